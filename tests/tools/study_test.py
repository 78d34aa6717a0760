"""`study` with the programs: rows are what single runs give, a failed run is a row."""

import json
import shutil
import unittest

import h5py
import numpy as np
from study_case import DYNAMICS, EXAMPLES, HEIGHT, StudyCase, read_csv
from tool_test_case import TOOLS, find_complaints, make_class_folder, run_program

TOLERANCE = '[[parameters]]\nkey = "integrator.relative_tolerance"\n'


class TheExample(StudyCase):
    @classmethod
    def setUpClass(cls):
        cls.made = make_class_folder(cls)
        command = [TOOLS / "study", EXAMPLES / "quarter_car_study.toml", "-o", cls.made]
        cls.process = run_program(command, cwd=cls.made, check=True)
        cls.rows = read_csv(cls.made / "table.csv")

    def test_its_rows_are_the_grid_of_its_parameters(self):
        points = [(float(row["damping"]), float(row["bump height"])) for row in self.rows]
        expected = [(damping, height) for damping in (750.0, 1500.0, 3000.0) for height in (0.05, 0.1)]
        np.testing.assert_allclose(points, expected, rtol=1e-12)
        self.assertEqual([row["run"] for row in self.rows], [str(k) for k in range(1, 7)])
        self.assertEqual({(row["exit_code"], row["converged"], row["error"]) for row in self.rows}, {("0", "1", "")})

    def test_every_value_is_that_of_a_single_run_with_the_same_settings(self):
        for row in (self.rows[0], self.rows[-1]):
            settings = [word for one in row["set"].split() for word in ("--set", one)]
            output = self.folder / "single.h5"
            run = [DYNAMICS, "run", EXAMPLES / "quarter_car_run.toml", "-o", output, "--quiet", *settings]
            run_program(run, check=True)
            (single,) = json.loads(run_program([TOOLS / "ride", output, "--json"], check=True).stdout)["runs"]
            columns = [name for name in row if "/" in name]
            self.assertEqual(len(columns), 3)
            for column in columns:
                name, unit = column.removesuffix("]").split(" [")
                self.assertEqual({"value": float(row[column]), "unit": unit}, single["measures"][name])

    def test_the_results_scale_with_the_bump_because_the_vehicle_is_linear(self):
        column = "suspensions/suspension/compression [m]"
        for low, high in zip(self.rows[::2], self.rows[1::2]):
            self.assertAlmostEqual(float(high[column]) / float(low[column]), 2.0, delta=1e-4)

    def test_the_hdf5_file_holds_the_same_table(self):
        with h5py.File(self.made / "table.h5") as file:
            self.assertEqual((file.attrs["format"], file.attrs["version"]), (b"sprung-study", 1))
            for name in ("damping", "bump height"):
                np.testing.assert_array_equal(file[f"parameters/{name}"], [float(row[name]) for row in self.rows])
            self.assertEqual(list(file["parameters/damping"].attrs["keys"]),
                             [b"vehicle.forces.suspension.damper.coefficient"])  # fmt: skip
            for column in (name for name in self.rows[0] if "/" in name):
                name, unit = column.removesuffix("]").split(" [")
                dataset = file[f"measures/{name}"]
                self.assertEqual(dataset.attrs["unit"].decode(), unit)
                np.testing.assert_array_equal(dataset, [float(row[column]) for row in self.rows])
            self.assertEqual([one.decode() for one in file["hash"]], [row["hash"] for row in self.rows])
            self.assertEqual(len(set(file["hash"])), 6)
            np.testing.assert_array_equal(file["exit_code"], 0)

    def test_it_prints_how_many_runs_were_made_and_the_main_effects(self):
        self.assertIn("6 runs: 6 made, 0 kept from before, 0 failed", self.process.stdout)
        self.assertRegex(self.process.stdout, r"tyres/tyre/dynamic_load_rms +bump height +9\d %")
        self.assertIn((self.made / "study.html").as_uri(), self.process.stdout)


