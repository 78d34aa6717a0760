"""Beams as matrices, and matrices in the formats of other programs, for the tests of [matrices]."""

import numpy as np

DIRECTIONS = {"x": 1, "y": 2, "z": 3, "rx": 4, "ry": 5, "rz": 6}


def make_beam(num_elements, length=1.0, axial=1e5, bending=1e3, mass=420.0):
    """K and M of a straight beam along x, 3N×3N, by the textbook's cubic element: axial rigidity EA, bending rigidity
    EI, mass per length. With the defaults and elements of 1 m all entries are whole numbers."""
    L = length
    Ke, Me = np.zeros((6, 6)), np.zeros((6, 6))
    axial_dofs, bending_dofs = np.ix_([0, 3], [0, 3]), np.ix_([1, 2, 4, 5], [1, 2, 4, 5])
    Ke[axial_dofs] = axial / L * np.array([[1, -1], [-1, 1]])
    Ke[bending_dofs] = bending / L**3 * np.array([[12, 6 * L, -12, 6 * L], [6 * L, 4 * L**2, -6 * L, 2 * L**2],
                                                  [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L**2, -6 * L, 4 * L**2]])
    Me[axial_dofs] = mass * L / 420 * np.array([[140, 70], [70, 140]])
    Me[bending_dofs] = mass * L / 420 * np.array([[156, 22 * L, 54, -13 * L], [22 * L, 4 * L**2, 13 * L, -3 * L**2],
                                                  [54, 13 * L, 156, -22 * L],
                                                  [-13 * L, -3 * L**2, -22 * L, 4 * L**2]])
    K, M = np.zeros((2, 3 * num_elements + 3, 3 * num_elements + 3))
    for e in range(num_elements):
        dofs = np.ix_(range(3 * e, 3 * e + 6), range(3 * e, 3 * e + 6))
        K[dofs] += Ke
        M[dofs] += Me
    return K, M


def plane_freedoms(ids):
    """Freedoms 3n, 3n+1, 3n+2 of node n."""
    return [(node, direction) for node in ids for direction in (1, 2, 6)]


def write_nodes(path, ids, places):
    heading = "node,x,y,z" if len(places[0]) == 3 else "node,x,y"
    rows = [",".join([str(node), *(repr(float(value)) for value in place)]) for node, place in zip(ids, places)]
    path.write_text("\n".join([heading, *rows]) + "\n")


def write_freedoms(path, freedoms):
    path.write_text("node,direction\n" + "".join(f"{node},{direction}\n" for node, direction in freedoms))


def lower(matrix):
    """(row, column, value) of the entries of the lower triangle that are not zero, 0-based."""
    return [(i, j, matrix[i, j]) for j in range(len(matrix)) for i in range(j, len(matrix)) if matrix[i, j] != 0]


def all_entries(matrix):
    return [(i, j, matrix[i, j]) for j in range(len(matrix)) for i in range(len(matrix)) if matrix[i, j] != 0]


def write_matrix_market(path, matrix, symmetric=True):
    entries = lower(matrix) if symmetric else all_entries(matrix)
    word = "symmetric" if symmetric else "general"
    rows = [f"{i + 1} {j + 1} {value!r}" for i, j, value in ((i, j, float(v)) for i, j, v in entries)]
    path.write_text("\n".join([f"%%MatrixMarket matrix coordinate real {word}", "% a comment",
                               f"{len(matrix)} {len(matrix)} {len(entries)}", *rows]) + "\n")


def write_array(path, matrix):
    rows = [repr(float(value)) for value in matrix.T.ravel()]
    size = f"{len(matrix)} {len(matrix)}"
    path.write_text("\n".join(["%%MatrixMarket matrix array real general", size, *rows]) + "\n")


def write_abaqus(path, matrix, freedoms):
    rows = [f"{freedoms[i][0]},{freedoms[i][1]}, {freedoms[j][0]},{freedoms[j][1]}, {value:.15e}"
            for i, j, value in lower(matrix)]
    path.write_text("** comment\n*MATRIX INPUT, NAME=K, TYPE=SYMMETRIC\n" + "\n".join(rows) + "\n")


def write_coordinates(path, matrix, separator=" "):
    path.write_text("".join(separator.join([str(i + 1), str(j + 1), f"{value:.16e}"]) + "\n"
                            for i, j, value in all_entries(matrix)))


def write_calculix(path, matrix):
    path.write_text("".join(f"{j + 1} {i + 1} {value:20.13e}\n" for i, j, value in lower(matrix)))


