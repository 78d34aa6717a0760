"""Reading the frame in an Abaqus input deck.

meshio's own reader is not used for it: in version 5.0 it keeps the last *NODE block alone, gives an element set to the
wrong block when an earlier *ELEMENT has no ELSET, leaves node sets of set names empty, and does not tell what else the
deck holds. tests/tools/mesh_reading_test.py compares the two where meshio's is right.
"""

import os
import re
from typing import NamedTuple

import numpy as np

from sprung_tools.mesh_import.line_mesh import LineMesh, MeshError, pick_members

TWO_NODES = re.compile(r"(B2[13]H?|B3[13](H|OS|OSH)?|T[23]D2[HTE]*|PIPE[23]1H?|FRAME[23]D)$")
THREE_NODES = re.compile(r"(B[23]2(H|OS|OSH)?|T[23]D3[HTE]*|PIPE[23]2H?)$")
KINDS = {  # what a beam of that type is in Abaqus
    "B21": "shear-flexible", "B31": "shear-flexible", "PIPE21": "shear-flexible", "PIPE31": "shear-flexible",
    "B23": "cubic, without shear", "B33": "cubic, without shear", "T2D2": "axial alone", "T3D2": "axial alone",
}  # fmt: skip
IN_ASSEMBLY = "Assembly."  # before the name of an assembly's set where the part has one of that name
GENERATING = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"}
SILENT = {"HEADING", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "INSTANCE", "END INSTANCE", "END STEP"}


class Block(NamedTuple):
    """A keyword line and the data lines under it."""

    keyword: str  # in capitals, without the asterisk
    parameters: dict  # in capitals → text, "" where there is none
    data: list  # (line number, list of fields)
    path: str
    line: int

    def fail(self, what, line=None):
        raise MeshError(f"{self.path}:{line or self.line}: error: *{self.keyword}: {what}")

    def describe(self):
        shown = [key if not text else f"{key}={text}" for key, text in self.parameters.items()]
        return f"*{', '.join([self.keyword, *shown])} (line {self.line})"


def read_blocks(path, including=()):
    """All blocks of a deck, those of *INCLUDE in their place. MeshError if it is not a whole deck.

    including: the files that include this one, each by the one before.
    """
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            text = file.read()
    except OSError as error:
        raise MeshError(f"{path}: error: cannot read the file ({error.strerror})") from error
    if text and not text.endswith("\n") and not text.rpartition("\n")[2].upper().startswith("*END"):
        number = text.count("\n") + 1
        raise MeshError(f"{path}:{number}: error: the last line has no line end: the file is truncated")
    blocks = []
    for number, line in join_lines(text.splitlines()):
        if line.startswith("*"):
            keyword, *parameters = [part.strip() for part in line[1:].split(",")]
            pairs = [part.partition("=") for part in parameters if part]
            named = {" ".join(key.upper().split()): value.strip().strip("\"'") for key, _, value in pairs}
            blocks.append(Block(" ".join(keyword.upper().split()), named, [], path, number))
        elif not blocks:
            raise MeshError(
                f"{path}:{number}: error: '{line[:40]}' stands before the first keyword: not an Abaqus deck"
            )
        else:
            blocks[-1].data.append((number, [part.strip().strip("\"'") for part in line.split(",")]))
    return [found for block in blocks for found in follow_include(block, (*including, path))]


def follow_include(block, including):
    if block.keyword != "INCLUDE":
        return [block]
    name = block.parameters.get("INPUT", "")
    if not name:
        block.fail("has no file (INPUT=…)")
    path = os.path.join(os.path.dirname(block.path), name)
    if any(os.path.realpath(path) == os.path.realpath(one) for one in including):
        block.fail(f"'{name}' includes itself")
    return read_blocks(path, including)


def join_lines(lines):
    """(number, text) without comments and blank lines; keyword lines with those they go on in after a comma."""
    waiting = None
    for number, line in enumerate(lines, start=1):
        line = line.strip()
        if not line or line.startswith("**"):
            continue
        if waiting:
            number, line = waiting[0], waiting[1] + line
        if line.startswith("*") and line.endswith(","):
            waiting = (number, line)
        else:
            waiting = None
            yield number, line


