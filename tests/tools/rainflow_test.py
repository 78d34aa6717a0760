"""signals/rainflow.py and signals/fatigue_damage.py: the example of ASTM E1049-85, and damage in closed form."""

import unittest

import numpy as np
from tool_test_case import ToolTestCase

from sprung_tools.signals.fatigue_damage import (
    StrengthLine,
    calc_damage,
    calc_range,
)
from sprung_tools.signals.rainflow import begin_at_highest, count_cycles, find_turning_points

MPA = 1e6
# ASTM E1049-85, figure 6, "Rainflow counting example": peaks and valleys A to I in units of its grid, and the counts of
# its table of ranges; all other ranges from 1 to 10 have none.
EXAMPLE = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]
COUNTED = {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
# The same history repeated, figure 7 of the standard: from D to the next D, all cycles are whole.
REPEATED = {3.0: 1.0, 4.0: 1.0, 7.0: 1.0, 9.0: 1.0}
# Its cycles as (range, mean, count) in the order in which they close: A-B, B-C, E-F, then C-D, D-G, G-H, H-I.
CYCLES = [(3.0, -0.5, 0.5), (4.0, -1.0, 0.5), (4.0, 1.0, 1.0), (8.0, 1.0, 0.5), (9.0, 0.5, 0.5), (8.0, 0.0, 0.5),
          (6.0, 1.0, 0.5)]  # fmt: skip


def make_sine(amplitude, mean, number, samples=400):
    """A history [Pa] that begins at its lowest value and has `number` whole cycles, whose peaks are samples."""
    phase = np.linspace(0.0, 2.0 * np.pi * number, samples * number + 1)
    return mean - amplitude * np.cos(phase)


def count_by_four_points(history):
    """Rainflow cycles by the other rule: of four turning points the middle two make a cycle if they lie within the
    outer two; what is left counts as half cycles."""
    found, waiting = [], []
    for value in find_turning_points(history).tolist():
        waiting.append(value)
        while len(waiting) >= 4:
            first, second, third, fourth = waiting[-4:]
            if min(second, third) < min(first, fourth) or max(second, third) > max(first, fourth):
                break
            found.append((abs(second - third), 0.5 * (second + third), 1.0))
            del waiting[-3:-1]
    return found + [(abs(one - other), 0.5 * (one + other), 0.5) for one, other in zip(waiting, waiting[1:])]


def sum_counts(cycles):
    """How many cycles each range has."""
    return {size: float(np.sum(cycles.counts[cycles.ranges == size])) for size in np.unique(cycles.ranges)}


class RainflowCounting(ToolTestCase):
    def test_the_published_example(self):
        cycles = count_cycles(np.array(EXAMPLE))
        self.assertEqual(sum_counts(cycles), COUNTED)
        self.assertEqual(list(zip(*(part.tolist() for part in cycles))), CYCLES)
        self.assertEqual(sum_counts(count_cycles(begin_at_highest(np.array(EXAMPLE)))), REPEATED)

    def test_a_repetition_has_what_each_more_of_many_passages_adds(self):
        for seed in range(5):
            history = np.random.default_rng(seed).normal(size=300).cumsum()
            two, three = (sum_counts(count_cycles(np.tile(history, number))) for number in (2, 3))
            added = {size: count - two.get(size, 0.0) for size, count in three.items()}
            repeated = sum_counts(count_cycles(begin_at_highest(history)))
            self.assertEqual({size: count for size, count in added.items() if count}, repeated)

    def test_samples_between_turning_points_do_not_count(self):
        fine = np.interp(np.linspace(0.0, 8.0, 161), np.arange(9.0), EXAMPLE)
        np.testing.assert_allclose(find_turning_points(np.repeat(fine, 2)), EXAMPLE)
        for fine_part, part in zip(count_cycles(np.repeat(fine, 2)), count_cycles(np.array(EXAMPLE))):
            np.testing.assert_allclose(fine_part, part)

    def test_a_small_cycle_within_a_large_one_leaves_the_large_one_whole(self):
        # 0 → 10 with 4 → 3 on the way, and back to 0: one cycle of range 1, two halves of range 10
        cycles = count_cycles(np.array([0.0, 4.0, 3.0, 10.0, 0.0]))
        self.assertEqual(
            list(zip(*(part.tolist() for part in cycles))), [(1.0, 3.5, 1.0), (10.0, 5.0, 0.5), (10.0, 5.0, 0.5)]
        )

    def test_a_constant_history_has_no_cycles(self):
        self.assertEqual(count_cycles(np.full(5, 3.0)).ranges.size, 0)
        self.assertEqual(count_cycles(np.array([3.0])).ranges.size, 0)

    def test_the_sum_of_counts_is_half_the_number_of_ranges(self):
        history = np.random.default_rng(3).normal(size=2001)
        cycles = count_cycles(history)
        self.assertEqual(2.0 * float(np.sum(cycles.counts)), find_turning_points(history).size - 1)
        self.assertEqual(float(np.max(cycles.ranges)), float(np.ptp(history)))

    def test_the_rule_of_four_points_finds_the_same_cycles(self):
        for seed in range(5):
            history = np.random.default_rng(seed).normal(size=3000).cumsum() % 7.0
            cycles = count_cycles(history)
            self.assertEqual(sorted(zip(*(part.tolist() for part in cycles))), sorted(count_by_four_points(history)))


class Damage(ToolTestCase):
    line = StrengthLine(71.0 * MPA)

    def test_cycles_of_one_range_do_the_share_of_those_that_exhaust_it(self):
        # n cycles of the category's range: n / 2·10⁶; of twice the range 2³ times that.
        for amplitude, factor in ((35.5, 1.0), (71.0, 8.0)):
            damage = calc_damage(self.line, count_cycles(make_sine(amplitude * MPA, 0.0, 7)))
            self.assertAlmostEqual(damage / (factor * 7.0 / 2e6), 1.0, places=12)

    def test_ranges_below_the_knee_have_the_second_slope(self):
        # The range at the knee of 5 million cycles is 71 MPa · 0.4^(1/3) = 52.3 MPa (EN 1993-1-9, 7.1: 0.737 times).
        knee = calc_range(self.line, 5e6)
        self.assertAlmostEqual(knee / (71.0 * MPA), 0.4 ** (1.0 / 3.0), places=14)
        damage = calc_damage(self.line, count_cycles(make_sine(0.25 * knee, 0.0, 3)))
        self.assertAlmostEqual(damage * 5e6 / 3.0 * 2.0**5, 1.0, places=12)
        # At the end of the line, 100 million cycles, it is 0.549 times the one of the knee, as the standard has it.
        self.assertAlmostEqual(calc_range(self.line, 1e8) / knee, 0.549, delta=5e-4)

    def test_a_line_with_an_end_has_no_damage_beyond_it(self):
        line = self.line._replace(endurance=1e8)
        limit = calc_range(line, 1e8)
        small, large = (count_cycles(make_sine(0.5 * factor * limit, 0.0, 2)) for factor in (0.999, 1.001))
        self.assertEqual(calc_damage(line, small), 0.0)
        self.assertGreater(calc_damage(line, large), 1.9e-8)
        self.assertGreater(calc_damage(self.line, small), 1.9e-8)

    def test_blocks_add_up(self):
        # 5 cycles between 0 and 60 MPa, then 3 between 0 and 142 MPa. By rainflow the last 142 MPa of the second block
        # do not change the first: 5 cycles of 60 MPa, 3 of 142 MPa.
        history = np.concatenate([make_sine(30.0 * MPA, 30.0 * MPA, 5), make_sine(71.0 * MPA, 71.0 * MPA, 3)])
        expected = 5.0 * (60.0 / 71.0) ** 3 / 2e6 + 3.0 * 8.0 / 2e6
        self.assertAlmostEqual(calc_damage(self.line, count_cycles(history)) / expected, 1.0, places=12)

    def test_goodmans_line_corrects_for_a_tensile_mean_only(self):
        # Range 80 MPa about a mean of 100 MPa, R_m = 400 MPa: as a range of 80 / (1 − 1/4) = 106.67 MPa about 0.
        line = self.line._replace(strength=400.0 * MPA)
        damage = {
            mean: calc_damage(line, count_cycles(make_sine(40.0 * MPA, mean * MPA, 4))) for mean in (100.0, 0.0, -100.0)
        }
        self.assertAlmostEqual(damage[100.0] * 2e6 / 4.0, (80.0 / 0.75 / 71.0) ** 3, places=12)
        self.assertAlmostEqual(damage[0.0] * 2e6 / 4.0, (80.0 / 71.0) ** 3, places=12)
        self.assertAlmostEqual(damage[-100.0] / damage[0.0], 1.0, places=12)
        self.assertEqual(calc_damage(self.line, count_cycles(make_sine(40.0 * MPA, 0.0, 4))), damage[0.0])

    def test_a_mean_at_the_ultimate_strength_is_refused(self):
        line = self.line._replace(strength=90.0 * MPA)
        with self.assertRaisesRegex(
            ValueError, "the mean stress of a cycle is 95 MPa, not below the ultimate strength 90 MPa"
        ):
            calc_damage(line, count_cycles(make_sine(5.0 * MPA, 95.0 * MPA, 1)))


if __name__ == "__main__":
    unittest.main()
