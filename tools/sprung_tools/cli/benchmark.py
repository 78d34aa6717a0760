"""Measures the cost of evaluations and runs, against a plain dense program in the same session.

With `reduce` it measures whole builds of large lattices instead: processor time and memory of stage one. With
`tolerances` it measures errors over the tolerance of a run, by the number of modes."""

import argparse
import os
import tempfile
from pathlib import Path

from sprung_tools.benchmark.bases import format_bases, measure_bases
from sprung_tools.benchmark.lattices import (
    COLUMNS, HANGING, LATTICES, METHOD_LATTICES, NUM_MODES, QUICK_LATTICES, format_builds, format_hanging,
    format_methods, measure_build, measure_hanging, measure_methods,
)  # fmt: skip
from sprung_tools.benchmark.many_runs import check_many_runs, format_many_runs, measure_many_runs
from sprung_tools.benchmark.programs import measure_evaluations, measure_growth, run_program
from sprung_tools.benchmark.tables import format_evaluations, format_growth, format_runs
from sprung_tools.benchmark.targets import check_targets, format_targets
from sprung_tools.benchmark.tolerances import MODES as MODES_OF_TOLERANCES
from sprung_tools.benchmark.tolerances import TOLERANCES, format_tolerances, measure_tolerances
from sprung_tools.benchmark.whole_runs import LADDER, METHODS, Plan, measure_runs
from sprung_tools.benchmark.work_precision import draw_work_precision, work_precision_csv
from sprung_tools.files.project import ROOT
from sprung_tools.files.whole_file import write_whole
from sprung_tools.terminal.program import make_parser

RUNS = ("bump", "terrain")
MODES = (0, 2, 4, 6, 36)
QUICK_DURATION = 1.2  # s


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(__doc__, "tools/benchmark --output-dir build/benchmark")
    what = "what to measure in place of evaluations and runs"
    parser.add_argument("what", nargs="?", choices=("reduce", "tolerances"), help=what)
    parser.add_argument(
        "--programs", metavar="FOLDER", type=Path, default=ROOT / "build/release", help="where the programs are built"
    )
    parser.add_argument(
        "-o", "--output-dir", metavar="FOLDER", type=Path, default=ROOT / "build/benchmark",
        help="for work_precision.png, work_precision.csv and benchmark.txt",
    )  # fmt: skip
    parser.add_argument(
        "--repetitions", type=int, metavar="N", help="of each timing; the tables show medians (default: 5)"
    )
    parser.add_argument(
        "--methods", nargs="+", choices=METHODS, metavar="METHOD", help="integrators (default: all)"
    )
    parser.add_argument("--modes", nargs="+", type=int, metavar="N", help="chassis modes, 0 for the rigid chassis")
    parser.add_argument(
        "--quick", action="store_true",
        help="one short run, few tolerances: shows that all of it works, measures little",
    )  # fmt: skip
    arguments = parser.parse_args()
    chosen = [arguments.repetitions, arguments.methods, arguments.modes]
    if arguments.what is not None and chosen != [None, None, None]:
        parser.error(f"--repetitions, --methods and --modes do not go with '{arguments.what}'")
    arguments.repetitions = 5 if arguments.repetitions is None else arguments.repetitions
    arguments.methods = arguments.methods or list(METHODS)
    if arguments.repetitions < 1 or min(arguments.modes or MODES) < 0:
        parser.error("--repetitions must be at least 1, and --modes at least 0")
    return arguments


def make_plan(arguments: argparse.Namespace) -> Plan:
    if arguments.quick:
        modes = arguments.modes or (0, 2)
        return Plan(("bump",), modes, arguments.methods, (1e-4, 1e-5, 1e-6, 1e-7), 1, QUICK_DURATION)
    return Plan(RUNS, arguments.modes or MODES, arguments.methods, LADDER, arguments.repetitions, None)


