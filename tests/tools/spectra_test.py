"""signals/spectra.py on signals of known spectrum."""

import unittest

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.signals.spectra import (
    calc_amplitude_spectrum,
    calc_band_rms,
    calc_power_spectrum,
    calc_rms,
    calc_whole_spectrum,
    count_upward_crossings,
    find_dominant_frequency,
)

STEP = 1e-3
TIME = STEP * np.arange(11501)


def noise(seed, size):
    return np.random.default_rng(seed).standard_normal(size)


class Spectra(unittest.TestCase):
    def test_squares_of_the_bands_add_up_to_the_mean_square(self):
        for size in (11501, 11500):
            values = noise(1, size) + 3.0
            bands = calc_band_rms(values, STEP, (4.0, 8.0, 16.0))
            self.assertEqual(bands.size, 4)
            self.assertAlmostEqual(np.sum(bands**2) / np.mean(values**2), 1.0, places=12)

    def test_each_sine_is_in_its_band(self):
        sines = [
            a * np.sin(2 * np.pi * f * TIME + p)
            for a, f, p in ((2, 2.1, 0.3), (1, 6.2, 1), (3, 11, 2), (1, 40, 0))
        ]
        bands = calc_band_rms(sum(sines), STEP, (4.0, 8.0, 16.0))
        # Leakage of sines that do not fit the length is of the order of 1/(number of periods).
        np.testing.assert_allclose(bands, np.array([2, 1, 3, 1]) / np.sqrt(2.0), rtol=0.02)

    def test_a_step_between_the_ends_does_not_leak_into_the_highest_band(self):
        ramp = np.linspace(-5.0, 5.0, TIME.size)
        bands = calc_band_rms(ramp, STEP, (4.0, 8.0, 16.0))
        # Cosine series of a ramp: terms fall with 1/k². A periodic continuation would leave 0.08 here.
        self.assertLess(bands[3], 1e-3)

    def test_an_amplitude_spectrum_shows_amplitudes_and_the_mean(self):
        time = STEP * np.arange(5000)
        frequency, amplitude = calc_amplitude_spectrum(0.7 + 2.5 * np.cos(2 * np.pi * 9.6 * time + 1.0), STEP)
        top = int(np.argmax(amplitude))
        self.assertAlmostEqual(frequency[top], 9.6, places=12)
        self.assertAlmostEqual(amplitude[top], 2.5, places=10)
        self.assertAlmostEqual(amplitude[0], 0.7, places=10)

    def test_a_power_spectrum_integrates_to_the_variance(self):
        values = noise(2, 40000)
        frequency, density = calc_power_spectrum(values, STEP, 1.0)
        self.assertAlmostEqual(np.sum(density) * frequency[1] / np.var(values), 1.0, delta=0.02)
        # White: 2 σ² Δt everywhere
        self.assertAlmostEqual(np.mean(density[50:450]) / (2.0 * STEP), 1.0, delta=0.03)

    def test_a_whole_spectrum_has_the_mean_square_of_the_signal_wherever_its_power_lies(self):
        def check(values, duration):
            frequency, density = calc_whole_spectrum(values, STEP, duration)
            self.assertAlmostEqual(np.sqrt(np.sum(density) * frequency[1]) / calc_rms(values), 1.0, places=12)

        for size in (9, 2001, 11501, 11998):
            check(noise(3, size), 4.0)
        for at in (0, 300, 5750, 11500):  # a bump at the begin, near it, in the middle, at the end
            check(np.exp(-(((np.arange(11501) - at) / 20.0) ** 2)), 4.0)
        # White: 2 σ² Δt everywhere
        _, density = calc_whole_spectrum(noise(2, 40000), STEP, 1.0)
        self.assertAlmostEqual(np.mean(density[50:450]) / (2.0 * STEP), 1.0, delta=0.03)

    def test_segments_longer_than_the_signal_are_refused(self):
        with self.assertRaisesRegex(ValueError, "segments of 12000 samples do not fit a signal of 11501"):
            calc_power_spectrum(TIME, STEP, 12.0)

    def test_the_dominant_frequency_is_found_between_the_spectrums_lines(self):
        values = 3.0 * np.sin(2 * np.pi * 9.57 * TIME) + np.sin(2 * np.pi * 1.95 * TIME) + 5.0
        self.assertAlmostEqual(find_dominant_frequency(values, STEP, 4.0), 9.57, delta=0.02)

    def test_upward_crossings_of_the_mean_are_counted(self):
        values = 4.0 + np.cos(2 * np.pi * 2.0 * TIME)  # 23 periods in 11.5 s; begins and ends at its top
        self.assertEqual(count_upward_crossings(values), 23)
        self.assertAlmostEqual(calc_rms(np.array([3.0, -4.0])), np.sqrt(12.5), places=15)


if __name__ == "__main__":
    unittest.main()
