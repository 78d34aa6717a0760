"""A part of an Abaqus deck: its nodes, elements and sets, and what gives sections and masses to its sets.

A deck without parts is one part; the assembly is one, too, in which the instances of the others stand.
"""

import math
import re
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from sprung_tools.mesh_import.abaqus_axes import GLOBAL, read_axes
from sprung_tools.mesh_import.abaqus_blocks import Block, Place, join_rows, read_integer, read_real
from sprung_tools.mesh_import.line_mesh import MOST_MEMBERS

TWO_NODES = re.compile(r"(B2[13]H?|B3[13](R|H|OS|OSH)?|T[23]D2[HTE]*|PIPE[23]1H?|FRAME[23]D|U1)$")
THREE_NODES = re.compile(r"(B[23]2(R|H|OS|OSH)?|T[23]D3[HTE]*|PIPE[23]2H?)$")
PLANAR = re.compile(r"(B2[123]H?|PIPE2[12]H?)$")
IN_NAME = re.compile(r"(?:C3D|CAX|CP[ES]|M3D|R3D|SC?)(\d+)")  # solids, membranes, rigid bodies, shells: nodes
NODES = {  # of elements of other types, which may go on in the next line until they have as many
    "CONN2D2": 2, "CONN3D2": 2, "DASHPOT1": 1, "DASHPOT2": 2, "DASHPOTA": 2, "GAPUNI": 2, "HEATCAP": 1, "JOINTC": 2,
    "MASS": 1, "ROTARYI": 1, "SPRING1": 1, "SPRING2": 2, "SPRINGA": 2,
}  # fmt: skip
GENERATING = {"NCOPY", "NMAP", "ELCOPY"}
GENERATORS = {"NGEN", "NFILL", "ELGEN"}
MESHING = {"NODE", "ELEMENT", "NSET", "ELSET", "SYSTEM", "NORMAL"} | GENERATORS
SAME_PLACE = 1e-9  # relative to the length of the line on which nodes are generated


class Element(NamedTuple):
    """An element; of lines two or three nodes from end to end, and the orientation node."""

    kind: str
    nodes: list[int]
    orientation: int | None
    block: Block
    line: Place

    @property
    def is_line(self) -> bool:
        """Whether it is a line."""
        return is_line_kind(self.kind)


def is_line_kind(kind: str) -> bool:
    """Whether elements of a type are lines."""
    return bool(TWO_NODES.match(kind) or THREE_NODES.match(kind))


def count_nodes(kind: str) -> int | None:
    """The number of nodes that elements of a type have, without orientation nodes; None if it is not known."""
    if is_line_kind(kind):
        return 3 if THREE_NODES.match(kind) else 2
    found = IN_NAME.match(kind)
    return int(found[1]) if found else NODES.get(kind)


class SetTable:
    """Sets by their names; in Abaqus, capitals and small letters are the same."""

    def __init__(self) -> None:
        self._sets: dict[str, tuple[str, dict[int, None]]] = {}  # capitals → (name, members in their order)

    def add(self, name: str, members: Iterable[int]) -> None:
        """Adds members to a set, which is new or not. It holds each once."""
        self._sets.setdefault(name.upper(), (name, {}))[1].update(dict.fromkeys(members))

    def find(self, name: str) -> list[int] | None:
        """The members of a set; None if there is no such set."""
        found = self._sets.get(name.upper())
        return list(found[1]) if found else None

    def items(self) -> Iterable[tuple[str, list[int]]]:
        """(name as first written, members) of all sets."""
        return [(name, list(members)) for name, members in self._sets.values()]


