"""Writes one page on one or more runs, which opens from disk in any browser without a network: what was run, a table
that compares the runs, histories, spectra, modal amplitudes, and the vehicle driving over its road."""

import sys
from pathlib import Path

from sprung_tools.files.whole_file import check_output, write_whole
from sprung_tools.report.page import LARGEST, make_small_page
from sprung_tools.report.summary import read_checks
from sprung_tools.runs.labelled_runs import join_titles, open_runs, runs_with, shown_quantities
from sprung_tools.terminal.program import make_parser


def main() -> int:
    parser = make_parser(
        __doc__,
        "tools/report rigid=bump_rigid.h5 '2 modes=bump_2modes.h5' -o report.html --superelements build/truck",
    )
    parser.add_argument("runs", metavar="[LABEL=]FILE", nargs="+", help="results file, and its name on the page")
    parser.add_argument("-o", "--output", required=True, metavar="PAGE", help="file to write (.html)")
    parser.add_argument("--title", default="", help="heading (default: the names of the vehicles)")
    parser.add_argument(
        "--superelements", metavar="FOLDER", help="folder of the superelement files, to show their checks"
    )
    parser.add_argument(
        "--show", metavar="[LABEL=]QUANTITY", action="append", default=[],
        help="a further quantity to show, such as points/chassis.rear_end/displacement.y",
    )  # fmt: skip
    arguments = parser.parse_args()

    runs = open_runs(arguments.runs)
    check_output(arguments.output, [run.results.path for run in runs])
    extra = shown_quantities(arguments.show)
    for shown in extra:
        runs_with(runs, shown)
    title = arguments.title or join_titles(run.results.title for run in runs)
    checks = read_checks(arguments.superelements, runs)
    page = make_small_page(title, runs, extra, checks)
    write_whole(arguments.output, page)
    size = len(page.encode())
    print(f"{arguments.output}: {len(runs)} run{'s' * (len(runs) > 1)}, {size / 1e6:.1f} MB")
    if size > LARGEST:
        print(f"{arguments.output}: warning: a page this large may open slowly; give fewer runs", file=sys.stderr)
    print(f"Open it in a browser: {Path(arguments.output).resolve().as_uri()}")
    return 0
