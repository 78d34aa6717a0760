"""study/effects.py: main effects of tables whose variation is known."""

import itertools
import unittest
from types import SimpleNamespace

import numpy as np
from tool_test_case import TOOLS  # noqa: F401  puts tools/ on the path

from sprung_tools.study.effects import calc_effects, make_groups
from sprung_tools.study.page import pack_values
from sprung_tools.study.table import Column


def make_study(names, points, **crossed):
    """A study of random points. crossed: values of the last parameters, which are combined with every point."""
    parameters = [SimpleNamespace(name=one, crossed=False, values=()) for one in names]
    parameters += [SimpleNamespace(name=name, crossed=True, values=values) for name, values in crossed.items()]
    all_points = [(*point, *more) for point in points for more in itertools.product(*crossed.values())]
    study = SimpleNamespace(parameters=parameters, sampling=SimpleNamespace(method="latin-hypercube"))
    return SimpleNamespace(study=study, points=all_points)


class Effects(unittest.TestCase):
    def test_in_a_sum_over_a_grid_each_parameter_explains_its_part(self):
        # y = 2 a + b over a, b in {-1, 1}: variances 4 and 1 of 5.
        points = [(a, b) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
        column = Column("o/y", "y", "m", np.array([2.0 * a + b for a, b in points]))
        first, second = calc_effects(make_study(("a", "b"), points), [column])
        self.assertAlmostEqual(first.share, 0.8, places=14)
        self.assertAlmostEqual(second.share, 0.2, places=14)
        np.testing.assert_allclose(first.means, [-2.0, 2.0])
        self.assertEqual((first.groups, list(first.counts)), (("-1.0", "1.0"), [2, 2]))
        self.assertEqual((first.chance, second.chance), (0.0, 0.0))  # b has the same values in both groups of a
        self.assertTrue(second.is_seen)

    def test_of_random_points_chance_alone_explains_more_in_one_case_of_twenty(self):
        random = np.random.default_rng(7)
        for num_values, count in ((2, 11), (16, 16)):
            points = [(float(value), float(other)) for value, other in
                      zip(np.arange(count) % num_values, random.permutation(count))]  # fmt: skip
            columns = [Column(f"o/{k}", f"{k}", "", random.standard_normal(count)) for k in range(1500)]
            effects = [one for one in calc_effects(make_study(("a", "b"), points), columns) if one.parameter == "a"]
            self.assertEqual(len(effects[0].counts), min(num_values, 5))
            seen = np.mean([one.is_seen for one in effects])
            self.assertAlmostEqual(seen, 0.05, delta=4.0 * np.sqrt(0.05 * 0.95 / 1500))
            mean = np.mean([one.share for one in effects])
            self.assertAlmostEqual(mean, (len(effects[0].counts) - 1) / (count - 1), delta=0.01)

    def test_groups_have_three_runs_also_where_others_have_failed(self):
        values = np.random.default_rng(1).permutation(16).astype(float)
        measured = np.where(np.arange(16) < 11, values, np.nan)
        points = list(zip(values, values[::-1]))
        effect, _ = calc_effects(make_study(("a", "b"), points), [Column("o/y", "y", "", measured)])
        self.assertEqual(sorted(effect.counts), [3, 4, 4])
        self.assertLess(effect.chance, 1.0)

    def test_runs_without_the_measure_do_not_count(self):
        points = [(1.0,), (1.0,), (3.0,), (3.0,)]
        (effect,) = calc_effects(
            make_study(("a",), points), [Column("o/y", "y", "", np.array([5.0, np.nan, 6.0, 7.0]))]
        )
        self.assertEqual((effect.groups, list(effect.counts)), (("1.0", "3.0"), [1, 2]))
        np.testing.assert_allclose(effect.means, [5.0, 6.5])
        # Mean 6: between the groups 1 + 2 · 0.25, in all 1 + 0 + 1.
        self.assertAlmostEqual(effect.share, 0.75, places=14)

    def test_a_measure_that_does_not_vary_or_is_nowhere_has_no_effects(self):
        points = [(1.0,), (2.0,)]
        for values in ([3.0, 3.0], [np.nan, np.nan], [np.nan, 1.0]):
            self.assertEqual(calc_effects(make_study(("a",), points), [Column("o/y", "y", "", np.array(values))]), [])

    def test_the_rounding_errors_of_a_mean_or_of_a_computation_are_no_variation(self):
        # The mean of three equal values of 0.1 is 0.1 + 1 ulp; one ulp of 0.1 is 1.4e-17.
        points = [(1.0,), (2.0,), (3.0,)]
        self.assertNotEqual(np.mean([0.1, 0.1, 0.1]), 0.1)
        for values in ([0.1, 0.1, 0.1], [0.1, 0.1, np.nextafter(0.1, 1.0)], [0.0, 0.0, 0.0]):
            self.assertEqual(calc_effects(make_study(("a",), points), [Column("o/y", "y", "", np.array(values))]), [])
        (effect,) = calc_effects(
            make_study(("a",), 2 * points), [Column("o/y", "y", "", np.array(2 * [0.1, 0.1, 0.1 + 1e-10]))]
        )
        self.assertAlmostEqual(effect.share, 1.0)

    def test_random_points_are_grouped_by_three_runs_or_more(self):
        random = np.random.default_rng(1)
        for count, sizes in ((12, [3] * 4), (7, [3, 4]), (4, [4])):
            groups, names = make_groups(random.permutation(np.linspace(0.0, 1.0, count)).tolist())
            self.assertEqual((sorted(np.bincount(groups)), len(names)), (sizes, len(sizes)))

    def test_what_has_one_value_among_the_good_runs_cannot_be_judged(self):
        points = [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)]
        column = Column("o/y", "y", "", np.array([1.0, np.nan, 2.0, np.nan]))
        first, second = calc_effects(make_study(("a", "b"), points), [column])
        self.assertIsNone(second.share)
        self.assertFalse(second.is_seen)
        # Among the good runs nothing else varies.
        self.assertEqual((first.share, first.chance, first.is_seen), (1.0, 0.0, True))

    def test_groups_of_one_run_explain_everything_and_so_do_they_by_chance(self):
        points = [("a", 1.0), ("b", 2.0), ("c", 4.0)]
        first, _ = calc_effects(make_study(("a", "b"), points), [Column("o/y", "y", "", np.array([1.0, 5.0, 7.0]))])
        self.assertAlmostEqual(first.share, 1.0)
        self.assertEqual((first.chance, first.is_seen), (1.0, False))

    def test_where_nothing_else_varies_a_parameter_explains_everything_however_many_values_it_has(self):
        values = np.linspace(0.1, 8.0, 30)
        column = Column("o/y", "y", "", np.sin(values))
        (effect,) = calc_effects(make_study(("a",), [(one,) for one in values]), [column])
        self.assertAlmostEqual(effect.share, 1.0, places=12)
        self.assertEqual((effect.chance, effect.is_seen, effect.is_of_ranges), (0.0, True, False))
        self.assertEqual(list(effect.counts), [6] * 5)  # means of 30 values are drawn as five

    def test_over_a_grid_of_many_values_the_shares_are_those_of_the_values(self):
        # Of sin a + b over whole turns of a the variances are 1/2 and (n² − 1)/12 of b = 0, 1, … n − 1.
        turn = np.arange(40) * 2.0 * np.pi / 20.0
        points = [(a, float(b)) for a in turn for b in range(3)]
        column = Column("o/y", "y", "", np.array([np.sin(a) + b for a, b in points]))
        first, second = calc_effects(make_study(("a", "b"), points), [column])
        self.assertAlmostEqual(first.share, 0.5 / (0.5 + 8.0 / 12.0), places=12)
        self.assertAlmostEqual(first.share + second.share, 1.0, places=12)

    def test_of_crossed_runs_only_the_points_are_independent(self):
        """Irrelevant parameters of a study with a crossed one are seen in one case of twenty."""
        random = np.random.default_rng(3)
        seen = {"relevant": [], "irrelevant": [], "seed": [], "none": []}
        for _ in range(1000):
            points = random.permuted(np.tile(np.arange(15.0), (2, 1)), axis=1).T.tolist()
            of_point, of_seed = random.standard_normal(15), random.standard_normal(8)
            values = of_point[:, None] + 0.3 * of_seed + 0.2 * of_point[:, None] * of_seed
            by_first = 0.4 * np.array([first for first, _ in points])[:, None] + values
            columns = [Column("o/y", "y", "", np.repeat(one.ravel(), 2)) for one in (values, by_first)]
            study = make_study(("relevant", "irrelevant"), points, seed=tuple(range(8)), none=(0, 1))
            first, second, *_ = effects = calc_effects(study, columns)
            seen["relevant"].append(second.is_seen)
            seen["irrelevant"].append(effects[2].is_seen)
            seen["seed"].append(effects[4].is_seen)
            seen["none"].append(effects[6].share)
            self.assertEqual(list(first.counts), [3 * 16] * 5)
        tolerance = 4.0 * np.sqrt(0.05 * 0.95 / 1000)
        self.assertAlmostEqual(np.mean(seen["irrelevant"]), 0.05, delta=tolerance)
        self.assertGreater(np.mean(seen["relevant"]), 0.5)
        self.assertTrue(all(seen["seed"]))  # its values stand with the same points
        self.assertLess(max(seen["none"]), 1e-12)

    def test_many_values_make_five_groups_of_equal_size(self):
        values = list(np.random.default_rng(1).permutation(np.linspace(0.0, 10.0, 50)))
        groups, names = make_groups(values)
        self.assertEqual(list(np.bincount(groups)), [10] * 5)
        for group in range(4):
            highest = max(one for one, number in zip(values, groups) if number == group)
            lowest = min(one for one, number in zip(values, groups) if number == group + 1)
            self.assertLess(highest, lowest)
        self.assertEqual((len(names), names[0], names[-1]), (5, "0 to 2", "8 to 10"))
        self.assertEqual(make_groups(list(np.linspace(1234.5, 2345.6, 50)))[1][0], "1230 to 1460")

    def test_texts_make_groups_in_the_order_in_which_they_come(self):
        groups, names = make_groups(["bdf", "adams", "bdf", True])
        self.assertEqual((list(groups), names), ([0, 1, 0, 2], ["bdf", "adams", "true"]))

    def test_lists_of_numbers_are_in_the_order_of_their_numbers(self):
        values = [[0, 2e4], [0, 3e4], [0, -4e4], [0], [-1, 5e4]]
        groups, names = make_groups(values)
        in_order = ["[-1, 50000.0]", "[0]", "[0, -40000.0]", "[0, 20000.0]", "[0, 30000.0]"]
        self.assertEqual((list(groups), names), ([3, 4, 2, 1, 0], in_order))
        self.assertEqual(pack_values(values)["categories"], in_order)
        self.assertEqual(pack_values([[2, 1], "off", [1, 2]])["categories"], ["[2, 1]", "off", "[1, 2]"])


if __name__ == "__main__":
    unittest.main()
