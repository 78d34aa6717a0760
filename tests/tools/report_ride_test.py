"""report/ride.py: the ride on the page is what the measures say, and a mechanism has none."""

import unittest

import h5py
import numpy as np
from ride_results import STEP, write_ride_results
from tool_test_case import ToolTestCase

from sprung_tools.files.results_file import open_results
from sprung_tools.report.ride import calc_vibrations, list_ride_channels, pack_boundaries, pack_ride
from sprung_tools.runs.ride_assessment import calc_assessment
from sprung_tools.runs.ride_measures import calc_contact, calc_travel
from sprung_tools.signals.ride_weighting import RUNNING

WINDOW = (1.0, 3.0)  # of the run's statistics


class ReportRide(ToolTestCase):
    def open(self, name="a.h5"):
        results = open_results(self.folder / name)
        self.addCleanup(results.file.close)
        return results

    def test_it_has_the_measures_of_seats_suspensions_and_tyres(self):
        write_ride_results(self.folder / "a.h5")
        results = self.open()
        vibrations = calc_vibrations(results)
        ride = pack_ride(results, vibrations, "")
        (seat,) = ride["points"]
        expected = calc_assessment(results, "points/body.seat", WINDOW)
        self.assertEqual(seat["name"], "body.seat")
        self.assertEqual({name: seat[name] for name in expected._fields}, expected._asdict())
        self.assertEqual(seat["words"], "uncomfortable to very uncomfortable")
        self.assertEqual(len(seat["bands"]), len(pack_boundaries()["centres"]))
        link, suspension = ride["travel"]
        self.assertEqual(suspension, {"name": "suspension", **calc_travel(results, "suspension", WINDOW)._asdict()})
        self.assertIsNone(link["hits"])
        (tyre,) = ride["tyres"]
        self.assertEqual(tyre, {"name": "tyre", **calc_contact(results, "tyre", WINDOW)._asdict()})
        (channel,) = list_ride_channels(vibrations)
        inside = (results.time >= WINDOW[0] + RUNNING) & (results.time <= WINDOW[1])  # so is the second before
        self.assertAlmostEqual(np.max(channel.values[inside]), expected.mtvv)

    def test_a_run_that_continues_another_one_has_no_values_in_equilibrium_and_says_why(self):
        write_ride_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["time"][:] += 0.25
        ride = pack_ride(self.open(), {}, "")
        self.assertEqual([one["compression"] for one in ride["travel"]], [None, None])
        self.assertEqual([one["static"] for one in ride["tyres"]], [None])
        self.assertIn("static loads and travel are not known", "; ".join(ride["remarks"]))

    def test_unequally_spaced_samples_are_told_as_the_reason_why_it_is_not_there(self):
        write_ride_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["time"][1] = 0.5 * STEP
        ride = pack_ride(self.open(), {}, "")
        self.assertIn("the samples in 'time' are not equally spaced", ride["problem"])
        self.assertEqual((ride["points"], ride["travel"], ride["tyres"]), ([], [], []))

    def test_a_mechanism_without_tyres_and_seat_has_none(self):
        write_ride_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            del file["points/body.seat"], file["forces/tyre"], file["model/resolved/forces/tyre"]
        self.assertIsNone(pack_ride(self.open(), {}, ""))


if __name__ == "__main__":
    unittest.main()
