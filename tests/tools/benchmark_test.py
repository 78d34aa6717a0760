"""tools/benchmark: how it judges runs, and that all of it runs. Times are not tested."""

import csv
import os
import re
import shutil
import unittest
from pathlib import Path

import numpy as np
from tool_test_case import ToolTestCase

from sprung_tools.benchmark.many_runs import ManyRuns, check_many_runs, format_many_runs, measure_many_runs
from sprung_tools.benchmark.tables import format_runs
from sprung_tools.benchmark.targets import check_targets
from sprung_tools.benchmark.whole_runs import (
    BASELINE,
    METHODS,
    Case,
    Errors,
    Rung,
    Series,
    calc_errors,
    rms_above,
    time_in_rounds,
)


def series_of(acceleration, height=0.0, deflection=0.0):
    time = np.arange(len(acceleration)) * 1e-3
    return Series(time, time * 0.0 + height, acceleration, time * 0.0 + deflection)


class Judging(unittest.TestCase):
    def test_rms_above_counts_higher_frequencies_only(self):
        time = np.arange(2000) * 1e-3  # 2 s: whole periods of both
        values = 3.0 * np.sin(2 * np.pi * 4.0 * time) + 0.5 * np.sin(2 * np.pi * 40.0 * time)
        self.assertAlmostEqual(rms_above(values, 1e-3, 16.0), 0.5 / np.sqrt(2.0), places=12)

    def test_each_error_is_told_from_the_converged_run(self):
        time = np.arange(1000) * 1e-3
        true = series_of(np.sin(2 * np.pi * 20.0 * time), height=1.0, deflection=0.02)
        off = series_of(1.005 * np.sin(2 * np.pi * 20.0 * time), height=1.0 - 3e-5, deflection=0.0201)
        errors = calc_errors(off, true)
        np.testing.assert_allclose(errors, (3e-5, 0.005, 0.005, 0.005), rtol=1e-9)
        self.assertTrue(errors.allowed())

    def test_a_rigid_chassis_has_no_error_of_its_deflection(self):
        flat = series_of(np.sin(np.arange(1000.0)))
        self.assertEqual(calc_errors(flat, flat), (0.0, 0.0, 0.0, 0.0))

    def test_one_condition_missed_is_enough(self):
        good = Errors(1e-4, 0.01, 0.01, 0.01)
        self.assertTrue(good.allowed())
        for name, value in (("height", 1.1e-4), ("peak", 0.011), ("rms", 0.011), ("deflection", 0.011)):
            self.assertFalse(good._replace(**{name: value}).allowed())

    def climb(self, errors, seconds=1.0, **options):
        """Tolerances of the rungs, of the good one and of the first that is good by itself. errors: of the height in
        units of what is allowed, by rung."""
        case = Case.__new__(Case)  # without programs
        heights = {10.0**-i: 1e-4 * error for i, error in enumerate(errors)}
        case.measure = lambda method, tolerance, repetitions: Rung(
            tolerance, 10, 5, seconds, Errors(heights[tolerance], 0.0, 0.0, 0.0)
        )
        rungs, good, first = case.climb("adams", 1, ladder=tuple(heights), **options)
        return [rung.tolerance for rung in rungs], good and good.tolerance, first and first.tolerance

    def test_the_climb_ends_at_the_loosest_tolerance_that_is_good_enough_with_the_next_two(self):
        self.assertEqual(self.climb((9, 2, 0.9, 0.2, 0.1, 0.1)), ([1.0, 0.1, 0.01, 1e-3, 1e-4], 0.01, 0.01))
        self.assertEqual(self.climb((9, 0.9, 2, 0.9, 0.2, 0.1))[1:], (1e-3, 0.1))  # once by chance
        self.assertEqual(self.climb((0.9, 0.9, 0.9, 2), whole=True), ([1.0, 0.1, 0.01, 1e-3], 1.0, 1.0))
        self.assertEqual(self.climb((0.9, 0.9))[1:], (None, 1.0))
        self.assertEqual(self.climb((0.9, 0.9, 0.9), seconds=9.0), ([1.0], None, None))

    def test_chosen_runs_are_timed_in_rounds(self):
        calls = []

        class Clock:
            """A machine that becomes slower with every run."""

            def __init__(self, modes):
                self.modes = modes

            def time(self, method, tolerance):
                calls.append((self.modes, method, tolerance))
                return float(len(calls))

        errors = Errors(0.0, 0.0, 0.0, 0.0)
        results = {
            ("bump", 0, "adams"): Rung(1e-3, 10, 5, 0.1, errors),
            ("bump", 2, "adams"): Rung(1e-4, 20, 9, 0.1, errors),
            ("bump", 2, "bdf"): None,
            ("bump", 2, "baseline"): Rung(1e-4, 90, 9, 3.0, errors),  # long
        }
        firsts = {
            ("bump", 0, "adams"): Rung(1e-3, 10, 5, 0.1, errors),
            ("bump", 2, "adams"): Rung(1e-2, 12, 6, 0.1, errors),
        }
        cases = {("bump", modes): Clock(modes) for modes in (0, 2)}
        results, firsts = time_in_rounds(cases, (results, firsts), 3)
        self.assertEqual(calls, [(0, "adams", 1e-3), (2, "adams", 1e-4), (2, "adams", 1e-2)] * 3)
        seconds = [rung and rung.seconds for rung in (*results.values(), *firsts.values())]
        self.assertEqual(seconds, [4.0, 5.0, None, 3.0, 4.0, 6.0])  # medians: of 1, 4, 7 and so on

    def test_ratios_are_to_the_fastest_rigid_run_and_of_the_baseline(self):
        def rung(seconds):
            return Rung(1e-4, 100, 20, seconds, None)

        results = {
            ("bump", 0, "exponential"): rung(0.004),
            ("bump", 0, "adams"): rung(0.002),
            ("bump", 0, "baseline"): rung(0.05),
            ("bump", 2, "exponential"): rung(0.003),
            ("bump", 2, "adams"): None,
        }
        firsts = {**results, ("bump", 0, "baseline"): rung(0.03)}
        targets = {
            what: (value, met)
            for what, _, value, met in check_targets({}, results, firsts, {"bump": 5.0}, [])
        }
        self.assertEqual(targets["bump, 2 modes to fastest rigid"], (1.5, True))
        self.assertEqual(targets["bump, 0 modes: baseline/fastest"], (25.0, True))
        self.assertEqual(targets["bump, 0 modes: baseline/fastest, first good tolerances"], (15.0, True))
        table = format_runs(results, firsts, {"bump": 5.0})
        self.assertIn("–", table.splitlines()[-1])

    def test_a_run_of_each_kind_is_compared_with_its_own_integration(self):
        kinds = {"bump": ManyRuns(1.0, 0.875, 0.25), "terrain": ManyRuns(3.0, None, 1.0)}
        ratios = [line.split()[-3] for line in format_many_runs(kinds).splitlines()[2:]]
        self.assertEqual(ratios, ["4.00", "3.50", "1.00", "3.00", "1.00"])
        self.assertEqual([target[1:] for target in check_many_runs(kinds)], [("≤ 3.75", 3.5, True)])


