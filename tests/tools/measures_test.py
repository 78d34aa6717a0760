"""`ride --json`: every measure of runs and responses under its name, with its unit, and the warnings beside them."""

import json
import re
import unittest

import h5py
import numpy as np
from ride_results import write_ride_results
from synthetic_results import write_series
from tool_test_case import TOOLS, ToolTestCase

from sprung.results import Results
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.runs.largest_loads import MOMENT, find_best_peak
from sprung_tools.runs.measures import UNITS_OF, calc_measures, combine, list_history_objects, list_objects
from sprung_tools.runs.ride_assessment import calc_assessment, calc_bands
from sprung_tools.runs.ride_measures import calc_comfort, calc_contact, calc_travel
from sprung_tools.signals.third_octaves import NOMINAL

WINDOW = (1.0, 3.0)


def write_run(path, closure=1e-6):
    """A run with known measures, a summary, and the energy balance as given."""
    write_ride_results(path)
    with h5py.File(path, "a") as file:
        summary = file.create_group("summary")
        summary.attrs.update({"energy_closure": closure, "steps": 12})
        summary.create_group("points/body.seat").attrs.update({"displacement_max": 0.25, "acceleration_rms": 1.5})
        file["model/modes/undamped_frequency"] = [0.0, 1.5, 9.0]
        file["model/modes/damping_ratio"] = [0.0, 0.2, 0.1]
        for name in ("undamped_frequency", "damping_ratio"):
            file[f"model/modes/{name}"].attrs["unit"] = np.bytes_("")
        shear = np.zeros(file["recovery/body/moment"].shape)
        shear[0, 0], shear[2000, 1] = 90.0, -40.0  # outside and inside of the window
        write_series(file, "recovery/body/shear", shear, "N")
        for name in ("integrator", "adaptivity"):
            settings = file.require_group(f"model/resolved/settings/{name}")
            settings.attrs.update({"method": np.bytes_("adams"), "relative_tolerance": 1e-6, "largest_step": np.inf,
                                   "enabled": 0})  # fmt: skip
    return path