class Part:
    """A part as far as it has been read."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.nodes: dict[int, tuple[float, float, float]] = {}
        self.elements: dict[int, Element] = {}
        self.node_sets = SetTable()
        self.element_sets = SetTable()
        self.axes = GLOBAL  # of the nodes that are read
        # What has normals of its own, which turn the sections of beams: nodes and elements.
        self.normals: dict[str, set[int]] = {"N": set(), "E": set()}
        self.used: list[tuple[Block, str]] = []  # blocks that give something to an element set, and its name

    def read(self, block: Block) -> None:
        """Takes in a block of MESHING."""
        if "INPUT" in block.parameters:
            block.fail("has its data in another file (INPUT=…), which is not followed; take it in by *INCLUDE")
        readers = {
            "NODE": self.read_nodes, "ELEMENT": self.read_elements, "NSET": self.read_node_set,
            "ELSET": self.read_element_set, "SYSTEM": self.read_system, "NGEN": self.generate_nodes,
            "NFILL": self.fill_nodes, "ELGEN": self.generate_elements, "NORMAL": self.read_normals,
        }  # fmt: skip
        readers[block.keyword](block)

    def add_node(self, block: Block, line: Place, node: int, place: tuple[float, float, float]) -> None:
        """Adds a node. InputError if there is another one of its number."""
        if self.nodes.setdefault(node, place) != place:
            block.fail(f"node {node} is defined twice", line)

    def read_nodes(self, block: Block) -> None:
        kind = block.parameters.get("SYSTEM", "R").upper()
        if kind not in ("R", "C"):
            block.fail("is neither in rectangular nor in cylindrical coordinates")
        ids: list[int] = []
        for line, fields in block.data:
            node = self.read_own_number(block, line, fields[0], "N")
            place = [read_real(block, line, text) if text else 0.0 for text in fields[1:4]]
            if len(fields) == 1:
                block.fail(f"node {node} has no coordinates: truncated?", line)
            if any([read_real(block, line, text) for text in fields[4:7] if text]):
                self.normals["N"].add(node)
            if node in ids[-1:]:
                block.fail(f"node {node} is defined twice", line)
            x, y, z = (*place, 0.0, 0.0)[:3]
            if kind == "C":
                x, y = x * math.cos(math.radians(y)), x * math.sin(math.radians(y))
            self.add_node(block, line, node, self.axes.place(x, y, z))
            ids.append(node)
        if block.parameters.get("NSET"):
            self.node_sets.add(block.parameters["NSET"], ids)

    def read_system(self, block: Block) -> None:
        self.axes = read_axes(block)

    def read_normals(self, block: Block) -> None:
        """*NORMAL: an element or a set of them, a node or a set of them, and the normal."""
        if block.parameters.get("TYPE", "ELEMENT").upper().startswith("C"):
            return  # of surfaces that touch
        for line, fields in block.data:
            if fields[0]:
                self.normals["E"].update(self.find_named(block, self.element_sets, "E", fields[0], line))

    def read_elements(self, block: Block) -> None:
        kind = block.parameters.get("TYPE", "").upper()
        count, is_line = count_nodes(kind), is_line_kind(kind)

        def find_number(line: Place, text: str, is_own: bool) -> int:
            if is_own:
                return self.read_own_number(block, line, text, "E")
            if not text and not is_line:
                return 0  # a connector's node on the ground
            return self.find_number(block, line, text, "N")

        rows = join_rows(block, None if count is None else count + 1, find_number)
        for line, (element, *nodes) in rows:
            orientation = None
            if is_line and count is not None:
                if len(nodes) not in (count, count + 1):
                    found = f"a {kind} has {len(nodes)} nodes, expected {count} (and an orientation node)"
                    block.fail(f"{found}: truncated?", line)
                nodes, orientation = nodes[:count], (*nodes[count:], None)[0]
            self.add_element(element, Element(kind, [node for node in nodes if node], orientation, block, line))
        if block.parameters.get("ELSET"):
            self.element_sets.add(block.parameters["ELSET"], [row[0] for _, row in rows])

    def add_element(self, number: int, element: Element) -> None:
        """Adds an element. InputError if there is one of its number."""
        if self.elements.setdefault(number, element) is not element:
            element.block.fail(f"element {number} is defined twice", element.line)

    def read_node_set(self, block: Block) -> None:
        members = self.read_members(block, self.node_sets, "N")
        name = block.parameters.get("ELSET")
        if name:
            elements = self.find_members(block, self.element_sets, "E", name)
            members += [node for one in elements if one in self.elements for node in self.elements[one].nodes]
        self.node_sets.add(self.name_set(block), members)

    def read_element_set(self, block: Block) -> None:
        members = self.read_members(block, self.element_sets, "E")
        self.element_sets.add(self.name_set(block), members)

    def name_set(self, block: Block) -> str:
        """The name of the set that a block defines."""
        name = block.parameters.get(block.keyword, "")
        if not name:
            block.fail(f"has no name ({block.keyword}=…)")
        return name

    def read_members(self, block: Block, sets: SetTable, kind: str) -> list[int]:
        """The members that the data lines of a set name: numbers, ranges, other sets."""
        members: list[int] = []
        for line, fields in block.data:
            if "GENERATE" in block.parameters:
                fields = [*fields, "", ""]
                first, last = (self.find_number(block, line, text, kind) for text in fields[:2])
                step = read_integer(block, line, fields[2], 1)
                if last < first or step < 1:
                    block.fail("GENERATE expects first, last and an increment > 0", line)
                generated = range(first, last + 1, step)
                if len(members) + len(generated) > MOST_MEMBERS:
                    block.fail(f"generates more than {MOST_MEMBERS} members", line)
                members += generated
                continue
            for text in filter(None, fields):
                members += self.find_named(block, sets, kind, text, line)
        return members

    def find_named(self, block: Block, sets: SetTable, kind: str, text: str, line: Place) -> list[int]:
        """What a text names: a node or an element by its number, or those of a set."""
        if text.rpartition(".")[2].lstrip("+-").isdecimal():
            return [self.find_number(block, line, text, kind)]
        return self.find_members(block, sets, kind, text, line)

    def read_own_number(self, block: Block, line: Place, text: str, kind: str) -> int:
        """The number of a node (kind: N) or an element (E) of the part."""
        number = read_integer(block, line, text)
        if number < 1:
            block.fail("numbers begin at 1", line)
        return number

    def find_number(self, block: Block, line: Place, text: str, kind: str) -> int:
        """The number that a text names. kind: N, E."""
        return self.read_own_number(block, line, text, kind)

    def find_members(self, block: Block, sets: SetTable, kind: str, name: str, line: Place | None = None) -> list[int]:
        """The members of the set that a text names. InputError if it is not there."""
        found = sets.find(name)
        if found is None:
            block.fail(f"names the set '{name}', which is not there", line)
        return found

    def generate_nodes(self, block: Block) -> None:
        """*NGEN on a straight line: first node, last node, increment of the numbers."""
        if block.parameters.get("LINE") or block.parameters.get("SYSTEM"):
            block.fail("along a curve is not followed; write the nodes out")
        ids: list[int] = []
        for line, fields in block.data:
            fields = [*fields, "", ""]
            first, last = (self.read_own_number(block, line, text, "N") for text in fields[:2])
            step = read_integer(block, line, fields[2], 1)
            ids += self.fill_between(block, line, first, last, step)
        if block.parameters.get("NSET"):
            self.node_sets.add(block.parameters["NSET"], ids)

    def fill_between(self, block: Block, line: Place, first: int, last: int, step: int) -> list[int]:
        """Adds equally spaced nodes between two. Returns the numbers of all, the ends included. InputError if a node of
        such a number is elsewhere."""
        for end in (first, last):
            if end not in self.nodes:
                block.fail(f"names node {end}, which is not there", line)
        if step == 0 or (last - first) % step or not 0 < (last - first) // step <= MOST_MEMBERS:
            block.fail(f"cannot go from node {first} to node {last} in steps of {step}", line)
        here, there = np.array(self.nodes[first]), np.array(self.nodes[last])
        numbers = list(range(first, last + (1 if step > 0 else -1), step))
        for k, node in enumerate(numbers[1:-1], start=1):
            share = k / (len(numbers) - 1)
            place = (1.0 - share) * here + share * there
            known = np.array(self.nodes.get(node, place))
            if not np.linalg.norm(known - place) <= SAME_PLACE * np.linalg.norm(there - here):
                block.fail(f"would put node {node} at another place than it has", line)
            x, y, z = known.tolist()
            self.add_node(block, line, node, (x, y, z))
        return numbers

    def fill_nodes(self, block: Block) -> None:
        """*NFILL without bias: two node sets, number of intervals between them, increment of the numbers."""
        if any(key in block.parameters for key in ("BIAS", "SINGULAR", "TWO STEP")):
            block.fail("with unequal intervals is not followed; write the nodes out")
        ids: list[int] = []
        for line, fields in block.data:
            if len(fields) < 4:
                block.fail("expects two node sets, a number of intervals and an increment", line)
            firsts, lasts = (self.find_members(block, self.node_sets, "N", name, line) for name in fields[:2])
            if len(firsts) != len(lasts):
                block.fail(f"joins a set of {len(firsts)} nodes and one of {len(lasts)}", line)
            intervals, step = (read_integer(block, line, text) for text in fields[2:4])
            for first, last in zip(firsts, lasts):
                if first + intervals * step != last:
                    block.fail(f"node {last} is not {intervals} times {step} after node {first}", line)
                ids += self.fill_between(block, line, first, last, step)
        if block.parameters.get("NSET"):
            self.node_sets.add(block.parameters["NSET"], ids)

    def generate_elements(self, block: Block) -> None:
        """*ELGEN: master element, then up to three times number, increment of nodes, increment of elements (1). The
        orientation node of a line stays the same unless ALL NODES is given."""
        turns = "ALL NODES" in block.parameters
        ids: list[int] = []
        for line, fields in block.data:
            master = read_integer(block, line, fields[0])
            rest = [read_integer(block, line, text, 1) for text in fields[1:]]
            if master not in self.elements:
                block.fail(f"names element {master}, which is not there", line)
            made = {master: self.elements[master]}
            for place in range(0, len(rest), 3):
                number, nodes, elements = (*rest[place : place + 3], 1, 1)[:3]
                if number > 1 and (nodes == 0 or elements == 0):
                    block.fail(f"generates {number} elements by an increment of 0", line)
                if not 1 <= number * len(made) <= MOST_MEMBERS:
                    block.fail(f"generates {number} elements in a row", line)
                row = made
                made = {
                    one + k * elements: shift(element, k * nodes, turns)
                    for k in range(number)
                    for one, element in row.items()
                }
                if len(made) < number * len(row):
                    block.fail("generates an element twice", line)
            if min(made) < 1:
                block.fail(f"generates element {min(made)}, but numbers begin at 1", line)
            for one, element in made.items():
                if one != master:
                    self.add_element(one, element)
            ids += made
        if block.parameters.get("ELSET"):
            self.element_sets.add(block.parameters["ELSET"], ids)


def shift(element: Element, step: int, turns: bool) -> Element:
    """An element whose nodes' numbers are larger by a step; turns: that of its orientation node, too."""
    orientation = element.orientation
    if turns and orientation is not None:
        orientation += step
    return element._replace(nodes=[node + step for node in element.nodes], orientation=orientation)
