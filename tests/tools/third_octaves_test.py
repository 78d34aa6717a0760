"""signals/third_octaves.py: the bands of known signals, and the standard's boundary."""

import unittest

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.signals.third_octaves import COMFORT, NOMINAL, PROFICIENCY, calc_comfort_boundary, calc_third_octaves

# ISO 2631:1978, fatigue-decreased proficiency boundary for a_z after 8 h, m/s², at 1 to 80 Hz, in preferred numbers
# (steps of 1/10 or 1/20 of a decade, which lie up to 1.6 % from the straight lines between them)
EIGHT_HOURS = (0.63, 0.56, 0.50, 0.45, 0.40, 0.355, 0.315, 0.315, 0.315, 0.315, 0.40, 0.50, 0.63, 0.80, 1.0, 1.25, 1.60,
               2.0, 2.5, 3.15)  # fmt: skip


class ThirdOctaves(unittest.TestCase):
    def test_a_sine_stands_in_its_band_alone(self):
        step = 1e-3
        time = np.arange(0.0, 200.0, step)  # the band at 0.5 Hz is 0.1 Hz wide
        for band in (0, 1, 9, 16, 22):
            with self.subTest(frequency=NOMINAL[band]):
                exact = 10.0 ** ((band - 3) / 10.0)
                found = calc_third_octaves(np.sqrt(2.0) * 1.5 * np.sin(2.0 * np.pi * exact * time), step)
                self.assertEqual(found.size, len(NOMINAL))
                self.assertAlmostEqual(found[band], 1.5, delta=0.02)
                # One band away |p| = 2.02, where the filter lets 1/√(1 + 2.02⁶) = 0.12 through. The ends of the span
                # add a little in the narrowest bands.
                others = np.delete(found, band)
                self.assertLess(np.max(others), 1.5 * 0.14)

    def test_white_noise_has_the_mean_square_of_each_bands_width(self):
        step, size = 1e-3, 400000
        noise = np.random.default_rng(1).standard_normal(size)
        found = calc_third_octaves(noise, step)
        centres = 10.0 ** (np.arange(-3, 20) / 10.0)
        # The density of the noise is 2 step; a Butterworth filter of sixth order takes π/3 of the width between its
        # edges. A band of width B has 2 B T = 800 B independent values.
        expected = 2.0 * step * centres * (10.0**0.05 - 10.0**-0.05) * np.pi / 3.0
        deviation = found**2 / expected - 1.0
        self.assertLess(np.max(np.abs(deviation) * np.sqrt(400.0 * 0.23 * centres)), 4.0)
        self.assertLess(np.max(np.abs(deviation[-6:])), 0.05)

    def test_all_bands_together_have_the_mean_square_of_a_short_span(self):
        # The filters overlap: from 0.5 to 80 Hz the sum of their |H|² is between 1 and 1.08, on average π/3.
        step = 1e-3
        time = np.arange(0.0, 2.0, step)
        values = np.exp(-(((time - 1.9) / 0.05) ** 2)) * np.sin(2.0 * np.pi * 10.0 * time)  # a shock near the end
        found = calc_third_octaves(values, step)
        self.assertAlmostEqual(np.sum(found**2) / np.mean(values**2), np.pi / 3.0, delta=0.02)

    def test_the_boundary_is_the_standards_divided_by_3_15(self):
        centres = np.array(NOMINAL[3:])
        np.testing.assert_allclose(COMFORT * calc_comfort_boundary("8 h", centres), EIGHT_HOURS, rtol=0.016)
        for exposure, least in PROFICIENCY.items():
            found = calc_comfort_boundary(exposure, centres)
            self.assertAlmostEqual(np.min(found), least / 3.15)
            np.testing.assert_allclose(found / calc_comfort_boundary("8 h", centres), least / 0.315)


if __name__ == "__main__":
    unittest.main()
