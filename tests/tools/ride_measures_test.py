"""runs/ride_measures.py: each measure of histories whose values are known."""

import json
import re
import unittest

import h5py
import numpy as np
from ride_results import (
    SEAT_AMPLITUDE,
    SEAT_FREQUENCY,
    STATIC_DEFLECTION,
    STATIC_LOAD,
    STEP,
    write_ride_results,
)
from synthetic_results import write_series
from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.runs.largest_loads import MOMENT, calc_moment_difference, calc_peak, find_best_peak
from sprung_tools.runs.measures import measure_suspension
from sprung_tools.runs.ride_measures import (
    calc_comfort,
    calc_contact,
    calc_travel,
    find_suspensions,
    list_row_remarks,
    read_window,
)
from sprung_tools.runs.section_stress import FROM_LOADS
from sprung_tools.signals.ride_weighting import WK, calc_weighting

WINDOW = (1.0, 3.0)


def calc_dynamic_load():
    """R.m.s. of what max(0, 1 + 1.5 sin) differs from 1, times the static load [N], by a fine sum over a period."""
    phase = np.linspace(0.0, 2.0 * np.pi, 200000, endpoint=False)
    return STATIC_LOAD * np.sqrt(np.mean((np.maximum(0.0, 1.0 + 1.5 * np.sin(phase)) - 1.0) ** 2))


