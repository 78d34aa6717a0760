"""Vehicles, runs and designs in which one value is another one that TOML allows: each ends well, or by an error that
names the place, never with numbers that are none.

Every third place in every_element.toml, every_element_run.toml and two designs has its turn with one value, the same on
every machine; SPRUNG_MUTANTS=10 tries ten values at all places and prints how many ended with which exit code.
Needs both programs and the truck's superelements."""

import collections
import copy
import os
import random
import re
import shutil
import tomllib
import unittest

import h5py
import numpy as np
from tool_test_case import ROOT, ToolTestCase, run_program

from sprung_tools.files.toml_text import format_document

REDUCE, DYNAMICS = os.environ["SPRUNG_REDUCE"], os.environ["SPRUNG_DYNAMICS"]
SUPERELEMENTS = os.environ["SPRUNG_SUPERELEMENTS"]
DATA = ROOT / "tests/tools/data"
VEHICLE, RUN = DATA / "every_element.toml", DATA / "every_element_run.toml"
DESIGNS = (ROOT / "meshes/truck/long_arm.toml", ROOT / "meshes/templates/tractor_frame.toml")
ROUNDS = int(os.environ.get("SPRUNG_MUTANTS", "1"))
EVERY = 1 if "SPRUNG_MUTANTS" in os.environ else 3
OF_NUMBERS = (
    1e300, -1e300, 1e-300, 1e30, 1e10, -1e12, 1e-15, -0.0, float("nan"), float("inf"), 2**63 - 1, True, "x", [],
)  # fmt: skip
OF_TEXTS = ("", "nan", "\0", "frame.origin", "ä", "\u202e", "x" * 5000, 1, [], {})
OF_OTHERS = (True, [], {}, [1.0], [[]], "x", 1e300)
NO_NUMBER = re.compile(r"(?<![\w.\"'])-?(nan|inf)(?![\w\"'])")
QUOTED = re.compile(r"got .*|'[^'\n]*'|no vehicle file .*")


