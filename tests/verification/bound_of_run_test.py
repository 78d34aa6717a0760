#!/usr/bin/python3
"""What a run may lack because of its superelement, told by the run itself under its own loads."""

import os
import re
import shutil
import unittest
from pathlib import Path

import numpy as np

from verification_case import ROOT, VerificationCase, run_program

BUMP = ROOT / "dynamics/models/truck/bump.toml"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]

PUSHED = """
name = "pushed chassis"
gravity = [0.0, 0.0]
[bodies.chassis]
superelement = "{superelement}"
position = [0.0, 0.0]
[[forces]]
name = "push"
type = "applied"
point = "chassis.{point}"
axes = "following"
force = [0.0, {{ product = [
  {{ harmonic = {{ amplitude = 1000.0, frequency = 52.0 }} }},
  {{ table = [[0.0, 0.0], [0.5, 1.0], [10.0, 1.0]] }},
] }}]
"""
PUSHED_RUN = """
start = "as-given"
duration = 2.0
output_step = 1e-3
[modes]
chassis = "all"
[modal_damping]
chassis = 0.02
[integrator]
relative_tolerance = 1e-8
"""


class Bound(VerificationCase):
    def build(self, **changes):
        """Builds the certified chassis with other values of `[reduction]`: name → (old, new)."""
        design = (ROOT / "meshes/truck/chassis_certified.toml").read_text(encoding="utf-8")
        for name, (old, new) in changes.items():
            self.assertEqual(design.count(old), 1)
            (self.folder / f"{name}.toml").write_text(design.replace(old, new), encoding="utf-8")
        files = [f"{name}.toml" for name in changes]
        run_program([os.environ["SPRUNG_REDUCE"], "build", *files, "--output-dir", "."], cwd=self.folder, check=True)

    def push(self, superelement, point="rear_spring"):
        run = self.write_model(PUSHED.format(superelement=superelement, point=point), PUSHED_RUN)
        return self.run_to_results(run, superelements=self.folder)

    # Truth: all 36 motions of the model. The force is within the band, so that all that is missing is, too.
    def test_it_is_above_what_the_basis_misses_and_warns_where_that_is_much(self):
        tolerance = "tolerance = 0.01 "
        self.build(truth=("= 60.0", "= 1e5"), loose=(tolerance, "tolerance = 0.5 "), good=(tolerance, tolerance))
        truth = self.push("truth")
        self.assertEqual(truth.summary["certified"]["chassis"]["of_rms_acceleration"], 0.0)
        for name, warns in (("loose", True), ("good", False)):
            results = self.push(name)
            found = results.summary["certified"]["chassis"]
            self.assertEqual((found["highest_frequency"], found["outside_of_interface"]), (60.0, ""))
            series = f"points/{found['point']}/acceleration"
            missing = (results[series] - truth[series])[:, "xy".index(found["axis"])]
            share = np.sqrt(np.mean(missing**2) / np.mean(np.sum(truth[series] ** 2, axis=1)))
            self.assertLess(share, found["of_rms_acceleration"])
            self.assertGreater(share, 0.1 * found["of_rms_acceleration"])
            told = [one["text"] for one in results.summary["warnings"] if "its superelement may miss" in one["text"]]
            self.assertEqual(bool(told), warns, results.summary["warnings"])

    def test_the_advice_depends_on_whether_modes_or_the_basis_miss_moments(self):
        """All vectors of the loose superelement miss about 9 % of the moment over the bump: more modes do not help."""
        self.build(loose=("tolerance = 0.01 ", "tolerance = 0.5 "), good=("= 60.0", "= 60.0"))
        shutil.copy(Path(TRUCK_SUPERELEMENTS) / "long_arm.h5", self.folder)
        reduce_it = "reduce it with a smaller tolerance, or up to a higher frequency, and take moments from the loads"
        for name, modes, advice in (
            ("loose", "6", r"; all vectors of its superelement would miss 9\.\d+ %, so " + reduce_it),
            ("loose", '"all"', "; " + reduce_it),
            ("good", "6", '; take more modes, modes.chassis = "certified" takes all'),
        ):
            settings = (f"vehicle.bodies.chassis.superelement={name}", f"modes.chassis={modes}", "duration=1",
                        "statistics.to=1")  # fmt: skip
            words = [word for setting in settings for word in ("--set", setting)]
            found = self.program("run", BUMP, *words, superelements=self.folder)
            (text,) = (one["text"] for one in found["warnings"] if "chassis: its modes miss" in one["text"])
            self.assertRegex(text, r"chassis: its modes miss 9\.\d+ % of the largest bending moment .*" + advice
                             if name == "loose" else advice)  # fmt: skip

    def test_what_is_above_the_band_is_warned_of_where_it_is_much(self):
        """The bump's kinks excite the chassis above 60 Hz. The truth has 36 modes: the acceleration of the seat differs
        by a tenth, nearly all of it above 60 Hz. A band up to 1 kHz contains it."""
        self.build(band=("= 60.0", "= 60.0"), wide=("= 60.0", "= 1e3"), truth=("= 60.0", "= 1e5"))
        shutil.copy(Path(TRUCK_SUPERELEMENTS) / "long_arm.h5", self.folder)
        found = {}
        for name in ("band", "wide", "truth"):
            settings = (f"vehicle.bodies.chassis.superelement={name}", 'modes.chassis="all"', "duration=1.5",
                        "statistics.to=1.5")  # fmt: skip
            words = [word for setting in settings for word in ("--set", setting)]
            found[name] = self.run_to_results(BUMP, *words, superelements=self.folder)
        series = "points/chassis.seat/acceleration"
        truth = found["truth"][series][:, 1]
        for name, warns in (("band", True), ("wide", False)):
            missing = found[name][series][:, 1] - truth
            share = np.sqrt(np.mean(missing**2) / np.mean(truth**2))
            self.assertEqual(share > 0.05, warns, share)
            texts = [one["text"] for one in found[name].summary["warnings"]]
            told = [one for one in texts if re.match(r"chassis: \d+(\.\d)? % of the r.m.s. .* is above 60 Hz", one)]
            self.assertEqual(bool(told), warns, texts)

    def test_the_end_of_a_run_counts(self):
        """The bump is met at 0.57 s: after the first 512 outputs, and within the last 256 of 0.76 s."""
        settings = ("vehicle.bodies.chassis.superelement=chassis_certified", 'modes.chassis="certified"',
                    "road.start=1.7", "output_step=1e-3")  # fmt: skip
        shares = []
        for duration in (0.76, 0.78):
            words = [word for setting in (*settings, f"duration={duration}") for word in ("--set", setting)]
            results = self.run_to_results(BUMP, *words, superelements=Path(TRUCK_SUPERELEMENTS))
            shares.append(results.summary["certified"]["chassis"]["of_rms_acceleration"])
        self.assertGreater(shares[0], 0.5 * shares[1])
        self.assertGreater(shares[1], 1e-3)

    def test_damping_that_an_installed_body_loses_is_told(self):
        """The chassis clamped at its rear end bends far below its free modes. Nothing else damps it, so that the ratio
        told is that of the mode; asked for is 1 %."""
        vehicle = (
            'name = "held"\ngravity = [0.0, 0.0]\n[ground.points]\nwall = [3.8257, 0.0]\n'
            '[bodies.chassis]\nsuperelement = "chassis_certified"\nposition = [0.0, 0.0]\n'
            '[[joints]]\nname = "weld"\ntype = "fixed"\na = "ground.wall"\nb = "chassis.rear_end"\n'
        )
        run = self.write_model(vehicle, 'duration = 1.0\n[modes]\nchassis = "all"\n')
        printed = self.program("modes", run, superelements=TRUCK_SUPERELEMENTS)
        first = printed["modes"][0]
        self.assertLess(first["damping_ratio"], 0.004)
        (text,) = (one["text"] for one in printed["warnings"] if "damps its bending" in one["text"])
        expected = (f"chassis damps its bending in mode 1, {first['undamped_frequency']:.5g} Hz, by a ratio of "
                    f"{first['damping_ratio']:.2g} where 0.01 is asked for")  # fmt: skip
        self.assertTrue(text.startswith(expected), (text, expected))

    def test_a_part_of_a_basis_is_not_proved(self):
        self.build(good=("= 60.0", "= 60.0"))
        run = self.write_model(PUSHED.format(superelement="good", point="rear_spring"), PUSHED_RUN)
        for modes, whole in (('"certified"', True), ("5", False)):
            words = ("--set", f"modes.chassis={modes}")
            found = self.program("run", run, *words, superelements=self.folder)["certified"]["chassis"]
            self.assertEqual(found["proved"], whole)

    def test_the_printed_bound_says_that_it_holds_under_the_loads_of_this_run(self):
        self.build(good=("= 60.0", "= 60.0"))
        run = self.write_model(PUSHED.format(superelement="good", point="rear_spring"), PUSHED_RUN)
        command = [os.environ["SPRUNG_DYNAMICS"], "run", run, "--superelements", self.folder, "--quiet"]
        printed = run_program(command, cwd=self.folder, check=True).stdout
        self.assertRegex(printed, r"basis of chassis misses +under the loads of this run, up to 60 Hz at most \d")

    def test_a_bushing_without_a_law_of_rotation_turns_only_its_first_point(self):
        """Its axes turn with the point a, on which the forces at b have a moment; b bears forces alone."""
        self.build(good=("= 60.0", "= 60.0"))
        bushing = """
[[forces]]
name = "bush"
type = "bushing"
a = "{}"
b = "{}"
x = {{ spring = {{ polynomial = [0.0, 1e6] }} }}
y = {{ spring = {{ polynomial = [0.0, 1e6] }} }}
"""
        for ends, warns in (("ground.origin chassis.rear_spring", False), ("chassis.rear_spring ground.origin", True)):
            vehicle = PUSHED.format(superelement="good", point="rear_spring") + bushing.format(*ends.split())
            run = self.write_model(vehicle, PUSHED_RUN)
            texts = [one["text"] for one in self.program("run", run, superelements=self.folder)["warnings"]]
            told = [one for one in texts if "rear_spring takes loads, but 'rotation' is not" in one]
            self.assertEqual(bool(told), warns, texts)

    def test_a_point_that_the_ground_holds_misses_nothing(self):
        """Its acceleration is zero, of which no share can be missing; the other points do not warn either."""
        self.build(good=("= 60.0", "= 60.0"))
        held = PUSHED.replace("position = [0.0, 0.0]", "position = [0.0, 0.0]\n[[joints]]\nname = \"wall\"\n"
                              'type = "revolute"\na = "ground.origin"\nb = "chassis.middle"\n')  # fmt: skip
        run = self.write_model(held.format(superelement="good", point="rear_spring"), PUSHED_RUN)
        results = self.run_to_results(run, superelements=self.folder)
        self.assertNotEqual(results.summary["certified"]["chassis"]["point"], "chassis.middle")

    def test_a_basis_without_a_bound_that_is_taken_whole_is_warned_of(self):
        """Four clamped vectors miss much of the flexibility at the interface, and so of the acceleration there."""
        design = (ROOT / "meshes/truck/chassis.toml").read_text(encoding="utf-8")
        self.assertEqual(design.count("all = true"), 1)
        (self.folder / "few.toml").write_text(design.replace("all = true", "count = 4"), encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "few.toml"], cwd=self.folder, check=True)
        shutil.copy(Path(TRUCK_SUPERELEMENTS) / "long_arm.h5", self.folder)
        settings = ("vehicle.bodies.chassis.superelement=few", 'modes.chassis="all"', "duration=1", "statistics.to=1")
        words = [word for setting in settings for word in ("--set", setting)]
        summary = self.run_to_results(BUMP, *words, superelements=self.folder).summary
        self.assertFalse(summary["certified"]["chassis"]["proved"])
        texts = [one["text"] for one in summary["warnings"]]
        self.assertTrue(any(re.match(r"chassis: under these loads its superelement misses about \d", text)
                            for text in texts), texts)  # fmt: skip

    def test_loads_that_are_not_in_the_interface_are_named(self):
        self.build(good=("= 60.0", "= 60.0"))
        found = self.push("good", point="front_end").summary["certified"]["chassis"]
        self.assertEqual(found["outside_of_interface"], "chassis.front_end")

    def test_joints_and_forces_outside_of_the_interface_are_warned_of_by_each_verb(self):
        """The basis has no vectors for them, and the certificate says nothing about its error there."""
        self.build(good=("= 60.0", "= 60.0"))
        for point, warns in (("front_end", True), ("rear_spring", False)):
            run = self.write_model(PUSHED.format(superelement="good", point=point), PUSHED_RUN)
            for verb in ("run", "modes", "equilibrium"):
                with self.subTest(point=point, verb=verb):
                    warnings = self.program(verb, run, superelements=self.folder)["warnings"]
                    told = [one["text"] for one in warnings if f"chassis.{point} takes loads, but 'x'" in one["text"]]
                    self.assertEqual(bool(told), warns, warnings)

    def test_all_points_and_what_the_interface_needs_of_them_are_told_at_once(self):
        self.build(good=("= 60.0", "= 60.0"))
        more = PUSHED[PUSHED.index("[[forces]]"):].replace('"push"', '"twist"').replace("{point}", "rear_spring")
        vehicle = (PUSHED + more + "torque = 50.0\n").format(superelement="good", point="front_end")
        warnings = self.program("run", self.write_model(vehicle, PUSHED_RUN), superelements=self.folder)["warnings"]
        (text,) = (one["text"] for one in warnings if "takes loads" in one["text"])
        self.assertIn("chassis.front_end takes loads, but 'x' is not", text)
        self.assertIn("; likewise chassis.rear_spring: ", text)
        needed = re.search(r"\[interface\] of the design also needs (.*)$", text)[1]
        self.assertEqual(sorted(needed.split(", ")), ['front_end = "xy"', 'rear_spring = "xyr"'])

    def test_a_torque_that_is_applied_is_a_load_as_well(self):
        self.build(good=("= 60.0", "= 60.0"))
        beat = "{ harmonic = { amplitude = 1.0, frequency = 2.0 } }"
        for torque, warns in (("0.0", False), ("50.0", True), (beat, True)):
            vehicle = PUSHED.format(superelement="good", point="rear_spring") + f"torque = {torque}\n"
            warnings = self.program("run", self.write_model(vehicle, PUSHED_RUN), superelements=self.folder)["warnings"]
            told = [one["text"] for one in warnings if "chassis.rear_spring takes loads, but 'rotation'" in one["text"]]
            self.assertEqual(bool(told), warns, warnings)


if __name__ == "__main__":
    unittest.main()
