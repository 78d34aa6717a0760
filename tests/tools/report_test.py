"""tools/report without a browser: the data of the page against the results, and the errors. report_page_test.py tests
what the page draws. Some cases are of whole runs, which need sprung-dynamics (SPRUNG_DYNAMICS)."""

import base64
import json
import os
import re
import unittest

import h5py
import numpy as np
from synthetic_results import (
    HEAVE,
    NUM_SAMPLES,
    STATIC_LOAD,
    write_results,
    write_series,
    write_superelement,
    write_texts,
)
from tool_test_case import ROOT, ToolTestCase, run_program

from sprung_tools.report.packing import find_kept
from sprung_tools.report.page import make_small_page
from sprung_tools.runs.labelled_runs import open_runs


def decode(text):
    return np.frombuffer(base64.b64decode(text), dtype="<f4")


def find_data(text):
    """The data in a page's text."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])


def read_page(path):
    """The page's text and its data."""
    text = path.read_text(encoding="utf-8")
    return text, find_data(text)


class Report(ToolTestCase):
    def setUp(self):
        super().setUp()
        write_results(self.folder / "rigid.h5", num_modes=0)
        write_results(self.folder / "soft.h5", scale=2.0, overrides=("modes.chassis=2",))

    def report(self, *arguments):
        process = self.run_tool("report", *arguments, "-o", "page.html")
        self.assert_succeeds(process)
        self.assertIn(f"Open it in a browser: {(self.folder / 'page.html').resolve().as_uri()}", process.stdout)
        return read_page(self.folder / "page.html")

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

    def drive(self, example, output, *arguments):
        command = [os.environ["SPRUNG_DYNAMICS"], "run", ROOT / f"dynamics/models/examples/{example}_run.toml"]
        run_program([*command, *arguments, "-o", output, "--quiet"], cwd=self.folder, check=True)

    def read_rows(self, data, of):
        return {row["name"]: row["value"] for row in data["runs"][0]["statistics"] if row["of"] == of}

    def test_a_mechanism_is_shown_along_the_axis_that_moves(self):
        self.drive("slider_crank", "slider.h5")  # a crank of 0.05 m: the piston moves 0.1 m along x, and not along y
        _, data = self.report("slider.h5")
        rows, channels = self.read_rows(data, "piston.origin"), data["runs"][0]["channels"]
        self.assertEqual({name.partition(",")[0] for name in rows}, {"displacement along x", "acceleration along x"})
        self.assertAlmostEqual(rows["displacement along x, lowest"], -0.1, places=4)
        self.assertEqual(rows["displacement along x, highest"], 0.0)  # from the start, its outermost place
        shown = [one["name"] for one in channels if one["group"] == "Motion of points"]
        self.assertEqual(shown, ["piston.origin, position along x", "piston.origin, acceleration along x"])
        self.assertEqual([one["name"] for one in data["runs"][0]["spectra"]], ["piston.origin along x"])
        acceleration = decode(channels[1]["v"])
        for name, value in (("highest", acceleration.max()), ("lowest", acceleration.min())):
            self.assertAlmostEqual(rows[f"acceleration along x, {name}"], float(value), places=4)

    def test_of_a_mechanism_that_moves_both_ways_the_larger_one_comes_first(self):
        self.drive("four_bar", "bars.h5")
        _, data = self.report("bars.h5")
        names = [one["name"] for one in data["runs"][0]["channels"] if one["group"] == "Motion of points"]
        ranges = [np.ptp(decode(one["v"])) for one in data["runs"][0]["channels"] if "position along" in one["name"]]
        self.assertEqual({name.split()[-1] for name in names}, {"x", "y"})
        self.assertGreater(ranges[0], ranges[1])
        self.assertTrue(names[0].startswith("coupler.middle, position along "))

    def test_runs_on_a_road_and_on_a_rig_are_shown_side_by_side(self):
        vehicle = (ROOT / "dynamics/models/examples/quarter_car.toml").read_text(encoding="utf-8")
        vehicle, _, _ = vehicle.partition('[[forces]]\nname = "tyre"')
        vehicle = vehicle.replace("[0.0, 5.0] }", "[0.0] }")  # the rig shakes the wheel, and stands
        shaker = "harmonic = { amplitude = 0.02, frequency = 2.0 }"
        vehicle += f'[[motions]]\nname = "shaker"\njoint = "wheel_slide"\nfunction = {{ {shaker} }}\n'
        (self.folder / "rig.toml").write_text(vehicle, encoding="utf-8")
        run = self.folder / "rig_run.toml"
        run.write_text('vehicle = "rig.toml"\nduration = 1.0\n', encoding="utf-8")
        self.drive("quarter_car", "road.h5", "--set", "duration=1.0")
        run_program([os.environ["SPRUNG_DYNAMICS"], "run", run, "-o", "rig.h5", "--quiet"], cwd=self.folder, check=True)
        _, data = self.report("road.h5", "rig.h5")
        shown = [[one["name"] for one in run["channels"] if one["group"] == "Vertical motion"] for run in data["runs"]]
        self.assertEqual(*shown)
        self.assertIn("sprung.origin, displacement", shown[1])
        names = [{row["name"] for row in run["statistics"] if row["of"] == "sprung.origin"} for run in data["runs"]]
        self.assertEqual(*names)
        self.assertGreaterEqual(len(names[0]), 6)

    def test_rounding_of_a_vehicle_at_rest_is_shown_as_nothing(self):
        self.drive("quarter_car", "rest.h5", "--set", 'road={shape="flat"}', "--set", "duration=0.5")
        _, data = self.report("rest.h5")
        rows = self.read_rows(data, "sprung.origin")
        self.assertEqual(set(rows.values()), {0.0})
        self.assertEqual(data["runs"][0]["spectra"], [])
        for channel in (one for one in data["runs"][0]["channels"] if one["group"] == "Vertical motion"):
            self.assertFalse(np.any(decode(channel["v"])), channel["name"])

    def test_a_spectrum_holds_the_mean_square_of_a_short_run_wherever_the_bump_lies(self):
        for duration in ("2", "6"):  # less and more than a segment
            self.drive("quarter_car", "bump.h5", "--set", f"duration={duration}")  # the bump begins after 0.4 s
            _, data = self.report("bump.h5")
            with h5py.File(self.folder / "bump.h5") as file:
                expected = np.var(file["points/sprung.origin/acceleration"][:, 1])
            (packed,) = [one for one in data["runs"][0]["spectra"] if one["name"] == "sprung.origin"]
            frequency, density = decode(packed["f"]), decode(packed["p"])
            # The lines at 0 Hz and above 200 Hz are not drawn.
            self.assertAlmostEqual(float(np.sum(density)) * frequency[0] / expected, 1.0, delta=0.02)

    def test_a_page_that_would_be_too_large_is_drawn_by_fewer_samples_with_the_same_numbers(self):
        self.drive("quarter_car", "car.h5", "--set", "duration=8")
        runs = open_runs([str(self.folder / "car.h5")])  # 8001 samples
        self.addCleanup(runs[0].results.file.close)
        pages = [make_small_page("", runs, [], [], largest) for largest in (15e6, 700e3, 1.0)]
        self.assertLess(len(pages[1]), 700e3)
        runs = [find_data(page)["runs"][0] for page in pages]
        self.assertEqual([run["frames"]["count"] for run in runs], [6000, 1500, 750])
        self.assertEqual([run["statistics"] for run in runs[1:]], [runs[0]["statistics"]] * 2)
        peaks = [decode(run["channels"][1]["v"]).max() for run in runs]
        self.assertEqual(peaks, [peaks[0]] * 3)

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
