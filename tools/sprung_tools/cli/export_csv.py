"""Writes quantities of a run over time as a CSV table: a column for each, with its name and unit in the first line."""

import csv
import io
from collections.abc import Sequence

import numpy as np

from sprung_tools.cli.arguments import add_span_arguments
from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.files.whole_file import check_output, write_whole
from sprung_tools.runs.labelled_runs import Run, describe, samples_between, shown_quantities
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.terminal.program import make_parser


def write_table(path: str, headings: Sequence[str], columns: Sequence[Floats]) -> None:
    """Writes columns [k] under their headings, whole or not at all, with the digits that reproduce each number
    exactly."""
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows(zip(*(column.tolist() for column in columns)))
    write_whole(path, table.getvalue())


def main() -> int:
    parser = make_parser(
        __doc__,
        "tools/export_csv bump_2modes.h5 -o bump.csv --show 'heave=bodies/chassis/displacement.y' \\\n"
        "    --show points/chassis.seat/acceleration.y --show forces/front_tyre/force",
    )
    parser.add_argument("file", metavar="FILE", help="results file")
    parser.add_argument("-o", "--output", required=True, metavar="TABLE", help="file to write (.csv)")
    parser.add_argument(
        "--show", metavar="[LABEL=]QUANTITY", action="append", required=True,
        help="a quantity such as bodies/chassis/displacement.y, and its heading; may be given several times",
    )  # fmt: skip
    add_span_arguments(parser)
    arguments = parser.parse_args()

    with open_results(arguments.file) as results:
        doubts = list_doubts([Run(describe(results), results)])
        check_output(arguments.output, [arguments.file])
        inside = samples_between(results, arguments.start, arguments.end)
        headings, columns = ["time [s]"], [results.time[inside]]
        for shown in shown_quantities(arguments.show):
            values, unit = results.series(shown.quantity)
            heading = f"{shown.label} [{unit or '1'}]"
            if heading in headings:
                raise InputError(f"--show: error: the heading '{heading}' stands twice: put a LABEL= before one")
            headings.append(heading)
            columns.append(values[inside])
    write_table(arguments.output, headings, columns)
    print("\n".join([*doubts, f"{arguments.output}: {np.count_nonzero(inside)} rows, {len(columns)} columns"]))
    return 0
