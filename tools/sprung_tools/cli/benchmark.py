"""Measures what evaluations and runs cost, against a plain dense program in the same session."""

import os
import tempfile
from pathlib import Path

from sprung_tools.benchmark.measurements import (
    BASELINE,
    LADDER,
    METHODS,
    Case,
    measure_evaluations,
    measure_growth,
    run_program,
    time_in_rounds,
)
from sprung_tools.benchmark.tables import (
    check_targets,
    draw_work_precision,
    format_evaluations,
    format_growth,
    format_runs,
    format_targets,
    work_precision_csv,
)
from sprung_tools.files.whole_file import write_whole
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.progress_bar import Progress

ROOT = Path(__file__).resolve().parents[3]
RUNS = ("bump", "terrain")
MODES = (0, 2, 4, 6, 36)
BASELINE_MODES = (0, 2, 4)  # beyond, the dense program takes minutes
DRAWN_MODES = 2  # of which the whole ladder is climbed
QUICK_DURATION = 1.2  # s


def parse_arguments():
    parser = make_parser(__doc__, "tools/benchmark --output-dir build/benchmark")
    parser.add_argument(
        "--programs", metavar="FOLDER", type=Path, default=ROOT / "build/release", help="where the programs are built"
    )
    parser.add_argument(
        "--output-dir", metavar="FOLDER", type=Path, default=ROOT / "build/benchmark",
        help="for work_precision.png, work_precision.csv and benchmark.txt",
    )  # fmt: skip
    parser.add_argument("--repetitions", type=int, default=5, metavar="N", help="of each timing; medians are told")
    parser.add_argument("--methods", nargs="+", default=list(METHODS), metavar="METHOD", help="integrators")
    parser.add_argument(
        "--modes", nargs="+", type=int, default=list(MODES), metavar="N", help="chassis modes, 0 for the rigid chassis"
    )
    parser.add_argument(
        "--quick", action="store_true", help="one short run, few tolerances: shows that all of it works, measures little"
    )
    return parser.parse_args()


def measure_runs(arguments, programs, superelements, folder):
    """All runs. Returns (results, firsts, ladders, durations) as benchmark_report wants them."""
    runs, all_modes, ladder = (("bump",), (0, 2), (1e-4, 1e-5, 1e-6, 1e-7)) if arguments.quick else (RUNS, arguments.modes, LADDER)
    results, firsts, ladders, durations, measured = {}, {}, {}, {}, {}
    cases = [(run, modes) for run in runs for modes in all_modes]
    methods = {
        modes: [*arguments.methods, *([BASELINE] if modes in BASELINE_MODES else [])] for modes in all_modes
    }
    with Progress("whole runs", sum(len(methods[modes]) for _, modes in cases)) as progress:
        for run, modes in cases:
            run_file = ROOT / f"dynamics/models/truck/{run}.toml"
            duration = QUICK_DURATION if arguments.quick else None
            case = Case(programs / "run_benchmark", run_file, superelements, modes, folder, duration)
            measured[run, modes] = case
            durations[run] = case.duration
            for method in methods[modes]:
                whole = modes == DRAWN_MODES
                key = run, modes, method
                rungs, results[key], firsts[key] = case.climb(method, arguments.repetitions, ladder, whole)
                if whole:
                    ladders[key] = rungs
                progress.step()
    results, firsts = time_in_rounds(measured, (results, firsts), arguments.repetitions)
    return results, firsts, ladders, durations


def main():
    arguments = parse_arguments()
    if arguments.quick:
        arguments.repetitions = 1
    programs = arguments.programs / "tests/benchmark"
    os.makedirs(arguments.output_dir, exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        run_program(
            [arguments.programs / "reduce/sprung-reduce", "build", ROOT / "meshes/truck/chassis.toml",
             ROOT / "meshes/truck/long_arm.toml", "--output-dir", folder]
        )  # fmt: skip
        times = measure_evaluations(
            programs / "evaluation_benchmark", arguments.repetitions, 0.001 if arguments.quick else 0.2
        )
        sizes = (10, 20) if arguments.quick else (10, 100, 1000)
        growth = measure_growth(programs / "growth_benchmark", sizes, 5 if arguments.quick else 50)
        results, firsts, ladders, durations = measure_runs(arguments, programs, folder, folder)
    text = "\n\n".join(
        (
            "One evaluation (positions, velocities, accelerations)\n" + format_evaluations(times),
            "Whole runs at the loosest tolerance that is good enough, as are the next two finer ones\n" + format_runs(results, firsts, durations),
            "Growth with the number of bodies (adams, 1e-6)\n" + format_growth(growth),
            "Targets\n" + format_targets(check_targets(times, results, firsts, durations, growth)),
        )
    )
    write_whole(arguments.output_dir / "benchmark.txt", text + "\n")
    write_whole(arguments.output_dir / "work_precision.csv", work_precision_csv(ladders))
    write_whole(arguments.output_dir / "work_precision.png", draw_work_precision(ladders))
    print(text)
    return 0
