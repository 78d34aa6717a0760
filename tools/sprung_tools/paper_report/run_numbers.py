"""The numbers that claims and tables are made of, each computed once from the results files of a folder."""

from functools import cached_property
from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, text_of
from sprung_tools.files.results_file import open_results
from sprung_tools.paper_report.paper_runs import list_warnings, name_modes
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.ride_measures import read_window, sampling_step
from sprung_tools.signals.spectra import calc_band_rms, calc_rms, count_upward_crossings, find_dominant_frequency

# The paper's centre of mass is where its body frame sits, the middle of the chassis. That is the centre of mass while
# the chassis is straight; bent, its true centre of mass moves otherwise. Both are reported.
MIDDLE = "points/chassis.middle"
CENTRE = "bodies/chassis/center_of_mass"
SEAT = "points/chassis.seat"
FRONT_END = "points/chassis.front_end/deflection.y"
BANDS = (4.0, 8.0, 16.0)  # Hz
SEGMENT = 4.0  # s, of an averaged spectrum
LEFT_OUT = "largest mode left out"  # how a line of the run's summary begins


class Deflection(NamedTuple):
    """Of the front end in the body frame: static and largest [m], frequency of the highest spectral peak [Hz], upward
    crossings of the mean each second [1/s]."""

    static: float
    largest: float
    frequency: float
    crossings: float

    @property
    def ratio(self):
        return abs(self.largest / self.static)


class RunNumbers:
    """One run's numbers over its statistics window."""

    def __init__(self, path):
        self.path = path
        self.results = open_results(path)
        self.window = read_window(self.results)
        self.inside = samples_between(self.results, *self.window)
        self.step = sampling_step(self.results)

    def series(self, quantity):
        """A quantity over the window [m]."""
        return self.results.series(quantity)[0][self.inside]

    def displacement(self, point):
        return self.series(f"{point}/displacement.y")

    def acceleration(self, point):
        return self.series(f"{point}/acceleration.y")

    def peak_acceleration(self, point):
        return float(np.max(np.abs(self.acceleration(point))))

    def rms_acceleration(self, point):
        return calc_rms(self.acceleration(point))

    def band_rms(self, point):
        """R.m.s. acceleration in the BANDS, m/s² [4]."""
        return calc_band_rms(self.acceleration(point), self.step, BANDS)

    def peak_deflection(self):
        """The front end's largest deflection in the body frame, static included [m]."""
        return float(np.max(np.abs(self.series(FRONT_END))))

    def rms_between(self, point, start, end):
        """R.m.s. acceleration of a span of time [s], m/s²."""
        span = samples_between(self.results, start, end)
        return calc_rms(self.results.series(f"{point}/acceleration.y")[0][span])

    @property
    def evaluations(self):
        """Of the equations of motion, by the integrator; those for output not counted."""
        return int(self.results.file["summary"].attrs["evaluations"])

    @property
    def closure(self):
        """Of the energy book, relative."""
        return float(self.results.file["summary"].attrs["energy_closure"])

    @property
    def said(self):
        """What the program said at the end of the run. InputError if it was not kept."""
        said = self.path.with_suffix(".txt")
        if not said.exists():
            raise InputError(f"{said}: error: no such file")
        return said.read_text(encoding="utf-8")

    @property
    def warnings(self):
        """What the program warned of at the end of the run, a line each."""
        return list_warnings(self.said)

    @property
    def left_out(self):
        """The mode that was left out and misses most, and its shares, in the program's words; empty if none was."""
        lines = [line for line in self.said.splitlines() if line.startswith(LEFT_OUT)]
        return lines[0].removeprefix(LEFT_OUT).strip() if lines else ""

    @property
    def frequencies(self):
        """The assembled vehicle's undamped frequencies without the rigid-body mode [Hz]."""
        found, _ = read_numbers(self.results.file, "model/modes/undamped_frequency")
        return found[found > 1e-3]

    def chassis_modes(self):
        """Frequencies of the two modes in which the rigid chassis itself moves most [Hz]: dict of "bounce", "pitch"."""
        file = self.results.file
        frequencies, _ = read_numbers(file, "model/modes/undamped_frequency")
        shapes, _ = read_numbers(file, "model/modes/shapes")
        rows = [text_of(name) for name in file["model/modes/coordinates"]]
        found = {}
        for name, coordinate in (("bounce", "chassis.y"), ("pitch", "chassis.angle")):
            found[name] = float(frequencies[np.argmax(np.abs(shapes[rows.index(coordinate)]))])
        return found

    @cached_property
    def front_end(self):
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


def chassis_frequencies(run, most):
    """The assembled truck's frequencies that its rigid model does not have: above 2.5 Hz, not the axles' hop at 11.4 to
    11.6 Hz."""
    found = [value for value in run.frequencies if value > 2.5 and not 11.4 < value < 11.6]
    return found[:most]


class Numbers:
    """The numbers of all runs in a folder, opened when they are asked for.

    made: names of the runs that count, so that files left there by an earlier work are not taken for new; None: all.
    """

    def __init__(self, folder, costs=None, made=None):
        self.folder = folder
        self.made = made
        self.costs = costs  # processor times, dict of run name → s, or None
        self.opened = {}

    def has(self, name):
        return (self.made is None or name in self.made) and (self.folder / f"{name}.h5").exists()

    def run(self, name):
        """The numbers of a run by its name. InputError if it is not one of those made or its file cannot be used."""
        if self.made is not None and name not in self.made:
            raise InputError(f"{self.folder / name}.h5: error: this run was not made")
        if name not in self.opened:
            self.opened[name] = RunNumbers(self.folder / f"{name}.h5")
        return self.opened[name]

    def modes(self, road, count):
        return self.run(f"{road}_{name_modes(count)}")

    def clamped_frequencies(self, superelement):
        """A superelement's frequencies [Hz], as the runs kept them."""
        file = self.run("bump_rigid").results.file
        return read_numbers(file, f"model/superelements/{superelement}/frequency")[0]


def relative(value, reference):
    """How much a value differs from a reference, as a share of it."""
    if reference == 0.0:
        raise InputError("error: no share of a reference that is 0")
    return value / reference - 1.0
