"""What the runs of a study read: designs that stage one reduces, random roads."""

import json
import shutil
import unittest

from study_case import DYNAMICS, EXAMPLES, REDUCE, StudyCase
from tool_test_case import ROOT, run_program

from sprung_tools.study.designs import make_variant, reduce_variant

VERIFICATION = ROOT / "tests/verification/models"


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
        settings = [row["set"] for row in rows]
        self.assertEqual(settings[0], f"modes.beam=5 {self.MODULUS}=100000000000.0")
        self.assertEqual(len(set(settings)), 6)  # rows of different designs differ

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

    def test_a_misspelt_key_of_a_design_is_refused_at_its_place_after_one_reduction(self):
        self.write_design_study([1e11, 2e11, 3e11])
        text = (self.folder / "study.toml").read_text(encoding="utf-8")
        (self.folder / "study.toml").write_text(text.replace("youngs_modulus", "youngs_modulos"), encoding="utf-8")
        self.assert_refuses(self.study(), "study.toml:7:8: error: unknown key 'youngs_modulos'")
        self.assertEqual((self.folder / "out/rows.jsonl").read_text(encoding="utf-8"), "")
        self.assertEqual(len(list((self.folder / "out/designs").iterdir())), 1)

    def test_a_misspelt_key_of_the_run_is_refused_although_the_first_design_fails(self):
        self.write_design_study([-1.0, 2e11], '[[parameters]]\nkey = "modes.baem"\nvalues = [5, 10]\n')
        self.assert_refuses(self.study(), "study.toml:10:8: error: 'modes.baem' is about no body of the vehicle")
        self.assertEqual((self.folder / "out/rows.jsonl").read_text(encoding="utf-8"), "")

    def test_names_with_dots_stand_in_quotes(self):
        text = (VERIFICATION / "beam_inside.toml").read_text(encoding="utf-8")
        text = text.replace("[materials.steel]", '[materials."steel.1"]').replace('"steel"', '"steel.1"')
        (self.folder / "beam_inside.toml").write_text(text, encoding="utf-8")
        key = """design.'beam_inside'.materials."steel.1".youngs_modulus"""
        self.write_study(
            'command = "modes"\ndesigns = ["beam_inside.toml"]\nmeasures = ["program/modes/2/undamped_frequency"]\n'
            f"[[parameters]]\nkey = {json.dumps(key)}\nvalues = [1e11, 4e11]\n",
            run=VERIFICATION / "pinned_beam_run.toml",
        )
        self.assert_succeeds(self.study())
        low, high = (float(row["program/modes/2/undamped_frequency"]) for row in self.read_table())
        self.assertAlmostEqual(high / low, 2.0, delta=1e-8)

    def test_a_whole_body_may_name_its_superelement(self):
        run_program([REDUCE, "build", VERIFICATION / "beam_inside.toml"], cwd=self.folder, check=True)
        body = 'superelement = "beam_inside", position = [3.0, -1.0], angle = 0.4'
        for key, value in (("vehicle.bodies.beam", f"{{ {body} }}"), ("vehicle.bodies", f"{{ beam = {{ {body} }} }}")):
            vehicle = (VERIFICATION / "pinned_beam.toml").read_text(encoding="utf-8")
            (self.folder / "vehicle.toml").write_text(vehicle.replace("beam_inside", "another"), encoding="utf-8")
            run = (VERIFICATION / "pinned_beam_run.toml").read_text(encoding="utf-8")
            (self.folder / "run.toml").write_text(run.replace("pinned_beam.toml", "vehicle.toml"), encoding="utf-8")
            self.write_study(
                'command = "modes"\nsuperelements = "."\nmeasures = ["program/modes/2/undamped_frequency"]\n'
                f'[[parameters]]\nname = "body"\nkey = "{key}"\nvalues = [{value}]\n',
                run="run.toml",
            )
            with self.subTest(key):
                self.assert_succeeds(self.study())
                self.assertEqual([row["error"] for row in self.read_table()], [""])

    def test_a_key_that_leads_through_a_number_is_a_row_with_the_reason(self):
        self.write_study(
            f'command = "modes"\ndesigns = ["{VERIFICATION / "beam_inside.toml"}"]\nmeasures = ["program/modes/1/x"]\n'
            '[[parameters]]\nkey = "design.beam_inside.lines.7.elements"\nvalues = [1]',
            run=VERIFICATION / "pinned_beam_run.toml",
        )
        process = self.study()
        self.assertIn("'lines.7.elements': '7' is no number of an entry", process.stderr)
        self.assertEqual(process.returncode, 2)


