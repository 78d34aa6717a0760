"""study/study_file.py and study/sampling.py: what a study file says, its errors with their places, and its points,
which are those of scipy."""

import itertools
import re
import tomllib
import unittest

import numpy as np
from scipy.stats import qmc
from tool_test_case import ROOT, TOOLS, ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_text import cut_key
from sprung_tools.study.sampling import is_balanced, make_points
from sprung_tools.study.description import PARAMETER_KEYS, ROAD_KEYS, ROOT_KEYS, SAMPLING_KEYS
from sprung_tools.study.study_file import read_study

HEAD = 'run = "run.toml"\nmeasures = ["summary/steps"]\n'
SPEED = '[[parameters]]\nkey = "speed"\nvalues = [1.0, 2.0, 5.0]\n'
RANGE = '[[parameters]]\nkey = "road.height"\nfrom = 0.1\nto = 0.4\n'
LOG_RANGE = '[[parameters]]\nname = "damping"\nkeys = ["a", "b"]\nfrom = 10.0\nto = 1000.0\nspacing = "logarithmic"\n'


class StudyCase(ToolTestCase):
    def setUp(self):
        super().setUp()
        (self.folder / "run.toml").write_text('vehicle = "vehicle.toml"\n', encoding="utf-8")
        (self.folder / "frame.toml").write_text("", encoding="utf-8")

    def read(self, text):
        path = self.folder / "study.toml"
        path.write_text(text, encoding="utf-8")
        return read_study(path)


class Points(StudyCase):
    def make(self, method, *parameters, sampling="number = 5\nseed = 7"):
        return make_points(self.read(f'{HEAD}[sampling]\nmethod = "{method}"\n{sampling}\n{"".join(parameters)}'))

    def test_a_grid_has_every_combination_the_last_parameter_fastest(self):
        points = make_points(self.read(HEAD + SPEED + RANGE + "number = 4\n"))
        self.assertEqual([point[0] for point in points], [1.0] * 4 + [2.0] * 4 + [5.0] * 4)
        np.testing.assert_allclose([point[1] for point in points], 3 * [0.1, 0.2, 0.3, 0.4], rtol=1e-14)

    def test_a_logarithmic_range_has_equal_ratios_and_its_ends_exactly(self):
        values = [point[0] for point in make_points(self.read(HEAD + LOG_RANGE + "number = 5\n"))]
        self.assertEqual((values[0], values[-1]), (10.0, 1000.0))
        np.testing.assert_allclose(np.diff(np.log(values)), np.log(100.0) / 4.0, rtol=1e-12)

    def test_whole_steps_between_whole_numbers_stay_whole(self):
        for low, high, number, values in ((0, 4, 3, [0, 2, 4]), (0, 4, 4, None), (0.0, 4, 3, [0.0, 2.0, 4.0])):
            (parameter,) = self.read_parameters(f"from = {low}\nto = {high}\nnumber = {number}\n")
            kind = int if isinstance(low, int) and values else float
            self.assertTrue(all(type(one) is kind for one in parameter.values))
            self.assertEqual(list(parameter.values), values or [0.0, 4.0 / 3.0, 8.0 / 3.0, 4.0])

    def read_parameters(self, text):
        (self.folder / "run.toml").touch()
        study = f'run = "run.toml"\nmeasures = ["program/a"]\n[[parameters]]\nkey = "modes.frame"\n{text}'
        (self.folder / "whole.toml").write_text(study, encoding="utf-8")
        return read_study(self.folder / "whole.toml").parameters

    def test_lists_are_taken_side_by_side(self):
        other = SPEED.replace("speed", "duration").replace("[1.0, 2.0, 5.0]", "[9, 8, 7]")
        self.assertEqual(self.make("list", SPEED, other, sampling=""), [(1.0, 9), (2.0, 8), (5.0, 7)])

    def test_random_points_are_those_of_scipy_for_the_seed(self):
        for method, engine in (
            ("latin-hypercube", qmc.LatinHypercube(3, seed=7)), ("sobol", qmc.Sobol(3, scramble=True, seed=7)),
        ):  # fmt: skip
            with self.subTest(method):
                shares = engine.random(8)
                points = self.make(method, RANGE, LOG_RANGE, SPEED, sampling="number = 8\nseed = 7")
                np.testing.assert_allclose([one[0] for one in points], 0.1 + 0.3 * shares[:, 0], rtol=1e-14)
                np.testing.assert_allclose([one[1] for one in points], 10.0 * 100.0 ** shares[:, 1], rtol=1e-12)
                chosen = np.array([1.0, 2.0, 5.0])[np.floor(3.0 * shares[:, 2]).astype(int)]
                np.testing.assert_array_equal([one[2] for one in points], chosen)

    def test_another_seed_gives_other_points(self):
        first, second = (self.make("sobol", RANGE, sampling=f"number = 4\nseed = {seed}") for seed in (1, 2))
        self.assertNotEqual(first, second)

    def test_a_crossed_parameter_is_combined_with_every_random_point(self):
        points = self.make("latin-hypercube", SPEED + "crossed = true\n", RANGE)
        shares = qmc.LatinHypercube(1, seed=7).random(5)[:, 0]
        self.assertEqual([one[0] for one in points], 5 * [1.0, 2.0, 5.0])
        np.testing.assert_allclose([one[1] for one in points], np.repeat(0.1 + 0.3 * shares, 3), rtol=1e-14)

    def test_a_sobol_sample_is_balanced_for_powers_of_two(self):
        for number, expected in ((1, True), (8, True), (12, False)):
            study = self.read(f'{HEAD}[sampling]\nmethod = "sobol"\nnumber = {number}\n{RANGE}')
            self.assertEqual(is_balanced(study.sampling), expected)

    def test_too_many_runs_are_refused(self):
        tables = (f'[[parameters]]\nkey = "k{k}"\nfrom = 0\nto = 1\nnumber = 101\n' for k in range(3))
        with self.assertRaisesRegex(InputError, r"study.toml:1:1: error: the study has 1030301 runs, at most 1000000"):
            make_points(self.read(HEAD + "".join(tables)))


