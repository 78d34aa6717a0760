"""runs/ride_of_response.py: the ride from spectra is that of a time history with these spectra."""

import json
import unittest

import h5py
import numpy as np
from synthetic_results import write_group, write_series
from tool_test_case import ToolTestCase

from sprung_tools.runs.labelled_responses import open_responses
from sprung_tools.runs.ride_of_response import (
    calc_linear_assessment,
    calc_linear_bands,
    list_frequency_remarks,
    list_points,
)
from sprung_tools.signals.absorbed_power import calc_absorbed_power
from sprung_tools.signals.ride_weighting import WD, WE, WK, calc_weighting, weight_acceleration
from sprung_tools.signals.spectra import calc_rms
from sprung_tools.signals.third_octaves import BANDS, NOMINAL, calc_third_octaves

STEP = 1e-3
HIGHEST = 250.0  # Hz, far above what the weightings let through


def write_response(path, densities, lowest=0.02, highest=HIGHEST):
    """A response file with one point, whose accelerations have constant spectral densities {axis: density}."""
    frequency = np.geomspace(lowest, highest, 4000)
    with h5py.File(path, "w") as file:
        file.attrs.update({"format": np.bytes_("sprung-response"), "version": 1, "title": "synthetic", "speed": 10.0})
        write_series(file, "frequency", frequency, "Hz")
        for axis, density in densities.items():
            name = f"outputs/points/body.seat/acceleration.{axis}"
            write_series(file, f"{name}/response", np.zeros((frequency.size, 2)), "m/s^2/m")
            if density is not None:
                write_series(file, f"{name}/spectrum", np.full(frequency.size, density), "(m/s^2)^2/Hz")
            write_group(file, name, {"unit": np.bytes_("m/s^2"), "rms": 1.0})
    return str(path)