class RideMeasures(ToolTestCase):
    def open(self, *arguments, **options):
        path = self.folder / f"{len(list(self.folder.iterdir()))}.h5"
        results = open_results(write_ride_results(path, *arguments, **options))
        self.addCleanup(results.file.close)
        return results

    def test_the_window_is_the_runs_unless_another_is_given(self):
        self.assertEqual(read_window(self.open()), (1.0, 3.0))
        self.assertEqual(read_window(self.open(), None, 2.0), (1.0, 2.0))
        self.assertEqual(read_window(self.open(settings={"statistics_to": 2.5})), (1.0, 2.5))

    def test_the_window_is_the_part_that_the_run_has(self):
        results = self.open(settings={"statistics_from": 0.0})
        self.assertEqual(read_window(results, -5.0, 100.0), (0.0, 4.0))  # the run is from 0 to 4 s
        results.time = results.time + 0.25  # it continues another one
        self.assertEqual(read_window(results), (0.25, 3.0))

    def test_comfort_of_a_sine_is_its_weighted_amplitude(self):
        comfort = calc_comfort(self.open(), "points/body.seat", WINDOW)
        weighted = SEAT_AMPLITUDE * abs(calc_weighting(WK, SEAT_FREQUENCY))
        self.assertAlmostEqual(comfort.rms, SEAT_AMPLITUDE / np.sqrt(2.0), delta=1e-3)
        self.assertAlmostEqual(comfort.peak, SEAT_AMPLITUDE, places=9)
        self.assertAlmostEqual(comfort.weighted_rms, weighted / np.sqrt(2.0), delta=5e-3)
        self.assertAlmostEqual(comfort.dose, weighted * (0.375 * 2.0) ** 0.25, delta=5e-3)

    def test_travel_counts_from_balance_and_every_stroke_into_the_stop_is_a_hit(self):
        results = self.open()
        self.assertEqual(list(find_suspensions(results)), ["link", "suspension"])
        travel = calc_travel(results, "suspension", WINDOW)
        self.assertAlmostEqual(travel.compression, 0.1, places=6)
        self.assertAlmostEqual(travel.rebound, -0.1, places=6)
        self.assertAlmostEqual(travel.whole, 0.15 - STATIC_DEFLECTION, places=12)
        self.assertEqual(travel.hits, 2)  # the window holds two periods, each once above 0.15 - 0.06 = 0.09 of 0.1 m
        # 0.1 sin > 0.09: 2 · (1/2 - asin(0.9)/π) of each period
        self.assertAlmostEqual(travel.stopped, 2.0 * (0.5 - np.arcsin(0.9) / np.pi), delta=4 * STEP)

    def test_strokes_into_the_rebound_stop_count_by_themselves(self):
        results = self.open(rebound_stop=STATIC_DEFLECTION - 0.08)
        travel = calc_travel(results, "suspension", WINDOW)
        self.assertEqual((travel.hits, travel.rebound_hits), (2, 2))
        self.assertAlmostEqual(travel.rebound_stopped, 2.0 * (0.5 - np.arcsin(0.8) / np.pi), delta=4 * STEP)
        self.assertIsNone(calc_travel(results, "link", WINDOW).rebound_hits)
        self.assertEqual(measure_suspension(results, "suspension", WINDOW)["suspensions/suspension/rebound_stop_hits"],
                         (2, "1"))  # fmt: skip

    def test_the_stop_is_where_the_run_had_it(self):
        self.assertEqual(calc_travel(self.open(stop=0.17), "suspension", WINDOW).hits, 0)

    def test_a_suspension_without_a_stop_has_neither_hits_nor_a_whole(self):
        travel = calc_travel(self.open(), "link", WINDOW)
        self.assertEqual((travel.whole, travel.hits, travel.stopped), (None, None, None))

    def test_a_tyres_load_and_its_time_in_the_air(self):
        contact = calc_contact(self.open(), "tyre", WINDOW)
        self.assertAlmostEqual(contact.static, STATIC_LOAD, places=6)
        self.assertAlmostEqual(contact.greatest, 2.5 * STATIC_LOAD, delta=1.0)
        # In the air where sin < -0.8, without load where sin < -2/3
        self.assertAlmostEqual(contact.off_ground, 2.0 * (0.5 - np.arcsin(0.8) / np.pi), delta=4 * STEP)
        self.assertAlmostEqual(contact.unloaded, 2.0 * (0.5 - np.arcsin(2.0 / 3.0) / np.pi), delta=4 * STEP)
        self.assertAlmostEqual(contact.dynamic_rms / calc_dynamic_load(), 1.0, delta=1e-3)

    def test_histories_stored_at_some_outputs_are_judged_by_their_rows(self):
        """What was interpolated between them lowered the r.m.s., and left the tyre on the ground for most of its time
        in the air."""
        every = 50
        path = write_ride_results(self.folder / "thin.h5")
        with h5py.File(path, "a") as file:
            for name in ("forces/tyre/force", "forces/tyre/contact", "forces/suspension/deflection"):
                rows, attributes = file[name][::every], dict(file[name].attrs)
                del file[name]
                file[name] = rows
                file[name].attrs.update({**attributes, "every": every})
        row_step = every * STEP
        sine = np.sin(2.0 * np.pi * row_step * np.arange(round(1.0 / row_step), round(3.0 / row_step) + 1))
        load = STATIC_LOAD * np.maximum(0.0, 1.0 + 1.5 * sine)
        with open_results(path) as results:
            contact, travel = calc_contact(results, "tyre", WINDOW), calc_travel(results, "suspension", WINDOW)
            (remark,) = list_row_remarks(results)
        self.assertAlmostEqual(contact.dynamic_rms, np.sqrt(np.mean((load - STATIC_LOAD) ** 2)), places=6)
        self.assertAlmostEqual(contact.off_ground, row_step * np.count_nonzero(sine <= -0.8), places=12)
        self.assertAlmostEqual(contact.unloaded, row_step * np.count_nonzero(load <= 0.0), places=12)
        self.assertAlmostEqual(travel.stopped, row_step * np.count_nonzero(0.06 + 0.1 * sine > 0.15), places=12)
        self.assertIn("judged by rows every 50 ms", remark)
        process = self.run_tool("report_peaks", "thin.h5", "--show", "forces/tyre/force", "--from", "1", "--to", "3")
        self.assertEqual(process.stdout.splitlines()[-1].split()[-2], f"{np.sqrt(np.mean(load**2)):.5g}")

    def test_static_values_are_those_in_equilibrium_where_the_file_has_them(self):
        """They were those at the start, where the vehicle moves already or a wheel stands on an obstacle."""
        path = write_ride_results(self.folder / "a.h5")
        with h5py.File(path, "a") as file:
            file.create_group("model/equilibrium/forces/tyre").attrs["force"] = 4e4
            file.create_group("model/equilibrium/forces/suspension").attrs["deflection"] = 0.05
        with open_results(path) as results:
            self.assertEqual(calc_contact(results, "tyre", WINDOW).static, 4e4)
            travel = calc_travel(results, "suspension", WINDOW)
        self.assertAlmostEqual(travel.compression, STATIC_DEFLECTION + 0.1 - 0.05, places=9)
        self.assertAlmostEqual(travel.whole, 0.15 - 0.05, places=12)

    def test_the_largest_moment_keeps_its_sign_its_place_and_its_time(self):
        bending = find_best_peak(self.open(), "body", MOMENT, (1.2, 2.8))
        self.assertAlmostEqual(bending.value, -3e3, places=6)
        self.assertEqual((bending.x, bending.y, round(bending.time, 9)), (0.25, 0.1, 2.0))
        self.assertIsNone(find_best_peak(self.open(with_moments=False), "body", MOMENT, WINDOW))

    def test_uneven_or_too_few_samples_are_refused(self):
        results = self.open()
        results.time = results.time**2
        told = (r"0.h5: error: the samples in 'time' are not equally spaced: 1e-06 s from sample 1 at 0 s to the next"
                r".* expected equal ones.*: interpolate all histories to equal steps of at most 3\.125 ms, or make ")
        with self.assertRaisesRegex(InputError, told):
            calc_comfort(results, "points/body.seat", WINDOW)
        results.time = 10.0 * STEP * np.arange(results.time.size)
        with self.assertRaisesRegex(InputError, "0.h5: error: a sample every 10 ms is too few"):
            calc_comfort(results, "points/body.seat", WINDOW)

    def test_a_file_without_the_model_as_run_is_refused(self):
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            del file["model/resolved"]
        with open_results(self.folder / "b.h5") as results:
            for judge in (read_window, lambda results: calc_travel(results, "suspension", WINDOW)):
                with self.assertRaisesRegex(InputError, "b.h5: error: holds no 'model/resolved', the model as run"):
                    judge(results)


