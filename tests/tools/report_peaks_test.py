"""tools/report_peaks: the numbers in its table."""

import math
import unittest

import h5py
from synthetic_results import CIRCULAR, HEAVE, write_results
from tool_test_case import ToolTestCase

DISPLACEMENT = "heave=bodies/chassis/displacement.y"


class ReportPeaks(ToolTestCase):
    def test_extremes_and_rms_of_a_sine_are_its_amplitude_and_its_amplitude_by_root_two(self):
        write_results(self.folder / "a.h5", num_modes=0)
        write_results(self.folder / "b.h5", scale=2.0)
        process = self.run_tool(
            "report_peaks",
            "one=a.h5",
            "two=b.h5",
            "--show",
            DISPLACEMENT,
            "--show",
            "points/chassis.seat/acceleration.y",
        )
        self.assertEqual(process.returncode, 0, process.stderr)
        rows = self.read_rows(process)
        # The samples hit the sine's extremes at 1/8 + k/2 and 3/8 + k/2 s; of 201 samples 200 are its two periods.
        rms = HEAVE * math.sqrt(100.0 / 201.0)
        self.assertEqual(
            rows[0],
            [
                "heave",
                "one",
                "-0.05",
                *self.at(0.375, 0.875, rows[0][3]),
                "0.05",
                *self.at(0.125, 0.625, rows[0][5]),
                f"{rms:.5g}",
                "m",
            ],
        )
        self.assertEqual(rows[1][:2], ["two", "-0.1"])
        peak = 2.0 * CIRCULAR**2 * HEAVE
        self.assertEqual([rows[2][1], rows[2][2], rows[2][-1]], ["one", f"{-peak:.5g}", "m/s^2"])

    @staticmethod
    def read_rows(process):
        """The rows of the table, below its rule, as lists of cells."""
        lines = process.stdout.splitlines()
        rule = next(number for number, line in enumerate(lines) if line.startswith("──"))
        return [line.split() for line in lines[rule + 1 :]]

    def at(self, first, second, found):
        # Both extremes of a kind are equal but for rounding, so either may be reported.
        self.assertIn(found, (f"{first:.3f}", f"{second:.3f}"))
        return [found]

    def test_a_span_of_time_limits_the_statistics(self):
        write_results(self.folder / "a.h5")
        process = self.run_tool("report_peaks", "a.h5", "--show", DISPLACEMENT, "--from", "0", "--to", "0.05")
        row = self.read_rows(process)[0]
        self.assertIn(f"{HEAVE * math.sin(CIRCULAR * 0.05):.5g}", row)
        self.assertNotIn("0.375", row)

    def test_the_span_is_that_of_its_own_statistics_unless_another_is_given_and_is_told(self):
        """It was the whole run, whatever its statistics, and was not told."""
        write_results(self.folder / "a.h5")
        write_results(self.folder / "b.h5", settings={"statistics_to": 0.05})
        tool = ("report_peaks", "one=a.h5", "two=b.h5", "--show", DISPLACEMENT)
        process = self.run_tool(*tool)
        self.assertEqual(process.stdout.splitlines()[0], "statistics over: one 0 to 1 s, two 0 to 0.05 s")
        one, two = self.read_rows(process)
        self.assertEqual((one[4], two[3]), ("0.05", f"{HEAVE * math.sin(CIRCULAR * 0.05):.5g}"))
        process = self.run_tool(*tool, "--from", "-1", "--to", "0.5")
        self.assertEqual(process.stdout.splitlines()[0], "statistics over: one 0 to 0.5 s, two 0 to 0.5 s")

    def test_of_a_file_that_does_not_tell_the_span_of_its_statistics_it_is_the_whole_run(self):
        write_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            del file["model/resolved"]
        process = self.run_tool("report_peaks", "one=a.h5", "--show", DISPLACEMENT, "--from", "0.5")
        self.assertEqual(process.stdout.splitlines()[0], "statistics over: one 0.5 to 1 s", process.stderr)

    def test_a_quantity_that_no_run_has_is_refused(self):
        write_results(self.folder / "a.h5", num_modes=0)
        process = self.run_tool("report_peaks", "a.h5", "--show", "points/chassis.front_end/deflection.y")
        self.assert_refuses(process, "a.h5: error: no quantity 'points/chassis.front_end/deflection.y'")

    def test_a_missing_file_is_refused(self):
        self.assert_refuses(
            self.run_tool("report_peaks", "a.h5", "--show", DISPLACEMENT), "a.h5: error: no such file"
        )


if __name__ == "__main__":
    unittest.main()
