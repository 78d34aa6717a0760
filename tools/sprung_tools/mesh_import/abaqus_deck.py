"""Reading the frame in an Abaqus input deck.

meshio's own reader is not used: in version 5.0 it keeps the last *NODE block alone, gives an element set to the wrong
block when an earlier *ELEMENT has no ELSET, leaves node sets of set names empty, and does not report what else the deck
holds. tests/tools/mesh_reading_test.py compares both readers where meshio's is right.
"""

import re
from collections.abc import Container, Sequence

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.abaqus_blocks import Block, join_rows, read_blocks, read_integer, read_real
from sprung_tools.mesh_import.line_mesh import MOST_MEMBERS, LineMesh, pick_members

IdSets = dict[str, list[int]]  # name → ids, in order

TWO_NODES = re.compile(r"(B2[13]H?|B3[13](H|OS|OSH)?|T[23]D2[HTE]*|PIPE[23]1H?|FRAME[23]D)$")
THREE_NODES = re.compile(r"(B[23]2(H|OS|OSH)?|T[23]D3[HTE]*|PIPE[23]2H?)$")
KINDS = {  # how a beam of that type deforms in Abaqus
    "B21": "shear-flexible", "B31": "shear-flexible", "PIPE21": "shear-flexible", "PIPE31": "shear-flexible",
    "B23": "cubic, without shear", "B33": "cubic, without shear", "T2D2": "axial alone", "T3D2": "axial alone",
}  # fmt: skip
IN_ASSEMBLY = "Assembly."  # prefix of the name of an assembly's set where the part has a set of that name
GENERATING = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"}
SILENT = {"HEADING", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "INSTANCE", "END INSTANCE", "END STEP"}


def read_abaqus(path: str) -> LineMesh:
    """Reads the line elements of a deck. InputError at the line of the fault."""
    deck = Deck(path)
    blocks = read_blocks(path)
    if not any(block.keyword in ("NODE", "ELEMENT") for block in blocks):
        raise InputError(f"{path}: error: has no *NODE and no *ELEMENT: not an Abaqus deck, or truncated")
    check_structure(blocks, path)
    for block in blocks:
        deck.read(block)
    return deck.make_mesh()


def check_structure(blocks: Sequence[Block], path: str) -> None:
    """Throws InputError for what would give nodes other positions or numbers than those written in the deck."""
    for opening in ("PART", "ASSEMBLY", "STEP", "INSTANCE"):
        begun = [block for block in blocks if block.keyword == opening]
        ended = sum(block.keyword == f"END {opening}" for block in blocks)
        if len(begun) > ended:
            begun[-1].fail(f"no *END {opening} follows: the file is truncated")
        if opening in ("PART", "INSTANCE") and len(begun) > 1:
            begun[1].fail(f"a second {opening.lower()}, expected one; write a flat deck")
        if opening == "INSTANCE" and begun and begun[0].data:
            begun[0].fail("moves its part, which is not followed; write a flat deck")
    for block in blocks:
        if block.keyword in GENERATING:
            block.fail("is not followed, and nodes or elements would be missing or misplaced; write them out")
        if block.keyword in ("NODE", "ELEMENT", "NSET", "ELSET") and "INPUT" in block.parameters:
            block.fail("has its data in another file (INPUT=…), which is not followed; take it in by *INCLUDE")
        if block.keyword == "NODE" and block.parameters.get("SYSTEM", "R").upper() != "R":
            block.fail("is not in rectangular coordinates")


