"""Reading the frame in a Nastran bulk data deck.

meshio's own reader is not used: in version 5.0 it skips CBAR* cards and cards in small letters, reads nodes of other
coordinate systems as if they were in the basic one, and does not report what else the deck holds.
tests/tools/mesh_reading_test.py compares both readers where meshio's is right.
"""

from collections.abc import Iterator

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import import nastran_coordinates, nastran_sections
from sprung_tools.mesh_import.frame_properties import Material, Section
from sprung_tools.mesh_import.line_mesh import LARGEST_NUMBER, MOST_MEMBERS, LineMesh, pick_members, shorten
from sprung_tools.mesh_import.nastran_cards import Card, read_cards
from sprung_tools.mesh_import.nastran_coordinates import CoordinateSystems
from sprung_tools.mesh_import.nastran_fields import find_not_taken

WITH_DIRECTION = {"CBAR", "CBEAM"}  # id, property, 2 nodes, orientation (3 numbers or a node), …
WITH_PROPERTY = {"CROD", "CTUBE"}  # id, property, 2 nodes; in NASTRAN-95 the same again for a second element
LINE_CARDS = WITH_DIRECTION | WITH_PROPERTY | {"CONROD"}  # CONROD: id, 2 nodes, material, area …
TWICE = {"CDAMP3", "CDAMP4", "CELAS3", "CELAS4", "CMASS3", "CMASS4", "PLOTEL"}  # may have a second id in their field 6
DEFAULTS = {"BAROR": "CBAR", "BEAMOR": "CBEAM"}  # gives property and orientation to the cards that lack them
KINDS = {
    "CBAR": "bending, with shear if its property has K1, K2",
    "CBEAM": "bending, with shear unless its property says not",
    "CROD": "axial alone", "CTUBE": "axial alone", "CONROD": "axial alone",
}  # fmt: skip


def read_nastran(path: str) -> LineMesh:
    """Reads the line elements of a deck. The elements of a property form the set property_ID, the nodes of a SET1 the
    set set_ID. InputError at the line of the fault."""
    found = read_cards(path)
    deck = Deck(path)
    for card in found.cards:
        for one in divide(card):
            deck.read(one)
    if found.before:
        deck.left_behind.append(f"executive and case control ({len(found.before)} lines)")
    mesh = deck.make_mesh()
    if deck.mass_factor is not None:
        multiply_masses(mesh, deck.mass_factor)
    if not found.has_end:
        mesh.doubts.append("no ENDDATA ends the deck, as in punch files: is the file whole?")
    return mesh


