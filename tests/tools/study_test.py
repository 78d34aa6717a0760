"""`study` with the programs: rows are what single runs give, an interrupted study goes on, a failed run is a row, stage
one runs once for each design. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS)."""

import csv
import json
import os
import select
import signal
import subprocess
import unittest

import h5py
import numpy as np
from tool_test_case import ROOT, TOOLS, ToolTestCase, find_complaints, make_class_folder, run_program

EXAMPLES = ROOT / "dynamics/models/examples"
VERIFICATION = ROOT / "tests/verification/models"
DYNAMICS, REDUCE = os.environ["SPRUNG_DYNAMICS"], os.environ["SPRUNG_REDUCE"]
TOLERANCE = '[[parameters]]\nkey = "integrator.relative_tolerance"\n'
HEIGHT = '[[parameters]]\nname = "height"\nkey = "road.height"\n'


class StudyCase(ToolTestCase):
    def write_study(self, text, run=EXAMPLES / "quarter_car_run.toml"):
        (self.folder / "study.toml").write_text(f'run = "{run}"\n{text}', encoding="utf-8")

    def study(self, *arguments, **environment):
        return self.run_tool("study", "study.toml", "-o", "out", *arguments, **environment)

    def read_table(self, folder="out"):
        """The rows of the CSV file: column → text."""
        with open(self.folder / folder / "table.csv", encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))


class TheExample(StudyCase):
    @classmethod
    def setUpClass(cls):
        cls.made = make_class_folder(cls)
        command = [TOOLS / "study", EXAMPLES / "quarter_car_study.toml", "-o", cls.made]
        cls.process = run_program(command, cwd=cls.made, check=True)
        with open(cls.made / "table.csv", encoding="utf-8", newline="") as file:
            cls.rows = list(csv.DictReader(file))

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
        self.write_study(f'measures = ["error=summary/energy_closure"]\nset.duration = 0.5\n{values}')
        self.assertIn("1 runs: 0 made, 1 kept from before", self.study().stdout)
        self.assertIn("error [1]", self.read_table()[0])

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

    def test_a_failed_run_is_a_row_with_its_error_and_the_others_are_made(self):
        self.write_study(self.MEASURES + TOLERANCE + "values = [1e-6, 5, 1e-7]")
        process = self.study()
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("3 runs: 3 made, 0 kept from before, 1 failed", process.stdout)
        good, bad, other = self.read_table()
        self.assertEqual((bad["exit_code"], bad["program/steps"], bad["converged"]), ("2", "", "0"))
        self.assertIn("--set 2: error: ", bad["error"])
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
        self.assertIn("2 runs: 0 made, 2 kept", self.study().stdout)
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
        self.write_study('measures = ["tyres/wheel/static_load", "program/steps"]\nset.duration = 0.5\n'
                         + HEIGHT + "values = [0.01]")  # fmt: skip
        process = self.study()
        self.assertEqual(process.returncode, 0)
        self.assertEqual(find_complaints(process.stderr), ["warning: no run has the measure tyres/wheel/static_load"])

    def test_results_files_are_kept_if_asked_for(self):
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01]")
        self.assert_succeeds(self.study())
        self.assertFalse((self.folder / "out/results").exists())
        self.assertIn("1 made, 0 kept", self.study("--keep-results").stdout)
        (row,) = self.read_table()
        with h5py.File(self.folder / "out/results" / f"{row['hash'][:16]}.h5") as file:
            self.assertEqual(float(row["summary/energy_closure [1]"]), file["summary"].attrs["energy_closure"])
        self.assertIn("0 made, 1 kept", self.study("--keep-results").stdout)

    def test_wrong_arguments_are_refused(self):
        self.write_study(self.MEASURES + HEIGHT + "values = [0.01]")
        self.assertIn("--jobs must be at least 1, got 0", self.study("--jobs", "0").stderr)
        self.assert_refuses(self.study("--programs", "out"), "out: error: no program sprung-reduce here")
        (self.folder / "taken").touch()
        process = self.run_tool("study", "study.toml", "-o", "taken")
        self.assert_refuses(process, "taken/rows.jsonl: error: cannot be opened (File exists)")