class ContinuedRun(ToolTestCase):
    """A run that begins at 0.25 s, where another one ended: the vehicle is in motion at its first sample."""

    def setUp(self):
        super().setUp()
        with h5py.File(write_ride_results(self.folder / "a.h5"), "a") as file:
            file["time"][:] += 0.25
            file.require_group("summary").attrs["energy_closure"] = 1e-9

    def test_what_refers_to_static_equilibrium_is_not_known_and_the_rest_is(self):
        with open_results(self.folder / "a.h5") as results:
            travel, contact = calc_travel(results, "suspension", WINDOW), calc_contact(results, "tyre", WINDOW)
        self.assertEqual((travel.compression, travel.rebound, travel.whole, travel.hits), (None, None, None, 2))
        self.assertEqual((contact.static, contact.dynamic_rms), (None, None))
        self.assertAlmostEqual(contact.greatest, 2.5 * STATIC_LOAD, delta=1.0)

    def test_tables_and_json_say_so(self):
        process = self.run_tool("ride", "truck=a.h5")
        self.assert_succeeds(process)
        rows = {line.split()[0]: line.split() for line in process.stdout.splitlines() if "truck" in line}
        self.assertEqual(rows["suspension"][2:6], ["–", "–", "–", "2"])
        self.assertEqual(rows["tyre"][2:6], ["–", "–", "–", "125.0"])
        reason = "static loads and travel are not known: the run continues another one from 0.25 s on"
        self.assertIn(f"remark: truck: {reason}", process.stdout)
        (run,) = json.loads(self.run_tool("ride", "a.h5", "--json").stdout)["runs"]
        for name in ("tyres/tyre/static_load", "suspensions/suspension/way_to_stop", "suspensions/link/compression"):
            self.assertIsNone(run["measures"][name]["value"], name)
        self.assertEqual(sum(one.startswith(reason) for one in run["remarks"]), 1)

    def test_the_filters_of_weighted_values_begin_at_rest(self):
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["time"][:] = np.linspace(0.25, 8.25, file["time"].size)
        for start, is_early in (("1.25", True), ("4.1", True), ("4.2", False)):  # 0.25 s + 3.89 s
            printed = self.run_tool("ride", "truck=a.h5", "--from", start, "--to", "8").stdout
            self.assertEqual("the MTVV and the other weighted values hold from 4.137 s on" in printed, is_early)


