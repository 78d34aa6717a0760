"""Measures of fatigue in studies, against tools/fatigue on a run made by hand."""

import json
import unittest

from cantilever import DESIGN, VEHICLE
from study_case import DYNAMICS, REDUCE, StudyCase
from tool_test_case import run_program

SHAKEN = (
    "gravity = [0.0, 0.0]"
    + VEHICLE
    + """
[[forces]]
name = "shaker"
type = "applied"
point = "beam.tip"
force = [0.0, { harmonic = { amplitude = 1000.0, frequency = 3.0 } }]
"""
)
RUN = 'vehicle = "vehicle.toml"\nduration = 1.0\noutput_step = 0.002\n[modes]\nbeam = "all"\n'
STUDY = """measures = ["fatigue/beam/from_loads/damage", "fatigue/beam/from_loads/x", "fatigue/*/largest_range"]
designs = ["beam.toml"]
[fatigue]
category = 71.0
slopes = [3, 3]
factor = 1.5
[[parameters]]
name = "amplitude"
key = "vehicle.forces.shaker.force.1.harmonic.amplitude"
values = [1000.0, 2000.0]
"""


class StudyOfFatigue(StudyCase):
    def setUp(self):
        super().setUp()
        for name, text in (("beam.toml", DESIGN), ("vehicle.toml", SHAKEN), ("run.toml", RUN)):
            (self.folder / name).write_text(text, encoding="utf-8")

    def test_its_damage_is_that_of_the_command(self):
        self.write_study(STUDY, run="run.toml")
        self.assert_succeeds(self.study())
        one, other = self.read_table()
        name = "fatigue/beam/from_loads/damage"
        # Twice the force: twice the ranges, and by the slope of 3 eight times the damage.
        self.assertAlmostEqual(float(other[f"{name} [1]"]) / float(one[f"{name} [1]"]), 8.0, places=2)
        run_program([REDUCE, "build", "beam.toml"], cwd=self.folder, check=True)
        run_program([DYNAMICS, "run", "run.toml", "-o", "run.h5"], cwd=self.folder, check=True)
        line = ("--category", "71", "--slopes", "3", "3", "--factor", "1.5")
        process = self.run_tool("fatigue", "run.h5", *line, "--json")
        self.assert_succeeds(process)
        measures = json.loads(process.stdout)["runs"][0]["measures"]
        for column in ("damage [1]", "x [m]", "largest_range [Pa]"):
            expected = measures[f"fatigue/beam/from_loads/{column.partition(' ')[0]}"]["value"]
            self.assertEqual(float(one[f"fatigue/beam/from_loads/{column}"]), expected, column)
        self.assertIn("fatigue/beam/from_modes/largest_range [Pa]", one)

    def test_another_line_is_another_study(self):
        self.write_study(STUDY, run="run.toml")
        self.assert_succeeds(self.study())
        self.write_study(STUDY.replace("71.0", "142.0"), run="run.toml")
        process = self.study()
        self.assertIn("2 made, 0 kept", process.stdout)

    def test_what_cannot_be_is_refused_at_its_place(self):
        for old, new, message in (
            ('[fatigue]\ncategory = 71.0\nslopes = [3, 3]\nfactor = 1.5\n', "", "needs the table [fatigue] with a"),
            ("category = 71.0", "category = 0", "'category', got 0, expected a number above 0"),
            ("category = 71.0", "category = 71e6", "'category', got 71000000.0, expected at most 10000 MPa"),
            ("category = 71.0\n", "", "'category' is missing, expected a number above 0"),
            ("slopes = [3, 3]", "slopes = [3]", "'slopes', got [3], expected two numbers above 0"),
            ("factor = 1.5", "factr = 1.5", "unknown key 'factr' (known keys: category, slopes, knee, "),
            ("from_loads/damage", "from_loads/demage", "fatigue/… has no measure 'demage' (did you mean 'damage'?)"),
            ("from_loads/damage", "from_load/damage", "stresses are 'from_load' (did you mean 'from_loads'?)"),
            ("fatigue/beam", "fatigue/bean", "the vehicle has no body 'bean' (did you mean 'beam'?)"),
            ('designs =', 'command = "response"\ndesigns =', "is a measure of runs alone"),
            ('"fatigue/beam/from_loads/damage", "fatigue/beam/from_loads/x", "fatigue/*/largest_range"',
             '"program/steps"', "'fatigue' has no effect without a measure 'fatigue/…'"),
        ):  # fmt: skip
            with self.subTest(message=message):
                self.assertIn(old, STUDY)
                self.write_study(STUDY.replace(old, new), run="run.toml")
                self.assert_refuses(self.study(), message)


if __name__ == "__main__":
    unittest.main()
