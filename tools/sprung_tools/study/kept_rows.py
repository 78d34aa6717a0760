"""The outcomes of a study's runs, each on disk as soon as its run has ended: one line of JSON in FOLDER/rows.jsonl.

A row is found by the hash of everything that its run read. A study that is started again therefore takes the rows that
are there, also after its file has changed, and makes the runs that are missing.
"""

import fcntl
import json
import math
import os
from pathlib import Path
from typing import IO, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.programs.calls import CHECK_FAILED, GOOD
from sprung_tools.runs.measures import Measure, Measures
from sprung_tools.study.machine_faults import is_of_machine

ROWS = "rows.jsonl"
MADE = ("table.csv", "table.h5", "study.html")  # what the tool writes from them, over what is there


class Row(NamedTuple):
    """The outcome of a run. exit_code: the program's, or 2 where its results cannot be read; converged: that no
    check of the run failed."""

    hash: str
    exit_code: int
    error: str
    converged: bool
    warnings: tuple[str, ...]
    measures: Measures
    seconds: float  # from the start of the run to its measures

    @property
    def has_failed(self) -> bool:
        """Whether there are no results. A run whose check failed has some."""
        return self.exit_code not in (GOOD, CHECK_FAILED)


class KeptRows:
    """The file of rows, held for one study at a time. rows: by hash."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / ROWS
        strange = [name for name in MADE if (folder / name).exists() and not self.path.exists()]
        if strange:
            what = f"holds {strange[0]} and no {ROWS}, so it is not of this tool; choose another one"
            raise InputError(f"{folder}: error: the folder {what}")
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file: IO[str] = open(self.path, "a+", encoding="utf-8", errors="replace")
        except OSError as error:
            raise InputError(f"{self.path}: error: cannot be opened ({error.strerror})") from error
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            self._file.close()
            raise InputError(f"{self.path}: error: another study is at work in this folder") from error
        self._file.seek(0)
        found = (parse_row(line) for line in self._file)
        self.rows = {row.hash: row for row in found if row is not None}

    def __enter__(self) -> "KeptRows":
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def keep_row(path: Path, row: Row) -> None:
    """Adds a row to the file; when this returns, it is on the disk. Several processes may do so."""
    measures = {name: list(one) for name, one in row.measures.items()}
    line = json.dumps({**row._asdict(), "measures": measures}, ensure_ascii=False, allow_nan=False)
    file = os.open(path, os.O_RDWR | os.O_APPEND)
    try:
        fcntl.lockf(file, fcntl.LOCK_EX)
        end = os.lseek(file, 0, os.SEEK_END)
        is_whole = end == 0 or os.pread(file, 1, end - 1) == b"\n"  # else a write was cut off there
        rest = ("" if is_whole else "\n").encode() + f"{line}\n".encode()
        while rest:  # a disk that becomes full takes a part of it
            rest = rest[os.write(file, rest) :]
        os.fsync(file)
    finally:
        os.close(file)


def parse_row(line: str) -> Row | None:
    """A row from its line; None for a line that was cut off, holds something else, or has a failure that says nothing
    about the run. That run is then made again."""
    try:
        values = json.loads(line)
        values["warnings"] = tuple(values["warnings"])
        values["measures"] = {name: Measure(*one) for name, one in values["measures"].items()}
        row = Row(**values)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
    return row if has_its_types(row) and not is_of_machine(row.error) else None


def has_its_types(row: Row) -> bool:
    """Whether the values that were read for a row are of the types of one."""
    numbers = (row.seconds, *(one.value for one in row.measures.values() if one.value is not None))
    texts = (row.hash, row.error, *row.warnings, *(one.unit for one in row.measures.values()))
    return (
        type(row.exit_code) is int
        and type(row.converged) is bool
        and all(type(one) in (int, float) and math.isfinite(one) for one in numbers)
        and all(isinstance(one, str) for one in texts)
    )
