"""runs/section_stress.py, runs/fatigue.py and tools/fatigue: stresses by hand, damage of sine waves in closed form."""

import csv
import json
import unittest

import h5py
import numpy as np
from ride_results import DURATION, STEP, write_ride_results
from synthetic_results import write_series
from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.runs.fatigue import calc_fatigue
from sprung_tools.runs.measures import list_objects, measure_stresses
from sprung_tools.runs.section_stress import calc_section_stress, list_stress_remarks, list_stressed_bodies
from sprung_tools.signals.fatigue_damage import StrengthLine, calc_damage, calc_range
from sprung_tools.signals.rainflow import Cycles, count_cycles
from sprung_tools.study.storage import choose_storage

STATIONS = np.array([(2.0, 0.0), (0.0, 0.0), (-2.0, 0.0), (0.0, 0.0)])  # the first element runs towards -x
AREA, MODULUS = np.array([0.01, 0.01, 0.02, 0.02]), np.array([1e-3, 1e-3, 4e-3, 4e-3])  # m², m³
AXIAL = 2e5  # N
MOMENT = 1e5  # N m, amplitude at the first station; the others have these shares
SHARES = np.array([1.0, 0.5, 0.0, -0.8])
FREQUENCY = 2.0  # Hz; the window of 1 to 3 s has four periods
LINE = StrengthLine(71e6)


def write_loads(path, from_loads=None):
    """A run whose body 'body' has a constant axial force and a moment that oscillates, which is lowest where the window
    begins. from_loads: factor of the same from loads. Returns the path."""
    write_ride_results(path, with_moments=False)
    with h5py.File(path, "a") as file:
        time = STEP * np.arange(round(DURATION / STEP) + 1)
        moment = -MOMENT * np.outer(np.cos(2.0 * np.pi * FREQUENCY * (time - 1.0)), SHARES)
        for ending, factor in (("", 1.0), *([("_from_loads", from_loads)] if from_loads else [])):
            write_series(file, f"recovery/body/axial{ending}", np.full(moment.shape, AXIAL), "N")
            write_series(file, f"recovery/body/moment{ending}", factor * moment, "N m")
        for name, values, unit in (
            ("station", STATIONS, "m"),
            ("area", AREA, "m^2"),
            ("section_modulus", MODULUS, "m^3"),
        ):
            write_series(file, f"recovery/body/{name}", values, unit)
        file.require_group("summary").attrs["energy_closure"] = 1e-9
        file.attrs["version"] = 2
    return str(path)


class SectionStress(ToolTestCase):
    def test_stresses_are_those_calculated_by_hand(self):
        with open_results(write_loads(self.folder / "a.h5")) as results:
            section = calc_section_stress(results, "body", "modes")
        np.testing.assert_array_equal(section.along, [-2.0, 0.0, 0.0, 2.0])
        np.testing.assert_array_equal(section.elements, [2, 2, 1, 1])
        # On the left of an element N/A − M/W. At 1 s, M is −MOMENT · share, and the first element has its left below.
        self.assertEqual(section.sides, [("+y", "-y")] * 2 + [("-y", "+y")] * 2)
        at_start = section.stress[round(1.0 / STEP)]
        np.testing.assert_allclose(
            at_start * 1e-6,
            [(10.0, 10.0), (10.0 - 20.0, 10.0 + 20.0), (20.0 + 50.0, 20.0 - 50.0), (20.0 + 100.0, 20.0 - 100.0)],
            atol=1e-9,
        )

    def test_a_body_without_sizes_of_sections_has_no_stresses(self):
        for change, gap in ((lambda file: file.pop("recovery/body/area"), "no areas of the sections of 'body'"),
                            (lambda file: file["recovery/body/section_modulus"].__setitem__(1, 0.0),
                             "not all section moduli of the sections of 'body': its design needs 'section_modulus'"),
                            (lambda file: file.pop("recovery/body/moment"), "no loads of the sections")):  # fmt: skip
            path = write_loads(self.folder / "a.h5")
            with h5py.File(path, "a") as file:
                change(file)
            with open_results(path) as results:
                self.assertEqual(list_stressed_bodies(results), [])
                with self.assertRaisesRegex(InputError, gap):
                    calc_section_stress(results, "body", "modes")

    def test_springs_are_left_out(self):
        with h5py.File(write_loads(self.folder / "a.h5"), "a") as file:
            for name in ("area", "section_modulus"):
                file[f"recovery/body/{name}"][:2] = 0.0  # the first element
        with open_results(self.folder / "a.h5") as results:
            section = calc_section_stress(results, "body", "modes")
        self.assertEqual((section.along.tolist(), section.elements.tolist()), ([-2.0, 0.0], [2, 2]))
        np.testing.assert_allclose(1e-6 * section.stress[round(1.0 / STEP)], [(10.0, 10.0), (-10.0, 30.0)], atol=1e-9)

    def test_springs_alone_and_sections_of_unknown_size_beside_springs_are_refused(self):
        for area, modulus, gap in (
            ((0, 0, 0, 0), (0, 0, 0, 0), "no sections of 'body': all its elements are springs"),
            ((0, 0, 1, 1), (0, 0, 1, 0), "not all section moduli of the sections of 'body'"),
            ((0, 0, 1, 0), (0, 0, 1, 1), "not all areas of the sections of 'body'"),
        ):
            with h5py.File(write_loads(self.folder / "a.h5"), "a") as file:
                file["recovery/body/area"][:] = area
                file["recovery/body/section_modulus"][:] = modulus
            with open_results(self.folder / "a.h5") as results, self.assertRaisesRegex(InputError, gap):
                calc_section_stress(results, "body", "modes")

    def test_loads_stored_at_some_outputs_only_are_refused(self):
        path = write_loads(self.folder / "a.h5")
        with h5py.File(path, "a") as file:
            for name in ("axial", "moment"):
                values = file[f"recovery/body/{name}"][::2]
                del file[f"recovery/body/{name}"]
                write_series(file, f"recovery/body/{name}", values, "N")
                file[f"recovery/body/{name}"].attrs["every"] = 2
        with open_results(path) as results, self.assertRaisesRegex(InputError, "is stored every 2 ms only"):
            calc_fatigue(results, "body", "modes", (1.0, 3.0), LINE)
        with open_results(path) as results:  # as measures they are remarked on
            (remark,) = list_stress_remarks(results, ["body"])
        self.assertIn("stresses of 'body' are those of rows every 2 ms", remark)