class Rows(StudyCase):
    MEASURES = 'measures = ["program/steps", "summary/energy_closure"]\nset = { duration = 0.5 }\n'

    def test_a_study_that_is_done_makes_nothing_and_writes_the_same(self):
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01, 0.02]\n")
        self.assert_succeeds(self.study())
        first = [(self.folder / "out" / name).read_bytes() for name in ("table.csv", "table.h5", "study.html")]
        process = self.study()
        self.assertIn("2 runs: 0 made, 2 kept from before, 0 failed", process.stdout)
        again = [(self.folder / "out" / name).read_bytes() for name in ("table.csv", "table.h5", "study.html")]
        self.assertEqual(first, again)

    def test_a_label_is_the_heading_of_its_measure_and_may_be_changed_without_new_runs(self):
        values = HEIGHT + "values = [0.01]\n"
        self.write_study(f'measures = ["closure=summary/energy_closure"]\nset.duration = 0.5\n{values}')
        self.assert_succeeds(self.study())
        self.assertGreater(float(self.read_table()[0]["closure [1]"]), 0.0)
        with h5py.File(self.folder / "out/table.h5") as file:
            self.assertEqual(file["measures/summary/energy_closure"].attrs["label"], b"closure")
        self.write_study(f'measures = ["balance=summary/energy_closure"]\nset.duration = 0.5\n{values}')
        self.assertIn("1 runs: 0 made, 1 kept from before", self.study().stdout)
        self.assertIn("balance [1]", self.read_table()[0])

    def test_with_more_values_only_the_missing_runs_are_made(self):
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01, 0.03]\n")
        self.assert_succeeds(self.study())
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01, 0.02, 0.03]\n")
        self.assertIn("3 runs: 1 made, 2 kept from before", self.study().stdout)
        self.assertEqual([row["height"] for row in self.read_table()], ["0.01", "0.02", "0.03"])

    def test_a_changed_vehicle_is_run_again(self):
        for name in ("quarter_car.toml", "quarter_car_run.toml"):
            text = (EXAMPLES / name).read_text(encoding="utf-8")
            (self.folder / name).write_text(text, encoding="utf-8")
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01]\n", run="quarter_car_run.toml")
        self.assert_succeeds(self.study())
        vehicle = self.folder / "quarter_car.toml"
        text = vehicle.read_text(encoding="utf-8")
        vehicle.write_text(text.replace("mass = 300.0", "mass = 310.0"), encoding="utf-8")
        self.assertIn("1 runs: 1 made, 0 kept from before", self.study().stdout)

    def test_a_changed_road_file_is_run_again(self):
        (self.folder / "road.txt").write_text("0 0\n1 0.1\n2 0\n", encoding="utf-8")
        road = f'{{ shape = "table", start = 1.0, file = "{self.folder / "road.txt"}" }}'
        self.write_study(f'{self.MEASURES}[[parameters]]\nkey = "road"\nvalues = [{road}]\n')
        self.assert_succeeds(self.study())
        self.assertIn("1 runs: 0 made, 1 kept from before", self.study().stdout)
        (self.folder / "road.txt").write_text("0 0\n1 0.2\n2 0\n", encoding="utf-8")
        self.assertIn("1 runs: 1 made, 0 kept from before", self.study().stdout)

    def test_numbers_that_are_put_in_groups_are_named_and_the_only_parameter_explains_all(self):
        values = HEIGHT + "values = [0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07]\n"
        self.write_study('measures = ["points/sprung.origin/rms"]\nset.duration = 0.5\n' + values)
        process = self.study()
        self.assertRegex(process.stdout, r"points/sprung.origin/rms +height +100 % +0 %")
        self.assertNotIn("groups", process.stdout)
        speed = '[[parameters]]\nkey = "speed"\nfrom = 1.0\nto = 5.0\n'
        self.write_study('measures = ["points/sprung.origin/rms"]\nset.duration = 0.5\n[sampling]\n'
                         f'method = "latin-hypercube"\nnumber = 7\n{values}{speed}')  # fmt: skip
        said = "remark: many values are put into five groups or fewer, whose means count: height, speed"
        self.assertIn(said, self.study().stdout)

    def test_of_points_that_are_the_same_one_run_is_made(self):
        self.write_study(f'{self.MEASURES}{HEIGHT}values = [0.01, 0.01, 0.02]\n')
        self.assertIn("3 runs: 2 made, 0 kept from before, 1 the same as others, 0 failed", self.study().stdout)
        self.assertIn("3 runs: 0 made, 3 kept from before, 0 failed", self.study().stdout)

    def test_a_value_may_be_a_whole_table_which_replaces_the_one_of_the_run_file(self):
        flat, ramp = '{ shape = "flat" }', '{ shape = "ramp", start = 0.5, length = 1.0, height = 0.1 }'
        self.write_study('measures = ["tyres/tyre/dynamic_load_rms"]\nset.duration = 0.5\n'
                         f'[[parameters]]\nkey = "road"\nvalues = [{flat}, {ramp}]')  # fmt: skip
        self.assert_succeeds(self.study())
        rows = self.read_table()
        self.assertEqual([row["road"] for row in rows], [flat, ramp])
        still, moved = (float(row["tyres/tyre/dynamic_load_rms [N]"]) for row in rows)
        self.assertLess(still, 1e-3)  # it stands in balance
        self.assertGreater(moved, 10.0)

    def test_thinned_histories_are_a_warning_of_the_row(self):
        self.write_study('measures = ["histories/forces/tyre/force/max"]\n[set]\nduration = 0.5\n'
                         f'[set.output.step]\nforces = 0.05\n{HEIGHT}values = [0.05]\n')  # fmt: skip
        self.assertEqual(self.study().returncode, 0)
        said = "largest values may be larger than measured: forces stored every 50 ms"
        self.assertIn(said, self.read_table()[0]["warnings"])

    def test_a_named_point_keeps_its_measures_beside_a_pattern(self):
        """It was said that no run has them."""
        self.write_study('measures = ["points/sprung.origin/rms", "points/*/wk_rms"]\n[set]\nduration = 0.5\n'
                         f'{HEIGHT}values = [0.05]\n')  # fmt: skip
        process = self.study()
        self.assertEqual((process.returncode, find_complaints(process.stderr)), (0, []))
        (row,) = self.read_table()
        for column in ("points/sprung.origin/rms [m/s^2]", "points/sprung.center_of_mass/wk_rms [m/s^2]"):
            self.assertGreater(float(row[column]), 0.0)

    def test_what_makes_a_measure_doubtful_is_a_warning_of_the_row(self):
        for measure, is_said in (("mtvv", True), ("wk_rms", False)):
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            self.write_study(f'measures = ["points/sprung.origin/{measure}"]\n[set]\nduration = 0.5\n'
                             f'{HEIGHT}values = [0.05]\n')  # fmt: skip
            self.assertEqual(self.study().returncode, 0)
            self.assertEqual("the MTVV is too low" in self.read_table()[0]["warnings"], is_said)

    def test_a_folder_with_a_table_of_something_else_is_refused(self):
        (self.folder / "out").mkdir()
        (self.folder / "out/table.csv").write_text("mine", encoding="utf-8")
        self.write_study(f'measures = ["summary/energy_closure"]\n{HEIGHT}values = [0.05]\n')
        self.assert_refuses(self.study(), "out: error: the folder holds table.csv and no rows.jsonl")
        self.assertEqual((self.folder / "out/table.csv").read_text(encoding="utf-8"), "mine")

    def test_a_failed_run_is_a_row_with_its_error_and_the_others_are_made(self):
        self.write_study(self.MEASURES + TOLERANCE + "values = [1e-6, 5, 1e-7]")
        process = self.study()
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("3 runs: 3 made, 0 kept from before, 1 failed", process.stdout)
        good, bad, other = self.read_table()
        self.assertEqual((bad["exit_code"], bad["program/steps"], bad["converged"]), ("2", "", "0"))
        self.assertIn("integrator.relative_tolerance=5: error: ", bad["error"])
        self.assertIn(f"run 2: {bad['error']}", process.stderr)
        self.assertGreater(float(other["program/steps"]), float(good["program/steps"]))
        with h5py.File(self.folder / "out/table.h5") as file:
            self.assertEqual(list(np.isnan(file["measures/program/steps"])), [False, True, False])
            self.assertEqual(list(file["exit_code"]), [0, 2, 0])

    def test_a_run_that_did_not_converge_has_its_measures_and_says_so(self):
        self.write_study(self.MEASURES + TOLERANCE + "values = [0.1]\n[[parameters]]\n"
                         'key = "integrator.method"\nvalues = ["generalized-alpha"]')  # fmt: skip
        process = self.study()
        self.assertIn("1 runs: 1 made, 0 kept from before, 0 failed, 1 with a failed check", process.stdout)
        (row,) = self.read_table()
        self.assertEqual((row["exit_code"], row["converged"]), ("1", "0"))
        self.assertIn("the energy balance does not close", row["error"])
        self.assertIn("the energy balance does not close", row["warnings"])
        self.assertGreater(float(row["summary/energy_closure [1]"]), 1e-3)

    def test_a_failed_run_is_made_again_only_if_asked_for(self):
        self.write_study(self.MEASURES + TOLERANCE + "values = [1e-6, 5]")
        self.study()
        said = "2 runs: 0 made, 2 kept from before, 1 failed; --retry-failed makes 1 of them again\n"
        self.assertIn(said, self.study().stdout)
        self.assertIn("2 runs: 1 made, 1 kept", self.study("--retry-failed").stdout)

    def test_it_is_an_error_if_all_runs_fail(self):
        self.write_study(self.MEASURES + TOLERANCE + "values = [5, 6]")
        process = self.study()
        self.assertEqual(process.returncode, 2)
        self.assertIn("study.toml: error: all runs failed", process.stderr)
        self.assertEqual(len(self.read_table()), 2)

    def test_an_unknown_key_is_refused_at_its_place_before_any_run(self):
        self.write_study(self.MEASURES + '[[parameters]]\nname = "damping"\n'
                         'keys = ["speed", "vehicle.forces.suspension.dampr.coefficient"]\nvalues = [1.0]')  # fmt: skip
        self.assert_refuses(self.study(), "study.toml:6:19: error: unknown key 'dampr'")
        self.assertEqual((self.folder / "out/rows.jsonl").read_text(encoding="utf-8"), "")

    def test_an_unknown_key_for_all_runs_is_refused_at_its_place(self):
        settings = "[set]\nduration = 0.5\nroad.heigth = 0.1\n"
        self.write_study(f'measures = ["program/steps"]\n{settings}{HEIGHT}values = [1]')
        self.assert_refuses(self.study(), "study.toml:5:1: error: unknown key 'heigth'")

    def test_a_measure_that_no_run_has_is_remarked_on(self):
        for name in ("program/nothing", "points/spring.*/rms", "stresses/*/highest"):
            with self.subTest(name):
                self.write_study(f'measures = ["{name}", "program/steps"]\nset.duration = 0.5\n{HEIGHT}values = [0.01]')
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                process = self.study()
                self.assertEqual(process.returncode, 1)
                self.assertEqual(find_complaints(process.stderr), [
                    f"warning: the first run has no measure {name}; the others are made all the same",
                    f"warning: no run has the measure {name}",
                ])  # fmt: skip

    def test_a_measure_of_what_the_vehicle_does_not_have_is_refused_at_its_place_after_one_run(self):
        slips = {
            "points/sprung.orign/wk_rms": "the vehicle has no point 'sprung.orign' (did you mean 'sprung.origin'?)",
            "bands/sprung.orign/5": "the vehicle has no point 'sprung.orign' (did you mean 'sprung.origin'?)",
            "tyres/tire/static_load": "the vehicle has no tyre 'tire' (did you mean 'tyre'?)",
            "suspensions/springs/rebound": "the vehicle has no suspension 'springs'",
            "loads/sprang/moment": "the vehicle has no body 'sprang' (did you mean 'sprung'?)",
            "tyres/tyre/static_lod": "tyres/… has no measure 'static_lod' (did you mean 'static_load'?)",
        }  # fmt: skip
        for number, (name, what) in enumerate(slips.items()):
            with self.subTest(name):
                self.write_study(f'measures = ["program/steps", "{name}"]\nset.duration = 0.5\n{HEIGHT}'
                                 f"values = [0.01, 0.02, 0.03, {number + 4}e-2]")  # fmt: skip
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                column = len('measures = ["program/steps", "') + 1 + name.index(what.split("'")[1])
                self.assert_refuses(self.study("--jobs", "2"), f"study.toml:2:{column}: error: {what}")
                self.assertEqual(len((self.folder / "out/rows.jsonl").read_text(encoding="utf-8").splitlines()), 1)

    def test_a_band_that_the_samples_do_not_hold_is_an_empty_cell_with_a_warning(self):
        # Four samples in a period of 80 Hz are one every 3.1 ms.
        self.write_study('measures = ["bands/sprung.origin/5", "bands/sprung.origin/80"]\nset.duration = 0.5\n'
                         '[[parameters]]\nkey = "output_step"\nvalues = [0.001, 0.01]')  # fmt: skip
        self.assertEqual(self.study().returncode, 0)
        fine, coarse = self.read_table()
        self.assertEqual(coarse["bands/sprung.origin/80 [m/s^2]"], "")
        for row in (fine, coarse):
            self.assertGreater(float(row["bands/sprung.origin/5 [m/s^2]"]), 0.0)
            is_warned = "bands/sprung.origin/80: the run has no such value" in row["warnings"]
            self.assertEqual(is_warned, row is coarse)

    def test_a_measure_that_cannot_be_computed_is_an_empty_cell_with_a_warning_beside_the_others(self):
        self.write_study('measures = ["program/steps", "histories/events/time/max", "summary/energy_closure"]\n'
                         f"set.duration = 0.5\n{HEIGHT}values = [0.01, 0.02]")  # fmt: skip
        process = self.study()
        self.assertEqual(process.returncode, 1)
        self.assertIn("2 runs: 2 made, 0 kept from before, 0 failed", process.stdout)
        why = "histories/events/time: cannot be computed (dataset 'events/time' has shape (0,), expected 501 rows"
        first, last = find_complaints(process.stderr)
        self.assertIn(f"warning: the first run has no measure histories/events/time/max ({why}", first)
        self.assertEqual(last, "warning: no run has the measure histories/events/time/max")
        for row in self.read_table():
            self.assertGreater(float(row["program/steps"]), 0.0)
            self.assertGreater(float(row["summary/energy_closure [1]"]), 0.0)
            self.assertIn(why, row["warnings"])

    def test_where_the_vehicle_varies_a_measure_that_one_does_not_have_is_an_empty_cell(self):
        text = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        for name in ("tyre", "wheel"):
            changed = text.replace('name = "tyre"', f'name = "{name}"')
            (self.folder / f"{name}.toml").write_text(changed, encoding="utf-8")
        shutil.copy(EXAMPLES / "quarter_car_run.toml", self.folder / "run.toml")
        self.write_study('measures = ["tyres/wheel/static_load"]\nset.duration = 0.5\n'
                         '[[parameters]]\nkey = "vehicle"\nvalues = ["tyre.toml", "wheel.toml"]', run="run.toml")
        self.assertEqual(self.study().returncode, 0)
        first, second = (row["tyres/wheel/static_load [N]"] for row in self.read_table())
        self.assertEqual(first, "")
        self.assertGreater(float(second), 0.0)

    def test_a_key_that_is_wrong_whatever_its_value_is_refused_and_a_value_is_not(self):
        self.write_study('measures = ["program/steps"]\nset.duration = 0.5\n'
                         '[[parameters]]\nkey = "modes.chasis"\nvalues = [1, 2]')  # fmt: skip
        self.assert_refuses(self.study(), "study.toml:5:8: error: 'modes.chasis' is about no body of the vehicle")
        self.write_study('measures = ["program/steps"]\nset.duration = 0.5\n'
                         '[[parameters]]\nkey = "speed"\nvalues = [-1.0, 2.0]')  # fmt: skip
        self.assertIn("2 runs: 2 made", self.study().stdout)

    def test_results_files_are_kept_if_asked_for(self):
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01]")
        self.assert_succeeds(self.study())
        self.assertFalse((self.folder / "out/results").exists())
        self.assertIn("1 made, 0 kept", self.study("--keep-results").stdout)
        (row,) = self.read_table()
        with h5py.File(self.folder / "out/results" / f"{row['hash'][:16]}.h5") as file:
            self.assertEqual(float(row["summary/energy_closure [1]"]), file["summary"].attrs["energy_closure"])
        self.assertIn("0 made, 1 kept", self.study("--keep-results").stdout)

    def test_results_files_of_a_command_that_writes_none_are_refused(self):
        self.write_study('command = "equilibrium"\nmeasures = ["program/bodies/body/y"]\n' + HEIGHT + "values = [0.01]")
        self.assert_refuses(self.study("--keep-results"),
                            "study.toml: error: --keep-results: 'equilibrium' writes no results files")  # fmt: skip
        self.assertFalse((self.folder / "out").exists())

    def test_wrong_arguments_are_refused(self):
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01]")
        self.assertIn("--jobs must be at least 1, got 0", self.study("--jobs", "0").stderr)
        self.assert_refuses(self.study("--programs", "out"), "out: error: no program sprung-reduce here")
        (self.folder / "taken").touch()
        process = self.run_tool("study", "study.toml", "-o", "taken")
        self.assert_refuses(process, "taken/rows.jsonl: error: cannot be opened (File exists)")


class Responses(StudyCase):
    def test_measures_of_the_linear_vehicle_grow_with_the_root_of_the_roads_density(self):
        self.write_study(
            'command = "response"\nmeasures = ["outputs/forces/tyre/force/rms"]\n'
            '[[parameters]]\nkey = "response.road.density"\nvalues = [16e-6, 64e-6]\n'
        )
        self.assert_succeeds(self.study())
        low, high = (float(row["outputs/forces/tyre/force/rms [N]"]) for row in self.read_table())
        self.assertAlmostEqual(high / low, 2.0, delta=1e-12)


if __name__ == "__main__":
    unittest.main()
