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
from sprung_tools.mesh_import.abaqus_keywords import PARAMETERS, find_keyword, find_parameter
from sprung_tools.mesh_import.line_mesh import LARGEST_NUMBER
from sprung_tools.mesh_import.number_text import parse_real, parse_whole

END_STEP = re.compile(r"^\s*\*\s*END\s*STEP", re.IGNORECASE | re.MULTILINE)
QUOTED = re.compile(r"""("[^"]*"|'[^']*')""")
LABEL = re.compile(r"[A-Za-z_]")  # how a label without quotation marks begins, and no number
# Keyword → the first of its data lines that may be blank, which stands for the defaults. Other blank lines are nothing.
FIRST_BLANK_LINE = {"BEAM SECTION": 1, "BEAM GENERAL SECTION": 1, "INSTANCE": 0}


class Place(NamedTuple):
    """Where a line stands: in the deck, or in a file that it includes."""

    path: str
    line: int


class Block(NamedTuple):
    """A keyword line and the data lines under it."""

    keyword: str  # in capitals, without the asterisk, written out
    parameters: dict[str, str]  # name in capitals, written out → text, "" where it has none
    data: list[tuple[Place, list[str]]]  # where it stands, fields
    place: Place
    title: str  # the keyword as it is written, in capitals

    @property
    def line(self) -> int:
        """The number of its keyword line."""
        return self.place.line

    def fail(self, what: str, place: Place | None = None) -> NoReturn:
        """Throws InputError at a line of the block, its first if none is given."""
        path, line = place or self.place
        raise InputError(f"{path}:{line}: error: *{self.keyword}: {what}")

    def describe(self) -> str:
        """The keyword line in one form, with its number."""
        shown = [key if not text else f"{key}={text}" for key, text in self.parameters.items()]
        return f"*{', '.join([self.title, *shown])} (line {self.line})"


def read_blocks(path: str) -> list[Block]:
    """Reads all blocks of a deck. InputError if it is not a whole one."""
    blocks: list[Block] = []
    add_blocks(path, os.path.dirname(path), (), blocks)
    return blocks


def add_blocks(path: str, folder: str, including: tuple[str, ...], blocks: list[Block]) -> None:
    """Adds the blocks of a file to those before it. Its lines stand in the place of the *INCLUDE: the first data lines
    belong to the last block before.

    folder: of the deck; including: the chain of files that leads to this one by *INCLUDE.
    """
    for number, line in join_lines(read_text(path).splitlines()):
        place = Place(path, number)
        if line.startswith("*"):
            block = read_keyword_line(place, line)
            if block.keyword == "INCLUDE":
                chain = (*including, path)
                add_blocks(find_included(block, folder, chain), folder, chain, blocks)
            else:
                blocks.append(block)
        elif not line and not (blocks and may_be_blank(blocks[-1])):
            continue
        elif not blocks:
            raise InputError(
                f"{path}:{number}: error: '{line[:40]}' stands before the first keyword: not an Abaqus deck"
            )
        else:
            blocks[-1].data.append((place, [read_field(part) for part in split_fields(line)]))


def read_text(path: str) -> str:
    """The text of a file. InputError if it cannot be read, or ends within a line."""
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            text = file.read()
    except OSError as error:
        raise InputError(f"{path}: error: cannot read the file ({error.strerror})") from error
    ends_open = text and not text.endswith("\n") and not text.rpartition("\n")[2].startswith("*")
    if ends_open and not END_STEP.search(text):
        number = text.count("\n") + 1
        raise InputError(f"{path}:{number}: error: the last line has no line end: the file is truncated")
    return text


