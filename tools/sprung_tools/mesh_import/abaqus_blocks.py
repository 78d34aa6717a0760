"""The blocks of an Abaqus input deck: a keyword line and the data lines under it.

Blanks on a keyword line are ignored but between quotation marks, and so are they in labels on data lines. Source:
Abaqus 2016, Analysis User's Guide, "Input syntax rules".
"""

import math
import os
import re
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple, NoReturn

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LARGEST_NUMBER
from sprung_tools.mesh_import.number_text import parse_real, parse_whole

SPELLINGS = {  # without blanks → as it is spelled here, of what the reader asks for; all other words have no blanks
    text.replace(" ", ""): text
    for text in (
        "ALL NODES", "BEAM GENERAL SECTION", "BEAM SECTION", "END ASSEMBLY", "END INSTANCE", "END PART", "END STEP",
        "ROTARY INERTIA", "SOLID SECTION", "THICK PIPE", "TWO STEP", "USER ELEMENT",
    )
}  # fmt: skip
END_STEP = re.compile(r"^\s*\*\s*END\s*STEP", re.IGNORECASE | re.MULTILINE)
QUOTED = re.compile(r"""("[^"]*"|'[^']*')""")
LABEL = re.compile(r"[A-Za-z_]")  # how a label without quotation marks begins, and no number
# Keyword → the first of its data lines that may be blank, which stands for the defaults. Other blank lines are nothing.
FIRST_BLANK_LINE = {"BEAM SECTION": 1, "BEAM GENERAL SECTION": 1, "INSTANCE": 0}


class Block(NamedTuple):
    """A keyword line and the data lines under it."""

    keyword: str  # in capitals, without the asterisk, as it is spelled here
    parameters: dict[str, str]  # name in capitals → text, "" where it has none
    data: list[tuple[int, list[str]]]  # line number, fields
    path: str
    line: int
    title: str  # the keyword as it is written, in capitals

    def fail(self, what: str, line: int | None = None) -> NoReturn:
        """Throws InputError at a line of the block, its first if none is given."""
        raise InputError(f"{self.path}:{line or self.line}: error: *{self.keyword}: {what}")

    def describe(self) -> str:
        """The keyword line in one form, with its number."""
        shown = [key if not text else f"{key}={text}" for key, text in self.parameters.items()]
        return f"*{', '.join([self.title, *shown])} (line {self.line})"


def read_blocks(path: str, including: tuple[str, ...] = ()) -> list[Block]:
    """Reads all blocks of a deck; the blocks of an *INCLUDE take its place. InputError if it is not a whole deck.

    including: the chain of files that leads to this one by *INCLUDE.
    """
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            text = file.read()
    except OSError as error:
        raise InputError(f"{path}: error: cannot read the file ({error.strerror})") from error
    ends_open = text and not text.endswith("\n") and not text.rpartition("\n")[2].startswith("*")
    if ends_open and not END_STEP.search(text):
        number = text.count("\n") + 1
        raise InputError(f"{path}:{number}: error: the last line has no line end: the file is truncated")
    blocks: list[Block] = []
    for number, line in join_lines(text.splitlines()):
        if line.startswith("*"):
            keyword, *parameters = split_fields(line[1:])
            named = dict(read_parameter(part) for part in parameters if part)
            blocks.append(Block(spell(keyword), named, [], path, number, " ".join(keyword.upper().split())))
        elif not line and not (blocks and may_be_blank(blocks[-1])):
            continue
        elif not blocks:
            raise InputError(
                f"{path}:{number}: error: '{line[:40]}' stands before the first keyword: not an Abaqus deck"
            )
        else:
            blocks[-1].data.append((number, [read_field(part) for part in split_fields(line)]))
    return [found for block in blocks for found in follow_include(block, (*including, path))]


def split_fields(line: str) -> list[str]:
    """The parts of a line between commas, but for those between quotation marks."""
    kept = QUOTED.split(line)  # every second one is quoted
    hidden = [part.replace(",", "\0") if place % 2 else part for place, part in enumerate(kept)]
    return [part.strip().replace("\0", ",") for part in "".join(hidden).split(",")]


def spell(text: str) -> str:
    """A keyword, a parameter or the name of a shape in capitals, as it is spelled here whatever blanks it has."""
    bare = "".join(text.upper().split())
    return SPELLINGS.get(bare, bare)


def read_parameter(part: str) -> tuple[str, str]:
    """(name, value) of a parameter; a file's name keeps its blanks."""
    name, _, value = part.partition("=")
    name, value = spell(name), value.strip()
    return name, value.strip("\"'") if name == "INPUT" else remove_blanks(value)


def read_field(text: str) -> str:
    """A field of a data line; a label loses its blanks."""
    return remove_blanks(text) if LABEL.match(text) else text.strip("\"'")


def remove_blanks(text: str) -> str:
    """A text without blanks and quotation marks; between these it keeps its blanks."""
    return "".join(one[1:-1] if place % 2 else "".join(one.split()) for place, one in enumerate(QUOTED.split(text)))


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
        number = parse_whole(text)
    except ValueError:
        block.fail(f"'{text}' is not a number" if text else "expects a number, but the field is blank", line)
    if abs(number) > LARGEST_NUMBER:
        block.fail(f"'{text}' is not a number of a node or an element, which end at {LARGEST_NUMBER}", line)
    return number


def read_real(block: Block, line: int, text: str, before: str = "") -> float:
    """A finite number; InputError at its line if it is none. before: what stands before it, for the message."""
    try:
        value = parse_real(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        block.fail(f"{before}'{text}' is not a number", line)
    return value


def check_rows(block: Block, most: int, what: str) -> None:
    """Throws InputError if a block has more data lines than `most`; blank ones do not count. what: the lines' meaning,
    for the message."""
    for line, fields in block.data[most:]:
        if any(fields):
            block.fail(f"has a further data line behind those {what}", line)


def read_reals(block: Block, place: int, most: int, what: str) -> list[float]:
    """The numbers of a data line, blank fields between them as 0; none if there is no such line. Blank fields at its
    end do not count. InputError if there are more than `most`. what: the numbers' meaning, for the message."""
    if place >= len(block.data):
        return []
    line, fields = block.data[place]
    given = max((number for number, text in enumerate(fields, start=1) if text), default=0)
    if given > most:
        block.fail(f"has {given} numbers of {what}, expected {most} at most", line)
    return [read_real(block, line, text) if text else 0.0 for text in fields[:given]]


def join_rows(
    block: Block, least: int | None, find_number: Callable[[int, str, bool], int]
) -> list[tuple[int, list[int]]]:
    """The elements of a block as (line number, numbers). An element continues in the next line after a comma at the
    end; one that has `least` numbers does not.

    find_number: the number that a text in a line names, of the element itself (True) or of one of its nodes.
    """
    rows: list[tuple[int, list[int]]] = []
    continues = False
    for line, fields in block.data:
        texts = [text for text in fields if text]
        numbers = [find_number(line, text, place == 0 and not continues) for place, text in enumerate(texts)]
        if continues:
            rows[-1][1].extend(numbers)
        else:
            rows.append((line, numbers))
        continues = fields[-1] == "" and (least is None or len(rows[-1][1]) < least)
    return [row for row in rows if row[1]]
