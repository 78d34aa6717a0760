"""Cycles of a stress history by rainflow counting.

[1] ASTM E1049-85 (2017), Standard Practices for Cycle Counting in Fatigue Analysis, 5.4.4. A range counts as a cycle
where it lies within the next one, and as half a cycle where it begins at the start of the history; what is left at the
end counts as half cycles. rainflow_test.py has the example of its figure 6.
[2] The same, 5.4.5: a history that is repeated is counted from its highest value to the next such value. Then all
ranges belong to whole cycles, also those that one passage leaves open.
"""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats


class Cycles(NamedTuple):
    """Cycles of a history: ranges, mean values, and counts of 1 or 0.5 [each cycles]."""

    ranges: Floats
    means: Floats
    counts: Floats


def find_turning_points(history: Floats) -> Floats:
    """The values at which a history [n] turns, its first and its last value included."""
    steps = np.diff(history)
    moved = np.concatenate([[True], steps != 0.0])  # of equal values in a row the first
    values = history[moved]
    if values.size < 3:
        return values
    rises = np.diff(values) > 0.0
    turns = np.concatenate([[True], rises[1:] != rises[:-1], [True]])
    return values[turns]


def begin_at_highest(history: Floats) -> Floats:
    """One period of a history [n] that is repeated without end, from its highest value to the next one [n + 1], as [2]
    counts it."""
    place = int(np.argmax(history))
    return np.concatenate([history[place:], history[: place + 1]])


def count_cycles(history: Floats) -> Cycles:
    """Counts the cycles of a history [n] by [1]."""
    found: list[tuple[float, float, float]] = []

    def count(one: float, other: float, cycles: float) -> None:
        found.append((abs(one - other), 0.5 * (one + other), cycles))

    waiting: list[float] = []  # turning points that are not yet counted
    for value in find_turning_points(history).tolist():
        waiting.append(value)
        while len(waiting) >= 3 and abs(waiting[-1] - waiting[-2]) >= abs(waiting[-2] - waiting[-3]):
            if len(waiting) == 3:  # the range begins at the start of the history
                count(waiting[0], waiting[1], 0.5)
                del waiting[0]
            else:
                count(waiting[-3], waiting[-2], 1.0)
                del waiting[-3:-1]
    for one, other in zip(waiting, waiting[1:]):
        count(one, other, 0.5)
    return Cycles(*(np.array(found, dtype=float).reshape(-1, 3).T))