def read_keyword_line(place: Place, text: str) -> Block:
    """A keyword line as a block without data. InputError if an abbreviation is not clear, or a parameter not known."""
    word, *parts = split_fields(text[1:])
    title = " ".join(word.upper().split())
    try:
        block = Block(find_keyword(word), {}, [], place, title)
    except ValueError as error:
        raise InputError(f"{place.path}:{place.line}: error: *{title}: {error}") from error
    for part in filter(None, parts):
        name, _, value = part.partition("=")
        try:
            name = find_parameter(block.keyword, name.strip())
        except ValueError as error:
            block.fail(str(error))
        if name in block.parameters and block.keyword in PARAMETERS:
            block.fail(f"has {name} twice")
        value = value.strip()
        block.parameters[name] = value.strip("\"'") if name == "INPUT" else remove_blanks(value)
    return block


def split_fields(line: str) -> list[str]:
    """The parts of a line between commas, but for those between quotation marks."""
    kept = QUOTED.split(line)  # every second one is quoted
    hidden = [part.replace(",", "\0") if place % 2 else part for place, part in enumerate(kept)]
    return [part.strip().replace("\0", ",") for part in "".join(hidden).split(",")]


def read_field(text: str) -> str:
    """A field of a data line; a label loses its blanks."""
    return remove_blanks(text) if LABEL.match(text) else text.strip("\"'")


def remove_blanks(text: str) -> str:
    """A text without blanks and quotation marks; between these it keeps its blanks."""
    return "".join(one[1:-1] if place % 2 else "".join(one.split()) for place, one in enumerate(QUOTED.split(text)))


def may_be_blank(block: Block) -> bool:
    """Whether a blank line that follows is a data line of the block."""
    return len(block.data) >= FIRST_BLANK_LINE.get(block.keyword, math.inf)


def find_included(block: Block, folder: str, including: tuple[str, ...]) -> str:
    """The path of the file that an *INCLUDE names: from the deck's folder, as Abaqus and CalculiX take it, or else from
    that of the file in which it stands."""
    name = block.parameters.get("INPUT", "")
    if not name:
        block.fail("has no file (INPUT=…)")
    paths = [os.path.join(place, name) for place in (folder, os.path.dirname(block.place.path))]
    path = next(filter(os.path.isfile, paths), None)
    if path is None:
        block.fail(f"there is no file {' or '.join(dict.fromkeys(paths))}")
    if any(os.path.realpath(path) == os.path.realpath(one) for one in including):
        block.fail(f"'{name}' includes itself")
    return path


def join_lines(lines: Iterable[str]) -> Iterator[tuple[int, str]]:
    """Yields (number, text) of the lines that are no comments; the text of a blank line is empty. A keyword line that
    ends with a comma is joined with the next one, if this one may begin with a parameter."""
    waiting: tuple[int, str] | None = None
    for number, line in enumerate(lines, start=1):
        line = line.strip()
        if line.startswith("**") or (waiting and not line):
            continue
        if waiting and LABEL.match(line):
            number, line = waiting[0], waiting[1] + line
        elif waiting:
            yield waiting
        waiting = (number, line) if line.startswith("*") and line.endswith(",") else None
        if not waiting:
            yield number, line
    if waiting:
        yield waiting


def read_integer(block: Block, line: Place, text: str, default: int | None = None) -> int:
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


def read_real(block: Block, line: Place, text: str, before: str = "") -> float:
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
    block: Block, least: int | None, find_number: Callable[[Place, str, bool], int]
) -> list[tuple[Place, list[int]]]:
    """The elements of a block as (where it stands, numbers). An element continues in the next line after a comma at the
    end; one that has `least` numbers does not.

    find_number: the number that a text in a line names, which is blank before others; of the element itself (True) or
    of one of its nodes.
    """
    rows: list[tuple[Place, list[int]]] = []
    continues = False
    for line, fields in block.data:
        given = max((number for number, text in enumerate(fields, start=1) if text), default=0)
        numbers = [find_number(line, text, k == 0 and not continues) for k, text in enumerate(fields[:given])]
        if continues:
            rows[-1][1].extend(numbers)
        else:
            rows.append((line, numbers))
        continues = fields[-1] == "" and (least is None or len(rows[-1][1]) < least)
    return [row for row in rows if row[1]]
