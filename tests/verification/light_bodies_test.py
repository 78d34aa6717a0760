#!/usr/bin/python3
"""A slider-crank whose mass is almost all in its slider: links far lighter than usual must not decide anything."""

import math
import os
import re
import unittest

from scipy.integrate import quad

from verification_case import VerificationCase, run_program

METHODS = ("exponential", "adams", "bdf", "generalized-alpha")
ROD = 2.0  # m; the crank has 1 m
START = 1.0  # rad, of the crank, which begins to turn at 1 rad/s


def slider_place(angle):
    return math.cos(angle) + math.sqrt(ROD**2 - math.sin(angle) ** 2)


def slider_rate(angle):
    """dx/dψ of the slider."""
    return -math.sin(angle) * (1.0 + math.cos(angle) / math.sqrt(ROD**2 - math.sin(angle) ** 2))


SPEED = slider_rate(START)  # m/s, of the slider at the start
DEAD_CENTRE = (ROD - 1.0 - slider_place(START)) / SPEED  # s, if the slider keeps it
ANGLE = -math.asin(math.sin(START) / ROD)  # of the rod


def slider_crank(mass, inertia):
    """A vehicle file. @param mass, inertia  of the crank and of the rod"""
    return f"""
name = "slider-crank"
gravity = [0.0, 0.0]
[bodies.crank]
mass = {mass}
inertia = {inertia}
position = [0.0, 0.0]
angle = {START}
points = {{ end = [1.0, 0.0] }}
[bodies.rod]
mass = {mass}
inertia = {inertia if mass else 0}
position = [{0.5 * (math.cos(START) + slider_place(START))!r}, {0.5 * math.sin(START)!r}]
angle = {ANGLE!r}
points = {{ start = [{-0.5 * ROD}, 0.0], end = [{0.5 * ROD}, 0.0] }}
[bodies.slider]
mass = 1.0
inertia = 0.1
position = [{slider_place(START)!r}, 0.0]
[[joints]]
name = "axle"
type = "revolute"
a = "ground.origin"
b = "crank.origin"
[[joints]]
name = "crank_pin"
type = "revolute"
a = "crank.end"
b = "rod.start"
[[joints]]
name = "slider_pin"
type = "revolute"
a = "rod.end"
b = "slider.origin"
[[joints]]
name = "guide"
type = "translational"
a = "ground.origin"
b = "slider.origin"
axis = [1.0, 0.0]
"""


def run_file(method, duration):
    return (
        f'start = "as-given"\nduration = {duration}\noutput_step = 0.01\n[joint_rates]\naxle = 1.0\n'
        f'[output]\nprecision = "double"\n[integrator]\nmethod = "{method}"\n'
    )


class SliderCrank(VerificationCase):
    def test_the_slider_keeps_its_speed(self):
        # It has all of the kinetic energy, but for ½ J ψ̇², which changes by less than 2 J as ψ̇ stays below 2 rad/s.
        for mass, inertia in ((0, 0), (0, 1e-12), (0, 1e-9), (1e-9, 1e-9), (0, 1e-6), (1e-6, 1e-6)):
            for method in METHODS:
                with self.subTest(mass=mass, inertia=inertia, method=method):
                    results = self.run_text(slider_crank(mass, inertia), run_file(method, 1.0))
                    place = slider_place(START) + SPEED * results.time
                    self.assert_close(
                        results["bodies/slider/position"][:, 0], place, absolute=2e-8 + inertia + 2.0 * mass
                    )
                    self.assertLess(results.summary["energy_closure"], 1e-4)

    def test_a_light_crank_is_carried_over_its_dead_centre(self):
        # There the crank has all of the energy: it turns at 1100 rad/s. Time by angle: dt = dψ √((J + m x'²)/2T).
        inertia = 1e-6
        for method in ("exponential", "adams", "bdf"):
            with self.subTest(method):
                results = self.run_text(slider_crank(0, inertia), run_file(method, 3.0))
                energy = 0.5 * (inertia + SPEED**2)
                end = results["joints/axle/coordinate"][-1]
                self.assertGreater(end, math.pi + 1.0)
                time, _ = quad(
                    lambda angle: math.sqrt((inertia + slider_rate(angle) ** 2) / (2.0 * energy)),
                    START, end, points=[math.pi], limit=500,
                )  # fmt: skip
                self.assertAlmostEqual(time, 3.0, delta=2e-4)

    def test_without_any_mass_in_the_links_the_dead_centre_ends_the_run(self):
        # The slider cannot stop there, nor go on: the run stops just before it, and names that time.
        for method in METHODS:
            with self.subTest(method):
                run = self.write_model(slider_crank(0, 0), run_file(method, 3.0))
                process = run_program([os.environ["SPRUNG_DYNAMICS"], "run", str(run), "--quiet"], cwd=self.folder)
                self.assertEqual(process.returncode, 3, process.stderr)
                found = re.search(r"at t = ([0-9.]+) s", process.stderr)
                self.assertIsNotNone(found, process.stderr)
                self.assertIn("singular", process.stderr)
                self.assertLess(float(found[1]), DEAD_CENTRE)
                self.assertGreater(float(found[1]), DEAD_CENTRE - 1e-3)


if __name__ == "__main__":
    unittest.main()
