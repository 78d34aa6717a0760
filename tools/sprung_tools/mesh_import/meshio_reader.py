"""Reading the frame in any of the formats that meshio reads, with its sets under the names they have there."""

import contextlib
import io
import os

import meshio
import numpy as np

from sprung_tools.mesh_import.line_mesh import LineMesh, MeshError, shorten

# Cell data that number the source's own entities or families, whose names are looked up elsewhere.
NOT_SETS = ("gmsh:geometrical", "cell_tags")
NOT_TOLD = ("gmsh:geometrical", "gmsh:dim_tags", "cell_tags", "point_tags", "gmsh:physical")


def read_with_meshio(path):
    """The lines of a mesh file. MeshError if meshio cannot read it, or the file ends before its last section does."""
    mesh, format_name = call_meshio(path)
    positions = np.zeros((len(mesh.points), 3))
    positions[:, : np.shape(mesh.points)[1]] = mesh.points
    middle = [block for block in mesh.cells if block.type.startswith("line") and block.type != "line"]
    if middle:
        count = sum(len(block.data) for block in middle)
        raise MeshError(
            f"{path}: error: {count} lines with middle nodes ({middle[0].type}), expected two-node lines"
        )
    offset, starts, lines = 0, {}, []
    for place, block in enumerate(mesh.cells):
        if block.type == "line":
            starts[place] = offset
            offset += len(block.data)
            lines.append(orient(mesh, place))
    lines = np.concatenate(lines) if lines else np.zeros((0, 2), dtype=int)
    if lines.size and not (0 <= lines.min() and lines.max() < len(positions)):
        raise MeshError(f"{path}: error: a line names a node that is not there: the file is truncated")
    if not np.all(np.isfinite(positions)):
        raise MeshError(f"{path}: error: coordinates are not finite")
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
        left_behind=tell_left(mesh, element_sets),
    )


def orient(mesh, place):
    """A block's lines [k×2]; where gmsh takes the curve in the opposite direction (group < 0), turned round."""
    lines = np.array(mesh.cells[place].data, dtype=int)
    if "gmsh:physical" in mesh.cell_data:
        turned = np.asarray(mesh.cell_data["gmsh:physical"][place]) < 0
        lines[turned] = lines[turned][:, ::-1]
    return lines


def call_meshio(path):
    """(mesh, name of the format). meshio prints its errors and leaves the program; here they are MeshErrors."""
    if not os.path.isfile(path):
        raise MeshError(f"{path}: error: no such file")
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = meshio.read(path, file_format="gmsh" if is_gmsh(path) else None)
    except MeshError:
        raise
    except (Exception, SystemExit) as error:  # whatever its many readers meet in a spoilt file
        text = " ".join(said.getvalue().split()) or str(error) or type(error).__name__
        text = text.split("] ")[-1] if isinstance(error, SystemExit) else f"{type(error).__name__}: {text}"
        raise MeshError(f"{path}: error: meshio {meshio.__version__} cannot read it: {text}") from error
    return mesh, "gmsh" if is_gmsh(path) else os.path.splitext(path)[1].lstrip(".").upper()


def is_gmsh(path):
    """Whether a file is a gmsh mesh. MeshError if it is empty, or a gmsh mesh cut short, of which meshio only warns."""
    with open(path, "rb") as file:
        content = file.read()
    if not content.strip():
        raise MeshError(f"{path}: error: the file is empty")
    if not content.startswith(b"$MeshFormat"):
        return False
    if not content.rstrip().rpartition(b"\n")[2].startswith(b"$End"):
        raise MeshError(f"{path}: error: the last section has no end: the file is truncated")
    return True


def read_sets(mesh, starts):
    """(element sets, node sets): name → numbers of lines, of nodes. starts: block → number of its first line."""
    elements, nodes = {}, {}

    def add(sets, name, numbers):
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


def find_block_sets(mesh, place, size):
    """(name, members) of every set of a block's cells: named sets, MED's families, else whole numbers as cell data."""
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
        # gmsh's groups are looked at even where it names sets: meshio leaves those out that turn a curve round.
        if (named or families) and key != "gmsh:physical":
            continue
        if key in NOT_SETS or values.shape != (size,) or values.dtype.kind not in "iu":
            continue
        for value in np.unique(values):
            yield name_of(mesh, key, int(value), mesh.cells[place].dim), np.flatnonzero(values == value)


def name_of(mesh, key, value, dimension):
    """A gmsh group's own name, else DATA_VALUE."""
    if key == "gmsh:physical":
        for name, pair in mesh.field_data.items():
            if (int(pair[0]), int(pair[1])) == (abs(value), dimension):
                return name
        return f"physical_{abs(value)}"
    return f"{key.replace(':', '_')}_{value}"


def tell_left(mesh, element_sets):
    """What the mesh holds beside lines, points and sets."""
    told, others = [], {}
    for block in mesh.cells:
        if block.type not in ("line", "vertex"):
            others[block.type] = others.get(block.type, 0) + len(block.data)
    told += [f"{count} elements of type {kind}, no lines" for kind, count in others.items()]
    used = [
        key
        for key in mesh.cell_data
        if any(name.startswith(key.replace(":", "_") + "_") for name in element_sets)
    ]
    data = [key for key in mesh.cell_data if key not in (*NOT_TOLD, *used)]
    told += [f"cell data {shorten(data)}"] if data else []
    data = [key for key in mesh.point_data if key not in NOT_TOLD]
    told += [f"point data {shorten(data)}"] if data else []
    told.append(
        "sections, materials and orientations, if it had any: meshio reads none of them from this format"
    )
    return told