class Interruption(StudyCase):
    """With a stand-in that runs the program, writes down each call, and at the third height of the bump stays for ever
    while a file called hold is there."""

    def setUp(self):
        super().setUp()
        settings = 'measures = ["program/steps"]\nset.duration = 0.5\n'
        self.write_study(f"{settings}{HEIGHT}values = [0.01, 0.02, 0.03, 0.04]")
        os.mkfifo(self.folder / "arrived")
        stand_in = self.folder / "stand_in"
        stand_in.write_text(
            '#!/bin/bash\n[[ "$*" == *--dry-run* ]] && exit 0\n'
            f'echo "$*" >>"{self.folder}/calls"\n'
            f'if [[ "$*" == *height=0.03* && -e "{self.folder}/hold" ]]; then\n'
            f'  echo $$ >"{self.folder}/arrived"\n  exec sleep infinity\nfi\nexec "{DYNAMICS}" "$@"\n',
            encoding="utf-8",
        )
        stand_in.chmod(0o755)
        self.environment = {"SPRUNG_DYNAMICS": str(stand_in)}

    def start_and_wait(self):
        """Starts the study. Returns its process and a file descriptor of the program that holds it up."""
        (self.folder / "hold").touch()
        process = subprocess.Popen(
            [TOOLS / "study", "study.toml", "-o", "out", "--jobs", "1"], cwd=self.folder, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, encoding="utf-8", env={**os.environ, **self.environment},
            start_new_session=True,
        )  # fmt: skip
        held = int((self.folder / "arrived").read_text(encoding="utf-8"))  # waits for the program
        return process, os.pidfd_open(held)

    def wait_for_end(self, held):
        select.select([held], [], [])  # of a process that has ended
        os.close(held)

    def check_that_it_goes_on(self):
        calls = (self.folder / "calls").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(calls), 3)
        (self.folder / "hold").unlink()
        process = self.study(**self.environment)
        self.assert_succeeds(process)
        self.assertIn("4 runs: 2 made, 2 kept from before, 0 failed", process.stdout)
        more = (self.folder / "calls").read_text(encoding="utf-8").splitlines()[3:]
        self.assertEqual(sorted(line.split("road.height=")[1] for line in more), ["0.03", "0.04"])
        interrupted = (self.folder / "out/table.csv").read_bytes()
        self.assert_succeeds(self.run_tool("study", "study.toml", "-o", "whole", **self.environment))
        self.assertEqual(interrupted, (self.folder / "whole/table.csv").read_bytes())
        self.assertFalse((self.folder / "out/under_way").exists())

    def test_a_study_that_is_killed_keeps_its_rows_ends_its_programs_and_goes_on(self):
        process, held = self.start_and_wait()
        process.kill()
        process.communicate()
        self.wait_for_end(held)
        self.check_that_it_goes_on()

    def test_an_interrupted_study_says_so_and_goes_on(self):
        process, held = self.start_and_wait()
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does, to all processes
        _, complaints = process.communicate()
        self.assertEqual(process.returncode, 130)
        self.assertIn("out: the runs that have ended are kept; the same command goes on", complaints)
        self.assertTrue(complaints.endswith("interrupted\n"), complaints)
        self.assertNotIn("Traceback", complaints)
        self.wait_for_end(held)
        self.check_that_it_goes_on()

    def test_a_program_that_is_killed_is_a_failed_row(self):
        process, held = self.start_and_wait()
        signal.pidfd_send_signal(held, signal.SIGKILL)
        process.communicate()
        self.wait_for_end(held)
        self.assertEqual(process.returncode, 0)
        errors = [(row["exit_code"], row["error"]) for row in self.read_table()]
        self.assertEqual(errors, [("0", ""), ("0", ""), ("-9", "ended by SIGKILL"), ("0", "")])

    def test_a_row_that_was_cut_off_is_made_again(self):
        self.assert_succeeds(self.study("--jobs", "1", **self.environment))
        rows = self.folder / "out/rows.jsonl"
        whole = rows.read_bytes()
        rows.write_bytes(whole[:-20])
        self.assertIn("4 runs: 1 made, 3 kept from before", self.study(**self.environment).stdout)
        self.assertIn("4 runs: 0 made, 4 kept from before", self.study(**self.environment).stdout)

    def test_a_second_study_in_the_same_folder_is_refused_meanwhile(self):
        process, held = self.start_and_wait()
        self.assert_refuses(self.study(**self.environment), "out/rows.jsonl: error: another study is at work")
        process.kill()
        process.communicate()
        self.wait_for_end(held)