class Fatigue(ToolTestCase):
    def test_a_sine_does_the_damage_of_its_cycles(self):
        with open_results(write_loads(self.folder / "a.h5")) as results:
            fatigue = calc_fatigue(results, "body", "modes", (1.0, 3.0), LINE)
            doubled = calc_fatigue(results, "body", "modes", (1.0, 3.0), LINE, factor=2.0)
        # Ranges 2 M/W: 40 MPa (below the knee of 52.3 MPa), 100 and 200 MPa; four cycles each
        knee = 71.0 * 0.4 ** (1.0 / 3.0)
        expected = 4.0 * np.array([0.0, (40.0 / knee) ** 5 / 5e6, (100.0 / 71.0) ** 3 / 2e6, (200.0 / 71.0) ** 3 / 2e6])
        np.testing.assert_allclose(fatigue.damage, np.stack([expected, expected], axis=1), rtol=1e-12)
        np.testing.assert_allclose(
            fatigue.greatest_range * 1e-6, [[0.0] * 2, [40.0] * 2, [100.0] * 2, [200.0] * 2], atol=1e-9
        )
        self.assertEqual(fatigue.worst[0], 3)
        np.testing.assert_allclose(doubled.damage[2:], 8.0 * fatigue.damage[2:], rtol=1e-12)

    def test_two_million_cycles_at_the_category_end_the_life_wherever_the_knee_is(self):
        """With a knee at 1e6 they did a damage of 0.63."""
        for knee in (5e5, 1e6, 2e6, 5e6):
            for slopes in ((3.0, 5.0), (4.0, 4.0)):
                line = StrengthLine(71e6, slopes, knee)
                cycles = Cycles(np.array([71e6]), np.array([0.0]), np.array([2e6]))
                self.assertAlmostEqual(calc_damage(line, cycles), 1.0, places=12)
                self.assertAlmostEqual(calc_range(line, 2e6), 71e6, places=3)

    def test_the_mean_stress_of_the_axial_force_counts_by_goodmans_line(self):
        with open_results(write_loads(self.folder / "a.h5")) as results:
            plain = calc_fatigue(results, "body", "modes", (1.0, 3.0), LINE)
            corrected = calc_fatigue(results, "body", "modes", (1.0, 3.0), LINE._replace(strength=100e6))
            with self.assertRaisesRegex(
                InputError, r"at \((-2|0), 0\) m of 'body', the mean stress"
            ):
                calc_fatigue(results, "body", "modes", (1.0, 3.0), LINE._replace(strength=10e6))
        # A mean of 20 MPa with R_m = 100 MPa raises ranges of the first slope by 1/0.8
        np.testing.assert_allclose(corrected.damage[2:], plain.damage[2:] / 0.8**3, rtol=1e-12)