class Tool(ToolTestCase):
    def test_builds_of_lattices_are_measured(self):
        process = self.run_tool(
            "benchmark", "reduce", "--quick", "--programs", os.environ["SPRUNG_BUILD"], "--output-dir", "out"
        )
        self.assert_succeeds(process)
        self.assertEqual((self.folder / "out/benchmark_reduce.txt").read_text(encoding="utf-8"), process.stdout)
        builds, hanging, methods = process.stdout.split("\n\n")
        heading, *lines = builds.splitlines()[1:]
        has_calculix = shutil.which("ccx") is not None
        self.assertEqual("ccx s" in heading, has_calculix)
        if not has_calculix:
            self.assertEqual(lines.pop(), "no column of CalculiX: ccx (Debian: calculix-ccx) is not in PATH")
        rows = [line.split() for line in lines]
        self.assertEqual([row[:2] for row in rows], [["1320", "4"], ["240", "2"]])
        for row in rows:
            self.assertIn("freedoms,", row)  # what the program says of a superelement
            self.assertGreater(float(row[3]), 1.0)  # of memory; CPU time has no lower bound
            limit, *parts = map(float, row[4:9])  # analysis, factors, solutions, count
            self.assertAlmostEqual(limit, sum(parts), delta=0.03)  # by two digits each
            self.assertGreater(float(row[9]), 1.0)  # its memory
            self.assertIn("CHOLMOD", heading)
            if row[10] != "–":  # built without it
                self.assertGreaterEqual(float(row[10]), 0.0)
            for seconds, megabytes in zip(row[11 : 13 + 2 * has_calculix : 2], row[12 : 14 + 2 * has_calculix : 2]):
                self.assertGreaterEqual(float(seconds), 0.0)  # scipy, CalculiX
                self.assertGreater(float(megabytes), 1.0)
        refused, built = (line.split(maxsplit=4) for line in hanging.splitlines()[2:])
        self.assertEqual((refused[:2], built[:2]), (["1323", "clamped"], ["1323", "free"]))
        self.assertRegex(refused[4], "^error: the reference, .* hangs on the body so softly")
        self.assertRegex(built[4], "^[0-9]+ elements, ")
        rows = [line.split() for line in methods.splitlines()[2:]]
        self.assertEqual([row[0] for row in rows], ["1320", "240"])
        for row in rows:
            self.assertEqual(len([one for one in row[1:] if one == "–" or float(one) >= 0.0]), 4)

    def test_errors_over_tolerances_are_measured(self):
        """At 1e-5 a run is better by far than at 1e-3, and costs more."""
        process = self.run_tool(
            "benchmark", "tolerances", "--quick", "--programs", os.environ["SPRUNG_BUILD"], "--output-dir", "out"
        )
        self.assert_succeeds(process)
        self.assertEqual((self.folder / "out/benchmark_tolerances.txt").read_text(encoding="utf-8"), process.stdout)
        coarse, fine = (line.split() for line in process.stdout.splitlines()[3:])
        self.assertEqual([coarse[:2], fine[0]], [["bump", "0.001"], "1e-05"])
        for modes in (0, 1):
            self.assertLess(float(fine[1 + modes]) * 1e-5, 0.1 * float(coarse[2 + modes]) * 1e-3)  # height
            self.assertLess(float(fine[3 + modes]) * 1e-5, 0.1 * float(coarse[4 + modes]) * 1e-3)  # acceleration
            self.assertGreater(int(fine[5 + modes]), int(coarse[6 + modes]))  # evaluations

    def test_a_quick_measurement_writes_tables_data_and_picture(self):
        process = self.run_tool("benchmark", "--quick", "--programs", os.environ["SPRUNG_BUILD"], "--output-dir", "out")
        self.assert_succeeds(process)
        for heading in ("One evaluation", "Whole runs", "Many runs", "The bump", "Growth", "Targets"):
            self.assertRegex(process.stdout, rf"(?m)^{heading}")
        beside = re.findall(r"(?m)^(bump|bump, stored|terrain) +a process for each run .* (\S+) ms$", process.stdout)
        self.assertEqual([run for run, _ in beside], ["bump", "bump, stored", "terrain"])
        self.assertGreater(min(float(milliseconds) for _, milliseconds in beside), 0.0)
        certified, clamped = re.findall(r"(?m)^(certified|clamped) +(\d+) +\d+ .* (\S+)$", process.stdout)
        self.assertEqual((certified[:2], clamped), (("certified", "20"), ("clamped", "20", "1.00")))
        self.assertGreater(float(certified[2]), 0.0)
        self.assertEqual((self.folder / "out/benchmark.txt").read_text(encoding="utf-8"), process.stdout)
        with open(self.folder / "out/work_precision.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["method"] for row in rows}, {*METHODS, BASELINE})
        for row in rows:
            # The converged run is by one method; the others agree with it, so all four agree.
            if float(row["tolerance"]) <= 1e-6:
                self.assertLess(float(row["height_error_m"]), 1e-4, row)
        self.assertEqual((self.folder / "out/work_precision.png").read_bytes()[:4], b"\x89PNG")

    def test_other_numbers_of_modes_are_drawn_as_well(self):
        process = self.run_tool("benchmark", "--quick", "--modes", "4", "--methods", "exponential", "--programs",
                                os.environ["SPRUNG_BUILD"], "--output-dir", "out")  # fmt: skip
        self.assert_succeeds(process)
        with open(self.folder / "out/work_precision.csv", encoding="utf-8") as file:
            self.assertEqual({row["modes"] for row in csv.DictReader(file)}, {"4"})

    def test_runs_as_long_as_their_files_say_are_measured(self):
        program = Path(os.environ["SPRUNG_BUILD"]) / "dynamics/sprung-dynamics"
        superelements = Path(os.environ["SPRUNG_TRUCK_SUPERELEMENTS"])
        for kind, runs in measure_many_runs(program, superelements, 1, None).items():
            with self.subTest(kind=kind):
                self.assertGreater(runs.by_process, runs.integration)

    def test_numbers_without_sense_are_refused(self):
        for arguments in (
            ("tolerances", "--modes", "2"), ("reduce", "--repetitions", "2"), ("--repetitions", "0"),
            ("--modes", "-1"), ("--methods", "euler"),
        ):  # fmt: skip
            self.assertEqual(self.run_tool("benchmark", "--quick", *arguments).returncode, 2, arguments)

    def test_programs_that_are_not_built_are_named(self):
        process = self.run_tool("benchmark", "--programs", "nowhere", "--output-dir", "out")
        self.assert_refuses(process, "nowhere/reduce/sprung-reduce: error: ", "tools/build")


if __name__ == "__main__":
    unittest.main()