def list_places(value, place=()):
    """The places of all values in a document: keys and indices from its root."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in inner:
        yield (*place, key)
        yield from list_places(one, (*place, key))


def replace(document, place, rng):
    """A copy of a document with another value at a place, and its description."""
    changed = copy.deepcopy(document)
    holder = changed
    for key in place[:-1]:
        holder = holder[key]
    old = holder[place[-1]]
    is_number = isinstance(old, (int, float)) and not isinstance(old, bool)
    new = rng.choice(OF_NUMBERS if is_number else OF_TEXTS if isinstance(old, str) else OF_OTHERS)
    holder[place[-1]] = new
    return changed, f"{'.'.join(map(str, place))} = {str(new)[:20]!r}"


def list_bad_datasets(path):
    """The datasets of a file with numbers that are not finite. What a default of infinity says is no result."""
    bad = []

    def look(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and not name.startswith("model/"):
            if not np.all(np.isfinite(item[()])):
                bad.append(name)

    with h5py.File(path) as file:
        file.visititems(look)
    return bad


class MutatedModels(ToolTestCase):
    def setUp(self):
        super().setUp()
        shutil.copy(DATA / "every_element_drive.csv", self.folder)
        self.vehicle = tomllib.loads(VEHICLE.read_text(encoding="utf-8"))
        self.run_table = tomllib.loads(RUN.read_text(encoding="utf-8"))

    def write(self, name, table):
        (self.folder / name).write_text(format_document(table), encoding="utf-8")

    def assert_ends_well(self, command):
        """Returns the exit code: 0 or 1 with finite results, 2 with an error at a place, 3 with a reason."""
        process = run_program(command, cwd=self.folder)
        self.said = said = process.stdout + process.stderr
        self.assertIn(process.returncode, (0, 1, 2, 3), said[-300:])
        self.assertNotIn("internal error", said)
        self.assertIsNone(NO_NUMBER.search(QUOTED.sub("", said)), said[-500:])
        if process.returncode >= 2:
            where = r"^[^\s:]*(:\d+:\d+)?: error: ." if process.returncode == 2 else r"^[^\s:]*: error: ."
            self.assertRegex(process.stderr, re.compile(where, re.MULTILINE))
        for path in self.folder.glob("*.h5"):
            if process.returncode < 2:
                self.assertEqual(list_bad_datasets(path), [])
            path.unlink()
        return process.returncode

    def run_model(self, vehicle, run, command="run"):
        self.write("every_element.toml", vehicle)
        self.write("run.toml", run)
        results = ["-o", "out.h5"] if command in ("run", "response") else []
        return self.assert_ends_well(
            [DYNAMICS, command, "run.toml", "--superelements", SUPERELEMENTS, "--quiet", *results]
        )

    def try_places(self, document, run_changed, every=EVERY):
        """Places of a document with other values. run_changed: takes the changed document, returns an exit code."""
        self.assertEqual(run_changed(document), 0)  # or all are refused for something else
        codes = []
        for number, place in list(enumerate(list_places(document)))[::every]:
            for attempt in range(ROUNDS):
                changed, what = replace(document, place, random.Random(f"{number} {attempt}"))
                with self.subTest(what):
                    codes.append(run_changed(changed))
        self.assertGreater(codes.count(2), len(codes) / 3)
        if "SPRUNG_MUTANTS" in os.environ:
            print(self.id(), sorted(collections.Counter(codes).items()), flush=True)

    def test_the_models_themselves_run(self):
        for command in ("run", "response"):
            self.assertEqual(self.run_model(self.vehicle, self.run_table, command), 0)

    def test_values_that_cannot_be_calculated_with_are_named(self):
        def find(group, name):
            return next(one for one in self.vehicle[group] if one["name"] == name)

        arm, slide = self.vehicle["bodies"]["arm"], find("joints", "slide")
        front, air = find("forces", "front_suspension"), find("forces", "air_pair")
        integrator = self.run_table["integrator"]
        for holder, key, value, *expected in (
            (arm, "position", [1e10, 0.0], "every_element.toml:", "must be ≤ 1000000000 m, got 10000000000"),
            (self.vehicle["bodies"]["tail"]["points"], "top", [0.0, -1e300], "must be ≥ -1000000000 m, got -1e+300"),
            (arm, "mass", 0.0, "'bodies.arm' can move without moving any mass"),
            (front, "spring", {"polynomial": [0.0, 1e29]}, "too large for the mass that it holds", "axle.y"),
            (front, "multiplicity", 1e9, "must be > 0 and ≤ 1000000, got 1000000000"),
            (slide, "axis", [1e300, 0.0], "must be ≤ 1e+30, got 1e+300"),
            (air, "volume", 1e300, "must be ≤ 1e+30 m³, got 1e+300"),
            (self.run_table, "output_step", 1e-12, "run.toml:", "outputs"),
            (integrator, "largest_step", 1e-15, "run.toml:", "must be ≥ 3e-11 s, got 1e-15"),
        ):
            before, holder[key] = holder[key], value
            with self.subTest(key, value=value):
                self.assertIn(self.run_model(self.vehicle, self.run_table), (2, 3))
                for fragment in expected:
                    self.assertIn(fragment, self.said)
            holder[key] = before

    def test_a_vehicle_with_another_value(self):
        run = {"vehicle": "every_element.toml", "duration": 0.01, "speed": 5.0, "modes": {"frame": 2}}
        # Not run: with a damper of 1e9 N·s/m and more the steps become short and the run long.
        self.try_places(self.vehicle, lambda vehicle: self.run_model(vehicle, run, "modes"))

    def test_a_run_with_another_value(self):
        self.try_places(self.run_table, lambda run: self.run_model(self.vehicle, run))

    def test_a_response_with_another_value(self):
        rest = {key: self.run_table[key] for key in ("vehicle", "speed", "duration")}
        self.try_places(
            self.run_table["response"],
            lambda response: self.run_model(self.vehicle, {**rest, "response": response}, "response"),
            every=1,
        )

    def test_a_design_without_its_mesh_is_told_where(self):
        design = tomllib.loads((ROOT / "meshes/examples/ladder_frame.toml").read_text(encoding="utf-8"))
        for mesh in ("", "nothing.geo", "../"):
            self.write("design.toml", {**design, "mesh": mesh})
            self.assertEqual(self.assert_ends_well([REDUCE, "build", "design.toml"]), 2)
            self.assertRegex(self.said, r"design\.toml:\d+:\d+: error: 'mesh' must name a file, found none at '")

    def test_a_design_with_another_value(self):
        def build(design):
            self.write("design.toml", design)
            return self.assert_ends_well([REDUCE, "build", "design.toml"])

        for path in DESIGNS:
            self.try_places(tomllib.loads(path.read_text(encoding="utf-8")), build)


if __name__ == "__main__":
    unittest.main()
