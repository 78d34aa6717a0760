"""runs/vehicle_modes.py, report/vehicle_modes.py and report/frame_loads.py: who moves in words, how far, and the loads
along a body. The truck's modes are checked in the browser (report_controls_test.py)."""

import base64
import unittest

import h5py
import numpy as np
from synthetic_results import STATIC_HEIGHT, write_results, write_series, write_texts
from tool_test_case import ToolTestCase

from sprung_tools.files.results_file import open_results
from sprung_tools.model.vehicle_shape import read_bodies
from sprung_tools.report.frame_loads import pack_frame_loads
from sprung_tools.report.vehicle_modes import pack_vehicle_modes
from sprung_tools.runs.stations import place_stations
from sprung_tools.runs.vehicle_modes import read_vehicle_modes


def decode(text):
    return np.frombuffer(base64.b64decode(text), dtype="<f4")


class VehicleModes(ToolTestCase):
    def write(self, shapes, participants):
        """A run whose modes have these shapes [5×modes]: x, y, angle of the chassis, two modal amplitudes."""
        write_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            count = len(participants)
            write_series(file, "model/modes/undamped_frequency", np.arange(count, dtype=float), "Hz")
            write_series(file, "model/modes/damping_ratio", np.full(count, 0.1), "1")
            write_texts(file, "model/modes/participants", participants)
            names = ["chassis.x", "chassis.y", "chassis.angle", "chassis.mode 1", "chassis.mode 2"]
            write_texts(file, "model/modes/coordinates", names)
            write_series(file, "model/modes/shapes", np.array(shapes, dtype=float), "mass-normalised")
            body = file.require_group("model/resolved/bodies/chassis")
            body.attrs.update({"mass": 1e4, "inertia": 5e4})
            write_series(body, "center_of_mass", np.array([0.0, 0.01]), "m")
            write_series(file, "model/equilibrium/modal/chassis", np.array([0.0, 0.0]), "kg^0.5 m")
        results = open_results(self.folder / "a.h5")
        self.addCleanup(results.file.close)
        return results, read_bodies(results)

    def test_who_moves_stands_in_the_words_of_the_results(self):
        results, bodies = self.write(np.zeros((5, 2)), ["chassis 100 %", "chassis bending, 95 %; cab pitch, 5 %"])
        (mode,) = read_vehicle_modes(results, bodies)  # the first has frequency 0
        self.assertEqual((mode.number, mode.words), (2, "chassis bending, 95 %; cab pitch, 5 %"))

    def test_the_nodes_move_as_the_shape_says_and_the_farthest_by_one(self):
        shapes = np.zeros((5, 3))
        shapes[1, 1] = 0.02
        shapes[2, 2] = 0.03
        results, bodies = self.write(shapes, ["chassis 100 %"] * 3)
        packed = pack_vehicle_modes(results, bodies)
        self.assertEqual([one["number"] for one in packed["table"]], [2, 3])  # the first has frequency 0
        equilibrium = decode(packed["equilibrium"]["chassis"]).reshape(-1, 2)
        self.assertAlmostEqual(float(equilibrium[1, 1]), STATIC_HEIGHT, places=6)
        up, turned = (decode(shape["chassis"]).reshape(-1, 2) for shape in packed["shapes"])
        np.testing.assert_allclose(up, np.tile([0.0, 1.0], (len(up), 1)), atol=1e-7)
        arm = bodies[0].places
        expected = np.stack([-arm[:, 1], arm[:, 0]], axis=1) / np.max(np.linalg.norm(arm, axis=1))
        np.testing.assert_allclose(turned, expected, atol=1e-6)

    def test_a_run_without_modes_has_none(self):
        write_results(self.folder / "b.h5")
        with open_results(self.folder / "b.h5") as results:
            found = pack_vehicle_modes(results, read_bodies(results))
        self.assertEqual(found, {"table": [], "equilibrium": {}, "shapes": []})


