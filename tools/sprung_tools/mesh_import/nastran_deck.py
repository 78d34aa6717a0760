"""Reading the frame in a Nastran bulk data deck (free, small and large fields).

meshio's own reader is not used: in version 5.0 it skips CBAR* cards and cards in small letters, reads nodes of other
coordinate systems as if they were in the basic one, and does not report what else the deck holds.
tests/tools/mesh_reading_test.py compares both readers where meshio's is right.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple, NoReturn

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LARGEST_NUMBER, MOST_MEMBERS, LineMesh, pick_members, shorten

WITH_DIRECTION = {"CBAR", "CBEAM"}  # id, property, 2 nodes, orientation (3 numbers or a node), …
WITH_PROPERTY = {"CROD", "CTUBE"}  # id, property, 2 nodes
LINE_CARDS = WITH_DIRECTION | WITH_PROPERTY | {"CONROD"}  # CONROD: id, 2 nodes, material, area …
KINDS = {
    "CBAR": "bending, with shear if its property has K1, K2",
    "CBEAM": "bending, with shear unless its property says not",
    "CROD": "axial alone", "CTUBE": "axial alone", "CONROD": "axial alone",
}  # fmt: skip
SHORT_EXPONENT = re.compile(r"([0-9.])([+-]\d+)$")  # 1.5-3 is 1.5e-3


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
            number = int(text)
        except ValueError:
            self.fail(f"'{text}' is no {what}" if text else f"has no {what}: truncated?")
        if abs(number) > LARGEST_NUMBER:
            self.fail(f"'{text}' is no {what}: numbers end at {LARGEST_NUMBER}")
        return number

    def real(self, place: int, what: str) -> float:
        """A field's number, 0 if it is blank. what: its meaning, for the message."""
        text = SHORT_EXPONENT.sub(r"\1e\2", self.field(place).upper().replace("D", "E"))
        try:
            value = float(text or 0.0)
        except ValueError:
            value = np.nan
        if not np.isfinite(value):
            self.fail(f"'{self.field(place)}' is no {what}")
        return value


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


def read_cards(path: str) -> tuple[list[str], list[Card]]:
    """Returns (lines before the bulk data, cards). InputError if the deck has no end."""
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            lines = file.read().splitlines()
    except OSError as error:
        raise InputError(f"{path}: error: cannot read the file ({error.strerror})") from error
    first = [number for number, line in enumerate(lines) if line.strip().upper().startswith("BEGIN")]
    begin = first[0] + 1 if first else 0
    cards: list[Card] = []
    for number, line in enumerate(lines[begin:], start=begin + 1):
        if line.lstrip().upper().startswith("ENDDATA"):
            return lines[: begin - 1] if begin else [], cards
        if not line.partition("$")[0].strip():
            continue
        name, fields = split_fields(line)
        if name[:1] in ("+", "*", ""):
            if not cards:
                raise InputError(f"{path}:{number}: error: a continuation without a card")
            cards[-1].fields.extend(fields)
        else:
            cards.append(Card(name.rstrip("*").upper(), list(fields), path, number))
    raise InputError(f"{path}: error: no ENDDATA: the file is truncated, or not a Nastran deck")


def is_nastran(path: str) -> bool:
    """Whether a file has the line that ends a Nastran deck; the ending `.dat` alone does not say so."""
    with open(path, "rb") as file:
        return any(line.strip().upper().startswith(b"ENDDATA") for line in file)


def read_nastran(path: str) -> LineMesh:
    """Reads the line elements of a deck. The elements of a property form the set property_ID, the nodes of a SET1 the
    set set_ID. InputError at the line of the fault."""
    before, cards = read_cards(path)
    deck = Deck(path)
    if any(line.partition("$")[0].strip() for line in before):
        deck.left_behind.append(f"executive and case control (lines 1 to {len(before)})")
    for card in cards:
        deck.read(card)
    return deck.make_mesh()


