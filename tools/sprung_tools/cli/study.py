"""Runs a study: many runs of one run file with other parameters, on all processors.

STUDY.toml says which keys change, how their values are chosen (a grid, lists, Latin hypercube or Sobol points), and
which measures are taken; tools/README.md lists its keys. The folder gets the table (table.csv, table.h5) and a page
(study.html) that opens in a browser without a network. The outcome of each run is kept as soon as the run ends: an
interrupted study goes on where it was when the same command is given again, and a study with more values makes only the
runs that are missing. A run that fails is a row with its error.

With --workflow it makes no runs, but writes a Snakefile with parts of the study as jobs, for many machines."""

import argparse
import shlex
import sys
from pathlib import Path

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import write_whole
from sprung_tools.programs.calls import CHECK_FAILED
from sprung_tools.programs.finding import find_programs
from sprung_tools.programs.process_pool import count_processors
from sprung_tools.study.description import Study
from sprung_tools.study.effects import LEAST_SEEN, Effect, calc_effects
from sprung_tools.study.execution import Finished, Options, find_missing, run_study
from sprung_tools.study.page import make_study_page
from sprung_tools.study.sampling import is_balanced, make_points
from sprung_tools.study.study_file import read_study
from sprung_tools.study.table import format_csv, make_hdf5, make_measure_columns
from sprung_tools.study.workflow import PARTS, SNAKEFILE, format_snakefile, parse_part
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

MOST_SHOWN = 12  # effects, errors


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(__doc__, "tools/study dynamics/models/examples/quarter_car_study.toml -o quarter_car_study")
    parser.add_argument("study", metavar="STUDY.toml", help="study file")
    parser.add_argument(
        "-o", "--output", required=True, type=Path, metavar="FOLDER", help="folder of the rows, the table and the page"
    )
    parser.add_argument(
        "--jobs", type=int, default=count_processors(), metavar="N",
        help="runs at the same time (default: as many as there are processors)",
    )  # fmt: skip
    parser.add_argument("--retry-failed", action="store_true", help="make the runs again whose rows have an error")
    parser.add_argument("--keep-results", action="store_true", help="keep the results files in FOLDER/results")
    parser.add_argument(
        "--programs", metavar="FOLDER",
        help="build folder or installation with the programs (default: that of the installation, build/release, PATH)",
    )  # fmt: skip
    parts = parser.add_mutually_exclusive_group()
    parts.add_argument("--workflow", type=int, metavar="N", help="write FOLDER/Snakefile with N parts; make no runs")
    parts.add_argument("--part", metavar="K/N", help="make part K of N only, in FOLDER/parts/K, without table and page")
    parts.add_argument("--collect", action="store_true", help="take over the rows of FOLDER/parts")
    arguments = parser.parse_args()
    if arguments.keep_results and (arguments.workflow or arguments.part or arguments.collect):
        parser.error("--keep-results: a study in parts keeps no results files")
    if arguments.workflow is not None and arguments.workflow < 1:
        parser.error(f"--workflow must be at least 1, got {arguments.workflow}")
    if arguments.jobs < 1:
        parser.error(f"--jobs must be at least 1, got {arguments.jobs}")
    return arguments


def format_effects(effects: list[Effect]) -> str:
    """The largest effects as a table, and what it leaves out."""
    seen = sorted((one for one in effects if one.is_seen), key=lambda one: -(one.share or 0.0))
    rows = [
        (one.measure, one.parameter, f"{100.0 * (one.share or 0.0):.0f} %", f"{100.0 * one.chance:.0f} %")
        for one in seen[:MOST_SHOWN]
    ]
    headings = ("measure", "parameter", "explains of the variance", "chance up to")
    text = [format_table(headings, sorted(rows))] if rows else []
    ranges = list(dict.fromkeys(one.parameter for one in effects if one.is_of_ranges and one.share is not None))
    if ranges:
        text.append(f"remark: many values are put into five groups or fewer, whose means count: {', '.join(ranges)}")
    judged = {one.parameter for one in effects if one.share is not None}
    unknown = [one for one in dict.fromkeys(one.parameter for one in effects) if one not in judged]
    weak = sum(one.share is not None and not one.is_seen for one in effects)
    if len(seen) > MOST_SHOWN:
        others = len(seen) - MOST_SHOWN
        text.append(f"remark: {others} smaller effect{' is' if others == 1 else 's are'} on the page only")
    if weak:
        text.append(f"remark: {weak} other effects explain no more than chance, or less than {100.0 * LEAST_SEEN:g} %")
    if unknown:
        text.append(f"remark: cannot be judged, with one value or too few runs: {', '.join(unknown)}")
    return "\n".join(text)