def nastran_real(value, width):
    """A number in a field of Nastran: with an exponent without letter in 8 columns, with D in 16."""
    if width == 16:
        return f"{value:.9E}".replace("E", "D").rjust(16)
    whole = f"{int(value)}."
    if value != int(value) or len(whole) > 8:
        raise ValueError(f"{value} does not fit 8 columns")
    return whole.rjust(8)


def write_dmig(path, matrices, freedoms, width=16, form=6):
    """All matrices, {name: matrix}, in one file. `width` 0: fields between commas."""
    lines = ["$ a comment"]
    for name, matrix in matrices.items():
        if width == 0:
            lines.append(f"DMIG,{name},0,{form},2,0,,,{len(matrix)}")
        else:
            lines.append(f"DMIG    {name:8}{0:8d}{form:8d}{2:8d}{0:8d}{'':16}{len(matrix):8d}")
        for j in range(len(matrix)):
            rows = [i for i in range(j if form == 6 else 0, len(matrix)) if matrix[i, j] != 0]
            lines += dmig_column(name, freedoms, j, rows, matrix[:, j], width)
    path.write_text("\n".join(lines) + "\n")


def dmig_column(name, freedoms, j, rows, values, width):
    node, direction = freedoms[j]
    if width == 0:
        first = rows[0]
        lines = [f"DMIG,{name},{node},{direction},,{freedoms[first][0]},{freedoms[first][1]},{float(values[first])}"]
        lines += [f"+,{freedoms[i][0]},{freedoms[i][1]},{float(values[i])}" for i in rows[1:]]
    elif width == 16:
        lines = [f"DMIG*   {name:16}{node:16d}{direction:16d}"]
        lines += [f"*       {freedoms[i][0]:16d}{freedoms[i][1]:16d}{nastran_real(values[i], 16)}" for i in rows]
    else:
        pair = [f"{freedoms[i][0]:8d}{freedoms[i][1]:8d}{nastran_real(values[i], 8)}{'':8}" for i in rows]
        lines = [f"DMIG    {name:8}{node:8d}{direction:8d}{'':8}{pair[0]}"]
        lines += ["        " + "".join(pair[k : k + 2]) for k in range(1, len(pair), 2)]
    return [line.rstrip() for line in lines]


def read_matrix_market(path):
    """A symmetric or general matrix of a file that sprung-reduce wrote."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("%")]
    kind = path.read_text(encoding="utf-8").splitlines()[0]
    rows, columns = (int(word) for word in lines[0].split()[:2])
    if "array" in kind:
        return np.array([float(line) for line in lines[1:]]).reshape(columns, rows).T
    matrix = np.zeros((rows, columns))
    for line in lines[1:]:
        i, j, value = line.split()
        matrix[int(i) - 1, int(j) - 1] = matrix[int(j) - 1, int(i) - 1] = float(value)
    return matrix


def write_substructure(path, matrices, freedoms, repeated=False):
    """A substructure of Abaqus: {"STIFFNESS": K, "MASS": M}, four values to a line. repeated: as CalculiX writes it, a
    node for each freedom."""
    runs = [(node, [direction]) for node, direction in freedoms]
    if not repeated:
        runs = [(node, [d for n, d in freedoms if n == node]) for node in dict.fromkeys(node for node, _ in freedoms)]
    lines = ["** a comment", f"*USER ELEMENT, NODES= {len(runs):9d}, LINEAR", "** ELEMENT NODES"]
    nodes = [f"{node:10d}" for node, _ in runs]
    lines += ["**" + ",".join(nodes[k : k + 10]) + "," for k in range(0, len(nodes), 10)]
    if not repeated and any(node <= 0 for node, _ in runs):
        lines.append("** NODE NUMBERS WHICH ARE NOT POSITIVE INDICATE Abaqus INTERNAL NODES.")
    known = None
    for position, (_, directions) in enumerate(runs, 1):
        if directions != known:
            lines.append(", ".join(str(value) for value in ([position] if known else []) + directions))
        known = directions
    for name, matrix in matrices.items():
        lines.append(f"*MATRIX,TYPE={name}")
        for i, row in enumerate(matrix):
            values = [f"{value:22.15e}" for value in row[: i + 1]]
            lines += [", ".join(values[k : k + 4]) + "," for k in range(0, i + 1, 4)]
    path.write_text("\n".join(lines) + "\n")
