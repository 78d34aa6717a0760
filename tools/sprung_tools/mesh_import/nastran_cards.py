"""The cards of a Nastran bulk data deck, in free, small and large fields."""

import os
import re
from typing import NamedTuple, NoReturn

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LARGEST_NUMBER
from sprung_tools.mesh_import.number_text import parse_real, parse_whole

SHORT_EXPONENT = re.compile(r"([0-9.])([+-]\d+)$")  # 1.5-3 is 1.5e-3
KNOWN = re.compile(rb"(GRID|C(BAR|BEAM|ROD|ONROD|TUBE|QUAD4|TRIA3|HEXA|TETRA)|MAT1|INCLUDE)[ \t,*]", re.IGNORECASE)
MOST_FILES = 100  # that are taken in by INCLUDE


class Card(NamedTuple):
    """A bulk data card: fields[0] is the first field after the name, a blank field is ""."""

    name: str
    fields: list[str]
    path: str
    line: int

    def fail(self, what: str) -> NoReturn:
        """Throws InputError at the card's line."""
        raise InputError(f"{self.path}:{self.line}: error: {self.name}: {what}")

    def field(self, place: int) -> str:
        """A field's text; empty beyond the last one."""
        return self.fields[place] if place < len(self.fields) else ""

    def integer(self, place: int, what: str, default: int | None = None) -> int:
        """A field's whole number; the default if it is blank and there is one. what: its meaning, for the message."""
        text = self.field(place)
        if not text and default is not None:
            return default
        try:
            number = parse_whole(text)
        except ValueError:
            self.fail(f"'{text}' is no {what}" if text else f"has no {what}: truncated?")
        if abs(number) > LARGEST_NUMBER:
            self.fail(f"'{text}' is no {what}: numbers end at {LARGEST_NUMBER}")
        return number

    def real(self, place: int, what: str) -> float:
        """A field's number, 0 if it is blank. what: its meaning, for the message."""
        value = self._parse(place)
        if not np.isfinite(value):
            self.fail(f"'{self.field(place)}' is no {what}")
        return value

    def is_filled(self, place: int) -> bool:
        """Whether a field says something: it is neither blank nor the number 0."""
        return self._parse(place) != 0.0

    def _parse(self, place: int) -> float:
        """A field's number, 0 if it is blank, NaN if it is none."""
        text = SHORT_EXPONENT.sub(r"\1e\2", self.field(place).upper().replace("D", "E"))
        try:
            return parse_real(text or "0")
        except ValueError:
            return np.nan


class Cards(NamedTuple):
    """What a deck holds. cards: those of the bulk data, and each PARAM before it; before: the other lines before the
    bulk data that say something; has_end: whether ENDDATA ends it."""

    cards: list[Card]
    before: list[str]
    has_end: bool


def split_fields(line: str) -> tuple[str, list[str]]:
    """Splits a line in any of the three formats. Returns (name, fields)."""
    line = line.partition("$")[0].rstrip()
    if "," in line:
        parts = [part.strip() for part in line.split(",")]
        width = 4 if "*" in parts[0] else 8
        return parts[0], (parts[1:] + [""] * width)[:width]
    line = line.expandtabs(8)
    width = 16 if "*" in line[:8] else 8
    body = line[8:72]
    return line[:8].strip(), [body[at : at + width].strip() for at in range(0, 64, width)]


def split_marks(line: str) -> tuple[str, str]:
    """The marks of a line, +NAME or *NAME: by which it continues another one, and by which the next one continues it.
    Empty for what is no mark."""
    line = line.partition("$")[0].rstrip()
    if "," in line:
        parts = [part.strip() for part in line.split(",")]
        last = 5 if "*" in parts[0] else 9
        ends = parts[0], parts[last] if last < len(parts) else ""
    else:
        line = line.expandtabs(8)
        ends = line[:8].strip(), line[72:80].strip()
    begin, end = (text[1:].upper() if text[:1] in ("+", "*") else "" for text in ends)
    return begin, end


