"""tools/report without a browser: the data of the page against the results, and the errors. report_page_test.py tests
what the page draws."""

import os
import unittest

import h5py
import numpy as np
from report_case import ReportCase, decode, read_page
from synthetic_results import (
    HEAVE,
    NUM_SAMPLES,
    STATIC_LOAD,
    write_results,
    write_series,
    write_superelement,
    write_texts,
)
from tool_test_case import ToolTestCase

from sprung_tools.report.packing import find_kept


class Report(ReportCase):
    def setUp(self):
        super().setUp()
        write_results(self.folder / "rigid.h5", num_modes=0)
        write_results(self.folder / "soft.h5", scale=2.0, overrides=("modes.chassis=2",))

    def test_it_stands_alone(self):
        text, _ = self.report("rigid.h5")
        self.assertNotRegex(text, r'(?i)<(script|link|img|iframe)[^>]*\b(src|href)="(?!data:)')
        self.assertNotRegex(text, r"(?i)@import|\burl\((?!['\"]?data:)")
        self.assertNotIn("sourceMappingURL", text)

    def test_where_samples_are_too_few_the_page_says_why_the_vibration_is_not_judged(self):
        _, data = self.report("rigid.h5")
        ride = data["runs"][0]["ride"]
        self.assertIn("a sample every 5 ms is too few", ride["problem"])
        self.assertEqual((ride["points"], [one["name"] for one in ride["tyres"]]), ([], ["front_tyre"]))

    def test_the_points_stand_in_the_order_of_the_vehicle_file(self):
        with h5py.File(self.folder / "rigid.h5", "a") as file:
            for point in ("chassis.front_end", "chassis.seat"):
                group = file.require_group(f"summary/points/{point}")
                group.attrs.update({"acceleration_max": 2.0, "acceleration_min": -1.0})
            write_series(file, "model/equilibrium/points/chassis.front_end", np.array((1.675, 0.975)), "m")
            write_texts(file, "model/resolved/settings/output_points", ["chassis.seat", "chassis.front_end"])
        _, data = self.report("rigid.h5")
        rows = [(row["of"], row["name"]) for row in data["runs"][0]["statistics"]]
        self.assertEqual(
            [row for row in rows if "acceleration" in row[1]],
            [(point, f"acceleration, {what}") for point in ("chassis.seat", "chassis.front_end")
             for what in ("highest", "lowest")],
        )  # fmt: skip

    def test_histories_are_the_results_with_the_units_of_the_file(self):
        _, data = self.report("a=rigid.h5", "b=soft.h5", "--show", "chosen=points/chassis.seat/position.x")
        self.assertEqual([run["label"] for run in data["runs"]], ["a", "b"])
        channels = {one["name"]: one for one in data["runs"][1]["channels"]}
        force = channels["front_tyre, force"]
        self.assertEqual((force["unit"], float(decode(force["v"]).max())), ("N", STATIC_LOAD))
        deflection = decode(channels["chassis.front_end, deflection in the body frame"]["v"])
        self.assertAlmostEqual(float(deflection.max()), 0.2 * HEAVE, places=7)
        self.assertEqual(channels["chosen"]["group"], "Asked for")
        self.assertEqual(decode(channels["chosen"]["t"]).size, NUM_SAMPLES)

    def test_the_summary_is_over_the_span_of_the_statistics(self):
        write_results(self.folder / "part.h5", settings={"statistics_from": 0.0, "statistics_to": 0.02})
        (run,) = self.report("part.h5")[1]["runs"]
        rows = {(row["of"], row["name"]): row["value"] for row in run["statistics"]}
        with h5py.File(self.folder / "part.h5") as file:
            inside = file["time"][:] <= 0.02
            off = np.count_nonzero(file["forces/front_tyre/contact"][:][inside] < 0.5)
            deflection = np.abs(file["points/chassis.front_end/deflection"][:, 1])
        self.assertEqual(run["window"], [0.0, 0.02])
        self.assertAlmostEqual(rows["front_tyre", "time off the road"], off * 1.0 / (NUM_SAMPLES - 1))
        expected = np.max(deflection[inside])
        self.assertLess(expected, 0.99 * np.max(deflection))
        self.assertAlmostEqual(rows["chassis.front_end", "deflection, largest"], expected)

    def test_the_summary_is_of_all_samples(self):
        _, data = self.report("soft.h5")
        rows = {(row["of"], row["name"]): row["value"] for row in data["runs"][0]["statistics"]}
        self.assertEqual(rows["front_tyre", "force, largest"], STATIC_LOAD)
        with h5py.File(self.folder / "soft.h5") as file:
            off = np.count_nonzero(file["forces/front_tyre/contact"][:] < 0.5)
        self.assertGreater(off, 0)
        self.assertAlmostEqual(rows["front_tyre", "time off the road"], off * 1.0 / (NUM_SAMPLES - 1))
        spans = decode(data["runs"][0]["frames"]["tyres"]["front_tyre"]["off"])
        self.assertAlmostEqual(float(np.sum(spans[1::2] - spans[::2])), off * 1.0 / (NUM_SAMPLES - 1), places=5)

    def test_the_settings_are_shown_with_versions_and_hashes(self):
        with h5py.File(self.folder / "soft.h5", "a") as file:
            file.attrs["program_version"] = np.bytes_("7.8.9")
        facts = dict(self.report("soft.h5")[1]["runs"][0]["facts"])
        self.assertEqual(facts["road"], "half-sine, length 0.4 m, height 0.2 m")
        self.assertEqual((facts["initial speed"], facts["changed by --set"]), ("3 m/s", "modes.chassis=2"))
        self.assertEqual(facts["flexible bodies"], "chassis: modes 1–2")
        self.assertEqual(
            (facts["sprung-dynamics"], facts["superelement chassis"]), ("7.8.9", "sprung-reduce 1.2, content 0123")
        )
        self.assertRegex(facts["results file, SHA-256"], r"^[0-9a-f]{64}$")

    def test_vectors_for_loads_are_no_modes_and_have_no_frequency(self):
        for kinds, fact, shown in (
            (None, "chassis: modes 1–2", [("mode 1", None), ("mode 2", None)]),
            (["free", "residual"], "chassis: free mode 1, residual vector 2",
             [("mode 1", 9.72), ("residual vector 2", None)]),
            (["clamped", "clamped"], "chassis: clamped modes 1–2", [("mode 1", 9.72), ("mode 2", 80.0)]),
        ):  # fmt: skip
            write_results(self.folder / "soft.h5")
            with h5py.File(self.folder / "soft.h5", "a") as file:
                if kinds:
                    write_series(file, "model/superelements/chassis/frequency", np.array([9.72, 80.0]), "Hz")
                    write_texts(file, "model/superelements/chassis/kind", kinds)
            (run,) = self.report("soft.h5")[1]["runs"]
            self.assertEqual(dict(run["facts"])["flexible bodies"], fact)
            self.assertEqual([(one["name"], one["frequency"]) for one in run["modes"][0]["modes"]], shown)
            self.assertEqual(run["modes"][0]["others"], bool(kinds) and "residual" in kinds)

    def test_the_frequencies_of_a_superelement_are_those_that_the_body_has(self):
        write_superelement(self.folder / "chassis.h5", "chassis", [9.72, 52.6, 80.0])
        with h5py.File(self.folder / "chassis.h5", "a") as file:
            write_texts(file, "modes/kind", ["free", "free", "residual"])
        (found,) = self.report("soft.h5", "--superelements", ".")[1]["superelements"]
        self.assertEqual((found["frequencies"], found["kind"], found["others"]), ([9.72, 52.6], "free", 1))

    def test_checks_are_shown_of_the_superelement_that_was_run_and_of_no_other(self):
        write_superelement(self.folder / "chassis.h5", "chassis", [6.11])
        (found,) = self.report("soft.h5", "--superelements", ".")[1]["superelements"]
        self.assertEqual((found["problem"], found["checks"][0]["value"], found["frequencies"]), ("", 1e-13, [6.11]))
        with h5py.File(self.folder / "chassis.h5", "a") as file:
            file.attrs["content_hash"] = np.bytes_("4567")
        (found,) = self.report("soft.h5", "--superelements", ".")[1]["superelements"]
        self.assertIn("is another superelement than the one that was run", found["problem"])
        self.assertEqual(found["checks"], [])
        (self.folder / "empty").mkdir()
        (found,) = self.report("soft.h5", "--superelements", "empty")[1]["superelements"]
        self.assertIn("there is no", found["problem"])
        mistaken = self.run_tool("report", "soft.h5", "-o", "other.html", "--superelements", "none")
        self.assert_refuses(mistaken, "none: error: no such folder")
        self.assertFalse((self.folder / "other.html").exists())

    def test_names_cannot_break_out_of_the_page(self):
        label = "</script><script>alert(1)</script> <!-- \"'&Ü @DATA@"
        path = self.folder / "ein Übler \"name' &.h5"
        os.rename(self.folder / "rigid.h5", path)
        text, data = self.report(f"{label}={path.name}", "--title", label)
        self.assertEqual((data["title"], data["runs"][0]["label"]), (label, label))
        self.assertEqual(text.count("</script>"), text.count("<script"))
        self.assertNotIn("<script>alert", text)

    def test_the_same_runs_give_the_same_bytes(self):
        texts = [self.report("rigid.h5", "soft.h5")[0] for _ in range(2)]
        self.assertEqual(*texts)

    def test_one_file_twice_has_two_names(self):
        _, data = self.report("rigid.h5", "rigid.h5")
        self.assertEqual(len({run["label"] for run in data["runs"]}), 2)

    def test_thinning_keeps_ends_and_peaks(self):
        values = np.sin(np.arange(60001) * 0.37)
        values[12345] = 7.0
        for most in (4000, 500):
            kept = find_kept(values, most)
            self.assertLessEqual(kept.size, most + 2)
            self.assertTrue({0, 12345, 60000} <= set(kept.tolist()))
            self.assertTrue(np.all(np.diff(kept) > 0))


