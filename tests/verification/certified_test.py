#!/usr/bin/python3
"""The truck with the certified chassis, against the chassis with all motions of its model."""

import os
import re
import shutil
import unittest
from pathlib import Path

import h5py
import numpy as np

from verification_case import ROOT, VerificationCase, run_program

BUMP = ROOT / "dynamics/models/truck/bump.toml"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]
ALL = ("--set", 'modes.chassis="all"')
CERTIFIED = (
    "--set", "vehicle.bodies.chassis.superelement=chassis_certified",
    "--set", 'modes.chassis="certified"',
)  # fmt: skip


def format_share(share):
    """In %. Below 1e-5 other equilibria count, and the differences by which the vehicle's stiffness is found."""
    return "< 0.001" if abs(share) < 1e-5 else f"{100.0 * share:.2g}"


def keep_up_to_60_hz(values, step=1e-3):
    spectrum = np.fft.rfft(values)
    spectrum[np.fft.rfftfreq(len(values), step) > 60.0] = 0.0
    return np.fft.irfft(spectrum, len(values))


class CertifiedChassis(VerificationCase):
    def truck_modes(self, *arguments):
        return self.modes(BUMP, *arguments, superelements=TRUCK_SUPERELEMENTS)[0]

    def run_truck(self, *arguments):
        return self.run_to_results(
            BUMP, *arguments, "--set", "duration=1.5", "--set", "statistics.to=1.5", superelements=TRUCK_SUPERELEMENTS
        )

    # The 36 clamped modes of the chassis are all motions that its model has: the truth.
    def test_frequencies_in_the_band_are_those_of_the_full_model(self):
        truth = self.truck_modes(*ALL)
        in_band = truth < 2.0 * np.pi * 60.0
        certified = self.truck_modes(*CERTIFIED)
        self.assert_close(certified[: in_band.sum()], truth[in_band], relative=1e-3)

    def test_brackets_hold_every_frequency_of_the_full_model_below_the_end_of_the_band(self):
        for changes in ({}, {"bodies.rear_axle.mass": 900.0}, {"bodies.front_axle.mass": 300.0}):
            changed = [part for key, value in changes.items() for part in ("--set", f"vehicle.{key}={value}")]
            truth = self.truck_modes(*ALL, *changed) / (2.0 * np.pi)
            process = ("modes", BUMP, *CERTIFIED, *changed, "--bracket")
            found = self.program(*process, superelements=TRUCK_SUPERELEMENTS)
            modes = found["modes"]
            self.assertEqual([one["text"] for one in found["warnings"] if "not proved" in one["text"]], [])
            brackets = np.array([mode["bracket"] for mode in modes if "bracket" in mode])
            self.assertGreaterEqual(len(brackets), 7)
            self.assertEqual(len(brackets), np.sum(truth < 60.0))
            rounding = 1e-7 * truth[: len(brackets)]  # of differences of the forces
            self.assertTrue(np.all(brackets[:, 0] <= truth[: len(brackets)] + rounding))
            self.assertTrue(np.all(truth[: len(brackets)] - rounding <= brackets[:, 1]))
            self.assertLess(np.max(brackets[:, 1] / brackets[:, 0] - 1.0), 2e-3)

    # The rows of reduce/README.md: largest differences from the chassis with all motions, for each basis.
    def test_the_table_of_the_vehicle_s_frequencies_is_what_the_bases_give(self):
        design = (ROOT / "meshes/truck/chassis_certified.toml").read_text(encoding="utf-8")
        free = 'basis = "free"'
        rows = {f"clamped {n}": {free: 'basis = "clamped"', "[modes]": f"[modes]\ncount = {n}"} for n in (2, 4, 8, 16)}
        rows |= {f"free, tolerance {tolerance:g}": {"tolerance = 0.01 ": f"tolerance = {tolerance} "}
                 for tolerance in (0.1, 0.01, 0.001)}  # fmt: skip
        rows["fixed interface"] = {free: 'basis = "fixed-interface"'}
        for number, (name, changes) in enumerate(rows.items()):
            changed = design
            for old, new in changes.items():
                self.assertEqual(changed.count(old), 1)
                changed = changed.replace(old, new)
            if not name.startswith("free"):
                changed = re.sub(r"(?m)^tolerance = .*$", "", changed)
            (self.folder / f"basis_{number}.toml").write_text(changed, encoding="utf-8")
        designs = [f"basis_{number}.toml" for number in range(len(rows))]
        run_program([os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", "."], cwd=self.folder, check=True)
        shutil.copy(Path(TRUCK_SUPERELEMENTS) / "long_arm.h5", self.folder)
        truth = self.truck_modes(*ALL)
        wanted = [int(np.argmin(np.abs(truth - 2.0 * np.pi * hz))) for hz in (9.57, 26.5, 52.6)]
        readme = (ROOT / "reduce/README.md").read_text(encoding="utf-8")
        for number, name in enumerate(rows):
            settings = (f"vehicle.bodies.chassis.superelement=basis_{number}", 'modes.chassis="all"')
            words = [word for setting in settings for word in ("--set", setting)]
            found, _ = self.modes(BUMP, *words, superelements=self.folder)
            with h5py.File(self.folder / f"basis_{number}.h5") as file:
                size = len(file["modes/frequency"])
            cells = [format_share(found[k] / truth[k] - 1.0) if k < len(found) else "–" for k in wanted]
            row = f"\n| {name.split(' ')[0] if 'clamped' in name else name} | {size} | {' | '.join(cells)} |\n"
            with self.subTest(row):
                self.assertIn(row, readme)

    def test_there_is_no_bracket_for_a_part_of_a_basis(self):
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "modes", BUMP, "--bracket", "--superelements", TRUCK_SUPERELEMENTS,
             *CERTIFIED[:2], "--set", "modes.chassis=5"],
        )  # fmt: skip
        self.assertEqual(process.returncode, 2)
        self.assertIn("error: body 'chassis' has no bracket of its frequencies: it has 5 of 15 modes", process.stderr)

    # Without damping, since a ratio of clamped modes is another one of free modes; in the certified band.
    def test_a_run_over_the_bump_is_that_of_the_full_model_up_to_60_hz(self):
        undamped = ("--set", "modal_damping.chassis=0")
        truth = self.run_truck(*ALL, *undamped)
        certified = self.run_truck(*CERTIFIED, *undamped)
        for quantity, share in (("position", 1e-3), ("acceleration", 0.02)):
            expected, found = (
                keep_up_to_60_hz(results[f"points/chassis.seat/{quantity}"][:, 1]) for results in (truth, certified)
            )
            self.assertLess(np.std(found - expected), share * np.std(expected))
        self.assertLess(certified.summary["energy_closure"], 1e-3)

    def test_a_number_takes_the_free_modes_first(self):
        results = self.run_truck(*CERTIFIED[:2], "--set", "modes.chassis=5")
        self.assertEqual(results["bodies/chassis/modal/amplitude"].shape[1], 5)