class Measures(ToolTestCase):
    def test_stresses_are_measures_for_studies(self):
        with open_results(write_loads(self.folder / "a.h5", from_loads=1.1)) as results:
            measures = measure_stresses(results, "body", (1.0, 3.0))
            self.assertIn("stresses/body", list_objects(results, (1.0, 3.0)))
        # From loads at the first station: N/A ± 1.1 M/W
        values = {
            name.rpartition("/")[2]: one.value * (1e-6 if one.unit == "Pa" else 1.0) for name, one in measures.items()
        }
        expected = {"highest": 130.0, "lowest": -90.0, "largest_range": 220.0, "x": 2.0, "y": 0.0}
        for name, value in expected.items():
            self.assertAlmostEqual(values[name], value, places=9)
        self.assertNotIn("output.store.recovery=none", choose_storage(["stresses/body/highest"], []))


class FatigueCommand(ToolTestCase):
    def test_the_table_has_the_worst_place_from_loads_and_from_modes(self):
        write_loads(self.folder / "a.h5", from_loads=1.1)
        done = self.run_tool("fatigue", "wave=a.h5", "--category", "71", "-o", "a.png", "--histories", "a.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        from_loads, from_modes = done.stdout.splitlines()[-2:]
        damage = 4.0 * (200.0 / 71.0) ** 3 / 2e6
        self.assertIn(f"{damage:.3e}", from_modes)
        self.assertIn(f"{2.0 / damage / 3600.0:.4g}", from_modes)
        self.assertIn(f"{1.1**3 * damage:.3e}", from_loads)
        self.assertRegex(from_loads, r"body +wave +loads +2\.000 +0\.000 +1 +[+-]y +130\.0 +-90\.0 +220\.0 ")
        self.assertGreater((self.folder / "a.png").stat().st_size, 10000)
        with open(self.folder / "a.csv", encoding="utf-8") as table:
            rows = list(csv.reader(table))
        self.assertEqual(len(rows), 1 + 2001)
        self.assertRegex(rows[0][1], r"body at \(2, 0\) m, element 1, [+-]y, from loads \[Pa\]")
        self.assertAlmostEqual(max(float(row[1]) for row in rows[1:]) * 1e-6, 130.0, places=9)

    def test_places_asked_for_are_shown_with_both_fibres_of_each_element_there(self):
        write_loads(self.folder / "a.h5")
        done = self.run_tool("fatigue", "a.h5", "--category", "71", "--at", "body:0.1")
        rows = [line.split() for line in done.stdout.splitlines()[-4:]]
        self.assertEqual([row[-7:-5] for row in rows], [["2", "+y"], ["2", "-y"], ["1", "-y"], ["1", "+y"]])

    def test_json_has_the_measures_and_the_profile_along_the_body(self):
        write_loads(self.folder / "a.h5")
        done = self.run_tool("fatigue", "a.h5", "--category", "71", "--strength", "500", "--endurance", "1e8", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        packed = json.loads(done.stdout)
        self.assertEqual((packed["format"], packed["version"]), ("sprung-measures", 4))
        line = {"category": 71e6, "slopes": [3.0, 5.0], "knee": 5e6, "endurance": 1e8, "strength": 500e6}
        self.assertEqual(packed["strength_line"], line)
        (run,) = packed["runs"]
        self.assertEqual(run["measures"]["fatigue/body/from_modes/x"], {"value": 2.0, "unit": "m"})
        self.assertAlmostEqual(run["measures"]["fatigue/body/from_modes/highest"]["value"] * 1e-6, 120.0, places=9)
        (along,) = run["along"]
        self.assertEqual((along["along"], along["x"]), ([-2.0, 0.0, 0.0, 2.0], [-2.0, 0.0, 0.0, 2.0]))
        self.assertEqual(
            max(max(pair) for pair in along["damage"]), run["measures"]["fatigue/body/from_modes/damage"]["value"]
        )

    def test_a_span_that_is_longer_than_the_run_does_not_lengthen_the_life(self):
        # The damage of 4 s of run is repeated every 4 s, however long the span that was asked for.
        write_loads(self.folder / "a.h5")
        lives = []
        for start, end in (("0", "4"), ("-5", "400")):
            process = self.run_tool("fatigue", "a.h5", "--category", "71", "--from", start, "--to", end, "--json")
            self.assert_succeeds(process)
            (run,) = json.loads(process.stdout)["runs"]
            self.assertEqual(run["span"], {"from": 0.0, "to": 4.0, "unit": "s"})
            lives.append(run["measures"]["fatigue/body/from_modes/life"]["value"])
        self.assertEqual(*lives)

    def test_the_life_does_not_depend_on_how_often_the_span_has_a_load_cycle(self):
        # The stress rises from one wave to the next: what one passage leaves open closes as it is repeated. By the rule
        # of four points, 50 repetitions have 50 times the damage of one.
        write_loads(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            time = file["time"][()]
            file["recovery/body/moment"][...] = MOMENT * np.outer(
                np.sin(2.0 * np.pi * FREQUENCY * time) * (1.0 + time) + 3.0 * np.sin(np.pi * time / DURATION), SHARES)
        with open_results(self.folder / "a.h5") as results:
            fatigue = calc_fatigue(results, "body", "modes", (0.0, DURATION), LINE)
        history = fatigue.section.stress[:, -1, 0]
        once, many = (calc_damage(LINE, count_cycles(np.tile(history, number))) for number in (50, 100))
        self.assertAlmostEqual(fatigue.damage[-1, 0] / ((many - once) / 50.0), 1.0, places=9)
        self.assertGreater(fatigue.damage[-1, 0], 1.1 * calc_damage(LINE, count_cycles(history)))

    def test_a_duty_adds_the_damages_of_its_runs(self):
        write_loads(self.folder / "a.h5")
        write_loads(self.folder / "b.h5", from_loads=1.1)
        done = self.run_tool("fatigue", "a.h5", "b.h5", "--category", "71", "--duty", "20", "3.5", "--json")
        self.assert_succeeds(done)
        packed = json.loads(done.stdout)
        one, other = (run["measures"] for run in packed["runs"])
        duty, name = packed["duty"]["measures"], "fatigue/body/from_modes/"
        self.assertEqual(packed["duty"]["repetitions"], [20.0, 3.5])
        damage = 20.0 * one[name + "damage"]["value"] + 3.5 * other[name + "damage"]["value"]
        self.assertAlmostEqual(duty[name + "damage"]["value"] / damage, 1.0, places=12)
        self.assertAlmostEqual(duty[name + "life"]["value"] * damage / (23.5 * 2.0), 1.0, places=9)
        self.assertNotIn("fatigue/body/from_loads/damage", duty)  # the first run has none
        self.assertIn("duty: without 'body' from its loads, which not all runs have", packed["remarks"])
        table = self.run_tool("fatigue", "a.h5", "b.h5", "--category", "71", "--duty", "20", "3.5")
        self.assertRegex(table.stdout, r"\n +duty +modes +2\.000 +0\.000 ")
        self.assertIn("remark: rigid (a.h5): no stresses of 'body' from its loads: it has", table.stdout)

    def test_runs_of_other_sections_make_no_duty(self):
        for name in ("a.h5", "b.h5"):
            write_loads(self.folder / name)
        with h5py.File(self.folder / "b.h5", "a") as file:
            file["recovery/body/station"][0, 0] = 2.5
        refused = self.run_tool("fatigue", "a.h5", "b.h5", "--category", "71", "--duty", "1", "1")
        self.assert_refuses(refused, "--duty: error: 'body': the runs do not have the same sections")

    def test_a_duty_adds_the_damages_of_the_same_fibres_however_elements_are_drawn(self):
        for name in ("a.h5", "b.h5"):
            write_loads(self.folder / name)
        with h5py.File(self.folder / "b.h5", "a") as file:  # the second element from right to left
            group = file["recovery/body"]
            group["station"][2:] = STATIONS[[3, 2]]
            moment = group["moment"][()]
            group["moment"][:, 2:] = -moment[:, [3, 2]]
        done = self.run_tool("fatigue", "one=a.h5", "two=b.h5", "--category", "71", "--duty", "1", "2", "--json")
        self.assert_succeeds(done)
        packed = json.loads(done.stdout)
        (alone,), (together,) = packed["runs"][0]["along"], packed["duty"]["along"]
        self.assertEqual(together["sides"], alone["sides"])
        self.assertNotEqual(packed["runs"][1]["along"][0]["sides"], alone["sides"])
        np.testing.assert_allclose(together["damage"], 3.0 * np.array(alone["damage"]), rtol=1e-12)

    def test_places_of_a_frame_are_told_by_x_and_y(self):
        # Two rails above each other: an x alone does not say which one is meant.
        write_loads(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["recovery/body/station"][...] = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 0.3), (4.0, 0.3)])
        refused = self.run_tool("fatigue", "a.h5", "--category", "71", "--at", "body:4")
        self.assert_refuses(refused, "--at: error: 'body' has sections above each other: give body:X,Y")
        done = self.run_tool("fatigue", "a.h5", "--category", "71", "--at", "body:4,0.28")
        self.assertRegex(done.stdout.splitlines()[-1], r"modes +4\.000 +0\.300 +2 ")
        far = self.run_tool("fatigue", "a.h5", "--category", "71", "--at", "body:1,0.15")
        self.assert_succeeds(far)  # within half an element of the nearest end
        refused = self.run_tool("fatigue", "a.h5", "--category", "71", "--at", "body:2,0.15")
        self.assert_refuses(refused, "--at: error: 'body' has no section at 2, 0.15 m; the nearest is at (0, 0) m")

    def test_what_cannot_be_is_refused(self):
        write_loads(self.folder / "a.h5")
        write_ride_results(self.folder / "bare.h5", with_moments=False)
        for arguments, message in (
            (("a.h5", "--category", "0"), "--category: error: is 0, expected a finite value > 0"),
            (("a.h5", "--category", "71", "--slopes", "3", "-1"), "--slopes: error: is -1"),
            (("a.h5", "--category", "71", "--slopes", "3", "nan"), "--slopes: error: is nan, expected a finite"),
            (("a.h5", "--category", "71", "--slopes", "3", "inf", "--json"), "--slopes: error: is inf, expected a"),
            # (100 MPa / 1e-300 MPa)³ and more are beyond the largest number of 64 bits, 1.8e308.
            (("a.h5", "--category", "1e-300"), "(0, 0) m of 'body', the damage of ranges up to 40 MPa is inf, ex"),
            # (2·10⁶/10⁶)^(1/m₂) and (2·10⁶/5·10⁶)^(1/m₁) with a slope of 1e-4 are inf and 0 in 64 bits.
            (("a.h5", "--category", "71", "--slopes", "5", "1e-4", "--knee", "1e6"), "at 1e+06 cycles is inf Pa"),
            (("a.h5", "--category", "71", "--slopes", "1e-4", "5"), "the line's range at 5e+06 cycles is 0 Pa"),
            (
                ("a.h5", "--category", "71", "--at", "arm:0"),
                "--at: error: no stresses of a body 'arm'; there are those of body",
            ),
            (("a.h5", "--category", "71", "--at", "body"), "--at: error: 'body' is not BODY:X or BODY:X,Y in m"),
            (("a.h5", "--category", "71", "--at", "body:nan"), "'body:nan' is not BODY:X or BODY:X,Y in m"),
            (("a.h5", "--category", "71", "--at", "body:99"), "99 m is beyond 'body', which reaches in x from -2"),
            (("a.h5", "--category", "71", "--at", "body:0,1"), "which reaches in x from -2 to 2 m, y from 0 to 0 m"),
            (("a.h5", "--category", "71", "--at", "body:0,1,2"), "'body:0,1,2' is not BODY:X or BODY:X,Y in m"),
            (("a.h5", "--category", "71", "--duty", "1", "2"), "--duty: error: has 2 numbers, expected one for each"),
            (("a.h5", "--category", "71e6"), "--category: error: is 7.1e+07, expected at most 10000 MPa"),
            (("a.h5", "--category", "71", "--strength", "4e8"), "--strength: error: is 4e+08, expected at most 10000"),
            (("duty=a.h5", "--category", "71", "--duty", "2"), "--duty: error: a run has the label 'duty', which the"),
            (("a.h5", "--category", "71", "--duty", "nan"), "--duty: error: is nan, expected a finite value > 0"),
            (("a.h5", "--category", "71", "--from", "1", "--to", "1"), "1 to 1 s has one output, expected at least 2"),
            (("a.h5", "--category", "71", "--bodies", "arm"), "no loads of the sections of 'arm'"),
            (("bare.h5", "--category", "71"), "no flexible body with loads of its sections"),
            (("a.h5", "bare.h5", "--category", "71", "--histories", "b.csv"), "--histories: error: takes one run"),
            (("a.h5", "--category", "71", "-o", "a.h5"), "is one of the input files"),
        ):
            self.assert_refuses(self.run_tool("fatigue", *arguments), message)


if __name__ == "__main__":
    unittest.main()
