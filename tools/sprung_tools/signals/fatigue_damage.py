"""Fatigue damage of cycles of stress, by a line of stress ranges over numbers of cycles.

    N = N_k (S_k / S)^m₁ for S ≥ S_k,   N = N_k (S_k / S)^m₂ below [1],   S_k = S_C (2·10⁶ / N_k)^(1/m)       (1)
    S = range / (1 − max(mean, 0) / R_m)   [2]                                                                (2)
    D = Σ n / N   [3]                                                                                         (3)

m is the slope on whose part of the line 2·10⁶ cycles lie: m₁ for N_k ≥ 2·10⁶, else m₂. S_C is the range that
2 million cycles exhaust, the detail category of [1]; m₁ = 3, m₂ = 5 and N_k = 5 million are those
of [1] for normal stresses. A stress is a nominal one where S_C is: that of the beam's section, without the notch of the
weld or hole that the category stands for. A compressive mean counts as none in (2).

[1] EN 1993-1-9:2005, Eurocode 3, Design of steel structures, part 1-9: Fatigue, 7.1; a line of O. H. Basquin (1910) in
two parts. The straight line is that of m₁ = m₂.
[2] J. Goodman, Mechanics applied to engineering (1899), with the ultimate strength R_m; without R_m the mean does not
count, as in [1] for welded details.
[3] M. A. Miner, Cumulative damage in fatigue, Journal of Applied Mechanics 12 (1945) A159; 1 is the end of life.
"""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.signals.rainflow import Cycles

CATEGORY_CYCLES = 2e6  # at which the detail category is the range
LARGEST_STRESS = 1e10  # Pa: no material bears more, so that a larger strength is probably in another unit


class StrengthLine(NamedTuple):
    """The line of (1).

    category: S_C [Pa]; slopes: m₁ and m₂; knee: N_k; endurance: the number of cycles at whose range the line ends, so
    that smaller ranges do no damage (None: it does not end); strength: R_m of (2) [Pa], None: the mean does not count.
    """

    category: float
    slopes: tuple[float, float] = (3.0, 5.0)
    knee: float = 5e6
    endurance: float | None = None
    strength: float | None = None


def calc_range(line: StrengthLine, cycles: float) -> float:
    """The range [Pa] that a number of cycles exhausts; 0 or inf where 64 bits do not hold it."""

    def find_slope(number: float) -> float:
        return line.slopes[0 if number <= line.knee else 1]

    with np.errstate(all="ignore"):
        knee_range = line.category * np.power(CATEGORY_CYCLES / line.knee, np.divide(1.0, find_slope(CATEGORY_CYCLES)))
        return float(knee_range * np.power(line.knee / cycles, np.divide(1.0, find_slope(cycles))))


def correct_ranges(line: StrengthLine, cycles: Cycles) -> Floats:
    """The ranges of (2) [Pa]. ValueError if a mean reaches the ultimate strength."""
    if line.strength is None:
        return cycles.ranges
    left = 1.0 - np.maximum(cycles.means, 0.0) / line.strength
    if np.any(left <= 0.0):
        mean, strength = 1e-6 * float(np.max(cycles.means)), 1e-6 * line.strength
        raise ValueError(
            f"the mean stress of a cycle is {mean:.4g} MPa, not below the ultimate strength {strength:g} MPa"
        )
    return cycles.ranges / left


def calc_damage(line: StrengthLine, cycles: Cycles) -> float:
    """The damage of (3). ValueError as correct_ranges(), or if the line's knee or the damage is not finite."""
    ranges = correct_ranges(line, cycles)
    knee_range = calc_range(line, line.knee)
    if not 0.0 < knee_range < np.inf:
        raise ValueError(f"the line's range at {line.knee:g} cycles is {knee_range:g} Pa, expected a finite value > 0")
    slopes = np.where(ranges >= knee_range, line.slopes[0], line.slopes[1])
    with np.errstate(all="ignore"):
        shares = cycles.counts / line.knee * (ranges / knee_range) ** slopes
    if line.endurance is not None:
        shares = np.where(ranges >= calc_range(line, line.endurance), shares, 0.0)
    damage = float(np.sum(shares))
    if not np.isfinite(damage):
        largest = 1e-6 * float(np.max(ranges))
        raise ValueError(
            f"the damage of ranges up to {largest:.4g} MPa is {damage:g}, expected a finite number: the line has a "
            f"knee at {1e-6 * knee_range:.4g} MPa and slopes of {line.slopes[0]:g} and {line.slopes[1]:g}"
        )
    return damage
