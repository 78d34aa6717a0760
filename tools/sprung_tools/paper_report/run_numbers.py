"""The numbers from which claims and tables are made: they are computed from the results files of a folder."""

from collections.abc import Collection
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_real, read_texts
from sprung_tools.files.results_file import open_results
from sprung_tools.paper_report.paper_runs import name_modes
from sprung_tools.paper_report.programs import MODES_MISSING, list_warnings
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.ride_measures import read_window, sampling_step
from sprung_tools.signals.spectra import calc_band_rms, calc_rms, count_upward_crossings, find_dominant_frequency

# The paper's centre of mass is the origin of its body frame, the middle of the chassis. That is the centre of mass only
# while the chassis is straight. Both are reported.
MIDDLE = "points/chassis.middle"
CENTRE = "bodies/chassis/center_of_mass"
SEAT = "points/chassis.seat"
FRONT_END = "points/chassis.front_end/deflection.y"
BANDS = (4.0, 8.0, 16.0)  # Hz
SEGMENT = 4.0  # s, of an averaged spectrum
LEFT_OUT, TOGETHER = "largest mode left out", "modes left out, together"  # the begin of lines of the run's summary


class Deflection(NamedTuple):
    """The front end's deflection in the body frame: static and largest [m], frequency of the highest spectral peak
    [Hz], upward crossings of the mean per second [1/s]."""

    static: float
    largest: float
    frequency: float
    crossings: float

    @property
    def ratio(self) -> float:
        """Largest over static deflection."""
        return abs(self.largest / self.static)


class RunNumbers:
    """One run's numbers, from its statistics window."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.results = open_results(path)
        self.window = read_window(self.results)
        self.inside = samples_between(self.results, *self.window)
        self.step = sampling_step(self.results)

    def series(self, quantity: str) -> Floats:
        """A quantity over the window [m]."""
        return self.results.series(quantity)[0][self.inside]

    def displacement(self, point: str) -> Floats:
        """A point's vertical displacement from static equilibrium over the window [m]."""
        return self.series(f"{point}/displacement.y")

    def acceleration(self, point: str) -> Floats:
        """A point's vertical acceleration over the window, m/s²."""
        return self.series(f"{point}/acceleration.y")

    def peak_acceleration(self, point: str) -> float:
        """A point's largest vertical acceleration, m/s²."""
        return float(np.max(np.abs(self.acceleration(point))))

    def rms_acceleration(self, point: str) -> float:
        """The r.m.s. of a point's vertical acceleration, m/s²."""
        return calc_rms(self.acceleration(point))

    def band_rms(self, point: str) -> Floats:
        """The r.m.s. acceleration in each of the BANDS, m/s² [4]."""
        return calc_band_rms(self.acceleration(point), self.step, BANDS)

    def peak_deflection(self) -> float:
        """The front end's largest deflection in the body frame, including the static one [m]."""
        return float(np.max(np.abs(self.series(FRONT_END))))

    def rms_between(self, point: str, start: float, end: float) -> float:
        """The r.m.s. acceleration in a span of time [s], m/s²."""
        span = samples_between(self.results, start, end)
        return calc_rms(self.results.series(f"{point}/acceleration.y")[0][span])

    @property
    def evaluations(self) -> int:
        """The integrator's evaluations of the equations of motion, without those for output."""
        return int(read_real(self.results.file, "summary", "evaluations"))

    @property
    def closure(self) -> float:
        """The relative error of the energy balance."""
        return read_real(self.results.file, "summary", "energy_closure")

    @property
    def said(self) -> str:
        """The output of the program at the end of the run. InputError if it was not kept."""
        said = self.path.with_suffix(".txt")
        if not said.exists():
            raise InputError(f"{said}: error: no such file")
        return said.read_text(encoding="utf-8")

    @property
    def warnings(self) -> list[str]:
        """The program's warnings of modes left out at the end of the run, a line each."""
        return [warning for warning in list_warnings(self.said) if warning.startswith(MODES_MISSING)]

    def read_summary(self, row: str) -> str:
        """What the program says in a row of its summary; empty if it has none."""
        lines = [line for line in self.said.splitlines() if line.startswith(row)]
        return lines[0].removeprefix(row).strip() if lines else ""

    @property
    def frequencies(self) -> Floats:
        """The assembled vehicle's undamped frequencies without the rigid-body mode [Hz]."""
        found, _ = read_numbers(self.results.file, "model/modes/undamped_frequency")
        return found[found > 1e-3]

    def chassis_modes(self) -> dict[str, float]:
        """The frequencies of the two modes in which the rigid chassis itself moves most [Hz], "bounce" and "pitch"."""
        file = self.results.file
        frequencies, _ = read_numbers(file, "model/modes/undamped_frequency")
        shapes, _ = read_numbers(file, "model/modes/shapes")
        rows = read_texts(file, "model/modes/coordinates")
        found = {}
        for name, coordinate in (("bounce", "chassis.y"), ("pitch", "chassis.angle")):
            found[name] = float(frequencies[np.argmax(np.abs(shapes[rows.index(coordinate)]))])
        return found

    @cached_property
    def front_end(self) -> Deflection:
        """The front end's deflection."""
        whole, _ = self.results.series(FRONT_END)
        values = whole[self.inside]
        largest = values[np.argmax(np.abs(values))]
        span = self.step * (values.size - 1)
        return Deflection(
            float(whole[0]),
            float(largest),
            find_dominant_frequency(values, self.step, min(SEGMENT, span)),
            count_upward_crossings(values) / span,
        )


