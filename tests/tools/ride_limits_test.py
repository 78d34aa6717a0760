"""limits/ and tools/ride_limits: a linear quarter car whose absorbed power goes with the square of the roughness."""

import json
import math
import os
import unittest
from pathlib import Path
from types import SimpleNamespace

from tool_test_case import ROOT, ToolTestCase

from sprung_tools.cli.ride_limits import make_curves
from sprung_tools.files.errors import InputError
from sprung_tools.limits.ride_limits import Obstacles, Terrain, calc_peak, calc_power, find_roughness, find_speed
from sprung_tools.limits.roads import make_terrain
from sprung_tools.limits.root_finding import CallFailed, Root
from sprung_tools.limits.trials import Variant, Vehicle, Wheels
from sprung_tools.plots.limits_picture import Curve, make_limits_figure, make_obstacle_panel, make_terrain_panel
from sprung_tools.programs.in_process import load_module
from sprung_tools.signals.road_profile import Recipe

RECIPE = Recipe(length=60.0, spacing=0.05, band=(0.0547, 3.3), exponent=2.0, ease=5.0, seed=3)
# The quarter car of the examples, which rolls on by itself: nothing acts along the road.
QUARTER_CAR = (ROOT / "dynamics/models/examples/quarter_car.toml").read_text(encoding="utf-8")
RUN = 'vehicle = "car.toml"\nspeed = 5.0\nduration = 1.0\noutput_step = 2e-3\n[road]\nshape = "flat"\n'


class QuarterCarCase(ToolTestCase):
    def setUp(self):
        super().setUp()
        begin, end = QUARTER_CAR.index("[[motions]]"), QUARTER_CAR.index("[[forces]]")
        (self.folder / "car.toml").write_text(QUARTER_CAR[:begin] + QUARTER_CAR[end:], encoding="utf-8")
        (self.folder / "run.toml").write_text(RUN, encoding="utf-8")

    def vehicle(self, point="sprung.origin", *overrides):
        program = Path(os.environ["SPRUNG_DYNAMICS"])
        return Vehicle(program, self.folder / "run.toml", None, point, Variant("car", overrides))


