"""The instances of an Abaqus deck's parts, moved to their places, with numbers and sets of their own."""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.abaqus_blocks import Block, Place, check_rows, read_integer, read_reals
from sprung_tools.mesh_import.abaqus_part import Part, SetTable
from sprung_tools.mesh_import.line_mesh import LARGEST_NUMBER

IN_ASSEMBLY = "Assembly."  # prefix of the name of an assembly's set where the part has a set of that name


class Instance(NamedTuple):
    """A part in its place: x → rotation x + translation. Its numbers are the part's plus an offset."""

    name: str
    part: Part
    rotation: Floats  # 3×3
    translation: Floats  # 3
    nodes: int  # offset of the nodes' numbers
    elements: int  # offset of the elements' numbers

    def find_sets(self, kind: str) -> SetTable:
        """Its part's sets of nodes (kind: N) or elements (E)."""
        return self.part.node_sets if kind == "N" else self.part.element_sets


def read_placement(block: Block) -> tuple[Floats, Floats]:
    """The rotation and the translation that an *INSTANCE gives: a translation, then a turn about the line through two
    points by an angle in degrees. A blank field is 0, and blank lines at the end are nothing."""
    check_rows(block, 2, "of its translation and of its rotation")
    first, turn = read_reals(block, 0, 3, "its translation"), read_reals(block, 1, 7, "its rotation")
    translation = np.array(first + [0.0] * (3 - len(first)))
    if not turn:
        return np.eye(3), translation
    if len(block.data[1][1]) < 7:
        block.fail("turns its part by two points and an angle, which are seven numbers", block.data[1][0])
    turn += [0.0] * (7 - len(turn))
    begin, end, angle = np.array(turn[:3]), np.array(turn[3:6]), math.radians(turn[6])
    length = np.linalg.norm(end - begin)
    if not length > 0.0:
        block.fail("turns its part about a line through one point", block.data[1][0])
    x, y, z = (end - begin) / length
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    return rotation, rotation @ (translation - begin) + begin