class Designs(StudyCase):
    """The bending frequencies of a beam are proportional to the square root of its Young's modulus; those of a beam
    that is pinned at one end, too."""

    MODULUS = "design.beam_inside.materials.steel.youngs_modulus"

    def write_design_study(self, values, more=""):
        self.write_study(
            f'command = "modes"\ndesigns = ["{VERIFICATION / "beam_inside.toml"}"]\n'
            'measures = ["program/modes/2/undamped_frequency"]\n'
            f'[[parameters]]\nname = "modulus"\nkey = "{self.MODULUS}"\nvalues = {values}\n{more}',
            run=VERIFICATION / "pinned_beam_run.toml",
        )

    def test_stage_one_runs_once_for_each_distinct_design(self):
        self.write_design_study([1e11, 4e11], '[[parameters]]\nkey = "modes.beam"\nvalues = [5, 10, 20]\n')
        self.assert_succeeds(self.study())
        self.assertEqual(len(list((self.folder / "out/designs").iterdir())), 2)
        rows = self.read_table()
        column = "program/modes/2/undamped_frequency"
        for modes in ("5", "10", "20"):
            low, high = (float(row[column]) for row in rows if row["modes.beam"] == modes)
            self.assertAlmostEqual(high / low, 2.0, delta=1e-8)

    def test_the_frequency_is_that_of_a_design_written_by_hand(self):
        self.write_design_study([3e11])
        self.assert_succeeds(self.study())
        text = (VERIFICATION / "beam_inside.toml").read_text(encoding="utf-8")
        changed = "".join(
            "youngs_modulus = 3e11\n" if line.startswith("youngs_modulus") else line for line in text.splitlines(True)
        )
        (self.folder / "beam_inside.toml").write_text(changed, encoding="utf-8")
        run_program([REDUCE, "build", "beam_inside.toml"], cwd=self.folder, check=True)
        run = [DYNAMICS, "modes", VERIFICATION / "pinned_beam_run.toml", "--json"]
        expected = json.loads(run_program(run, cwd=self.folder, check=True).stdout)["modes"][1]["undamped_frequency"]
        self.assertEqual(float(self.read_table()[0]["program/modes/2/undamped_frequency"]), expected)

    def test_a_design_that_cannot_be_reduced_is_a_row_with_the_error_of_stage_one(self):
        self.write_design_study([-1.0, 2e11])
        self.assertEqual(self.study().returncode, 0)
        bad, good = self.read_table()
        self.assertEqual((bad["exit_code"], good["exit_code"]), ("2", "0"))
        self.assertIn("youngs_modulus", bad["error"])

    def test_a_key_that_leads_through_a_number_is_a_row_with_the_reason(self):
        self.write_study(
            f'command = "modes"\ndesigns = ["{VERIFICATION / "beam_inside.toml"}"]\nmeasures = ["program/modes/1/x"]\n'
            '[[parameters]]\nkey = "design.beam_inside.lines.7.elements"\nvalues = [1]',
            run=VERIFICATION / "pinned_beam_run.toml",
        )
        process = self.study()
        self.assertIn("'lines.7.elements': '7' is no number of an entry", process.stderr)
        self.assertEqual(process.returncode, 2)


class RandomRoads(StudyCase):
    def test_each_seed_is_a_road_of_its_own_the_one_that_make_road_makes(self):
        self.write_study(
            'measures = ["tyres/tyre/dynamic_load_rms"]\nset.duration = 1.0\n'
            '[random_road]\nclass = "C"\nlength = 20.0\nspacing = 0.05\nease = 1.0\nstart = 0.5\n'
            '[[parameters]]\nname = "seed"\nkey = "random_road.seed"\nvalues = [1, 2]\n'
        )
        self.assert_succeeds(self.study())
        first, second = (float(row["tyres/tyre/dynamic_load_rms [N]"]) for row in self.read_table())
        self.assertNotEqual(first, second)
        recipe = ["--iso-class", "C", "--length", "20", "--spacing", "0.05", "--ease", "1", "--seed", "2"]
        self.assert_succeeds(self.run_tool("make_road.py", "-o", "road.txt", *recipe))
        road = f'road={{shape="table", start=0.5, file="{self.folder / "road.txt"}"}}'
        run = [DYNAMICS, "run", EXAMPLES / "quarter_car_run.toml", "--quiet", "-o", "single.h5", "--set", road]
        run_program([*run, "--set", "duration=1.0"], cwd=self.folder, check=True)
        (single,) = json.loads(self.run_tool("ride", "single.h5", "--json").stdout)["runs"]
        self.assertEqual(single["measures"]["tyres/tyre/dynamic_load_rms"]["value"], second)

    def test_a_recipe_that_makes_no_road_is_a_row_with_the_reason(self):
        self.write_study(
            'measures = ["program/steps"]\nset.duration = 0.2\n[random_road]\nlength = 20.0\nspacing = 0.05\n'
            '[[parameters]]\nkey = "random_road.class"\nvalues = ["C", "Z"]\n'
        )
        self.study()
        self.assertEqual([row["error"] for row in self.read_table()],
                         ["", "random_road: error: 'class', got 'Z', expected A to H"])  # fmt: skip


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