class Deck:
    """The deck as far as it has been read."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.nodes: dict[int, tuple[float, ...]] = {}  # id → position
        self.elements: dict[int, tuple[Card, list[int]]] = {}  # id → (card, node ids)
        self.properties: dict[str, list[int]] = {}  # name → element ids
        self.node_sets: dict[str, list[int]] = {}  # name → node ids
        self.num_lines: dict[str, int] = {}  # name of a card of lines → number of them
        self.others: dict[str, list[str]] = {}  # name of any other card → ids
        self.not_kept: dict[str, list[int]] = {
            "orientation vectors or nodes": [],
            "hinges (pin flags)": [],
            "offsets": [],
        }  # element ids
        self.left_behind: list[str] = []

    def read(self, card: Card) -> None:
        if card.name == "GRID":
            self.read_node(card)
        elif card.name in LINE_CARDS:
            self.read_line(card)
        elif card.name in ("INCLUDE", "=") or card.name.startswith("INCLUDE"):
            card.fail("is not followed; write one deck without it")
        elif card.name == "GRDSET" and card.integer(1, "coordinate system", 0) != 0:
            card.fail("gives a coordinate system to nodes; write them in the basic one")
        elif card.name in ("BAROR", "BEAMOR") and card.field(1):
            card.fail("gives a property to bars that name none; write it on each")
        elif card.name == "SET1":
            name = f"set_{card.integer(0, 'set number')}"
            if name in self.node_sets:
                card.fail(f"set {card.field(0)} is defined twice")
            self.node_sets[name] = list(read_members(card))
        else:
            self.others.setdefault(card.name, []).append(card.field(0))

    def read_node(self, card: Card) -> None:
        node = card.integer(0, "node number")
        if card.integer(1, "coordinate system", 0) != 0:
            card.fail(f"node {node} is in coordinate system {card.field(1)}; write nodes in the basic one (0)")
        if len([text for text in card.fields[2:5] if text]) == 0:
            card.fail(f"node {node} has no coordinates: truncated?")
        if node in self.nodes or node < 1:
            card.fail(f"node {node} is defined twice" if node > 0 else "numbers begin at 1")
        self.nodes[node] = tuple(card.real(place, "coordinate") for place in (2, 3, 4))

    def read_line(self, card: Card) -> None:
        element = card.integer(0, "element number")
        if element in self.elements or element < 1:
            card.fail(f"element {element} is defined twice" if element > 0 else "numbers begin at 1")
        first = 1 if card.name == "CONROD" else 2
        ends = [card.integer(first + end, "node") for end in (0, 1)]
        self.elements[element] = (card, ends)
        self.num_lines[card.name] = self.num_lines.get(card.name, 0) + 1
        if card.name != "CONROD":
            name = f"property_{card.integer(1, 'property', element)}"
            self.properties.setdefault(name, []).append(element)
        if card.name in WITH_DIRECTION:
            for what, places in zip(self.not_kept, ((4, 5, 6), (8, 9), range(10, 16))):
                if any(card.field(place) and card.real(place, "number") != 0.0 for place in places):
                    self.not_kept[what].append(element)

    def make_mesh(self) -> LineMesh:
        ids = sorted(self.nodes)
        number = {node: place for place, node in enumerate(ids)}
        for element, (card, ends) in self.elements.items():
            for node in ends:
                if node not in number:
                    card.fail(f"element {element} names node {node}, which is not there: truncated?")
        lines = np.array([[number[node] for node in ends] for _, ends in self.elements.values()], dtype=int)
        element_number = {element: place for place, element in enumerate(self.elements)}
        node_sets = {}
        for name, members in self.node_sets.items():
            if set(members) <= set(number):
                node_sets[name] = members
            else:
                self.left_behind.append(f"SET1 '{name}': not all its members are nodes")
        return LineMesh(
            path=self.path,
            format="Nastran deck",
            node_ids=np.array(ids, dtype=int),
            positions=np.array([self.nodes[node] for node in ids], dtype=float).reshape(-1, 3),
            line_ids=np.array(list(self.elements), dtype=int),
            lines=lines.reshape(-1, 2),
            element_sets=pick_members(self.properties, element_number),
            node_sets=pick_members(node_sets, number),
            section_sets=tuple(self.properties),
            left_behind=self.list_left_behind(),
        )

    def list_left_behind(self) -> list[str]:
        """What the deck holds and the mesh does not, a text each."""
        texts = [
            f"beam kind {name} of {count} elements ({KINDS[name]} in Nastran): the design's 'theory' decides"
            for name, count in self.num_lines.items()
        ]
        texts += [f"{what} of elements {shorten(found)}" for what, found in self.not_kept.items() if found]
        texts += [f"{name} {shorten(filter(None, found))}".rstrip() for name, found in self.others.items()]
        return texts + self.left_behind


def read_members(card: Card) -> Iterator[int]:
    """Yields the numbers of a SET1 card: single ones, or FIRST THRU LAST."""
    texts = [text.upper() for text in card.fields[1:] if text]
    place = 0
    while place < len(texts):
        if texts[place + 1 : place + 2] == ["THRU"] and place + 2 < len(texts):
            if not (texts[place].isdecimal() and texts[place + 2].isdecimal()):
                card.fail(f"'{texts[place]} THRU {texts[place + 2]}' is not a range")
            members = range(int(texts[place]), int(texts[place + 2]) + 1)
            if not 0 < len(members) <= MOST_MEMBERS:
                card.fail(f"'{texts[place]} THRU {texts[place + 2]}' is not a range of 1 to {MOST_MEMBERS} numbers")
            yield from members
            place += 3
            continue
        if not texts[place].isdecimal():
            card.fail(f"'{texts[place]}' is not a node's number")
        yield int(texts[place])
        place += 1
