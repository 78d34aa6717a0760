#!/usr/bin/python3
"""Runs that start with the last state of a results file."""

import json
import unittest

import h5py
import numpy as np

from dynamics_test_case import DynamicsTestCase

TIGHT = ("--quiet", "--set", "integrator.relative_tolerance=1e-9")
KICK = """
[[forces]]
name = "kick"
type = "applied"
point = "chassis.origin"
force = [0.0, { table = [[0.3, 0.0], [0.3, 40000.0]] }]
"""
FROM_FIRST = ("--set", 'continue_from="first.h5"')

SLIDER = """
name = "slider"
[ground.points]
rail = [0.0, 0.0]
anchor = [0.0, -1.0]
[bodies.m]
mass = 100.0
inertia = 1.0
position = [0.0, 0.0]
[[joints]]
name = "slide"
type = "translational"
a = "ground.rail"
b = "m.origin"
axis = [0.0, 1.0]
"""
LEAF = """
[[forces]]
name = "leaf"
type = "leaf-spring"
a = "m.origin"
b = "ground.anchor"
free_length = 1.0
spring = { polynomial = [0.0, 2e4] }
friction = { coefficient = 500.0 }
presliding_deflection = 0.002
"""
MOUNT = """
[[forces]]
name = "mount"
type = "bushing"
a = "ground.rail"
b = "m.origin"
y = { spring = { polynomial = [0.0, 1e3] }, relaxation = { stiffness = 3e4, time = 1.0 } }
"""
PUSH = """
[[forces]]
name = "push"
type = "applied"
point = "m.origin"
force = [0.0, { table = [[0.1, 0.0], [0.2, -900.0], [0.6, -900.0], [1.2, 0.0]] }]
"""


