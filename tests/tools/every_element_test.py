"""A vehicle with every key that the reference of input files has, and so every kind of joint, force element, law and
function: it has an equilibrium and modes, runs and resumes; ride and report accept its results, and the moments in a
frame that is taken as rigid contain the loads of all elements. Needs sprung-dynamics and the truck's superelements."""

import os
import re
import shutil
import signal
import subprocess
import time
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy as np
from tool_test_case import ROOT, ToolTestCase, make_class_folder, run_program

from sprung_tools.files.results_file import open_results
from sprung_tools.files.hdf5_file import read_text
from sprung_tools.model.force_channels import ROLES
from sprung_tools.model.resolved_model import read_elements
from sprung_tools.model.rigid_body_loads import calc_rigid_moments, read_superelement

PROGRAM, SUPERELEMENTS = os.environ["SPRUNG_DYNAMICS"], os.environ["SPRUNG_SUPERELEMENTS"]
DATA = ROOT / "tests/tools/data"
ATTEMPTS = 20  # on a busy machine a run may be at its end before the signal


def read_reference():
    """The keys of a vehicle file, and the types of joints and of force elements, from dynamics/models/README.md."""
    text = (ROOT / "dynamics/models/README.md").read_text(encoding="utf-8")
    part = text.partition("\n## Vehicle file\n")[2].partition("\n## Run file\n")[0]
    tables = re.findall(r"^\| key \|.*\n\|[-| ]*\n((?:\|.*\n)+)", part, re.MULTILINE)
    cells = [row.split(" |")[0] for table in tables for row in table.splitlines()]
    keys = {key for cell in cells for key in re.findall(r"`(\w+)`", cell)}
    return keys, {
        group: set(re.findall(rf"^### {group.capitalize()}: ([a-z-]+)$", part, re.MULTILINE)) - keys
        for group in ("joints", "forces")
    }


def read_names(heading):
    """The names in a table "| kind | HEADING |" of dynamics/output/results.md, by kind: NAME or PREFIX_…. What stands
    in parentheses explains them."""
    text = (ROOT / "dynamics/output/results.md").read_text(encoding="utf-8")
    rows = text.partition(f"\n| kind | {heading} |\n")[2].partition("\n\n")[0].splitlines()[1:]
    cells = [row.strip("| ").split(" | ") for row in rows]
    return {kind.strip("`"): set(re.findall(r"`(\w+…?)`", re.sub(r"\([^()]*\)", "", named))) for kind, named in cells}


def list_differences(found, named):
    """The names that were found or that a table has, and not both."""
    prefixes = tuple(name.removesuffix("…") for name in named if name.endswith("…"))
    plain = {name for name in named if not name.endswith("…")}
    missing = [prefix for prefix in prefixes if not any(name.startswith(prefix) for name in found)]
    return sorted({name for name in found if not name.startswith(prefixes)} ^ plain) + missing


def list_keys(value):
    """The keys of a document and of all tables in it."""
    if isinstance(value, dict):
        return set(value).union(*map(list_keys, value.values()))
    return set().union(*map(list_keys, value)) if isinstance(value, list) else set()