class QuarterCar(QuarterCarCase):
    def test_the_roughness_follows_from_the_power_at_any_other(self):
        terrain = Terrain(RECIPE, (0.001, 0.2), 6.0)
        vehicle = self.vehicle()
        known = 0.01
        expected = known * math.sqrt(6.0 / calc_power(vehicle, terrain, 7.0, known))
        root = find_roughness(vehicle, terrain, 7.0)
        self.assertAlmostEqual(root.value / expected, 1.0, delta=0.01)  # half a per cent is the tolerance
        self.assertLessEqual(root.calls, 5)

    def test_the_limits_of_roughness_bound_the_search(self):
        for roughness, side in (((0.0001, 0.0002), "above"), ((0.5, 0.6), "below")):
            root = find_roughness(self.vehicle(), Terrain(RECIPE, roughness, 6.0), 7.0)
            self.assertEqual((root.value, root.side), (None, side))

    def test_the_speed_over_an_obstacle_is_the_lowest_that_reaches_the_limit(self):
        vehicle = self.vehicle()
        obstacles = Obstacles((0.5, 25.0), 15.0, None)
        root = find_speed(vehicle, obstacles, 0.1)
        at, below = (calc_peak(vehicle, obstacles, 0.1, factor * root.value) for factor in (1.0, 0.95))
        self.assertAlmostEqual(at / 15.0, 1.0, delta=0.02)
        self.assertLess(below, 15.0)
        # The car is linear: a limit of half the size is reached by the suspension's peak at a lower speed.
        half = find_speed(vehicle, obstacles._replace(acceleration=7.5), 0.1)
        self.assertLess(half.value, root.value)

    def test_a_low_pass_filter_takes_off_what_is_fast(self):
        obstacles = Obstacles((0.5, 25.0), 15.0, None)
        plain, smoothed = (
            calc_peak(self.vehicle("unsprung.origin"), obstacles._replace(low_pass=one), 0.1, 6.0)
            for one in (None, 2.0)
        )
        self.assertLess(smoothed, 0.3 * plain)
        with self.assertRaisesRegex(InputError, "--low-pass: error: is 300 Hz, expected less than 250 Hz"):
            calc_peak(self.vehicle(), obstacles._replace(low_pass=300.0), 0.1, 6.0)

    def test_wheels_are_read_from_the_vehicle(self):
        self.assertEqual(self.vehicle().wheels, (0.0, (0.316677,), False))
        self.assertEqual(self.vehicle().title, "quarter car")

    def test_wheels_of_nearly_one_radius_share_an_outline(self):
        self.assertIsNone(Wheels(3.0, (), True).point_radius)
        self.assertAlmostEqual(Wheels(3.0, (0.49, 0.50, 0.51), False).point_radius, 0.5)
        with self.assertRaisesRegex(InputError, r"--heights: error: .*radii 0\.4, 0\.5 m, expected radii within 5 %"):
            Wheels(3.0, (0.4, 0.5, 0.5), False).point_radius  # noqa: B018  it throws

    def test_wheels_of_both_kinds_have_no_outline_in_common(self):
        with self.assertRaisesRegex(InputError, '--heights: error: some wheels have contact = "point" and others'):
            Wheels(3.0, (0.5,), True).point_radius  # noqa: B018  it throws

    def test_what_the_run_file_stores_does_not_matter(self):
        obstacles, whole = Obstacles((1.0, 25.0), 15.0, None), self.vehicle()
        for choice in ("output.store={points='none', bodies='none'}", "output.step={points=0.01, bodies=0.01}"):
            vehicle = self.vehicle("sprung.origin", choice)
            self.assertEqual(calc_peak(vehicle, obstacles, 0.1, 6.0), calc_peak(whole, obstacles, 0.1, 6.0))

    def test_outputs_are_as_close_as_the_measures_need_whatever_the_run_file_says(self):
        terrain = Terrain(RECIPE, (0.001, 0.2), 6.0)
        fine = calc_power(self.vehicle("sprung.origin", "output_step=5e-4"), terrain, 7.0, 0.01)
        for step, expected in ((0.05, 0.05 / 16), (0.01, 0.0025), (2e-3, 2e-3)):  # whole parts of at most 3.125 ms
            vehicle = self.vehicle("sprung.origin", f"output_step={step}")
            self.assertAlmostEqual(vehicle.drive(7.0, make_terrain(RECIPE, 0.01), 1.0).step, expected)
            self.assertAlmostEqual(calc_power(vehicle, terrain, 7.0, 0.01) / fine, 1.0, delta=5e-3)

    def test_a_point_that_is_not_there_is_an_error(self):
        with self.assertRaisesRegex(InputError, "run.toml: error: no quantity 'points/sprung.seat/acceleration.y'"):
            self.vehicle("sprung.seat")

    def test_a_vehicle_without_wheels_is_an_error(self):
        text = (self.folder / "car.toml").read_text(encoding="utf-8")
        begin = text.index('name = "tyre"')
        spring = 'type = "spring-damper"\na = "ground.origin"\nb = "unsprung.origin"\nfree_length = 0.3\n'
        without = f'{text[:begin]}name = "tyre"\n{spring}spring = {{ polynomial = [0.0, 2.0e5] }}\n'
        (self.folder / "car.toml").write_text(without, encoding="utf-8")
        with self.assertRaisesRegex(InputError, "run.toml: error: the vehicle has no wheels on the road"):
            self.vehicle()

    def test_a_run_that_fails_is_told_and_not_used(self):
        # A program that makes the short run which tells what the vehicle is, and then fails in each of two ways.
        for code, complaint in ((3, "the step size fell below its limit"), (1, "the energy balance does not close")):
            program = self.folder / f"program_{code}"
            program.write_text(
                f"#!/bin/sh\ncase \"$*\" in\n*duration=1.0*) exec {os.environ['SPRUNG_DYNAMICS']} \"$@\" ;;\nesac\n"
                f"echo '{complaint}' >&2\nexit {code}\n",
                encoding="utf-8",
            )
            program.chmod(0o755)
            vehicle = Vehicle(program, self.folder / "run.toml", None, "sprung.origin", Variant("car", ()))
            root = find_roughness(vehicle, Terrain(RECIPE, (0.001, 0.2), 6.0), 7.0)
            self.assertEqual(root, (None, "", f"at 7 m/s the run failed: {complaint}", 1))


