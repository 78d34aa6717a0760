"""Stresses of a cantilever as the programs run it, against those of its weight."""

import os
import re
import unittest

import numpy as np
from cantilever import DESIGN, VEHICLE
from tool_test_case import ToolTestCase, run_program

from sprung_tools.files.results_file import open_results
from sprung_tools.runs.section_stress import calc_section_stress

RUN = """
vehicle = "vehicle.toml"
speed = 0.0
duration = 0.1
output_step = 0.01
[road]
shape = "flat"
"""


class Programs(ToolTestCase):
    def setUp(self):
        super().setUp()
        for name, text in (("beam.toml", DESIGN), ("vehicle.toml", VEHICLE), ("run.toml", RUN)):
            (self.folder / name).write_text(text, encoding="utf-8")
        self.run_stage("SPRUNG_REDUCE", "build", "beam.toml", "--output-dir", ".")

    def run_stage(self, program, *arguments):
        done = run_program([os.environ[program], *arguments], cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)

    def run_cantilever(self, *arguments):
        self.run_stage("SPRUNG_DYNAMICS", "run", "run.toml", "--superelements", ".", "-o", "run.h5", *arguments)

    def test_the_refusal_names_the_setting_with_which_the_run_is_accepted(self):
        steps = ("--set", "output_step=0.0025")
        self.run_cantilever(*steps, "--set", "output.step.recovery=0.01")
        refused = self.run_tool("fatigue", "run.h5", "--category", "71")
        self.assert_refuses(refused, "is stored every 10 ms only")
        (setting,) = re.findall(r"again with (--set \S+),", refused.stderr)
        self.assertEqual(setting, "--set output.step.recovery=0.0025")
        self.run_cantilever(*steps, *setting.split())
        self.assert_succeeds(self.run_tool("fatigue", "run.h5", "--category", "71"))

    def test_a_cantilever_at_rest_has_the_stress_of_its_weight_at_its_root(self):
        self.run_cantilever()
        with open_results(self.folder / "run.h5") as results:
            section = calc_section_stress(results, "beam", "loads")
        # M = −ρ A g L²/2 of the root, W = b h²/6: σ = 3 ρ g L²/h, tension above; the number of members does not count.
        expected = 3.0 * 7850.0 * 9.80665 * 2.0**2 / 0.12
        self.assertEqual(section.sides[0], ("+y", "-y"))
        np.testing.assert_allclose(section.stress[:, 0, 0], expected, rtol=1e-6)
        np.testing.assert_allclose(section.stress[:, 0, 1], -expected, rtol=1e-6)

    def test_springs_and_foundations_of_a_design_leave_the_stresses_of_its_sections(self):
        parts = DESIGN.replace("[[lines]]", """carrier = [2.0, 0.3]
[[springs]]
from = "tip"
to = "carrier"
axial_stiffness = 1e6
rotational_stiffness = 1e5
[[foundations]]
from = "foot"
to = "tip"
part = "carrier"
normal_stiffness = 1.0
[[point_masses]]
point = "carrier"
mass = 50.0
[[lines]]""")
        (self.folder / "beam.toml").write_text(parts, encoding="utf-8")
        self.run_stage("SPRUNG_REDUCE", "build", "beam.toml", "--output-dir", ".", "--force")
        self.run_cantilever()
        with open_results(self.folder / "run.h5") as results:
            section = calc_section_stress(results, "beam", "loads")
        self.assertEqual(sorted(set(section.elements)), [1, 2, 3, 4])
        # The mass adds m g L to the moment at the root, W = 2 b h²/6 of both members; the foundation hardly counts.
        expected = 3.0 * 7850.0 * 9.80665 * 2.0**2 / 0.12 + 50.0 * 9.80665 * 2.0 / (0.05 * 0.12**2 / 3.0)
        root = section.stress[:, section.along == 0.0, 0]
        np.testing.assert_allclose(root, expected, rtol=1e-5)


if __name__ == "__main__":
    unittest.main()
