"""How a run with few, chosen or changing modes differs from that with all, and what its modes did."""

from functools import cached_property

import numpy as np

from sprung_tools.files.hdf5_file import read_attribute, read_numbers, text_of
from sprung_tools.paper_report.mode_runs import ALL
from sprung_tools.paper_report.run_numbers import FRONT_END, MIDDLE, SEAT, relative
from sprung_tools.runs.mode_history import count_active, find_change_times
from sprung_tools.signals.spectra import calc_rms


class Comparison:
    """A run beside the one with all modes over the same road, by the same integrator; shares are of the latter's."""

    def __init__(self, run, full):
        self.run, self.full = run, full

    def deflection(self):
        """Of the front end's peak."""
        return relative(self.run.peak_deflection(), self.full.peak_deflection())

    def peak(self, point):
        """Of the vertical acceleration's peak."""
        return relative(self.run.peak_acceleration(point), self.full.peak_acceleration(point))

    def horizontal_peak(self, point):
        one, full = (float(np.max(np.abs(each.series(f"{point}/acceleration.x")))) for each in (self.run, self.full))
        return relative(one, full)

    def rms(self, point):
        return relative(self.run.rms_acceleration(point), self.full.rms_acceleration(point))

    def history(self, quantity):
        """R.m.s. of the difference of both histories over the r.m.s. of the full one."""
        one, full = (each.series(quantity) for each in (self.run, self.full))
        return calc_rms(one - full) / calc_rms(full)

    def histories(self):
        """Of the acceleration of middle and seat."""
        return [self.history(f"{point}/acceleration.y") for point in (MIDDLE, SEAT)]

    def largest_difference(self, quantity):
        """At any moment, over the largest value of the full one."""
        one, full = (each.series(quantity) for each in (self.run, self.full))
        return float(np.max(np.abs(one - full)) / np.max(np.abs(full)))

    def largest_differences(self):
        """Of the front end's deflection and of the middle's and the seat's acceleration."""
        return [self.largest_difference(one) for one in (FRONT_END, *(f"{p}/acceleration.y" for p in (MIDDLE, SEAT)))]

    def effort(self):
        """Evaluations over those with all modes."""
        return self.run.evaluations / self.full.evaluations

    @cached_property
    def active(self):
        """How many modes took part at each sample [n]."""
        return count_active(self.run.results)

    def changes(self):
        """Instants at which modes joined or left."""
        return find_change_times(self.run.results).size


class Choice:
    """What a run's program chose beforehand."""

    def __init__(self, run):
        file = run.results.file
        self.kept = 1 + np.flatnonzero(read_numbers(file, "model/mode_choice/kept")[0])
        self.neglected = float(read_attribute(file, "model/mode_choice", "neglected"))
        self.neglected_of = text_of(read_attribute(file, "model/mode_choice", "neglected_of"))


def compare(numbers, name, suffix=""):
    """A run's comparison by its name, whose first word is the road. suffix: of runs by this run's integrator."""
    road = name.partition("_")[0]
    return Comparison(numbers.run(name), numbers.run(f"{road}_{ALL}modes{suffix}"))


def can_compare(numbers, name, suffix=""):
    road = name.partition("_")[0]
    return numbers.has(name) and numbers.has(f"{road}_{ALL}modes{suffix}")


def format_ranges(values):
    """`1–8, 11` from ascending whole numbers."""
    spans = np.split(values, 1 + np.flatnonzero(np.diff(values) > 1))
    return ", ".join(f"{span[0]}" if len(span) == 1 else f"{span[0]}–{span[-1]}" for span in spans)
