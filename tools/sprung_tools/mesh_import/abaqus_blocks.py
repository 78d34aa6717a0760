"""The blocks of an Abaqus input deck: a keyword line and the data lines under it."""

import math
import os
from collections.abc import Iterable, Iterator
from typing import NamedTuple, NoReturn

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LARGEST_NUMBER

# Keyword → the first of its data lines that may be blank, which stands for the defaults. Other blank lines are nothing.
FIRST_BLANK_LINE = {"BEAM SECTION": 1, "BEAM GENERAL SECTION": 1, "INSTANCE": 0}


class Block(NamedTuple):
    """A keyword line and the data lines under it."""

    keyword: str  # in capitals, without the asterisk
    parameters: dict[str, str]  # name in capitals → text, "" where it has none
    data: list[tuple[int, list[str]]]  # line number, fields
    path: str
    line: int

    def fail(self, what: str, line: int | None = None) -> NoReturn:
        """Throws InputError at a line of the block, its first if none is given."""
        raise InputError(f"{self.path}:{line or self.line}: error: *{self.keyword}: {what}")

    def describe(self) -> str:
        """The keyword line in one form, with its number."""
        shown = [key if not text else f"{key}={text}" for key, text in self.parameters.items()]
        return f"*{', '.join([self.keyword, *shown])} (line {self.line})"


def read_blocks(path: str, including: tuple[str, ...] = ()) -> list[Block]:
    """Reads all blocks of a deck; the blocks of an *INCLUDE take its place. InputError if it is not a whole deck.

    including: the chain of files that leads to this one by *INCLUDE.
    """
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            text = file.read()
    except OSError as error:
        raise InputError(f"{path}: error: cannot read the file ({error.strerror})") from error
    ends_open = text and not text.endswith("\n") and not text.rpartition("\n")[2].startswith("*")
    if ends_open and "*END STEP" not in text.upper():
        number = text.count("\n") + 1
        raise InputError(f"{path}:{number}: error: the last line has no line end: the file is truncated")
    blocks: list[Block] = []
    for number, line in join_lines(text.splitlines()):
        if line.startswith("*"):
            keyword, *parameters = [part.strip() for part in line[1:].split(",")]
            pairs = [part.partition("=") for part in parameters if part]
            named = {" ".join(key.upper().split()): value.strip().strip("\"'") for key, _, value in pairs}
            blocks.append(Block(" ".join(keyword.upper().split()), named, [], path, number))
        elif not line and not (blocks and may_be_blank(blocks[-1])):
            continue
        elif not blocks:
            raise InputError(
                f"{path}:{number}: error: '{line[:40]}' stands before the first keyword: not an Abaqus deck"
            )
        else:
            blocks[-1].data.append((number, [part.strip().strip("\"'") for part in line.split(",")]))
    return [found for block in blocks for found in follow_include(block, (*including, path))]


def may_be_blank(block: Block) -> bool:
    """Whether a blank line that follows is a data line of the block."""
    return len(block.data) >= FIRST_BLANK_LINE.get(block.keyword, math.inf)


def follow_include(block: Block, including: tuple[str, ...]) -> list[Block]:
    """The blocks of the file that an *INCLUDE names; any other block alone."""
    if block.keyword != "INCLUDE":
        return [block]
    name = block.parameters.get("INPUT", "")
    if not name:
        block.fail("has no file (INPUT=…)")
    path = os.path.join(os.path.dirname(block.path), name)
    if any(os.path.realpath(path) == os.path.realpath(one) for one in including):
        block.fail(f"'{name}' includes itself")
    return read_blocks(path, including)


def join_lines(lines: Iterable[str]) -> Iterator[tuple[int, str]]:
    """Yields (number, text) of the lines that are no comments; the text of a blank line is empty. A keyword line that
    ends with a comma is joined with the next one."""
    waiting: tuple[int, str] | None = None
    for number, line in enumerate(lines, start=1):
        line = line.strip()
        if line.startswith("**") or (waiting and not line):
            continue
        if waiting:
            number, line = waiting[0], waiting[1] + line
        if line.startswith("*") and line.endswith(","):
            waiting = (number, line)
        else:
            waiting = None
            yield number, line


def read_integer(block: Block, line: int, text: str, default: int | None = None) -> int:
    """A whole number; the default if it is blank. InputError at its line if it is none, too large, or blank without a
    default."""
    if not text and default is not None:
        return default
    try:
        number = int(text)
    except ValueError:
        block.fail(f"'{text}' is not a number" if text else "expects a number, but the field is blank", line)
    if abs(number) > LARGEST_NUMBER:
        block.fail(f"'{text}' is not a number of a node or an element, which end at {LARGEST_NUMBER}", line)
    return number


def read_real(block: Block, line: int, text: str) -> float:
    """A finite number; InputError at its line if it is none."""
    try:
        value = float(text.upper().replace("D", "E"))  # Fortran's 1.0D0
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        block.fail(f"'{text}' is not a number", line)
    return value


def join_rows(block: Block, least: int | None) -> list[tuple[int, list[int]]]:
    """The elements of a block as (line number, numbers). An element continues in the next line after a comma at the
    end; one that has `least` numbers does not."""
    rows: list[tuple[int, list[int]]] = []
    continues = False
    for line, fields in block.data:
        numbers = [read_integer(block, line, text) for text in fields if text]
        if continues:
            rows[-1][1].extend(numbers)
        else:
            rows.append((line, numbers))
        continues = fields[-1] == "" and (least is None or len(rows[-1][1]) < least)
    return [row for row in rows if row[1]]
