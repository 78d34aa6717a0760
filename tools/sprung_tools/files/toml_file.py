"""Reading TOML files, with the line and column of every key for the message of an error.

Python's tomllib says where the syntax is wrong, but not where a value stands. The places are therefore found here: a
statement is the shortest run of lines, from a given line on, that is valid TOML by itself.
"""

import re
import tomllib
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError

Place = tuple[str | int, ...]  # keys and indices from the root: ("parameters", 0, "from")


class Statement(NamedTuple):
    """A statement: its first line from 0, its text, what it alone parses to."""

    line: int
    text: str
    parsed: dict[str, Any]


class TomlFile:
    """A file that was read. data: its root table."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        try:
            text = self.path.read_text(encoding="utf-8-sig")
        except OSError as error:
            raise InputError(f"{path}: error: cannot read the file ({error.strerror})") from error
        except UnicodeDecodeError as error:
            raise InputError(f"{path}: error: is not UTF-8 text (byte {error.start})") from error
        try:
            self.data: dict[str, Any] = tomllib.loads(text)
        except ValueError as error:  # of syntax, or of a whole number with thousands of digits
            raise InputError(f"{path}:{describe_syntax(str(error), text)}") from error
        self._statements = find_places(text)

    def places(self) -> Collection[Place]:
        """The places of all keys in the file."""
        return self._statements.keys()

    def fail(self, place: Place, what: str, fragment: str = "") -> InputError:
        """The error about a key or value, `path:line:column: error: what`. Of a key that is not in the file it names
        the table. fragment: a text within the value, to which the error then points."""
        while place and place not in self._statements:
            place = place[:-1]
        line, column = 1, 1
        if place:
            statement = self._statements[place]
            start = max(statement.text.find(fragment), 0) if fragment else 0
            if start == 0:
                start = len(statement.text) - len(statement.text.lstrip())
            before = statement.text[:start]
            line = statement.line + before.count("\n") + 1
            column = start - (before.rfind("\n") + 1) + 1
        return InputError(f"{self.path}:{line}:{column}: error: {what}")


def describe_syntax(message: str, text: str) -> str:
    """tomllib's message `… (at line 3, column 5)` as `3:5: error: …`."""
    found = re.fullmatch(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", message, re.DOTALL)
    if not found:
        return f"1:1: error: {message}"
    what, line, column = found.groups()
    lines = text.split("\n")
    return f"{line or len(lines)}:{column or len(lines[-1]) + 1}: error: {what}"


def list_statements(text: str) -> Iterator[Statement]:
    """The statements of a valid file in order, blank lines and comments among them."""
    lines = text.splitlines(keepends=True)
    first = 0
    while first < len(lines):
        for last in range(first + 1, len(lines) + 1):
            part = "".join(lines[first:last])
            try:
                parsed = tomllib.loads(part)
            except tomllib.TOMLDecodeError:
                continue
            yield Statement(first, part, parsed)
            break
        first = last


def find_places(text: str) -> dict[Place, Statement]:
    """The statement in which each key of a valid file stands."""
    places: dict[Place, Statement] = {}
    counts: dict[Place, int] = {}  # of the arrays of tables so far
    table: Place = ()
    for statement in list_statements(text):
        if not statement.text.lstrip().startswith("["):
            for place in list_keys(statement.parsed):
                places.setdefault((*table, *place), statement)
            continue
        keys, is_array = read_header(statement.parsed)
        table = ()
        for number, key in enumerate(keys, start=1):
            table = (*table, key)
            if number == len(keys) and is_array:
                counts[table] = counts.get(table, 0) + 1
            if table in counts:
                table = (*table, counts[table] - 1)
        places[table] = statement
    return places


def list_keys(table: dict[str, Any]) -> Iterator[Place]:
    """The places of all keys of a table and of the tables in it."""
    for key, value in table.items():
        yield (key,)
        if isinstance(value, dict):
            yield from ((key, *rest) for rest in list_keys(value))


def read_header(parsed: dict[str, Any]) -> tuple[list[str], bool]:
    """The keys of a header from what it alone parses to, and whether it is one of an array of tables."""
    keys: list[str] = []
    inside: Any = parsed
    while isinstance(inside, dict) and inside:
        ((key, inside),) = inside.items()
        keys.append(key)
    return keys, isinstance(inside, list)
