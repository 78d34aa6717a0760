#!/usr/bin/python3
"""The JSON of the commands is what dynamics/README.md, "JSON", says: no path is missing there, none only there."""

import json
import re
import unittest

from dynamics_test_case import PROGRAM, ROOT, DynamicsTestCase, run_program

README = (ROOT / "dynamics/README.md").read_text(encoding="utf-8")
QUARTER_CAR = ROOT / "dynamics/models/examples/quarter_car_run.toml"
# Names of outputs have slashes, those of the other objects have none.
NAMES = {"OUTPUT": ".+", "K": r"\d+", "POINT": "[^/]+", "BODY": "[^/]+", "FORCE": "[^/]+", "CHANNEL": "[^/]+",
         "JOINT": "[^/]+", "NAME": "[^/]+", "EXTREME": "(min|max|rms)",
         "QUANTITY": "(axial|shear|moment|static|(displacement|acceleration|force)_(rms|peak))",
         "FROM": "(from_loads|from_modes|difference)"}  # fmt: skip

HEAD = ["format", "version", "command", "file", "set", "parameters", "warnings"]  # of all commands
AIR_SPRING = """
[[forces]]
name = "rear_air"
type = "air-spring"
a = "rear_axle.origin"
b = "chassis.rear_spring"
design_height = 0.41
effective_area = 0.02
volume = 0.005
load = "static"
"""

ROAD = ("--set", "road={class = 'D', length = 50.0, start = 2.0, seed = 7}")


def list_paths(value, path=""):
    """The paths of all single values."""
    if not isinstance(value, (dict, list)):
        return {path}
    items = value.items() if isinstance(value, dict) else enumerate(value)
    return {found for key, one in items for found in list_paths(one, f"{path}/{key}" if path else str(key))}


def read_documented():
    """The paths that the README says, of each command."""
    part = README.split("### JSON\n")[1].split("\n### ")[0]
    documented = {}
    for table in re.findall(r"\| of (.+) \| \|\n\|---\|---\|\n((?:\|.+\n)+)", part):
        paths = re.findall("`([^`]+)`", "\n".join(row.split(" | ")[0] for row in table[1].splitlines()))
        for command in re.findall("`([^`]+)`", table[0]):
            documented.setdefault(command, set()).update(paths)
    return documented


def make_pattern(path):
    words = [NAMES.get(word, re.escape(word)) for word in path.split("/")]
    return re.compile("/".join(words))


class JsonOfCommands(DynamicsTestCase):
    def call_json(self, command, run, *arguments):
        """The paths in what a command prints."""
        words = [PROGRAM, *command.split(), run, "--json", "--quiet", "--superelements", ".", *arguments]
        printed = json.loads(run_program(words, cwd=self.folder, check=True).stdout)
        self.assertEqual((printed["format"], printed["version"], printed["command"]), ("sprung-dynamics", 1, command))
        self.assertEqual(list(printed)[: len(HEAD)], HEAD)
        return list_paths(printed)

    def test_a_random_road_is_told_by_its_numbers(self):
        # ISO 8608: class D has 1024e-6 m³ at 0.1 1/m, and spectra are reported from 0.011 to 2.83 1/m.
        words = [PROGRAM, "run", "--dry-run", QUARTER_CAR, "--json", "--quiet", *ROAD]
        parameters = json.loads(run_program(words, cwd=self.folder, check=True).stdout)["parameters"]
        self.assertEqual(parameters["road"], "random")
        found = parameters["road_parameters"]
        self.assertAlmostEqual(found.pop("density"), 1024e-6, delta=1e-12)
        self.assertEqual(found, {"start": 2.0, "length": 50.0, "seed": 7, "ease": 0.0, "band": [0.011, 2.83]})

    def test_ride_tells_the_parameters_of_the_run(self):
        words = [PROGRAM, "run", "bump.toml", "--json", "--quiet", "--superelements", ".", "-o", "r.h5", "--set",
                 "duration=0.5", "--set", "modes.chassis=[1, 3]"]  # fmt: skip
        told = json.loads(run_program(words, cwd=self.folder, check=True).stdout)["parameters"]
        ride = run_program([ROOT / "tools/ride", "r.h5", "--json"], cwd=self.folder, check=True)
        (found,) = json.loads(ride.stdout)["runs"]
        self.assertGreater(len(found["parameters"]), 6)
        self.assertEqual(found["parameters"], {key: told[key] for key in found["parameters"]})

    def test_every_path_is_documented_and_every_documented_one_occurs(self):
        short = ("--set", "duration=0.1", "--set", "modes.chassis=2")
        # A random road; modes chosen; the length of a spring and the pressure of an air spring; an unlikely inertia.
        vehicle = (self.folder / "vehicle.toml").read_text(encoding="utf-8")
        static = "free_length = { static = 0.39 }"
        (self.folder / "static.toml").write_text(
            vehicle.replace("free_length = 0.458", static, 1) + AIR_SPRING, encoding="utf-8")  # fmt: skip
        of_all = ("bump.toml", "--set", 'vehicle="static.toml"', "--set", 'modes.chassis="auto"', "--set",
                  "mode_choice.tolerance=0.2", "--set", "vehicle.bodies.front_axle.inertia=1e7", *ROAD)  # fmt: skip
        turned = ("--set", "initial.sprung.angular_velocity=0.1")  # which its slide does not allow
        shifted = ("--set", "vehicle.motions.way.function={ polynomial = [0.5, 5.0] }")
        slow = ("--set", "vehicle.forces.suspension.damper.coefficient=1e5")
        runs = {
            "run": [("bump.toml", *short, "-o", "r.h5", "--set", "output.size=0.01"), (QUARTER_CAR, *short[:2]),
                    (QUARTER_CAR, *short[:2], *turned), (QUARTER_CAR, *short[:2], *shifted)],
            "run --dry-run": [(QUARTER_CAR, "--set", "output.size=0.01"), (QUARTER_CAR, *turned),
                              (QUARTER_CAR, *shifted), ("bump.toml", *short)],
            "equilibrium": [("bump.toml", *short), (QUARTER_CAR,)],
            "modes": [("bump.toml", *short), ("bump.toml", "--bracket", "--set", 'modes.chassis="certified"'),
                      (QUARTER_CAR, *slow)],
            "response": [("bump.toml", "--set", "response.road.class=C"), (QUARTER_CAR,)],
            "select-modes": [],
        }
        for command, calls in runs.items():
            calls.append((*of_all, *short[:2]))
        documented = read_documented()
        self.assertEqual(set(documented), set(runs))
        for command, calls in runs.items():
            found = set().union(*(self.call_json(command, *arguments) for arguments in calls))
            patterns = {path: make_pattern(path) for path in documented[command]}
            for path in found:
                self.assertTrue(any(one.fullmatch(path) for one in patterns.values()), f"{command}: {path}")
            for path, pattern in patterns.items():
                with self.subTest(command=command, path=path):
                    self.assertTrue(any(pattern.fullmatch(one) for one in found))


if __name__ == "__main__":
    unittest.main()
