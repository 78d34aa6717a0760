"""runs/ride_assessment.py: all measures of a seat whose vibration is a sine, and people's reaction in words."""

import h5py
import numpy as np
from ride_results import SEAT_AMPLITUDE, SEAT_FREQUENCY, write_ride_results
from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.runs.ride_assessment import (
    calc_assessment,
    calc_bands,
    describe_comfort,
    list_remarks,
)
from sprung_tools.signals.absorbed_power import FEET_PER_METRE, calc_response
from sprung_tools.signals.ride_weighting import WD, WE, WK, calc_weighting
from sprung_tools.signals.third_octaves import NOMINAL

WINDOW = (2.0, 4.0)  # the filters have settled


class RideAssessment(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.results = open_results(write_ride_results(self.folder / "a.h5"))
        self.addCleanup(self.results.file.close)

    def test_the_measures_of_a_sine_are_those_of_its_weighted_amplitudes(self):
        found = calc_assessment(self.results, "points/body.seat", WINDOW)

        def rms(weighting, factor):
            gain = abs(calc_weighting(weighting, np.array([SEAT_FREQUENCY]))[0])
            return factor * SEAT_AMPLITUDE * gain / np.sqrt(2.0)

        # The seat moves by 1 vertically, ½ fore and aft, and the body turns by 3.
        fore_aft, vertical, pitch = rms(WD, 0.5), rms(WK, 1.0), rms(WE, 3.0)
        for value, expected in ((found.fore_aft, fore_aft), (found.vertical, vertical), (found.pitch, pitch)):
            self.assertAlmostEqual(value / expected, 1.0, delta=5e-3)
        self.assertAlmostEqual(found.total / np.sqrt(fore_aft**2 + vertical**2 + (0.4 * pitch) ** 2), 1.0, delta=5e-3)
        self.assertAlmostEqual(found.mtvv / vertical, 1.0, delta=5e-3)  # whole periods in every second
        self.assertAlmostEqual(found.crest, np.sqrt(2.0), delta=0.02)
        self.assertAlmostEqual(found.dose / (np.sqrt(2.0) * vertical * (0.375 * 2.0) ** 0.25), 1.0, delta=5e-3)
        power = 0.5 * (SEAT_AMPLITUDE * FEET_PER_METRE * abs(calc_response(SEAT_FREQUENCY))) ** 2
        self.assertAlmostEqual(found.power / power, 1.0, delta=5e-3)

    def test_vibration_before_the_span_does_not_count_in_its_largest_running_rms(self):
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            time = file["time"][:]
            file["points/body.seat/acceleration"][time < 1.6, :] *= 100.0
        with open_results(self.folder / "b.h5") as results:
            found = calc_assessment(results, "points/body.seat", WINDOW)
        self.assertLessEqual(found.mtvv, found.crest * found.vertical)  # no r.m.s. exceeds the largest value

    def test_a_centre_of_mass_is_judged_as_a_seat_is(self):
        found = calc_assessment(self.results, "bodies/body/center_of_mass", WINDOW)
        seat = calc_assessment(self.results, "points/body.seat", WINDOW)
        self.assertAlmostEqual(found.vertical, 0.5 * seat.vertical)
        self.assertAlmostEqual(found.pitch, seat.pitch)

    def test_a_remark_names_a_centre_of_mass_as_the_tables_do(self):
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            del file["bodies/body/acceleration"]
        with open_results(self.folder / "b.h5") as results:
            centre, seat = list_remarks(results, ["bodies/body/center_of_mass", "points/body.seat"], WINDOW)
        self.assertTrue(centre.startswith("body.center_of_mass: without We and the total: "), centre)
        self.assertTrue(seat.startswith("body.seat: without We and the total: "), seat)

    def test_the_sine_is_in_its_band(self):
        bands = calc_bands(self.results, "points/body.seat", (1.0, 3.0))
        self.assertEqual(NOMINAL[int(np.argmax(bands))], SEAT_FREQUENCY)
        self.assertAlmostEqual(np.max(bands), SEAT_AMPLITUDE / np.sqrt(2.0), delta=0.04)

    def test_vibration_before_and_after_the_span_is_forgotten(self):
        expected = calc_bands(self.results, "points/body.seat", (1.9, 2.1))
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            file["points/body.seat/acceleration"][np.abs(file["time"][:] - 2.0) > 1.9, :] *= 100.0
        with open_results(self.folder / "b.h5") as results:
            found = calc_bands(results, "points/body.seat", (1.9, 2.1))
        # 1.8 s from a bump of 200 m/s²; 15/f s from a shock a thousandth of the response is left.
        for centre, one, other in zip(NOMINAL, found, expected):
            if centre > 8.5:
                self.assertAlmostEqual(one, other, delta=0.2)
        self.assertGreater(found[0], expected[0])

    def test_the_squares_of_the_bands_add_up_to_the_mean_square_of_a_run_that_is_struck_at_its_end(self):
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            acceleration = file["points/body.seat/acceleration"]
            acceleration[:, 1] += 80.0 * np.maximum(0.0, (file["time"][:] - 3.95) / 0.05) ** 2
            rms = np.sqrt(np.mean(acceleration[:, 1] ** 2))
        with open_results(self.folder / "b.h5") as results:
            bands = calc_bands(results, "points/body.seat", (0.0, 4.0))
        self.assertAlmostEqual(np.sqrt(3.0 / np.pi * np.sum(np.square(bands))) / rms, 1.0, delta=0.05)

    def test_bands_that_the_samples_do_not_hold_are_not_known(self):
        # A sample every 10 ms is four in a period of 25 Hz. The sine of 5 Hz is in bands that both files hold.
        whole = calc_bands(self.results, "points/body.seat", WINDOW)
        self.assertNotIn(None, whole)
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            for name in ("time", "points/body.seat/acceleration"):
                values, unit = file[name][::10], file[name].attrs["unit"]
                del file[name]
                file[name] = values
                file[name].attrs["unit"] = unit
        with open_results(self.folder / "b.h5") as results:
            bands = calc_bands(results, "points/body.seat", WINDOW)
        known = NOMINAL.index(25.0) + 1
        self.assertEqual(bands[known:], [None] * (len(NOMINAL) - known))
        np.testing.assert_allclose(bands[:known], whole[:known], atol=0.01)

    def test_bands_are_refused_where_the_acceleration_is_not_stored_at_every_output(self):
        with h5py.File(write_ride_results(self.folder / "b.h5"), "a") as file:
            name = "points/body.seat/acceleration"
            values, unit = file[name][::2], file[name].attrs["unit"]
            del file[name]
            file[name] = values
            file[name].attrs.update({"unit": unit, "every": 2})
        with open_results(self.folder / "b.h5") as results:
            with self.assertRaisesRegex(InputError, "is stored every 2 ms only, but is needed at every output"):
                calc_bands(results, "points/body.seat", WINDOW)

    def test_the_words_are_those_of_the_standard_whose_ranges_overlap(self):
        for total, words in (
            (0.1, "not uncomfortable"), (0.4, "a little uncomfortable"),
            (0.55, "a little uncomfortable to fairly uncomfortable"), (1.1, "uncomfortable"),
            (1.4, "uncomfortable to very uncomfortable"), (3.0, "extremely uncomfortable"),
        ):  # fmt: skip
            self.assertEqual(describe_comfort(total), words)


if __name__ == "__main__":
    import unittest

    unittest.main()
