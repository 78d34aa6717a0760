"""Reading the frame in any of the formats that meshio reads. The sets keep the names that they have in the file."""

import contextlib
import io
import os
from collections.abc import Iterable, Iterator, Mapping

import meshio
import numpy as np

from sprung_tools.files.array_types import Integers
from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LineMesh, shorten

# These cell data number the source's own entities or families; the names of these are read elsewhere.
NOT_SETS = ("gmsh:geometrical", "cell_tags")
NOT_REPORTED = ("gmsh:geometrical", "gmsh:dim_tags", "cell_tags", "point_tags", "gmsh:physical")


def read_with_meshio(path: str) -> LineMesh:
    """Reads the line elements of a mesh file. InputError if meshio cannot read it, or if the file is cut short."""
    mesh, format_name = call_meshio(path)
    positions = np.zeros((len(mesh.points), 3))
    positions[:, : np.shape(mesh.points)[1]] = mesh.points
    middle = [block for block in mesh.cells if block.type.startswith("line") and block.type != "line"]
    if middle:
        count = sum(len(block.data) for block in middle)
        raise InputError(f"{path}: error: {count} lines with middle nodes ({middle[0].type}), expected two-node lines")
    offset, starts, blocks = 0, {}, []
    for place, block in enumerate(mesh.cells):
        if block.type == "line":
            starts[place] = offset
            offset += len(block.data)
            blocks.append(orient(mesh, place))
    lines = np.concatenate(blocks) if blocks else np.zeros((0, 2), dtype=int)
    if lines.size and not (0 <= lines.min() and lines.max() < len(positions)):
        raise InputError(f"{path}: error: a line names a node that is not there: the file is truncated")
    if not np.all(np.isfinite(positions)):
        raise InputError(f"{path}: error: coordinates are not finite")
    element_sets, node_sets = read_sets(mesh, starts)
    return LineMesh(
        path=path,
        format=f"{format_name} file",
        node_ids=np.arange(1, len(positions) + 1),
        positions=positions,
        line_ids=np.arange(1, len(lines) + 1),
        lines=lines,
        element_sets=element_sets,
        node_sets=node_sets,
        left_behind=list_left_behind(mesh, element_sets),
    )


def orient(mesh: meshio.Mesh, place: int) -> Integers:
    """A block's lines [k×2]. Where gmsh takes the curve in the opposite direction (group < 0), their ends are
    swapped."""
    lines = np.array(mesh.cells[place].data, dtype=int)
    if "gmsh:physical" in mesh.cell_data:
        reversed_ = np.asarray(mesh.cell_data["gmsh:physical"][place]) < 0
        lines[reversed_] = lines[reversed_][:, ::-1]
    return lines


def call_meshio(path: str) -> tuple[meshio.Mesh, str]:
    """Returns (mesh, name of the format). meshio prints its errors and ends the program; here they become
    InputErrors."""
    if not os.path.isfile(path):
        raise InputError(f"{path}: error: no such file")
    file_format = "gmsh" if is_gmsh(path) else None
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = meshio.read(path, file_format=file_format)
    except (Exception, SystemExit) as error:  # whatever its many readers raise for a damaged file
        text = " ".join(said.getvalue().split()) or str(error) or type(error).__name__
        text = text.split("] ")[-1] if isinstance(error, SystemExit) else f"{type(error).__name__}: {text}"
        raise InputError(f"{path}: error: meshio {meshio.__version__} cannot read it: {text}") from error
    return mesh, file_format or os.path.splitext(path)[1].lstrip(".").upper()


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