class FilesOfDesigns(StudyCase):
    """A design that reads other files becomes variants that read the same files."""

    def reduce(self, design, **changes):
        """Reduces a variant elsewhere. Returns it."""
        variant = make_variant(design, changes, self.folder / "designs")
        self.assertEqual(reduce_variant(REDUCE, variant), "")
        self.assertTrue(variant.superelement.is_file())
        return variant

    def test_a_mesh_in_another_folder_is_taken_along(self):
        text = (ROOT / "meshes/examples/ladder_frame.toml").read_text(encoding="utf-8")
        for name in ("frame.geo", "sub/frame.geo", "../meshes/frame.geo", str(self.folder / "frame.geo")):
            design = self.folder / "frames" / "ladder_frame.toml"
            mesh = design.parent / name
            for one in (design, mesh):
                one.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / "meshes/examples/ladder_frame.geo", mesh)
            design.write_text(text.replace('"ladder_frame.geo"', f'"{name}"'), encoding="utf-8")
            with self.subTest(name):
                first = self.reduce(design)
                mesh.write_text(mesh.read_text(encoding="utf-8") + "// changed\n", encoding="utf-8")
                self.assertNotEqual(make_variant(design, {}, self.folder / "designs").folder, first.folder)

    def test_matrices_are_taken_along_and_a_changed_one_makes_another_variant(self):
        folder = self.folder / "body"
        (folder / "parts").mkdir(parents=True)
        write = [REDUCE, "matrices", VERIFICATION / "beam_inside.toml", "-o", folder / "parts/beam"]
        run_program(write, cwd=self.folder, check=True)
        names = {key: f"parts/beam_{key}" for key in ("stiffness.mtx", "mass.mtx", "freedoms.csv", "nodes.csv")}
        keys = "".join(f'{key.partition(".")[0]} = "{name}"\n' for key, name in names.items())
        design = folder / "beam.toml"
        design.write_text(
            f'[matrices]\nformat = "matrix-market"\n{keys}[points]\ninner = [0.625, 0.0]\n'
            '[reference]\npoint = "inner"\ncondition = "clamped"\n[modes]\ncount = 4\ndamping_ratio = 0.0\n',
            encoding="utf-8",
        )
        found = {self.reduce(design, **changes).folder for changes in ({}, {"modes.damping_ratio": 0.01})}
        for name in names.values():
            with open(folder / name, "a", encoding="utf-8") as file:
                file.write("\n")
            found.add(make_variant(design, {}, self.folder / "designs").folder)
        self.assertEqual(len(found), 6)


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

    def test_a_class_with_another_exponent_and_a_number_beyond_all_are_rows_with_the_reason(self):
        for settings, what in (("exponent = 3.0", "'exponent', got 3, expected 2, that of an ISO 8608 class"),
                               (f"ease = 1{400 * '0'}", "expected a finite number")):  # fmt: skip
            self.write_study(
                f'measures = ["program/steps"]\nset.duration = 0.2\n[random_road]\nclass = "C"\n{settings}\n'
                'length = 20.0\nspacing = 0.05\n[[parameters]]\nkey = "random_road.seed"\nvalues = [1]\n'
            )
            self.study()
            self.assertIn(what, self.read_table()[0]["error"])

    def test_roads_that_cannot_be_made_for_one_reason_are_rows_of_their_own(self):
        self.write_study(
            'measures = ["program/steps"]\nset.duration = 0.2\n'
            '[random_road]\nclass = "Z"\nlength = 20.0\nspacing = 0.05\n'
            '[[parameters]]\nkey = "random_road.seed"\nvalues = [1, 2]\n'
        )
        process = self.study()
        self.assertIn("2 runs: 2 made, 0 kept from before, 2 failed", process.stdout)
        self.assertEqual(len({row["hash"] for row in self.read_table()}), 2)


if __name__ == "__main__":
    unittest.main()
