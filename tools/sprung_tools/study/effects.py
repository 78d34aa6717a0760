"""Main effects: how much of the variation of a measure each parameter alone explains.

The runs are put into groups, one for each value of the parameter. Numbers that are many, or that stand in less than two
runs each on average, make groups of equal size in their order: five, or fewer so that each has three runs. With the
mean ȳ of all N runs, and the mean ȳ_g of the N_g runs of a group,

    share = Σ_g N_g (ȳ_g − ȳ)² / Σ_i (y_i − ȳ)²                                                        (1)

It is 1 where the parameter alone decides, and 0 where it has no effect on the mean. With few runs in a group it is too
large: (G − 1)/(N − 1) is what G groups explain of pure chance on average.
"""

from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.study.execution import Finished
from sprung_tools.study.table import Column, are_numbers, format_cell, list_distinct

MOST_VALUES = 12  # of a parameter that make a group each
PARTS, LEAST_RUNS = 5, 3  # groups of many values; runs in each
ROUNDING = 1e-12  # of the largest value: what varies less does not vary


class Effect(NamedTuple):
    """The effect of a parameter on a measure. groups: their names; means: [groups]; counts: runs in each; share: by
    (1), None where all runs are in one group; chance: its mean value if there is no effect."""

    parameter: str
    measure: str
    groups: tuple[str, ...]
    means: Floats
    counts: Integers
    share: float | None
    chance: float

    @property
    def is_seen(self) -> bool:
        """Whether the parameter explains more than chance does."""
        return self.share is not None and self.share > self.chance


def make_groups(values: list[Any]) -> tuple[Integers, list[str]]:
    """The group of each run by the values of a parameter, and the names of the groups."""
    names = list_distinct(values)
    is_repeated = len(names) <= MOST_VALUES and len(values) >= 2 * len(names)
    if is_repeated or not are_numbers(values):
        order = {name: number for number, name in enumerate(names)}
        return np.array([order[format_cell(one)] for one in values], dtype=int), names
    numbers = np.array(values, dtype=float)
    parts = max(min(PARTS, len(values) // LEAST_RUNS), 1)
    limits = np.quantile(numbers, np.linspace(0.0, 1.0, parts + 1))
    groups = np.clip(np.searchsorted(limits, numbers, side="right") - 1, 0, parts - 1)
    names = [f"{round_number(low)} to {round_number(high)}" for low, high in zip(limits[:-1], limits[1:])]
    return groups, names


def round_number(value: float) -> str:
    """A number with three digits, without an exponent where that is short."""
    return f"{float(f'{value:.3g}'):g}"


def calc_effects(finished: Finished, columns: list[Column]) -> list[Effect]:
    """The effects of all parameters on all measures, from the runs that have the measure. Measures that do not vary
    have none."""
    effects = []
    for number, parameter in enumerate(finished.study.parameters):
        groups, names = make_groups([point[number] for point in finished.points])
        for column in columns:
            effect = calc_effect(parameter.name, column, groups, names)
            if effect is not None:
                effects.append(effect)
    return effects


def calc_effect(parameter: str, column: Column, groups: Integers, names: list[str]) -> Effect | None:
    """The effect of one parameter on one measure; None if the measure does not vary."""
    there = ~np.isnan(column.values)
    values, groups = column.values[there], groups[there]
    if not values.size or not np.ptp(values) > ROUNDING * np.max(np.abs(values)):
        return None
    total = float(np.sum((values - np.mean(values)) ** 2))
    found = np.unique(groups)
    means = np.array([np.mean(values[groups == one]) for one in found])
    counts = np.array([np.count_nonzero(groups == one) for one in found])
    share = float(np.sum(counts * (means - np.mean(values)) ** 2)) / total if found.size > 1 else None
    chance = (found.size - 1) / (values.size - 1)
    return Effect(parameter, column.name, tuple(names[one] for one in found), means, counts, share, chance)