class Values(StudyCase):
    def test_several_keys_get_the_same_value_or_one_of_a_list_each(self):
        text = '[[parameters]]\nname = "p"\nkeys = ["a", "b"]\nvalues = [3, [4, 5]]\n'
        (parameter,) = self.read(HEAD + text).parameters
        self.assertEqual([parameter.settings(one) for one in parameter.values], [{"a": 3, "b": 3}, {"a": 4, "b": 5}])

    def test_a_measure_may_have_a_label(self):
        study = self.read('run = "run.toml"\nmeasures = ["seat=points/body.seat/rms", "summary/*"]\n' + SPEED)
        self.assertEqual(study.measures, {"points/body.seat/rms": "seat", "summary/*": "summary/*"})

    def test_a_parameter_is_called_by_its_first_key_unless_it_has_a_name(self):
        self.assertEqual([one.name for one in self.read(HEAD + SPEED + LOG_RANGE + "number = 2").parameters],
                         ["speed", "damping"])  # fmt: skip


class Errors(StudyCase):
    def test_each_is_told_with_its_place_and_what_was_expected(self):
        random = '[sampling]\nmethod = "sobol"\nnumber = 4\n'
        design = f'designs = ["frame.toml"]\n{HEAD}[[parameters]]\nkey = "design.fram.x"\nvalues = [1]\n'
        for text, where, said in (
            ("x = = 1", "1:5", "Invalid value"),
            (SPEED, "1:1", "'run' is missing, expected a text"),
            ('run = "none.toml"\n' + SPEED, "1:8", "there is no file .*none.toml"),
            (HEAD + 'measure = ["a/b"]\n' + SPEED, "3:1", r"unknown key 'measure' \(known keys: run, command, "),
            ('run = "run.toml"\nmeasures = ["a/b",\n  "steps"]\n' + SPEED, "3:4",
             "'steps' is no measure, expected OBJECT"),
            ('run = "run.toml"\nmeasures = ["a/b", "a/b"]\n' + SPEED, "2:14", "'a/b' stands twice"),
            ('run = "run.toml"\nmeasures = ["s=a/b", "t=a/b"]\n' + SPEED, "2:23",
             "'t=a/b' has a name or a label that stands"),
            ('run = "run.toml"\nmeasures = ["s=a/b", "s=a/c"]\n' + SPEED, "2:23",
             "'s=a/c' has a name or a label that"),
            ('run = "run.toml"\nmeasures = ["=a/b"]\n' + SPEED, "2:14", "'=a/b' has an empty label"),
            ('run = "run.toml"\nmeasures = ["s=a/*"]\n' + SPEED, "2:14",
             "'s=a/\\*' has a label, which one measure needs"),
            (HEAD + 'command = "walk"\n' + SPEED, "3:1", "'command', got 'walk', expected \"run\" or \"response\" or"),
            (HEAD + 'superelements = "none"\n' + SPEED, "3:1", "expected a folder; there is no "),
            (HEAD, "1:1", r"no parameters: \[\[parameters\]\] is required"),
            (HEAD + "[[parameters]]\nvalues = [1]\n", "3:1", "needs one of 'key' and 'keys'"),
            (HEAD + '[[parameters]]\nkey = "speed"\nvalues = []\n', "5:1",
             "got \\[\\], expected a list of one value or"),
            (HEAD + SPEED + "from = 1\n", "6:1", "'from' has no effect beside 'values'"),
            (HEAD + SPEED + 'name = "a/b"\n', "6:1", "'name', got 'a/b', expected a name .* without a slash"),
            (HEAD + SPEED + SPEED, "7:1", "two parameters are called 'speed'"),
            (HEAD + SPEED + SPEED + 'name = "v"\n', "9:1", "another parameter sets it, too"),
            (HEAD + RANGE, "3:1", "'number' is missing, expected a whole number of at least 2"),
            (HEAD + RANGE.replace("0.4", "0.1") + "number = 3\n", "6:1",
             "'to', got 0.1, expected more than 'from' = 0.1"),
            (HEAD + LOG_RANGE.replace("10.0", "0.0") + "number = 3\n", "6:1", "a number above 0 for logarithmic"),
            (HEAD + RANGE.replace("0.1", "nan") + "number = 3\n", "5:1", "'from', got nan, expected a number"),
            (HEAD + RANGE.replace("0.4", "1" + 400 * "0") + "number = 3\n", "6:1", "'to', got 10+, expected a number"),
            (HEAD + SPEED.replace("5.0", "1" + 400 * "0"), "5:1", "expected finite numbers"),
            (HEAD + SPEED.replace("5.0", "1" + 5000 * "0"), "1:1", "Exceeds the limit"),
            (HEAD + SPEED.replace("speed", "road..height"), "4:8", "'road..height' is no key: names with dots"),
            (design.replace("fram.x", "frame"), "5:8", r"'design.frame' is no key of a design"),
            (HEAD + random + RANGE + "number = 3\n", "10:1", "'number' has no effect with method \"sobol\""),
            (HEAD + "[sampling]\nnumber = 4\n" + RANGE, "4:1", "'number' has no effect with method \"grid\""),
            (HEAD + '[sampling]\nmethod = "sobol"\n' + RANGE, "3:1",
             "'number' is missing, expected a whole number of at"),
            (HEAD + '[sampling]\nmethod = "list"\n' + SPEED + RANGE + "number = 2\n", "8:1",
             "has 2 values, the first"),
            (HEAD + "[random_road]\nseeds = 1\n" + SPEED, "4:1", "unknown key 'seeds'"),
            ('run = "run.toml"\nmeasures = ["histories/forces/f/force/median"]\n' + SPEED, "2:14",
             "has the measure 'median' of a quantity, expected one of min, max, rms, mean"),
            ('run = "run.toml"\nmeasures = ["histories/points/*/acceleration.y/max"]\n' + SPEED, "2:14",
             "has a pattern in its quantity"),
            ('run = "run.toml"\nmeasures = ["speed=a/b"]\n' + SPEED, "2:14",
             "'speed' is a parameter or another column of the table, expected another label"),
            ('run = "run.toml"\nmeasures = ["converged=a/b"]\n' + SPEED, "2:14", "'converged' is a parameter or"),
            (HEAD + SPEED + 'name = "exit_code"\n', "4:8", "'exit_code' is a column of the table; give a 'name'"),
            (HEAD + SPEED.replace("speed", "road.height") + SPEED.replace("speed", "road"), "4:8",
             "'road.height' lies in 'road', which is set as a whole, too"),
            (HEAD + "[set]\nroad.height = 1\n" + SPEED.replace("speed", "road"), "4:1",
             "'road.height' lies in 'road', which is set as a whole, too"),
            (HEAD + "[random_road]\nlength = 9\nspacing = 1\nrms = 1\n" + SPEED.replace("speed", "road.height"),
             "8:8", r"'road.height' has no effect: \[random_road\] makes the road"),
            (HEAD + SPEED.replace("5.0", "nan"), "5:1", r"got \[1.0, 2.0, nan\], expected finite numbers"),
            (HEAD + SPEED.replace("5.0", "{ a = [inf] }"), "5:1", "expected finite numbers"),
            (HEAD + '[random_road]\nclass = "C"\nlength = 9.0\n' + SPEED, "3:1",
             "'spacing' is missing in 'random_road', expected a number in m"),
            (HEAD + "[random_road]\nspacing = 0.1\nlength = 9.0\n" + SPEED, "3:1",
             "needs one of 'class', 'rms', 'density', got none"),
            (HEAD + SPEED.replace("speed", "random_road.seed"), "4:8", r"'random_road.seed' needs a table"),
            (design, "5:8", r"'design.fram.x' is no key of a design \(designs: frame\)"),
        ):  # fmt: skip
            with self.subTest(said), self.assertRaisesRegex(InputError, rf"study\.toml:{where}: error: .*{said}"):
                self.read(text)

    def test_no_key_is_set_twice_in_whatever_spelling(self):
        (self.folder / "vehicle.toml").write_text(
            '[[forces]]\nname = "tyre"\n[[forces]]\nname = "spring"\n[[forces]]\nname = "0"\n', encoding="utf-8"
        )
        name = SPEED.replace("speed", "vehicle.forces.spring.stiffness")
        height = SPEED.replace("speed", "road.height")
        for text, where, said in (
            (name + SPEED.replace('"speed"', """'vehicle.forces."spring".stiffness'"""), "7:8",
             "'vehicle.forces.\"spring\".stiffness' means the same as 'vehicle.forces.spring.stiffness', which is set"),
            (name + SPEED.replace("speed", "vehicle.forces.1.stiffness"), "7:8",
             "'vehicle.forces.1.stiffness' means the same as 'vehicle.forces.spring.stiffness', which is set, too"),
            (name + SPEED.replace("speed", "vehicle.forces.1"), "4:8",
             "'vehicle.forces.spring.stiffness' lies in 'vehicle.forces.1', which is set as a whole, too"),
            ('[[parameters]]\nname = "p"\nkeys = ["speed", "\'speed\'"]\nvalues = [[1, 2]]\n', "5:19",
             "''speed'' means the same as 'speed', which is set, too"),
            ("[set]\n'\"road\".height' = 1\n" + height, "4:1",
             "'\"road\".height' means the same as 'road.height', which is set, too"),
            ("[set]\nroad.height = 1\n" + height, "6:8", "'road.height' is set for all runs by 'set', too"),
            ('[set]\n"a..b" = 1\n' + SPEED, "4:1", "'a..b' is no key: names with dots between"),
        ):  # fmt: skip
            with self.subTest(said), self.assertRaisesRegex(InputError, rf"study\.toml:{where}: error: {said}"):
                self.read(HEAD + text)
        quoted = """vehicle.forces.\\"0\\".stiffness"""
        others = ("vehicle.forces.0.stiffness", quoted, "vehicle.forces.9.stiffness")
        study = self.read(HEAD + name + "".join(SPEED.replace("speed", one) for one in others))
        self.assertEqual(len(study.parameters), 4)

    def test_a_random_road_may_have_what_it_needs_from_parameters_and_from_what_is_set(self):
        for text in ('set.random_road.spacing = 0.1\n', 'set = { "random_road.spacing" = 0.1 }\n'):
            study = self.read(HEAD + text + "[random_road]\nlength = 9.0\n"
                              + SPEED.replace("speed", "random_road.rms"))  # fmt: skip
            self.assertEqual(study.random_road, {"length": 9.0})

    def test_lists_for_several_keys_have_a_value_for_each(self):
        with self.assertRaisesRegex(InputError, "study.toml:6:1: error: .*expected lists of 2 values"):
            self.read(HEAD + '[[parameters]]\nname = "p"\nkeys = ["a", "b"]\nvalues = [[1, 2, 3]]\n')

    def test_a_design_whose_name_has_a_dot_stands_in_quotes(self):
        (self.folder / "frame.2.toml").touch()
        text = f'designs = ["frame.2.toml"]\n{HEAD}[[parameters]]\nkey = \'design.NAME.x\'\nvalues = [1]\n'
        study = self.read(text.replace("NAME", '"frame.2"'))
        self.assertEqual(cut_key(study.parameters[0].keys[0], "design", "frame.2"), "x")
        with self.assertRaisesRegex(InputError, r"'design.frame.2.x' is no key of a design \(designs: \"frame.2\"\)"):
            self.read(text.replace("NAME", "frame.2"))

    def test_every_method_and_every_command_is_read(self):
        methods = ("sobol", "latin-hypercube")
        for command, method in itertools.product(("run", "response", "modes", "equilibrium"), methods):
            text = f'command = "{command}"\n{HEAD}[sampling]\nmethod = "{method}"\nnumber = 2\n{RANGE}'
            study = self.read(text)
            self.assertEqual((study.command, study.sampling.method), (command, method))