HANGING_ROD = """
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.rod]
material = "steel"
shape = "rectangle"
width = 0.05
height = 0.01
[points]
top = [0, 0]
inside = [0, -1.3]
tip = [0, -4]
[[lines]]
through = ["top", "inside", "tip"]
section = "rod"
elements = 6
[reference]
point = "inside"
[interface]
top = "xy"
"""
BAND = '[reduction]\nbasis = "free"\nhighest_frequency = 3.0\ntolerance = 0.02\n[modes]\ndamping_ratio = 0.0\n'
WHOLE = '[reduction]\nbasis = "clamped"\n[modes]\nall = true\ndamping_ratio = 0.0\n'
HANGING = """
name = "hanging rod"
gravity = [0.0, -9.81]
[bodies.rod]
superelement = "{superelement}"
position = [0.0, -1.3]
[[joints]]
name = "pin"
type = "revolute"
a = "ground.origin"
b = "rod.{point}"
"""


class Hanging(VerificationCase):
    """The weight of a rod turns with its reference node, which is not in its interface."""

    def find_modes(self, superelement, point):
        run = self.write_model(
            HANGING.format(superelement=superelement, point=point), 'duration = 1.0\n[modes]\nrod = "all"\n'
        )
        return self.program("modes", run, "--bracket", superelements=self.folder)

    # Truth: all 36 motions of the model. A pin at the reference node is another load there.
    def test_brackets_are_proved_and_hold_where_the_reference_is_not_in_the_interface(self):
        for name, ending in (("band", BAND), ("whole", WHOLE)):
            (self.folder / f"{name}.toml").write_text(HANGING_ROD + ending, encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "band.toml", "whole.toml"], cwd=self.folder, check=True)
        for point, least in (("top", 2), ("inside", 1)):
            with self.subTest(point=point):
                truth = [mode["undamped_frequency"] for mode in self.find_modes("whole", point)["modes"]]
                found = self.find_modes("band", point)
                self.assertEqual([one["text"] for one in found["warnings"] if "not proved" in one["text"]], [])
                brackets = [(k, *mode["bracket"]) for k, mode in enumerate(found["modes"]) if "bracket" in mode]
                self.assertGreaterEqual(len(brackets), least)
                for k, lower, upper in brackets:
                    self.assertTrue((1.0 - 2e-7) * lower <= truth[k] <= (1.0 + 2e-7) * upper, (lower, truth[k], upper))


