"""Main effects: how much of the variance of a measure each parameter alone explains.

The runs that have the measure are put into groups by the values of the parameter. With the mean ȳ of all N runs, and
the mean ȳ_g of the N_g runs of a group,

    share = Σ_g N_g (ȳ_g − ȳ)² / S,   S = Σ_i (y_i − ȳ)²                                               (1)

It is 1 where the parameter alone decides and each value is a group, and 0 where it has no effect on the mean.

A parameter is balanced if each of its values stands with the same values of all others: over a complete grid, if it is
crossed and no run has failed, or if nothing else varies. Then each value is a group, and nothing is by chance. The
shares of balanced parameters add up to 1 at most.

Otherwise the other parameters differ from group to group by chance, which raises the shares. Numbers that are many, or
that stand at less than two points each on average, make groups of equal size in their order: five, or fewer so that
each has three points. A point has one run, or one for each combination of the crossed parameters; runs of one point
have the same values of all sampled parameters, so that only points are independent of each other. With the mean ȳ_p of
the N_p runs of a point,

    S_p = Σ_p N_p (ȳ_p − ȳ)²                                                                           (2)

is the part of S that all sampled parameters explain together. Of G groups of n points drawn at random, share · S / S_p
has the distribution Beta((G − 1)/2, (n − G)/2) if the means ȳ_p are normal (R. A. Fisher's analysis of variance). An
effect is seen where the share is larger than 95 % of these. Where runs of a crossed parameter, or of a grid, have
failed, each run counts as a point.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags, Floats, Integers
from sprung_tools.study.execution import Finished
from sprung_tools.study.sampling import count_repeats
from sprung_tools.study.table import Column, are_numbers, format_cell, list_distinct

MOST_VALUES = 12  # of a parameter that make a group each
PARTS, LEAST_RUNS = 5, 3  # groups of many values; points in each
LEAST_SEEN = 0.005  # share of an effect
CERTAINTY = 0.95  # with which an effect is more than chance
ROUNDING = 1e-12  # of the largest value: what varies less does not vary


class Effect(NamedTuple):
    """The effect of a parameter on a measure. groups: their names; means: [groups]; counts: runs in each; share: by
    (1), None where all runs have one value or are in one group; chance: what it reaches at most without any effect, but
    for one case of twenty; is_of_ranges: whether the share is that of ranges of numbers."""

    parameter: str
    measure: str
    groups: tuple[str, ...]
    means: Floats
    counts: Integers
    share: float | None
    chance: float
    is_of_ranges: bool

    @property
    def is_seen(self) -> bool:
        """Whether the parameter explains more than chance does, and more than next to nothing."""
        return self.share is not None and self.share > max(self.chance, LEAST_SEEN)


class Grouping(NamedTuple):
    """The runs that have a measure, by a parameter. groups: [runs], and their names; levels: [runs], the groups of (1);
    points: [runs], the independent ones, None if the parameter is balanced; is_of_ranges: whether the levels are ranges
    of numbers."""

    groups: Integers
    names: list[str]
    levels: Integers
    points: Integers | None
    is_of_ranges: bool


def make_groups(values: list[Any], there: Flags | None = None) -> tuple[Integers, list[str]]:
    """The group of each point by the values of a parameter, and the names of the groups. there: which points count; all
    without it."""
    names = list_distinct(values)
    counted = [one for one, is_there in zip(values, there) if is_there] if there is not None else values
    is_repeated = len(names) <= MOST_VALUES and len(values) >= 2 * len(names)
    if is_repeated or not are_numbers(values):
        return number_values(counted, names), names
    numbers = np.array(counted, dtype=float)
    parts = max(min(PARTS, len(counted) // LEAST_RUNS), 1)
    limits = np.quantile(numbers, np.linspace(0.0, 1.0, parts + 1))
    groups = np.clip(np.searchsorted(limits, numbers, side="right") - 1, 0, parts - 1)
    names = [f"{round_number(low)} to {round_number(high)}" for low, high in zip(limits[:-1], limits[1:])]
    return groups, names


def number_values(values: Sequence[Any], names: Sequence[str]) -> Integers:
    """The number of each value among the names of all."""
    order = {name: number for number, name in enumerate(names)}
    return np.array([order[format_cell(one)] for one in values], dtype=int)


def round_number(value: float) -> str:
    """A number with three digits, without an exponent where that is short."""
    return f"{float(f'{value:.3g}'):g}"


def is_balanced(cells: Integers, parameter: int) -> bool:
    """Whether each value of a parameter stands with the same values of the others equally often, or as often as these
    stand there at all. cells: [runs × parameters], numbers of the values."""
    others = np.zeros(len(cells), dtype=int)
    for column in np.delete(cells, parameter, axis=1).T:
        others = np.unique(others * (np.max(column) + 1) + column, return_inverse=True)[1]
    own = np.unique(cells[:, parameter], return_inverse=True)[1]
    of_own, of_others = np.bincount(own), np.bincount(others)
    pairs, counts = np.unique(own * of_others.size + others, return_counts=True)
    if pairs.size < of_own.size * of_others.size:
        return False
    return bool(np.all(counts * len(cells) == np.outer(of_own, of_others).ravel()))


def make_grouping(values: list[Any], there: Flags, cells: Integers, parameter: int, repeats: int) -> Grouping:
    """Groups the runs that are there. values: of the parameter in all runs; repeats: the runs of each point."""
    levels = cells[there, parameter]
    if is_balanced(cells[there], parameter):
        names = list_distinct(values)
        if len(names) <= MOST_VALUES:
            return Grouping(levels, names, levels, None, False)
        return Grouping(*make_groups(values, there), levels, None, False)
    points_there = there.reshape(-1, repeats).any(axis=1)
    groups_of_points, names = make_groups(values[::repeats], points_there)
    points = (np.repeat(np.cumsum(points_there), repeats) - 1)[there]
    groups = groups_of_points[points]
    is_of_ranges = names != list_distinct(values)
    return Grouping(groups, names, groups, points, is_of_ranges)


def calc_effects(finished: Finished, columns: list[Column]) -> list[Effect]:
    """The effects of all parameters on all measures, from the runs that have the measure. Measures that do not vary
    have none."""
    effects = []
    values = [list(one) for one in zip(*finished.points)]
    cells = np.array([number_values(one, list_distinct(one)) for one in values]).T
    for number, parameter in enumerate(finished.study.parameters):
        # Runs that differ by a crossed parameter are points of their own for its effect.
        repeats = 1 if parameter.crossed else count_repeats(finished.study)
        groupings: dict[bytes, Grouping] = {}  # by the runs that are there
        for column in columns:
            there = ~np.isnan(column.values)
            if not does_vary(column.values[there]):
                continue
            key = there.tobytes()
            if key not in groupings:
                groupings[key] = make_grouping(values[number], there, cells, number, repeats)
            effects.append(calc_effect(parameter.name, column.name, column.values[there], groupings[key]))
    return effects


def does_vary(values: Floats) -> bool:
    """Whether values differ by more than rounding."""
    return values.size > 0 and bool(np.ptp(values) > ROUNDING * np.max(np.abs(values)))


def calc_effect(parameter: str, measure: str, values: Floats, grouping: Grouping) -> Effect:
    """The effect of one parameter on one measure that varies. values: of the measure."""
    found, groups = np.unique(grouping.groups, return_inverse=True)
    counts = np.bincount(groups)
    means = np.bincount(groups, values) / counts
    num_levels = np.unique(grouping.levels).size
    total = float(np.sum((values - np.mean(values)) ** 2))
    share = calc_explained(values, grouping.levels) / total if num_levels > 1 else None
    chance = 0.0
    if grouping.points is not None:
        chance = calc_chance(num_levels, np.unique(grouping.points).size)
        chance *= calc_explained(values, grouping.points) / total if chance < 1.0 else 1.0
    names = tuple(grouping.names[one] for one in found)
    return Effect(parameter, measure, names, means, counts, share, chance, grouping.is_of_ranges)


def calc_explained(values: Floats, groups: Integers) -> float:
    """The sum Σ_g N_g (ȳ_g − ȳ)² of values in groups."""
    offsets = values - np.mean(values)
    counts = np.bincount(groups)
    sums = np.bincount(groups, offsets)[counts > 0]
    return float(np.sum(sums**2 / counts[counts > 0]))


def calc_chance(num_groups: int, num_points: int) -> float:
    """What the groups explain of S_p at most if they are drawn at random, with CERTAINTY."""
    if num_groups in (1, num_points):
        return 0.0 if num_groups == 1 else 1.0
    from scipy.special import betaincinv  # here, as a study over a grid does without scipy, which takes long to load

    return float(betaincinv(0.5 * (num_groups - 1), 0.5 * (num_points - num_groups), CERTAINTY))