class Deck:
    """The deck as far as it has been read."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.nodes: dict[int, tuple[float, ...]] = {}  # id → position
        self.elements: dict[
            int, tuple[int, list[int], Block]
        ] = {}  # id of a line element → (line, node ids, its block)
        self.node_sets: IdSets = {}
        self.element_sets: IdSets = {}
        self.spelling: dict[tuple[str, str], str] = {}  # ("N" or "E", name in capitals) → name as first written
        self.section_sets: list[str] = []
        self.other_ids: set[int] = set()  # of elements that are not lines
        self.num_others: dict[str, int] = {}  # type of elements that are not lines → number of them
        self.num_lines: dict[str, int] = {}  # type of line elements → number of them
        self.nodes_of: list[tuple[str, str]] = []  # (node set, element set whose nodes belong to it)
        self.instance = ""  # the one instance's name in capitals; it may stand before numbers and names of sets
        self.sets_of_part: set[
            tuple[str, str]
        ] | None = None  # within the assembly: the part's sets, keyed as in spelling
        self.num_directions = 0  # line elements with an orientation node
        self.left_behind: list[str] = []

    def read(self, block: Block) -> None:
        readers = {"NODE": self.read_nodes, "ELEMENT": self.read_elements}
        readers |= {"NSET": self.read_node_set, "ELSET": self.read_element_set}
        if block.keyword in readers:
            readers[block.keyword](block)
            return
        if "SECTION" in block.keyword and block.parameters.get("ELSET"):
            self.section_sets.append(self.name("E", block.parameters["ELSET"]))
        if block.keyword == "ASSEMBLY":
            self.sets_of_part = set(self.spelling)
        elif block.keyword == "INSTANCE":
            self.instance = block.parameters.get("NAME", "").upper()
        elif block.keyword == "END ASSEMBLY":
            self.sets_of_part = None
        if block.keyword not in SILENT:
            self.left_behind.append(block.describe())

    def name(self, kind: str, text: str) -> str:
        """A set's name as it was first written: in Abaqus, capitals and small letters are the same."""
        return self.spelling.setdefault((kind, text.upper()), text)

    def read_nodes(self, block: Block) -> None:
        ids: list[int] = []
        for line, fields in block.data:
            node = read_integer(block, line, fields[0])
            place = [read_real(block, line, text) for text in fields[1:4] if text]
            if len(place) < 2 or node < 1:
                block.fail(f"node {node} has {len(place)} coordinates, expected 2 or 3: truncated?", line)
            if self.nodes.setdefault(node, (*place, 0.0)[:3]) != (*place, 0.0)[:3] or node in ids[-1:]:
                block.fail(f"node {node} is defined twice", line)
            ids.append(node)
        if block.parameters.get("NSET"):
            self.node_sets.setdefault(self.name("N", block.parameters["NSET"]), []).extend(ids)

    def read_elements(self, block: Block) -> None:
        kind = block.parameters.get("TYPE", "").upper()
        if THREE_NODES.match(kind):
            block.fail(f"{kind} is a line with a middle node, expected two-node lines")
        rows = join_rows(block)
        if not TWO_NODES.match(kind):
            self.num_others[kind or "?"] = self.num_others.get(kind or "?", 0) + len(rows)
            self.other_ids.update(row[0] for _, row in rows)
            return
        for line, row in rows:
            if len(row) not in (3, 4):
                found = f"a {kind} has {len(row) - 1} nodes, expected 2 (and an orientation node)"
                block.fail(f"{found}: truncated?", line)
            if row[0] in self.elements or row[0] < 1:
                block.fail(f"element {row[0]} is defined twice" if row[0] > 0 else "numbers begin at 1", line)
            self.num_directions += len(row) == 4
            self.elements[row[0]] = (line, row[1:3], block)
        self.num_lines[kind] = self.num_lines.get(kind, 0) + len(rows)
        if block.parameters.get("ELSET"):
            ids = [row[0] for _, row in rows]
            self.element_sets.setdefault(self.name("E", block.parameters["ELSET"]), []).extend(ids)

    def read_node_set(self, block: Block) -> None:
        members = self.read_set(block, "N", self.node_sets)
        name = self.set_name(block, "N")
        self.node_sets.setdefault(name, []).extend(members)
        if block.parameters.get("ELSET"):
            self.nodes_of.append((name, self.find_set(block, "E", block.parameters["ELSET"], self.element_sets)))

    def read_element_set(self, block: Block) -> None:
        members = self.read_set(block, "E", self.element_sets)
        self.element_sets.setdefault(self.set_name(block, "E"), []).extend(members)

    def set_name(self, block: Block, kind: str) -> str:
        """The name of the set that a block defines. A set of the assembly and one of its part may have the same name;
        then the assembly's gets a prefix."""
        key = {"N": "NSET", "E": "ELSET"}[kind]
        text = block.parameters.get(key, "")
        if not text:
            block.fail(f"has no name ({key}=…)")
        if self.sets_of_part is not None and (kind, text.upper()) in self.sets_of_part:
            text = IN_ASSEMBLY + text
        return self.name(kind, text)

    def find_set(self, block: Block, kind: str, text: str, sets: IdSets, line: int | None = None) -> str:
        """The name of the set that a text refers to: the assembly's if it has one, else the part's."""
        for candidate in (IN_ASSEMBLY + text, self.without_instance(text)):
            name = self.spelling.get((kind, candidate.upper()))
            if (
                name is not None
                and name in sets
                and (self.sets_of_part is not None or not candidate.startswith(IN_ASSEMBLY))
            ):
                return name
        block.fail(f"names the set '{text}', which is not there", line)

    def without_instance(self, text: str) -> str:
        """The text without the instance's name: PART-1-1.27 → 27 where PART-1-1 is the instance."""
        instance, _, rest = text.rpartition(".")
        return rest if instance and instance.upper() == self.instance else text

    def read_set(self, block: Block, kind: str, sets: IdSets) -> list[int]:
        members: list[int] = []
        for line, fields in block.data:
            fields = [text for text in fields if text]
            if "GENERATE" in block.parameters:
                row = [read_integer(block, line, text) for text in fields]
                if len(row) not in (2, 3) or row[1] < row[0] or (len(row) == 3 and row[2] < 1):
                    block.fail("GENERATE expects first, last and an increment > 0", line)
                generated = range(row[0], row[1] + 1, row[2] if len(row) == 3 else 1)
                if len(members) + len(generated) > MOST_MEMBERS:
                    block.fail(f"generates more than {MOST_MEMBERS} members", line)
                members += generated
                continue
            for text in fields:
                plain = self.without_instance(text)
                if plain.isdecimal():
                    members.append(int(plain))
                else:
                    members += sets[self.find_set(block, kind, text, sets, line)]
        return members

    def make_mesh(self) -> LineMesh:
        ids = sorted(self.nodes)
        number = {node: place for place, node in enumerate(ids)}
        lines = np.zeros((len(self.elements), 2), dtype=int)
        for place, (element, (line, ends, block)) in enumerate(self.elements.items()):
            for end in (0, 1):
                if ends[end] not in number:
                    block.fail(f"element {element} names node {ends[end]}, which is not there", line)
                lines[place, end] = number[ends[end]]
        element_number = {element: place for place, element in enumerate(self.elements)}
        self.check_members(self.element_sets, {*element_number, *self.other_ids}, "element")
        for name, elements in self.nodes_of:
            for element in self.element_sets[elements]:
                if element in self.elements:
                    self.node_sets[name] += self.elements[element][1]
        self.check_members(self.node_sets, number, "node")
        return LineMesh(
            path=self.path,
            format="Abaqus deck",
            node_ids=np.array(ids, dtype=int),
            positions=np.array([self.nodes[node] for node in ids], dtype=float).reshape(-1, 3),
            line_ids=np.array(list(self.elements), dtype=int),
            lines=lines,
            element_sets=pick_members(self.element_sets, element_number),
            node_sets=pick_members(self.node_sets, number),
            section_sets=tuple(self.section_sets),
            left_behind=self.list_left_behind(),
        )

    def check_members(self, sets: IdSets, there: Container[int], what: str) -> None:
        """Throws InputError if a set names a node or an element that is not there."""
        for name, members in sets.items():
            for member in members:
                if member not in there:
                    raise InputError(
                        f"{self.path}: error: the set '{name}' names {what} {member}, which is not there: truncated?"
                    )

    def list_left_behind(self) -> list[str]:
        """What the deck holds and the mesh does not, a text each."""
        texts = [f"{count} elements of type {kind}, which are not lines" for kind, count in self.num_others.items()]
        for kind, count in self.num_lines.items():
            meaning = KINDS.get(kind.rstrip("H"), "")
            texts.append(
                f"beam kind {kind} of {count} elements{' (' + meaning + ' in Abaqus)' if meaning else ''}: "
                "the design's 'theory' decides"
            )
        if self.num_directions:
            texts.append(f"orientation nodes of {self.num_directions} elements")
        return texts + self.left_behind