class AllVectors(VerificationCase):
    """A vehicle does not depend on the basis of a body, nor on where the body is held, if the basis has all motions."""

    PLACES = {"middle": 0.0, "front_end": -3.8257, "front_spring": -2.175, "rear_1617": 1.617, "rear_long_pivot": 1.059}
    MIDDLE = (3.675, 0.975)  # of the chassis, in the vehicle file

    def build(self):
        """Builds the chassis with all vectors, without damping, which a ratio gives to each basis in another way.
        Returns names of superelements with their reference points."""
        design = (ROOT / "meshes/truck/chassis_certified.toml").read_text(encoding="utf-8")
        design = design[: design.index("[reduction]")]
        modes, middle = "[modes]\ndamping_ratio = 0.0\n", 'point = "middle"'
        designs = {
            f"clamped_{place}": (place, f"{design.replace(middle, middle.replace('middle', place))}{modes}all = true\n")
            for place in self.PLACES
        }
        for basis in ("free", "fixed-interface"):
            wanted = f'[reduction]\nbasis = "{basis}"\nhighest_frequency = 1e5\n'
            designs[basis] = ("middle", design + wanted + modes)
        for name, (_, text) in designs.items():
            (self.folder / f"{name}.toml").write_text(text, encoding="utf-8")
        files = [ROOT / "meshes/truck/long_arm.toml", *(f"{name}.toml" for name in designs)]
        build = [os.environ["SPRUNG_REDUCE"], "build", *files, "--output-dir", "."]
        run_program(build, cwd=self.folder, check=True)
        return {name: place for name, (place, _) in designs.items()}

    def run_over_small_bump(self, name, place):
        """Displacements of a seat beside the chassis and of its end, from the start."""
        x, y = self.MIDDLE
        results = self.run_to_results(
            BUMP, "--set", f"vehicle.bodies.chassis.superelement={name}", "--set", 'modes.chassis="all"',
            "--set", f"vehicle.bodies.chassis.position=[{x + self.PLACES[place]}, {y}]", "--set", "duration=1.0",
            "--set", "statistics.to=1.0", "--set", "road.height=0.02", superelements=self.folder,
        )  # fmt: skip
        self.assertEqual(results["bodies/chassis/modal/amplitude"].shape[1], 36)
        places = np.hstack([results[f"points/chassis.{point}/position"] for point in ("seat", "rear_end")])
        return places - places[0]

    # Linear bending is described in the body's frame, so that another frame changes terms of second order in the
    # deflection: over a bump of 2 cm they are below the tolerance of the run, 1e-6.
    def test_runs_agree_to_their_tolerance_for_each_basis_and_clamped_at_five_places(self):
        runs = {name: self.run_over_small_bump(name, place) for name, place in self.build().items()}
        expected = runs.pop("clamped_middle")
        size = np.max(np.abs(expected))
        self.assertGreater(size, 0.02)
        for name, found in runs.items():
            self.assertLess(np.max(np.abs(found - expected)), 1e-6 * size, name)


if __name__ == "__main__":
    unittest.main()
