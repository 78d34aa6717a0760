#!/usr/bin/python3
"""Warnings of what joints and prescribed motions make of the drawing at the start."""

import json
import unittest

from dynamics_test_case import ROOT, DynamicsTestCase

# A carriage that a motion drives at 5 m/s, with a wheel under it.
CARRIAGE = """
name = "carriage"
[ground.points]
rail = [0.0, 1.0]
[bodies.carriage]
mass = 300.0
inertia = 100.0
position = [0.0, 1.0]
[bodies.wheel]
mass = 40.0
inertia = 1.0
position = [0.0, 0.3]
[[joints]]
name = "rail"
type = "translational"
a = "ground.rail"
b = "carriage.origin"
axis = [1.0, 0.0]
[[joints]]
name = "guide"
type = "translational"
a = "carriage.origin"
b = "wheel.origin"
axis = [0.0, 1.0]
[[motions]]
name = "drive"
joint = "rail"
function = { polynomial = [0.0, 5.0] }
[[forces]]
name = "tyre"
type = "tyre"
wheel = "wheel.origin"
radius = 0.32
spring = { polynomial = [0.0, 2e5] }
"""


ROPE = """
[[forces]]
name = "rope"
type = "spring-damper"
a = "ground.origin"
b = "carriage.origin"
free_length = 1.0
spring = { polynomial = [0.0, 1.0] }
"""
CRUISE = """
[[motions]]
name = "cruise"
point = "{point}"
coordinate = "{coordinate}"
function = {{ polynomial = [{value}, 0.0] }}
"""


class WholeVehicles(DynamicsTestCase):
    def balance(self, *motions):
        """Of the half car of the templates."""
        templates = ROOT / "dynamics/models/templates"
        text = (templates / "half_car.toml").read_text(encoding="utf-8") + "".join(motions)
        (self.folder / "vehicle.toml").write_text(text, encoding="utf-8")
        run = (templates / "half_car_run.toml").read_text(encoding="utf-8")
        (self.folder / "bump.toml").write_text(run.replace("half_car.toml", "vehicle.toml"), encoding="utf-8")
        process = self.run_program("--json", verb="equilibrium")
        self.assertEqual(process.returncode, 0, process.stderr)
        return json.loads(process.stdout), process.stderr

    def test_a_vehicle_is_shifted_as_a_whole_to_where_its_motion_begins(self):
        drawn, _ = self.balance()
        moved, remarks = self.balance(CRUISE.format(point="body.seat", coordinate="x", value=5.1))
        for name, body in moved["bodies"].items():
            expected = drawn["bodies"][name]
            self.assertAlmostEqual(body["x"], expected["x"] + 5.0, delta=1e-3)  # the balance itself moves some
            self.assertAlmostEqual(body["y"], expected["y"], delta=1e-9)
        self.assertEqual((moved["warnings"], remarks), ([], ""))
        self.assertEqual(moved["static_lengths"].keys(), drawn["static_lengths"].keys())
        for name, spring in moved["static_lengths"].items():
            self.assertAlmostEqual(spring["free_length"], drawn["static_lengths"][name]["free_length"], delta=1e-8)

    def test_it_is_not_shifted_off_the_road_or_away_from_the_ground(self):
        rope = ROPE.replace("carriage.origin", "body.center_of_mass")
        for coordinate, value, tied, shift in (("x", 5.0, "", 5.0), ("x", 5.0, rope, None), ("y", 0.6, "", None)):
            motion = CRUISE.format(point="body.center_of_mass", coordinate=coordinate, value=value)
            self.balance(motion + tied)
            process = self.run_program("--dry-run", "--json", "--quiet")
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertEqual(json.loads(process.stdout)["start"].get("shift"), shift)


class AssemblyWarnings(DynamicsTestCase):
    def write_carriage(self, x=0.0, wheel=0.0):
        """x: where the carriage is drawn, whose motion begins at 0; wheel: where its wheel is, from there."""
        vehicle = CARRIAGE.replace("[0.0, 1.0]\n[bodies.wheel]", f"[{x}, 1.0]\n[bodies.wheel]")
        vehicle = vehicle.replace("position = [0.0, 0.3]", f"position = [{x + wheel}, 0.3]")
        (self.folder / "vehicle.toml").write_text(vehicle, encoding="utf-8")
        (self.folder / "bump.toml").write_text('vehicle = "vehicle.toml"\nduration = 0.01\n', encoding="utf-8")

    def test_a_speed_that_prescribed_motion_does_not_allow(self):
        self.write_carriage()
        for speed, told in ((5.0, False), (8.0, True)):
            process = self.run_program("--set", f"speed={speed}", "-o", "x.h5")
            self.assertEqual(process.returncode, 0, process.stderr)
            words = f"starts at 5 m/s and not at 'speed', {speed:g} m/s, which prescribed motion ('drive') or joints do"
            self.assertEqual(words in process.stderr, told, process.stderr)

    def test_a_motion_that_begins_away_from_the_drawing(self):
        # A spring to the ground keeps it from being shifted as a whole.
        larger, smaller = "begins at a value 0.3 m larger", "begins at a value 0.3 m smaller"
        for x, told in ((0.0, ""), (-0.004, ""), (-0.3, larger), (0.3, smaller)):
            self.write_carriage(x)
            with (self.folder / "vehicle.toml").open("a", encoding="utf-8") as vehicle:
                vehicle.write(ROPE)
            for verb in ("run", "modes", "equilibrium"):
                with self.subTest(x=x, verb=verb):
                    process = self.run_program("--json", "--quiet", verb=verb)
                    self.assertEqual(process.returncode, 0, process.stderr)
                    texts = [one["text"] for one in json.loads(process.stdout)["warnings"]]
                    found = [text for text in texts if "prescribed motion 'drive' begins" in text]
                    self.assertEqual(len(found), bool(told), texts)
                    self.assertTrue(all(told in text for text in found), found)

    def test_a_body_that_joints_move_far_is_told_of_in_the_balance_too(self):
        self.write_carriage(wheel=8.0)
        for verb in ("equilibrium", "modes"):
            process = self.run_program("--json", verb=verb)
            self.assertEqual(process.returncode, 0, process.stderr)
            (text,) = (one["text"] for one in json.loads(process.stdout)["warnings"])
            self.assertRegex(text, r"to close the joints, of which 'guide' was 8 m open")
            self.assertIn(f"warning: {text}", process.stderr)


if __name__ == "__main__":
    unittest.main()
