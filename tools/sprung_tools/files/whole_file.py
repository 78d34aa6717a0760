"""Writing a file whole or not at all: it is written under another name in the same folder, then renamed."""

import os
from collections.abc import Iterable
from pathlib import Path

from sprung_tools.files.errors import InputError


def write_whole(path: str | Path, content: str | bytes) -> None:
    """Writes text (as UTF-8) or bytes. An interrupted or failed write leaves an earlier file as it was.

    InputError if the file cannot be written, or is a device or a pipe, which renaming would replace.
    """
    path = Path(path)
    if is_device(path):
        raise InputError(f"{path}: error: cannot write the file (it is not a regular file)")
    data = content.encode("utf-8") if isinstance(content, str) else content
    unfinished = path.with_name(f".unfinished-{os.getpid()}-{path.name}") if path.name else path
    try:
        try:
            unfinished.write_bytes(data)
            os.replace(unfinished, path)
        except BaseException:
            if unfinished.is_file():
                unfinished.unlink()
            raise
    except OSError as error:
        raise InputError(f"{path}: error: cannot write the file ({error.strerror})") from error


def is_device(path: Path) -> bool:
    """Whether a path is a device or a pipe, or leads to an open file of a process, as /dev/stdout does, also where that
    is a regular file."""
    is_special = path.exists() and not path.is_file() and not path.is_dir()
    is_open_file = path.is_symlink() and os.readlink(path).startswith("/proc/")
    return is_special or is_open_file or path.absolute().parent.resolve() == Path("/dev")


def check_output(path: str | Path, inputs: Iterable[str | Path]) -> None:
    """Throws InputError if the file to be written is one of those that are read."""
    if any(os.path.exists(one) and os.path.exists(path) and os.path.samefile(path, one) for one in inputs):
        raise InputError(f"{path}: error: is one of the input files, which the output would replace")