def read_datasets(path):
    """Every dataset of an HDF5 file, as bytes, without what was measured by a clock."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: np.asarray(item[()]).tobytes()})
                        if isinstance(item, h5py.Dataset) else None)  # fmt: skip
    return found


class EveryElement(ToolTestCase):
    @classmethod
    def setUpClass(cls):
        """Runs with the frame rigid, and with all of its modes."""
        cls.made = make_class_folder(cls)
        shutil.copy(DATA / "every_element.toml", cls.made / "vehicle.toml")
        shutil.copy(DATA / "every_element_drive.csv", cls.made)
        (cls.made / "run.toml").write_text('vehicle = "vehicle.toml"\nduration = 0.5\n', encoding="utf-8")
        for name, modes in (("rigid", "0"), ("flexible", '"all"')):
            run_program([PROGRAM, "run", "run.toml", "--superelements", SUPERELEMENTS, "--quiet", "-o", f"{name}.h5",
                         "--set", f"modes.frame={modes}"], cwd=cls.made, check=True)  # fmt: skip

    def setUp(self):
        super().setUp()
        for path in self.made.glob("*.h5"):
            shutil.copy(path, self.folder)

    def open(self, name):
        results = open_results(self.folder / name)
        self.addCleanup(results.file.close)
        return results

    def test_the_vehicle_has_every_key_of_the_reference(self):
        vehicle = tomllib.loads((DATA / "every_element.toml").read_text(encoding="utf-8"))
        keys, types = read_reference()
        self.assertGreater(min(len(keys), 10 * sum(map(len, types.values()))), 80)
        self.assertEqual(keys - list_keys(vehicle), set())
        for group, wanted in types.items():
            self.assertEqual(wanted - {one["type"] for one in vehicle[group]}, set())

    def test_the_contents_of_the_reference_and_its_table_of_joints_are_complete(self):
        text = (ROOT / "dynamics/models/README.md").read_text(encoding="utf-8")
        contents = text.partition("\n## Contents\n")[2].partition("\n## ")[0]
        for heading in re.findall(r"^### (.+)$", text, re.MULTILINE):
            self.assertIn(f"](#{heading.lower().replace(':', '').replace(' ', '-')})", contents)
        joints = text.partition("\n### Joints\n")[2].partition("\n### ")[0]
        self.assertEqual(set(re.findall(r'^\| `"([a-z-]+)"`', joints, re.MULTILINE)), read_reference()[1]["joints"])

    def test_it_has_an_equilibrium_and_modes(self):
        for command, expected in (("equilibrium", "cab_air: gauge pressure"), ("modes", "46 freedoms")):
            process = run_program([PROGRAM, command, "run.toml", "--superelements", SUPERELEMENTS,
                                   "--set", 'modes.frame="all"'], cwd=self.made)  # fmt: skip
            self.assert_succeeds(process)
            self.assertIn(expected, process.stdout)

    def test_a_killed_run_resumes_with_the_results_of_an_uninterrupted_one(self):
        command = [PROGRAM, "run", "run.toml", "--superelements", SUPERELEMENTS, "--quiet", "--set", "modes.frame=0",
                   "--set", "duration=9", "--set", "output_step=1e-4", "-o"]  # fmt: skip
        run_program([*command, "whole.h5"], cwd=self.made, check=True)
        partial = self.made / "cut.partial.h5"
        for _ in range(ATTEMPTS):
            with subprocess.Popen([*command, "cut.h5"], cwd=self.made, stdin=subprocess.DEVNULL) as process:
                while process.poll() is None and not partial.exists():
                    time.sleep(0.001)
                process.kill()
            if partial.exists():
                break
        self.assertEqual(process.returncode, -signal.SIGKILL)
        run_program([*command, "cut.h5", "--resume"], cwd=self.made, check=True)
        whole, found = read_datasets(self.made / "whole.h5"), read_datasets(self.made / "cut.h5")
        self.assertEqual(sorted(whole), sorted(found))
        self.assertEqual([name for name in whole if whole[name] != found[name]], [])

    def test_the_tools_know_the_role_of_every_channel(self):
        results = self.open("rigid.h5")
        for name in results.names("forces"):
            for channel in results.file.names(f"forces/{name}"):
                if not channel.startswith("on_") and channel != "state":
                    self.assertIn(read_text(results.file, f"forces/{name}/{channel}", "role", ""), ROLES, channel)

    def test_the_parameters_of_every_kind_are_those_of_the_reference(self):
        results, named = self.open("rigid.h5"), read_names("parameters")
        found: dict = {}
        for group in ("joints", "forces"):
            for name, element in read_elements(results, group).items():
                where = f"model/resolved/{group}/{name}/parameters"
                attributes = {one for one in results.file.attributes(where) if not one.endswith("_unit")}
                found.setdefault(element.kind, set()).update(attributes, results.file.names(where))
        self.assertEqual(set(found), set(named))
        for kind, names in found.items():
            self.assertEqual(list_differences(names, named[kind]), [], kind)

    def test_the_channels_of_every_kind_are_those_of_the_reference(self):
        results, named = self.open("rigid.h5"), read_names("channels in `/forces/NAME`")
        found: dict = {}
        for name, element in read_elements(results, "forces").items():
            channels = {one for one in results.file.names(f"forces/{name}") if not one.startswith("on_")} - {"state"}
            found.setdefault(element.kind, set()).update(channels)
        self.assertEqual(set(found), set(named))
        for kind, names in found.items():
            self.assertEqual(list_differences(names, named[kind]), [], kind)

    def test_the_reference_says_what_the_coordinate_of_every_joint_is(self):
        text = (ROOT / "dynamics/output/results.md").read_text(encoding="utf-8")
        (row,) = re.findall(r"^\| `/joints/NAME/coordinate`.*", text, re.MULTILINE)
        results = self.open("rigid.h5")
        for name, element in read_elements(results, "joints").items():
            has_none = not results.file.has_dataset(f"joints/{name}/coordinate")
            self.assertIn(f"`{element.kind}`{' has none' if has_none else ''}", row)

    def test_ride_and_report_accept_all_of_them(self):
        results = self.open("rigid.h5")
        _, types = read_reference()
        for group, kinds in (("joints", types["joints"] | {"motion"}), ("forces", types["forces"])):
            self.assertEqual({one.kind for one in read_elements(results, group).values()}, kinds)
        ride = self.run_tool("ride", "rigid.h5", "--superelements", SUPERELEMENTS)
        self.assert_succeeds(ride)
        for name in ("front_suspension", "rear_tyre", "largest moment"):
            self.assertIn(name, ride.stdout)
        self.assert_succeeds(self.run_tool("report", "rigid.h5", "-o", "page.html"))

    def test_the_moments_of_a_rigid_frame_are_those_of_the_flexible_one_in_balance(self):
        # The deflection of the flexible frame of some millimetres changes the loads a little.
        rigid, flexible = self.open("rigid.h5"), self.open("flexible.h5")
        moments, stations = calc_rigid_moments(rigid, "frame", read_superelement(Path(SUPERELEMENTS) / "chassis.h5"))
        expected, _ = flexible.history("recovery/frame/moment_from_loads")
        np.testing.assert_array_equal(stations, flexible.history("recovery/frame/station")[0])
        largest = np.abs(expected[0]).max()
        self.assertGreater(largest, 1e4)  # N·m
        np.testing.assert_allclose(moments[0], expected[0], rtol=0, atol=0.03 * largest)

    def test_the_moments_of_a_rigid_frame_are_those_that_the_run_itself_computes_from_the_loads(self):
        rigid = self.open("rigid.h5")
        moments, _ = calc_rigid_moments(rigid, "frame", read_superelement(Path(SUPERELEMENTS) / "chassis.h5"))
        expected, _ = rigid.history("recovery/frame/moment_from_loads")
        np.testing.assert_allclose(moments, expected, rtol=0, atol=1e-8 * np.abs(expected).max())

    def test_where_section_loads_are_missing_too_small_moments_of_a_rigid_frame_are_remarked_on(self):
        shutil.copy(self.made / "rigid.h5", self.folder / "bare.h5")
        with h5py.File(self.folder / "bare.h5", "a") as file:
            del file["recovery/frame"]
        whole, short = self.folder / "whole", self.folder / "short"
        for folder in (whole, short):
            folder.mkdir()
            shutil.copy(Path(SUPERELEMENTS) / "chassis.h5", folder)
        with h5py.File(short / "chassis.h5", "a") as file:
            del file["section_loads"]
            file.attrs["num_elastic_dofs"] += 1
        remark = "frame: the moment may be too small: short/chassis.h5 has no section loads, and 36 of the 37 vectors"
        rows = {}
        for folder, is_remarked in (("whole", False), ("short", True)):
            process = self.run_tool("ride", "x=bare.h5", "--superelements", folder)
            self.assert_succeeds(process)
            self.assertEqual(f"remark: x: {remark}" in process.stdout, is_remarked)
            (rows[folder],) = [line.split() for line in process.stdout.splitlines() if line.startswith("frame ")]
        printed = self.run_tool("ride", "x=rigid.h5").stdout
        (expected,) = [line.split() for line in printed.splitlines() if line.startswith("frame ")]
        self.assertEqual(rows["whole"][:5], expected[:5])
        self.assertNotEqual(rows["short"][:5], expected[:5])


if __name__ == "__main__":
    unittest.main()