class Deck:
    """The deck as far as it has been read."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.nodes: dict[int, Card] = {}  # id → its GRID
        self.places: dict[int, Floats] = {}  # id → position in the basic system, as far as it is known
        self.systems = CoordinateSystems(self.find_node)
        self.node_defaults: Card | None = None  # GRDSET
        self.defaults: dict[str, Card] = {}  # name of a card of lines → BAROR, BEAMOR
        self.elements: dict[int, tuple[Card, list[int]]] = {}  # id → (card, node ids)
        self.properties: dict[str, Card] = {}  # id → card
        self.materials: dict[str, Card] = {}  # id → card
        self.masses: dict[int, Card] = {}  # id → card
        self.mass_factor: float | None = None  # PARAM,WTMASS
        self.node_sets: dict[str, list[int]] = {}  # name → node ids
        self.others: dict[str, list[str]] = {}  # name of any other card → ids
        self.not_taken: dict[tuple[str, str], dict[str, None]] = {}  # (card, what stands in its fields) → ids
        self.not_kept: dict[str, list[int]] = {"hinges (pin flags)": [], "offsets": []}  # element ids
        self.left_behind: list[str] = []

    def read(self, card: Card) -> None:
        """Takes in one card."""
        for what in find_not_taken(card):
            self.not_taken.setdefault((card.name, what), {})[card.field(0)] = None
        if card.name == "GRID":
            self.read_node(card)
        elif card.name in LINE_CARDS:
            self.read_line(card)
        elif card.name in nastran_coordinates.CARDS:
            self.systems.add(card)
        elif card.name == "GRDSET":
            self.node_defaults = card
        elif card.name in DEFAULTS:
            self.defaults[DEFAULTS[card.name]] = card
        elif card.name in nastran_sections.SECTION_CARDS:
            self.keep(card, self.properties)
        elif card.name in nastran_sections.MATERIAL_CARDS:
            self.keep(card, self.materials)
        elif card.name in nastran_sections.MASS_CARDS:
            self.read_mass(card)
        elif card.name == "PARAM" and card.field(0).upper() == "WTMASS":
            self.read_mass_factor(card)
        elif card.name == "SET1":
            name = f"set_{card.integer(0, 'set number')}"
            if name in self.node_sets:
                card.fail(f"set {card.field(0)} is defined twice")
            self.node_sets[name] = list(read_members(card))
        else:
            places = (0, 4) if card.name in TWICE and card.field(4) else (0,)
            self.others.setdefault(card.name, []).extend(card.field(place) for place in places)

    def keep(self, card: Card, kept: dict[str, Card]) -> None:
        """Keeps a property or a material by its number."""
        if card.field(0) in kept and kept[card.field(0)].fields != card.fields:
            card.fail(f"{card.field(0)} is defined twice")
        kept[card.field(0)] = card

    def read_mass(self, card: Card) -> None:
        number = card.integer(0, "element number")
        if number in self.masses:
            card.fail(f"{number} is defined twice")
        self.masses[number] = card

    def read_mass_factor(self, card: Card) -> None:
        """Reads PARAM,WTMASS. InputError if it is not positive, or differs from an earlier one."""
        factor = card.real(1, "number")
        if not factor > 0.0:
            card.fail(f"WTMASS is {factor:g}, expected a factor > 0 of all masses")
        if self.mass_factor not in (None, factor):
            card.fail(f"WTMASS is {factor:g} here and {self.mass_factor:g} elsewhere")
        self.mass_factor = factor

    def read_node(self, card: Card) -> None:
        node = card.integer(0, "node number")
        known = self.nodes.get(node)
        if (known and known.fields != card.fields) or node < 1:
            card.fail(f"node {node} is defined twice" if node > 0 else "numbers begin at 1")
        self.nodes[node] = card

    def find_node(self, asking: Card, node: int) -> Floats:
        """The position of a node in the basic system. InputError if it is not there, or defined by itself."""
        if node not in self.places:
            if node not in self.nodes:
                asking.fail(f"names node {node}, which is not there: truncated?")
            card = self.nodes[node]
            system = card.integer(1, "coordinate system", self.default_system(1))
            coordinates = [card.real(place, "coordinate") for place in (2, 3, 4)]
            self.places[node] = self.systems.place(card, system, coordinates)
        return self.places[node]

    def default_system(self, place: int) -> int:
        """The coordinate system of nodes that name none: for coordinates (place 1) or directions (place 5)."""
        return self.node_defaults.integer(place, "coordinate system", 0) if self.node_defaults else 0

    def read_line(self, card: Card) -> None:
        element = card.integer(0, "element number")
        if element in self.elements or element < 1:
            card.fail(f"element {element} is defined twice" if element > 0 else "numbers begin at 1")
        first = 1 if card.name == "CONROD" else 2
        ends = [card.integer(first + end, "node") for end in (0, 1)]
        self.elements[element] = (card, ends)
        if card.name in WITH_DIRECTION:
            for what, places in zip(self.not_kept, ((8, 9), range(10, 16))):
                if any(card.field(place) and card.real(place, "number") != 0.0 for place in places):
                    self.not_kept[what].append(element)

    def find_property(self, card: Card) -> str:
        """The number of the property that a line has: its own, that of BAROR, or the element's."""
        default = self.defaults.get(card.name)
        number = default.integer(1, "property", card.integer(0, "element number")) if default else None
        return str(card.integer(1, "property", card.integer(0, "element number") if number is None else number))

    def find_height(self, card: Card, ends: list[int]) -> Floats:
        """The vector in the plane of a bar's height [3]; NaN where the deck gives none."""
        source = card if any(card.field(place) for place in (4, 5, 6)) else self.defaults.get(card.name)
        if card.name not in WITH_DIRECTION or source is None:
            return np.full(3, np.nan)
        begin = self.find_node(card, ends[0])
        text = source.field(4)
        if text.isdecimal() and not source.field(5) and not source.field(6):
            return self.find_node(source, source.integer(4, "node")) - begin
        vector = [source.real(place, "number") for place in (4, 5, 6)]
        default = self.defaults.get(card.name)
        frames = card.field(7) or (default.field(7) if default else "")  # OFFT: of the orientation, and of both offsets
        if frames[:1].upper() == "B":  # the basic system
            return np.array(vector)
        system = self.nodes[ends[0]].integer(5, "coordinate system", self.default_system(5))
        return self.systems.turn(card, max(system, 0), vector, begin)

    def make_mesh(self) -> LineMesh:
        """The mesh of all cards."""
        ids = sorted(self.nodes)
        number = {node: place for place, node in enumerate(ids)}
        for element, (card, ends) in self.elements.items():
            for node in ends:
                if node not in number:
                    card.fail(f"element {element} names node {node}, which is not there: truncated?")
        element_number = {element: place for place, element in enumerate(self.elements)}
        by_property: dict[str, list[int]] = {}
        for element, (card, _) in self.elements.items():
            if card.name != "CONROD":
                by_property.setdefault(f"property_{self.find_property(card)}", []).append(element)
        sections, section_of = self.read_sections()
        materials = self.read_materials()
        positions = [self.find_node(card, node) for node, card in sorted(self.nodes.items())]
        return LineMesh(
            path=self.path,
            format="Nastran deck",
            node_ids=np.array(ids, dtype=int),
            positions=np.array(positions, dtype=float).reshape(-1, 3),
            line_ids=np.array(list(self.elements), dtype=int),
            lines=np.array([[number[node] for node in ends] for _, ends in self.elements.values()], dtype=int)
            .reshape(-1, 2),
            element_sets=pick_members(by_property, element_number),
            node_sets=pick_members(self.pick_node_sets(number), number),
            section_sets=tuple(by_property),
            left_behind=self.list_left_behind(),
            sections=sections,
            section_of=section_of,
            heights=np.array([self.find_height(*one) for one in self.elements.values()]).reshape(-1, 3),
            materials=materials,
            point_masses=[nastran_sections.read_mass(card, number, self.find_node) for card in self.masses.values()],
        )  # fmt: skip

    def read_sections(self) -> tuple[list[Section], np.ndarray]:
        """The sections that lines have, and the number of each line's section, -1 without one."""
        numbers: dict[str, int] = {}
        sections: list[Section] = []
        section_of = np.full(len(self.elements), -1)
        for place, (card, _) in enumerate(self.elements.values()):
            if card.name == "CONROD":
                sections.append(nastran_sections.read_rod_section(card))
                section_of[place] = len(sections) - 1
                continue
            name = self.find_property(card)
            if name in self.properties and name not in numbers:
                numbers[name] = len(sections)
                sections.append(nastran_sections.read_section(self.properties[name]))
            section_of[place] = numbers.get(name, -1)
        return sections, section_of

    def read_materials(self) -> dict[str, Material]:
        """The materials by their names. What is left out of them is noted."""
        materials = {}
        for name, card in self.materials.items():
            materials[name], left_out = nastran_sections.read_material(card)
            self.left_behind += left_out
        return materials

    def pick_node_sets(self, number: dict[int, int]) -> dict[str, list[int]]:
        """The sets that are sets of nodes; a SET1 may hold numbers of anything."""
        kept = {}
        for name, members in self.node_sets.items():
            if all(member in number for member in members):
                kept[name] = members
            else:
                self.left_behind.append(f"SET1 '{name}': not all its members are nodes")
        return kept

    def list_left_behind(self) -> list[str]:
        """What the deck holds and the mesh does not, a text each."""
        kinds: dict[str, int] = {}
        for card, _ in self.elements.values():
            kinds[card.name] = kinds.get(card.name, 0) + 1
        texts = [
            f"beam kind {name} of {count} elements ({KINDS[name]} in Nastran): the design's 'theory' decides"
            for name, count in kinds.items()
        ]
        texts += [f"{what} of elements {shorten(found)}" for what, found in self.not_kept.items() if found]
        texts += [
            f"{what} of {name} {shorten(filter(None, found))}".rstrip()
            for (name, what), found in self.not_taken.items()
        ]
        texts += [f"{name} {shorten(filter(None, found))}".rstrip() for name, found in self.others.items()]
        return texts + self.left_behind


