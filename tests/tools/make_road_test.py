"""tools/make_road.py and signals/road_profile.py: that a profile is what its recipe says, also the truck's own."""

import os
import shlex
import unittest
from pathlib import Path

import numpy as np
from tool_test_case import ROOT, ToolTestCase

from sprung_tools.signals import road_profile
from sprung_tools.signals.road_profile import (
    Recipe,
    calc_iso_density,
    calc_waves,
    estimate_octaves,
    fit_exponent,
    make_profile,
)

TERRAIN = ROOT / "dynamics/models/truck/terrain_road.txt"
RECIPE = Recipe(length=91.44, spacing=0.0508, band=(0.0545, 3.33), rms=0.0264, ease=3.0, seed=1)


def calc_amplitudes(profile):
    """Amplitude of k waves in the length, k = 0 …, of a profile without easing: periodic, its last point left out."""
    height = profile.height[:-1]
    return 2.0 * np.abs(np.fft.rfft(height)) / height.size


class Profiles(unittest.TestCase):
    def test_amplitudes_follow_the_spectrum_within_the_band_and_vanish_outside(self):
        for exponent in (2.0, 3.1):
            with self.subTest(exponent):
                profile = make_profile(RECIPE._replace(ease=0.0, exponent=exponent))
                amplitudes = calc_amplitudes(profile)
                waves = np.arange(5, 305)  # 0.0545 · 91.44 = 4.98 and 3.33 · 91.44 = 304.5
                # a_k = √(2 G Δn), so a_k ∝ k^(−w/2)
                law = amplitudes[5] * (waves / 5.0) ** (-0.5 * exponent)
                np.testing.assert_allclose(amplitudes[waves], law, rtol=1e-9)
                outside = np.delete(amplitudes, waves)[1:]  # without the mean
                self.assertLess(outside.max(), 1e-9 * amplitudes[5])

    def test_the_rms_over_all_points_is_the_one_asked_for(self):
        for ease in (3.0, 20.0):
            height = make_profile(RECIPE._replace(ease=ease)).height
            self.assertAlmostEqual(np.sqrt(np.mean(height**2)), 0.0264, places=15)

    def test_without_easing_the_rms_is_about_the_mean_and_that_of_the_spectrum(self):
        # Over a period each cosine has the mean square G(n) Δn and no mean; the offset at the start is no roughness.
        for seed in range(1, 6):
            profile = make_profile(RECIPE._replace(ease=0.0, seed=seed))
            self.assertAlmostEqual(np.std(profile.height), 0.0264, places=15)
            # The last of the 1801 points is that of a period again: h²/σ²/3602 of the r.m.s., with |h| < 3σ.
            law = (profile.waves / 91.44 / 0.1) ** -2.0 / 91.44
            self.assertAlmostEqual(np.sqrt(profile.density * np.sum(law)) / 0.0264, 1.0, delta=9.0 / 3602.0)

    def test_a_profile_begins_at_height_0_and_an_eased_one_ends_there_level(self):
        self.assertEqual(make_profile(RECIPE._replace(ease=0.0)).height[0], 0.0)
        profile = make_profile(RECIPE)
        self.assertEqual((profile.height[0], profile.height[-1]), (0.0, 0.0))
        # Raised cosine: the first step is (π h/3)²/4 = 7.1e-4 of what the profile has there.
        self.assertLess(abs(profile.height[1]), 7.1e-4 * 0.2)

    def test_easing_changes_the_middle_by_a_factor_only(self):
        eased, whole = (make_profile(RECIPE._replace(ease=ease)) for ease in (3.0, 1e-9))
        middle = slice(60, -60)  # 60 · 0.0508 m > 3 m
        ratio = np.sqrt(eased.density / whole.density)
        np.testing.assert_allclose(eased.height[middle], ratio * whole.height[middle], rtol=0, atol=1e-12)
        self.assertGreater(ratio, 1.0)

    def test_an_iso_class_has_the_variance_of_its_spectrum(self):
        # Over whole periods each cosine has the mean square a²/2 = G(n) Δn.
        recipe = Recipe(length=200.0, spacing=0.1, band=(0.011, 2.83), density=calc_iso_density("C"), seed=4)
        height = make_profile(recipe).height[:-1]
        n = np.arange(3, 567) / 200.0
        self.assertAlmostEqual(np.var(height) / np.sum(256e-6 * (n / 0.1) ** -2 / 200.0), 1.0, places=9)

    def test_iso_classes_are_those_of_the_standards_table(self):
        # Geometric means, 1e-6 m³: ISO 8608, table C.1
        table = {"A": 16, "B": 64, "C": 256, "D": 1024, "E": 4096, "F": 16384, "G": 65536, "H": 262144}
        for name, value in table.items():
            self.assertAlmostEqual(calc_iso_density(name), 1e-6 * value, places=15)

    def test_the_seed_alone_tells_profiles_apart(self):
        first, again, other = (make_profile(RECIPE._replace(seed=seed)).height for seed in (5, 5, 6))
        np.testing.assert_array_equal(first, again)
        self.assertLess(abs(np.corrcoef(first, other)[0, 1]), 0.5)

    def test_the_spectrum_found_is_the_wanted_one_without_easing_and_near_it_with(self):
        for ease, tolerance in ((0.0, 1e-9), (3.0, 0.1)):
            recipe = RECIPE._replace(ease=ease)
            profile = make_profile(recipe)
            octaves = estimate_octaves(profile.distance, profile.height, recipe, profile.density)
            self.assertEqual(len(octaves), 6)
            for octave in octaves:
                self.assertAlmostEqual(octave.found / octave.wanted, 1.0, delta=tolerance)
            self.assertAlmostEqual(fit_exponent(octaves, 2.0), 2.0, delta=0.3 * tolerance)

    def test_a_steeper_spectrum_is_found_to_be_steeper(self):
        profile = make_profile(RECIPE._replace(ease=0.0, exponent=2.5))
        octaves = estimate_octaves(
            profile.distance, profile.height, RECIPE._replace(ease=0.0), profile.density
        )
        self.assertAlmostEqual(fit_exponent(octaves, 2.0), 2.5, delta=0.02)

    def test_the_waves_of_a_band_are_those_within_it(self):
        self.assertEqual(list(calc_waves(RECIPE._replace(band=(2 / 91.44, 4 / 91.44)))), [2, 3, 4])
        self.assertEqual(list(calc_waves(RECIPE._replace(band=(2.1 / 91.44, 3.9 / 91.44)))), [3])

    def test_a_band_from_nearly_0_begins_with_one_wave_in_the_length(self):
        recipe = RECIPE._replace(band=(1e-13, 4 / 91.44))
        self.assertEqual(list(calc_waves(recipe)), [1, 2, 3, 4])
        self.assertTrue(np.all(np.isfinite(make_profile(recipe).height)))


