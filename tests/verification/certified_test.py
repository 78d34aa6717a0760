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


def keep_up_to_60_hz(values, step=1e-3):
    spectrum = np.fft.rfft(values)
    spectrum[np.fft.rfftfreq(len(values), step) > 60.0] = 0.0
    return np.fft.irfft(spectrum, len(values))


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

    # Without damping, since a ratio of clamped modes is another one of free modes; in the certified band.
    def test_a_run_over_the_bump_is_that_of_the_full_model_up_to_60_hz(self):
        undamped = ("--set", "modal_damping.chassis=0")
        truth = self.run_truck(*ALL, *undamped)
        certified = self.run_truck(*CERTIFIED, *undamped)
        for quantity, share in (("position", 1e-3), ("acceleration", 0.02)):
            expected, found = (
                keep_up_to_60_hz(results[f"points/chassis.seat/{quantity}"][:, 1]) for results in (truth, certified)
            )
            self.assertLess(np.std(found - expected), share * np.std(expected))
        self.assertLess(certified.summary["energy_closure"], 1e-3)

    def test_a_number_takes_the_free_modes_first(self):
        results = self.run_truck(*CERTIFIED[:2], "--set", "modes.chassis=5")
        self.assertEqual(results["bodies/chassis/modal/amplitude"].shape[1], 5)


if __name__ == "__main__":
    unittest.main()