def divide(card: Card) -> list[Card]:
    """The card itself; two of a CROD or CTUBE with a second element in its second half."""
    if card.name not in WITH_PROPERTY or not any(card.fields[4:8]):
        return [card]
    first = card._replace(fields=[*card.fields[:4], *[""] * 4, *card.fields[8:]])
    return [first, card._replace(fields=card.fields[4:8])]


def multiply_masses(mesh: LineMesh, factor: float) -> None:
    """Multiplies every density, mass per length and point mass, as PARAM,WTMASS does."""
    for name, material in mesh.materials.items():
        if material.density is not None:
            mesh.materials[name] = material._replace(density=factor * material.density)
    mesh.sections = [one._replace(extra_mass=factor * one.extra_mass) for one in mesh.sections]
    mesh.point_masses = [
        one._replace(mass=factor * one.mass, inertia=None if one.inertia is None else factor * one.inertia)
        for one in mesh.point_masses
    ]


def read_members(card: Card) -> Iterator[int]:
    """Yields the numbers of a SET1 card: single ones, or FIRST THRU LAST."""
    texts = [text.upper() for text in card.fields[1:] if text]
    place = 0
    while place < len(texts):
        first = read_member(card, texts[place])
        if texts[place + 1 : place + 2] == ["THRU"] and place + 2 < len(texts):
            members = range(first, read_member(card, texts[place + 2]) + 1)
            if not 0 < len(members) <= MOST_MEMBERS:
                card.fail(f"'{texts[place]} THRU {texts[place + 2]}' is not a range of 1 to {MOST_MEMBERS} numbers")
            yield from members
            place += 3
            continue
        yield first
        place += 1


def read_member(card: Card, text: str) -> int:
    """The number of a node in a SET1 card."""
    digits = text.lstrip("0") or "0"
    if not (text.isascii() and text.isdecimal()) or len(digits) > len(str(LARGEST_NUMBER)):
        card.fail(f"'{text}' is not a node's number, 0 to {LARGEST_NUMBER}")
    return int(digits)
