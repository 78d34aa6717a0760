"""A beam on two supports, whose reference point one of them holds: what a run says of its moments and of its basis."""

import os
import unittest

import numpy as np
from verification_case import VerificationCase, run_program

POINT_MASS = '[[point_masses]]\npoint = "middle"\nmass = 800.0\n'
DESIGN = f"""
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.rail]
material = "steel"
shape = "rectangle"
width = 0.1
height = 0.2
[points]
left = [0.0, 0.0]
middle = [2.0, 0.0]
right = [6.0, 0.0]
[[lines]]
through = ["left", "middle", "right"]
section = "rail"
elements = [4, 8]
{POINT_MASS}[reference]
point = "left"
[interface]
left = "xyr"
middle = "xy"
right = "xyr"
[reduction]
highest_frequency = 200.0
[modes]
damping_ratio = 0.02
"""
VEHICLE = """
name = "supported beam"
[ground.points]
left = [0.0, 0.0]
right = [6.0, 0.0]
[bodies.beam]
superelement = "beam"
position = [0.0, 0.0]
[[joints]]
name = "pin"
type = "revolute"
a = "ground.left"
b = "beam.left"
[[joints]]
name = "roller"
type = "pin-in-slot"
a = "ground.right"
b = "beam.right"
axis = [1.0, 0.0]
[[forces]]
name = "shaker"
type = "applied"
point = "beam.middle"
force = [0.0, {{ harmonic = {{ amplitude = 5000.0, frequency = {frequency} }} }}]
"""
RUN = 'duration = {duration}\noutput_step = {step}\n[modes]\nbeam = "certified"\n'


class SupportedBeam(VerificationCase):
    def setUp(self):
        super().setUp()
        (self.folder / "beam.toml").write_text(DESIGN, encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "beam.toml"], cwd=self.folder, check=True)

    def run_beam(self, output_step, frequency=10.0):
        run = self.write_model(VEHICLE.format(frequency=frequency), RUN.format(duration=3.0, step=output_step))
        return self.run_to_results(run, superelements=self.folder)

    def test_outputs_that_do_not_resolve_the_moments_are_warned_of(self):
        """The point reported is the one that the pin holds: its acceleration says nothing. Every 0.05 and 0.1 s the
        force of 10 Hz has the same phase or its opposite at all outputs; every 0.02 s there
        are five of them in a period."""
        ranges = {}
        for step, is_coarse in ((0.001, False), (0.02, False), (0.05, True), (0.1, True)):
            with self.subTest(step=step):
                results = self.run_beam(step)
                ranges[step] = np.max(np.ptp(results["recovery/beam/moment_from_loads"][results.time > 1.0], axis=0))
                told = [one for one in results.summary["warnings"] if "bending moments of beam" in one["text"]]
                self.assertEqual(bool(told), is_coarse, results.summary["warnings"])
                if told:
                    self.assertEqual((told[0]["concerns"], told[0]["of"]), ("summary", ["beam"]))
                    self.assertIn(f"values every {step:g} s do not resolve the bending moments", told[0]["text"])
        self.assertGreater(ranges[0.02], 0.9 * ranges[0.001])
        self.assertLess(ranges[0.05], 0.7 * ranges[0.001])

    def test_a_load_that_comes_slowly_does_not_hide_a_vibration(self):
        """40 kN come within a second, beside 5 kN at 10 Hz: every 0.03 s there are three outputs in a period."""
        slowly = "{{ table = [[0.0, 0.0], [1.0, -4e4], [3.0, -4e4]] }}"
        fast = "{{ harmonic = {{ amplitude = 5000.0, frequency = {frequency} }} }}"
        self.assertIn(fast, VEHICLE)
        slow = VEHICLE.replace(fast, "{{ sum = [" + slowly + ", " + fast + "] }}")
        for step, is_coarse in ((0.001, False), (0.03, True)):
            with self.subTest(step=step):
                run = self.write_model(slow.format(frequency=10.0), RUN.format(duration=3.0, step=step))
                warnings = self.run_to_results(run, superelements=self.folder).summary["warnings"]
                self.assertEqual(any("bending moments of beam" in one["text"] for one in warnings), is_coarse, warnings)

    def test_a_beam_at_rest_is_not_warned_of(self):
        """Its moments, 34 kN m of weight, change by rounding alone, which no outputs resolve."""
        run = self.write_model(VEHICLE.partition("[[forces]]")[0], RUN.format(duration=1.0, step=0.01))
        self.assertEqual(self.run_to_results(run, superelements=self.folder).summary["warnings"], [])

    def test_a_direction_in_which_a_point_is_held_misses_nothing(self):
        """The roller moves along x alone: of an acceleration of zero along y no share can be missing."""
        results = self.run_beam(0.001)
        found = results.summary["certified"]["beam"]
        self.assertNotEqual((found["point"], found["axis"]), ("beam.right", "y"))
        self.assertFalse([one for one in results.summary["warnings"] if "superelement" in one["text"]])

    def test_loads_on_the_centre_of_mass_are_said_to_be_spread(self):
        """They are spread as the mass is: on a beam without the point mass a force at midspan would bend it twice as
        much, F L/4 in place of F L/8."""
        (self.folder / "beam.toml").write_text(DESIGN.replace(POINT_MASS, ""), encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "beam.toml"], cwd=self.folder, check=True)
        vehicle = "gravity = [0.0, 0.0]" + VEHICLE.partition("[[forces]]")[0] + (
            '[[forces]]\nname = "weight"\ntype = "applied"\npoint = "beam.center_of_mass"\n'
            "force = [0.0, -10000.0]\n"
        )
        run = self.write_model(vehicle, RUN.format(duration=0.1, step=0.01))
        results = self.run_to_results(run, superelements=self.folder)
        self.assert_close(np.max(results["recovery/beam/moment_from_loads"]), 10000.0 * 6.0 / 8.0, relative=1e-5)
        (told,) = [one["text"] for one in results.summary["warnings"] if "are spread along the body" in one["text"]]
        self.assertIn("loads on beam.center_of_mass are spread", told)


if __name__ == "__main__":
    unittest.main()
