"""Whole runs: the loosest tolerance at which each method is accurate enough, and the cost of a run with it."""

import itertools
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.benchmark.programs import run_program
from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.project import ROOT
from sprung_tools.terminal.progress_bar import Progress

BASELINE = "baseline"  # dense equations under Dormand–Prince 5(4)
METHODS = ("exponential", "adams", "bdf", "generalized-alpha")  # as in run files
REFERENCE_METHOD, REFERENCE_TOLERANCE = "exponential", 1e-9
LADDER = (
    1e-1, 5e-2, 3e-2, 2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 3e-7, 1e-7,
)  # fmt: skip
CONFIRMATIONS = 2  # the next finer rungs that must be good enough, too
LONG_RUN, TOO_LONG_RUN = 0.5, 8.0  # s: a long run is not repeated; after a too long one the method is given up
RUNS_IN_A_ROUND = 3  # the fastest of them counts: the first one fills the caches
HIGH_PASS = 16.0  # Hz
ALLOWED_HEIGHT = 1e-4  # m
ALLOWED_SHARE = 0.01  # error of peak and r.m.s. of the acceleration and of the deflection


BASELINE_MODES = (0, 2, 4)  # with more modes the dense program takes minutes
DRAWN_MODES = 2  # every rung is measured for the picture; without 2 modes it shows the first number asked for

Key = tuple[str, int, str]  # run, modes, method
Rungs = dict[Key, "Rung | None"]


class Series(NamedTuple):
    """Samples of a run, SI units: the columns that run_benchmark writes."""

    time: Floats
    height: Floats
    acceleration: Floats
    deflection: Floats


class Errors(NamedTuple):
    """Differences of a run from a converged one: height in m, the others as shares."""

    height: float
    peak: float
    rms: float
    deflection: float

    def allowed(self) -> bool:
        """Whether the run meets all conditions."""
        return self.height <= ALLOWED_HEIGHT and max(self.peak, self.rms, self.deflection) <= ALLOWED_SHARE


class Rung(NamedTuple):
    """One method at one tolerance: its cost and its errors."""

    tolerance: float
    evaluations: int
    steps: int
    seconds: float
    errors: Errors


class Plan(NamedTuple):
    """What is measured: run files by their names, numbers of chassis modes, methods, tolerances from loose to fine, how
    often each timing is repeated, and the runs' duration [s] (None for that of the run file)."""

    runs: Sequence[str]
    modes: Sequence[int]
    methods: Sequence[str]
    ladder: Sequence[float]
    repetitions: int
    duration: float | None


class Measurements(NamedTuple):
    """The rungs of whole runs.

    results: the rung that is good enough together with the next finer ones, None if there is none; firsts: the loosest
    rung that is good enough by itself; ladders: all rungs of the runs that are drawn; durations: of the runs [s].
    """

    results: dict[Key, Rung | None]
    firsts: dict[Key, Rung | None]
    ladders: dict[Key, list[Rung]]
    durations: dict[str, float]


def rms_above(values: Floats, step: float, frequency: float) -> float:
    """The r.m.s. of the part of equally spaced samples above a frequency [Hz]. step: between samples [s]."""
    spectrum = np.fft.rfft(values)
    spectrum[np.fft.rfftfreq(len(values), step) <= frequency] = 0.0
    return float(np.sqrt(np.mean(np.fft.irfft(spectrum, len(values)) ** 2)))


def calc_errors(series: Series, reference: Series) -> Errors:
    """The errors of a run against a converged one with the same samples."""

    def share(value: float, true_value: float) -> float:
        return float(abs(value - true_value) / true_value) if true_value > 0.0 else 0.0

    step = reference.time[1] - reference.time[0]
    deflection = np.max(np.abs(reference.deflection))
    off = np.max(np.abs(series.deflection - reference.deflection))
    return Errors(
        height=float(np.max(np.abs(series.height - reference.height))),
        peak=share(np.max(np.abs(series.acceleration)), np.max(np.abs(reference.acceleration))),
        rms=share(*(rms_above(one.acceleration, step, HIGH_PASS) for one in (series, reference))),
        deflection=float(off / deflection) if deflection > 0.0 else 0.0,
    )


def read_series(path: str | Path) -> Series:
    """Reads the samples of one run."""
    return Series(*np.fromfile(path).reshape(-1, 4).T)


