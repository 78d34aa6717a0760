"""Fatigue of a body's sections over a run: stresses, cycles and damage of each station and fibre."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.section_stress import SectionStress, calc_section_stress, name_datasets
from sprung_tools.signals.fatigue_damage import StrengthLine, calc_damage
from sprung_tools.signals.rainflow import Cycles, count_cycles
from sprung_tools.signals.spans import Span


class Fatigue(NamedTuple):
    """The fatigue of a body over a span of time. section: its stresses, over the span only; time: of these [n] s;
    damage, greatest_range: of each station and fibre [stations × 2] 1, Pa."""

    section: SectionStress
    time: Floats
    damage: Floats
    greatest_range: Floats

    @property
    def worst(self) -> tuple[int, int]:
        """The station and the fibre with the greatest damage; without damage, with the greatest range."""
        measure = self.damage if np.any(self.damage > 0.0) else self.greatest_range
        station, side = np.unravel_index(int(np.argmax(measure)), measure.shape)
        return int(station), int(side)


def calc_fatigue(
    results: ResultsFile, body: str, source: str, window: Span, line: StrengthLine, factor: float = 1.0
) -> Fatigue:
    """The fatigue of a body. factor: multiplies all stresses. InputError if the file lacks something or does
    not hold it at every output, or if a mean stress reaches the ultimate strength."""
    for name in name_datasets(body, source):
        results.check_every_output(name)
    whole = calc_section_stress(results, body, source)
    inside = samples_between(results, *window)
    section = whole._replace(stress=factor * whole.stress[inside])
    shape = section.stress.shape[1:]
    damage, greatest = np.zeros(shape), np.zeros(shape)
    for place in np.ndindex(shape):
        cycles = count_cycles(section.stress[:, place[0], place[1]])
        greatest[place] = np.max(cycles.ranges, initial=0.0)
        try:
            damage[place] = calc_damage(line, cycles)
        except ValueError as error:
            where = f"at {section.along[place[0]]:.4g} m of '{body}'"
            raise InputError(f"{results.path}: error: {where}, {error}") from error
    return Fatigue(section, results.time[inside], damage, greatest)


def count_at(fatigue: Fatigue, station: int, side: int) -> Cycles:
    """The cycles of a station's fibre."""
    return count_cycles(fatigue.section.stress[:, station, side])


def find_stations(fatigue: Fatigue, place: float) -> list[int]:
    """The stations closest to a place along the body: one for each of the elements that meet there."""
    distances = np.abs(fatigue.section.along - place)
    return [int(station) for station in np.flatnonzero(distances <= np.min(distances) + 1e-9)]


def calc_life(damage: float, window: Span) -> float | None:
    """The time until the damage is 1 if the span of the run is repeated [s]; None without damage."""
    return (window[1] - window[0]) / damage if damage > 0.0 else None