def chassis_frequencies(run: RunNumbers, most: int) -> list[float]:
    """The assembled truck's frequencies that its rigid model does not have: those above 2.5 Hz without the axles' hop
    at 11.4 to 11.6 Hz."""
    found = [value for value in run.frequencies if value > 2.5 and not 11.4 < value < 11.6]
    return found[:most]


class Numbers:
    """The numbers of all runs in a folder; a run's file is opened at its first use.

    costs: run name → processor time [s], None if nothing was timed; made: the names of the runs that count, so that
    files of an earlier time in the folder are ignored; None for all.
    """

    def __init__(
        self, folder: Path, costs: dict[str, float] | None = None, made: Collection[str] | None = None
    ) -> None:
        self.folder = folder
        self.made = made
        self.costs = costs
        self.opened: dict[str, RunNumbers] = {}

    def has(self, name: str) -> bool:
        """Whether a run was made and its file is there."""
        return (self.made is None or name in self.made) and (self.folder / f"{name}.h5").exists()

    def has_cost(self, name: str) -> bool:
        """Whether a run was timed."""
        return self.costs is not None and name in self.costs

    def cost(self, name: str) -> float:
        """The processor time of a run [s]. InputError if it was not timed."""
        if self.costs is None or name not in self.costs:
            raise InputError(f"{name}: error: this run was not timed")
        return self.costs[name]

    def run(self, name: str) -> RunNumbers:
        """The numbers of a run by its name. InputError if it is not one of those made or its file cannot be used."""
        if self.made is not None and name not in self.made:
            raise InputError(f"{self.folder / name}.h5: error: this run was not made")
        if name not in self.opened:
            self.opened[name] = RunNumbers(self.folder / f"{name}.h5")
        return self.opened[name]

    def modes(self, road: str, count: int) -> RunNumbers:
        """The numbers of the run over a road with a number of chassis modes."""
        return self.run(f"{road}_{name_modes(count)}")

    def clamped_frequencies(self, superelement: str) -> Floats:
        """A superelement's frequencies [Hz], as the runs kept them."""
        file = self.run("bump_rigid").results.file
        return read_numbers(file, f"model/superelements/{superelement}/frequency")[0]


def relative(value: float, reference: float) -> float:
    """The difference of a value from a reference, as a share of the reference."""
    if reference == 0.0:
        raise InputError("error: no share of a reference that is 0")
    return value / reference - 1.0
