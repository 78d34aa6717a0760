#!/usr/bin/python3
"""Where linear bending ends: deflections that are too large, and axial forces that would change them, are told."""

import os
import unittest

import numpy as np

from section_test import CANTILEVER, find_warnings
from verification_case import SUPERELEMENTS, VerificationCase, run_program

CRANK = """
name = "slider crank"
gravity = [0.0, 0.0]
[bodies.crank]
mass = 1.0
inertia = 0.1
position = [0.0, 0.0]
[bodies.crank.points]
pin = [0.3, 0.0]
[bodies.rod]
superelement = "spin_up_beam"
position = [0.3, 0.0]
[bodies.slider]
mass = 5.0
inertia = 1.0
position = [8.3, 0.0]
[[joints]]
name = "shaft"
type = "revolute"
a = "ground.origin"
b = "crank.origin"
[[joints]]
name = "pin"
type = "revolute"
a = "crank.pin"
b = "rod.root"
[[joints]]
name = "wrist"
type = "revolute"
a = "rod.tip"
b = "slider.origin"
[[joints]]
name = "guide"
type = "translational"
axis = [1.0, 0.0]
a = "ground.origin"
b = "slider.origin"
[[motions]]
name = "speed"
joint = "shaft"
function = { polynomial = [0.0, SPEED] }
"""


class LinearBending(VerificationCase):
    def run_crank(self, speed, stiffening=False, is_hit=True):
        run = 'start = "as-given"\nduration = 3.0\noutput_step = 0.01\n[modes]\nrod = 4\n[stiffening]\nrod = '
        run += f"{str(stiffening).lower()}\n"
        if is_hit:
            run += "[initial.rod]\nvelocity = [0.0, 0.0]\n"
        results = self.run_text(CRANK.replace("SPEED", str(speed)), run)
        return results.summary, results["points/rod.tip/deflection"][:, 1]

    def is_told_of_axial_forces(self, summary):
        return any("axial forces change the bending" in warning["text"] for warning in summary["warnings"])

    def test_axial_forces_in_a_fast_connecting_rod_are_told_where_stiffening_changes_the_deflection(self):
        # Their effect is that of the first order: it is the real change of the largest deflection to a tenth of the
        # deflection. The hit gives the slow rod axial vibration, whose forces are larger than those of the motion and
        # change nothing.
        for speed, is_told in ((0.25, False), (0.5, True), (4.0, True)):
            summary, deflection = self.run_crank(speed)
            stiffened, right = self.run_crank(speed, stiffening=True)
            self.assertEqual(stiffened["bending"]["rod"]["axial_effect"], 0.0)
            effect = summary["bending"]["rod"]["axial_effect"]
            self.assertEqual(self.is_told_of_axial_forces(summary), is_told)
            change = np.max(np.abs(deflection)) / np.max(np.abs(right)) - 1.0
            self.assertAlmostEqual(effect, abs(change), delta=0.1)

    def test_axial_forces_that_change_sign_with_the_bending_are_told(self):
        # Without a hit the axial force and the deflection both follow the crank, and the work of one in the other has a
        # mean near zero. Their combined frequency, twice that of the crank, nears the lowest of the pinned rod,
        # 1.3 Hz, which makes the change larger than one of first order.
        for is_hit, speeds in ((False, (0.5, 2.0, 3.0, 4.0)), (True, (2.0, 3.0, 4.0))):
            for speed in speeds:
                summary, deflection = self.run_crank(speed, is_hit=is_hit)
                _, right = self.run_crank(speed, stiffening=True, is_hit=is_hit)
                self.assertEqual(self.is_told_of_axial_forces(summary), speed > 1.0, (is_hit, speed))
                change = abs(np.std(deflection) / np.std(right) - 1.0)
                effect = summary["bending"]["rod"]["axial_effect"]
                self.assertTrue(1.0 / 3.0 < effect / change < 3.0, (is_hit, speed, effect, change))

    def test_a_column_under_load_is_told_whatever_it_stores_by_compression(self):
        # Clamped at one end it buckles at π² EI/4L² = 2467 N, EI = 4000 N m² and L = 2 m. Its compression stores far
        # more than its bending does. The force across it bends it to w = 3Lx² − x³, so that the effect is
        # P ∫w'² dx / EI ∫w''² dx = 2PL²/5EI.
        beam = CANTILEVER.format(wall="origin", held="left", loaded="right")
        for force, is_told in ((1700.0, True), (100.0, True), (50.0, False)):
            vehicle = beam.replace("[0.0, -10.0]", f"[{-force}, -1.0]")
            summary = self.run_text(vehicle, "duration = 0.01\n[modes]\nbeam = 16\n").summary
            expected = 0.4 * force * 2.0**2 / 4000.0
            self.assertAlmostEqual(summary["bending"]["beam"]["axial_effect"] / expected, 1.0, delta=1e-3)
            self.assertEqual(self.is_told_of_axial_forces(summary), is_told)

    def test_a_deflection_beyond_a_tenth_of_the_length_is_told(self):
        # A cantilever with EI = 4000 N m² and L = 2 m deflects by F L³/3EI under the force F at its tip.
        for share, told in ((0.09, False), (0.12, True)):
            force = share * 2.0 * 3.0 * 4000.0 / 2.0**3
            vehicle = CANTILEVER.format(wall="origin", held="left", loaded="right").replace("-10.0", str(force))
            run = "duration = 0.01\n[modes]\nbeam = 16\n"
            results = self.run_text(vehicle, run)
            self.assertAlmostEqual(results.summary["bending"]["beam"]["deflection"], share, delta=2e-3 * share)
            process = run_program(
                [os.environ["SPRUNG_DYNAMICS"], "run", "run.toml", "--superelements", SUPERELEMENTS, "--quiet"],
                cwd=self.folder, check=True,
            )  # fmt: skip
            expected = "warning: beam: the deflection is 12 % of the body's length (at t = 0 s)"
            self.assertEqual(any(line.startswith(expected) for line in find_warnings(process.stdout)), told)
            balance = self.program("equilibrium", "run.toml", superelements=SUPERELEMENTS)
            texts = [one["text"] for one in balance["warnings"]]
            self.assertEqual(any("of the body's length" in text for text in texts), told, texts)


if __name__ == "__main__":
    unittest.main()