class Refusing(ToolTestCase):
    def setUp(self):
        super().setUp()
        write_results(self.folder / "run.h5")

    def refuse(self, *arguments, fragment):
        before = sorted(os.listdir(self.folder))
        process = self.run_tool("report", *arguments)
        self.assert_refuses(process, fragment)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_files_that_are_missing_stopped_early_cut_short_or_something_else(self):
        self.refuse("none.h5", "-o", "a.html", fragment="none.h5: error: no such file")
        write_superelement(self.folder / "chassis.h5", "chassis", [6.11])
        self.refuse("chassis.h5", "-o", "a.html", fragment="chassis.h5: error: format is 'sprung-superelement'")
        content = (self.folder / "run.h5").read_bytes()
        (self.folder / "cut.h5").write_bytes(content[: len(content) // 2])
        self.refuse("run.h5", "cut.h5", "-o", "a.html", fragment="cut.h5: error: not a readable HDF5 file")
        with h5py.File(self.folder / "run.h5", "a") as file:
            file.attrs["complete"] = 0
        self.refuse("run.h5", "-o", "a.html", fragment="did not finish (complete = 0)")

    def test_what_a_file_lacks_is_named(self):
        for lacking in ("model/bodies", "model/resolved/points/chassis.seat/position",
                        "forces/front_tyre/force", "model/resolved/forces/front_tyre",
                        "bodies/chassis/modal/amplitude", "model/superelements/chassis/elements"):  # fmt: skip
            with self.subTest(lacking):
                write_results(self.folder / "run.h5")
                with h5py.File(self.folder / "run.h5", "a") as file:
                    del file[lacking]
                self.refuse("run.h5", "-o", "a.html", fragment=lacking.rpartition("/")[2])

    def test_a_run_whose_bodies_are_not_stored_is_not_drawn_but_all_else_is_shown(self):
        write_results(self.folder / "run.h5")
        with h5py.File(self.folder / "run.h5", "a") as file:
            del file["bodies/chassis/position"]
        process = self.run_tool("report", "run.h5", "-o", "a.html")
        self.assert_succeeds(process)
        (run,) = read_page(self.folder / "a.html")[1]["runs"]
        self.assertEqual((run["frames"], run["unknown"], run["span"]), (None, ["chassis"], [0.0, run["span"][1]]))
        self.assertIn("front_tyre, force", [one["name"] for one in run["channels"]])

    def test_values_that_are_not_finite(self):
        with h5py.File(self.folder / "run.h5", "a") as file:
            file["bodies/chassis/position"][3, 1] = np.nan
        self.refuse("run.h5", "-o", "a.html", fragment="'bodies/chassis/position' holds values that are not finite")

    def test_a_file_of_version_1_without_the_model_as_run(self):
        with h5py.File(self.folder / "run.h5", "a") as file:
            file.attrs["version"] = 1
            del file["model/resolved"]
        self.refuse("run.h5", "-o", "a.html", fragment="run.h5: error: holds no 'model/resolved', the model as run")

    def test_places_that_cannot_be_written_and_quantities_that_are_not_there(self):
        (self.folder / "folder").mkdir()
        self.refuse("run.h5", "-o", "folder", fragment="folder: error: cannot write the file")
        self.refuse("run.h5", "-o", "none/a.html", fragment="none/a.html: error: cannot write the file")
        self.refuse("run.h5", "-o", "", fragment="cannot write the file")
        self.refuse("run.h5", "-o", "run.h5", fragment="run.h5: error: is one of the input files")
        self.refuse(
            "run.h5", "-o", "a.html", "--show", "bodies/cab/position.x", fragment="no quantity 'bodies/cab/position.x'"
        )


if __name__ == "__main__":
    unittest.main()
