"""limits/: root finding on functions with known roots, obstacles by hand, and the roughness of terrain."""

import math
import unittest

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.limits.roads import calc_obstacle, make_terrain
from sprung_tools.limits.root_finding import CallFailed, find_root
from sprung_tools.signals.road_profile import Recipe

BOUNDS = (0.0, 10.0)
RECIPE = Recipe(length=100.0, spacing=0.05, band=(0.0547, 3.3), exponent=2.0, ease=5.0, seed=3)


def step_by_one(_x, _value):
    return 1.0


class RootFinding(unittest.TestCase):
    def test_a_root_is_found_from_below_and_from_above(self):
        for start in (1.0, 9.0):
            root = find_root(lambda x: x**3 - 50.0, start, BOUNDS, step_by_one, 1e-9)
            self.assertAlmostEqual(root.value, 50.0 ** (1.0 / 3.0), delta=2e-9)
            self.assertEqual((root.side, root.problem), ("", ""))

    def test_the_first_of_several_roots_is_found(self):
        root = find_root(lambda x: math.sin(x - 1.0), 0.0, BOUNDS, step_by_one, 1e-9)
        self.assertAlmostEqual(root.value, 1.0, delta=2e-9)

    def test_a_jump_is_found_at_its_place(self):
        root = find_root(lambda x: -1.0 if x < 4.56 else 1.0, 0.5, BOUNDS, step_by_one, 1e-6)
        self.assertAlmostEqual(root.value, 4.56, delta=2e-6)

    def test_a_root_beyond_the_bounds_is_told(self):
        self.assertEqual(find_root(lambda x: x - 11.0, 3.0, BOUNDS, step_by_one, 1e-9)[:3], (None, "above", ""))
        self.assertEqual(find_root(lambda x: x + 1.0, 3.0, BOUNDS, step_by_one, 1e-9)[:3], (None, "below", ""))

    def test_no_argument_is_asked_for_twice(self):
        asked = []

        def function(x):
            asked.append(x)
            return x - 5.4

        root = find_root(function, 3.0, BOUNDS, step_by_one, 1e-9)
        self.assertEqual(len(set(asked)), len(asked))
        self.assertEqual(root.calls, len(asked))

    def test_a_failed_call_leaves_the_root_unknown(self):
        def function(x):
            if x > 4.0:
                raise CallFailed("the run failed")
            return x - 7.0

        self.assertEqual(find_root(function, 3.0, BOUNDS, step_by_one, 1e-9), (None, "", "the run failed", 3))


class ObstacleOutline(unittest.TestCase):
    def test_a_half_round_obstacle_is_a_half_circle(self):
        places, heights = calc_obstacle(0.25, None)
        self.assertEqual((places[0], heights[0], heights[-1]), (0.0, 0.0, 0.0))
        self.assertAlmostEqual(places[-1], 0.5)
        np.testing.assert_allclose(np.hypot(places - 0.25, heights), 0.25, rtol=1e-12)
        # A tyre with distributed contact takes as many samples and steps as the closest points ask for.
        np.testing.assert_allclose(np.diff(places), 0.5 / 80)

    def test_the_outline_for_a_wheel_is_the_way_of_its_centre(self):
        # The centre of a wheel of 0.5 m on a half circle of 0.2 m is 0.7 m from the circle's centre, and on level
        # ground 0.5 m high: √(0.7² − 0.5²) = 0.4899 m before the middle.
        places, heights = calc_obstacle(0.2, 0.5)
        self.assertAlmostEqual(places[-1], 2.0 * math.sqrt(0.24))
        self.assertAlmostEqual(np.max(heights), 0.2)
        np.testing.assert_allclose(np.hypot(places - math.sqrt(0.24), heights + 0.5), 0.7, rtol=1e-12)

    def test_the_roughness_is_that_between_the_eased_ends(self):
        """It was that of all points, and 4 % less than that of the terrain on which the power is measured."""
        for ease in (0.0, 10.0, 20.0):
            recipe = RECIPE._replace(ease=ease)
            rows = [line.split() for line in make_terrain(recipe, 0.03).splitlines() if not line.startswith("#")]
            place, height = np.array(rows, dtype=float).T
            between = height[(place >= ease) & (place <= 100.0 - ease)]
            self.assertAlmostEqual(float(np.std(between)), 0.03, places=7)


if __name__ == "__main__":
    unittest.main()
