"""Reading the frame in an Abaqus or CalculiX input deck.

meshio's own reader is not used: in version 5.0 it keeps the last *NODE block alone, gives an element set to the wrong
block when an earlier *ELEMENT has no ELSET, leaves node sets of set names empty, and does not report what else the deck
holds. tests/tools/mesh_reading_test.py compares both readers where meshio's is right.
"""

import copy
from collections.abc import Container, Iterator, Sequence

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import import abaqus_properties
from sprung_tools.mesh_import.abaqus_assembly import Assembly
from sprung_tools.mesh_import.abaqus_blocks import Block, read_blocks
from sprung_tools.mesh_import.abaqus_keywords import NOT_TAKEN
from sprung_tools.mesh_import.abaqus_orientation import Orientation
from sprung_tools.mesh_import.abaqus_part import GENERATING, MESHING, Element, Part, is_line_kind
from sprung_tools.mesh_import.frame_properties import Material, PointMass
from sprung_tools.mesh_import.line_mesh import LineMesh, describe_split, pick_members, shorten

KINDS = {  # how a beam of that type deforms in Abaqus
    "B21": "shear-flexible", "B31": "shear-flexible", "PIPE21": "shear-flexible", "PIPE31": "shear-flexible",
    "B22": "shear-flexible", "B32": "shear-flexible",
    "B23": "cubic, without shear", "B33": "cubic, without shear", "T2D2": "axial alone", "T3D2": "axial alone",
}  # fmt: skip
POINT_KINDS = {"MASS": "MASS", "ROTARYI": "ROTARY INERTIA"}  # type of elements → what gives them something
SILENT = {
    "HEADING", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "INSTANCE", "END INSTANCE", "END STEP",
    "USER ELEMENT",
}  # fmt: skip
Gift = tuple[Block, str, list[int], Floats]  # of a section or a mass, element set, elements, rotation of the instance


def read_abaqus(path: str) -> LineMesh:
    """Reads the line elements of a deck. InputError at the line of the fault."""
    blocks = read_blocks(path)
    if not any(block.keyword in ("NODE", "ELEMENT") for block in blocks):
        raise InputError(f"{path}: error: has no *NODE and no *ELEMENT: not an Abaqus deck, or truncated")
    check_structure(blocks)
    deck = Deck(path)
    for block in blocks:
        deck.read(block)
    for block in deck.of_assembly:
        deck.assembly.read(block)
    return deck.make_mesh()


def check_structure(blocks: Sequence[Block]) -> None:
    """Throws InputError for a deck that is cut short, and for what would leave nodes or elements out."""
    for opening in ("PART", "ASSEMBLY", "STEP", "INSTANCE"):
        begun = [block for block in blocks if block.keyword == opening]
        ended = sum(block.keyword == f"END {opening}" for block in blocks)
        if len(begun) > ended:
            begun[-1].fail(f"no *END {opening} follows: the file is truncated")
    for block in blocks:
        if block.keyword in GENERATING:
            block.fail("is not followed, and nodes or elements would be missing or misplaced; write them out")