class DrivenSpeed(QuarterCarCase):
    """A limit belongs to a speed only where the vehicle drives at that speed."""

    def add(self, name, text):
        with open(self.folder / name, "a", encoding="utf-8") as file:
            file.write(text)

    def test_a_motion_at_another_speed_is_told_and_not_used(self):
        self.add("car.toml", '[[motions]]\nname = "cruise"\npoint = "sprung.origin"\ncoordinate = "x"\n'
                 "function = { polynomial = [0.0, 6.0] }\n")  # fmt: skip
        vehicle = self.vehicle()
        said = "at 7 m/s asked for, the vehicle drove 6 m/s on average"
        self.assertEqual(find_roughness(vehicle, Terrain(RECIPE, (0.001, 0.2), 6.0), 7.0), (None, "", said, 1))
        root = find_speed(vehicle, Obstacles((7.0, 25.0), 15.0, None), 0.1)
        self.assertEqual((root.value, root.problem), (None, said))
        self.assertGreater(calc_power(vehicle, Terrain(RECIPE, (0.001, 0.2), 6.0), 6.1, 0.01), 0.0)  # 1.6 % off

    def test_brakes_and_another_initial_speed_are_told(self):
        for name, text, found in (
            ("car.toml", '[[forces]]\nname = "brake"\ntype = "applied"\npoint = "sprung.origin"\n'
             "force = [{ step = { before = 0.0, after = -1500.0, start = 0.1, end = 0.2 } }, 0.0]\n", "-"),
            ("run.toml", "[initial.sprung]\nvelocity = [2.0, 0.0]\n", ""),
        ):  # fmt: skip
            self.setUp()
            self.add(name, text)
            root = find_speed(self.vehicle(), Obstacles((1.0, 25.0), 15.0, None), 0.1)
            self.assertIsNone(root.value)
            self.assertRegex(root.problem, rf"at 1 m/s asked for, the vehicle drove {found}[\d.]+ m/s on average")

    def test_a_vehicle_that_does_not_get_over_is_told(self):
        text = (self.folder / "car.toml").read_text(encoding="utf-8")
        text = text.replace('type = "tyre"\n', 'type = "tyre"\ncontact = "distributed"\n')
        text = text.replace("one_sided = false", "one_sided = true")
        (self.folder / "car.toml").write_text(text, encoding="utf-8")
        vehicle = self.vehicle()
        self.assertTrue(vehicle.wheels.has_others)
        with self.assertRaisesRegex(CallFailed, "at 1 m/s the vehicle did not get over: "):
            calc_peak(vehicle, Obstacles((1.0, 25.0), 15.0, None), 0.4, 1.0)

    def test_a_file_that_continues_another_run_is_refused(self):
        self.add("run.toml", "")
        text = (self.folder / "run.toml").read_text(encoding="utf-8")
        (self.folder / "run.toml").write_text(f'continue_from = "a.h5"\n{text}', encoding="utf-8")
        with self.assertRaisesRegex(InputError, r"run.toml:1:1: error: ride_limits begins each of its runs anew"):
            self.vehicle()

    def test_coarse_outputs_are_no_error_of_the_tool_s_own_first_run(self):
        self.assertEqual(self.vehicle("sprung.origin", "output_step=0.03").title, "quarter car")
        made = r" \(in a run of 1 s that ride_limits made\)$"
        with self.assertRaisesRegex(InputError, r"^output_step=3: error: .*" + made):
            self.vehicle("sprung.origin", "output_step=3", "duration=5")
        # An error of the run file itself is not laid to these runs, whatever it says.
        with self.assertRaisesRegex(InputError, r"^output_step=3: error: 'output_step' of .* duration of 1 s$"):
            self.vehicle("sprung.origin", "output_step=3")


