"""signals/third_octaves.py: the bands of known signals, and the standard's boundary."""

import unittest

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.signals.third_octaves import (
    COMFORT,
    NOMINAL,
    PROFICIENCY,
    calc_band,
    calc_comfort_boundary,
    calc_third_octaves,
)

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
                sine = np.sqrt(2.0) * 1.5 * np.sin(2.0 * np.pi * exact * time)
                found = calc_third_octaves(sine, step, time >= 50.0)
                self.assertEqual(found.size, len(NOMINAL))
                self.assertAlmostEqual(found[band], 1.5, delta=0.02)
                # One band away |p| = 2.02, where the filter lets 1/√(1 + 2.02⁶) = 0.12 through.
                others = np.delete(found, band)
                self.assertLess(np.max(others), 1.5 * 0.125)

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

    def test_a_sine_in_a_span_has_its_rms_there(self):
        step = 1e-3
        time = np.arange(0.0, 8.0, step)
        exact = 10.0**1.2
        # Of a span of 3.1 s at most half a period is left over.
        found = calc_third_octaves(np.sin(2.0 * np.pi * exact * time), step, (time >= 2.0) & (time < 5.1))
        self.assertAlmostEqual(found[NOMINAL.index(16.0)] * np.sqrt(2.0), 1.0, delta=0.25 / (exact * 3.1))

    def test_a_slow_swing_that_the_span_cuts_leaves_nothing_in_high_bands(self):
        # |H| at 1 Hz is 1/|p|³ of a filter of sixth order far above, |p| = (f₀² − 1)/B with the width B = 0.2307 f₀.
        step = 1e-3
        time = np.arange(0.0, 12.0, step)
        for swing in (np.sin(2.0 * np.pi * time), 3.0 + np.cos(2.0 * np.pi * time + 0.4)):
            found = calc_third_octaves(swing, step, (time >= 5.3) & (time < 9.7))
            for nominal, exact in ((12.5, 10.0**1.1), (31.5, 10.0**1.5), (63.0, 10.0**1.8)):
                let_through = (10.0**0.05 - 10.0**-0.05) ** 3 * exact**3 / (exact**2 - 1.0) ** 3
                self.assertLess(found[NOMINAL.index(nominal)], 1.05 * let_through / np.sqrt(2.0) + 1e-8)

    def test_a_slow_swing_that_the_record_cuts_leaves_little_in_high_bands(self):
        # The bound is (3); 5 % for the widths of bands that are not small beside 1 Hz.
        step = 1e-3
        for length, phase in ((4.4, 0.0), (4.4, 1.1), (6.0, 0.4), (6.7, 1.5708)):
            swing = 3.0 + np.cos(2.0 * np.pi * np.arange(0.0, length, step) + phase)
            found = calc_third_octaves(swing, step)
            for nominal, exact in ((12.5, 10.0**1.1), (31.5, 10.0**1.5), (63.0, 10.0**1.8)):
                self.assertLess(found[NOMINAL.index(nominal)], 1.05 * 0.22 / np.sqrt(exact**3 * length))

    def test_a_shock_counts_in_full_wherever_in_the_record_it_is(self):
        # Half a sine of 40 ms, which has less than 1 % of its energy above 89 Hz. Filters that begin with the record
        # left a fifth of one at its end. Of a record of 2 s the mean and half of the first line are below the bands.
        step = 1e-3
        time = step * np.arange(2000)
        for begin in (0.0, 0.3, 1.0, 1.955, 1.98):
            shock = np.where((time >= begin) & (time < begin + 0.04), np.sin(np.pi * (time - begin) / 0.04), 0.0)
            together = np.sqrt(3.0 / np.pi * np.sum(calc_third_octaves(shock, step) ** 2))
            self.assertAlmostEqual(together / np.sqrt(np.mean(shock**2)), 1.0, delta=0.05)

    def test_half_of_a_shock_at_an_end_of_the_span_is_in_it(self):
        shock = np.zeros(16000)
        shock[7999:8001] = 1.0
        whole, half = (calc_third_octaves(shock, 1e-3, inside) for inside in (slice(None), slice(8000)))
        np.testing.assert_allclose(half**2 * 8000, 0.5 * whole**2 * 16000, rtol=0.02)

    def test_bands_narrower_than_the_lines_of_a_short_record_have_no_holes(self):
        # White noise of 1 s has a line every 0.5 Hz, and the band at 0.63 Hz is from 0.56 to 0.71 Hz: each band has, on
        # average over many records, the mean square of its width.
        step = 1e-2
        noise = np.random.default_rng(2).standard_normal((1000, 100))
        found = np.mean([calc_third_octaves(one, step) ** 2 for one in noise], axis=0)
        centres = 10.0 ** (np.arange(-3, 13) / 10.0)
        expected = 2.0 * step * centres * (10.0**0.05 - 10.0**-0.05) * np.pi / 3.0
        np.testing.assert_allclose(found[: centres.size], expected, rtol=0.1)

    def test_a_constant_acceleration_is_in_no_band(self):
        found = calc_third_octaves(np.full(3000, 9.81), 1e-3)
        self.assertEqual(np.max(found), 0.0)

    def test_the_squares_of_all_bands_of_random_vibration_add_up_to_its_mean_square(self):
        # The filters overlap: from 0.5 to 80 Hz the sum of their |H|² is between 1 and 1.08, on average π/3. The noise
        # is from 2 to 40 Hz, so that the bands hold all of it.
        step, size = 1e-3, 100000
        frequency = np.fft.rfftfreq(size, step)
        random = np.random.default_rng(4).standard_normal((2, frequency.size))
        noise = np.fft.irfft((random[0] + 1j * random[1]) * ((frequency > 2.0) & (frequency < 40.0)), size)
        inside = slice(30000, 90000)
        found = calc_third_octaves(noise, step, inside)
        self.assertAlmostEqual(np.sum(found**2) / np.mean(noise[inside] ** 2), np.pi / 3.0, delta=0.02)

    def test_99_percent_of_a_shock_lie_within_3_periods_before_and_after(self):
        step, size = 1.0 / 64.0, 1 << 14
        response = np.abs(np.fft.irfft(np.abs(calc_band(np.fft.rfftfreq(size, step), 1.0)), size)) ** 2
        share = np.sum(response[1 : round(3.0 / step)]) / np.sum(response[1 : size // 2])
        self.assertAlmostEqual(share, 0.99, delta=1e-3)

    def test_the_boundary_is_the_standards_divided_by_3_15(self):
        centres = np.array(NOMINAL[3:])
        np.testing.assert_allclose(COMFORT * calc_comfort_boundary("8 h", centres), EIGHT_HOURS, rtol=0.016)
        for exposure, least in PROFICIENCY.items():
            found = calc_comfort_boundary(exposure, centres)
            self.assertAlmostEqual(np.min(found), least / 3.15)
            np.testing.assert_allclose(found / calc_comfort_boundary("8 h", centres), least / 0.315)


if __name__ == "__main__":
    unittest.main()