def measure_reduction(arguments: argparse.Namespace) -> str:
    """Builds lattices, and writes what that took. The largest needs 8 GB."""
    programs = arguments.programs.resolve()
    with tempfile.TemporaryDirectory() as folder:
        lattices = QUICK_LATTICES if arguments.quick else LATTICES
        costs = [measure_build(programs, one, Path(folder)) for one in lattices]
        hanging = measure_hanging(programs, HANGING, Path(folder))
        small = QUICK_LATTICES if arguments.quick else METHOD_LATTICES
        methods = [measure_methods(programs, one, Path(folder)) for one in small]
    tables = (
        ("Whole builds of lattices, about 20 free modes", format_builds(costs)),
        ("A lattice held at the end of a thin rod", format_hanging(hanging)),
        (f"Factors and {COLUMNS} solutions, {NUM_MODES} held modes, by both methods, CPU s", format_methods(methods)),
    )
    text = "\n\n".join(f"{title}\n{table}" for title, table in tables)
    write_whole(arguments.output_dir / "benchmark_reduce.txt", text + "\n")
    return text


def build_truck(programs: Path, folder: Path) -> None:
    """Builds the truck's superelements into a folder."""
    run_program(
        [programs / "reduce/sprung-reduce", "build", ROOT / "meshes/truck/chassis.toml",
         ROOT / "meshes/truck/chassis_certified.toml", ROOT / "meshes/truck/long_arm.toml", "--output-dir", folder]
    )  # fmt: skip


def measure_accuracy(arguments: argparse.Namespace) -> str:
    """Measures errors over tolerances, and writes the table."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        build_truck(arguments.programs, folder)
        found = measure_tolerances(
            arguments.programs / "tests/benchmark/run_benchmark", folder, folder,
            *(
                (("bump",), (0, 2), (1e-3, 1e-5), QUICK_DURATION)
                if arguments.quick
                else (RUNS, MODES_OF_TOLERANCES, TOLERANCES, None)
            ),
        )  # fmt: skip
    text = (
        "Errors of the default method over its tolerance, by the number of modes: of the chassis height, m, and of its "
        "acceleration, r.m.s. of r.m.s.\n" + format_tolerances(found)
    )
    write_whole(arguments.output_dir / "benchmark_tolerances.txt", text + "\n")
    return text


def main() -> int:
    arguments = parse_arguments()
    if arguments.what is not None:
        os.makedirs(arguments.output_dir, exist_ok=True)
        print(measure_reduction(arguments) if arguments.what == "reduce" else measure_accuracy(arguments))
        return 0
    plan = make_plan(arguments)
    programs = arguments.programs / "tests/benchmark"
    os.makedirs(arguments.output_dir, exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        build_truck(arguments.programs, folder)
        min_time = 0.001 if arguments.quick else 0.2
        times = measure_evaluations(programs / "evaluation_benchmark", plan.repetitions, min_time)
        sizes = (10, 20) if arguments.quick else (10, 100, 1000)
        growth = measure_growth(programs / "growth_benchmark", sizes, 5 if arguments.quick else 50)
        dynamics = arguments.programs.resolve() / "dynamics/sprung-dynamics"
        many = measure_many_runs(dynamics, folder, 2 if arguments.quick else 20, plan.duration)
        bases = measure_bases(dynamics, folder, 2 if arguments.quick else 20, plan.duration)
        results, firsts, ladders, durations = measure_runs(programs / "run_benchmark", folder, folder, plan)
    targets = [*check_targets(times, results, firsts, durations, growth), *check_many_runs(many)]
    text = "\n\n".join(
        (
            "One evaluation (positions, velocities, accelerations)\n" + format_evaluations(times),
            "Whole runs at the loosest tolerance that is good enough, as are the next two finer ones\n"
            + format_runs(results, firsts, durations),
            "Many runs with the outputs of their files, without results files and with them\n"
            + format_many_runs(many),
            "The bump with a certified basis of the chassis, and with as many clamped modes\n" + format_bases(bases),
            "Growth with the number of bodies (adams, 1e-6)\n" + format_growth(growth),
            "Targets\n" + format_targets(targets),
        )
    )
    write_whole(arguments.output_dir / "benchmark.txt", text + "\n")
    write_whole(arguments.output_dir / "work_precision.csv", work_precision_csv(ladders))
    write_whole(arguments.output_dir / "work_precision.png", draw_work_precision(ladders))
    print(text)
    return 0
