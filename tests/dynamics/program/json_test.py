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
         "EXTREME": "(min|max|rms)", "QUANTITY": "(axial|shear|moment)",
         "FROM": "(from_loads|from_modes|difference)"}  # fmt: skip


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
        words = [PROGRAM, command, run, "--json", "--quiet", "--superelements", ".", *arguments]
        return list_paths(json.loads(run_program(words, cwd=self.folder, check=True).stdout))

    def test_every_path_is_documented_and_every_documented_one_occurs(self):
        short = ("--set", "duration=0.1", "--set", "modes.chassis=2")
        runs = {
            "run": [("bump.toml", *short), (QUARTER_CAR, "--set", "duration=0.1")],
            "equilibrium": [("bump.toml", *short), (QUARTER_CAR,)],
            "modes": [("bump.toml", *short), ("bump.toml", "--bracket", "--set", 'modes.chassis="certified"')],
            "response": [("bump.toml", "--set", "response.road.class=C"), (QUARTER_CAR,)],
        }
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