class Picture(unittest.TestCase):
    def test_every_limit_is_inside_and_one_beyond_the_bounds_is_an_open_mark_at_its_bound(self):
        vehicles = [SimpleNamespace(variant=SimpleNamespace(label=one)) for one in ("base", "soft")]
        roots = {0.1: Root(None, "above", "", 9), 0.2: Root(3.0, "", "", 9), 0.3: Root(2.9, "", "", 9),
                 0.4: Root(None, "below", "", 1), 0.5: Root(None, "", "failed", 1)}  # fmt: skip
        found = [SimpleNamespace(vehicle=one, given=height, root=root) for one in vehicles
                 for height, root in roots.items()]  # fmt: skip
        curves = make_curves(vehicles, found, False, (1.0, 25.0))
        steep = [Curve("base", [(0.0333, 8.0), (0.0251, 15.0)])]  # the least of both is near the largest
        panels = (make_terrain_panel(steep, 6.0, (0.002, 0.15)), make_obstacle_panel(curves, "2.5 g", (1.0, 25.0)))
        figure = make_limits_figure("van", panels)
        for axes in figure.axes:
            for line in axes.lines:
                for end, data in ((axes.get_xlim()[1], line.get_xdata()), (axes.get_ylim()[1], line.get_ydata())):
                    self.assertLess(max(data, default=0.0), 0.95 * end)
        over_obstacles = figure.axes[1]
        marks = {line.get_marker(): (list(line.get_xdata()), list(line.get_ydata())) for line in over_obstacles.lines
                 if len(line.get_xdata())}  # fmt: skip
        self.assertEqual(marks, {"o": ([200.0, 300.0], [3.6 * 3.0, 3.6 * 2.9]), "^": ([100.0], [90.0]),
                                 "v": ([400.0], [3.6])})  # fmt: skip
        words = [one.get_text() for one in over_obstacles.get_legend().get_texts()]
        self.assertEqual(words, ["base", "soft", "limit below 1 m/s", "limit above 25 m/s"])
        self.assertEqual([one.get_text() for one in figure.axes[0].get_legend().get_texts()], ["base"])


