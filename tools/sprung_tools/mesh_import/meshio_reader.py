"""Reading the frame in any of the formats that meshio reads. The sets keep the names that they have in the file."""

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

import meshio
import numpy as np

from sprung_tools.files.array_types import Integers
from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LineMesh, describe_split, order_along, shorten
from sprung_tools.mesh_import.meshio_process import run_meshio

# These cell data number the source's own entities or families; the names of these are read elsewhere.
NOT_SETS = ("gmsh:geometrical", "cell_tags")
WITH_MIDDLE_NODES = {"line3": 3, "line4": 4}  # nodes of lines
SIZES = {"vertex": 1, "line": 2, **WITH_MIDDLE_NODES}  # nodes of the cells that are used
NOT_REPORTED = ("gmsh:geometrical", "gmsh:dim_tags", "cell_tags", "point_tags", "gmsh:physical")


def read_with_meshio(path: str) -> LineMesh:
    """Reads the line elements of a mesh file. InputError if meshio cannot read it, or if the file is cut short."""
    mesh, format_name = call_meshio(path)
    positions = np.zeros((len(mesh.points), 3))
    positions[:, : np.shape(mesh.points)[1]] = mesh.points
    halved = sum(len(block.data) for block in mesh.cells if block.type in WITH_MIDDLE_NODES)
    split_lines(mesh)
    offset, starts, blocks = 0, {}, []
    for place, block in enumerate(mesh.cells):
        if block.type == "line":
            starts[place] = offset
            offset += len(block.data)
            blocks.append(orient(mesh, place))
    lines = np.concatenate(blocks) if blocks else np.zeros((0, 2), dtype=int)
    if not np.all(np.isfinite(positions)):
        raise InputError(f"{path}: error: coordinates are not finite")
    element_sets, node_sets = read_sets(mesh, starts)
    if has_numbers(mesh, "gmsh:geometrical") and has_numbers(mesh, "gmsh:physical"):
        kept, numbers = find_repeated(mesh, starts)
        lines = lines[kept]
        element_sets = {name: np.unique(numbers[members]) for name, members in element_sets.items()}
    return LineMesh(
        path=path,
        format=f"{format_name} file",
        node_ids=np.arange(1, len(positions) + 1),
        positions=positions,
        line_ids=np.arange(1, len(lines) + 1),
        lines=lines,
        element_sets=element_sets,
        node_sets=node_sets,
        left_behind=[*describe_split(halved), *list_left_behind(mesh, element_sets)],
    )


def split_lines(mesh: meshio.Mesh) -> None:
    """Makes two-node lines of those with middle nodes, which stand behind both ends; each part has the data and is in
    the sets of the whole."""
    for place, block in enumerate(mesh.cells):
        if block.type not in WITH_MIDDLE_NODES:
            continue
        size = WITH_MIDDLE_NODES[block.type]
        along = order_along(size)
        pairs = np.asarray(block.data)[:, list(zip(along, along[1:]))].reshape(-1, 2)
        mesh.cells[place] = meshio.CellBlock("line", pairs)
        for blocks in mesh.cell_data.values():
            blocks[place] = np.repeat(blocks[place], size - 1, axis=0)
        for name, parts in mesh.cell_sets.items():
            if name != "gmsh:bounding_entities" and parts[place] is not None:
                first = (size - 1) * np.asarray(parts[place], dtype=int)
                parts[place] = (first[:, None] + np.arange(size - 1)).reshape(-1)


def orient(mesh: meshio.Mesh, place: int) -> Integers:
    """A block's lines [k×2]. Where gmsh takes the curve in the opposite direction (group < 0), their ends are
    swapped."""
    lines = np.array(mesh.cells[place].data, dtype=int)
    if "gmsh:physical" in mesh.cell_data:
        reversed_ = np.asarray(mesh.cell_data["gmsh:physical"][place]) < 0
        lines[reversed_] = lines[reversed_][:, ::-1]
    return lines


def has_numbers(mesh: meshio.Mesh, key: str) -> bool:
    """Whether the mesh has cell data of a name, a whole number for each cell."""
    blocks = [np.asarray(one) for one in mesh.cell_data.get(key, ())]
    return bool(blocks) and all(one.ndim == 1 and is_of_kind(one, "iu") for one in blocks)


