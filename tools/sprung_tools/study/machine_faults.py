"""Failures that say nothing about a run, because the machine lacks space, memory or files. No row is kept of them."""

import errno
import os

CODES = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.ENOMEM, errno.EMFILE, errno.ENFILE, errno.EIO)
REASONS = (*map(os.strerror, CODES), "internal error: out of memory")  # the last one is of the programs themselves


def is_of_machine(error: str) -> bool:
    """Whether an error is about the machine, so that the same run may end well at another time."""
    return any(reason in error for reason in REASONS)