class TruckTerrain(ToolTestCase):
    def test_the_terrain_is_made_again_byte_for_byte_by_the_command_in_its_header(self):
        text = TERRAIN.read_text(encoding="utf-8")
        command = shlex.split(text.splitlines()[0].partition("made by: ")[2])
        self.assertEqual(command[0], "tools/make_road.py")
        process = self.run_tool("make_road.py", *command[1:], "-o", "again.txt")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual((self.folder / "again.txt").read_text(encoding="utf-8"), text)

    def test_the_terrain_has_the_length_and_rms_that_the_paper_prints(self):
        table = np.loadtxt(TERRAIN)
        self.assertEqual(table.shape, (1801, 2))
        self.assertAlmostEqual(table[-1, 0], 91.44, places=12)
        np.testing.assert_allclose(np.diff(table[:, 0]), 0.0508, atol=1e-12)
        self.assertAlmostEqual(np.sqrt(np.mean(table[:, 1] ** 2)), 0.0264, places=8)


class Tool(ToolTestCase):
    arguments = (
        "--length",
        "40",
        "--spacing",
        "0.05",
        "--band",
        "0.05",
        "2",
        "--ease",
        "2",
        "-o",
        "road.txt",
    )

    def test_it_prints_the_rms_and_the_spectrum_of_the_file_it_wrote(self):
        # Without easing the profile is its cosines and nothing else, to the nanometre that is written.
        process = self.run_tool("make_road.py", *self.arguments, "--rms", "0.01", "--ease", "0")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("road.txt: 801 points, r.m.s. 0.010000 m", process.stdout)
        rows = [line.split() for line in process.stdout.splitlines()[3:-1]]
        self.assertEqual(rows[0][0], "0.0500")
        self.assertEqual(rows[-1][1], "2.0000")
        for row in rows:
            self.assertAlmostEqual(float(row[3]) / float(row[2]), 1.0, delta=1e-3)
            self.assertEqual(row[4], "1.000")
        self.assertIn("exponent wanted 2, found 2.000", process.stdout)
        self.assertEqual(os.listdir(self.folder), ["road.txt"])

    def test_an_iso_class_is_not_scaled(self):
        process = self.run_tool("make_road.py", *self.arguments, "--iso-class", "E")
        self.assertEqual(process.returncode, 0, process.stderr)
        header = (self.folder / "road.txt").read_text(encoding="utf-8").splitlines()[:6]
        self.assertTrue(all(line.startswith("# ") for line in header))
        self.assertIn("not scaled", header[1])
        self.assertIn("0.004096 m^3", header[3])

    def test_the_header_does_not_hold_the_files_name_however_it_was_given(self):
        headers = []
        for name in (("-o", "road.txt"), ("-oroad.txt",), ("--output", "road.txt"), ("--output=road.txt",)):
            self.run_tool("make_road.py", *self.arguments[:-2], "--rms", "0.01", *name)
            headers.append((self.folder / "road.txt").read_text(encoding="utf-8").splitlines()[0])
            (self.folder / "road.txt").unlink()
        self.assertNotIn("road.txt", headers[0].partition("make_road.py")[2])
        self.assertEqual(len(set(headers)), 1)

    def test_too_coarse_points_get_a_note(self):
        process = self.run_tool("make_road.py", *self.arguments, "--band", "0.05", "9", "--rms", "0.01")
        self.assertIn("remark: only 2.22 points on the shortest wave", process.stdout)

    def test_recipes_that_make_no_profile_are_refused(self):
        for changed, complaint in (
            (("--spacing", "0.07"), "--spacing 0.07 m must divide --length 40 m"),
            (("--length", "-1"), "--length must be positive"),
            (("--length", "inf"), "--length must be positive and finite"),
            (("--spacing", "1e-9"), "makes 4e+10 points, more than 1e+07"),
            (("--band", "2", "1"), "two ascending positive wavenumbers"),
            (("--band", "0.5", "11"), "points every 0.05 m cannot show"),
            (("--band", "0.051", "0.052"), "holds no multiple of 1/40 m"),
            (("--ease", "20"), "--ease must be at least 0 and below half of the length"),
            (("--rms", "0"), "--rms must be positive"),
            (("--rms", "inf"), "--rms must be positive and finite"),
            (("--rms", "1e-12"), "m, expected 1e-06 to 1e+06 m; change --rms"),
            (("--rms", "1e200"), "the heights reach "),
            (("--exponent", "400"), "--exponent 400 makes a spectrum beyond the range of numbers"),
            (("--exponent", "-4000"), "--exponent -4000 makes a spectrum beyond the range of numbers"),
            (("--exponent", "nan"), "--exponent must be a finite number"),
            (("--seed", "-1"), "--seed must be at least 0, got -1"),
            (("-o", "none/road.txt"), "none/road.txt: error: cannot write the file"),
        ):
            with self.subTest(changed):
                arguments = (*self.arguments, "--rms", "0.01", *changed)
                self.assert_refuses(self.run_tool("make_road.py", *arguments), complaint)
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_file_that_is_no_profile_is_refused(self):
        for text, complaint in (
            ("0 0\n1 x\n", "not a table of distances and heights"),
            ("0 0\n1 0\n", "expected 3 rows or more"),
            ("0 0\n1 0\n3 0\n", "the distances are not equally spaced"),
        ):
            path = Path(self.folder, "bad.txt")
            path.write_text(text, encoding="utf-8")
            with self.assertRaisesRegex(road_profile.InputError, complaint):
                road_profile.read_profile(path)


if __name__ == "__main__":
    unittest.main()