def check_width(path: str, number: int, line: str) -> None:
    """Throws InputError if a line in free fields has more than its name, the data and the mark by which the next line
    continues it (MSC Nastran, Quick Reference Guide, "Format of Bulk Data Entries")."""
    parts = [part.strip() for part in line.partition("$")[0].split(",")]
    width = 4 if "*" in parts[0] else 8
    rest = [part for part in parts[width + 1 :] if part]
    is_mark = len(rest) == 1 and parts[width + 1][:1] in ("+", "*") and "." not in rest[0]
    if rest and not is_mark:
        what = f"has '{rest[0]}' behind its {width} data fields, where only the mark of a continuation (+…) can stand"
        raise InputError(f"{path}:{number}: error: {parts[0] or 'continuation'}: {what}")


def read_lines(path: str) -> list[str]:
    """The lines of a text file. InputError if it cannot be read."""
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            return file.read().splitlines()
    except OSError as error:
        raise InputError(f"{path}: error: cannot read the file ({error.strerror})") from error


def read_cards(path: str) -> Cards:
    """Reads a deck, and the files that it includes. A deck without BEGIN BULK is bulk data from its first line on, one
    without ENDDATA ends with its last line. InputError if it holds no cards."""
    lines = read_lines(path)
    first = [number for number, line in enumerate(lines) if line.strip().upper().startswith("BEGIN")]
    begin = first[0] + 1 if first else 0
    cards: list[Card] = []
    has_end = add_cards(path, lines, begin, cards, [os.path.realpath(path)])
    if not cards:
        raise InputError(f"{path}: error: has no bulk data: not a Nastran deck, or truncated")
    before = []
    for number, line in enumerate(lines[: max(begin - 1, 0)], start=1):
        name, fields = split_fields(line)
        if name.rstrip("*").upper() == "PARAM":
            cards.append(Card("PARAM", fields, path, number))
        elif line.partition("$")[0].strip():
            before.append(line)
    return Cards(cards, before, has_end)


def add_cards(path: str, lines: list[str], begin: int, cards: list[Card], taken: list[str]) -> bool:
    """Adds the cards of a file to the list. Returns whether it ends with ENDDATA. taken: the files so far."""
    places = iter(range(begin, len(lines)))
    expected = ""  # mark of the line that continues the one before
    for place in places:
        line = lines[place]
        upper = line.lstrip().upper()
        if upper.startswith("ENDDATA"):
            return True
        if not line.partition("$")[0].strip():
            continue
        if upper.startswith("INCLUDE"):
            text = line.strip()[len("INCLUDE") :].strip()
            while text[:1] in "'\"" and text.count(text[:1]) < 2 and text:
                line_after = next(places, None)
                if line_after is None:
                    raise InputError(f"{path}:{place + 1}: error: INCLUDE: its file name has no end")
                text += lines[line_after].strip()
            include(path, place + 1, text.strip("'\""), cards, taken)
            continue
        check_width(path, place + 1, line)
        name, fields = split_fields(line)
        mark, following = split_marks(line)
        if name[:1] == "=" or "=" in fields:
            raise InputError(f"{path}:{place + 1}: error: {name}: repeats the card before, which is not followed")
        if name[:1] in ("+", "*", ""):
            if not cards:
                raise InputError(f"{path}:{place + 1}: error: a continuation without a card")
            if mark and expected and mark != expected:
                found = f"continues by '{name}', but the line before it is continued by '+{expected}'"
                raise InputError(f"{path}:{place + 1}: error: {cards[-1].name}: {found}: put them one after the other")
            cards[-1].fields.extend(fields)
        else:
            cards.append(Card(name.rstrip("*").strip().upper(), list(fields), path, place + 1))
        expected = following
    return False


def include(path: str, line: int, name: str, cards: list[Card], taken: list[str]) -> None:
    """Adds the cards of a file that another one includes."""
    found = os.path.join(os.path.dirname(path), name.replace("\\", "/"))
    if not os.path.isfile(found):
        raise InputError(f"{path}:{line}: error: INCLUDE: there is no file '{found}'")
    taken.append(os.path.realpath(found))
    if len(taken) > MOST_FILES:
        raise InputError(f"{path}:{line}: error: INCLUDE: more than {MOST_FILES} files; does one include itself?")
    add_cards(found, read_lines(found), 0, cards, taken)


def is_nastran(path: str) -> bool:
    """Whether a file has a line of a Nastran deck; the endings `.dat` and `.pch` alone do not say so."""
    with open(path, "rb") as file:
        return any(KNOWN.match(line) or line.strip().upper().startswith(b"ENDDATA") for line in file)
