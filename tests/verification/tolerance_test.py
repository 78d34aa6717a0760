#!/usr/bin/python3
"""What the tolerance of a run means: errors of the truck's runs over it, with any number of modes."""

import math
import os
import unittest

import numpy as np

from verification_case import ROOT, VerificationCase

TRUCK = ROOT / "dynamics/models/truck"
LENGTH = 3.9  # m: the truck's length scale, from the chassis' frame to its farthest point


class Tolerance(VerificationCase):
    def run_truck(self, run, modes, tolerance):
        """Height of the chassis and acceleration of the driver's seat by the default method."""
        results = self.run_to_results(
            TRUCK / f"{run}.toml", "--set", f"modes.chassis={modes}", "--set", "output.precision=double",
            "--set", f"integrator.relative_tolerance={tolerance}",
            superelements=os.environ["SPRUNG_TRUCK_SUPERELEMENTS"],
        )  # fmt: skip
        return results["bodies/chassis/position"][:, 1], results["points/chassis.seat/acceleration"][:, 1]

    def test_height_and_acceleration_meet_it_with_any_number_of_modes(self):
        """The height to a twentieth of the tolerance times the length scale, over terrain to a hundredth: there it was
        0.09 of the tolerance with 36 modes, while these gave way by a constant inertia over each step. The
        acceleration, r.m.s. of r.m.s., to five times the tolerance with a few modes and to 40 times with all: errors in
        stiff modes count by their frequencies. The largest error of the height scatters between tolerances that differ
        by 1e-4 of themselves, so that its r.m.s. of eight runs counts."""
        for run, share in (("bump", 1.0 / 20.0), ("terrain", 1.0 / 100.0)):
            for modes in (0, 2, 4, 36) if run == "bump" else (0, 36):
                height, acceleration = self.run_truck(run, modes, 1e-7)
                for tolerance in (1e-4, 1e-5):
                    with self.subTest(run=run, modes=modes, tolerance=tolerance):
                        squares = []
                        for factor in 1.0 + 1e-4 * np.arange(8):
                            found = self.run_truck(run, modes, factor * tolerance)
                            squares.append(np.max(np.abs(found[0] - height)) ** 2)
                            off = np.sqrt(np.mean((found[1] - acceleration) ** 2) / np.mean(acceleration**2))
                            self.assertLess(off, (40.0 if modes == 36 else 5.0) * tolerance)
                        self.assertLess(math.sqrt(np.mean(squares)), share * LENGTH * tolerance)


if __name__ == "__main__":
    unittest.main()