class Case:
    """A run file with a number of chassis modes: runs it by any method, and judges it against a converged run."""

    def __init__(
        self,
        program: Path,
        run_file: Path,
        superelements: Path,
        modes: int,
        folder: Path,
        duration: float | None = None,
    ) -> None:
        self.run_file, self.modes, self.folder = run_file, modes, folder
        self.command: list[str | Path | float] = [program, run_file, superelements, "--modes", modes]
        if duration is not None:
            self.command += ["--duration", duration]
        _, self.reference = self._run(REFERENCE_METHOD, REFERENCE_TOLERANCE, 0)
        self.duration = float(self.reference.time[-1])

    def _run(self, method: str, tolerance: float, repetitions: int) -> tuple[dict[str, Any], Series]:
        path = self.folder / "series.bin"
        text = run_program(
            [*self.command, "--method", method, "--tolerance", f"{tolerance:g}",
             "--repetitions", repetitions, "--series", path]
        )  # fmt: skip
        return json.loads(text), read_series(path)

    def measure(self, method: str, tolerance: float, repetitions: int) -> Rung:
        """Measures one rung of the ladder: the median of the repetitions, or the time of a single long run."""
        cost, series = self._run(method, tolerance, 1)
        seconds = cost["seconds"]
        if repetitions > 1 and seconds[0] < LONG_RUN:
            seconds = self._run(method, tolerance, repetitions)[0]["seconds"]
        errors = calc_errors(series, self.reference)
        return Rung(tolerance, cost["evaluations"], cost["steps"], float(np.median(seconds)), errors)

    def time(self, method: str, tolerance: float) -> float:
        """The seconds of a run, from a program that is started for it."""
        return float(min(self._run(method, tolerance, RUNS_IN_A_ROUND)[0]["seconds"]))

    def climb(
        self, method: str, repetitions: int, ladder: Sequence[float] = LADDER, whole: bool = False
    ) -> tuple[list[Rung], Rung | None, Rung | None]:
        """Measures rungs from the loosest tolerance to the first that is good enough together with the next finer ones,
        so that it is not good by chance. A run that takes too long ends the measurement.

        whole: measure all rungs of the ladder. Returns (rungs, good, first): all rungs; that good one, None if there is
        none; the first that is good enough by itself, None if there is none.
        """
        rungs: list[Rung] = []
        good = first = None
        for tolerance in ladder:
            try:
                rungs.append(self.measure(method, tolerance, repetitions))
            except InputError:
                continue  # the tolerance is so loose that the run failed
            if rungs[-1].seconds > TOO_LONG_RUN:
                break
            if first is None and rungs[-1].errors.allowed():
                first = rungs[-1]
            last = rungs[-1 - CONFIRMATIONS :]
            if good is None and len(last) > CONFIRMATIONS and all(rung.errors.allowed() for rung in last):
                good = last[0]
                if not whole:
                    break
        return rungs, good, first


def time_in_rounds(cases: Mapping[tuple[str, int], Case], tables: Sequence[Rungs], num_rounds: int) -> list[Rungs]:
    """Times the chosen runs again, each of them once in every round, so that the drift of the machine's speed affects
    all of them alike. Long runs keep their times.

    cases: (run, modes) → case. Returns the tables with the medians.
    """
    found: dict[tuple[Key, float], list[float]] = {
        (key, rung.tolerance): []
        for table in tables
        for key, rung in table.items()
        if rung is not None and rung.seconds < LONG_RUN
    }
    with Progress("timing in rounds", num_rounds * len(found)) as progress:
        for _ in range(num_rounds):
            for ((run, modes, method), tolerance), seconds in found.items():
                seconds.append(cases[run, modes].time(method, tolerance))
                progress.step()

    def timed(key: Key, rung: Rung | None) -> Rung | None:
        if rung is None or not found.get((key, rung.tolerance)):
            return rung
        return rung._replace(seconds=float(np.median(found[key, rung.tolerance])))

    return [{key: timed(key, rung) for key, rung in table.items()} for table in tables]


def measure_runs(program: Path, superelements: Path, folder: Path, plan: Plan) -> Measurements:
    """Measures all runs of a plan by run_benchmark (program). folder: for the files that the program writes."""
    results: dict[Key, Rung | None] = {}
    firsts: dict[Key, Rung | None] = {}
    ladders, durations, cases = {}, {}, {}
    drawn = DRAWN_MODES if DRAWN_MODES in plan.modes else plan.modes[0]
    methods = {modes: [*plan.methods, *([BASELINE] if modes in BASELINE_MODES else [])] for modes in plan.modes}
    with Progress("whole runs", len(plan.runs) * sum(map(len, methods.values()))) as progress:
        for run, modes in itertools.product(plan.runs, plan.modes):
            run_file = ROOT / f"dynamics/models/truck/{run}.toml"
            case = Case(program, run_file, superelements, modes, folder, plan.duration)
            cases[run, modes] = case
            durations[run] = case.duration
            for method in methods[modes]:
                whole = modes == drawn
                key = run, modes, method
                rungs, results[key], firsts[key] = case.climb(method, plan.repetitions, plan.ladder, whole)
                if whole:
                    ladders[key] = rungs
                progress.step()
    results, firsts = time_in_rounds(cases, (results, firsts), plan.repetitions)
    return Measurements(results, firsts, ladders, durations)