def find_repeated(mesh: meshio.Mesh, starts: Mapping[int, int]) -> tuple[Integers, Integers]:
    """Returns (places of the lines that stand for themselves, for each line its number among these).

    A gmsh 2.2 file repeats the elements of a curve for each group of the curve. Elements of the same group between
    the same nodes are no repetitions: such are the two of a circle.
    """
    kept: list[int] = []
    number_of: dict[tuple[int, ...], int] = {}
    numbers: list[int] = []
    seen: Counter[tuple[int, ...]] = Counter()
    for block in starts:
        entities = mesh.cell_data["gmsh:geometrical"][block]
        groups = mesh.cell_data["gmsh:physical"][block]
        pairs = np.sort(mesh.cells[block].data, axis=1)
        for entity, group, (a, b) in zip(entities.tolist(), groups.tolist(), pairs.tolist()):
            seen[entity, a, b, abs(group)] += 1
            key = (entity, a, b, seen[entity, a, b, abs(group)])
            if key not in number_of:
                number_of[key] = len(kept)
                kept.append(len(numbers))
            numbers.append(number_of[key])
    return np.array(kept, dtype=int), np.array(numbers, dtype=int)


def call_meshio(path: str) -> tuple[meshio.Mesh, str]:
    """Returns (mesh, name of the format). InputError if meshio cannot read the file, or makes no whole mesh of it."""
    if not os.path.isfile(path):
        raise InputError(f"{path}: error: no such file")
    file_format = "gmsh" if is_gmsh(path) else None
    mesh = run_meshio(path, file_format)
    fault = find_fault(mesh)
    if fault:
        raise InputError(f"{path}: error: {fault}: the file is damaged")
    return mesh, file_format or os.path.splitext(path)[1].lstrip(".").upper()


def find_fault(mesh: meshio.Mesh) -> str:
    """What is wrong with the shapes and types of the arrays that meshio returns; empty if nothing is."""
    shape = np.shape(mesh.points)
    if len(shape) != 2 or shape[1] > 3 or not is_of_kind(mesh.points, "fiu"):
        return f"its coordinates are an array of shape {shape}"
    for block in mesh.cells:
        if np.ndim(block.data) != 2 or not is_of_kind(block.data, "iu"):
            return f"its {block.type} cells are an array of shape {np.shape(block.data)}"
        if block.type in SIZES and np.shape(block.data)[1] != SIZES[block.type]:
            return f"its {block.type} cells have {np.shape(block.data)[1]} nodes each"
        if np.size(block.data) and not 0 <= np.min(block.data) <= np.max(block.data) < shape[0]:
            return f"a cell of type {block.type} names a node that is not there"
    lengths = [len(block.data) for block in mesh.cells]
    for key, blocks in mesh.cell_data.items():
        if [len(values) for values in blocks] != lengths:
            return f"the cell data '{key}' are not one for each cell"
    for key, values in mesh.point_data.items():
        if np.ndim(values) == 0 or len(values) != shape[0]:
            return f"the point data '{key}' are not one for each point"
    return find_fault_of_sets(mesh, lengths)


def find_fault_of_sets(mesh: meshio.Mesh, lengths: Sequence[int]) -> str:
    """What is wrong with the sets that meshio returns; empty if nothing is. lengths: cells in each block."""
    for name, blocks in mesh.cell_sets.items():
        if name != "gmsh:bounding_entities" and len(blocks) != len(lengths):
            return f"the set '{name}' is not divided like the cells"
        for members, length in zip(blocks, lengths):
            if name != "gmsh:bounding_entities" and members is not None and not are_indices(members, length):
                return f"the set '{name}' names a cell that is not there"
    for name, members in mesh.point_sets.items():
        if not are_indices(members, len(mesh.points)):
            return f"the set '{name}' names a node that is not there"
    return ""


def is_of_kind(values: object, kinds: str) -> bool:
    """Whether an array holds values of some of NumPy's kinds; an empty one is of any kind."""
    array = np.asarray(values)
    return array.size == 0 or array.dtype.kind in kinds


def are_indices(members: object, count: int) -> bool:
    """Whether all members are whole numbers from 0 to count - 1."""
    array = np.asarray(members)
    return array.size == 0 or (is_of_kind(array, "iu") and 0 <= array.min() and bool(array.max() < count))