class Command(QuarterCarCase):
    def test_warnings_of_runs_and_obstacles_above_the_hub_are_told(self):
        words = ("ride_limits", "run.toml", "--point", "sprung.origin", "--set", "output_step=0.05", "--speeds", "5",
                 "--heights", "0.35", "--peak", "1", "--length", "60", "--ease", "5")  # fmt: skip
        done = self.run_tool(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("do not resolve the accelerations", done.stdout)  # outputs every 3.125 ms, not every 50 ms
        self.assertIn("higher than the wheel's hub at 317 mm: a vehicle would hardly get over", done.stdout)
        (packed,) = json.loads(self.run_tool(*words, "--json").stdout)["vehicles"]
        self.assertEqual((packed["warnings"], packed["terrain"][0]["remark"]), ([], ""))
        # A tyre so stiff that its wheel hops with 112 Hz, of which 320 outputs in a second hold no peaks.
        stiff = ("--set", "vehicle.forces.tyre.spring={polynomial=[0.0,2.0e7]}", "--peak", "20", "--speed-range", "0.1",
                 "5")  # fmt: skip
        words = (*words[:3], "unsprung.origin", *words[4:], *stiff)
        done = self.run_tool(*words)
        self.assertRegex(done.stdout, r"\nwarning: vehicle: in \d+ of \d+ runs: values every 0\.003125 s do not res")
        doubtful = r"doubtful: \d+ of its runs warned of unsprung\.origin, see below"
        self.assertRegex(done.stdout, rf"vehicle +5 .*  {doubtful}\n")
        (packed,) = json.loads(self.run_tool(*words, "--json").stdout)["vehicles"]
        for one in (packed["terrain"][0], packed["obstacles"][0]):
            self.assertRegex(one["remark"], f"{doubtful}$")

    def test_tables_json_and_picture(self):
        words = ("ride_limits", "run.toml", "--point", "sprung.origin", "--variant", "as it is", "--variant", "soft",
                 "vehicle.forces.suspension.damper.coefficient=700.0", "--speeds", "5", "--heights", "0.1", "--peak",
                 "1", "--length", "60", "--ease", "5")  # fmt: skip
        done = self.run_tool(*words, "-o", "limits.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"as it is +5 +18\.0 +\d+\.\d +\d+\n")
        self.assertRegex(done.stdout, r"soft +100 +\d+\.\d\d +\d+\.\d +\d+\n?")
        self.assertIn('contact = "point" feel no force along the road: the vehicle keeps its speed', done.stdout)
        self.assertGreater((self.folder / "limits.png").stat().st_size, 10000)
        done = self.run_tool(*words, "--json")
        packed = json.loads(done.stdout)
        self.assertEqual((packed["format"], packed["version"], packed["power"]), ("sprung-ride-limits", 2, 6.0))
        first, second = packed["vehicles"]
        self.assertEqual((first["label"], first["set"]), ("as it is", []))
        self.assertEqual(second["set"], ["vehicle.forces.suspension.damper.coefficient=700.0"])
        self.assertEqual(first["terrain"][0]["speed"], 5.0)
        # A softer damper passes on less of what is fast.
        self.assertLess(first["terrain"][0]["roughness"], second["terrain"][0]["roughness"])
        self.assertEqual(first["obstacles"][0]["height"], 0.1)

    def test_runs_start_no_programs_where_the_module_is_there(self):
        module = load_module(Path(os.environ["SPRUNG_DYNAMICS"]))
        if module.call is None:
            self.skipTest(module.what)
        program = self.folder / "bin/sprung-dynamics"  # fails at each start
        program.parent.mkdir()
        program.write_text("#!/bin/sh\nexit 3\n", encoding="utf-8")
        program.chmod(0o755)
        (program.parent / Path(module.what).name).symlink_to(module.what)
        words = ("ride_limits", "run.toml", "--point", "sprung.origin", "--speeds", "5", "--heights", "--length", "60",
                 "--ease", "5", "--json")  # fmt: skip
        done = self.run_tool(*words, SPRUNG_DYNAMICS=str(program))
        self.assertEqual(done.returncode, 0, done.stderr)
        (limit,) = json.loads(done.stdout)["vehicles"][0]["terrain"]
        self.assertEqual((limit["problem"], limit["roughness"] is None), ("", False))

    def test_what_cannot_be_is_refused(self):
        for arguments, message in (
            (("--speeds", "-3"), "--speeds: error: is -3, expected a finite value > 0"),
            (("--roughness", "0.2", "0.1"), "--roughness: error: got 0.2 0.1, expected two ascending values"),
            (("--variant", "soft", "road"), "--variant soft: error: 'road' is not KEY=VALUE"),
            (("--variant", "a", "--variant", "a"), "--variant: error: the label 'a' stands twice"),
            (("--speeds", "--heights"), "there are neither speeds nor --heights"),
            (("--variant", "x", "sped=3"), "sped=3: error: unknown key 'sped'"),
            (("--spacing", "0.07"), "--spacing 0.07 m must divide"),
        ):
            process = self.run_tool("ride_limits", "run.toml", "--point", "sprung.origin", *arguments)
            self.assert_refuses(process, message)

    def test_changes_without_effect_are_refused(self):
        """Each run has a road, a speed, times and an output of its own, and took no notice of them."""
        for option in (("--set",), ("--variant", "x")):
            for change, reason in (
                ("road.height=0.2", "each run has a road of its own"), ("road={shape='flat'}", "each run has a road"),
                ("speed=3", "each run has a speed of its own (--speeds"), ("duration=9", "each run lasts as long as"),
                ("statistics.from=1", "the span that is judged"), ("output.step.points=0.1", "each run stores what"),
                ('"continue_from"="a.h5"', "each run begins anew"),
            ):  # fmt: skip
                process = self.run_tool("ride_limits", "run.toml", "--point", "sprung.origin", *option, change)
                name = " ".join(option)
                self.assert_refuses(process, f"{name}: error: '{change}' would have no effect: {reason}")


if __name__ == "__main__":
    unittest.main()