class Assembly(Part):
    """The assembly: its own nodes, elements and sets (those of a deck without parts), and the instances."""

    def __init__(self) -> None:
        super().__init__()
        self.instances: dict[str, Instance] = {}  # name in capitals → instance
        self.offsets = {"N": 0, "E": 0}  # of the numbers of its own nodes and elements

    def place(self, block: Block, part: Part) -> None:
        """Adds an instance of a part."""
        name = block.parameters.get("NAME", "") or part.name
        if name.upper() in self.instances:
            block.fail(f"a second instance of the name '{name}'")
        nodes = find_offset(block, self.nodes, part.nodes)
        elements = find_offset(block, self.elements, part.elements)
        one = Instance(name, part, *read_placement(block), nodes, elements)
        self.instances[name.upper()] = one
        is_moved = bool(block.data)
        for node, position in part.nodes.items():
            if is_moved:
                x, y, z = (one.rotation @ position + one.translation).tolist()
                position = (x, y, z)
            self.nodes[node + one.nodes] = position
        for number, element in part.elements.items():
            self.elements[number + one.elements] = element._replace(
                nodes=[node + one.nodes for node in element.nodes],
                orientation=None if element.orientation is None else element.orientation + one.nodes,
            )
        for kind, offset in (("N", one.nodes), ("E", one.elements)):
            self.normals[kind].update(number + offset for number in part.normals[kind])
        self.offsets = {"N": find_offset(block, self.nodes, ()), "E": find_offset(block, self.elements, ())}

    def read(self, block: Block) -> None:
        """Takes in a block of the assembly's own, when all instances are placed."""
        if self.instances and block.keyword in ("NFILL", "ELGEN"):
            block.fail("is not followed beside instances; write the nodes or elements out")
        super().read(block)

    def read_own_number(self, block: Block, line: Place, text: str, kind: str) -> int:
        number = super().read_own_number(block, line, text, kind) + self.offsets[kind]
        if number > LARGEST_NUMBER:
            block.fail(f"'{text}' would become {number}, but numbers end at {LARGEST_NUMBER}", line)
        return number

    def find_number(self, block: Block, line: Place, text: str, kind: str) -> int:
        """The number of a node or an element in the assembly: INSTANCE.27, or 27 where the block names the instance;
        else the assembly's own."""
        name, _, number = text.rpartition(".")
        one = self.find_instance(block, name or block.parameters.get("INSTANCE", ""), line)
        if one is None:
            return self.read_own_number(block, line, text, kind)
        found = read_integer(block, line, number)
        if found not in (one.part.nodes.keys() if kind == "N" else one.part.elements.keys()):
            block.fail(f"{one.name} has no {'node' if kind == 'N' else 'element'} {found}", line)
        return found + (one.nodes if kind == "N" else one.elements)

    def find_instance(self, block: Block, name: str, line: Place | None) -> Instance | None:
        """The instance of a name; None for an empty one. InputError if it is not there."""
        if not name:
            return None
        if name.upper() not in self.instances:
            block.fail(f"names the instance '{name}', which is not there", line)
        return self.instances[name.upper()]

    def find_owner(
        self, block: Block, sets: SetTable, kind: str, name: str, line: Place | None = None
    ) -> tuple[Instance | None, str]:
        """Who has the set that a text names, None for the assembly itself, and its name there: the instance that the
        block names, else the assembly, else an instance, named by INSTANCE.SET; a single instance by SET alone."""
        named = self.find_instance(block, block.parameters.get("INSTANCE", ""), line)
        if find_in_instance(named, kind, name) is not None:
            return named, name
        if sets.find(name) is not None:
            return None, name
        instance, _, rest = name.rpartition(".")
        named = self.instances.get(instance.upper())
        if find_in_instance(named, kind, rest) is not None:
            return named, rest
        if len(self.instances) == 1:
            (named,) = self.instances.values()
            if find_in_instance(named, kind, name) is not None:
                return named, name
        block.fail(f"names the set '{name}', which is not there", line)

    def find_members(self, block: Block, sets: SetTable, kind: str, name: str, line: Place | None = None) -> list[int]:
        """The members of the set that a text names."""
        owner, own = self.find_owner(block, sets, kind, name, line)
        return (sets.find(own) if owner is None else find_in_instance(owner, kind, own)) or []

    def name_set_of(self, owner: Instance | None, kind: str, name: str) -> str:
        """The name that a set gets: INSTANCE.SET if there are several instances. An assembly's set whose name an
        instance's has gets a prefix."""
        if owner is not None:
            return name if len(self.instances) == 1 else f"{owner.name}.{name}"
        is_theirs = any(
            find_in_instance(one, kind, own) is not None and self.name_set_of(one, kind, own).upper() == name.upper()
            for one in self.instances.values()
            for own in (name, name[len(one.name) + 1 :])
        )
        return IN_ASSEMBLY + name if is_theirs else name

    def name_sets(self, kind: str) -> dict[str, list[int]]:
        """All sets by the names that they get: those of instances, then the assembly's."""
        named: dict[str, list[int]] = {}
        for one in self.instances.values():
            for name, _ in one.find_sets(kind).items():
                named[self.name_set_of(one, kind, name)] = find_in_instance(one, kind, name) or []
        for name, members in (self.node_sets if kind == "N" else self.element_sets).items():
            named[self.name_set_of(None, kind, name)] = members
        return named


def find_in_instance(one: Instance | None, kind: str, name: str) -> list[int] | None:
    """The members of an instance's set, by their numbers in the assembly; None if there is no such set."""
    members = None if one is None else one.find_sets(kind).find(name)
    if one is None or members is None:
        return None
    return [member + (one.nodes if kind == "N" else one.elements) for member in members]


def find_offset(block: Block, there: Iterable[int], new: Iterable[int]) -> int:
    """An offset that keeps an instance's numbers apart from those that are there: a multiple of a power of ten."""
    largest, own = max(there, default=0), max(new, default=0)
    step = 10 ** max(3, len(str(own)))
    offset = math.ceil(largest / step) * step
    if offset + own > LARGEST_NUMBER:
        block.fail(f"its numbers would end beyond {LARGEST_NUMBER}")
    return offset