def format_errors(finished: Finished) -> list[str]:
    """A line for each different error, with the number of its runs."""
    counts: dict[str, list[int]] = {}
    for number, row in enumerate(finished.rows, start=1):
        if row.error:
            counts.setdefault(row.error, []).append(number)
    lines = []
    for error, runs in counts.items():
        others = f" and {len(runs) - 1} more" if len(runs) > 1 else ""
        lines.append(f"run {runs[0]}{others}: {error}")
    return lines[:MOST_SHOWN] + [f"… and {len(lines) - MOST_SHOWN} other errors"] * (len(lines) > MOST_SHOWN)


def write_workflow(study: Study, folder: Path, programs: str | None, parts: int) -> None:
    """Writes the Snakefile of a study."""
    number = min(parts, len(make_points(study)))
    (folder / PARTS).mkdir(parents=True, exist_ok=True)  # Slurm writes what jobs say there, and ends those it cannot
    command = Path(sys.argv[0]).resolve()
    text = format_snakefile(command, study, programs, find_programs(programs), number)
    write_whole(folder / SNAKEFILE, text)
    print(f"{folder / SNAKEFILE}: {len(make_points(study))} runs in {number} parts")
    words = ("snakemake", "--directory", str(folder), "--snakefile", str(folder / SNAKEFILE), "--cores", "all")
    print(shlex.join((*words, "--rerun-incomplete")))


def summarise(finished: Finished) -> str:
    """How many runs there are, and how they ended."""
    failed = sum(row.has_failed for row in finished.rows)
    same = len(finished.rows) - finished.made - finished.kept
    repeated = f", {same} the same as others" if same else ""
    doubtful = sum(row.exit_code == CHECK_FAILED for row in finished.rows)
    more = f", {doubtful} with a failed check" if doubtful else ""
    made = f"{finished.made} made, {finished.kept} kept from before{repeated}"
    again = f"; --retry-failed makes {finished.kept_failed} of them again" if finished.kept_failed else ""
    return f"{len(finished.rows)} runs: {made}, {failed} failed{more}{again}"


def main() -> int:
    arguments = parse_arguments()
    study = read_study(arguments.study)
    if arguments.keep_results and study.command != "run":
        raise InputError(f"{study.file.path}: error: --keep-results: '{study.command}' writes no results files")
    if arguments.workflow is not None:
        write_workflow(study, arguments.output, arguments.programs, arguments.workflow)
        return 0
    part = parse_part(arguments.part) if arguments.part else None
    programs = find_programs(arguments.programs)
    folder = part.folder(arguments.output) if part else arguments.output
    options = Options(folder, arguments.jobs, arguments.retry_failed, arguments.keep_results, part, arguments.collect)
    if not is_balanced(study.sampling):
        number = study.sampling.number
        print(f"remark: Sobol points are balanced where they are 1, 2, 4, 8, …; here {number}", file=sys.stderr)
    try:
        finished = run_study(study, programs, options)
    except KeyboardInterrupt:
        print(f"{options.folder}: the runs that have ended are kept; the same command goes on", file=sys.stderr)
        raise
    if part:
        print(summarise(finished))
        return 0
    columns = make_measure_columns(finished)
    effects = calc_effects(finished, columns)
    write_whole(options.folder / "table.csv", format_csv(finished, columns))
    write_whole(options.folder / "table.h5", make_hdf5(finished, columns))
    write_whole(options.folder / "study.html", make_study_page(finished, columns, effects))
    print(summarise(finished))
    for line in format_errors(finished):
        print(line, file=sys.stderr)
    there = {one.measure for one in columns if not np.all(np.isnan(one.values))}
    missing = find_missing(study.measures, there)
    for name in missing:
        print(f"warning: no run has the measure {name}", file=sys.stderr)
    if effects:
        print(f"\n{format_effects(effects)}\n")
    print(f"{options.folder / 'table.csv'}, table.h5")
    print(f"Open it in a browser: {(options.folder / 'study.html').resolve().as_uri()}")
    if all(row.has_failed for row in finished.rows):
        raise InputError(f"{study.file.path}: error: all runs failed")
    return CHECK_FAILED if missing else 0
