#!/usr/bin/python3
"""What modes that a run leaves out would do together, and when it warns of them."""

import os
import unittest
from pathlib import Path

import h5py
import numpy as np

from section_test import CANTILEVER
from verification_case import ROOT, VerificationCase, run_program

TRUCK_RUNS = ROOT / "dynamics/models/truck"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]
ARMS = ["--set", 'modes.front_long_arm="all"', "--set", 'modes.rear_long_arm="all"']


class LeftOut(VerificationCase):
    """Modes left out are judged by what they would do together."""

    def calc_rms(self, vectors):
        return np.sqrt(np.mean(np.sum(vectors**2, axis=1)))

    def test_their_sum_is_the_acceleration_that_is_missing(self):
        # The force has 40 Hz, the third mode 49 Hz. Trapezoids over steps of 0.3 ms: 2 %.
        vehicle = CANTILEVER.format(wall="origin", held="left", loaded="right").replace(
            "force = [0.0, -10.0]", "force = [0.0, { harmonic = { amplitude = 10.0, frequency = 40.0 } }]"
        ).replace('name = "cantilever"', 'name = "cantilever"\nmonitor = ["beam.right"]')
        run = "duration = 0.5\noutput_step = 2e-4\n[integrator]\nlargest_step = 3e-4\n[modes]\nbeam = {modes}\n"
        for modes in (1, 3):
            full = self.run_text(vehicle, run.format(modes=20))["points/beam.right/acceleration"]
            results = self.run_text(vehicle, run.format(modes=modes))
            missing = full - results["points/beam.right/acceleration"]
            found = results.summary["modes"]["left_out_together"]
            self.assertEqual((found["point"], found["axis"]), ("beam.right", "y"))
            expected = self.calc_rms(missing) / self.calc_rms(full - missing)
            self.assert_close(found["of_rms_acceleration"], expected, relative=0.02)

    def test_what_is_told_of_a_truck_is_what_all_modes_of_its_chassis_and_arms_add(self):
        # Where the modes left out act on each other and on stiff active ones, and shift the frequencies of the vehicle.
        for run, arguments in (
            ("bump.toml", ["--set", "modes.chassis=36"]),
            ("bump.toml", ["--set", "modes.chassis=4", *ARMS]),
            ("terrain.toml", ["--set", "modes.chassis=2"]),
            ("terrain.toml", ["--set", "modes.chassis=16"]),
        ):
            with self.subTest(run=run, arguments=arguments):
                path, options = TRUCK_RUNS / run, {"superelements": TRUCK_SUPERELEMENTS}
                results = self.run_to_results(path, *arguments, **options)
                found = results.summary["modes"]["left_out_together"]
                history = f"points/{found['point']}/acceleration"
                with_few = results[history]
                right = self.run_to_results(path, "--set", "modes.chassis=36", *ARMS, **options)[history]
                true = self.calc_rms(right - with_few) / self.calc_rms(with_few)
                self.assert_close(found["of_rms_acceleration"], true, relative=0.2)

    def test_a_stiff_mode_of_an_arm_is_told_beside_all_modes_of_the_chassis(self):
        # Between its pins the arm bends under its own inertia: its first mode, η as in a run with all modes.
        run, options = TRUCK_RUNS / "bump.toml", {"superelements": TRUCK_SUPERELEMENTS}
        with_arms = self.run_to_results(run, "--set", "modes.chassis=36", *ARMS, **options)
        with h5py.File(Path(TRUCK_SUPERELEMENTS) / "long_arm.h5") as arm:
            reach = np.abs(arm["modes/shape"][:, :2, 0]).max()
        amplitude = np.abs(with_arms["bodies/front_long_arm/modal/amplitude"][:, 0]).max()
        found = self.run_to_results(run, "--set", "modes.chassis=36", **options).summary
        largest = found["modes"]["largest_left_out"]["of_deflection"]
        self.assertEqual(largest["mode"], "front_long_arm.mode 1")
        self.assert_close(largest["share"] * self.find_largest_deflection(with_arms), reach * amplitude, relative=0.1)
        self.assertIn("modes are missing: front_long_arm.mode 1, which", found["warnings"][0]["text"])

    def compare_beam(self, vehicle, run, modes, relative, all_modes=20):
        """What a beam's run with few modes is told, beside the difference to one with all, at that point."""
        full = self.run_text(vehicle, run.format(modes=all_modes))
        results = self.run_text(vehicle, run.format(modes=modes))
        found = results.summary["modes"]["left_out_together"]
        span = (results.time >= results.summary["parameters"]["statistics"][0])
        right, with_few = (one[f"points/{found['point']}/acceleration"][span] for one in (full, results))
        true = self.calc_rms(right - with_few) / self.calc_rms(with_few)
        self.assert_close(found["of_rms_acceleration"], true, relative=relative)
        return found, results.summary

    def clamp(self, force, more=""):
        """A beam that is clamped at its left end, with a force on its right one."""
        vehicle = CANTILEVER.format(wall="origin", held="left", loaded="right")
        monitored = 'name = "cantilever"\nmonitor = ["beam.right"]'
        vehicle = vehicle.replace("force = [0.0, -10.0]", f"force = {force}")
        return vehicle.replace('name = "cantilever"', monitored) + more

    def test_a_start_out_of_balance_is_told(self):
        # The force is there at once, or the beam is hit: with all modes it rings from the first instant on.
        steps = "output_step = 2e-4\n[integrator]\nlargest_step = 2e-4\n[modes]\nbeam = {modes}\n"
        sudden = 'duration = 0.3\nstart = "as-given"\n' + steps
        hit = "duration = 0.3\n" + steps + "[initial.beam]\nvelocity = [0.0, 1.0]\n"
        for vehicle, run in ((self.clamp("[0.0, -10.0]"), sudden), (self.clamp("[0.0, 0.0]"), hit)):
            _, summary = self.compare_beam(vehicle, run, 2, relative=0.2)
            self.assertTrue(any("modes are missing" in one["text"] for one in summary["warnings"]))

    def test_dampers_far_above_critical_and_small_forces_are_told(self):
        # In a linear system the share does not depend on the size of the force.
        run = "duration = 0.3\noutput_step = 2e-4\n[integrator]\nlargest_step = 2e-4\n[modes]\nbeam = {modes}\n"
        damper = """
[[forces]]
name = "damper"
type = "bushing"
a = "ground.origin"
b = "beam.right"
y = { damper = { coefficient = 1e4 } }
"""
        for size in (1000.0, 0.01):
            force = f"[0.0, {{ harmonic = {{ amplitude = {size}, frequency = 40.0 }} }}]"
            found, _ = self.compare_beam(self.clamp(force, damper), run, 2, relative=0.05)
            self.assertGreater(found["of_rms_acceleration"], 0.02)

    def test_the_share_is_that_of_the_span_of_the_statistics(self):
        # A slow motion that the first mode has goes before a fast one that it has not.
        first = "{ harmonic = { amplitude = 100.0, frequency = 1.0 } }"
        force = f"[0.0, {{ product = [{first}, {{ table = [[0.0, 1.0], [0.5, 1.0], [0.6, 0.0]] }}] }}]"
        fast = """
[[forces]]
name = "fast"
type = "applied"
point = "beam.right"
force = [0.0, { product = [{ harmonic = { amplitude = 1.0, frequency = 40.0 } },
                           { table = [[0.0, 0.0], [0.7, 0.0], [0.8, 1.0]] }] }]
"""
        run = "duration = 1.2\noutput_step = 2e-4\nstatistics = {{ from = 1.0 }}\n[integrator]\nlargest_step = 2e-4\n"
        self.compare_beam(self.clamp(force, fast), run + "[modes]\nbeam = {modes}\n", 1, relative=0.05)

    def find_largest_deflection(self, results):
        """Of any named point of the chassis [m]."""
        with h5py.File(Path(TRUCK_SUPERELEMENTS) / "chassis.h5") as chassis:
            shapes = chassis["modes/shape"][:, :2, :36]
        deflections = np.einsum("pdk,tk->tpd", shapes, results["bodies/chassis/modal/amplitude"])
        return np.linalg.norm(deflections, axis=2).max()

    def test_a_semitrailer_whose_seat_is_right_to_four_digits_does_not_warn(self):
        # 17 of the 20 modes of the tractor's frame, all 20 of the trailer's. One of those left out would reach more
        # than a twentieth of a largest acceleration, for an instant.
        for name in ("tractor_frame", "trailer_frame"):
            design = (ROOT / f"meshes/templates/{name}.toml").read_text(encoding="utf-8")
            begin, end = design.index("[reduction]"), design.index("[modes]")
            design = design[:begin] + design[end:].replace("[modes]", "[modes]\ncount = 20")
            (self.folder / f"{name}.toml").write_text(design, encoding="utf-8")
            build = [os.environ["SPRUNG_REDUCE"], "build", f"{name}.toml", "--output-dir", "."]
            run_program(build, cwd=self.folder, check=True)
        road = ["--iso-class", "C", "--length", "500", "--spacing", "0.05", "--ease", "5", "--seed", "7"]
        run_program([ROOT / "tools/make_road.py", "-o", self.folder / "road.txt", *road], check=True)
        run = f"""
            vehicle = "{ROOT}/dynamics/models/templates/semitrailer.toml"
            speed = 16.7
            duration = 30.0
            output_step = 0.005
            [modes]
            tractor_frame = 17
            trailer_frame = 20
            [road]
            shape = "table"
            file = "road.txt"
            start = 3.0
        """
        (self.folder / "run.toml").write_text(run, encoding="utf-8")
        seat, wheel = [], []
        for modes in (20, 17):
            results = self.run_to_results(
                self.folder / "run.toml", "--set", f"modes.tractor_frame={modes}", superelements=self.folder
            )
            seat.append(results.summary["points"]["driver.seat"]["acceleration"]["rms"])
            wheel.append(results["points/tractor_frame.fifth_wheel/acceleration"])
        self.assert_close(seat[1], seat[0], relative=5e-4)
        found = results.summary["modes"]
        self.assertEqual(results.summary["warnings"], [])
        self.assertGreater(found["largest_left_out"]["of_acceleration"]["share"], 0.05)
        self.assertEqual(found["left_out_together"]["point"], "tractor_frame.fifth_wheel")
        true = self.calc_rms(wheel[0] - wheel[1]) / self.calc_rms(wheel[1])
        self.assert_close(found["left_out_together"]["of_rms_acceleration"], true, relative=0.3)


if __name__ == "__main__":
    unittest.main()
