"""The file that is being read, in memory that a process shares with its parent. If HDF5 ends the process, it tells the
parent on which file."""

import mmap

LONGEST = 4096  # bytes of a path
_shared = mmap.mmap(-1, LONGEST)


def note_file(path: str) -> None:
    """Notes the file that is read from now on; an empty path if none is."""
    data = path.encode(errors="replace")[: LONGEST - 1]
    _shared[: len(data) + 1] = data + b"\0"


def last_file() -> str:
    """The file that was noted last; empty if there is none."""
    return _shared[:LONGEST].partition(b"\0")[0].decode(errors="replace")
