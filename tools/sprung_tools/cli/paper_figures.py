"""Compares the truck with the paper from which it comes: builds the programs, makes all runs again, and puts the tables
and figures of the report into dynamics/models/truck/README.md and its folder figures/.

The results files and the superelements go to --output-dir. Everything takes some minutes; --quick leaves out the runs
with 24 and 36 modes and prints the tables instead of writing them."""

import argparse
import subprocess
from pathlib import Path

from sprung_tools.files.errors import InputError
from sprung_tools.files.project import ROOT
from sprung_tools.files.whole_file import write_whole
from sprung_tools.paper_report.certified_runs import list_certified_runs, list_timed_certified_runs
from sprung_tools.paper_report.markdown import format_markdown, format_words, replace_part
from sprung_tools.paper_report.mode_runs import list_mode_runs, list_timed_mode_runs
from sprung_tools.paper_report.paper_runs import (
    EXPENSIVE_MODES,
    TRUCK,
    PaperRun,
    count_chassis_modes,
    list_adams_runs,
    list_convergence_runs,
    list_finer_runs,
    list_main_runs,
    list_sensitivity_runs,
    list_speed_runs,
    list_timed_main_runs,
    list_tyre_runs,
    write_roads,
)
from sprung_tools.paper_report.pictures import draw_all, write_picture
from sprung_tools.paper_report.programs import (
    Programs,
    build_superelements,
    find_programs,
    measure_costs,
    print_progress,
    run_all,
)
from sprung_tools.paper_report.run_numbers import Numbers
from sprung_tools.paper_report.tables import list_tables, list_texts
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import Table, format_table

REPORT = TRUCK / "README.md"


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(__doc__, "tools/paper_figures --output-dir /tmp/paper --quick")
    parser.add_argument(
        "--output-dir", type=Path, default=ROOT / "build/truck/paper", metavar="FOLDER",
        help="where results and superelements go (default: build/truck/paper in the project)",
    )  # fmt: skip
    parser.add_argument(
        "--programs", type=Path, metavar="FOLDER",
        help="build folder whose programs are used as they are (default: build/release, built first)",
    )  # fmt: skip
    parser.add_argument(
        "--figures-dir",
        type=Path,
        metavar="FOLDER",
        help="write the figures here, and do not touch the report",
    )
    parser.add_argument("--quick", action="store_true", help="no run with 24 modes or more, no report")
    parser.add_argument(
        "--no-timing",
        action="store_true",
        help="leave out the processor times, which need some minutes and an idle machine; the report is left as it is",
    )
    return parser.parse_args()


def make_programs(folder: Path | None) -> Programs:
    """Finds the programs in a folder; builds them if none is given."""
    if folder is None:
        subprocess.run([ROOT / "tools/build", "sprung-reduce", "sprung-dynamics"], check=True)
        folder = ROOT / "build/release"
    return find_programs(folder)


def list_runs(quick: bool, folder: Path) -> list[PaperRun]:
    """The runs to make. folder: that of the terrain profiles."""
    runs = [
        *list_main_runs(),
        *list_convergence_runs(),
        *list_adams_runs(),
        *list_finer_runs(),
        *list_sensitivity_runs(folder),
        *list_speed_runs(),
        *list_tyre_runs(),
        *list_mode_runs(),
        *list_certified_runs(),
    ]
    return [run for run in runs if not quick or count_chassis_modes(run) < EXPENSIVE_MODES]


def write_report(tables: dict[str, Table], texts: dict[str, str]) -> None:
    """Puts tables and texts between their markers in the report. InputError, and an unchanged report, if a marker is
    missing."""
    text = REPORT.read_text(encoding="utf-8")
    for name, content in texts.items():
        text = replace_part(text, name, format_words(content))
    for name, table in tables.items():
        text = replace_part(text, name, format_markdown(*table))
    write_whole(REPORT, text)


def main() -> int:
    arguments = parse_arguments()
    folder = arguments.output_dir.resolve()
    try:
        programs = make_programs(arguments.programs)
    except subprocess.CalledProcessError as error:
        raise InputError("tools/build: error: the programs could not be built") from error
    build_superelements(programs, folder)
    write_roads(folder)
    runs = list_runs(arguments.quick, folder)
    run_all(programs, runs, folder, print_progress)
    costs = None
    if not arguments.no_timing:
        timed = [*list_timed_main_runs(), *list_timed_mode_runs(), *list_timed_certified_runs()]
        costs = measure_costs(programs, folder, timed, report=print_progress)
    numbers = Numbers(folder, costs, [run.name for run in runs])
    tables = {name: make(numbers) for name, make in list_tables().items()}
    texts = {name: make(numbers) for name, make in list_texts().items()}
    for text in (*(format_table(*table) for table in tables.values()), *texts.values()):
        print(text, end="\n\n")
    changes_report = not (arguments.quick or arguments.figures_dir or arguments.no_timing)
    figures = arguments.figures_dir or (TRUCK / "figures" if changes_report else folder)
    figures.mkdir(parents=True, exist_ok=True)
    for name, figure in draw_all(numbers).items():
        write_picture(figure, figures / name)
        print(figures / name)
    if changes_report:
        write_report(tables, texts)
        print(REPORT)
    return 0