class Deck:
    """The deck as far as it has been read."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.parts: dict[str, Part] = {}  # name in capitals → part
        self.assembly = Assembly()
        self.of_assembly: list[Block] = []  # its own blocks, which may name nodes of instances that come later
        self.part: Part | None = None  # that is being read
        self.instance: tuple[Block, Part] | None = None  # that is being read
        self.materials = abaqus_properties.Materials()
        self.weighed: dict[tuple[str, int], Block] = {}  # (keyword, element) → block that gives it a mass
        self.left_behind: list[str] = []

    def read(self, block: Block) -> None:
        """Takes in one block."""
        untaken = [key for key in NOT_TAKEN.get(block.keyword, ()) if key in block.parameters]
        self.left_behind += [f"{', '.join(untaken)} of {block.describe()}"] if untaken else []
        if block.keyword == "PART":
            self.begin_part(block)
        elif block.keyword == "END PART":
            self.part = None
        elif block.keyword == "INSTANCE":
            self.begin_instance(block)
        elif block.keyword == "END INSTANCE" and self.instance:
            self.assembly.place(*self.instance)
            self.instance = None
        elif block.keyword in MESHING and self.find_target() is self.assembly:
            self.of_assembly.append(block)
        elif block.keyword in MESHING:
            self.find_target().read(block)
        elif block.keyword in abaqus_properties.SECTION_BLOCKS | abaqus_properties.MASS_BLOCKS:
            self.find_target().used.append((block, block.parameters.get("ELSET", "")))
        elif block.keyword in abaqus_properties.MATERIAL_BLOCKS:
            self.materials.read(block)
        elif block.keyword not in SILENT:
            self.left_behind.append(block.describe())

    def begin_part(self, block: Block) -> None:
        self.part = Part(block.parameters.get("NAME", ""))
        if self.parts.setdefault(self.part.name.upper(), self.part) is not self.part:
            block.fail(f"a second part of the name '{self.part.name}'")

    def begin_instance(self, block: Block) -> None:
        name = block.parameters.get("PART", "")
        if name.upper() not in self.parts:
            block.fail(f"names the part '{name}', which is not there")
        self.instance = (block, self.parts[name.upper()])

    def find_target(self) -> Part:
        """What a block belongs to: the part or the instance that is being read, else the assembly."""
        if self.instance:
            block, part = self.instance
            if part in self.parts.values():  # what stands in an instance is not the part's
                part = copy.deepcopy(part)
                self.instance = (block, part)
            return part
        return self.part or self.assembly

    def make_mesh(self) -> LineMesh:
        """The mesh of all blocks; a line with a middle node becomes two lines."""
        whole = self.assembly
        ids = sorted(whole.nodes)
        number = {node: place for place, node in enumerate(ids)}
        positions = np.array([whole.nodes[node] for node in ids], dtype=float).reshape(-1, 3)
        line_ids, ends, owners = split_lines(whole.elements)
        lines_of: dict[int, list[int]] = {}
        for place, owner in enumerate(owners):
            lines_of.setdefault(owner, []).append(place)
            element = whole.elements[owner]
            for node in ends[place]:
                if node not in number:
                    element.block.fail(f"element {owner} names node {node}, which is not there", element.line)
            if element.orientation is not None and element.orientation not in number:
                found = f"element {owner} names the orientation node {element.orientation}"
                element.block.fail(f"{found}, which is not there", element.line)
        lines = np.array([[number[node] for node in pair] for pair in ends], dtype=int).reshape(-1, 2)
        element_sets, node_sets = whole.name_sets("E"), whole.name_sets("N")
        self.check_members(element_sets, whole.elements, "element")
        self.check_members(node_sets, number, "node")
        mesh = LineMesh(
            path=self.path,
            format="Abaqus deck",
            node_ids=np.array(ids, dtype=int),
            positions=positions,
            line_ids=np.array(line_ids, dtype=int),
            lines=lines,
            element_sets={
                name: np.unique([line for one in members for line in lines_of.get(one, ())]).astype(int)
                for name, members in element_sets.items()
            },
            node_sets=pick_members(node_sets, number),
            materials=self.materials.found,
        )
        self.add_properties(mesh, number, lines_of)
        mesh.left_behind = self.list_left_behind(owners)
        return mesh

    def check_members(self, sets: dict[str, list[int]], there: Container[int], what: str) -> None:
        """Throws InputError if a set names a node or an element that is not there."""
        for name, members in sets.items():
            for member in members:
                if member not in there:
                    raise InputError(
                        f"{self.path}: error: the set '{name}' names {what} {member}, which is not there: truncated?"
                    )

    def list_gifts(self) -> Iterator[Gift]:
        """What gives sections and masses to elements, with the elements' numbers in the assembly."""
        whole = self.assembly
        for block, name in whole.used:
            owner, own = whole.find_owner(block, whole.element_sets, "E", name)
            members = whole.find_members(block, whole.element_sets, "E", name)
            yield block, whole.name_set_of(owner, "E", own), members, np.eye(3)
        for one in whole.instances.values():
            for block, name in one.part.used:
                members = one.part.find_members(block, one.part.element_sets, "E", name)
                given = [member + one.elements for member in members]
                yield block, whole.name_set_of(one, "E", name), given, one.rotation

    def add_properties(self, mesh: LineMesh, number: dict[int, int], lines_of: dict[int, list[int]]) -> None:
        """Adds the sections of lines and the point masses to the mesh."""
        names: set[str] = set()
        orientation = Orientation(self.assembly)
        for block, name, elements, rotation in self.list_gifts():
            if block.keyword in abaqus_properties.MASS_BLOCKS:
                self.add_masses(mesh, number, block, elements, rotation)
                continue
            places = [line for element in elements for line in lines_of.get(element, ())]
            if not places:
                self.left_behind.append(block.describe())
                continue
            types = {self.assembly.elements[element].kind for element in elements if element in lines_of}
            section, width, material = abaqus_properties.read_section(block, self.materials.found, types)
            if material is not None:
                section = section._replace(material=add_material(mesh.materials, material))
            for replaced in np.unique(mesh.section_of[places]):
                if replaced >= 0:
                    text = mesh.sections[replaced].text
                    self.left_behind.append(f"{text} of elements that {block.describe()} has, too")
            mesh.section_of[places] = len(mesh.sections)
            mesh.sections.append(section)
            names.add(name.upper())
            for element in elements if section.bends else ():
                for place in lines_of.get(element, ()):
                    mesh.heights[place] = self.find_height(mesh, number, orientation, element, place, rotation, width)
        mesh.section_sets = tuple(name for name in mesh.element_sets if name.upper() in names)
        self.left_behind += orientation.list_remarks()

    def find_height(
        self, mesh: LineMesh, number: dict[int, int], orientation: Orientation, element: int, place: int,
        rotation: Floats, width: Floats,
    ) -> Floats:  # fmt: skip
        """The direction of the height of an element's line. width: the 1-direction of the section."""
        one = self.assembly.elements[element]
        begin, end = mesh.positions[mesh.lines[place]]
        given = rotation @ width if one.orientation is None else mesh.positions[number[one.orientation]] - begin
        return orientation.find_height(element, one, end - begin, given, rotation)

    def add_masses(
        self, mesh: LineMesh, number: dict[int, int], block: Block, elements: Sequence[int], rotation: Floats
    ) -> None:
        """Adds the point masses of a *MASS or a *ROTARY INERTIA. rotation: of their instance."""
        mass, inertia, left_out = abaqus_properties.read_mass(block)
        if inertia is not None:
            inertia = rotation @ inertia @ rotation.T
        for one in elements:
            element = self.assembly.elements.get(one)
            if element is None or len(element.nodes) != 1 or element.nodes[0] not in number:
                block.fail(f"names element {one}, which is not an element of one node")
            before = self.weighed.setdefault((block.keyword, one), block)
            if before is not block:
                block.fail(f"gives element {one} what {before.describe()} has given it")
            node = element.nodes[0]
            text = f"*{block.keyword} (line {block.line}) at node {node}"
            mesh.point_masses.append(PointMass(text, number[node], mass, inertia, left_out))

    def list_left_behind(self, owners: Sequence[int]) -> list[str]:
        """What the deck holds and the mesh does not, a text each."""
        kinds: dict[str, int] = {}
        for element in self.assembly.elements.values():
            kinds[element.kind] = kinds.get(element.kind, 0) + 1
        texts = []
        for kind, count in kinds.items():
            if is_line_kind(kind):
                meaning = KINDS.get(kind.rstrip("HR"), "")
                meaning = f" ({meaning} in Abaqus)" if meaning else ""
                texts.append(f"beam kind {kind} of {count} elements{meaning}: the design's 'theory' decides")
            elif kind.startswith("CONN"):
                joined = [one.nodes for one in self.assembly.elements.values() if one.kind == kind]
                ends = shorten("–".join(map(str, nodes)) for nodes in joined)
                texts.append(f"connectors of type {kind}, which join nodes {ends}")
            elif kind not in POINT_KINDS:
                texts.append(f"{count} elements of type {kind or '?'}, which are not lines")
        for kind, keyword in POINT_KINDS.items():
            bare = [
                number
                for number, element in self.assembly.elements.items()
                if element.kind == kind and (keyword, number) not in self.weighed
            ]
            texts += [f"elements {shorten(bare)} of type {kind}, to which no *{keyword} gives anything"] if bare else []
        texts += describe_split(len(owners) - len(set(owners)))
        moved = [(one.name, one.nodes, one.elements) for one in self.assembly.instances.values()]
        if any(block.keyword in ("NODE", "ELEMENT") for block in self.of_assembly):
            moved.append(("the assembly's own", self.assembly.offsets["N"], self.assembly.offsets["E"]))
        offsets = shorten(f"{name}: {nodes} and {elements}" for name, nodes, elements in moved if nodes or elements)
        if offsets:
            texts.append(f"numbers of nodes and elements in instances, which are now larger ({offsets})")
        return texts + self.materials.left_behind + self.left_behind


def add_material(materials: dict[str, Material], material: Material) -> str:
    """Adds the material that a section gives itself. Returns its name, which gets a number where parts with element
    sets of one name have different ones."""
    named, number = material, 1
    while materials.get(named.name, named) != named:
        number += 1
        named = material._replace(name=f"{material.name} ({number})")
    materials[named.name] = named
    return named.name


def split_lines(elements: dict[int, Element]) -> tuple[list[int], list[list[int]], list[int]]:
    """The lines of all elements that are lines: (numbers, end nodes, numbers of their elements). The second half of an
    element with a middle node gets a number after all others."""
    line_ids: list[int] = []
    ends: list[list[int]] = []
    owners: list[int] = []
    following = max(elements, default=0) + 1
    for number, element in elements.items():
        if not element.is_line:
            continue
        for half, pair in enumerate(zip(element.nodes, element.nodes[1:])):
            line_ids.append(number if half == 0 else following)
            following += half
            ends.append(list(pair))
            owners.append(number)
    return line_ids, ends, owners
