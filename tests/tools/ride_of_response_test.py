"""runs/ride_of_response.py: the ride from spectra is that of a time history with these spectra."""

import unittest

import h5py
import numpy as np
from synthetic_results import write_group, write_series
from tool_test_case import ToolTestCase

from sprung_tools.runs.labelled_responses import open_responses
from sprung_tools.runs.ride_of_response import calc_linear_assessment, list_points
from sprung_tools.signals.absorbed_power import calc_absorbed_power
from sprung_tools.signals.ride_weighting import WD, WE, WK, weight_acceleration
from sprung_tools.signals.spectra import calc_rms

STEP = 1e-3
HIGHEST = 250.0  # Hz, far above what the weightings let through


def write_response(path, densities):
    """A response file with one point, whose accelerations have constant spectral densities {axis: density}."""
    frequency = np.geomspace(0.02, HIGHEST, 4000)
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