class Json(ToolTestCase):
    def read_json(self, *arguments):
        process = self.run_tool("ride", *arguments, "--json")
        self.assert_succeeds(process)
        return json.loads(process.stdout)

    def test_it_has_the_numbers_of_the_tables_under_their_names_with_units(self):
        path = write_run(self.folder / "a.h5")
        found = self.read_json("truck=a.h5")
        self.assertEqual((found["format"], found["version"]), ("sprung-measures", 4))
        (run,) = found["runs"]
        self.assertEqual((run["label"], run["file"], run["kind"], run["title"]), ("truck", "a.h5", "run", "synthetic"))
        self.assertEqual(run["span"], {"from": 1.0, "to": 3.0, "unit": "s"})
        with open_results(path) as results:
            comfort = calc_comfort(results, "points/body.seat", WINDOW)
            felt = calc_assessment(results, "points/body.seat", WINDOW)
            travel, contact = calc_travel(results, "suspension", WINDOW), calc_contact(results, "tyre", WINDOW)
            bending = find_best_peak(results, "body", MOMENT, WINDOW)
            expected_bands = calc_bands(results, "points/body.seat", WINDOW)
        expected = {
            "points/body.seat/rms": (comfort.rms, "m/s^2"), "points/body.seat/peak": (comfort.peak, "m/s^2"),
            "points/body.seat/wk_rms": (comfort.weighted_rms, "m/s^2"),
            "points/body.seat/vdv": (comfort.dose, "m/s^1.75"),
            "points/body.seat/mtvv": (felt.mtvv, "m/s^2"), "points/body.seat/crest_factor": (felt.crest, "1"),
            "points/body.seat/wd_rms": (felt.fore_aft, "m/s^2"), "points/body.seat/we_rms": (felt.pitch, "rad/s^2"),
            "points/body.seat/total": (felt.total, "m/s^2"), "points/body.seat/absorbed_power": (felt.power, "W"),
            "suspensions/suspension/compression": (travel.compression, "m"),
            "suspensions/suspension/rebound": (travel.rebound, "m"),
            "suspensions/suspension/way_to_stop": (travel.whole, "m"),
            "suspensions/suspension/stop_hits": (travel.hits, "1"),
            "suspensions/suspension/time_on_stop": (travel.stopped, "s"),
            "suspensions/link/way_to_stop": (None, "m"), "suspensions/link/stop_hits": (None, "1"),
            "tyres/tyre/static_load": (contact.static, "N"), "tyres/tyre/greatest_load": (contact.greatest, "N"),
            "tyres/tyre/dynamic_load_rms": (contact.dynamic_rms, "N"),
            "tyres/tyre/time_off_ground": (contact.off_ground, "s"),
            "tyres/tyre/time_without_load": (contact.unloaded, "s"),
            "loads/body/moment": (bending.value, "N m"), "loads/body/x": (0.25, "m"), "loads/body/y": (0.1, "m"),
            "loads/body/time": (bending.time, "s"), "loads/body/shear": (-40.0, "N"),
            "loads/body/axial": (None, "N"), "loads/body/axial_size": (None, "N"),
            "loads/body/moment_size": (abs(bending.value), "N m"), "loads/body/shear_size": (40.0, "N"),
            "loads/body/moment_from_modes": (bending.value, "N m"), "loads/body/shear_from_modes": (-40.0, "N"),
            "loads/body/axial_from_modes": (None, "N"), "loads/body/moment_difference": (None, "N m"),
            "modes/2/frequency": (1.5, "Hz"), "modes/2/damping_ratio": (0.2, "1"),
            "modes/3/frequency": (9.0, "Hz"), "summary/energy_closure": (1e-6, "1"), "summary/steps": (12.0, "1"),
            "summary/points/body.seat/displacement_max": (0.25, "m"),
            "summary/points/body.seat/acceleration_rms": (1.5, "m/s^2"),
        }  # fmt: skip
        for name, (value, unit) in expected.items():
            self.assertEqual(run["measures"][name], {"value": value, "unit": unit}, name)
        bands = {
            name.rpartition("/")[2]: one["value"] for name, one in run["measures"].items() if "bands/body.seat" in name
        }
        self.assertEqual([float(name) for name in bands], list(NOMINAL))
        np.testing.assert_array_equal(list(bands.values()), expected_bands)
        self.assertEqual(max(bands, key=bands.get), "5")  # a sine of 5 Hz
        self.assertEqual(sum(name.startswith("points/body.seat/") for name in run["measures"]), 10)
        self.assertEqual(sum(name.startswith("points/body.center_of_mass/") for name in run["measures"]), 10)

    def test_the_loads_of_a_body_are_from_its_loads_with_their_place_and_time_and_those_from_its_modes_beside(self):
        path = write_run(self.folder / "a.h5")
        with h5py.File(path, "a") as file:
            moments = np.zeros(file["recovery/body/moment"].shape)
            moments[1500, 3], moments[2500, 0] = -5e3, 4e3  # the largest is not where and when that of the modes is
            write_series(file, "recovery/body/moment_from_loads", moments, "N m")
            write_series(file, "recovery/body/shear_from_loads", -0.5 * moments, "N")
            write_series(file, "recovery/body/axial_from_loads", 0.1 * moments, "N")
            file["recovery/body/axial"] = np.full(moments.shape, 1e-7)
            file["recovery/body/axial"].attrs["unit"] = np.bytes_("N")
            difference = np.max(np.abs(moments - file["recovery/body/moment"][:])[1000:3001])
        (run,) = self.read_json("a.h5")["runs"]
        of_body = [name for name in run["measures"] if name.startswith("loads/body/")]
        found = {name.rpartition("/")[2]: run["measures"][name]["value"] for name in of_body}
        expected = {
            "moment": -5e3, "x": 1.0, "y": 0.0, "time": 1.5, "shear": 2.5e3, "axial": -500.0, "moment_size": 5e3,
            "shear_size": 2.5e3, "axial_size": 500.0, "moment_from_modes": -3e3, "shear_from_modes": -40.0,
            "axial_from_modes": 1e-7, "moment_difference": difference,
        }  # fmt: skip
        self.assertEqual(set(found), set(expected))
        for name, value in expected.items():
            self.assertAlmostEqual(found[name], value, places=9, msg=name)
        rows = [line.split() for line in self.run_tool("ride", "truck=a.h5").stdout.splitlines()]
        (row,) = [row[2:] for row in rows if row[:2] == ["body", "truck"]]
        self.assertEqual(row, ["-5", "1.000", "0.000", "1.500", "-3", f"{1e-3 * difference:.4g}"])

    def test_the_largest_loads_that_the_run_itself_has_found_count_where_its_file_holds_some_rows_only(self):
        path = write_run(self.folder / "a.h5")
        with h5py.File(path, "a") as file:
            file.create_group("summary/sections/body").attrs.update(
                {"moment": -7e3, "moment_station": 1, "moment_time": 1.7254}
            )
        with open_results(path) as results:
            peak = find_best_peak(results, "body", MOMENT, WINDOW)
            self.assertEqual((peak.value, peak.x, peak.time),
                             (-7e3, results.file.numbers("recovery/body/station")[0][1, 0], 1.7254))  # fmt: skip
            # Of another span than that of the run's statistics: from the rows of the file
            self.assertAlmostEqual(find_best_peak(results, "body", MOMENT, (1.2, 2.8)).value, -3e3, places=6)
        with h5py.File(path, "a") as file:
            file["summary/sections/body"].attrs["moment_station"] = 99
        self.assert_refuses(self.run_tool("ride", "a.h5"), "'summary/sections/body' has moment_station = 99")

    def test_without_the_motion_of_bodies_only_what_needs_their_rotation_is_left_out_and_named(self):
        write_run(self.folder / "whole.h5")
        with h5py.File(write_run(self.folder / "a.h5"), "a") as file:
            del file["bodies/body/acceleration"], file["bodies/body/center_of_mass"]
        whole, run = self.read_json("whole.h5", "a.h5")["runs"]
        self.assertEqual({name.split("/")[1] for name in run["measures"] if name.startswith("points/")}, {"body.seat"})
        for name in UNITS_OF["points"]:
            left_out = name in ("we_rms", "total")
            expected = None if left_out else whole["measures"][f"points/body.seat/{name}"]["value"]
            self.assertEqual(run["measures"][f"points/body.seat/{name}"]["value"], expected, name)
        for arguments in ((), ("--points", "body.seat")):
            process = self.run_tool("ride", "truck=a.h5", *arguments)
            self.assert_succeeds(process)
            gap = "body.seat: without We and the total: 'bodies/body/acceleration' is not stored"
            self.assertIn(f"remark: truck: {gap}", process.stdout)
        process = self.run_tool("ride", "truck=a.h5", "--points", "body.center_of_mass")  # asked for, and not there
        self.assertEqual(process.returncode, 2)

    def test_of_points_that_are_stored_at_some_outputs_only_what_the_rows_tell_is_given(self):
        """No measure of the run was given, those of tyres and suspensions either."""
        write_run(self.folder / "whole.h5")
        every = 20
        with h5py.File(write_run(self.folder / "a.h5"), "a") as file:
            name = "points/body.seat/acceleration"
            rows, attributes = file[name][::every], dict(file[name].attrs)
            del file[name]
            file[name] = rows
            file[name].attrs.update({**attributes, "every": every})
            time = file["time"][::every]
        peaks = np.abs(rows[(time >= 1.0) & (time <= 3.0), 1])  # over the span of its statistics
        whole, run = self.read_json("whole.h5", "a.h5")["runs"]
        known = {"rms": np.sqrt(np.mean(peaks**2)), "peak": np.max(peaks)}
        for name, measure in run["measures"].items():
            place, _, last = name.rpartition("/")
            expected = whole["measures"][name]["value"]
            if place in ("points/body.seat", "bands/body.seat"):
                expected = known.get(last) if place.startswith("points") else None
            if expected is None:
                self.assertIsNone(measure["value"], name)
            else:
                self.assertAlmostEqual(measure["value"], expected, places=9, msg=name)
        reason = "'points/body.seat/acceleration' is stored every 20 ms only, but is needed at every output: make"
        (remark,) = [one for one in run["remarks"] if one.startswith("body.seat")]
        self.assertIn("without the weighted values, the absorbed power and the third-octave bands, and", remark)
        self.assertIn(reason, remark)
        process = self.run_tool("ride", "truck=a.h5")
        self.assert_succeeds(process)
        self.assertIn(f"remark: truck: {remark}", process.stdout)
        with Results(self.folder / "a.h5") as results:
            self.assertAlmostEqual(results.measure("points/body.seat/peak"), known["peak"], places=9)
            for name in ("points/body.seat/wk_rms", "bands/body.seat/4"):
                with self.assertRaisesRegex(InputError, f"{name}: the run has no such value .*; {reason}"):
                    results.measure(name)

    def test_a_run_that_is_too_short_for_the_mtvv_has_a_remark(self):
        write_run(self.folder / "a.h5")
        for end, count in (("0.4", 1), ("1.0", 0)):
            (run,) = self.read_json("a.h5", "--from", "0", "--to", end)["runs"]
            self.assertEqual(sum("the MTVV is the largest r.m.s. over 1 s" in one for one in run["remarks"]), count)

    def test_points_and_span_are_those_asked_for(self):
        write_run(self.folder / "a.h5")
        (run,) = self.read_json("a.h5", "--points", "body.center_of_mass", "--from", "0.5")["runs"]
        self.assertEqual(run["span"]["from"], 0.5)
        points = {name.split("/")[1] for name in run["measures"] if name.startswith("points/")}
        self.assertEqual(points, {"body.center_of_mass"})

    def test_a_run_whose_energy_balance_does_not_close_has_not_converged_and_says_so(self):
        write_run(self.folder / "good.h5")
        write_run(self.folder / "bad.h5", closure=0.02)
        good, bad = self.read_json("good.h5", "bad.h5")["runs"]
        self.assertTrue(good["converged"])
        # Its tyre leaves the ground.
        self.assertEqual([(one["concerns"], one["of"]) for one in good["warnings"]], [("equilibrium", ["tyre"])])
        self.assertFalse(bad["converged"])
        self.assertEqual(bad["warnings"][0]["concerns"], "summary")
        self.assertIn("the energy balance does not close (relative 2.0e-02)", bad["warnings"][0]["text"])

    def test_a_run_has_converged_if_it_says_so_itself(self):
        """Its accelerations may not be converged, though its energy balance closes."""
        for name, converged in (("good.h5", 1), ("bad.h5", 0)):
            write_run(self.folder / name)
            with h5py.File(self.folder / name, "a") as file:
                file["summary"].attrs["converged"] = converged
        self.assertEqual([one["converged"] for one in self.read_json("good.h5", "bad.h5")["runs"]], [True, False])

    def test_any_history_gives_its_extremes_its_mean_and_its_rms(self):
        with open_results(write_run(self.folder / "a.h5")) as results:
            wanted = ["histories/points/body.seat/acceleration.y/max", "histories/points/none/acceleration.y/max"]
            found = calc_measures(list_history_objects(results, WINDOW, wanted))
        values = {name.rpartition("/")[2]: one for name, one in found.items()}
        # A sine of 2 m/s², ten periods of it
        self.assertEqual({one.unit for one in values.values()}, {"m/s^2"})
        for name, expected in (("min", -2.0), ("max", 2.0), ("mean", 0.0), ("rms", np.sqrt(2.0))):
            self.assertAlmostEqual(values[name].value, expected, delta=1e-3)

    def test_a_value_that_is_no_number_is_refused(self):
        with self.assertRaisesRegex(InputError, "tyres/t/load: error: the measure is nan, expected a finite number"):
            combine("tyres/t", {"load": "N"}, [np.nan])

    def test_only_what_is_evaluated_is_computed(self):
        with open_results(write_run(self.folder / "a.h5")) as results:
            objects = list_objects(results, WINDOW, ["body.none"])
            self.assertEqual(set(objects["tyres/tyre"]()), {f"tyres/tyre/{name}" for name in UNITS_OF["tyres"]})


class Documentation(unittest.TestCase):
    def test_the_readme_lists_every_measure_with_its_unit(self):
        text = (TOOLS / "README.md").read_text(encoding="utf-8")
        section = text.partition("\n## Measures\n")[2].partition("\n## ")[0]
        listed = {}
        for group, cell in re.findall(r"^\| `(\w+)/[^`]*` \| (.+) \|$", section, re.MULTILINE):
            listed[group] = dict(re.findall(r"`(\w+)` \[([^\]]+)\]", cell))
        plain = {"m/s^2": "m/s²", "m/s^1.75": "m/s^1.75", "rad/s^2": "rad/s²", "N m": "N·m"}
        for group, units in UNITS_OF.items():
            self.assertEqual(listed[group], {name: plain.get(unit, unit) for name, unit in units.items()})


if __name__ == "__main__":
    unittest.main()