class Documentation(unittest.TestCase):
    SECTION = (TOOLS / "README.md").read_text(encoding="utf-8").partition("\n## Studies\n")[2].partition("\n## ")[0]

    def test_the_study_in_the_readme_is_the_example_shortened(self):
        (block,) = re.findall(r"^```toml\n(.*?)^```", self.SECTION, re.MULTILINE | re.DOTALL)
        shown = tomllib.loads(block)
        whole = tomllib.loads((ROOT / "dynamics/models/examples/quarter_car_study.toml").read_text(encoding="utf-8"))
        self.assertEqual((shown["run"], shown["set"]), (whole["run"], whole["set"]))
        self.assertLess(set(shown["measures"]), set(whole["measures"]))
        for one in shown["parameters"]:
            self.assertIn(one["key"], [other["key"] for other in whole["parameters"]])

    def test_the_readme_names_every_key(self):
        listed = set(re.findall(r"`(\w+)`", self.SECTION.partition("| key | | |")[2].partition("\n\n")[0]))
        self.assertLessEqual({*ROOT_KEYS, *SAMPLING_KEYS, *PARAMETER_KEYS, *ROAD_KEYS} - {"sampling", "parameters",
                             "random_road"}, listed)  # fmt: skip


if __name__ == "__main__":
    unittest.main()
