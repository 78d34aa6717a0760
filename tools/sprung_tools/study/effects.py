"""Main effects: how much of the variance of a measure each parameter alone explains.

The runs that have the measure are put into groups, one for each value of the parameter. Numbers that are many, or that
stand in less than two runs each on average, make groups of equal size in their order: five, or fewer so that each has
three runs. With the mean ȳ of all N runs, and the mean ȳ_g of the N_g runs of a group,

    share = Σ_g N_g (ȳ_g − ȳ)² / Σ_i (y_i − ȳ)²                                                        (1)

It is 1 where the parameter alone decides, and 0 where it has no effect on the mean. Over a complete grid the means are
over the same values of all other parameters, so that the shares of all parameters add up to 1 at most. Otherwise the
other parameters differ from group to group, by chance: this raises the shares, by (G − 1)/(N − 1) on average. Of G
groups of runs drawn at random (1) has the distribution Beta((G − 1)/2, (N − G)/2) if the measure is normal (R. A.
Fisher's analysis of variance); an effect is seen where it is larger than 95 % of these.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags, Floats, Integers
from sprung_tools.study.execution import Finished
from sprung_tools.study.table import Column, are_numbers, format_cell, list_distinct

MOST_VALUES = 12  # of a parameter that make a group each
PARTS, LEAST_RUNS = 5, 3  # groups of many values; runs in each
LEAST_SEEN = 0.005  # share of an effect
CERTAINTY = 0.95  # with which an effect is more than chance
ROUNDING = 1e-12  # of the largest value: what varies less does not vary


class Effect(NamedTuple):
    """The effect of a parameter on a measure. groups: their names; means: [groups]; counts: runs in each; share: by
    (1), None where all runs are in one group; chance: what it reaches at most without any effect, but for one case of
    twenty."""

    parameter: str
    measure: str
    groups: tuple[str, ...]
    means: Floats
    counts: Integers
    share: float | None
    chance: float

    @property
    def is_seen(self) -> bool:
        """Whether the parameter explains more than chance does, and more than next to nothing."""
        return self.share is not None and self.share > max(self.chance, LEAST_SEEN)


def make_groups(values: list[Any], there: Flags | None = None) -> tuple[Integers, list[str]]:
    """The group of each run by the values of a parameter, and the names of the groups. there: which runs count; all
    without it."""
    names = list_distinct(values)
    counted = [one for one, is_there in zip(values, there) if is_there] if there is not None else values
    is_repeated = len(names) <= MOST_VALUES and len(values) >= 2 * len(names)
    if is_repeated or not are_numbers(values):
        order = {name: number for number, name in enumerate(names)}
        return np.array([order[format_cell(one)] for one in counted], dtype=int), names
    numbers = np.array(counted, dtype=float)
    parts = max(min(PARTS, len(counted) // LEAST_RUNS), 1)
    limits = np.quantile(numbers, np.linspace(0.0, 1.0, parts + 1))
    groups = np.clip(np.searchsorted(limits, numbers, side="right") - 1, 0, parts - 1)
    names = [f"{round_number(low)} to {round_number(high)}" for low, high in zip(limits[:-1], limits[1:])]
    return groups, names


def round_number(value: float) -> str:
    """A number with three digits, without an exponent where that is short."""
    return f"{float(f'{value:.3g}'):g}"


def is_complete_grid(points: Sequence[Sequence[Any]]) -> bool:
    """Whether each combination of the parameters' values is there once."""
    cells = [tuple(map(format_cell, point)) for point in points]
    return len(set(cells)) == len(cells) == math.prod(len(set(column)) for column in zip(*cells))


def calc_effects(finished: Finished, columns: list[Column]) -> list[Effect]:
    """The effects of all parameters on all measures, from the runs that have the measure. Measures that do not vary
    have none."""
    effects = []
    is_grid = is_complete_grid(finished.points)
    for number, parameter in enumerate(finished.study.parameters):
        values = [point[number] for point in finished.points]
        for column in columns:
            effect = calc_effect(parameter.name, values, column, is_grid)
            if effect is not None:
                effects.append(effect)
    return effects


def calc_effect(parameter: str, points: list[Any], column: Column, is_grid: bool) -> Effect | None:
    """The effect of one parameter on one measure; None if the measure does not vary. points: the parameter's values."""
    there = ~np.isnan(column.values)
    values = column.values[there]
    if not values.size or not np.ptp(values) > ROUNDING * np.max(np.abs(values)):
        return None
    groups, names = make_groups(points, there)
    total = float(np.sum((values - np.mean(values)) ** 2))
    found = np.unique(groups)
    means = np.array([np.mean(values[groups == one]) for one in found])
    counts = np.array([np.count_nonzero(groups == one) for one in found])
    share = float(np.sum(counts * (means - np.mean(values)) ** 2)) / total if found.size > 1 else None
    chance = 0.0 if is_grid and there.all() else calc_chance(found.size, values.size)
    return Effect(parameter, column.name, tuple(names[one] for one in found), means, counts, share, chance)


def calc_chance(num_groups: int, num_runs: int) -> float:
    """What the groups explain at most if they are drawn at random, with CERTAINTY."""
    if num_groups in (1, num_runs):
        return 0.0 if num_groups == 1 else 1.0
    from scipy.special import betaincinv  # here, as a study over a grid does without scipy, which takes long to load

    return float(betaincinv(0.5 * (num_groups - 1), 0.5 * (num_runs - num_groups), CERTAINTY))
