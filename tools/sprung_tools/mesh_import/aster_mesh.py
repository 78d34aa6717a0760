"""Reading the lines of a Code_Aster mesh in its own text format (.mail)."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, NoReturn

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LineMesh, describe_split, order_along, pick_members
from sprung_tools.mesh_import.number_text import parse_real

DIMENSIONS = {"COOR_1D": 1, "COOR_2D": 2, "COOR_3D": 3}
NODES_OF = {"SEG2": 2, "SEG3": 3, "SEG4": 4}  # middle nodes stand behind both ends
OTHER_CELLS = re.compile(r"(TRIA|QUAD|TETRA|PENTA|PYRAM|HEXA)\d+")
ATTRIBUTE = re.compile(r"(NOM|NUMIN|NUMAX|NUMED|NBOBJ|NBLIGE|NBLIGT|AUTEUR|DATE)=")  # of a block, not of its table
GROUPS = ("GROUP_NO", "GROUP_MA")
SILENT = ("TITRE",)  # blocks that say nothing about the mesh


class Block(NamedTuple):
    """A keyword and the words after it, up to FINSF."""

    keyword: str
    name: str  # what NOM=… says; empty if it says nothing
    words: list[tuple[int, str]]  # line number, word
    path: str
    line: int

    def fail(self, what: str, line: int | None = None) -> NoReturn:
        """Throws InputError at a line of the block, its first if none is given."""
        raise InputError(f"{self.path}:{line or self.line}: error: {self.keyword}: {what}")


def is_aster_mesh(path: str) -> bool:
    """Whether a text file has a table of coordinates as Code_Aster writes it."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        return any(line.split()[:1] and line.split()[0] in DIMENSIONS for line in file)


def read_aster_mesh(path: str) -> LineMesh:
    """Reads nodes, lines and groups; other elements are left behind. InputError if it is not a whole mesh."""
    blocks = read_blocks(path)
    names, positions = read_nodes(path, blocks)
    nodes = {name: [place] for name, place in names.items()}
    lines, cells = read_lines(blocks, names)
    split = sum(len(halves) > 1 for halves in cells.values())
    groups: dict[str, dict[str, list[int]]] = {keyword: {} for keyword in GROUPS}
    others: dict[str, int] = {}
    for block in blocks:
        if block.keyword in GROUPS:
            name, members = read_group(block, nodes if block.keyword == "GROUP_NO" else cells)
            groups[block.keyword][name] = members
        elif OTHER_CELLS.fullmatch(block.keyword) or block.keyword == "POI1":
            others[block.keyword] = others.get(block.keyword, 0) + 1
        elif block.keyword not in (*DIMENSIONS, *NODES_OF, *SILENT):
            block.fail("a block of a kind that is not known")
    left_behind = describe_split(split) + [f"elements {kind}, which are not lines" for kind in others]
    left_behind.append("sections, materials and orientations: they stand in the command file (.comm)")
    element_sets = pick_members(groups["GROUP_MA"], {place: place for place in range(len(lines))})
    return LineMesh(
        path=path,
        format="Code_Aster mesh",
        node_ids=np.arange(1, len(names) + 1),
        positions=positions,
        line_ids=np.arange(1, len(lines) + 1),
        lines=np.array(lines, dtype=int).reshape(-1, 2),
        element_sets={name: members for name, members in element_sets.items() if len(members)},
        node_sets=pick_members(groups["GROUP_NO"], {place: place for place in range(len(names))}),
        left_behind=left_behind,
    )


