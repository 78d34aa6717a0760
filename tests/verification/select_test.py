#!/usr/bin/python3
"""Modes chosen from the forcing: the truck against its full basis, and the report of the choice."""

import json
import os
import re
import unittest

import h5py
import numpy as np

from response_case import overrides
from verification_case import ROOT, VerificationCase, run_program

TRUCK = ROOT / "dynamics/models/truck"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]
AUTO = ["--set", 'modes.chassis="auto"']


class Truck(VerificationCase):
    def select(self, run, *arguments):
        """What was chosen."""
        command = (TRUCK / f"{run}.toml", *AUTO, *arguments)
        return self.program("select-modes", *command, superelements=TRUCK_SUPERELEMENTS)["mode_choice"]

    def run_truck(self, run, *arguments):
        return self.run_to_results(TRUCK / f"{run}.toml", *arguments, superelements=TRUCK_SUPERELEMENTS)

    @staticmethod
    def kept(report):
        return [(mode["body"], mode["number"]) for mode in report["modes"] if mode["kept"]]

    def test_terrain_run_within_one_percent_of_the_full_basis(self):
        full = self.run_truck("terrain", "--set", 'modes.chassis="all"').summary
        results = self.run_truck("terrain", *AUTO)
        auto = results.summary
        for point in ("chassis.origin", "chassis.seat"):
            with self.subTest(point):
                rms = [summary["points"][point]["acceleration"]["rms"] for summary in (auto, full)]
                self.assert_close(rms[0], rms[1], relative=0.01)
        # Fewer modes; two of them are too few.
        chosen = results["model/mode_choice/kept"].sum()
        self.assertEqual(len(results["model/mode_choice/kept"]), 36)
        self.assertEqual(results.file["bodies/chassis/modal/amplitude"].shape[1], chosen)
        self.assertLess(chosen, 18)
        two = self.run_truck("terrain", "--set", "modes.chassis=2").summary
        rms = (
            two["points"]["chassis.origin"]["acceleration"]["rms"]
            / full["points"]["chassis.origin"]["acceleration"]["rms"]
        )
        self.assertGreater(abs(rms - 1.0), 0.05)
        self.assertLess(auto["evaluations"], 0.8 * full["evaluations"])

    def test_the_predicted_share_is_that_of_a_run(self):
        # A terrain of a twentieth of its height, where the truck is nearly linear but for the damper, made equal both
        # ways.
        s, height = np.loadtxt(TRUCK / "terrain_road.txt", unpack=True)
        road = self.folder / "low.txt"
        np.savetxt(road, np.column_stack([s, height / 20.0]), fmt="%.12g")
        damper = "{ coefficient = 11527.5 }"
        setting = [
            *overrides(**{f"vehicle__forces__{end}_suspension__damper": damper for end in ("front", "rear")}),
            *overrides(road=f"{{ shape = 'table', start = 1.0, file = '{road}' }}", integrator__relative_tolerance=1e-9,
                       mode_choice__tolerance=0.05),
        ]  # fmt: skip
        report = self.select("terrain", *setting)
        self.assertEqual(report["neglected_of"], "peak acceleration of chassis.seat")
        runs = {}
        for modes in ('"all"', '"auto"'):
            runs[modes] = self.run_truck("terrain", *setting, "--set", f"modes.chassis={modes}")[
                "points/chassis.seat/acceleration"
            ]
        difference = np.hypot(*(runs['"auto"'] - runs['"all"']).T)
        neglected = difference.max() / np.hypot(*runs['"all"'].T).max()
        self.assert_close(neglected, report["neglected"], relative=0.15)

    def test_dampers_with_two_rates_are_remarked(self):
        # The same terrain and the truck's own dampers: what their kinks excite is not in the prediction, and the remark
        # estimates it from the linear motion.
        s, height = np.loadtxt(TRUCK / "terrain_road.txt", unpack=True)
        road = self.folder / "low.txt"
        np.savetxt(road, np.column_stack([s, height / 20.0]), fmt="%.12g")
        setting = overrides(road=f"{{ shape = 'table', start = 1.0, file = '{road}' }}", mode_choice__tolerance=0.05)
        report = self.select("terrain", *setting)
        (remark,) = report["remarks"]
        self.assertIn("forces of 'front_suspension', 'rear_suspension' are beyond that", remark)
        told = float(re.search(r"left out ([0-9.]+) % of the peak acceleration of chassis.seat", remark)[1]) / 100.0
        seat = [
            self.run_truck("terrain", *setting, "--set", f"modes.chassis={modes}")["points/chassis.seat/acceleration"]
            for modes in ('"all"', '"auto"')
        ]
        true = np.hypot(*(seat[0] - seat[1]).T).max() / np.hypot(*seat[0].T).max()
        self.assertGreater(true, 2.0 * report["neglected"])
        self.assert_close(told, true, relative=0.5)

    def test_the_predicted_share_of_moments_is_that_of_a_run(self):
        # The truck on the terrain of a twentieth of its height, as above; moments alone judge, by their norm over the
        # places where the moment of a mode is the largest.
        s, height = np.loadtxt(TRUCK / "terrain_road.txt", unpack=True)
        road = self.folder / "low.txt"
        np.savetxt(road, np.column_stack([s, height / 20.0]), fmt="%.12g")
        damper = "{ coefficient = 11527.5 }"
        setting = [
            *overrides(**{f"vehicle__forces__{end}_suspension__damper": damper for end in ("front", "rear")}),
            *overrides(road=f"{{ shape = 'table', start = 1.0, file = '{road}' }}", integrator__relative_tolerance=1e-9,
                       mode_choice__tolerance=0.05, vehicle__modes__judge="['moments']",
                       output__store="{ recovery = 'all' }", output__precision="'double'"),
        ]  # fmt: skip
        report = self.select("terrain", *setting)
        self.assertEqual(report["neglected_of"], "peak bending moments of chassis")
        with h5py.File(f"{TRUCK_SUPERELEMENTS}/chassis.h5") as file:
            moments = file["resultants"][:, [2, 5], :]  # at both ends of each element, by mode
        places = np.unique(np.abs(moments).reshape(-1, moments.shape[2]).argmax(axis=0))
        runs = {
            modes: self.run_truck("terrain", *setting, "--set", f"modes.chassis={modes}")[
                "recovery/chassis/moment_from_loads"
            ][:, places]
            for modes in ('"all"', '"auto"')
        }
        difference = np.linalg.norm(runs['"auto"'] - runs['"all"'], axis=1)
        size = np.linalg.norm(runs['"all"'] - runs['"all"'][0], axis=1)
        self.assert_close(difference.max() / size.max(), report["neglected"], relative=0.15)

    def test_the_quantities_that_judge_are_those_of_the_vehicle_file(self):
        kinds = {"points": ("displacement ", "acceleration "), "moments": ("bending moments ",),
                 "forces": ("force ", "torque "), "reactions": ("reaction ",)}  # fmt: skip
        for kind, names in kinds.items():
            with self.subTest(kind):
                report = self.select("terrain", *overrides(vehicle__modes__judge=f"['{kind}']"))
                words = report["neglected_of"].split(" ", 1)
                self.assertTrue(words[1].startswith(names), report["neglected_of"])

    def test_the_faster_the_more_modes(self):
        slow, fast = (self.select("terrain", *overrides(speed=speed)) for speed in (1.0, 7.5))
        self.assertLess(len(self.kept(slow)), len(self.kept(fast)))
        self.assertLess(set(self.kept(slow)), set(self.kept(fast)))

    def test_several_bodies_share_one_tolerance(self):
        report = self.select("terrain", "--set", 'modes.front_long_arm="auto"')
        self.assertEqual({mode["body"] for mode in report["modes"]}, {"chassis", "front_long_arm"})
        self.assertLess(report["neglected"], 0.01)
        kept = set(self.kept(report))
        for body, numbers in (("chassis", range(1, 37)), ("front_long_arm", range(1, 7))):
            frequency = {mode["number"]: mode["frequency"] for mode in report["modes"] if mode["body"] == body}
            for number in numbers:
                for other in numbers:  # equal frequencies stay together
                    if abs(frequency[number] / frequency[other] - 1.0) < 1e-6:
                        self.assertEqual((body, number) in kept, (body, other) in kept)

    def test_tolerance_zero_keeps_all(self):
        report = self.select(
            "terrain", *overrides(mode_choice__tolerance=0, duration=2.0, statistics="{ from = 0, to = 2 }")
        )
        self.assertEqual(len(self.kept(report)), 36)

    def test_bump_run_has_the_peaks_of_the_full_basis(self):
        tolerance = 0.01
        full = self.run_truck("bump", "--set", 'modes.chassis="all"')
        peaks = self.largest_values(full)
        full.file.close()
        auto = self.run_truck("bump", *AUTO)
        kept = auto["model/mode_choice/kept"].sum()
        self.assertLess(kept, 36)
        self.assertGreater(kept, 8)
        for name, peak in self.largest_values(auto).items():
            with self.subTest(name):
                self.assert_close(peak, peaks[name], relative=tolerance)

    @staticmethod
    def largest_values(results):
        """Largest values of all watched quantities: points' accelerations, reactions and forces."""
        values = {f"points/{point}": results[f"points/{point}/acceleration"] for point in results.file["points"]}
        for joint in results.file["joints"]:
            values[f"joints/{joint}"] = results[f"joints/{joint}/reaction"][:, :2]
        for force in results.file["forces"]:
            values[f"forces/{force}"] = results[f"forces/{force}/force"][:, np.newaxis]
        return {name: np.max(np.hypot.reduce(value, axis=1)) for name, value in values.items()}

    def test_a_longer_run_over_the_same_bump_chooses_the_same(self):
        short, long = (
            self.select("bump", *overrides(duration=duration, statistics=f"{{ from = 0, to = {duration} }}"))
            for duration in (5.0, 60.0)
        )
        self.assertEqual(self.kept(short), self.kept(long))
        self.assertEqual(short["neglected"], long["neglected"])
        # Its wheels leave the ground, which is reported.
        for report in (short, long):
            lifting, beyond_linear = report["remarks"]
            self.assertRegex(lifting, "static value: 'front_tyre' by 3[0-9.]* % of it.*leave the ground")
            self.assertIn("forces of 'front_suspension', 'rear_suspension' are beyond that", beyond_linear)
        # A tyre that also pulls never does.
        tyre = {"vehicle__forces__front_tyre__spring": "{ polynomial = [0.0, 1e6] }"}
        for one_sided, lifts in (("true", True), ("false", False)):
            pulls = self.select("bump", *overrides(vehicle__forces__front_tyre__one_sided=one_sided, **tyre))
            found = re.search("'front_tyre'.*leave the ground", " ".join(pulls["remarks"]))
            self.assertEqual(found is not None, lifts, pulls["remarks"])
        slow = self.select("terrain", *overrides(speed=1.0))
        self.assertNotIn("leave the ground", " ".join(slow["remarks"]))

    def test_without_motion_the_weight_alone_decides(self):
        report = self.select("terrain", *overrides(speed=0))
        remark = "neither road nor forces in time move the vehicle: modes are judged by their effect under"
        self.assertEqual(report["remarks"], [f"{remark} the weight alone"])
        self.assertGreater(len(self.kept(report)), 1)
        for mode in report["modes"]:
            self.assertLessEqual(mode["share"]["static"], 1.0)
            self.assertEqual(mode["share"]["acceleration_rms"], 0.0)

    def test_another_numbering_of_the_nodes_changes_nothing(self):
        # The same chassis, numbered from its rear end: all of its modes are pairs, of which any turn would do.
        design = (ROOT / "meshes/truck/chassis.toml").read_text(encoding="utf-8")
        lines = re.search(r"\[points\]\n(.*?)\n\n", design, re.DOTALL).group(1)  # nodes are numbered in this order
        self.assertGreater(lines.count("\n"), 10)
        (self.folder / "chassis.toml").write_text(
            design.replace(lines, "\n".join(reversed(lines.split("\n")))), encoding="utf-8"
        )
        other = self.folder / "other"
        designs = ("chassis.toml", ROOT / "meshes/truck/long_arm.toml")
        build = [os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", other]
        run_program(build, cwd=self.folder, check=True)
        with h5py.File(other / "chassis.h5", "r") as turned, h5py.File(
            f"{TRUCK_SUPERELEMENTS}/chassis.h5", "r"
        ) as straight:
            numbers = [
                dict(zip(map(tuple, file["nodes/position"][:]), file["nodes/id"][:], strict=True))
                for file in (straight, turned)
            ]
            self.assertEqual(numbers[0].keys(), numbers[1].keys())
            self.assertNotEqual(*numbers)
        reports, runs = [], []
        for superelements in (TRUCK_SUPERELEMENTS, other):
            printed = self.program("select-modes", TRUCK / "terrain.toml", *AUTO, superelements=superelements)
            reports.append(printed["mode_choice"])
            results = self.run_to_results(
                TRUCK / "bump.toml",
                # Into the bump at once: while all stands still modes are judged by rounding against rounding.
                *overrides(adaptivity="{ enabled = true }", duration=0.8, road__start=0.01),
                *overrides(statistics="{ from = 0, to = 0.8 }"),
                superelements=superelements)  # fmt: skip
            runs.append((results["bodies/chassis/modal/active"], results["points/chassis.seat/acceleration"]))
            results.file.close()
        for mode, other_mode in zip(*(report["modes"] for report in reports), strict=True):
            self.assertEqual(mode["kept"], other_mode["kept"])
            for name, share in mode["share"].items():
                self.assert_close(other_mode["share"][name], share, relative=1e-4, absolute=1e-9)
        self.assertGreater(runs[0][0].sum(axis=1).max(), 2)
        # The same modes join. The time at which one leaves again may depend on rounding, where its share is at a
        # threshold.
        np.testing.assert_array_equal(runs[1][0].any(axis=0), runs[0][0].any(axis=0))
        self.assertLess(np.mean(runs[1][0] != runs[0][0]), 0.01)
        self.assert_close(runs[1][1], runs[0][1], absolute=0.01 * np.max(np.abs(runs[0][1])))

    def test_says_why_all_are_kept_where_the_forcing_is_not_known(self):
        for setting, why in (
            (overrides(start="'as-given'"), "the run does not start in static equilibrium"),
            (overrides(initial__chassis__angular_velocity=0.1), "[initial] adds motion at the start"),
            (overrides(speed=-3.0), "the vehicle drives backwards over the road"),
        ):
            report = self.select("bump", *setting)
            self.assertEqual(len(self.kept(report)), 36)
            self.assertEqual(report["remarks"], [f"all modes are kept, as {why}"])
            self.assertEqual({mode["reason"] for mode in report["modes"]}, {f"kept: not judged, as {why}"})

    def test_a_run_stores_what_select_modes_and_the_dry_run_show(self):
        short = overrides(duration=0.05, mode_choice__tolerance=0.2)
        report = self.select("bump", *short)
        command = [os.environ["SPRUNG_DYNAMICS"], "run", TRUCK / "bump.toml", "--superelements", TRUCK_SUPERELEMENTS]
        command += [*AUTO, *short, "--dry-run"]
        dry = run_program(command, cwd=self.folder, check=True).stdout
        shown = run_program([*command, "--json"], cwd=self.folder, check=True).stdout
        self.assertEqual(json.loads(shown)["mode_choice"], report)
        results = self.run_truck("bump", *AUTO, *short)
        path = self.folder / "choice.h5"
        self.select("bump", *short, "-o", str(path))
        with h5py.File(path, "r") as choice:
            self.assertEqual(choice.attrs["format"].decode(), "sprung-mode-choice")
            for file in (choice, results.file):
                group = file["model/mode_choice"]
                self.assertEqual(
                    [text.decode() for text in group["reason"]], [mode["reason"] for mode in report["modes"]]
                )
                self.assertEqual(list(group["kept"]), [mode["kept"] for mode in report["modes"]])
                self.assertEqual(group["transfer/chassis.seat"].shape, group["frequency"].shape)
                # A long wave lifts the seat by its height: acceleration ω².
                omega = 2.0 * np.pi * group["frequency"][0]
                self.assert_close(group["transfer/chassis.seat"][0] / omega**2, 1.0, relative=0.1)
        for mode in report["modes"]:
            self.assertIn(mode["reason"], dry)

    def test_refusals(self):
        for arguments, fragment in (
            ((), 'has no body with modes "auto", so there is nothing to choose'),
            ((*AUTO, "-o", "foreign.h5"), "foreign.h5: error: exists and is no file of chosen modes"),
        ):
            (self.folder / "foreign.h5").write_text("mine", encoding="utf-8")
            command = [os.environ["SPRUNG_DYNAMICS"], "select-modes", TRUCK / "bump.toml"]
            process = run_program(
                [*command, "--superelements", TRUCK_SUPERELEMENTS, *arguments], cwd=self.folder
            )
            self.assertEqual(process.returncode, 2)
            self.assertIn(fragment, process.stderr)


if __name__ == "__main__":
    unittest.main()
