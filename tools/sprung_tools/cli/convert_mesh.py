"""Reads the frame in another program's mesh file (Abaqus, Nastran, MED, Code_Aster's .mail, VTK, gmsh and the other
formats of meshio) and writes it as a gmsh 4.1 mesh: every line element, every set of elements as a physical curve,
every set of nodes as physical points. Beside OUT.msh it writes a starter design OUT.toml with the sections, materials
and masses that the source gives; an OUT.toml that is already there stays as it is."""

import math
import os

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import check_output, write_whole
from sprung_tools.mesh_import.divided_lines import divide_lines
from sprung_tools.mesh_import.gmsh_writer import write_msh
from sprung_tools.mesh_import.ladder_frame import unite_rails
from sprung_tools.mesh_import.line_mesh import LineMesh
from sprung_tools.mesh_import.mesh_file import read_mesh
from sprung_tools.mesh_import.plane_frame import PlaneFrame, make_plane_frame
from sprung_tools.mesh_import.starter_design import find_doubts, format_design, list_left_out
from sprung_tools.mesh_import.units import Units
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

MOST_POINTS = 24  # points that are listed by name
MOST_PARTS = 1000  # elements in a line
PLANES = ("xy", "xz", "yz", "yx", "zx", "zy")


def print_report(mesh: LineMesh, frame: PlaneFrame, plane: str, units: Units, output: str) -> None:
    """Prints what was kept, what became of the rest, and what the source holds that a mesh cannot hold."""
    width, height = frame.positions.max(axis=0) - frame.positions.min(axis=0)
    print(
        f"{mesh.path}: {mesh.format}, {len(frame.node_ids)} nodes and {len(frame.lines)} lines in the "
        f"{plane[0]}–{plane[1]} plane, {width:g} m by {height:g} m"
    )
    rows = [("curve", name, f"{len(lines)} element{'s' * (len(lines) > 1)}") for name, lines in frame.curves.items()]
    points = [("point", name, f"node {frame.node_ids[node]}") for name, node in frame.points.items()]
    rows += points[:MOST_POINTS]
    if len(points) > MOST_POINTS:
        rows.append(("point", "…", f"{len(points) - MOST_POINTS} more"))
    print("\nKept")
    print(format_table(("physical", "name", "holds"), rows))
    for heading, texts in (
        ("Not kept as it was", frame.remarks),
        (
            "In the source, but neither in the mesh nor in the starter design",
            [*mesh.left_behind, *list_left_out(mesh, frame, plane, units)],
        ),
    ):
        if texts:
            print(f"\n{heading}")
            print("\n".join(f"  {text}" for text in texts))
    print(f"\nMesh: {output}")


def write_design(text: str, path: str) -> None:
    """Writes the starter design, unless there is a file of its name: somebody may have completed it."""
    if os.path.exists(path):
        print(f"Design: {path} is there already and stays as it is; remove it to get a starter design")
        return
    write_whole(path, text)
    print(f"Starter design: {path}")


def main() -> int:
    parser = make_parser(
        __doc__,
        "tools/convert_mesh chassis.inp chassis.msh\n  tools/convert_mesh frame.bdf frame.msh --plane xz --scale 1e-3",
    )
    parser.add_argument("input", metavar="IN", help="mesh file; its ending says which format it has")
    parser.add_argument("output", metavar="OUT.msh", help="gmsh 4.1 file to write")
    parser.add_argument(
        "--plane", choices=PLANES, default="xy", help="the source's axes that become x and y (default: xy)"
    )
    parser.add_argument(
        "--unite-rails", action="store_true",
        help="unite a frame of two equal rails, which is symmetric about the middle plane, into that plane",
    )  # fmt: skip
    parser.add_argument(
        "--sections", metavar="SET", nargs="+", default=(),
        help="the element sets that become curves, where sets overlap; the others are left out",
    )  # fmt: skip
    parser.add_argument(
        "--elements", metavar="N", type=int, default=1,
        help="divide each line into N elements: a frame with one element per member is too coarse (default: 1)",
    )  # fmt: skip
    parser.add_argument(
        "--scale", metavar="M", type=float, default=1.0, help="length of the source's unit in metres (mm: 1e-3)"
    )
    parser.add_argument(
        "--force", metavar="N", type=float, default=1.0,
        help="the source's unit of force in newtons, for moduli and densities (pound: 4.4482216)",
    )  # fmt: skip
    arguments = parser.parse_args()
    if not arguments.output.endswith(".msh"):
        raise InputError(f"{arguments.output}: error: the output's name must end in .msh")
    for name, value, expected in (
        ("--scale", arguments.scale, "a length > 0 m"), ("--force", arguments.force, "a force > 0 N"),
    ):  # fmt: skip
        if not 0.0 < value < math.inf:
            raise InputError(f"{name}: error: {value:g}, expected {expected}")
    if not 1 <= arguments.elements <= MOST_PARTS:
        raise InputError(f"--elements: error: {arguments.elements}, expected 1 … {MOST_PARTS}")
    mesh = read_mesh(arguments.input)
    check_output(arguments.output, [arguments.input])
    if arguments.unite_rails:
        mesh = unite_rails(mesh, arguments.plane)
    frame = make_plane_frame(mesh, arguments.plane, arguments.sections, arguments.scale)
    write_msh(divide_lines(frame, arguments.elements), arguments.output)
    units = Units(arguments.scale, arguments.force)
    design = format_design(mesh, frame, arguments.plane, units, os.path.basename(arguments.output))
    print_report(mesh, frame, arguments.plane, units, arguments.output)
    if arguments.elements > 1:
        print(f"Each of the lines kept is divided into {arguments.elements} elements")
    write_design(design, arguments.output.removesuffix(".msh") + ".toml")
    for doubt in (*mesh.doubts, *find_doubts(mesh, frame, units)):
        print(f"remark: {doubt}")
    return 0