def read_blocks(path: str) -> list[Block]:
    """The blocks of a file. InputError without FIN at its end, or with a block that has no FINSF."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        text = file.read()
    blocks: list[Block] = []
    is_open = False
    for number, line in enumerate(text.splitlines(), 1):
        words = re.sub(r"\s*=\s*", "=", line.partition("%")[0].replace(",", " ")).split()
        if not words:
            continue
        if is_open and words == ["FINSF"]:
            is_open = False
        elif is_open:
            given = [word[4:] for word in words if word.startswith("NOM=")]
            blocks[-1] = blocks[-1]._replace(name=given[0] if given else blocks[-1].name)
            blocks[-1].words.extend((number, word) for word in words if not ATTRIBUTE.match(word))
        elif words[0] == "FIN":
            return blocks
        else:
            given = [word[4:] for word in words[1:] if word.startswith("NOM=")]
            # Words beside the keyword that say nothing about the format's attributes belong to the block.
            rest = [(number, word) for word in words[1:] if "=" not in word]
            blocks.append(Block(words[0], given[0] if given else "", rest, path, number))
            is_open = True
    if not blocks:
        raise InputError(f"{path}: error: the file is empty")
    end = f"{blocks[-1].keyword} of line {blocks[-1].line} has no FINSF" if is_open else "there is no FIN"
    raise InputError(f"{path}: error: {end}: the file is truncated")


def read_nodes(path: str, blocks: Iterable[Block]) -> tuple[dict[str, int], np.ndarray]:
    """Returns (name → 0-based number, positions [N×3])."""
    tables = [block for block in blocks if block.keyword in DIMENSIONS]
    if len(tables) != 1:
        raise InputError(f"{path}: error: {len(tables)} tables of coordinates (COOR_2D, COOR_3D), expected one")
    table = tables[0]
    size = DIMENSIONS[table.keyword] + 1
    names: dict[str, int] = {}
    positions = []
    for at in range(0, len(table.words), size):
        row = table.words[at : at + size]
        line, name = row[0]
        if len(row) < size:
            table.fail(f"node '{name}' has {len(row) - 1} coordinates, expected {size - 1}", line)
        if name in names:
            table.fail(f"node '{name}' is defined twice", line)
        names[name] = len(names)
        positions.append([read_number(table, *word) for word in row[1:]] + [0.0] * (4 - size))
    return names, np.array(positions, dtype=float).reshape(-1, 3)


def read_number(block: Block, line: int, word: str) -> float:
    """A finite number, with an exponent as Fortran writes it or as C does."""
    try:
        value = parse_real(word)
    except ValueError:
        block.fail(f"'{word}' is not a number", line)
    if not np.isfinite(value):
        block.fail(f"'{word}' is not finite", line)
    return value


def read_lines(blocks: Iterable[Block], names: dict[str, int]) -> tuple[list[tuple[int, int]], dict[str, list[int]]]:
    """Returns (pairs of nodes, name of a cell → numbers of its lines; none for other cells). A cell with middle nodes
    becomes a line from node to node."""
    lines: list[tuple[int, int]] = []
    cells: dict[str, list[int]] = {}
    for block in blocks:
        if OTHER_CELLS.fullmatch(block.keyword) or block.keyword == "POI1":
            cells.update((word, []) for _, word in block.words if word not in names)
        size = NODES_OF.get(block.keyword, 0)
        if not size:
            continue
        for at in range(0, len(block.words), size + 1):
            row = block.words[at : at + size + 1]
            line, name = row[0]
            if len(row) < size + 1:
                block.fail(f"element '{name}' has {len(row) - 1} nodes, expected {size}", line)
            if name in cells:
                block.fail(f"element '{name}' is defined twice", line)
            for place, node in row[1:]:
                if node not in names:
                    block.fail(f"element '{name}' names the node '{node}', which is not there", place)
            along = [names[row[1 + place][1]] for place in order_along(size)]
            cells[name] = list(range(len(lines), len(lines) + size - 1))
            lines += zip(along, along[1:])
    return lines, cells


def read_group(block: Block, numbers: Mapping[str, Sequence[int]]) -> tuple[str, list[int]]:
    """Returns (name, members). numbers: name of a node or a cell → numbers of its nodes or lines."""
    words = block.words if block.name else block.words[1:]
    name = block.name or (block.words[0][1] if block.words else "")
    if not name:
        block.fail("the group has no name")
    for line, word in words:
        if word not in numbers:
            block.fail(f"the group '{name}' names '{word}', which is not there", line)
    return name, [number for _, word in words for number in numbers[word]]