class Tool(ToolTestCase):
    def test_it_prints_a_table_for_each_kind_of_measure(self):
        write_ride_results(self.folder / "a.h5")
        process = self.run_tool("ride", "truck=a.h5")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("statistics over: truck 1 to 3 s", process.stdout)
        rows = {line.split()[0]: line.split() for line in process.stdout.splitlines() if "truck" in line}
        self.assertEqual(rows["body.seat"][2:4], ["1.414", "2"])
        self.assertEqual(rows["body.center_of_mass"][2:4], ["0.7069", "1"])
        self.assertEqual(rows["suspension"][2:], ["100.0", "111", "%", "-100.0", "2", "0.286", "–", "–"])
        self.assertEqual(rows["link"][2:], ["100.0", "–", "-100.0", "–", "–", "–", "–"])
        static, dynamic, share, greatest, off_ground, unloaded = map(float, rows["tyre"][2:])
        self.assertEqual((static, greatest, off_ground, unloaded), (50.0, 125.0, 0.41, 0.534))
        self.assertAlmostEqual(1e3 * dynamic / calc_dynamic_load(), 1.0, delta=1e-3)
        self.assertAlmostEqual(share, dynamic / static, delta=1e-3)
        self.assertEqual(rows["body"][2:], ["-3", "0.250", "0.100", "2.000", "-3", "–"])
        self.assertNotIn("its modes miss", process.stdout)

    def test_the_moment_from_the_loads_comes_first_with_that_of_the_modes_and_the_largest_difference(self):
        path = write_ride_results(self.folder / "a.h5")
        with h5py.File(path, "a") as file:
            moment = file["recovery/body/moment"][:]
            moment[2000, 1] -= 600.0  # at 2 s, the time of the largest one
            moment[1500, 0] += 900.0
            write_series(file, "recovery/body/moment_from_loads", moment, "N m")
        with open_results(path) as results:
            self.assertAlmostEqual(calc_peak(results, "body", MOMENT, FROM_LOADS, WINDOW).value, -3600.0, places=6)
            self.assertAlmostEqual(calc_moment_difference(results, "body", WINDOW), 900.0, places=6)
            self.assertAlmostEqual(calc_moment_difference(results, "body", (1.8, 2.2)), 600.0, places=6)
        printed = self.run_tool("ride", "truck=a.h5").stdout
        rows = [line.split() for line in printed.splitlines()]
        (found,) = [row[2:] for row in rows if row[:2] == ["body", "truck"]]
        self.assertIn("what 'its modes miss' is another number", printed)  # (section_loads, eq. 3)
        self.assertEqual(found, ["-3.6", "0.250", "0.100", "2.000", "-3", "0.9"])

    def test_every_heading_of_the_vibration_has_its_unit(self):
        write_ride_results(self.folder / "a.h5")
        (heading,) = [line for line in self.run_tool("ride", "a.h5").stdout.splitlines() if line.startswith("point ")]
        units = [word.rpartition(" ")[2] for word in re.split(r" {2,}", heading.strip())[2:]]
        self.assertEqual(units, ["m/s²", "m/s²", "m/s²", "m/s^1.75", "m/s²", "factor", "m/s²", "rad/s²", "m/s²", "W"])

    def test_a_span_that_is_too_short_for_the_mtvv_is_remarked_on(self):
        write_ride_results(self.folder / "a.h5")  # from 0 s
        for begin, end, is_short in (("0", "0.4", True), ("2.0", "2.4", True), ("0", "1.0", False)):
            printed = self.run_tool("ride", "truck=a.h5", "--from", begin, "--to", end).stdout
            remark = "remark: truck: the MTVV is the largest r.m.s. over 1 s, and the span has only 0.4 s: what is"
            self.assertEqual(remark in printed, is_short)

    def test_no_share_of_travel_is_given_if_the_vehicle_rests_on_its_stop(self):
        write_ride_results(self.folder / "a.h5", stop=0.05)
        rows = [line.split() for line in self.run_tool("ride", "truck=a.h5").stdout.splitlines()]
        self.assertEqual([row[2:4] for row in rows if row[:1] == ["suspension"] and "truck" in row], [["100.0", "–"]])

    def test_of_a_run_that_starts_as_given_static_values_are_called_mean_values(self):
        remark = "static equilibrium was not sought: static loads are mean values over the span"
        with h5py.File(write_ride_results(self.folder / "a.h5"), "a") as file:
            file["model/equilibrium"].attrs["is_static_equilibrium"] = 0
        write_ride_results(self.folder / "b.h5")
        for name, is_given in (("a.h5", True), ("b.h5", False)):
            self.assertEqual(remark in self.run_tool("ride", name).stdout, is_given)

    def test_a_tyre_without_load_has_no_load_over_static(self):
        # A drop test before the wheel touches the road.
        with h5py.File(write_ride_results(self.folder / "a.h5"), "a") as file:
            file["model/equilibrium"].attrs["is_static_equilibrium"] = 0
            file["forces/tyre/force"][:] = 0.0
        process = self.run_tool("ride", "truck=a.h5")
        self.assert_succeeds(process)
        (row,) = [line.split() for line in process.stdout.splitlines() if line.startswith("tyre ") and "truck" in line]
        self.assertEqual(row[2:6], ["0.00", "0.00", "–", "0.0"])

    def test_points_and_the_span_can_be_chosen(self):
        write_ride_results(self.folder / "a.h5", with_moments=False)
        process = self.run_tool("ride", "a.h5", "--points", "body.center_of_mass", "--from", "0", "--to", "4")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("rigid 0 to 4 s", process.stdout)
        self.assertNotIn("body.seat", process.stdout)
        self.assertNotIn("largest moment", process.stdout)

    def test_what_only_some_runs_have_is_in_the_tables_of_all(self):
        write_ride_results(self.folder / "a.h5")
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            file.move("forces/tyre", "forces/wheel")
            file.move("model/resolved/forces/tyre", "model/resolved/forces/wheel")
            for name in ("forces/link", "bodies/body", "recovery/body", "points/body.seat"):
                del file[name]
        for order in (("a=a.h5", "b=b.h5"), ("b=b.h5", "a=a.h5")):
            process = self.run_tool("ride", *order)
            self.assert_succeeds(process)
            rows = [re.split(r"  +", line.strip()) for line in process.stdout.splitlines()]
            cells = {}
            for first, *others in rows:  # the name stands in the first row only
                if first in ("a", "b"):
                    cells[(name, first)] = others
                elif others[:1] in (["a"], ["b"]):
                    name = first
                    cells[(name, others[0])] = others[1:]
            for missing, there in ((("link", "b"), ("link", "a")), (("tyre", "b"), ("tyre", "a")),
                                   (("wheel", "a"), ("wheel", "b"))):  # fmt: skip
                self.assertEqual(set(cells[missing]), {"–"}, (order, missing))
                self.assertNotEqual(set(cells[there]), {"–"}, (order, there))
            self.assertEqual(cells[("body", "a")][0], "-3")
            self.assertNotIn(("body", "b"), cells)

    def test_of_too_few_samples_the_values_that_need_no_more_are_given(self):
        with h5py.File(write_ride_results(self.folder / "a.h5"), "a") as file:
            file["time"][:] *= 10.0  # a sample every 10 ms
            file.require_group("summary").attrs["energy_closure"] = 1e-9
        process = self.run_tool("ride", "truck=a.h5")
        self.assert_succeeds(process)
        reason = "without the weighted values and the absorbed power: a sample every 10 ms is too few"
        self.assertIn(f"remark: truck: body.seat, body.center_of_mass: {reason}", process.stdout)
        rows = {line.split()[0]: line.split() for line in process.stdout.splitlines() if "truck" in line}
        self.assertEqual(rows["body.seat"][2:], ["1.411", "2", *["–"] * 8])
        self.assertEqual(rows["tyre"][2], "50.00")
        process = self.run_tool("ride", "a.h5", "--json")
        self.assert_succeeds(process)
        (run,) = json.loads(process.stdout)["runs"]
        self.assertAlmostEqual(run["measures"]["points/body.seat/peak"]["value"], SEAT_AMPLITUDE)
        self.assertIsNone(run["measures"]["points/body.seat/crest_factor"]["value"])
        self.assertTrue(run["remarks"][0].startswith(f"body.seat, body.center_of_mass: {reason}"))

    def test_the_rounding_of_a_vehicle_at_rest_is_no_vibration(self):
        with h5py.File(write_ride_results(self.folder / "a.h5"), "a") as file:
            for name in ("points/body.seat", "bodies/body/center_of_mass", "bodies/body"):
                file[f"{name}/acceleration"][:] *= 1e-13
            for name in ("deflection", "length"):
                file[f"forces/link/{name}"][:] = 0.06 + 1e-12 * np.arange(file["time"].size)[::-1]
        printed = self.run_tool("ride", "truck=a.h5").stdout
        rows = {line.split()[0]: line.split() for line in printed.splitlines() if line}
        self.assertEqual(rows["body.seat"][2:], ["0"] * 10)
        self.assertEqual([rows["link"][2], rows["link"][4]], ["0.0", "0.0"])
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["forces/link/deflection"][:] = 0.06 + 1e-15 * np.sin(np.arange(file["time"].size))
        with open_results(self.folder / "a.h5") as results:
            self.assertEqual(calc_travel(results, "link", WINDOW)[:2], (0.0, 0.0))

    def test_missing_quantities_are_refused(self):
        write_ride_results(self.folder / "a.h5")
        self.assert_refuses(self.run_tool("ride", "b.h5"), "b.h5: error: no such file")
        self.assert_refuses(
            self.run_tool("ride", "a.h5", "--points", "body.knee"),
            "a.h5: error: no quantity 'points/body.knee/",
        )
        self.assert_refuses(self.run_tool("ride", "a.h5", "--from", "9"), "a.h5: error: no samples from 9 to 3 s")

    def test_a_run_that_did_not_finish_is_refused(self):
        with h5py.File(write_ride_results(self.folder / "a.h5"), "a") as file:
            file.attrs["complete"] = 0
        self.assert_refuses(self.run_tool("ride", "a.h5"), "a.h5: error: the run that wrote this file did not finish")


if __name__ == "__main__":
    unittest.main()
