"""Differences of a run with few, chosen or changing modes from the run with all modes; the activity of its modes."""

from functools import cached_property

import numpy as np

from sprung_tools.files.array_types import Integers
from sprung_tools.files.hdf5_file import read_numbers, read_real, read_text
from sprung_tools.paper_report.mode_runs import ALL
from sprung_tools.paper_report.run_numbers import FRONT_END, MIDDLE, SEAT, Numbers, RunNumbers, relative
from sprung_tools.runs.mode_history import count_active, find_change_times
from sprung_tools.signals.spectra import calc_rms


class Comparison:
    """Compares a run with the run of all modes over the same road by the same integrator. Differences are shares of the
    latter's values."""

    def __init__(self, run: RunNumbers, full: RunNumbers) -> None:
        self.run, self.full = run, full

    def deflection(self) -> float:
        """The relative difference of the front end's peak deflection."""
        return relative(self.run.peak_deflection(), self.full.peak_deflection())

    def peak(self, point: str) -> float:
        """The relative difference of a point's peak vertical acceleration."""
        return relative(self.run.peak_acceleration(point), self.full.peak_acceleration(point))

    def horizontal_peak(self, point: str) -> float:
        """The relative difference of a point's peak horizontal acceleration."""
        one, full = (float(np.max(np.abs(each.series(f"{point}/acceleration.x")))) for each in (self.run, self.full))
        return relative(one, full)

    def rms(self, point: str) -> float:
        """The relative difference of a point's r.m.s. vertical acceleration."""
        return relative(self.run.rms_acceleration(point), self.full.rms_acceleration(point))

    def history(self, quantity: str) -> float:
        """The r.m.s. of the difference of both histories over the r.m.s. of the full one."""
        one, full = (each.series(quantity) for each in (self.run, self.full))
        return calc_rms(one - full) / calc_rms(full)

    def histories(self) -> list[float]:
        """history() of the vertical acceleration of middle and seat."""
        return [self.history(f"{point}/acceleration.y") for point in (MIDDLE, SEAT)]

    def largest_difference(self, quantity: str) -> float:
        """The largest difference at any time over the largest value of the full run."""
        one, full = (each.series(quantity) for each in (self.run, self.full))
        return float(np.max(np.abs(one - full)) / np.max(np.abs(full)))

    def largest_differences(self) -> list[float]:
        """largest_difference() of the front end's deflection, and of the acceleration of middle and seat."""
        quantities = (FRONT_END, *(f"{point}/acceleration.y" for point in (MIDDLE, SEAT)))
        return [self.largest_difference(one) for one in quantities]

    def effort(self) -> float:
        """The evaluations over those with all modes."""
        return self.run.evaluations / self.full.evaluations

    @cached_property
    def active(self) -> Integers:
        """The number of active modes at each sample [n]."""
        return count_active(self.run.results)

    def changes(self) -> int:
        """The number of times at which modes joined or left."""
        return int(find_change_times(self.run.results).size)


class Choice:
    """The modes that the program chose before a run."""

    def __init__(self, run: RunNumbers) -> None:
        file = run.results.file
        self.kept = 1 + np.flatnonzero(read_numbers(file, "model/mode_choice/kept")[0])
        self.neglected = read_real(file, "model/mode_choice", "neglected")
        self.neglected_of = read_text(file, "model/mode_choice", "neglected_of")


def compare(numbers: Numbers, name: str, suffix: str = "") -> Comparison:
    """Compares a run, whose name begins with the road, with that of all modes. suffix: of runs by the same
    integrator."""
    road = name.partition("_")[0]
    return Comparison(numbers.run(name), numbers.run(f"{road}_{ALL}modes{suffix}"))


def can_compare(numbers: Numbers, name: str, suffix: str = "") -> bool:
    """Whether both runs of compare() were made."""
    road = name.partition("_")[0]
    return numbers.has(name) and numbers.has(f"{road}_{ALL}modes{suffix}")
