#!/usr/bin/python3
"""What a run warns of is in its results, with the numbers that it concerns, and in what --json prints."""

import json
import math
import re
import shutil
import sys
import unittest

from dynamics_test_case import PROGRAM, ROOT, DynamicsTestCase, run_program

sys.path.insert(0, str(ROOT / "tools"))

from sprung_tools.files.results_file import open_results  # noqa: E402  after the path
from sprung_tools.runs.run_warnings import read_warnings  # noqa: E402


FLAT = 'road={ shape = "flat" }'


class Warnings(DynamicsTestCase):
    def run_to_json(self, *settings):
        """Runs to results.h5. Returns the exit code, stderr and what --json printed."""
        words = [word for setting in settings for word in ("--set", setting)]
        process = self.run_program(*words, "--json", "--quiet", "-o", "results.h5")
        return process.returncode, process.stderr, json.loads(process.stdout)

    def read_warnings(self):
        with open_results(self.results) as results:
            return [one._asdict() for one in read_warnings(results.file)]

    def test_missing_modes_are_said_of_the_points_of_their_body(self):
        # Over the bump the third mode, left out, would carry much of the acceleration.
        points = 'vehicle.monitor=["chassis.origin", "chassis.seat"]'
        code, _, printed = self.run_to_json("duration=0.5", "modes.chassis=2", points)
        self.assertEqual(code, 0)
        first, second = (one for one in printed["warnings"] if "modes are missing" in one["text"])
        self.assertTrue(first["text"].startswith("modes are missing: chassis.mode 3, which was left out"))
        self.assertIn("% of the r.m.s. acceleration of chassis.seat, most of it along x, and would", first["text"])
        self.assertEqual((first["concerns"], first["of"]), ("summary", ["chassis.origin", "chassis.seat", "chassis"]))
        self.assertEqual((second["concerns"], second["of"], second["text"]), ("modes", ["chassis"], first["text"]))
        stored = [
            {"concerns": one["section"], "of": list(one["of"]), "text": one["text"]} for one in self.read_warnings()
        ]
        self.assertEqual(stored, printed["warnings"])

    def test_missing_modes_are_said_of_the_point_that_they_name_on_whatever_body(self):
        _, _, printed = self.run_to_json("duration=0.5", "modes.chassis=2", 'vehicle.monitor=["front_axle.origin"]')
        first = printed["warnings"][0]
        self.assertTrue(first["text"].startswith("modes are missing: chassis.mode 3"), first)
        self.assertIn("of the r.m.s. acceleration of front_axle.origin", first["text"])
        self.assertEqual((first["concerns"], first["of"]), ("summary", ["chassis", "front_axle.origin"]))

    def test_balance_and_modes_print_their_warnings_as_json(self):
        for verb in ("equilibrium", "modes"):
            process = self.run_program("--set", "modes.chassis=2", "--json", "--quiet", verb=verb)
            (warning,) = json.loads(process.stdout)["warnings"]
            self.assertEqual((warning["concerns"], warning["of"]), ("sections", ["chassis"]))
            self.assertTrue(warning["text"].startswith("chassis: its modes miss "), warning)

    def test_a_certified_body_is_not_told_to_take_a_certified_basis(self):
        # Both superelements have a certificate with a bound; with two of their vectors the remedy is to take all.
        for superelement in ("chassis", "chassis_certified"):
            with self.subTest(superelement):
                process = self.run_program("--set", f"vehicle.bodies.chassis.superelement={superelement}", "--set",
                                           "modes.chassis=2", "--json", "--quiet", verb="equilibrium")  # fmt: skip
                (warning,) = json.loads(process.stdout)["warnings"]
                advice = '; take more modes, modes.chassis = "certified" takes all, and take moments from the loads'
                self.assertIn(advice, warning["text"])
                self.assertNotIn("a certified basis", warning["text"])

    def test_a_run_prints_what_it_was_asked_for(self):
        _, _, printed = self.run_to_json("duration=0.2", "modes.chassis=2", "speed=4.5")
        found = printed["parameters"]
        self.assertEqual((found["speed"], found["duration"], found["road"]), (4.5, 0.2, "half-sine"))
        self.assertEqual((found["method"], found["modes"]), ("exponential", {"chassis": [1, 2]}))

    def test_an_energy_balance_that_does_not_close_concerns_the_computation(self):
        code, said, printed = self.run_to_json(
            "duration=0.5", "integrator.method=generalized-alpha", "integrator.fixed_step=0.005", "output_step=0.005"
        )
        self.assertEqual(code, 1)
        warning = printed["warnings"][0]
        self.assertEqual((warning["concerns"], warning["of"]), ("summary", ["computation"]))
        self.assertIn("the energy balance does not close", warning["text"])
        self.assertEqual(self.read_warnings()[0]["text"], warning["text"])
        self.assertIn(f"warning: {warning['text']}\n", said)

    def test_a_good_run_has_none(self):
        _, _, printed = self.run_to_json("duration=0.2", "modes.chassis=36", "adaptivity.indicator=false", FLAT)
        self.assertEqual((printed["warnings"], self.read_warnings()), ([], []))

    def test_a_remark_on_the_vehicle_file_is_kept_beside_the_numbers(self):
        unlikely = "vehicle.bodies.front_axle.inertia=1e9"
        process = self.run_program("--set", "duration=0.05", "--set", unlikely, "--json", "-o", "results.h5")
        (text,) = (one["text"] for one in json.loads(process.stdout)["warnings"] if "in kg·m²" in one["text"])
        self.assertIn("'bodies.front_axle.inertia' is that of", text)
        self.assertEqual(process.stderr.count(text), 1)
        self.assertIn(f"remark: {text}", process.stderr)
        self.assertIn(("computation",), [one["of"] for one in self.read_warnings() if one["text"] == text])

    def test_equal_runs_in_two_folders_are_equal_bytes_with_the_name_of_the_file_in_the_warning(self):
        # results.md: no paths inside. 80 m/s is remarked on at its place in the run file.
        stored = []
        for name in ("first", "second"):
            shutil.copytree(ROOT / "dynamics/models/templates", self.folder / name)
            run = self.folder / name / "half_car_run.toml"
            text = re.sub(r"(?m)^speed = .*", "speed = 80.0", run.read_text(encoding="utf-8"))
            run.write_text(text, encoding="utf-8")
            line = text[: text.index("speed = ")].count("\n") + 1
            words = ("--set", "duration=0.01", "-o", self.results)
            process = run_program([PROGRAM, "run", run, *words], cwd=self.folder)
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertIn(f"remark: {run}:{line}:", process.stderr)
            stored.append(self.results.read_bytes())
        self.assertIn(f"half_car_run.toml:{line}", [one["text"].rsplit(":", 2)[0] for one in self.read_warnings()])
        self.assertEqual(*stored)

    def test_ride_prints_the_warnings_above_its_tables(self):
        _, _, printed = self.run_to_json("duration=0.5", "modes.chassis=2")
        ride = run_program([ROOT / "tools/ride", "results.h5"], cwd=self.folder)
        text = f"warning: chassis 2 modes: {printed['warnings'][0]['text']}"
        self.assertEqual(ride.stdout.count(text), 1)
        self.assertLess(ride.stdout.index(text), ride.stdout.index("point "))

    def test_a_road_that_is_missed_is_warned_of_where_it_concerns_the_statistics(self):
        # A class C road of 1 m, passed at 3 m/s after 1/3 s.
        road = 'road={ shape = "random", start = 0.0, length = 1.0, class = "C" }'
        ends = "the road ends at 1 m, which the leading axle passes after 0.333333 s of 0.5 s"
        code, said, printed = self.run_to_json("duration=0.5", road, "statistics.to=0.5")
        self.assertEqual(code, 0)
        (warning,) = (one for one in printed["warnings"] if one["of"] == ["computation"])
        self.assertTrue(warning["text"].startswith(ends), warning)
        self.assertIn(warning["text"], [one["text"] for one in self.read_warnings()])
        self.assertIn(f"warning: {ends}", said)
        # Beside the statistics it is a remark on the run file, with its place.
        for settings, expected in (((road, "statistics.to=0.3"), f"--set 2: {ends}"),
                                   (("speed=-3.0",), "the vehicle drives against its heading")):  # fmt: skip
            _, said, printed = self.run_to_json("duration=0.5", *settings)
            (text,) = (one["text"] for one in printed["warnings"] if one["of"] == ["computation"])
            self.assertIn(expected, text)

    def test_a_road_that_is_never_reached_is_warned_of(self):
        for setting, reason in (("road.start=9.0", "at 'speed', 3 m/s, it covers 1.5 m in 0.5 s"),
                                ("speed=0.0", "at 'speed', 0 m/s, it covers 0 m in 0.5 s")):  # fmt: skip
            _, said, printed = self.run_to_json("duration=0.5", setting)
            (text,) = (one["text"] for one in printed["warnings"] if one["of"] == ["computation"])
            self.assertIn("ahead of the leading axle, which does not reach it: " + reason, text)
            self.assertIn(text, said)

    def test_a_motion_inside_the_vehicle_does_not_drive_it_to_the_road(self):
        vehicle = self.folder / "vehicle.toml"
        vehicle.write_text(vehicle.read_text(encoding="utf-8") + """
[bodies.pump]
mass = 1.0
inertia = 0.1
position = [0.0, 2.0]
[[joints]]
name = "pump"
type = "revolute"
a = "chassis.origin"
b = "pump.origin"
[[motions]]
name = "turning"
joint = "pump"
function = { polynomial = [0.0, 0.5] }
""", encoding="utf-8")  # fmt: skip
        _, _, printed = self.run_to_json("duration=0.5", "road.start=9.0")
        self.assertIn("which does not reach it", str(printed["warnings"]))
        # The carriage of the quarter car is driven along the ground.
        self.assertNotIn("does not reach it", str(self.run_quarter_car("road.start=99.0", "speed=1.0")))

    def run_quarter_car(self, *settings):
        """A quarter car over a bump. Returns the extremes of the body's acceleration, and the warnings."""
        words = [word for setting in settings for word in ("--set", setting)]
        run = ROOT / "dynamics/models/examples/quarter_car_run.toml"
        process = run_program([PROGRAM, "run", run, "--json", "--quiet", "-o", "results.h5", *words], cwd=self.folder)
        self.assertEqual(process.returncode, 0, process.stderr)
        printed = json.loads(process.stdout)
        return printed["points"]["sprung.origin"]["acceleration"], printed["warnings"]

    def test_outputs_too_coarse_for_the_peaks_of_accelerations(self):
        expected, warnings = self.run_quarter_car()
        self.assertEqual(warnings, [])
        found, (warning,) = self.run_quarter_car("output_step=0.2")
        self.assertGreater(found["min"], 0.5 * expected["min"])
        self.assertEqual((warning["concerns"], warning["of"]), ("summary", ["sprung.origin", "unsprung.origin"]))
        self.assertEqual(self.read_warnings()[0]["text"], warning["text"])
        between = re.search(r"every 0\.2 s .* sprung\.origin along y reached (\S+) m/s² in between", warning["text"])
        self.assertAlmostEqual(float(between.group(1)), expected["min"], delta=0.1 * abs(expected["min"]))
        # The summary has all outputs, but the results have every two hundredth.
        found, (warning,) = self.run_quarter_car("output.step.points=0.2")
        self.assertEqual(found, expected)
        self.assertIn("take a smaller step.points of [output]", warning["text"])

    def test_outputs_at_the_period_of_the_motion(self):
        # 1 kg under 5 sin(2π 5 t) N, seen every 0.2 s at zero force and at every millisecond.
        (self.folder / "vehicle.toml").write_text("""
name = "shaken"
gravity = [0.0, 0.0]
monitor = ["b.origin"]
[bodies.b]
mass = 1.0
inertia = 0.1
position = [0.0, 0.0]
[[forces]]
name = "shaker"
type = "applied"
point = "b.origin"
force = [0.0, { harmonic = { amplitude = 5.0, frequency = 5.0 } }]
""", encoding="utf-8")
        (self.folder / "bump.toml").write_text(
            'vehicle = "vehicle.toml"\nstart = "as-given"\nduration = 4.0\n', encoding="utf-8"
        )
        for step, is_coarse in ((0.2, True), (0.001, False)):
            _, _, printed = self.run_to_json(f"output_step={step}")
            texts = [one["text"] for one in printed["warnings"]]
            self.assertEqual(len(texts), int(is_coarse), texts)
            for text in texts:
                self.assertRegex(text, r"that of b\.origin along y reached -?(5|4\.\d+) m/s² in between, where they")

    def test_a_balance_that_is_not_found_tells_of_a_point_that_was_moved_far(self):
        run = ROOT / "dynamics/models/templates/half_car_run.toml"
        for verb in ("run", "equilibrium"):
            far = ("--set", "vehicle.bodies.body.position=[3000.0, 0.9]")
            process = run_program([PROGRAM, verb, run, "--quiet", *far], cwd=self.folder)
            self.assertEqual(process.returncode, 3, process.stderr)
            self.assertRegex(
                process.stderr,
                r"error: no static equilibrium after .*; as drawn, 'forces\.\w+' is 3000 m long: check .*; "
                r"to close the joints, of which '\w+' was \S+ m open, \S+ was moved by \S+ m; no point is farther than",
            )

    def test_a_balance_that_a_force_prevents_names_what_nothing_holds(self):
        # The search tips the car over, and what moves at its end says nothing about the cause.
        templates = ROOT / "dynamics/models/templates"
        push = '[[forces]]\nname = "push"\ntype = "applied"\npoint = "body.origin"\nforce = [1000.0, 0.0]\n'
        vehicle = (templates / "half_car.toml").read_text(encoding="utf-8") + push
        (self.folder / "half_car.toml").write_text(vehicle, encoding="utf-8")
        run = shutil.copy(templates / "half_car_run.toml", self.folder)
        process = run_program([PROGRAM, "equilibrium", run, "--quiet"], cwd=self.folder)
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertIn("what nothing holds at the start position against the forces: all bodies along x", process.stderr)

    def write_bar(self, angle, extra=""):
        """A bar of 1 m on a hinge under gravity."""
        (self.folder / "vehicle.toml").write_text(f"""
name = "bar"
[bodies.b]
mass = 1.0
inertia = 0.1
position = [{math.cos(angle)!r}, {math.sin(angle)!r}]
angle = {angle!r}
points = {{ a = [-1.0, 0.0] }}
[[joints]]
name = "hinge"
type = "revolute"
a = "ground.origin"
b = "b.a"
{extra}""", encoding="utf-8")
        (self.folder / "bump.toml").write_text('vehicle = "vehicle.toml"\nduration = 0.1\n', encoding="utf-8")

    def test_a_start_in_an_unstable_equilibrium_is_warned_of(self):
        for angle, is_unstable in ((0.5 * math.pi, True), (-0.5 * math.pi, False)):  # upright, hanging
            self.write_bar(angle)
            code, said, printed = self.run_to_json()
            texts = [one["text"] for one in printed["warnings"]]
            self.assertEqual((code, len(texts)), (0, int(is_unstable)), texts)
            self.assertEqual([one["text"] for one in self.read_warnings()], texts)
            for text in texts:
                self.assertIn("starts in an unstable equilibrium", text)
                self.assertIn(text, said)

    def test_a_motion_that_moves_a_body_far_is_named_as_the_reason(self):
        # Drawn at 0 rad, its motion prescribes 3 rad: the centre moves by 2 sin 1.5 m, and no joint was open.
        motion = '[[motions]]\nname = "turn"\njoint = "hinge"\nfunction = { polynomial = [3.0] }\n'
        self.write_bar(0.0, motion)
        _, _, printed = self.run_to_json()
        (warning,) = printed["warnings"]
        expected = r"prescribed motions, b\.origin was moved by 1\.99 m; .* the motions at the start"
        self.assertRegex(warning["text"], expected)
        self.assertNotIn("''", warning["text"])

    def test_samples_taken_in_another_unit_than_that_of_the_file_are_remarked_on(self):
        (self.folder / "push.csv").write_text("t [s],f [kN]\n0,1\n1,2\n", encoding="utf-8")
        for unit, is_other in (("N", True), ("kN", False)):
            self.write_bar(0.0, '[[forces]]\nname = "push"\ntype = "applied"\npoint = "b.origin"\nforce = [0.0, '
                           f'{{ history = {{ file = "push.csv", channel = "f", unit = "{unit}" }} }}]\n')  # fmt: skip
            process = self.run_program("--set", 'start="as-given"')
            self.assertEqual(process.returncode, 0, process.stderr)
            remark = r"remark: vehicle.toml:\d+:\d+: '\S+' is taken in N, but its file gives it in kN"
            self.assertEqual(re.search(remark, process.stderr) is not None, is_other, process.stderr)

    def test_a_steady_motion_that_the_springs_do_not_hold_is_not_put_down_to_gravity_or_modes(self):
        # A mass on a rotating arm: its spring holds it up to √(200/2) = 10 rad/s; the arm turns at 11 rad/s.
        (self.folder / "vehicle.toml").write_text("""
name = "arm"
gravity = [0.0, 0.0]
[bodies.arm]
mass = 1.0
inertia = 0.5
position = [0.0, 0.0]
[bodies.mass]
mass = 2.0
inertia = 0.1
position = [0.55, 0.0]
[[joints]]
name = "hinge"
type = "revolute"
a = "ground.origin"
b = "arm.origin"
[[joints]]
name = "slot"
type = "translational"
a = "arm.origin"
b = "mass.origin"
axis = [1.0, 0.0]
[[motions]]
name = "spin"
joint = "hinge"
function = { polynomial = [0.0, 11.0] }
[[forces]]
name = "spring"
type = "spring-damper"
a = "arm.origin"
b = "mass.origin"
free_length = 0.5
spring = { polynomial = [0.0, 200.0] }
""", encoding="utf-8")
        run = 'vehicle = "vehicle.toml"\nduration = 1.0\nstart = "steady"\n'
        (self.folder / "bump.toml").write_text(run, encoding="utf-8")
        process = self.run_program(verb="equilibrium")
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertIn("keeps moving: mass.x; check that something holds it against the inertia forces", process.stderr)
        self.assertNotIn("modes", process.stderr)

    def test_wall_time_and_the_times_of_program_and_integration_are_told_apart(self):
        _, _, printed = self.run_to_json("duration=0.2")
        self.assertGreater(printed["integration_cpu_time"], 0.0)
        self.assertGreater(printed["cpu_time"], printed["integration_cpu_time"])
        self.assertGreater(printed["elapsed"], 0.0)
        table = self.run_program("--set", "duration=0.2", "--quiet").stdout
        for name in ("wall time of the run", "CPU time of the program", "CPU time of the integration"):
            self.assertIn(name, table)


if __name__ == "__main__":
    unittest.main()