def is_gmsh(path: str) -> bool:
    """Whether a file is a gmsh mesh. InputError if it is empty, or a gmsh mesh cut short, for which meshio prints only
    a warning."""
    with open(path, "rb") as file:
        content = file.read()
    if not content.strip():
        raise InputError(f"{path}: error: the file is empty")
    if not content.startswith(b"$MeshFormat"):
        return False
    if not content.rstrip().rpartition(b"\n")[2].startswith(b"$End"):
        raise InputError(f"{path}: error: the last section has no end: the file is truncated")
    return True


def read_sets(mesh: meshio.Mesh, starts: Mapping[int, int]) -> tuple[dict[str, Integers], dict[str, Integers]]:
    """Returns (element sets, node sets): name → numbers of lines, name → numbers of nodes.

    starts: block → number of its first line.
    """
    elements: dict[str, Integers] = {}
    nodes: dict[str, Integers] = {}

    def add(sets: dict[str, Integers], name: str, numbers: Integers) -> None:
        numbers = np.asarray(numbers, dtype=int)
        if numbers.size:
            sets[name] = np.unique(np.concatenate([sets.get(name, np.zeros(0, dtype=int)), numbers]))

    for place, block in enumerate(mesh.cells):
        is_line = place in starts
        if not is_line and block.type != "vertex":
            continue
        for name, chosen in find_block_sets(mesh, place, len(block.data)):
            if is_line:
                add(elements, name, starts[place] + chosen)
            else:
                add(nodes, name, block.data[chosen, 0])
    for name, chosen in mesh.point_sets.items():
        add(nodes, name, chosen)
    tags = mesh.point_data.get("point_tags")
    for family, names in getattr(mesh, "point_tags", {}).items():
        for name in names:
            add(nodes, name, np.flatnonzero(tags == family))
    return elements, nodes


def find_block_sets(mesh: meshio.Mesh, place: int, size: int) -> Iterator[tuple[str, Integers]]:
    """Yields (name, members) of every set of a block's cells: named sets, MED's families, else whole numbers as cell
    data."""
    named = {name for name in mesh.cell_sets if name != "gmsh:bounding_entities"}
    for name in sorted(named):
        chosen = mesh.cell_sets[name][place]
        if chosen is not None and np.size(chosen):
            yield name, np.asarray(chosen, dtype=int)
    families = getattr(mesh, "cell_tags", {})
    for family, names in families.items():
        for name in names:
            yield name, np.flatnonzero(mesh.cell_data["cell_tags"][place] == family)
    for key, blocks in mesh.cell_data.items():
        values = np.asarray(blocks[place])
        values = values[:, 0] if values.shape == (size, 1) else values
        # gmsh's groups are read even where it names sets: meshio leaves out the groups that reverse a curve.
        if (named or families) and key != "gmsh:physical":
            continue
        if key in NOT_SETS or values.shape != (size,) or values.dtype.kind not in "iu":
            continue
        for value in np.unique(values):
            if key == "gmsh:physical" and value == 0:  # in no group
                continue
            yield name_set(mesh, key, int(value), mesh.cells[place].dim), np.flatnonzero(values == value)


def name_set(mesh: meshio.Mesh, key: str, value: int, dimension: int) -> str:
    """The name of the cells whose data have a value: a gmsh group's own name, else DATA_VALUE."""
    if key == "gmsh:physical":
        for name, pair in mesh.field_data.items():
            if (int(pair[0]), int(pair[1])) == (abs(value), dimension):
                return name
        return f"physical_{abs(value)}"
    return f"{key.replace(':', '_')}_{value}"


def list_left_behind(mesh: meshio.Mesh, element_sets: Iterable[str]) -> list[str]:
    """What the mesh holds beside lines, points and sets, a text each."""
    others: dict[str, int] = {}
    for block in mesh.cells:
        if block.type not in ("line", "vertex"):
            others[block.type] = others.get(block.type, 0) + len(block.data)
    texts = [f"{count} elements of type {kind}, which are not lines" for kind, count in others.items()]
    used = [key for key in mesh.cell_data if any(name.startswith(key.replace(":", "_") + "_") for name in element_sets)]
    data = [key for key in mesh.cell_data if key not in (*NOT_REPORTED, *used)]
    texts += [f"cell data {shorten(data)}"] if data else []
    data = [key for key in mesh.point_data if key not in NOT_REPORTED]
    texts += [f"point data {shorten(data)}"] if data else []
    texts.append("sections, materials and orientations, if it had any: meshio reads none of them from this format")
    return texts
