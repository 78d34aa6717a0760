"""The truck's report dynamics/models/truck/README.md: its cheap rows are made again and must agree with it.

Needs the built programs: SPRUNG_REDUCE and SPRUNG_DYNAMICS.
"""

import os
import unittest
from pathlib import Path

import numpy as np
from markdown_tables import NUMBER, cells_agree, find_differences, parse_markdown, read_part
from report_differences import (
    RELATIVE,
    RELATIVE_EVALUATIONS,
    find_mode_differences,
    keep_columns,
    rows_of_evaluations,
)
from tool_test_case import ROOT, make_class_folder

from sprung_tools.paper_report.paper_claims import list_claims
from sprung_tools.paper_report.certified_runs import list_certified_runs, list_timed_certified_runs
from sprung_tools.paper_report.certified_tables import make_basis_cost_table
from sprung_tools.paper_report.markdown import format_markdown, format_words
from sprung_tools.paper_report.mode_claims import list_mode_claims
from sprung_tools.paper_report.mode_runs import RECALLS, list_mode_runs, list_timed_mode_runs, name_recall
from sprung_tools.paper_report.mode_tables import list_mode_tables, make_mode_cost_table
from sprung_tools.paper_report.paper_runs import (
    MODE_COUNTS,
    SPEEDS,
    TRUCK,
    PaperRun,
    list_convergence_runs,
    list_adams_runs,
    list_finer_runs,
    list_main_runs,
    list_sensitivity_runs,
    list_speed_runs,
    list_tyre_runs,
    name_start,
    write_roads,
)
from sprung_tools.paper_report.programs import Programs, build_superelements, call, make_command, run_all
from sprung_tools.paper_report.run_numbers import MIDDLE, SEAT, Numbers
from sprung_tools.paper_report.tables import list_tables, list_texts
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.runs.ride_measures import calc_contact
from sprung_tools.model.rigid_body_loads import calc_rigid_moments, read_superelement

OTHER_TERRAIN = "road_1_seed2"
OTHER_SPEED = "speed8.5"
TIMED = ("cost", "mode cost", "certified cost")
MODES = ("mode claims", "certified accuracy")  # compared as the tables on modes are


