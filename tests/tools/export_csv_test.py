"""tools/export_csv: columns, units and values against the results file, and what is refused. One case is of a whole
run, which needs sprung-dynamics (SPRUNG_DYNAMICS)."""

import csv
import os
import unittest

import numpy as np
from synthetic_results import CIRCULAR, HEAVE, STATIC_HEIGHT, write_results
from tool_test_case import ROOT, ToolTestCase, run_program

from sprung_tools.files.results_file import open_results


def read_table(path):
    """(headings, values [n×k])."""
    with open(path, encoding="utf-8", newline="") as file:
        headings, *rows = csv.reader(file)
    return headings, np.array(rows, dtype=float)


class ExportCsv(ToolTestCase):
    def setUp(self):
        super().setUp()
        write_results(self.folder / "run.h5", start_offset=0.02)

    def export(self, *arguments):
        process = self.run_tool("export_csv", *arguments)
        self.assert_succeeds(process)
        return process.stdout

    def test_each_column_has_its_name_and_its_own_unit(self):
        quantities = (
            "bodies/chassis/displacement.y", "bodies/chassis/position.angle", "bodies/chassis/acceleration.angle",
            "forces/front_tyre/force", "forces/front_tyre/contact", "bodies/chassis/modal/amplitude.2",
        )  # fmt: skip
        self.export("run.h5", "-o", "a.csv", *(part for one in quantities for part in ("--show", one)))
        headings, values = read_table(self.folder / "a.csv")
        units = ("m", "rad", "rad/s^2", "N", "1", "m√kg")
        self.assertEqual(headings, ["time [s]", *(f"{name} [{unit}]" for name, unit in zip(quantities, units))])
        self.assertEqual(values.shape, (201, 7))

    def test_values_are_the_formula_s_and_those_of_the_file_to_the_last_bit(self):
        self.export("run.h5", "-o", "a.csv", "--show", "heave=bodies/chassis/displacement.y",
                    "--show", "bodies/chassis/position.y")  # fmt: skip
        headings, values = read_table(self.folder / "a.csv")
        self.assertEqual(headings[1], "heave [m]")
        expected = 0.02 + HEAVE * np.sin(CIRCULAR * values[:, 0])
        np.testing.assert_allclose(values[:, 1], expected, atol=1e-15)
        np.testing.assert_allclose(values[:, 2], STATIC_HEIGHT + expected, atol=1e-15)
        with open_results(str(self.folder / "run.h5")) as results:
            np.testing.assert_array_equal(values[:, 0], results.time)
            np.testing.assert_array_equal(values[:, 2], results.series("bodies/chassis/position.y")[0])

    def test_a_span_of_time_has_both_its_ends(self):
        told = self.export("run.h5", "-o", "a.csv", "--show", "t=time", "--from", "0.25", "--to", "0.75")
        _, values = read_table(self.folder / "a.csv")
        self.assertEqual((values[0, 0], values[-1, 0], len(values)), (0.25, 0.75, 101))
        self.assertIn("a.csv: 101 rows, 2 columns", told)

    def test_a_label_with_commas_and_quotes_is_one_heading(self):
        self.export("run.h5", "-o", "mine & yours.csv", "--show", 'a, "b" Ü=bodies/chassis/position.x')
        self.assertEqual(read_table(self.folder / "mine & yours.csv")[0][1], 'a, "b" Ü [m]')

    def test_wrong_names_and_places_are_refused_and_leave_no_file(self):
        (self.folder / "folder.csv").mkdir()
        before = sorted(os.listdir(self.folder))
        y = "bodies/chassis/position.y"
        for fragment, file, output, *rest in (
            (
                "run.h5: error: no quantity 'bodies/cab/position.y': '/bodies' holds chassis",
                "run.h5",
                "a.csv",
                "bodies/cab/position.y",
            ),
            ("no quantity 'forces/front_tyre/torque'", "run.h5", "a.csv", "forces/front_tyre/torque"),
            ("has component 'z', expected x, y, angle", "run.h5", "a.csv", "bodies/chassis/position.z"),
            ("has component '', expected x, y, angle", "run.h5", "a.csv", "bodies/chassis/position"),
            ("has component '3', expected 1 to 2", "run.h5", "a.csv", "bodies/chassis/modal/amplitude.3"),
            ("no samples from 2 to 1 s", "run.h5", "a.csv", y, "--from", "2"),
            ("none.h5: error: no such file", "none.h5", "a.csv", y),
            ("none/a.csv: error: cannot write the file", "run.h5", "none/a.csv", y),
            ("--show: error: the heading 'time [s]' stands twice", "run.h5", "a.csv", "time"),
            ("--show: error: the heading 'a [m]' stands twice", "run.h5", "a.csv", f"a={y}", "--show", f"a={y[:-1]}x"),
            ("run.h5: error: is one of the input files", "run.h5", "run.h5", y),
            ("folder.csv: error: cannot write the file", "run.h5", "folder.csv", y),
        ):
            with self.subTest(fragment):
                process = self.run_tool("export_csv", file, "-o", output, "--show", *rest)
                self.assert_refuses(process, fragment)
                self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_an_earlier_table_stays_when_the_new_one_is_refused(self):
        self.export("run.h5", "-o", "a.csv", "--show", "t=time")
        before = (self.folder / "a.csv").read_bytes()
        self.assert_refuses(self.run_tool("export_csv", "run.h5", "-o", "a.csv", "--show", "nothing"), "no quantity")
        self.assertEqual((self.folder / "a.csv").read_bytes(), before)

    def test_a_whole_run_falls_under_gravity(self):
        command = [os.environ["SPRUNG_DYNAMICS"], "run", ROOT / "dynamics/models/examples/pendulum_run.toml"]
        run_program([*command, "-o", "p.h5", "--set", "duration=1", "--quiet"], cwd=self.folder, check=True)
        self.export("p.h5", "-o", "a.csv", *(part for one in "xy" for part in ("--show", f"bodies/bob/position.{one}")))
        headings, values = read_table(self.folder / "a.csv")
        self.assertEqual(headings[1:], ["bodies/bob/position.x [m]", "bodies/bob/position.y [m]"])
        np.testing.assert_allclose(np.hypot(values[:, 1], values[:, 2]), 1.0, atol=1e-9)  # the rod's length
        np.testing.assert_allclose(values[1, 2], -0.5 * 9.81 * values[1, 0] ** 2, rtol=1e-4)  # at first a free fall


if __name__ == "__main__":
    unittest.main()
