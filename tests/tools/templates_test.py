"""dynamics/models/templates: each vehicle is built, stands where it is drawn, runs and is judged, as its README says.
Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS)."""

import csv
import json
import os
import re
import shutil
import tomllib
import unittest

import numpy as np
from tool_test_case import ROOT, ToolTestCase, make_class_folder, run_program

from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import open_results
from sprung_tools.model.resolved_model import read_elements, read_point
from sprung_tools.runs.ride_measures import calc_contact, find_suspensions

TEMPLATES = ROOT / "dynamics/models/templates"
GUIDE = TEMPLATES / "README.md"
# Degrees of freedom with rigid bodies: three for each body, without those that the joints take.
FREEDOMS = {"half_car": 5, "bus": 8, "truck": 7, "semitrailer": 14, "air_semitrailer": 16}
FLEXIBLE = {"truck": ("frame",), "semitrailer": ("tractor_frame", "trailer_frame"),
            "air_semitrailer": ("tractor_frame", "trailer_frame")}  # fmt: skip
DURATION = "0.5"


class Templates(ToolTestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = make_class_folder(cls)
        designs = sorted((ROOT / "meshes/templates").glob("*.toml"))
        process = run_program([os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", cls.made], check=True)
        cls.remarks = [line for line in process.stdout.splitlines() if "remark" in line]

    def run_template(self, name, *arguments):
        """Runs a template. Returns what --json printed; the results are in NAME.h5 of the test's folder."""
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "run", TEMPLATES / f"{name}_run.toml", "--superelements", self.made,
             "--json", "--set", f"duration={DURATION}", "-o", self.folder / f"{name}.h5", *arguments],
        )  # fmt: skip
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        return json.loads(process.stdout)

    def test_every_template_is_among_those_tested(self):
        self.assertEqual({path.stem for path in TEMPLATES.glob("*.toml") if not path.stem.endswith("_run")},
                         set(FREEDOMS))  # fmt: skip
        self.assertEqual(self.remarks, [])

    def test_each_runs_with_the_freedoms_of_its_joints_and_without_warnings(self):
        for name, freedoms in FREEDOMS.items():
            with self.subTest(name):
                rigid = [word for body in FLEXIBLE.get(name, ()) for word in ("--set", f"modes.{body}=0")]
                # Without the estimate of modes left out, which a rigid frame would call for.
                printed = self.run_template(name, *rigid, "--set", "adaptivity.indicator=false")
                self.assertEqual((printed["freedoms"], printed["warnings"]), (freedoms, []))
                if rigid:
                    flexible = self.run_template(name)
                    self.assertGreater(flexible["freedoms"], freedoms)
                    self.assertEqual(flexible["warnings"], [])

    def test_bdf_does_not_crawl_where_stiff_modes_are_at_rest(self):
        # In balance nothing moves. With a Jacobian of differences as small as the errors allowed it took 39,619 steps.
        settings = ('integrator.method="bdf"', "duration=0.01", 'road={ shape = "flat" }', "modes.frame=10",
                    "integrator.relative_tolerance=1e-8")  # fmt: skip
        printed = self.run_template("truck", *(word for one in settings for word in ("--set", one)))
        self.assertLess(printed["steps"], 4000)

    def test_in_balance_on_a_level_road_no_modes_are_missing(self):
        # The largest acceleration is 6e-6 m/s²: rounding, of which modes that are left out seemed to be 13 %.
        level = ("--set", 'road={ shape = "flat" }', "--set", "modes.frame=12")
        told = [one["text"] for one in self.run_template("truck", *level)["warnings"]]
        self.assertFalse(any("modes are missing" in text for text in told), told)

    def read_acceleration(self, name, point):
        with open_results(self.folder / f"{name}.h5") as results:
            return read_numbers(results.file, f"points/{point}/acceleration")[0]

    def test_modes_left_out_are_told_though_axles_are_heavy_beside_them(self):
        # Joints of heavy axles may take modes for their dependent coordinates. To first order, what is told is what
        # all modes show.
        points = ("--set", 'vehicle.monitor=["frame.origin"]')
        for modes in (1, 2):
            told = self.run_template("truck", *points, "--set", f"modes.frame={modes}")
            found = told["modes"]["left_out_together"]
            with_few = self.read_acceleration("truck", found["point"])
            self.run_template("truck", *points)
            right = self.read_acceleration("truck", found["point"])
            true = np.linalg.norm(right - with_few) / np.linalg.norm(with_few)
            self.assertAlmostEqual(found["of_rms_acceleration"] / true, 1.0, delta=0.08, msg=(modes, true))

    def test_a_continued_run_has_the_measures_of_one_long_run(self):
        """Those that need the equilibrium were not known."""
        self.run_template("half_car")
        (self.folder / "half_car.h5").rename(self.folder / "long.h5")
        self.run_template("half_car", "--set", "duration=0.25")
        (self.folder / "half_car.h5").rename(self.folder / "first.h5")
        self.run_template("half_car", "--set", f'continue_from="{self.folder / "first.h5"}"')
        with open_results(self.folder / "long.h5") as long, open_results(self.folder / "half_car.h5") as continued:
            window = (0.25, float(DURATION))
            for name in ("front_tyre", "rear_tyre"):
                expected, found = calc_contact(long, name, window), calc_contact(continued, name, window)
                for one, other in zip(found[:3], expected[:3]):  # to the run's tolerance
                    self.assertAlmostEqual(one / other, 1.0, delta=1e-3)
                self.assertEqual(found.off_ground, expected.off_ground)

    def test_each_has_one_rigid_body_mode_and_a_bracket_of_every_other_up_to_60_hz(self):
        # 60 Hz is the end of the band of both frames; 1 % is twice their tolerance of flexibilities. Nothing but the
        # motion along the road is without stiffness: internal states of air springs and bushings are no modes.
        for name in FREEDOMS:
            with self.subTest(name):
                printed = {}
                for command, *options in (("equilibrium",), ("modes", "--bracket")):
                    process = run_program(
                        [os.environ["SPRUNG_DYNAMICS"], command, TEMPLATES / f"{name}_run.toml", "--superelements",
                         self.made, "--json", *options],
                    )  # fmt: skip
                    self.assertEqual(process.returncode, 0, process.stderr)
                    printed[command] = json.loads(process.stdout)
                self.assertEqual(printed["equilibrium"]["neutral"], ["all bodies along x"])
                self.assertTrue(printed["equilibrium"]["stable"])
                modes = printed["modes"]["modes"]
                self.assertEqual([mode["rigid_body"] for mode in modes], [True] + [False] * (len(modes) - 1))
                for mode in modes[1:]:
                    frequency = mode["undamped_frequency"]
                    self.assertEqual("bracket" in mode, name not in FLEXIBLE or frequency < 60.0)
                    if "bracket" in mode:
                        lower, upper = mode["bracket"]
                        # The bracket is about the equilibrium of the true vehicle, the frequency about the model's.
                        # They are the same but for rounding where force elements are linear or no body is flexible.
                        differs = 3e-5 if "semitrailer" in name else 1e-6
                        self.assertLess(abs(upper / frequency - 1.0), differs, mode)
                        self.assertTrue(0.99 * upper < lower < (1.0 + 1e-9) * upper, mode)

    def find_modes(self, name, superelements):
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "modes", TEMPLATES / f"{name}_run.toml", "--superelements", superelements,
             "--bracket", "--json"],
        )  # fmt: skip
        self.assertEqual(process.returncode, 0, process.stderr)
        return json.loads(process.stdout)

    def test_brackets_are_proved_and_hold_the_frequencies_with_all_motions_of_the_frame(self):
        for name in FLEXIBLE:
            texts = [one["text"] for one in self.find_modes(name, self.made)["warnings"]]
            self.assertEqual([text for text in texts if "not proved" in text], [])
        # The truck's is at the same equilibrium with all clamped modes: its springs are linear.
        design = (ROOT / "meshes/templates/tractor_frame.toml").read_text(encoding="utf-8")
        start, end = design.index("[reduction]"), design.index("[modes]\n")
        design = design[:start] + '[reduction]\nbasis = "clamped"\n\n[modes]\nall = true\n' + design[end + 8 :]
        (self.folder / "tractor_frame.toml").write_text(design, encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "tractor_frame.toml"], cwd=self.folder, check=True)
        truth = [mode["undamped_frequency"] for mode in self.find_modes("truck", self.folder)["modes"]]
        found = [mode["bracket"] for mode in self.find_modes("truck", self.made)["modes"] if "bracket" in mode]
        self.assertGreaterEqual(len(found), 8)
        for frequency, (lower, upper) in zip(truth[1:], found):
            self.assertTrue((1.0 - 2e-7) * lower <= frequency <= (1.0 + 2e-7) * upper, (lower, frequency, upper))

    def test_each_stands_as_it_is_drawn_with_its_wheels_on_the_ground(self):
        for name in FREEDOMS:
            with self.subTest(name):
                self.run_template(name)
                with open_results(self.folder / f"{name}.h5") as results:
                    for name_of_spring in find_suspensions(results):
                        spring = read_elements(results, "forces")[name_of_spring]
                        static, _ = results.series(f"forces/{spring.name}/length")
                        self.assertAlmostEqual(static[0], self.drawn_length(results, spring), delta=1e-6)
                    for force in results.names("forces"):
                        if force.endswith("tyre") or force.startswith("tyre"):
                            self.assertEqual(results.series(f"forces/{force}/contact")[0][0], 1.0)
                    # The drawing has the tyres a little more or less compressed than they are.
                    for body in (one for one in results.names("bodies") if "axle" in one):
                        drawn, _ = results.file.numbers(f"model/resolved/bodies/{body}/position")
                        balance, _ = results.file.numbers(f"model/equilibrium/bodies/{body}")
                        self.assertLess(abs(balance[1] - drawn[1]), 0.02, body)

    def drawn_length(self, results, spring):
        """The distance of a spring's points in the vehicle file."""
        ends = []
        for name in spring.points.values():
            point = read_point(results, name)
            place, _ = results.file.numbers(f"model/resolved/bodies/{point.body}/position")
            self.assertEqual(place[2], 0.0)
            ends.append(place[:2] + point.position)
        return float(np.linalg.norm(ends[0] - ends[1]))

    def test_the_tools_judge_and_draw_the_semitrailers(self):
        for name, elements in (("semitrailer", ()), ("air_semitrailer", ("front_leaf", "drive_air"))):
            self.run_template(name)
            ride = self.run_tool("ride", f"{name}.h5")
            self.assert_succeeds(ride)
            for words in ("driver.seat", "seat_air", "tyre_3", "trailer_frame", *elements):
                self.assertIn(words, ride.stdout)
            self.assert_succeeds(self.run_tool("report", f"{name}.h5", "-o", "page.html"))

    def test_every_choice_of_modes_works_with_the_elements_of_suspensions(self):
        # Leaf spring, air springs with orifices and a valve, bushings that relax, hydraulic stops: modes chosen or
        # changing give the seat's r.m.s. acceleration of all modes of the certified bases to 5 %.
        frames = FLEXIBLE["air_semitrailer"]

        def find_rms(*settings):
            process = run_program(
                [os.environ["SPRUNG_DYNAMICS"], "run", TEMPLATES / "air_semitrailer_run.toml", "--superelements",
                 self.made, "--json", "--set", "duration=1.5", "-o", self.folder / "modes.h5",
                 *(word for setting in settings for word in ("--set", setting))],
            )  # fmt: skip
            self.assertEqual(process.returncode, 0, process.stderr)
            printed = json.loads(process.stdout)
            return printed["points"]["driver.seat"]["acceleration"]["rms"], printed["modes"]

        certified, _ = find_rms(*(f'modes.{frame}="certified"' for frame in frames))
        self.assertGreater(certified, 0.3)  # m/s²
        chosen, _ = find_rms(*(f'modes.{frame}="auto"' for frame in frames))
        changing, modes = find_rms("adaptivity.enabled=true")
        self.assertGreater(modes["changes"], 0)
        for rms in (chosen, changing):
            self.assertAlmostEqual(rms, certified, delta=0.05 * certified)

    def test_a_study_varies_the_elements_of_suspensions(self):
        # More friction in the leaf springs, and a narrower orifice behind the cab: other forces at the seat.
        (self.folder / "study.toml").write_text(
            f"""run = "{TEMPLATES / "air_semitrailer_run.toml"}"
superelements = "{self.made}"
measures = ["summary/points/driver.seat/acceleration_max", "suspensions/front_leaf/compression"]
[set]
duration = 1.0
[[parameters]]
name = "friction"
key = "vehicle.forces.front_leaf.friction.coefficient"
values = [500.0, 3000.0]
[[parameters]]
name = "orifice"
key = "vehicle.forces.cab_rear.auxiliary.orifice.diameter"
values = [0.002, 0.008]
""",
            encoding="utf-8",
        )
        self.assert_succeeds(self.run_tool("study", "study.toml", "-o", "out"))
        with open(self.folder / "out/table.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 4)
        for column in ("summary/points/driver.seat/acceleration_max", "suspensions/front_leaf/compression"):
            name = next(key for key in rows[0] if key.startswith(column))
            self.assertGreater(len({row[name] for row in rows}), 1)

    def test_the_guide_goes_through(self):
        # Its vehicle file is the template; every command of it is run as it stands there.
        text = GUIDE.read_text(encoding="utf-8")
        commands = [line for block in re.findall(r"```sh\n(.*?)```", text, re.S) for line in block.splitlines()]
        self.assertGreater(len(commands), 5)
        shutil.copytree(ROOT / "dynamics", self.folder / "dynamics")
        shutil.copytree(ROOT / "meshes", self.folder / "meshes")
        (self.folder / "tools").symlink_to(ROOT / "tools")
        programs = {"sprung-reduce": os.environ["SPRUNG_REDUCE"], "sprung-dynamics": os.environ["SPRUNG_DYNAMICS"]}
        for command in commands:
            with self.subTest(command):
                words = command.split()
                words[0] = programs.get(words[0], words[0])
                process = run_program(words, cwd=self.folder)
                self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        # What the guide adds to the vehicle: each piece of TOML, one after the other, is read and run.
        pieces = re.findall(r"```toml\n(.*?)```", text, re.S)
        self.assertGreater(len(pieces), 1)
        for piece in pieces:
            with self.subTest(piece):
                self.run_with_piece(piece, "duration=0.5")

    def run_with_piece(self, piece, *settings):
        """Runs the half car with a piece of TOML that the guide adds to it; the results are in mine.h5 of the test's
        folder. Returns the vehicle."""
        vehicle = (TEMPLATES / "half_car.toml").read_text(encoding="utf-8") + "\n" + piece
        (self.folder / "mine.toml").write_text(vehicle, encoding="utf-8")
        shutil.copy(TEMPLATES / "half_car_run.toml", self.folder / "mine_run.toml")
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "run", "mine_run.toml", "--quiet", "-o", "mine.h5",
             *(word for one in ("vehicle=mine.toml", *settings) for word in ("--set", one))], cwd=self.folder,
        )  # fmt: skip
        self.assertEqual(process.returncode, 0, process.stderr)
        return tomllib.loads(vehicle)

    def test_the_brakes_of_the_guide_load_the_front_by_the_balance_of_moments(self):
        # A force at the body's centre of mass, which stood there, took 33 N from the front.
        (piece,) = (one for one in re.findall(r"```toml\n(.*?)```", GUIDE.read_text(encoding="utf-8"), re.S)
                    if "brake" in one)  # fmt: skip
        vehicle = self.run_with_piece(piece, 'road={ shape = "flat" }', "duration=3.0")
        bodies = vehicle["bodies"]
        mass = sum(body["mass"] for body in bodies.values())
        height = sum(body["mass"] * body["position"][1] for body in bodies.values()) / mass
        wheelbase = bodies["front_axle"]["position"][0] - bodies["rear_axle"]["position"][0]
        with open_results(self.folder / "mine.h5") as results:
            acceleration = results.series("bodies/body/acceleration.x")[0][-1]
            self.assertAlmostEqual(acceleration, -3000.0 / mass, delta=1e-3)
            moved = -mass * acceleration * height / wheelbase
            self.assertAlmostEqual(moved, 579.0, delta=1.0)  # as the guide says
            # As the body pitches, its centre of mass moves over the axles, which slide along its own axis.
            angle = results.series("bodies/body/position.angle")[0]
            arm = bodies["body"]["position"][1] - bodies["front_axle"]["position"][1]
            moved += bodies["body"]["mass"] * 9.80665 * arm * (angle[0] - angle[-1]) / wheelbase
            for tyre, sign in (("front_tyre", 1.0), ("rear_tyre", -1.0)):
                load = results.series(f"forces/{tyre}/force")[0]
                self.assertAlmostEqual(sign * (load[-1] - load[0]), moved, delta=0.005 * moved)

    def test_springs_of_one_free_length_share_the_load_of_a_group_as_the_guide_says(self):
        def find_loads(*settings):
            process = run_program(
                [os.environ["SPRUNG_DYNAMICS"], "equilibrium", TEMPLATES / "semitrailer_run.toml", "--superelements",
                 self.made, "--json", *(word for one in settings for word in ("--set", one))],
            )  # fmt: skip
            self.assertEqual(process.returncode, 0, process.stderr)
            forces = json.loads(process.stdout)["forces"]
            return [round(1e-3 * forces[f"tyre_{k}"]["force"]) for k in (1, 2, 3)]

        self.assertEqual(find_loads(), [67, 69, 74])
        equal = (f"vehicle.forces.suspension_{k}.free_length=0.925" for k in (1, 2, 3))
        self.assertEqual(find_loads(*equal), [70, 70, 71])


if __name__ == "__main__":
    unittest.main()
