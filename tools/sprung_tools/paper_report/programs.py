"""Running the programs for the report: all runs in parallel, and what they cost."""

import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.project import ROOT
from sprung_tools.paper_report.certified_runs import CERTIFIED_DESIGN, write_free_design
from sprung_tools.paper_report.paper_runs import DESIGNS, TRUCK, PaperRun, count_chassis_modes, name_start

Printer = Callable[[str], None]

MODES_MISSING = "warning: modes are missing: "
# What some runs are to show.
OF_MODES = (
    MODES_MISSING,
    " its modes miss ",
    " axial forces change the bending by ",
    ", where nothing is known of what its superelement misses",  # above the band of a certified basis
)
# Horizontal accelerations, and moments of the arms.
COARSE_ELSEWHERE = re.compile(
    r"do not resolve the (accelerations: that of \S+ along x |bending moments of \w+_long_arm:)"
)
REPEATS = 9  # timed runs of each model


class Programs(NamedTuple):
    """The paths of the two programs."""

    reduce: Path
    dynamics: Path


def find_programs(folder: Path) -> Programs:
    """Finds the programs in a build folder. InputError if they are not there."""
    programs = Programs(folder / "reduce/sprung-reduce", folder / "dynamics/sprung-dynamics")
    for path in programs:
        if not os.access(path, os.X_OK):
            raise InputError(f"{path}: error: no such program; tools/build makes build/release")
    return programs


def call(command: Sequence[str | Path]) -> str:
    """Runs a program in the project's folder. Returns its standard output. InputError, with its message, if it
    fails."""
    done = subprocess.run(
        command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", errors="replace"
    )
    if done.returncode != 0:
        raise InputError(f"{' '.join(map(str, command))}: error: exit code {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def build_superelements(programs: Programs, folder: Path) -> None:
    """Reduces chassis, by each basis, and long arm into a folder, unless they are up to date there."""
    folder.mkdir(parents=True, exist_ok=True)
    designs: list[str | Path] = [*DESIGNS, CERTIFIED_DESIGN, write_free_design(folder.resolve())]
    call([programs.reduce, "build", *designs, "--output-dir", folder.resolve()])


def make_command(programs: Programs, run: PaperRun, folder: Path, output: Path | None = None) -> list[str | Path]:
    """The command line of a run whose superelements are in `folder`."""
    command: list[str | Path] = [programs.dynamics, "run", TRUCK / run.file]
    command += ["--superelements", folder.resolve(), "--quiet"]
    for override in run.overrides:
        command += ["--set", override]
    if output:
        command += ["-o", output.resolve()]
    return command


def list_warnings(said: str) -> list[str]:
    """The lines with warnings among those that a program prints at the end of a run."""
    return [line for line in said.splitlines() if line.startswith("warning: ")]


def run_all(programs: Programs, runs: Sequence[PaperRun], folder: Path, report: Printer = print) -> None:
    """Makes all runs, as many at a time as there are processors: results in FOLDER/NAME.h5, what each prints in
    FOLDER/NAME.txt.

    report: called with a line as each run ends. InputError at the first run that fails or ends with a warning; warnings
    of what the modes miss are allowed, because some of the runs show just that, and those that a run says it may have.
    Runs that have begun are finished.
    """
    began = time.monotonic()
    # The longest runs come first, so that none of them is left alone at the end.
    ordered = sorted(runs, key=count_chassis_modes, reverse=True)

    def run_one(run: PaperRun) -> str:
        said = call(make_command(programs, run, folder, folder / f"{run.name}.h5"))
        (folder / f"{run.name}.txt").write_text(said, encoding="utf-8")
        for warning in list_warnings(said):
            is_allowed = any(part in warning for part in OF_MODES)
            is_allowed = is_allowed or run.is_coarse_elsewhere and COARSE_ELSEWHERE.search(warning) is not None
            if not is_allowed:
                raise InputError(f"{folder / run.name}.h5: error: no run for a report: {warning}")
        return run.name

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        waiting = [pool.submit(run_one, run) for run in ordered]
        try:
            for count, done in enumerate(as_completed(waiting), start=1):
                report(f"[{count:3d}/{len(runs)}] {done.result():<32} {time.monotonic() - began:6.1f} s")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def measure_processor_time(command: Sequence[str | Path]) -> float:
    """Runs a program. Returns its processor time [s], including that of the system."""
    process = subprocess.Popen(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise InputError(f"{' '.join(map(str, command))}: error: exit code {process.returncode}")
    return usage.ru_utime + usage.ru_stime


def measure_costs(programs: Programs, folder: Path, runs: Sequence[PaperRun], report: Printer) -> dict[str, float]:
    """Measures the processor times of runs: run name → median [s]. If several runs have one name, the first is
    measured.

    No results are written. The runs take turns, so that other work of the machine affects all of them alike. The time
    before the first step is that of a dry run; it is kept under name_start(run name).
    """
    named = {run.name: run for run in reversed(runs)}
    times: dict[str, list[float]] = {name: [] for run_name in named for name in (run_name, name_start(run_name))}
    for turn in range(REPEATS):
        report(f"timing, round {turn + 1} of {REPEATS}")
        for name, run in named.items():
            command = make_command(programs, run, folder)
            times[name].append(measure_processor_time(command))
            times[name_start(name)].append(measure_processor_time([*command, "--dry-run"]))
    return {name: statistics.median(values) for name, values in times.items()}


def print_progress(text: str) -> None:
    """Prints a line on stderr at once."""
    print(text, file=sys.stderr, flush=True)
