"""signals/ride_weighting.py: ISO 2631-1's table, and that sampling does not bend the filter."""

import unittest

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path
from scipy.fft import next_fast_len

from sprung_tools.signals.ride_weighting import (
    LEFT,
    MEMORY,
    WD,
    WE,
    WK,
    calc_dose,
    calc_running_rms,
    calc_weighting,
    describe_fault,
    find_fast_size,
    weight_acceleration,
)
from sprung_tools.signals.spectra import calc_rms

STEP = 1e-3
# |Wk| by the formula at the exact third-octave centres 10^(n/10) Hz, n = -3 … 19
BY_FORMULA = (.419, .459, .477, .483, .485, .494, .531, .634, .807, .965, 1.039, 1.054, 1.037, .988, .899, .774, .637,
              .510, .403, .316, .245, .186, .134)  # fmt: skip
# ISO 2631-1:1997, table 3, principal weighting Wk × 1000 at the nominal centres 0.5 … 80 Hz
STANDARD = (418, 459, 477, 482, 484, 494, 531, 631, 804, 967, 1039, 1054, 1036, 988, 902, 768, 636, 513, 405, 314, 246,
            186, 132)  # fmt: skip
# The same table, principal weighting Wd × 1000. At 10 Hz it has 212 where its own formula gives 202; see the test.
STANDARD_WD = (853, 944, 992, 1011, 1008, 968, 890, 776, 642, 512, 409, 323, 253, 212, 161, 125, 100, 80.0, 63.2, 49.4,
               38.8, 29.5, 21.1)  # fmt: skip
# ISO 8041-1:2017, table B.4: We at the exact third-octave centres, as transcribed in the package phonometry by
# J. M. Requena-Plens (repository jmrplens/phonometry, tests/reference_data/vibration.py), who checked it against the
# table's column in dB
STANDARD_WE = (.8635, .9389, .9423, .8798, .7683, .6372, .5127, .4070, .3218, .2543, .2012, .1594, .1263, .1002, .07954,
               .06314, .05011, .03975, .03147, .02481, .01935, .01473, .01065)  # fmt: skip
# ISO 8041:2005, the weighting factors at the reference frequency of 100 rad/s
AT_REFERENCE = {WK: 0.7718, WD: 0.1261, WE: 0.06287}


class Weighting(unittest.TestCase):
    def test_the_formula_gives_its_known_values(self):
        frequency = 10.0 ** (np.arange(-3, 20) / 10.0)
        np.testing.assert_allclose(np.abs(calc_weighting(WK, frequency)), BY_FORMULA, atol=1.01e-3)

    def test_the_formula_is_within_the_rounding_of_the_standards_table(self):
        frequency = 10.0 ** (np.arange(-3, 20) / 10.0)
        np.testing.assert_allclose(1e3 * np.abs(calc_weighting(WK, frequency)), STANDARD, rtol=0.015)

    def test_the_weighting_fore_and_aft_is_within_the_rounding_of_the_standards_table(self):
        number = np.arange(-3, 20)
        found = 1e3 * np.abs(calc_weighting(WD, 10.0 ** (number / 10.0)))
        regular = number != 10  # 10 Hz: the table's neighbours, 253 and 161, have 202 between them in proportion
        np.testing.assert_allclose(found[regular], np.array(STANDARD_WD)[regular], rtol=0.015)
        self.assertAlmostEqual(found[13], np.sqrt(STANDARD_WD[12] * STANDARD_WD[14]), delta=1.0)

    def test_the_weighting_of_rotation_has_the_four_digits_of_the_standards_table(self):
        found = np.abs(calc_weighting(WE, 10.0 ** (np.arange(-3, 20) / 10.0)))
        last_digit = 10.0 ** (np.floor(np.log10(STANDARD_WE)) - 3.0)
        self.assertLess(np.max(np.abs(found - STANDARD_WE) / last_digit), 0.51)

    def test_all_weightings_have_their_factors_at_the_reference_frequency(self):
        for weighting, factor in AT_REFERENCE.items():
            with self.subTest(weighting.name):
                found = abs(calc_weighting(weighting, np.array([100.0 / (2.0 * np.pi)]))[0])
                self.assertAlmostEqual(found / factor, 1.0, delta=5e-5 / factor)  # the last digit

    def test_the_running_rms_is_that_of_the_second_before(self):
        time = np.arange(0.0, 4.0 + 0.5 * STEP, STEP)
        signal = np.where(time < 2.0, 3.0, 0.0)
        running = calc_running_rms(signal, STEP)
        # √(9 · share of the last second that is filled)
        for at, share in ((0.25, 0.25), (1.0, 1.0), (1.9, 1.0), (2.5, 0.5), (3.5, 0.0)):
            self.assertAlmostEqual(running[round(at / STEP)], 3.0 * np.sqrt(share), delta=2e-3)

    def test_sampled_sines_are_weighted_as_the_formula_says_up_to_80_hz(self):
        for step in (1e-3, 2.5e-3):
            time = np.arange(0.0, 30.0, step)
            settled = time >= 10.0
            for frequency in (0.5, 2.0, 6.3, 20.0, 63.0, 80.0):
                with self.subTest(step=step, frequency=frequency):
                    weighted = weight_acceleration(1.7 * np.sin(2 * np.pi * frequency * time), step)[settled]
                    expected = 1.7 * abs(calc_weighting(WK, frequency)) / np.sqrt(2.0)
                    self.assertAlmostEqual(calc_rms(weighted) / expected, 1.0, delta=2e-3)

    def test_the_filter_looks_only_back(self):
        signal = np.zeros(20000)
        signal[12000] = 1.0
        weighted = weight_acceleration(signal, STEP)
        # Samples of a band-limited pulse ring a little both ways; a filter that ran round the end would leave far more.
        self.assertLess(np.max(np.abs(weighted[:11000])), 1e-4 * np.max(np.abs(weighted)))

    def test_a_thousandth_of_the_largest_response_to_a_pulse_is_left_after_the_memory(self):
        for weighting in (WK, WD, WE):
            with self.subTest(weighting.name):
                response = np.abs(weight_acceleration(np.eye(1, 10000)[0], STEP, weighting))
                self.assertLess(np.max(response[round(MEMORY / STEP) :]), LEFT * np.max(response))

    def test_a_transform_has_the_next_size_without_large_prime_factors(self):
        sizes = [*range(1, 400), 25001, 10**6 + 3]
        self.assertEqual([find_fast_size(one) for one in sizes], [next_fast_len(one, real=True) for one in sizes])

    def test_samples_at_the_limit_are_enough_whatever_their_rounding(self):
        self.assertEqual(describe_fault(0.003125 * (1.0 + 1e-12)), "")
        self.assertIn("a sample every 3.126 ms is too few", describe_fault(0.003126))

    def test_too_few_samples_are_refused(self):
        with self.assertRaisesRegex(ValueError, "a sample every 5 ms is too few"):
            weight_acceleration(np.zeros(100), 5e-3)

    def test_the_dose_of_a_sine_is_that_of_the_integral(self):
        # ∫ a⁴ sin⁴ dt = 3/8 a⁴ T over whole periods, and it is not divided by T.
        for duration in (4.0, 8.0):
            time = np.arange(0.0, duration + 0.5 * STEP, STEP)
            dose = calc_dose(2.0 * np.sin(2 * np.pi * 5.0 * time), STEP)
            self.assertAlmostEqual(dose, 2.0 * (0.375 * duration) ** 0.25, places=9)


if __name__ == "__main__":
    unittest.main()
