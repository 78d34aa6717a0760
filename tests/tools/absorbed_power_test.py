"""signals/absorbed_power.py: against the absorbed power of Lee and Pradko, and in time."""

import unittest

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.signals.absorbed_power import FEET_PER_METRE, calc_absorbed_power, calc_response


def calc_lee_and_pradko(frequency):
    """The vertical absorbed power by frequency, W per (ft/s²)² r.m.s., SAE paper 680091 (1968):
    K₀ K₁ (F₁ F₄ − F₂ F₃) / (F₃² + ω² F₄²)."""
    w = 2.0 * np.pi * frequency
    f1 = -0.10245e-9 * w**6 + 0.17583e-5 * w**4 - 0.44600e-2 * w**2 + 1.0
    f2 = 0.12882e-7 * w**4 - 0.93394e-4 * w**2 + 0.10543
    f3 = -0.45416e-9 * w**6 + 0.37667e-5 * w**4 - 0.56104e-2 * w**2 + 1.0
    f4 = -0.21179e-11 * w**6 + 0.51728e-7 * w**4 - 0.17946e-3 * w**2 + 0.10543
    return 4.3537 * 1.356 * (f1 * f4 - f2 * f3) / (f3**2 + w**2 * f4**2)


class AbsorbedPower(unittest.TestCase):
    def test_the_filter_has_the_power_of_lee_and_pradko(self):
        # Two fits of the same measurements: close where people feel most, a quarter apart elsewhere.
        most_felt, all_felt = np.linspace(4.0, 6.0, 21), np.geomspace(0.5, 80.0, 100)
        for frequency, tolerance in ((most_felt, 0.04), (all_felt, 0.26)):
            power = np.abs(calc_response(frequency)) ** 2
            np.testing.assert_allclose(power, calc_lee_and_pradko(frequency), rtol=tolerance)
        # What tools/README.md says
        for frequency, deviation in ((8.2, 0.26), (1.7, -0.17), (20.0, 0.20), (80.0, -0.23)):
            found = abs(calc_response(frequency)) ** 2 / calc_lee_and_pradko(frequency) - 1.0
            self.assertAlmostEqual(found, deviation, delta=5e-3)
        felt = np.linspace(1.0, 20.0, 2000)
        peaks = [felt[np.argmax(power)] for power in (np.abs(calc_response(felt)) ** 2, calc_lee_and_pradko(felt))]
        self.assertAlmostEqual(peaks[0], peaks[1], delta=0.25)

    def test_a_sine_has_a_person_absorb_its_mean_square_times_the_response(self):
        step = 1e-3
        time = np.arange(0.0, 30.0, step)
        for frequency in (1.0, 4.5, 20.0):
            power = calc_absorbed_power(1.7 * np.sin(2.0 * np.pi * frequency * time), step)[time >= 10.0]
            expected = 0.5 * (1.7 * FEET_PER_METRE * abs(calc_response(frequency))) ** 2
            self.assertAlmostEqual(np.mean(power) / expected, 1.0, delta=2e-3)

    def test_six_watts_are_reached_at_about_a_sixth_of_gravity_where_it_is_felt_most(self):
        # Lee and Pradko at 4.5 Hz: √(6 W / 0.2034 W per (ft/s²)²) = 5.43 ft/s² = 1.66 m/s² r.m.s.
        rms = np.sqrt(6.0 / abs(calc_response(4.5)) ** 2) / FEET_PER_METRE
        self.assertAlmostEqual(rms, 1.66, delta=0.04)


if __name__ == "__main__":
    unittest.main()