def read_number(block, line, text, kind):
    try:
        value = kind(text.upper().replace("D", "E") if kind is float else text)  # Fortran's 1.0D0
    except ValueError:
        value = None
    if value is None or (kind is float and not np.isfinite(value)):
        block.fail(f"'{text}' is not a number", line)
    return value


def join_rows(block):
    """The elements of a block as (line number, numbers); an element goes on after a comma at the line's end."""
    rows, goes_on = [], False
    for line, fields in block.data:
        numbers = [read_number(block, line, text, int) for text in fields if text]
        if goes_on:
            rows[-1][1].extend(numbers)
        else:
            rows.append((line, numbers))
        goes_on = fields[-1] == "" and len(rows[-1][1]) != 3
    return [row for row in rows if row[1]]


def read_abaqus(path):
    """The lines of a deck. MeshError at the line of the fault."""
    deck = Deck(path)
    blocks = read_blocks(path)
    if not any(block.keyword in ("NODE", "ELEMENT") for block in blocks):
        raise MeshError(f"{path}: error: has no *NODE and no *ELEMENT: not an Abaqus deck, or truncated")
    check_structure(blocks, path)
    for block in blocks:
        deck.take(block)
    return deck.make_mesh()


def check_structure(blocks, path):
    """MeshError for what would make the nodes' places or numbers others than they stand there."""
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

    def __init__(self, path):
        self.path = path
        self.nodes = {}  # id → position
        self.elements = {}  # id → (type, node ids); lines only
        self.node_sets, self.element_sets = {}, {}  # name → ids, in order
        self.spelling = {}  # ("N" or "E", name in capitals) → name as first written
        self.section_sets = []
        self.other_ids = set()  # of elements that are no lines
        self.others = {}  # type of elements that are no lines → number of them
        self.kinds = {}  # type of lines → number of them
        self.nodes_of = []  # (node set, element set whose nodes it takes in)
        self.instance = ""  # name of the one instance in capitals, which may stand before numbers and names of sets
        self.of_part = None  # in the assembly: what sets the part has, as in spelling
        self.directions = 0  # lines with an orientation node
        self.left = []

    def take(self, block):
        takers = {"NODE": self.take_nodes, "ELEMENT": self.take_elements}
        takers |= {"NSET": self.take_node_set, "ELSET": self.take_element_set}
        if block.keyword in takers:
            takers[block.keyword](block)
            return
        if "SECTION" in block.keyword and block.parameters.get("ELSET"):
            self.section_sets.append(self.name("E", block.parameters["ELSET"]))
        if block.keyword == "ASSEMBLY":
            self.of_part = set(self.spelling)
        elif block.keyword == "INSTANCE":
            self.instance = block.parameters.get("NAME", "").upper()
        elif block.keyword == "END ASSEMBLY":
            self.of_part = None
        if block.keyword not in SILENT:
            self.left.append(block.describe())

    def name(self, kind, text):
        """A set's name as it was first written: Abaqus takes capitals and small letters for the same."""
        return self.spelling.setdefault((kind, text.upper()), text)

    def take_nodes(self, block):
        ids = []
        for line, fields in block.data:
            node = read_number(block, line, fields[0], int)
            place = [read_number(block, line, text, float) for text in fields[1:4] if text]
            if len(place) < 2 or node < 1:
                block.fail(f"node {node} has {len(place)} coordinates, expected 2 or 3: truncated?", line)
            if self.nodes.setdefault(node, (*place, 0.0)[:3]) != (*place, 0.0)[:3] or node in ids[-1:]:
                block.fail(f"node {node} is defined twice", line)
            ids.append(node)
        if block.parameters.get("NSET"):
            self.node_sets.setdefault(self.name("N", block.parameters["NSET"]), []).extend(ids)

    def take_elements(self, block):
        kind = block.parameters.get("TYPE", "").upper()
        if THREE_NODES.match(kind):
            block.fail(f"{kind} is a line with a middle node, expected two-node lines")
        rows = join_rows(block)
        if not TWO_NODES.match(kind):
            self.others[kind or "?"] = self.others.get(kind or "?", 0) + len(rows)
            self.other_ids.update(row[0] for _, row in rows)
            return
        for line, row in rows:
            if len(row) not in (3, 4):
                found = f"a {kind} has {len(row) - 1} nodes, expected 2 (and an orientation node)"
                block.fail(f"{found}: truncated?", line)
            if row[0] in self.elements or row[0] < 1:
                block.fail(f"element {row[0]} is defined twice" if row[0] > 0 else "numbers begin at 1", line)
            self.directions += len(row) == 4
            self.elements[row[0]] = (line, row[1:3], block)
        self.kinds[kind] = self.kinds.get(kind, 0) + len(rows)
        if block.parameters.get("ELSET"):
            ids = [row[0] for _, row in rows]
            self.element_sets.setdefault(self.name("E", block.parameters["ELSET"]), []).extend(ids)

    def take_node_set(self, block):
        members = self.read_set(block, "N", self.node_sets)
        name = self.set_name(block, "N")
        self.node_sets.setdefault(name, []).extend(members)
        if block.parameters.get("ELSET"):
            self.nodes_of.append((name, self.find_set(block, "E", block.parameters["ELSET"], self.element_sets)))

    def take_element_set(self, block):
        members = self.read_set(block, "E", self.element_sets)
        self.element_sets.setdefault(self.set_name(block, "E"), []).extend(members)

    def set_name(self, block, kind):
        """The name of the set that a block defines; an assembly's set is another than its part's of the same name."""
        key = {"N": "NSET", "E": "ELSET"}[kind]
        text = block.parameters.get(key)
        if not text:
            block.fail(f"has no name ({key}=…)")
        if self.of_part is not None and (kind, text.upper()) in self.of_part:
            text = IN_ASSEMBLY + text
        return self.name(kind, text)

    def find_set(self, block, kind, text, sets, line=None):
        """The name of the set that a text refers to: of the assembly, if it has it, else of the part."""
        for candidate in (IN_ASSEMBLY + text, self.without_instance(text)):
            name = self.spelling.get((kind, candidate.upper()))
            if name in sets and (self.of_part is not None or not candidate.startswith(IN_ASSEMBLY)):
                return name
        return block.fail(f"names the set '{text}', which is not there", line)

    def without_instance(self, text):
        """PART-1-1.27 → 27 where PART-1-1 is the instance."""
        instance, _, rest = text.rpartition(".")
        return rest if instance and instance.upper() == self.instance else text

    def read_set(self, block, kind, sets):
        members = []
        for line, fields in block.data:
            fields = [text for text in fields if text]
            if "GENERATE" in block.parameters:
                row = [read_number(block, line, text, int) for text in fields]
                if len(row) not in (2, 3) or row[1] < row[0] or (len(row) == 3 and row[2] < 1):
                    block.fail("GENERATE expects first, last and an increment > 0", line)
                members += range(row[0], row[1] + 1, row[2] if len(row) == 3 else 1)
                continue
            for text in fields:
                plain = self.without_instance(text)
                if plain.isdecimal():
                    members.append(int(plain))
                else:
                    members += sets[self.find_set(block, kind, text, sets, line)]
        return members

    def make_mesh(self):
        ids = np.array(sorted(self.nodes), dtype=int)
        number = {node: place for place, node in enumerate(ids.tolist())}
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
            node_ids=ids,
            positions=np.array([self.nodes[node] for node in ids.tolist()], dtype=float).reshape(-1, 3),
            line_ids=np.array(list(self.elements), dtype=int),
            lines=lines,
            element_sets=pick_members(self.element_sets, element_number),
            node_sets=pick_members(self.node_sets, number),
            section_sets=tuple(self.section_sets),
            left_behind=self.tell_left(),
        )

    def check_members(self, sets, there, what):
        for name, members in sets.items():
            for member in members:
                if member not in there:
                    raise MeshError(
                        f"{self.path}: error: the set '{name}' names {what} {member}, which is not there: truncated?"
                    )

    def tell_left(self):
        told = [f"{count} elements of type {kind}, no lines" for kind, count in self.others.items()]
        for kind, count in self.kinds.items():
            meaning = KINDS.get(kind.rstrip("H"), "")
            told.append(
                f"beam kind {kind} of {count} elements{' (' + meaning + ' in Abaqus)' if meaning else ''}: "
                "the design's 'theory' decides"
            )
        if self.directions:
            told.append(f"orientation nodes of {self.directions} elements")
        return told + self.left
