"""Running the benchmark programs and judging their runs: what tools/benchmark measures."""

import json
import subprocess
from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.terminal.progress_bar import Progress

BASELINE = "baseline"  # dense equations under Dormand–Prince 5(4)
METHODS = ("exponential", "adams", "bdf", "generalized-alpha")  # as in run files
REFERENCE_METHOD, REFERENCE_TOLERANCE = "exponential", 1e-9
LADDER = (
    1e-1, 5e-2, 3e-2, 2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 3e-7, 1e-7,
)  # fmt: skip
CONFIRMATIONS = 2  # finer rungs that have to be good enough too
LONG_RUN, TOO_LONG_RUN = 0.5, 8.0  # s: not repeated; the method is given up
RUNS_IN_A_ROUND = 3  # the best of them is the round's: the first finds nothing in the caches
HIGH_PASS = 16.0  # Hz
ALLOWED_HEIGHT = 1e-4  # m
ALLOWED_SHARE = 0.01  # of peak and r.m.s. of the acceleration, and of the deflection


class Series(NamedTuple):
    """Samples of a run, SI units: the columns that run_benchmark writes."""

    time: np.ndarray
    height: np.ndarray
    acceleration: np.ndarray
    deflection: np.ndarray


class Errors(NamedTuple):
    """What a run differs in from a converged one: height in m, the others as shares."""

    height: float
    peak: float
    rms: float
    deflection: float

    def allowed(self):
        """Whether the run meets all conditions."""
        return self.height <= ALLOWED_HEIGHT and max(self.peak, self.rms, self.deflection) <= ALLOWED_SHARE


class Rung(NamedTuple):
    """One method at one tolerance: its cost, and its errors (None for a run that stopped)."""

    tolerance: float
    evaluations: int
    steps: int
    seconds: float
    errors: Errors


def run_program(command):
    """A benchmark program's output. InputError where it fails, with its own words."""
    try:
        process = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    except OSError as error:
        raise InputError(f"{command[0]}: error: {error.strerror}; build it: tools/build") from error
    if process.returncode != 0:
        raise InputError(process.stderr.strip() or f"{command[0]}: error: exit code {process.returncode}")
    return process.stdout


def rms_above(values, step, frequency):
    """Root mean square of the part of evenly spaced samples that lies above a frequency [Hz]."""
    spectrum = np.fft.rfft(values)
    spectrum[np.fft.rfftfreq(len(values), step) <= frequency] = 0.0
    return float(np.sqrt(np.mean(np.fft.irfft(spectrum, len(values)) ** 2)))


def calc_errors(series, reference):
    """Errors of a run against a converged one with the same samples."""

    def share(value, true_value):
        return float(abs(value - true_value) / true_value) if true_value > 0.0 else 0.0

    step = reference.time[1] - reference.time[0]
    deflection = np.max(np.abs(reference.deflection))
    off = np.max(np.abs(series.deflection - reference.deflection))
    return Errors(
        height=float(np.max(np.abs(series.height - reference.height))),
        peak=share(np.max(np.abs(series.acceleration)), np.max(np.abs(reference.acceleration))),
        rms=share(
            rms_above(series.acceleration, step, HIGH_PASS), rms_above(reference.acceleration, step, HIGH_PASS)
        ),
        deflection=float(off / deflection) if deflection > 0.0 else 0.0,
    )


def read_series(path):
    """The samples of one run."""
    return Series(*np.fromfile(path).reshape(-1, 4).T)


class Case:
    """A run file with a number of chassis modes: runs it by any method and judges it against a converged run."""

    def __init__(self, program, run_file, superelements, modes, folder, duration=None):
        self.run_file, self.modes, self.folder = run_file, modes, folder
        self.command = [program, run_file, superelements, "--modes", modes]
        if duration is not None:
            self.command += ["--duration", duration]
        _, self.reference = self._run(REFERENCE_METHOD, REFERENCE_TOLERANCE, 0)
        self.duration = float(self.reference.time[-1])

    def _run(self, method, tolerance, repetitions):
        path = self.folder / "series.bin"
        text = run_program(
            [*self.command, "--method", method, "--tolerance", f"{tolerance:g}",
             "--repetitions", repetitions, "--series", path]
        )  # fmt: skip
        return json.loads(text), read_series(path)

    def measure(self, method, tolerance, repetitions):
        """One rung of the ladder; the median of the repetitions, of long runs the time of one."""
        cost, series = self._run(method, tolerance, 1)
        seconds = cost["seconds"]
        if repetitions > 1 and seconds[0] < LONG_RUN:
            seconds = self._run(method, tolerance, repetitions)[0]["seconds"]
        errors = calc_errors(series, self.reference)
        return Rung(tolerance, cost["evaluations"], cost["steps"], float(np.median(seconds)), errors)

    def time(self, method, tolerance):
        """Seconds of a run, by a program that is started for it."""
        return min(self._run(method, tolerance, RUNS_IN_A_ROUND)[0]["seconds"])

    def climb(self, method, repetitions, ladder=LADDER, whole=False):
        """Returns (rungs, good, first): the rungs from the loosest tolerance to the first that is good enough together
        with the next finer ones, so that it is not so by chance (whole: to the last of the ladder); that good one;
        the first that is good enough by itself. None where there is none. Runs that take too long end it."""
        rungs = []
        good = first = None
        for tolerance in ladder:
            try:
                rungs.append(self.measure(method, tolerance, repetitions))
            except InputError:
                continue  # so loose that it could not go on
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


def time_in_rounds(cases, tables, num_rounds):
    """Takes the times of chosen runs anew, each of them once in every round: the machine's speed drifts, and ratios
    have to be of one time. Long runs keep theirs.

    cases: {(run, modes): Case}; tables: several {(run, modes, method): Rung or None}. Returns the tables with the medians.
    """
    found = {
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

    def timed(key, rung):
        seconds = found.get((key, rung.tolerance)) if rung is not None else None
        return rung._replace(seconds=float(np.median(seconds))) if seconds else rung

    return [{key: timed(key, rung) for key, rung in table.items()} for table in tables]


def measure_evaluations(program, repetitions, min_time):
    """Medians of evaluation_benchmark. Returns {(kind, modes): seconds}, kind "fast" or "dense"."""
    text = run_program(
        [program, "--benchmark_format=json", f"--benchmark_repetitions={repetitions}",
         f"--benchmark_min_time={min_time}", "--benchmark_enable_random_interleaving=true"]
    )  # fmt: skip
    times = {}
    for entry in json.loads(text)["benchmarks"]:
        if entry["run_type"] != "iteration":
            continue
        name, modes = entry["run_name"].split("/")[:2]
        key = (name.removesuffix("_evaluation"), int(modes))
        times.setdefault(key, []).append(1e-6 * entry["cpu_time"])
    return {key: float(np.median(values)) for key, values in times.items()}


def measure_growth(program, sizes, num_steps):
    """The lines of growth_benchmark."""
    text = run_program([program, *sizes, "--steps", num_steps])
    return [json.loads(line) for line in text.splitlines()]
