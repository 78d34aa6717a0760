"""tools/report on whole runs of sprung-dynamics (SPRUNG_DYNAMICS): the data of the page against the results."""

import os
import unittest

import h5py
import numpy as np
from report_case import ReportCase, decode, find_data
from tool_test_case import ROOT, run_program

from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import open_results
from sprung_tools.report.page import make_small_page
from sprung_tools.runs.labelled_runs import open_runs
from sprung_tools.runs.measures import measure_history


class Runs(ReportCase):
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

    def test_reactions_of_joints_and_drives_of_motions_are_shown_on_the_body_on_which_they_act(self):
        # The wall bears the piston across its way alone, and no revolute joint bears a torque.
        self.drive("slider_crank", "slider.h5")
        _, data = self.report("slider.h5")
        shown = {one["name"]: decode(one["v"]) for one in data["runs"][0]["channels"] if one["group"] == "Joints"}
        self.assertEqual({name for name in shown if "torque on" in name}, {"cylinder, torque on ground"})
        self.assertEqual([name for name in shown if name.startswith("motor,")], ["motor, drive"])
        with h5py.File(self.folder / "slider.h5") as file:
            for name, expected in (
                ("piston_pin, force along x on rod", file["joints/piston_pin/reaction"][:, 0]),
                ("piston_pin, force along y on rod", file["joints/piston_pin/reaction"][:, 1]),
                ("motor, drive", file["joints/motor/drive"][:]),
            ):
                self.assertTrue(np.any(expected))
                for extreme in (np.min, np.max):
                    self.assertAlmostEqual(extreme(shown[name]) / extreme(expected), 1.0, places=6)
        self.assertLess(np.max(np.abs(shown["cylinder, force along x on ground"])), 1e-9)

    def test_reactions_have_components_by_name(self):
        self.drive("slider_crank", "slider.h5")
        with open_results(self.folder / "slider.h5") as results:
            columns, _ = read_numbers(results.file, "joints/cylinder/reaction_b")
            for column, (component, unit) in enumerate((("x", "N"), ("y", "N"), ("torque", "N m"))):
                values, found = results.series(f"joints/cylinder/reaction_b.{component}")
                self.assertEqual(found, unit)
                np.testing.assert_array_equal(values, columns[:, column])
            values, _ = results.series("forces/coupling/on_b.torque")
            np.testing.assert_array_equal(values, results.series("forces/coupling/torque")[0])

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

    def test_the_rms_of_a_computed_point_is_that_of_stored_rows(self):
        # Straight lines between rows of 10 ms would lower it. The origin of the axle moves as its frame does.
        self.drive("quarter_car", "thin.h5", "--set", "output.size=0.05", "--set", "output.store.points='none'")
        quantity = "points/unsprung.origin/velocity.y"
        with open_results(self.folder / "thin.h5") as results:
            every, end = results.every(quantity), float(results.time[-1])
            found = measure_history(results, f"histories/{quantity}", (0.0, end))[f"histories/{quantity}/rms"].value
            rows = results.series("bodies/unsprung/velocity.y")[0][::every]
        self.assertEqual(every, 10)
        self.assertAlmostEqual(found / np.sqrt(np.mean(rows**2)), 1.0, places=9)

    def test_rounding_of_a_vehicle_at_rest_is_shown_as_nothing(self):
        self.drive("quarter_car", "rest.h5", "--set", 'road={shape="flat"}', "--set", "duration=0.5")
        _, data = self.report("rest.h5")
        rows = self.read_rows(data, "sprung.origin")
        self.assertEqual(set(rows.values()), {0.0})
        self.assertEqual(data["runs"][0]["spectra"], [])
        for channel in (one for one in data["runs"][0]["channels"] if one["group"] == "Vertical motion"):
            self.assertFalse(np.any(decode(channel["v"])), channel["name"])

    def test_rounding_that_stiff_springs_turn_into_acceleration_is_nothing(self):
        # The 5-ton truck on a level road: 4.4e-11 m/s² with modes up to 35 Hz, 13.5 m from the origin. A point that is
        # held at the origin moves by 1e-16 m.
        self.drive("quarter_car", "rest.h5", "--set", 'road={shape="flat"}', "--set", "duration=0.5")
        for amplitude, is_motion in ((4.4e-11, False), (1e-7, True)):  # m/s²
            with h5py.File(self.folder / "rest.h5", "a") as file:
                wave = amplitude * np.sin(np.arange(file["time"].size))
                file["points/sprung.origin/acceleration"][:, 1] = wave
                file["points/sprung.origin/position"][:] = 1e-16 * np.sin(np.arange(wave.size))[:, None]
                file["model/equilibrium/points/sprung.origin"][:] = 0.0
                file["bodies/sprung/position"][:, 2] = 1e-15 * np.sin(np.arange(wave.size))
                file["energy/dissipated"][:] = 1e-15 * np.arange(wave.size)
                file["model/modes/undamped_frequency"][-1] = 35.0
                for part, value in (("max", amplitude), ("min", -amplitude), ("rms", 1e-12)):
                    file["summary/points/sprung.origin"].attrs[f"acceleration_{part}"] = value
            _, data = self.report("rest.h5")
            rows = self.read_rows(data, "sprung.origin")
            found = {rows[f"acceleration, {part}"] for part in ("highest", "lowest", "r.m.s.")}
            self.assertEqual(found, {amplitude, -amplitude, 1e-12} if is_motion else {0.0})
            shown = {one["name"]: decode(one["v"]) for one in data["runs"][0]["channels"]}
            self.assertEqual(np.any(shown["sprung.origin, acceleration"]), is_motion)
            for name in ("sprung.origin, displacement", "sprung, angle", "dissipated energy"):
                self.assertFalse(np.any(shown[name]), name)

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


if __name__ == "__main__":
    unittest.main()
