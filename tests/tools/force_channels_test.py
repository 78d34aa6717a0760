#!/usr/bin/python3
"""Elements with several forces or deflections: each has a name of its own in tables and diagrams, and what belongs to
springs alone leaves out the others."""

import sys
import unittest
from pathlib import Path

import h5py
import numpy as np
from ride_results import ENDS, write_ride_results
from synthetic_results import write_element, write_series
from tool_test_case import ToolTestCase

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from sprung_tools.files.results_file import open_results  # noqa: E402  after the path
from sprung_tools.report.histories import list_channels  # noqa: E402
from sprung_tools.report.shown_motion import ShownMotion  # noqa: E402
from sprung_tools.report.summary import calc_force_rows  # noqa: E402
from sprung_tools.runs.ride_measures import calc_travel, find_suspensions  # noqa: E402

# Element: kind, drawing, place in the vehicle file; and of each channel the role, the unit and the largest value.
ELEMENTS = {
    "bush": ("bushing", "spring", 4, {
        "deflection_x": ("deflection", "m", 0.01), "deflection_y": ("deflection", "m", 0.02),
        "deflection_rotation": ("deflection", "rad", 0.3), "force_x": ("force", "N", 100.0),
        "force_y": ("force", "N", 200.0), "torque": ("torque", "N m", 5.0)}),
    "leaf": ("leaf-spring", "spring", 3, {
        "length": ("extent", "m", 0.4), "deflection": ("deflection", "m", 0.1), "force": ("force", "N", 5e4),
        "friction": ("force", "N", 3e3)}),
    "air": ("air-spring", "spring", 2, {
        "length": ("extent", "m", 0.4), "deflection": ("deflection", "m", 0.05), "force": ("force", "N", 7e4),
        "partner_length": ("extent", "m", 0.4), "partner_deflection": ("deflection", "m", 0.06),
        "partner_force": ("force", "N", 8e4)}),
    "stop": ("hydraulic-stop", "rod", 5, {
        "length": ("extent", "m", 0.4), "overlap": ("deflection", "m", 0.1), "force": ("force", "N", 2e4)}),
    "suspension": (None, None, 1, {}),
}  # fmt: skip


class ForceChannels(ToolTestCase):
    def setUp(self):
        super().setUp()
        path = write_ride_results(self.folder / "results.h5")
        with h5py.File(path, "a") as file:
            time = file["time"][()]
            for name, (kind, drawing, place, channels) in ELEMENTS.items():
                if kind:
                    write_element(file, f"forces/{name}", kind, drawing, ENDS, {})
                for channel, (role, unit, largest) in channels.items():
                    values = largest * np.sin(2.0 * np.pi * time) - 0.07 * (channel == "overlap")
                    write_series(file, f"forces/{name}/{channel}", values, unit)
                    file[f"forces/{name}/{channel}"].attrs["role"] = np.bytes_(role)
                file[f"model/resolved/forces/{name}"].attrs["place"] = place
        self.results = open_results(path)
        self.addCleanup(self.results.file.close)

    def test_the_summary_has_the_largest_of_each_under_its_own_name(self):
        expected = {
            "stop": {"force": 2e4, "overlap": 0.03},
            "leaf": {"force": 5e4, "friction": 3e3, "compression from the free length": 0.1},
            "air": {"force": 7e4, "partner force": 8e4, "compression from the design height": 0.05,
                    "partner compression from the design height": 0.06},
            "bush": {"force along x": 100.0, "force along y": 200.0, "torque": 5.0, "deflection along x": 0.01,
                     "deflection along y": 0.02, "turn": 0.3},
        }  # fmt: skip
        every = np.ones(self.results.time.size, dtype=bool)
        for force, values in expected.items():
            rows = {row.name: row.value for row in calc_force_rows(self.results, force, every)}
            self.assertEqual(set(rows), {f"{name}, largest" for name in values})
            for name, value in values.items():
                self.assertAlmostEqual(rows[f"{name}, largest"], value, places=9)

    def test_no_two_diagrams_have_one_name(self):
        channels = list_channels(self.results, [], [], ShownMotion([self.results]))
        names = [channel.name for channel in channels if channel.group == "Forces"]
        self.assertIn("leaf, friction", names)
        self.assertEqual(len(names), len(set(names)), names)

    def test_suspensions_are_springs_along_a_line_and_coupled_ones_are_two(self):
        found = find_suspensions(self.results)
        self.assertEqual(list(found), ["link", "suspension", "air", "air partner", "leaf", "stop"])
        self.assertEqual(found["air partner"], "forces/air/partner_deflection")
        travel = calc_travel(self.results, "air partner", (1.0, 3.0))
        self.assertAlmostEqual(travel.compression, 0.06, places=6)
        self.assertAlmostEqual(travel.rebound, -0.06, places=6)

    def test_an_end_stop_is_struck_where_its_parts_overlap(self):
        # 0.1 sin − 0.07 from −0.07 in balance: above 0 once in each of two periods, (1/2 − asin(0.7)/π) of each.
        travel = calc_travel(self.results, "stop", (1.0, 3.0))
        self.assertAlmostEqual(travel.compression, 0.1, places=6)
        self.assertAlmostEqual(travel.whole, 0.07, places=12)
        self.assertEqual(travel.hits, 2)
        self.assertAlmostEqual(travel.stopped, 2.0 * (0.5 - np.arcsin(0.7) / np.pi), delta=4e-3)

    def test_forces_stand_in_the_order_of_the_vehicle_file(self):
        # Those whose place the file does not tell come first, by their names.
        self.assertEqual(self.results.names("forces"), ["link", "tyre", "suspension", "air", "leaf", "bush", "stop"])


if __name__ == "__main__":
    unittest.main()