class Report(unittest.TestCase):
    """All runs are made once, in a folder of the class."""

    @classmethod
    def setUpClass(cls):
        cls.folder = make_class_folder(cls)
        cls.programs = Programs(Path(os.environ["SPRUNG_REDUCE"]), Path(os.environ["SPRUNG_DYNAMICS"]))
        build_superelements(cls.programs, cls.folder)
        write_roads(cls.folder)
        others = [run for run in list_sensitivity_runs(cls.folder) if OTHER_TERRAIN in run.name]
        others += [run for run in list_speed_runs() if OTHER_SPEED in run.name]
        at_rest = PaperRun("at_rest_36modes", "bump.toml", ("modes.chassis=36", "duration=0.01"))
        runs = [
            *list_main_runs(),
            *list_convergence_runs(),
            *list_adams_runs(),
            *list_finer_runs(),
            *others,
            *list_tyre_runs(),
            *list_mode_runs(),
            *list_certified_runs(),
            at_rest,
        ]
        run_all(cls.programs, runs, cls.folder, report=lambda _: None)
        cls.numbers = Numbers(cls.folder)
        cls.text = (TRUCK / "README.md").read_text(encoding="utf-8")

    def test_every_table_still_has_the_numbers_and_answers_of_the_report(self):
        for name, make in list_tables().items():
            if name in TIMED:
                continue
            headings, rows = make(self.numbers)
            if (
                name == "ride"
            ):  # its columns are models: those not run again are left out of the report's, too
                kept = keep_columns(parse_markdown(read_part(self.text, name)), headings)
            else:
                kept = parse_markdown(read_part(self.text, name))
            with self.subTest(name):
                self.assertGreater(len(rows), 0)
                if name in MODES or name in list_mode_tables():
                    self.assertEqual(find_mode_differences(name, kept, (headings, rows)), [])
                    continue
                counts = [row for row in rows if rows_of_evaluations(name, row)]
                others = [row for row in rows if not rows_of_evaluations(name, row)]
                found = find_differences(kept, (headings, others), RELATIVE)
                found += find_differences(kept, (headings, counts), RELATIVE_EVALUATIONS)
                self.assertEqual(found, [])

    def test_a_number_changed_by_more_than_the_tolerance_is_noticed_in_every_table(self):
        for name, make in list_tables().items():
            if name in TIMED:
                continue
            headings, rows = make(self.numbers)
            changed = [
                (row[0], *(NUMBER.sub(lambda found: change(found[0]), cell) for cell in row[1:]))
                for row in rows
            ]
            kept = parse_markdown(format_markdown(headings, rows))
            with self.subTest(name):
                differences = find_differences(kept, (headings, changed), RELATIVE)
                self.assertEqual(len({text.split("'")[1] for text in differences}), len(rows))

    def test_a_number_that_is_twice_another_is_noticed_in_every_column_on_modes(self):
        for name in ("mode claims", *list_mode_tables()):
            if name in TIMED:
                continue
            headings, rows = list_tables()[name](self.numbers)
            first = headings.index("we find") if name == "mode claims" else 1
            kept = parse_markdown(format_markdown(headings, rows))
            self.assertEqual(find_mode_differences(name, kept, (headings, rows)), [])
            for column in range(first, len(headings)):
                if headings[column] in ("energy closure", "holds?", "warns"):
                    continue
                changed = [
                    (*row[:column], NUMBER.sub(lambda found: double(found[0]), row[column]), *row[column + 1 :])
                    for row in rows
                ]
                numbered = [row for row in rows if NUMBER.search(row[column])]  # "nothing" is left out of all modes
                with self.subTest(name, column=headings[column]):
                    self.assertGreater(len(numbered), 0)
                    self.assertEqual(len(find_mode_differences(name, kept, (headings, changed))), len(numbered))

    def test_the_report_shows_a_row_for_every_claim_and_every_number_of_modes(self):
        rows = parse_markdown(read_part(self.text, "claims"))[1]
        self.assertEqual([row[0] for row in rows], [claim.number for claim in list_claims()])
        self.assertEqual(
            [row[1:4] for row in rows], [[one.source, one.says, one.criterion] for one in list_claims()]
        )
        for name in ("convergence", "effort"):
            rows = parse_markdown(read_part(self.text, name))[1]
            self.assertEqual([row[0] for row in rows], [str(count) for count in MODE_COUNTS])
        self.assertEqual(len(parse_markdown(read_part(self.text, "sensitivity"))[1]), 9)
        self.assertEqual(
            [row[0] for row in parse_markdown(read_part(self.text, "speed"))[1]],
            [f"{v:g} m/s" for v in SPEEDS],
        )
        self.assertEqual(len(parse_markdown(read_part(self.text, "cost"))[1]), 6)

    def test_the_report_quotes_what_the_program_says(self):
        for name, make in list_texts().items():
            made = format_words(make(self.numbers))
            self.assertIn("warning: modes are missing", made)
            self.assertTrue(cells_agree(read_part(self.text, name), made, RELATIVE), made)

    def test_the_section_on_modes_has_every_row(self):
        shown = parse_markdown(read_part(self.text, "mode claims"))[1]
        self.assertEqual(
            [row[:4] for row in shown],
            [[one.number, one.source, one.says, one.criterion] for one in list_mode_claims()],
        )
        self.assertEqual(len(parse_markdown(read_part(self.text, "recall"))[1]), len(RECALLS))
        self.assertEqual(len(parse_markdown(read_part(self.text, "adaptive bump"))[1]), 12)

    def test_the_section_on_the_certified_chassis_has_every_claim_on_flexibility_and_a_time_for_every_row(self):
        rows = parse_markdown(read_part(self.text, "certified claims"))[1]
        numbers = {number for row in rows for number in NUMBER.findall(row[0])}
        # Not those on the clamped modes themselves, the rigid truck, all 36 modes, and the cost.
        others = {"1", "2", "3", "20", "23", "26", "27", "28", "29", "30"}
        self.assertEqual(numbers, {claim.number for claim in list_claims()} - others)
        times = {run.name: 1.0 + place for place, run in enumerate(list_timed_certified_runs())}
        made = make_basis_cost_table(Numbers(self.folder, times))[1]
        accuracy = [row[0] for row in parse_markdown(read_part(self.text, "certified accuracy"))[1]]
        for shown in (made, parse_markdown(read_part(self.text, "certified cost"))[1]):
            self.assertEqual([row[0] for row in shown], accuracy)

    def test_the_programs_own_thresholds_are_among_those_that_are_tightened(self):
        own = self.numbers.run("bump_adaptive")
        same = [one for one in RECALLS if self.numbers.run(name_recall(one)).evaluations == own.evaluations]
        self.assertEqual(len(same), 1)
        for point in (MIDDLE, SEAT):
            np.testing.assert_array_equal(
                self.numbers.run(name_recall(same[0])).acceleration(point), own.acceleration(point)
            )

    def test_times_stand_beside_those_of_all_modes_by_the_same_method(self):
        times = {run.name: 1.0 + place for place, run in enumerate(list_timed_mode_runs())}
        headings, rows = make_mode_cost_table(Numbers(self.folder, times))
        self.assertEqual(
            headings, ("", "exponential s", "exponential over all modes", "Adams s", "Adams over all modes")
        )
        cells = {row[0]: row[1:] for row in rows}
        adaptive, full = (times[f"bump_{name}_adams"] for name in ("adaptive", "36modes"))
        self.assertEqual(cells["bump: from 2, 36 available"][2:], (f"{adaptive:.2f}", f"{adaptive / full:.2f}"))
        self.assertEqual(cells["bump: fixed, all 36 modes"][1::2], ("1.00", "1.00"))
        watched = times["bump_36modes_watched"] / times["bump_36modes"]
        self.assertEqual(cells["bump: fixed, all 36 modes, with the indicator"][1], f"{watched:.2f}")
        self.assertEqual(cells["terrain: chosen beforehand"][2:], ("–", "–"))
        self.assertEqual(make_mode_cost_table(Numbers(self.folder))[1], [])
        # The claims on cost are judged by the same times, on both sides of their limits.
        integration, program, few, _ = (one for one in list_mode_claims() if one.timed)
        starts = {name_start(name): 0.25 for name in times}
        for value, holds in ((0.5, True), (0.51, False)):
            half = {**times, **starts, "bump_adaptive": value * times["bump_36modes"]}
            self.assertEqual(program.judge(Numbers(self.folder, half)).holds["exponential"], holds)
            half["bump_adaptive"] = 0.25 + value * (times["bump_36modes"] - 0.25)
            self.assertEqual(integration.judge(Numbers(self.folder, half)).holds["exponential"], holds)
        cheap = {**times, **starts, "bump_adaptive_of_6_adams": 0.9 * times["bump_6modes_adams"]}
        self.assertTrue(few.judge(Numbers(self.folder, cheap)).holds["Adams"])

    def test_runs_at_other_speeds_are_judged_over_the_same_metres(self):
        run = self.numbers.run(f"terrain_rigid_{OTHER_SPEED}")
        way = run.series("points/front_axle.origin/position.x")
        start = self.numbers.run("terrain_rigid").series("points/front_axle.origin/position.x")
        # From sample to sample 8.5 mm; without a horizontal force the speed changes by some per mille.
        np.testing.assert_allclose((way[0], way[-1]), (start[0], start[-1]), atol=0.1)

    def test_every_picture_of_the_report_is_there(self):
        pictures = [
            part.partition(")")[0] for part in self.text.split("](")[1:] if part.startswith("figures/")
        ]
        self.assertGreaterEqual(len(pictures), 7)
        for picture in pictures:
            self.assertTrue((TRUCK / picture).is_file(), picture)

    def test_mean_tyre_loads_over_terrain_carry_the_trucks_weight(self):
        # 14400 kg · 9.80665 m/s² [N]; momentum at the window's ends leaves less than 2 %.
        run = self.numbers.run("terrain_4modes")
        mean = sum(np.mean(run.series(f"forces/{axle}_tyre/force")) for axle in ("front", "rear"))
        self.assertAlmostEqual(mean / (14400.0 * 9.80665), 1.0, delta=0.02)
        static = sum(
            calc_contact(run.results, f"{axle}_tyre", run.window).static for axle in ("front", "rear")
        )
        # 11950 + 2 · 1185 + 2 · 22.4 + 2 · 17.6 kg
        self.assertAlmostEqual(static / (14400.0 * 9.80665), 1.0, delta=1e-6)

    def test_a_rigid_chassis_in_balance_has_the_moments_of_a_flexible_one(self):
        rigid = self.numbers.run("bump_rigid").results
        moments, stations = calc_rigid_moments(
            rigid, "chassis", read_superelement(self.folder / "chassis.h5")
        )
        with open_results(self.folder / "at_rest_36modes.h5") as flexible:
            elastic, _ = read_numbers(flexible.file, "recovery/chassis/moment_from_loads")
            places, _ = read_numbers(flexible.file, "recovery/chassis/station")
        np.testing.assert_allclose(stations, places, atol=1e-12)
        # The bent chassis stands slightly differently on its springs.
        np.testing.assert_allclose(moments[0], elastic[0], atol=1e-3 * np.max(np.abs(elastic[0])))

    def test_a_rigid_chassis_in_equilibrium_carries_its_overhang(self):
        # At the foremost pivot: −q L²/2 of the overhang L = 3.8257 − 3.034 m.
        rigid = self.numbers.run("bump_rigid").results
        moments, stations = calc_rigid_moments(
            rigid, "chassis", read_superelement(self.folder / "chassis.h5")
        )
        load, overhang = 1561.8057 * 9.80665, 3.8257 - 3.034
        self.assertAlmostEqual(stations[1, 0], -3.034, places=9)
        expected = -load * overhang**2 / 2.0
        self.assertAlmostEqual(moments[0, 1] / expected, 1.0, delta=2e-3)

    def test_moments_are_not_taken_from_another_superelement_than_the_runs(self):
        # Of the same nodes and points, but stiffer.
        text = (ROOT / "meshes/truck/chassis.toml").read_text(encoding="utf-8")
        (self.folder / "stiffer.toml").write_text(text.replace("1.9e-4", "3.8e-4"), encoding="utf-8")
        (self.folder / "other").mkdir()
        call(
            [
                self.programs.reduce,
                "build",
                self.folder / "stiffer.toml",
                "--output-dir",
                self.folder / "other",
            ]
        )
        rigid = self.numbers.run("bump_rigid").results
        for path in (*(self.folder / "other").glob("*.h5"), self.folder / "long_arm.h5"):
            with self.assertRaisesRegex(
                InputError, f"{path}: error: is not the superelement that 'chassis' had"
            ):
                calc_rigid_moments(rigid, "chassis", read_superelement(path))

    def test_a_run_that_fails_says_so(self):
        bad = PaperRun("bad", "bump.toml", ("modes.chassis=3",))
        with self.assertRaisesRegex(InputError, "(?s)modes.chassis=3.*exit code 2"):
            run_all(self.programs, [bad], self.folder, report=lambda _: None)
        self.assertIn("modes.chassis=3", make_command(self.programs, bad, self.folder))

    def test_a_run_that_its_program_does_not_trust_is_refused(self):
        folder = self.folder / "warned"
        folder.mkdir()
        program = folder / "program"
        for warning, is_refused in (("modes are missing: one", False), ("the energy balance does not close", True)):
            program.write_text(f"#!/bin/sh\necho 'warning: {warning}'\n", encoding="utf-8")
            program.chmod(0o755)
            run = PaperRun("untrusted", "bump.toml", ())
            arguments = (Programs(program, program), [run], folder, lambda _: None)
            if is_refused:
                with self.assertRaisesRegex(InputError, "untrusted.h5: error: no run for a report: .* energy balance"):
                    run_all(*arguments)
            else:
                run_all(*arguments)
                self.assertTrue((folder / "untrusted.txt").exists())

    def test_values_between_outputs_are_allowed_where_none_are_taken(self):
        folder = self.folder / "coarse"
        folder.mkdir()
        program = folder / "program"
        seat, arm = "accelerations: that of chassis.seat along {} reached 2 m/s²", "bending moments of {}: one of them"
        for quantity, is_known, is_refused in (
            (seat.format("x"), True, False), (seat.format("x"), False, True), (seat.format("y"), True, True),
            (arm.format("front_long_arm"), True, False), (arm.format("chassis"), True, True),
        ):  # fmt: skip
            with self.subTest(quantity=quantity, is_known=is_known):
                said = f"values every 0.001 s do not resolve the {quantity}"
                program.write_text(f"#!/bin/sh\necho 'warning: {said}'\n", encoding="utf-8")
                program.chmod(0o755)
                run = PaperRun("coarse", "bump.toml", (), is_coarse_elsewhere=is_known)
                arguments = (Programs(program, program), [run], folder, lambda _: None)
                if is_refused:
                    with self.assertRaisesRegex(InputError, "no run for a report"):
                        run_all(*arguments)
                else:
                    run_all(*arguments)

    def test_a_file_left_by_an_earlier_work_is_no_run_of_this_one(self):
        numbers = Numbers(self.folder, made=["bump_rigid", "bump_7modes"])
        self.assertEqual(
            [numbers.has(name) for name in ("bump_rigid", "bump_4modes", "bump_7modes")], [True, False, False]
        )
        with self.assertRaisesRegex(InputError, "bump_4modes.h5: error: this run was not made"):
            numbers.run("bump_4modes")

    def test_a_missing_run_is_named(self):
        with self.assertRaisesRegex(InputError, "bump_7modes.h5: error: no such file"):
            self.numbers.run("bump_7modes")


def double(number):
    """Twice a number and fifteen."""
    digits = len(number.partition(".")[2])
    return f"{2.0 * float(number) + np.copysign(15.0, float(number)):.{digits}f}"


def change(number):
    """A number moved by a tenth and three of its last digits."""
    digits = len(number.partition(".")[2].partition("e")[0])
    if "e" in number:
        return "3e-03"
    value = float(number)
    return f"{value * 1.1 + np.copysign(3.0 * 10.0**-digits, value):.{digits}f}"


if __name__ == "__main__":
    unittest.main()
