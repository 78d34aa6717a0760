#!/usr/bin/python3
"""Input that cannot be used gives a located message and exit code 2. An earlier result stays, and no partial file is
left."""

import shutil
import unittest

import h5py

from dynamics_test_case import DynamicsTestCase

# What is done to a file, and what the message has to say: where, what was found, what was expected.
SPOILT_TEXT = [
    (
        "unknown key",
        "bump.toml",
        "duration = 5.0",
        "duration = 5.0\nspede = 3.0",
        ("bump.toml:7:1", "'spede'", "speed"),
    ),
    ("missing key", "bump.toml", "length = 0.4", "", ("bump.toml:12:1", "missing key 'length'")),
    ("wrong type", "bump.toml", "speed = 3.0", 'speed = "fast"', ("bump.toml:5:9", "m/s", '"fast"')),
    ("negative length", "bump.toml", "length = 0.4", "length = -0.4", ("bump.toml:15:10", "> 0 m", "-0.4")),
    ("negative mass", "vehicle.toml", "mass = 1185.0", "mass = -1185.0", ("vehicle.toml:22:8", "≥ 0 kg", "-1185")),
    ("NaN", "vehicle.toml", "mass = 1185.0", "mass = nan", ("vehicle.toml:22:8", "nan")),
    ("infinity", "vehicle.toml", "free_length = 0.458", "free_length = inf", ("vehicle.toml", "free_length", "inf")),
    ("negative stiffness", "vehicle.toml", "rate = 6.91e6", "rate = -6.91e6", ("vehicle.toml", "rate", "> 0")),
    ("not TOML", "vehicle.toml", "[[joints]]", "[[joints]", ("vehicle.toml:", "error: ")),
    (
        "a joint on a node the superelement lacks",
        "vehicle.toml",
        'a = "chassis.front_long_pivot"',
        'a = "chassis.front_long_pvot"',
        ("vehicle.toml:", "front_long_pvot", "front_long_pivot"),
    ),
    (
        "unknown joint partner",
        "vehicle.toml",
        'b = "front_axle.long_arm"',
        'b = "frnt_axle.long_arm"',
        ("vehicle.toml:", "frnt_axle", "front_axle"),
    ),
    (
        "initial positions that cannot be assembled",
        "vehicle.toml",
        "long_arm = [0.116, -0.1]",
        "long_arm = [3.0, -3.0]",
        ("vehicle.toml:", "cannot be closed", "front_long_axle"),
    ),
    (
        "redundant joints",
        "vehicle.toml",
        '[[joints]]\nname = "front_long_chassis"',
        '[[joints]]\nname = "twice"\ntype = "revolute"\na = "chassis.front_long_pivot"\n'
        'b = "front_long_arm.chassis_end"\n\n[[joints]]\nname = "front_long_chassis"',
        ("vehicle.toml:", "redundant", "twice", "front_long_chassis"),
    ),
    ("no such vehicle", "bump.toml", '"vehicle.toml"', '"vehcle.toml"', ("bump.toml", "vehcle.toml")),
    ("a name that is too long", "bump.toml", '"vehicle.toml"', f'"{"v" * 300}"', ("bump.toml:4:", "no vehicle file")),
]


class SpoiltText(DynamicsTestCase):
    def test_each_fault_is_located_and_nothing_is_lost(self):
        self.make_earlier_result()
        for name, file, old, new, fragments in SPOILT_TEXT:
            with self.subTest(name):
                before = self.files()
                self.edit(file, old, new)
                process = self.run_to_results()
                (self.folder / file).write_bytes(before[file])
                self.assert_refused(process, *fragments)
                self.assertEqual(self.files(), before)

    def test_overrides_are_located_by_their_number(self):
        process = self.run_to_results("--set", "modes.chassis=2", "--set", "road.lenght=3")
        self.assert_refused(process, "--set 3: error: ", "lenght", "length")  # after the one of SHORT
        process = self.run_to_results("--set", "vehicle.bodies.front_axle.mass=-1")
        self.assert_refused(process, "--set 2: error: ", "mass", "≥ 0 kg")

    def test_more_modes_than_the_file_has(self):
        self.assert_refused(self.run_to_results("--set", "modes.chassis=37"), "--set 2", "36", "37")

    def test_half_a_cluster_of_equal_frequencies(self):
        self.assert_refused(self.run_to_results("--set", "modes.chassis=3"), "--set 2", "38.31")

    def test_unknown_command_line(self):
        self.assert_refused(self.run_program("--sett", "speed=1"), "sprung-dynamics: error: ", "--sett")


class SpoiltSuperelement(DynamicsTestCase):
    def setUp(self):
        super().setUp()
        self.earlier = self.make_earlier_result()
        self.chassis = self.folder / "chassis.h5"

    def check(self, *fragments):
        self.assert_refused(self.run_to_results("--superelements", "."), "chassis.h5", *fragments)
        self.assertEqual(self.results.read_bytes(), self.earlier)
        self.assertFalse((self.folder / "results.partial.h5").exists())

    def test_missing(self):
        self.chassis.unlink()
        self.check("vehicle.toml:")

    def test_empty(self):
        self.chassis.write_bytes(b"")
        self.check("empty")

    def test_truncated(self):
        self.chassis.write_bytes(self.chassis.read_bytes()[:40000])
        self.check()

    def test_overwritten_in_the_middle(self):
        content = bytearray(self.chassis.read_bytes())
        middle = len(content) // 2
        content[middle : middle + 64] = bytes(byte ^ 0x5A for byte in content[middle : middle + 64])
        self.chassis.write_bytes(bytes(content))
        self.check()

    def test_foreign(self):
        with h5py.File(self.chassis, "w") as file:
            file["weather"] = [1.0, 2.0]
        self.check("format")

    def test_wrong_shape(self):
        with h5py.File(self.chassis, "r+") as file:
            stiffness = file["matrices/stiffness"][:-1, :]
            del file["matrices/stiffness"]
            file["matrices/stiffness"] = stiffness
        self.check("stiffness", "35", "36")

    def test_newer_version(self):
        with h5py.File(self.chassis, "r+") as file:
            file.attrs["version"] = file.attrs["version"] + 99
        self.check("version")

    def test_another_body_in_its_place(self):
        shutil.copy(self.folder / "long_arm.h5", self.chassis)
        process = self.run_to_results()
        self.assert_refused(process, "vehicle.toml:", "front_spring")


if __name__ == "__main__":
    unittest.main()
