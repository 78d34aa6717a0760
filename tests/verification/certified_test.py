#!/usr/bin/python3
"""The truck with the certified chassis, against the chassis with all motions of its model."""

import os
import unittest

import numpy as np

from verification_case import ROOT, VerificationCase

BUMP = ROOT / "dynamics/models/truck/bump.toml"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]
ALL = ("--set", 'modes.chassis="all"')
CERTIFIED = (
    "--set", "vehicle.bodies.chassis.superelement=chassis_certified",
    "--set", 'modes.chassis="certified"',
)  # fmt: skip


class CertifiedChassis(VerificationCase):
    def truck_modes(self, *arguments):
        return self.modes(BUMP, *arguments, superelements=TRUCK_SUPERELEMENTS)[0]

    def run_truck(self, *arguments):
        return self.run_to_results(
            BUMP, *arguments, "--set", "duration=1.5", "--set", "statistics.to=1.5", superelements=TRUCK_SUPERELEMENTS
        )

    # The 36 clamped modes of the chassis are all motions that its model has: the truth.
    def test_frequencies_in_the_band_are_those_of_the_full_model(self):
        truth = self.truck_modes(*ALL)
        in_band = truth < 2.0 * np.pi * 60.0
        certified = self.truck_modes(*CERTIFIED)
        self.assert_close(certified[: in_band.sum()], truth[in_band], relative=1e-3)

    def test_a_run_over_the_bump_is_that_of_the_full_model(self):
        truth = self.run_truck(*ALL)["points/chassis.seat/acceleration"][:, 1]
        results = self.run_truck(*CERTIFIED)
        certified = results["points/chassis.seat/acceleration"][:, 1]
        self.assertLess(np.std(certified - truth), 0.02 * np.std(truth))
        self.assertLess(results.summary["energy_closure"], 1e-3)

    def test_a_number_takes_the_free_modes_first(self):
        results = self.run_truck(*CERTIFIED[:2], "--set", "modes.chassis=5")
        self.assertEqual(results["bodies/chassis/modal/amplitude"].shape[1], 5)


if __name__ == "__main__":
    unittest.main()
