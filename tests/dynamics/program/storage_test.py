#!/usr/bin/python3
"""What the results file of a run holds: all that fits, or what [output] asks for; and what the tools make of it."""

import json
import re
import sys
import unittest

import h5py
import numpy as np
from dynamics_test_case import ROOT, DynamicsTestCase, run_program

sys.path.insert(0, str(ROOT / "tools"))

from sprung_tools.files.errors import InputError  # noqa: E402  after the path
from sprung_tools.files.results_file import open_results  # noqa: E402
from sprung_tools.runs.stored_histories import list_gaps  # noqa: E402

RUN = ("--set", "duration=0.5", "--set", "modes.chassis=4")
MOTIONS = ("position", "velocity", "acceleration")
UNIT = 6e-8  # relative error of a number of single precision
NO_HISTORIES = 0.35e6  # bytes of what is no history, of the truck


class Storage(DynamicsTestCase):
    def run_with(self, name, *settings, verbose=False):
        """Runs to a file. Returns what the run printed."""
        words = [word for setting in settings for word in ("--set", setting)]
        process = self.run_program(*RUN, *words, "-o", name, *(() if verbose else ("--quiet",)))
        self.assertEqual(process.returncode, 0, process.stderr)
        return process.stdout

    def open(self, name):
        results = open_results(self.folder / name)
        self.addCleanup(results.file.close)
        return results

    def test_motions_that_are_not_stored_are_those_of_a_file_that_has_them(self):
        self.run_with("all.h5")
        self.run_with("few.h5", "output.store.points=reported", "output.precision=single")
        whole, few = self.open("all.h5"), self.open("few.h5")
        points = [name for name in whole.names("points") if not few.file.has_group(f"points/{name}")]
        self.assertIn("chassis.rear_spring", points)  # of a flexible body
        self.assertIn("front_short_arm.axle_end", points)
        self.assertEqual(whole.names("points"), few.names("points"))
        datasets = [f"points/{point}/{what}" for point in points for what in (*MOTIONS, "deflection")]
        datasets += [f"bodies/{body}/center_of_mass/{what}" for body in whole.names("bodies") for what in MOTIONS]
        for name in datasets:
            self.assertEqual(few.has(name), whole.has(name), name)
            if whole.has(name):
                self.assertFalse(few.file.has_dataset(name))
                exact, unit = whole.history(name)
                found, found_unit = few.history(name)
                self.assertEqual(found_unit, unit)
                # Errors of rounding of the body's motion, which is larger than that of some of its points.
                error = 40 * UNIT * (np.abs(exact).max() + 1.0)
                np.testing.assert_allclose(found, exact, rtol=0, atol=error, err_msg=name)
        self.assertEqual(list_gaps(few), [])

    def test_single_precision_changes_values_by_rounding_only_and_coarse_steps_leave_rows_out(self):
        self.run_with("all.h5", "output.precision=double", "output.size=1000")
        self.run_with("small.h5", "output.precision=single", "output.step.forces=0.005", "output.step.recovery=0.01")
        with h5py.File(self.folder / "all.h5") as whole, h5py.File(self.folder / "small.h5") as small:
            for name, every in {"bodies/chassis/acceleration": 1, "forces/front_tyre/force": 5,
                                "recovery/chassis/moment": 10, "forces/front_tyre/on_wheel": 1}.items():  # fmt: skip
                expected = whole[name][::every]
                self.assertEqual(small[name].dtype, np.float32)
                self.assertEqual(small[name].attrs.get("every", 1), every)
                np.testing.assert_allclose(small[name][()], expected, rtol=UNIT, atol=1e-30, err_msg=name)
            for name in ("time", "energy/strain", "last_state/velocities"):
                np.testing.assert_array_equal(small[name][()], whole[name][()])
        small = self.open("small.h5")
        force, _ = small.series("forces/front_tyre/force")
        self.assertEqual(force.size, small.time.size)
        self.assertAlmostEqual(force[2], 0.6 * force[0] + 0.4 * force[5], delta=1e-6 * abs(force[0]))
        self.assertEqual(list_gaps(small), ["stress resultants stored every 10 ms", "forces stored every 5 ms"])
        with self.assertRaisesRegex(InputError, "'forces/front_tyre/force' is stored every 5 ms only"):
            small.check_every_output("forces/front_tyre/force")

    def test_a_history_of_coarse_steps_reaches_to_the_end_of_the_run(self):
        self.run_with("all.h5", "output.precision=double", "output.size=1000")
        self.run_with("coarse.h5", "output.precision=double", "output.step.forces=0.007")
        whole, coarse = self.open("all.h5"), self.open("coarse.h5")
        exact, found = (one.series("forces/front_tyre/force")[0] for one in (whole, coarse))
        last = exact.size - 1
        self.assertNotEqual(last % 7, 0)
        self.assertEqual(coarse.file.shape("forces/front_tyre/force"), (last // 7 + 2,))
        self.assertEqual(found[[0, 7, last]].tolist(), exact[[0, 7, last]].tolist())
        # Between the last two rows the values lie on a line.
        rows = np.arange(last // 7 * 7, last + 1)
        np.testing.assert_allclose(found[rows], np.interp(rows, rows[[0, -1]], exact[rows[[0, -1]]]), rtol=1e-12)
        self.assertGreater(rows.size, 2)

    def test_the_size_of_the_file_is_said_and_kept(self):
        said = self.run_with("small.h5", "output.size=0.7", verbose=True)
        self.assertRegex(said, r"Results: about 0\.\d+ MB; for output\.size = 0\.7 MB: only points of the summary .*; "
                               r"single precision")  # fmt: skip
        self.assertLess((self.folder / "small.h5").stat().st_size, 0.7e6 + NO_HISTORIES)
        (told,) = re.findall(r"Results: about (\d\.\d) MB\n", self.run_with("all.h5", verbose=True))
        size = (self.folder / "all.h5").stat().st_size
        self.assertGreater(size, 2e6)
        self.assertAlmostEqual(1e6 * float(told) / size, 1.0, delta=0.15)

    def test_a_dry_run_says_the_size_that_the_run_says(self):
        self.run_with("first.h5")
        for settings in (("output.size=0.7",), ("adaptivity.indicator=false",),
                         (f'continue_from="{self.folder}/first.h5"', "duration=0.6")):  # fmt: skip
            with self.subTest(settings):
                said = self.run_with("whole.h5", *settings, verbose=True)
                words = [*RUN, *(word for setting in settings for word in ("--set", setting))]
                before = sorted(self.folder.iterdir())
                dry = self.run_program(*words, "--dry-run")
                self.assertEqual(dry.returncode, 0, dry.stderr)
                self.assertEqual(sorted(self.folder.iterdir()), before)
                (line,) = re.findall("Results: (?:less|about).*", dry.stdout)
                self.assertIn(f"{line}\n", said)
                run, dry = (
                    json.loads(self.run_program(*words, "--json", *last).stdout)["storage"]
                    for last in (("-o", "whole.h5"), ("--dry-run",))
                )
                self.assertEqual(run, dry)
        rows = 101  # of the last run, which begins after 0.5 s
        with h5py.File(self.folder / "whole.h5") as file:
            self.assertEqual(file["time"].size, rows)
        # The histories alone: what a file has more than one in which none of these groups is stored.
        groups = ("points", "bodies", "joints", "forces", "wrenches", "recovery")
        nothing = "output.store={" + ", ".join(f'{group}="none"' for group in groups) + "}"
        words += ["--set", nothing]
        rest = json.loads(self.run_program(*words, "--json", "-o", "rest.h5").stdout)["storage"]
        size, size_of_rest = ((self.folder / name).stat().st_size for name in ("whole.h5", "rest.h5"))
        self.assertAlmostEqual((dry["size"] - rest["size"]) / (size - size_of_rest), 1.0, delta=0.1)

    def test_a_file_has_no_space_for_more_rows(self):
        """The last chunk of double precision is stored whole: a run with 1101 rows had space for 2048."""
        for number, duration in ((21, 0.02), (1025, 1.024), (1101, 1.1), (2201, 2.2)):
            said = self.run_with("short.h5", f"duration={duration}", "output.precision=double", verbose=True)
            with h5py.File(self.folder / "short.h5") as file:
                rows = file["time"].size
                self.assertEqual(rows, number)
                for name in ("time", "bodies/chassis/position", "recovery/chassis/moment",
                             "points/chassis.seat/velocity"):  # fmt: skip
                    with self.subTest(rows=rows, name=name):
                        data = file[name]
                        row = data.dtype.itemsize * data[0].size
                        checksum, chunks = 4, -(-rows // 1024)
                        self.assertLessEqual(data.id.get_storage_size(), (rows + 2 * chunks) * row + chunks * checksum)
            if rows > 1000:
                (told,) = re.findall(r"Results: about (\d+\.?\d*) MB", said)
                self.assertAlmostEqual((self.folder / "short.h5").stat().st_size / 1e6, float(told), delta=0.7)

    def test_tools_say_what_is_not_stored(self):
        self.run_with("few.h5", *(f"output.store.{group}=none" for group in ("joints", "wrenches", "recovery")),
                      'output.store.forces=["front_tyre"]')  # fmt: skip
        ride = run_program([ROOT / "tools/ride", "few.h5"], cwd=self.folder)
        self.assertEqual(ride.returncode, 0, ride.stderr)
        for words in ("joints not stored: all", "forces not stored: front_suspension, rear_suspension, rear_tyre",
                      "stress resultants not stored: all"):  # fmt: skip
            self.assertIn(f"remark: chassis 4 modes: {words}", ride.stdout)
        self.assertIn("front_tyre", ride.stdout)
        export = run_program(
            [ROOT / "tools/export_csv", "few.h5", "-o", "a.csv", "--show", "joints/front_long_axle/reaction.1"],
            cwd=self.folder,
        )  # fmt: skip
        self.assertEqual(export.returncode, 2)
        self.assertIn("few.h5: error: 'joints/front_long_axle/reaction' is not stored; 'joints' in [output.store] of "
                      "the run file chooses what is", export.stderr)  # fmt: skip
        paraview = run_program([ROOT / "tools/export_paraview", "few.h5", "-o", "few.pvd", "--every", "0.1"],
                               cwd=self.folder)  # fmt: skip
        self.assertEqual(paraview.returncode, 0, paraview.stderr)
        self.assertIn(": stress resultants not stored: all", paraview.stdout)
        page = run_program([ROOT / "tools/report", "few.h5", "-o", "page.html"], cwd=self.folder)
        self.assertEqual(page.returncode, 0, page.stderr)
        self.assertIn("stress resultants not stored: all", (self.folder / "page.html").read_text(encoding="utf-8"))

    def test_vibration_is_not_judged_from_coarse_rows(self):
        self.run_with("coarse.h5", "output.step.points=0.01")
        ride = run_program([ROOT / "tools/ride", "coarse.h5"], cwd=self.folder)
        self.assertEqual(ride.returncode, 0, ride.stderr)
        self.assertIn("chassis.seat: without the weighted values, the absorbed power and the third-", ride.stdout)
        self.assertIn("'points/chassis.seat/acceleration' is stored every 10 ms only", ride.stdout)
        (row,) = [line for line in ride.stdout.splitlines() if line.startswith("chassis.seat ")]
        self.assertIn("–", row)


if __name__ == "__main__":
    unittest.main()