class RideOfResponse(ToolTestCase):
    def test_too_few_frequencies_are_remarked_on(self):
        """A spectrum with a peak had a power 46 % too large from 12 frequencies, without a word."""
        for number, is_said in ((12, True), (1000, False)):
            path = write_response(self.folder / f"{number}.h5", {"x": 0.01, "y": 0.02, "angle": 0.01})
            frequency = np.geomspace(0.1, 80.0, number)
            with h5py.File(path, "a") as file:
                del file["frequency"]
                write_series(file, "frequency", frequency, "Hz")
                for axis in ("x", "y", "angle"):
                    name = f"outputs/points/body.seat/acceleration.{axis}"
                    for one in ("response", "spectrum"):
                        del file[f"{name}/{one}"]
                    write_series(file, f"{name}/response", np.zeros((number, 2)), "m/s^2/m")
                    peak = 0.01 / ((1.0 - (frequency / 3.0) ** 2) ** 2 + 0.01)
                    write_series(file, f"{name}/spectrum", peak, "(m/s^2)^2/Hz")
            (response,) = open_responses([path])
            remarks = list_frequency_remarks(response, ["body.seat"])
            self.assertEqual(["are too few" in one for one in remarks], [True] if is_said else [])
            self.assertEqual("are too few" in self.run_tool("ride", path).stdout, is_said)

    def test_a_range_that_cuts_the_weightings_is_remarked_on(self):
        """The remark has what noise of the same density beyond the range would add."""
        density = 0.02
        for low, high, is_cut in ((0.1, 5.0, True), (2.0, 100.0, True), (0.2, 100.0, False)):
            path = write_response(self.folder / f"{low}.h5", {axis: density for axis in ("x", "y", "angle")}, low, high)
            (response,) = open_responses([path])
            remarks = [one for one in list_frequency_remarks(response, ["body.seat"]) if "cut off" in one]
            self.assertEqual(len(remarks), int(is_cut), (low, high))
            printed = self.run_tool("ride", path).stdout
            self.assertEqual("cut off the weightings" in printed, is_cut)
            if not is_cut:
                continue
            frequency = np.geomspace(0.4, 80.0, 20000)
            shares = []
            for weighting in (WD, WK, WE):
                passed = np.abs(calc_weighting(weighting, frequency)) ** 2
                inside = np.geomspace(low, high, 20000)
                within = np.trapz(np.abs(calc_weighting(weighting, inside)) ** 2, inside)
                beyond = np.trapz(passed * ((frequency < low) | (frequency > high)), frequency)
                shares.append(np.sqrt(1.0 + beyond / within) - 1.0)
            self.assertIn(f"would be {100.0 * max(shares):.3g} % larger", remarks[0])
            self.assertIn(f"frequencies from {low:g} to {high:g} Hz", remarks[0])

    def test_a_spectrum_that_has_fallen_at_its_end_is_not_remarked_on(self):
        """A spectrum that has fallen to little at its end cuts off little."""
        path = write_response(self.folder / "a.h5", {"x": 0.01, "y": 0.01, "angle": 0.01}, 0.1, 50.0)
        with h5py.File(path, "a") as file:
            for axis in ("x", "y", "angle"):
                spectrum = file[f"outputs/points/body.seat/acceleration.{axis}/spectrum"]
                spectrum[:] = 0.01 / (1.0 + file["frequency"][:] ** 4)
        (response,) = open_responses([path])
        self.assertEqual(list_frequency_remarks(response, ["body.seat"]), [])

    def test_it_is_that_of_noise_in_time_with_the_same_spectra(self):
        densities = {"x": 0.02, "y": 0.08, "angle": 0.01}
        (response,) = open_responses([write_response(self.folder / "a.h5", densities)])
        self.assertEqual(list_points(response), ["body.seat"])
        found = calc_linear_assessment(response, "body.seat")
        generator = np.random.default_rng(3)

        def make_noise(density):
            return generator.standard_normal(400000) * np.sqrt(density / (2.0 * STEP))

        for value, weighting, axis in (
            (found.fore_aft, WD, "x"), (found.vertical, WK, "y"), (found.pitch, WE, "angle"),
        ):  # fmt: skip
            expected = calc_rms(weight_acceleration(make_noise(densities[axis]), STEP, weighting))
            # 400 s of a band a few Hz wide: some 2000 independent values, 1.6 % of a standard deviation
            self.assertAlmostEqual(value / expected, 1.0, delta=0.05)
        power = np.mean(calc_absorbed_power(make_noise(densities["y"]), STEP))
        self.assertAlmostEqual(found.power / power, 1.0, delta=0.1)
        self.assertAlmostEqual(found.rms, np.sqrt(0.08 * (HIGHEST - 0.02)), places=6)
        self.assertAlmostEqual(
            found.total, np.sqrt(found.fore_aft**2 + found.vertical**2 + (0.4 * found.pitch) ** 2), places=12
        )

    def test_third_octave_bands_are_those_of_noise_in_time_and_of_the_filters_noise_bandwidth(self):
        # Closed form: ∫|H|² df = π/3 of the width of the band, for a Butterworth filter of sixth order.
        frequency = np.geomspace(0.02, HIGHEST, 4000)
        found = calc_linear_bands(frequency, np.full(frequency.size, 0.08))
        width = 10.0 ** (BANDS / 10.0) * (10.0**0.05 - 10.0**-0.05)
        np.testing.assert_allclose(np.square(found), 0.08 * np.pi / 3.0 * width, rtol=2e-3)
        noise = np.random.default_rng(5).standard_normal(400000) * np.sqrt(0.08 / (2.0 * STEP))
        # 400 s of a band of a width of 0.23 f: some 190 f independent values, 3.6/√f % of a standard deviation
        for value, expected, centre in zip(found, calc_third_octaves(noise, STEP), NOMINAL):
            self.assertAlmostEqual(value / expected, 1.0, delta=0.13 / np.sqrt(centre))

    def test_bands_outside_of_the_frequencies_or_with_few_of_them_are_unknown(self):
        def list_known(frequency):
            found = calc_linear_bands(frequency, np.ones(frequency.size))
            return [one for one, value in zip(NOMINAL, found) if value is not None]

        self.assertEqual(list_known(np.geomspace(0.1, 50.0, 1000)), [one for one in NOMINAL if one <= 40.0])
        self.assertEqual(list_known(np.geomspace(1.0, 100.0, 1000)), [one for one in NOMINAL if one >= 1.25])
        self.assertEqual(list_known(np.linspace(0.1, 100.0, 1000))[0], 4.0)  # 8 frequencies 0.1 Hz apart from 3.5 Hz
        self.assertEqual(list_known(np.geomspace(0.1, 100.0, 100)), [])

    def test_the_measures_have_the_bands(self):
        write_response(self.folder / "a.h5", {"x": 0.02, "y": 0.08, "angle": 0.01})
        (run,) = json.loads(self.run_tool("ride", "a.h5", "--json").stdout)["runs"]
        band = run["measures"]["bands/body.seat/8"]
        self.assertAlmostEqual(band["value"], np.sqrt(0.08 * np.pi / 3.0 * 7.943 * 0.2308), delta=2e-3)
        self.assertEqual(band["unit"], "m/s^2")

    def test_the_tool_repeats_what_the_program_warned_of(self):
        write_response(self.folder / "a.h5", {"x": 0.02, "y": 0.08, "angle": 0.01})
        with h5py.File(self.folder / "a.h5", "a") as file:
            for name, text in (("concerns", "response"), ("of", "front, rear"), ("text", "both are off the ground")):
                file[f"warnings/{name}"] = [text]
            file["remarks"] = ["the dampers have their mean slopes"]
        printed = self.run_tool("ride", "linear=a.h5").stdout
        self.assertIn("warning: linear: both are off the ground\n", printed)
        self.assertIn("remark: linear: the dampers have their mean slopes\n", printed)
        (run,) = json.loads(self.run_tool("ride", "a.h5", "--json").stdout)["runs"]
        self.assertEqual(run["warnings"], [{"concerns": "response", "of": ["front", "rear"],
                                            "text": "both are off the ground"}])  # fmt: skip
        self.assertEqual((run["remarks"], run["parameters"]), (["the dampers have their mean slopes"], {"speed": 10.0}))

    def test_the_tool_prints_it_and_refuses_what_is_not_there(self):
        write_response(self.folder / "a.h5", {"x": 0.02, "y": 0.08, "angle": 0.01})
        process = self.run_tool("ride", "linear=a.h5")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("linear: linear, on its random road, from 0.02 to 250 Hz", process.stdout)
        (row,) = [line.split() for line in process.stdout.splitlines() if line.startswith("body.seat")]
        self.assertEqual(row[1:3], ["linear", f"{np.sqrt(0.08 * (HIGHEST - 0.02)):.4g}"])
        for option, value in (("--from", "1"), ("--to", "2"), ("--superelements", ".")):
            fault = f"{option}: error: a.h5 is a response, and the option is of runs"
            self.assert_refuses(self.run_tool("ride", "linear=a.h5", option, value), fault)
        write_response(self.folder / "b.h5", {"x": None, "y": None, "angle": None})
        self.assert_refuses(self.run_tool("ride", "b.h5"), "b.h5: error: has no spectra")
        write_response(self.folder / "c.h5", {"y": 0.08})
        self.assert_refuses(self.run_tool("ride", "c.h5"), "c.h5: error: no output 'points/body.seat/acceleration.x'")


if __name__ == "__main__":
    unittest.main()