class Continue(DynamicsTestCase):
    def run_until(self, duration, name, *arguments):
        return self.run_program(*TIGHT, "--set", f"duration={duration}", *arguments, "-o", name)

    def make_first(self):
        """The truck up to 0.5 s, when its front wheels have just passed the bump."""
        process = self.run_until(0.5, "first.h5")
        self.assertEqual(process.returncode, 0, process.stderr)

    def test_the_partial_file_of_the_same_name_is_not_continued(self):
        self.make_first()
        partial = self.folder / "second.partial.h5"
        (self.folder / "first.h5").rename(partial)
        before = partial.read_bytes()
        process = self.run_until(0.8, "second.h5", "--set", 'continue_from="second.partial.h5"')
        self.assertEqual(process.returncode, 2)
        self.assertIn("is also the name of the results, or of their partial file", process.stderr)
        self.assertEqual(partial.read_bytes(), before)

    def test_results_are_not_called_as_partial_ones_are(self):
        for name in ("x.partial", "x.partial.h5"):
            process = self.run_until(0.1, name)
            self.assertEqual(process.returncode, 2)
            self.assertIn("is a name of results that are not complete", process.stderr)

    def test_a_continued_run_agrees_with_one_long_run(self):
        self.make_first()
        for name, arguments in (("long.h5", ()), ("second.h5", FROM_FIRST)):
            process = self.run_until(0.8, name, *arguments)
            self.assertEqual(process.returncode, 0, process.stderr)
        with h5py.File(self.folder / "long.h5") as whole, h5py.File(self.folder / "second.h5") as second:
            np.testing.assert_allclose(second["time"][()], whole["time"][500:], rtol=0, atol=1e-12)
            self.assertEqual(len(second["time"]), 301)
            for name in ("bodies/chassis/position", "bodies/chassis/velocity", "bodies/chassis/modal/amplitude",
                         "bodies/chassis/acceleration", "bodies/front_axle/velocity"):  # fmt: skip
                expected = whole[name][500:]
                size = np.abs(whole[name]).max()
                self.assertGreater(np.abs(expected - expected[0]).max(), 1e-3 * size, name)  # it moves
                np.testing.assert_allclose(second[name][()], expected, rtol=0, atol=1e-5 * size, err_msg=name)
            # Displacements refer to the same equilibrium.
            np.testing.assert_allclose(
                second["model/equilibrium/bodies/chassis"][()], whole["model/equilibrium/bodies/chassis"][()],
                rtol=0, atol=1e-9,
            )  # fmt: skip

    def test_a_run_that_continues_has_the_speed_of_the_one_before(self):
        # From the speed follows where on the road the vehicle is, and so whether the road ends before the run.
        self.make_first()
        self.edit("bump.toml", "speed = 3.0\n", "")
        process = self.run_until(0.8, "second.h5", *FROM_FIRST)
        self.assertEqual(process.returncode, 0, process.stderr)
        with h5py.File(self.folder / "second.h5") as file:
            self.assertEqual(file["model"].attrs["speed"], 3.0)

    def test_a_run_continues_exactly_from_results_of_single_precision_without_bodies(self):
        single = ("--set", "output.precision=single", "--set", "output.store.bodies=none")
        for name, arguments in (("first.h5", ()), ("small.h5", single)):
            self.assertEqual(self.run_until(0.5, name, *arguments).returncode, 0)
        for name in ("first", "small"):
            process = self.run_until(0.8, f"{name}_on.h5", "--set", f'continue_from="{name}.h5"')
            self.assertEqual(process.returncode, 0, process.stderr)
        with h5py.File(self.folder / "first_on.h5") as first, h5py.File(self.folder / "small_on.h5") as small:
            for name in ("time", "bodies/chassis/position", "bodies/chassis/modal/acceleration"):
                np.testing.assert_array_equal(first[name][()], small[name][()], err_msg=name)

    def test_modes_that_join_at_the_start_of_a_continued_run_are_not_released_at_once(self):
        # The forces that held modes left out were there before. 0.1 s after the bump few modes are active.
        adaptive = ("--set", "adaptivity.enabled=true", "--set", "adaptivity.recall=0.02")
        self.assertEqual(self.run_until(0.9, "first.h5", *adaptive).returncode, 0)
        for name, arguments in (("long.h5", ()), ("second.h5", FROM_FIRST)):
            process = self.run_until(1.2, name, *adaptive, *arguments)
            self.assertEqual(process.returncode, 0, process.stderr)
        with h5py.File(self.folder / "long.h5") as whole, h5py.File(self.folder / "second.h5") as second:
            active = second["bodies/chassis/modal/active"][()].sum(axis=1)
            self.assertGreater(active.max(), whole["bodies/chassis/modal/active"][900].sum())  # some join
            expected = whole["bodies/chassis/acceleration"][900:, :2]
            off = second["bodies/chassis/acceleration"][:, :2] - expected
            self.assertLess(np.abs(off).max(), 0.1 * np.abs(expected).max())

    def test_a_jump_at_the_start_of_a_continued_run_sets_modes_in_vibration(self):
        # Taken as balanced under the force behind the jump, 8 of 36 modes joined, and the seat had 10 % less.
        vehicle = (self.folder / "vehicle.toml").read_text(encoding="utf-8")
        (self.folder / "kicked.toml").write_text(vehicle + KICK, encoding="utf-8")
        for adaptive in ("true", "false"):
            with self.subTest(adaptive=adaptive):
                kicked = ("--set", 'vehicle="kicked.toml"', "--set", f"adaptivity.enabled={adaptive}", "--set",
                          'adaptivity.available.chassis="all"')  # fmt: skip
                self.assertEqual(self.run_until(0.3, "first.h5", *kicked).returncode, 0)
                told = []
                for name, arguments in (("long.h5", ("--set", "statistics.from=0.3")), ("second.h5", FROM_FIRST)):
                    process = self.run_until(0.5, name, *kicked, *arguments, "--json")
                    self.assertEqual(process.returncode, 0, process.stderr)
                    told.append(json.loads(process.stdout)["modes"])
                with h5py.File(self.folder / "long.h5") as whole, h5py.File(self.folder / "second.h5") as second:
                    for name, allowed in (("position", 1e-5), ("acceleration", 0.02)):
                        # Without the first row, in which the modes of the long run have not joined yet.
                        expected = whole[f"bodies/chassis/{name}"][301:, :2]
                        off = second[f"bodies/chassis/{name}"][1:, :2] - expected
                        self.assertLess(np.abs(off).max(), allowed * np.abs(expected).max())
                if adaptive == "false":  # what came before is not known to the second
                    shares = [one["left_out_together"]["of_rms_acceleration"] for one in told]
                    self.assertLess(abs(shares[1] / shares[0] - 1.0), 0.2)

    def test_what_does_not_fit_is_refused(self):
        self.make_first()
        self.assert_refused(self.run_until(0.5, "b.h5", *FROM_FIRST), "--set 3", "ends at 0.5 s, 'duration' must be")
        self.assert_refused(self.run_until(0.8, "b.h5", *FROM_FIRST, "--set", "statistics.to=0.4"),
                            "ends at 0.5 s, 'statistics.to' must be later, got 0.4 s")
        self.assert_refused(self.run_until(0.8, "b.h5", *FROM_FIRST, "--set", "modes.chassis=4"),
                            "first.h5: error: has modes 1, 2 of body 'chassis', this run has modes 1, 2, 3, 4;")
        self.assert_refused(
            self.run_until(0.8, "b.h5", *FROM_FIRST, "--set", "initial.chassis.angular_velocity=0.1"),
            "'continue_from'", "and 'initial' exclude each other",
        )  # fmt: skip
        self.assert_refused(self.run_until(0.8, "b.h5", "--set", 'continue_from="none.h5"'), "none.h5", "no such file")
        self.assert_refused(self.run_until(0.8, "b.h5", *FROM_FIRST, "--set", "speed=5"),
                            "--set 4: error: 'speed' must be left out, or 3 m/s as in the run that this one")
        before = self.files()
        self.assert_refused(self.run_until(0.8, "./first.h5", *FROM_FIRST), "is also the name of the results")
        self.assertEqual(self.files(), before)
        self.assert_refused(self.run_until(0.8, "b.h5", "--set", 'continue_from="chassis.h5"'), "is no results file")
        with h5py.File(self.folder / "first.h5", "r+") as file:
            file["last_state/coordinates"][1] += 0.01
        self.assert_refused(self.run_until(0.8, "b.h5", *FROM_FIRST), "leave a joint open", "of another vehicle")
        # Without a last state, as files of earlier versions are, the last rows count.
        with h5py.File(self.folder / "first.h5", "r+") as file:
            del file["last_state"]
            file["bodies/chassis/position"][-1, 1] += 0.01
        self.assert_refused(self.run_until(0.8, "b.h5", *FROM_FIRST), "leave a joint open", "of another vehicle")
        with h5py.File(self.folder / "first.h5", "r+") as file:
            del file["bodies/chassis/velocity"]
        self.assert_refused(self.run_until(0.8, "b.h5", *FROM_FIRST), "dataset '/bodies/chassis/velocity' is missing")
        self.assertFalse((self.folder / "b.h5").exists())

    def test_a_force_element_takes_over_its_own_states(self):
        # At 0.5 s the load holds the leaf spring's friction and the bushing's relaxing part away from zero.
        # Expected: what the elements had at the end of the first run, whatever their order in the file.
        self.write_vehicle(LEAF, MOUNT)
        self.assertEqual(self.run_until(0.5, "first.h5").returncode, 0)
        forces = ("leaf/friction", "mount/force_y")
        with h5py.File(self.folder / "first.h5") as file:
            expected = [file["forces"][name][-1] for name in forces]
        self.assertGreater(min(np.abs(expected)), 50.0)
        self.write_vehicle(MOUNT, LEAF)
        self.assertEqual(self.run_until(0.8, "second.h5", *FROM_FIRST).returncode, 0)
        with h5py.File(self.folder / "second.h5") as file:
            np.testing.assert_allclose([file["forces"][name][0] for name in forces], expected, rtol=1e-6)
        # Of another full friction the share is the same, and an element of another kind remembers nothing.
        self.write_vehicle(MOUNT.replace("mount", "other"), LEAF.replace("coefficient = 500.0", "coefficient = 100.0"))
        self.assertEqual(self.run_until(0.8, "third.h5", *FROM_FIRST).returncode, 0)
        with h5py.File(self.folder / "third.h5") as file:
            self.assertAlmostEqual(file["forces/leaf/friction"][0] / expected[0], 0.2, delta=1e-6)
            self.assertEqual(file["forces/other/state"][0, 0], 0.0)
        # A share of nothing is no number.
        with h5py.File(self.folder / "first.h5", "r+") as file:
            file["last_state/state_size"][0] = 0.0
        self.assert_refused(self.run_until(0.8, "b.h5", *FROM_FIRST), "'/last_state/state_size' must have a size > 0")

    def write_vehicle(self, *forces):
        (self.folder / "vehicle.toml").write_text(SLIDER + "".join(forces) + PUSH, encoding="utf-8")
        (self.folder / "bump.toml").write_text('vehicle = "vehicle.toml"\nduration = 0.5\n', encoding="utf-8")


if __name__ == "__main__":
    unittest.main()
