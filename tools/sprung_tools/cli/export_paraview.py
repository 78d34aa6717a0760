"""Writes a superelement's modes, or a run as a moving vehicle, for ParaView: VTU files and a PVD file that lists them.

A superelement gives one file for each mode: the frame bent by it, with the vectors `displacement` and `rotation`. A run
gives one file for each instant: bodies as lines where they are, with `velocity`, `acceleration`, `deflection` at their
nodes and the beam resultants at both ends of each element (first, second). The resultants are those from the modes,
which those from the loads may exceed ('ride' prints both moments); of rigid bodies, and where the file has none, they
are NaN."""

import argparse
import math
import os
from pathlib import Path

from sprung_tools.cli.arguments import add_span_arguments
from sprung_tools.files.errors import InputError, WrongFormatError
from sprung_tools.files.hdf5_file import RESULTS, SUPERELEMENT, open_hdf5
from sprung_tools.files.whole_file import check_output
from sprung_tools.paraview.collection import write_folder
from sprung_tools.paraview.modes import export_modes
from sprung_tools.paraview.run import export_run
from sprung_tools.terminal.program import make_parser


def find_format(path: str | Path) -> bool:
    """Whether a file is a run; otherwise it is a superelement. InputError if it is neither."""
    try:
        open_hdf5(path, RESULTS).close()
    except WrongFormatError as error:
        if error.found != SUPERELEMENT:
            raise
        return False
    return True


def check_arguments(arguments: argparse.Namespace) -> None:
    """Throws InputError for a value that makes no sense, or that does not apply to the file's kind."""
    if not os.path.splitext(os.path.basename(arguments.output))[1] == ".pvd":
        raise InputError(f"{arguments.output}: error: the output's name must end in .pvd")
    if arguments.every is not None and not 0.0 < arguments.every < math.inf:
        raise InputError(f"--every: error: {arguments.every:g}, expected a time > 0 s")
    if not math.isfinite(arguments.magnify):
        raise InputError(f"--magnify: error: {arguments.magnify:g}, expected a finite factor")
    if arguments.is_run and arguments.modes:
        raise InputError(f"--modes: error: {arguments.file} is a run, of which instants are written")
    of_runs = {"--every": arguments.every, "--from": arguments.start, "--to": arguments.end}
    for name, value in of_runs.items():
        if not arguments.is_run and value is not None:
            raise InputError(f"{name}: error: {arguments.file} is a superelement, which has no time")


def main() -> int:
    parser = make_parser(
        __doc__,
        "tools/export_paraview chassis.h5 -o modes.pvd --modes 1 2 3\n"
        "  tools/export_paraview bump_2modes.h5 -o bump.pvd --every 0.01 --magnify 10",
    )
    parser.add_argument("file", metavar="FILE", help="superelement file or results file")
    parser.add_argument("-o", "--output", required=True, metavar="NAME.pvd", help="list to write; NAME holds the files")
    parser.add_argument("--modes", metavar="NUMBER", type=int, nargs="+", help="modes of a superelement (default: all)")
    parser.add_argument(
        "--magnify",
        metavar="FACTOR",
        type=float,
        default=1.0,
        help="factor of the deflections of a run, or of the modes",
    )
    parser.add_argument(
        "--every", metavar="S", type=float, help="time between the instants of a run, s (default: all samples)"
    )
    add_span_arguments(parser)
    arguments = parser.parse_args()
    check_output(arguments.output, [arguments.file])
    arguments.is_run = find_format(arguments.file)
    check_arguments(arguments)

    def write_files(folder: str) -> list[tuple[float, str]]:
        if arguments.is_run:
            span = (arguments.start, arguments.end)
            return export_run(arguments.file, folder, span, arguments.every, arguments.magnify)
        return export_modes(arguments.file, folder, arguments.modes, arguments.magnify)

    count = write_folder(arguments.output, write_files)
    print(f"{arguments.output}: {count} {'instants' if arguments.is_run else 'modes'}")
    return 0
