"""Failures that say nothing about a run, because the machine lacks space or files. No row is kept of them. A lack of
memory may come from the run itself, and is the failure of a row."""

import errno
import os

CODES = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EMFILE, errno.ENFILE, errno.EIO)
REASONS = tuple(map(os.strerror, CODES))


def is_of_machine(error: str) -> bool:
    """Whether an error is about the machine, so that the same run may end well at another time."""
    return any(reason in error for reason in REASONS)
