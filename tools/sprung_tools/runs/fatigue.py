"""Fatigue of a body's sections over a run: stresses, cycles and damage of each station and fibre."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.section_stress import SectionStress, calc_section_stress, name_datasets
from sprung_tools.signals.fatigue_damage import StrengthLine, calc_damage
from sprung_tools.signals.rainflow import Cycles, begin_at_highest, count_cycles
from sprung_tools.signals.spans import Span


ROUNDING = 1e-9  # of the largest stress of a body


class Fatigue(NamedTuple):
    """The fatigue of a body over a span of time that is repeated. section: its stresses, over the span only; time: of
    these [n] s; damage, greatest_range: of a repetition, for each station and fibre [stations × 2] 1, Pa."""

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
    """The fatigue of a body; changes that are rounding errors count as none. factor: multiplies all stresses.
    InputError if the file lacks something or does not hold it at every output, if the span has one output only, or if a
    mean stress reaches the ultimate strength."""
    for name in name_datasets(body, source):
        results.check_every_output(name)
    whole = calc_section_stress(results, body, source)
    inside = samples_between(results, *window)
    if np.count_nonzero(inside) < 2:
        raise InputError(f"{results.path}: error: {window[0]:g} to {window[1]:g} s has one output, expected at least 2")
    section = whole._replace(stress=factor * whole.stress[inside])
    shape = section.stress.shape[1:]
    damage, greatest = np.zeros(shape), np.zeros(shape)
    least = ROUNDING * float(np.max(np.abs(section.stress), initial=0.0))
    for place in np.ndindex(shape):
        history = section.stress[:, place[0], place[1]]
        if np.ptp(history) <= least:
            continue
        cycles = count_history(history)
        greatest[place] = np.max(cycles.ranges, initial=0.0)
        try:
            damage[place] = calc_damage(line, cycles)
        except ValueError as error:
            where = f"at {section.name_place(place[0])} of '{body}'"
            raise InputError(f"{results.path}: error: {where}, {error}") from error
    return Fatigue(section, results.time[inside], damage, greatest)


def count_history(history: Floats) -> Cycles:
    """The cycles of a repetition of a stress history."""
    return count_cycles(begin_at_highest(history))


def count_at(fatigue: Fatigue, station: int, side: int) -> Cycles:
    """The cycles of a station's fibre."""
    return count_history(fatigue.section.stress[:, station, side])


def combine_fatigue(parts: Sequence[Fatigue], repetitions: Sequence[float]) -> Fatigue:
    """The fatigue of a duty that has each of the spans of one body so many times. Its damages add up; from one span to
    the next no cycle is counted. ValueError if the spans do not have the same stations."""
    first = parts[0].section
    parts = [turn_sides(part, first) for part in parts]
    damage = np.sum([number * part.damage for number, part in zip(repetitions, parts)], axis=0)
    stress, time = (np.concatenate(values) for values in zip(*((one.section.stress, one.time) for one in parts)))
    greatest = np.max([part.greatest_range for part in parts], axis=0)
    return Fatigue(first._replace(stress=stress), time, damage, greatest)


def turn_sides(fatigue: Fatigue, like: SectionStress) -> Fatigue:
    """The same with the fibres of each station in the order of another one's, whose elements may be drawn the other
    way round. ValueError if it does not have the same stations."""
    section = fatigue.section
    is_same = section.positions.shape == like.positions.shape and np.all(section.positions == like.positions)
    if not is_same or any(set(one) != set(other) for one, other in zip(section.sides, like.sides)):
        raise ValueError("the runs do not have the same sections")
    turned = np.array([one != other for one, other in zip(section.sides, like.sides)])

    def turn(values: Floats) -> Floats:
        return np.where(turned[:, np.newaxis], values[..., ::-1], values)

    section = section._replace(sides=like.sides, elements=like.elements, stress=turn(section.stress))
    return Fatigue(section, fatigue.time, turn(fatigue.damage), turn(fatigue.greatest_range))


def calc_life(damage: float, duration: float) -> float | None:
    """The time until the damage is 1 if this damage comes with each `duration` [s]; None without damage."""
    return duration / damage if damage > 0.0 else None