class FrameLoads(ToolTestCase):
    def test_the_envelope_and_the_extremes_are_of_all_samples(self):
        write_results(self.folder / "a.h5")
        stations = np.array([(0.0, 0.0), (2.0, 0.0), (-2.0, 0.0), (0.0, 0.0)])  # the element on -x comes second
        with h5py.File(self.folder / "a.h5", "a") as file:
            time = file["time"][:]
            wave = np.sin(2.0 * np.pi * time)
            for name, scale in (("moment", 1e3), ("shear", -50.0)):
                values = scale * np.outer(wave, [3.0, 1.0, 2.0, 4.0])
                write_series(file, f"recovery/chassis/{name}", values, "N m" if name == "moment" else "N")
            write_series(file, "recovery/chassis/station", stations, "m")
        with open_results(self.folder / "a.h5") as results:
            (packed,) = pack_frame_loads(results, read_bodies(results), 7)
        moment, shear = packed["quantities"]
        self.assertEqual(packed["axis"], "x in the body frame, m")
        np.testing.assert_allclose(decode(moment["s"]), [-2.0, 0.0, 0.0, 2.0])
        np.testing.assert_allclose(decode(moment["high"]), [2e3, 4e3, 3e3, 1e3], rtol=1e-6)
        np.testing.assert_allclose(decode(shear["low"]), [-100.0, -200.0, -150.0, -50.0], rtol=1e-6)
        highest, lowest = moment["extremes"]
        self.assertEqual((highest["what"], highest["value"], highest["place"], highest["time"]),
                         ("highest", 4e3, 0.0, 0.25))  # fmt: skip
        self.assertAlmostEqual(lowest["time"], 0.75)
        times = decode(packed["t"])
        self.assertIn(np.float32(0.25), times)  # an instant of an extreme is always drawn
        values = decode(moment["v"]).reshape(times.size, 4)
        np.testing.assert_allclose(values[times == np.float32(0.25)][0], [2e3, 4e3, 3e3, 1e3], rtol=1e-6)

    def test_loads_from_the_loads_are_shown_with_their_largest_difference_from_the_modes(self):
        write_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            for name in ("moment", "shear"):
                values = np.ones((file["time"].size, 2))
                write_series(file, f"recovery/chassis/{name}", values, "N m")
                values = values + 2.0
                values[3, 1] = -5.0
                write_series(file, f"recovery/chassis/{name}_from_loads", values, "N m")
            write_series(file, "recovery/chassis/station", np.array([(0.0, 0.0), (2.0, 0.0)]), "m")
            time = float(file["time"][3])
        with open_results(self.folder / "a.h5") as results:
            (packed,) = pack_frame_loads(results, read_bodies(results), 7)
        for quantity in packed["quantities"]:
            self.assertEqual([one["value"] for one in quantity["extremes"]], [3.0, -5.0])
            self.assertEqual(
                quantity["difference"],
                {"what": "largest difference from that of the modes", "value": -6.0, "place": 2.0, "where": "2 m",
                 "time": time},
            )

    def test_stresses_are_shown_for_both_sides_of_a_body_with_sizes_of_sections(self):
        write_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            wave = np.sin(2.0 * np.pi * file["time"][()])
            loads = {"axial": ([2e5, 2e5], "N"), "shear": ([0.0, 0.0], "N"), "moment": ([1e5, 3e5], "N m")}
            for name, (values, unit) in loads.items():
                write_series(file, f"recovery/chassis/{name}", np.outer(wave, values), unit)
            write_series(file, "recovery/chassis/station", np.array([(2.0, 0.0), (0.0, 0.0)]), "m")
            write_series(file, "recovery/chassis/area", np.array([0.01, 0.01]), "m^2")
            write_series(file, "recovery/chassis/section_modulus", np.array([2e-3, 2e-3]), "m^3")
        with open_results(self.folder / "a.h5") as results:
            (packed,) = pack_frame_loads(results, read_bodies(results), 7)
        *_, above, below = packed["quantities"]
        self.assertEqual([one["name"] for one in (below, above)], ["stress, −y side", "stress, +y side"])
        # N/A ± M/W: the element runs towards -x, so that its left, the side of the lower sign, is below.
        np.testing.assert_allclose(decode(below["s"]), [0.0, 2.0])
        np.testing.assert_allclose(decode(below["high"]) * 1e-6, [130.0, 30.0], rtol=1e-6)
        np.testing.assert_allclose(decode(above["high"]) * 1e-6, [170.0, 70.0], rtol=1e-6)
        self.assertEqual((above["extremes"][0]["place"], above["extremes"][0]["time"]), (0.0, 0.25))

    def test_a_frame_that_is_not_slender_is_drawn_along_its_elements(self):
        stations = np.array([(0.0, 0.0), (0.0, 3.0), (0.0, 3.0), (4.0, 3.0)])
        layout = place_stations(stations)
        np.testing.assert_array_equal(layout.order, [0, 1, 2, 3])
        np.testing.assert_allclose(layout.along, [0.0, 3.0, 3.0, 7.0])
        self.assertEqual(layout.axis, "length along the elements in their order, m")


if __name__ == "__main__":
    unittest.main()
