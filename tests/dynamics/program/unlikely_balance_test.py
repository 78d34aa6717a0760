#!/usr/bin/python3
"""Static equilibria that no vehicle has: fallen through its springs or tyres, or drawn far apart."""

import re
import unittest

from dynamics_test_case import ROOT, DynamicsTestCase


TEMPLATES = ROOT / "dynamics/models/templates"


class WheelsUnderTheRoad(DynamicsTestCase):
    def test_the_deepest_wheel_and_its_depth_are_named(self):
        # The half car 30 m too low, on wheels with a length of contact: the centres of the wheels are at 0.3 − 30 m.
        templates = ROOT / "dynamics/models/templates"
        text = (templates / "half_car.toml").read_text(encoding="utf-8")
        text = re.sub(r"(position = \[\S+,) (\S+)\]", lambda found: f"{found[1]} {float(found[2]) - 30}]", text)
        text = text.replace("free_length = { static = 0.25 }", "free_length = 0.5")
        text = text.replace("damping = 50.0", 'damping = 50.0\ncontact = "distributed"')
        (self.folder / "vehicle.toml").write_text(text, encoding="utf-8")
        run = (templates / "half_car_run.toml").read_text(encoding="utf-8")
        (self.folder / "bump.toml").write_text(run.replace("half_car.toml", "vehicle.toml"), encoding="utf-8")
        line = text.splitlines().index('name = "front_tyre"') + 1
        process = self.run_program(verb="equilibrium")
        self.assert_refused(process, f"vehicle.toml:{line}:",
                            "the centre of the wheel of 'forces.front_tyre' is 29.7 m under the road")  # fmt: skip
        self.assertNotIn("gravity", process.stderr)

    def test_a_wheel_that_the_balance_lifts_out_of_the_road_is_remarked_on(self):
        # The half car drawn 0.9 m too low: its wheels begin 0.6 m under the road.
        process = self.run_half_car(-0.9)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertRegex(process.stderr, r"remark: vehicle.toml:\d+:\d+: as drawn, the centre of the wheel of "
                                         r"'forces\.front_tyre' is 0\.6 m under the road")  # fmt: skip

    def test_bodies_far_from_their_drawing_are_remarked_on(self):
        for above, told in ((0.0, False), (0.7, True)):
            process = self.run_half_car(above)
            self.assertEqual(process.returncode, 0, process.stderr)
            found = re.findall(r"static equilibrium 'bodies.(\w+)' is ([\d.]+) m lower than it is", process.stderr)
            self.assertEqual([name for name, _ in found], ["body", "front_axle", "rear_axle"] if told else [])
            for _, lower in found:
                self.assertAlmostEqual(float(lower), above, delta=0.05)

    def run_half_car(self, above):
        """The balance of the half car of the templates, drawn higher by a distance in m."""
        templates = ROOT / "dynamics/models/templates"
        text = (templates / "half_car.toml").read_text(encoding="utf-8")
        text = re.sub(r"(position = \[\S+,) (\S+)\]", lambda found: f"{found[1]} {float(found[2]) + above}]", text)
        (self.folder / "vehicle.toml").write_text(text, encoding="utf-8")
        run = (templates / "half_car_run.toml").read_text(encoding="utf-8")
        (self.folder / "bump.toml").write_text(run.replace("half_car.toml", "vehicle.toml"), encoding="utf-8")
        return self.run_program(verb="equilibrium")


class BodiesOnWhichNothingActs(DynamicsTestCase):
    def test_they_are_named_where_there_is_no_equilibrium(self):
        self.edit("vehicle.toml", "[bodies.chassis]", "[bodies.crate]\nmass = 50.0\ninertia = 2.0\n"
                  "position = [0.0, 2.0]\n\n[bodies.chassis]")  # fmt: skip
        process = self.run_program(verb="equilibrium")
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertIn("no joint or force element acts on 'bodies.crate'", process.stderr)


class SuspensionsOnStops(DynamicsTestCase):
    def test_a_stop_that_bears_load_at_rest_is_remarked_on(self):
        # The half car's static deflection is 0.15 m; a stop that a reader takes for travel begins before it.
        templates = ROOT / "dynamics/models/templates"
        text = (templates / "half_car.toml").read_text(encoding="utf-8")
        run = (templates / "half_car_run.toml").read_text(encoding="utf-8")
        (self.folder / "bump.toml").write_text(run.replace("half_car.toml", "vehicle.toml"), encoding="utf-8")
        for stop in (0.07, 0.22):
            (self.folder / "vehicle.toml").write_text(
                text.replace("compression_stop = { deflection = 0.22", f"compression_stop = {{ deflection = {stop}"),
                encoding="utf-8",
            )
            for verb in ("run", "equilibrium", "modes"):
                settings = ("--set", "duration=0.01") if verb == "run" else ()
                process = self.run_program(*settings, verb=verb)
                self.assertEqual(process.returncode, 0, process.stderr)
                told = re.findall(r"remark: vehicle.toml:\d+:\d+: in static equilibrium 'forces\.(\w+)' is on its "
                                  r"compression stop, [\d.]+ m deep: its deflection is [\d.]+ m, and the stop begins "
                                  r"at 0\.07 m", process.stderr)  # fmt: skip
                self.assertEqual(told, ["front_suspension"] if stop == 0.07 else [])
                self.assertEqual("compression stop, " in process.stderr, bool(told))


class TurnedSprings(DynamicsTestCase):
    def setUp(self):
        super().setUp()
        for _ in range(2):
            self.edit("vehicle.toml", "compression_stop = { deflection = 0.15, rate = 6.91e6 }", "")

    def soften(self, rate):
        """Both suspensions get a linear spring."""
        for _ in range(2):
            self.edit("vehicle.toml", "polynomial = [0.0, 4.67e5, 7.45e5]", f"polynomial = [0.0, {rate}]")

    def test_a_run_is_remarked_on(self):
        # Half of the weight, 71 kN, would shorten two springs of 1e4 N/m by 3.5 m.
        self.soften(1e4)
        for verb in ("run", "equilibrium", "modes"):
            process = self.run_program(*(("--set", "duration=0.01") if verb == "run" else ()), verb=verb)
            self.assertEqual(process.returncode, 0, process.stderr)
            for name in ("front_suspension", "rear_suspension"):
                self.assertRegex(process.stderr, rf"remark: vehicle.toml:\d+:\d+: in static equilibrium "
                                 rf"'forces\.{name}' points the other way than as drawn; does it carry its load\?\n")

    def test_a_suspension_that_carries_its_load_is_not(self):
        self.assertNotIn("points the other way", self.run_program("--set", "duration=0.01").stderr)

    def test_a_static_length_on_the_other_side_is_refused(self):
        """100 kg above the ground on a soft spring: below the ground they hang from another spring, which pulls with
        1020 N there. The soft one has the length asked for, and pushes them down with the rest, 39.3 N."""
        (self.folder / "vehicle.toml").write_text("""
name = "mass on a spring"
heading = "+x"

[bodies.mass]
mass = 100.0
inertia = 10.0
position = [0.0, 0.5]

[ground.points]
floor = [0.0, 0.0]
ceiling = [0.0, 1.0]

[[joints]]
name = "guide"
type = "translational"
a = "ground.floor"
b = "mass.origin"
axis = [0.0, 1.0]

[[forces]]
name = "hanger"
type = "spring-damper"
a = "ground.ceiling"
b = "mass.origin"
free_length = 0.48
spring = { polynomial = [0.0, 1000.0] }

[[forces]]
name = "seat"
type = "spring-damper"
a = "ground.floor"
b = "mass.origin"
free_length = { static = 0.5 }
spring = { polynomial = [0.0, 100.0] }
""")
        (self.folder / "bump.toml").write_text(
            'vehicle = "vehicle.toml"\nduration = 0.01\noutput_step = 0.01\nspeed = 0.0\n')
        process = self.run_program()
        self.assert_refused(process, "vehicle.toml:", "'forces.seat.free_length.static': where the length is reached, "
                            "the spring points the other way than as drawn")


class HangingAxles(DynamicsTestCase):
    def test_an_axle_without_a_tyre_that_hangs_on_a_spring_as_drawn_is_remarked_on(self):
        # The spring's length is that of the drawing, so that nothing moves: it pulls the axle up.
        text = (TEMPLATES / "bus.toml").read_text(encoding="utf-8")
        run = (TEMPLATES / "bus_run.toml").read_text(encoding="utf-8")
        (self.folder / "bump.toml").write_text(run.replace("bus.toml", "vehicle.toml"), encoding="utf-8")
        tyre = re.search(r'\[\[forces\]\]\nname = "trailing_tyre".*?(?=\[\[|\Z)', text, re.DOTALL)[0]
        for vehicle, told in ((text, False), (text.replace(tyre, ""), True)):
            (self.folder / "vehicle.toml").write_text(vehicle, encoding="utf-8")
            process = self.run_program(verb="equilibrium")
            self.assertEqual(process.returncode, 0, process.stderr)
            found = re.findall(r"vehicle.toml:\d+:\d+: in static equilibrium 'forces\.(\w+)' pulls with .* N, and "
                               r"'bodies\.(\w+)' hangs on it: nothing else holds it up", process.stderr)  # fmt: skip
            self.assertEqual(found, [("trailing_suspension", "trailing_axle")] if told else [], process.stderr)


class AirSpringsWithoutVolume(DynamicsTestCase):
    def test_they_are_named_where_the_vehicle_is_drawn_so(self):
        vehicle = (
            'name = "squeezed"\n[bodies.body]\nmass = 5000.0\ninertia = 100.0\nposition = [0.0, 0.01]\n'
            '[[joints]]\nname = "guide"\ntype = "translational"\na = "ground.origin"\nb = "body.origin"\n'
            'axis = [0.0, 1.0]\n[[forces]]\nname = "air"\ntype = "air-spring"\na = "ground.origin"\nb = "body.origin"\n'
            "design_height = 0.3\neffective_area = 0.05\nvolume = 0.01\nload = 5000.0\n"
        )
        self.assert_named(vehicle, 'duration = 0.1\nvehicle = "vehicle.toml"\n', "'air' (points 0.01 m apart)")

    def test_they_are_named_where_the_search_squeezes_them(self):
        # The rear axle is not guided, and falls over on a small air spring that shares its air with that of the front.
        text = (TEMPLATES / "half_car.toml").read_text(encoding="utf-8")
        text = re.sub(r'\[\[joints\]\]\nname = "rear_guide".*?\n\n', "\n", text, flags=re.DOTALL)
        air = (
            '[[forces]]\nname = "air"\ntype = "air-spring"\na = "rear_axle.origin"\nb = "body.rear"\n'
            "multiplicity = 2\ndesign_height = 0.25\neffective_area = 0.01\nvolume = 0.001\nload = 2900.0\n"
            'partner = { a = "front_axle.origin", b = "body.front", line = { diameter = 0.012 } }\n\n'
        )
        first, last = (text.index(f'[[forces]]\nname = "{name}"') for name in ("front_suspension", "front_tyre"))
        run = (TEMPLATES / "half_car_run.toml").read_text(encoding="utf-8").replace("half_car.toml", "vehicle.toml")
        self.assert_named(text[:first] + air + text[last:], run, "'air' (points ")

    def assert_named(self, vehicle, run, words):
        (self.folder / "vehicle.toml").write_text(vehicle, encoding="utf-8")
        (self.folder / "bump.toml").write_text(run, encoding="utf-8")
        process = self.run_program(verb="equilibrium")
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertIn(f"no force can be calculated for {words}", process.stderr)


class Tyres(DynamicsTestCase):
    def test_a_tyre_pressed_in_by_more_than_its_radius_is_an_error(self):
        # 200 N/m in place of N/mm: half of the weight presses two such tyres in by far more than 0.6 m.
        process = self.run_program("--set", "vehicle.forces.front_tyre.spring.polynomial=[0.0, 200.0]",
                                   verb="equilibrium")  # fmt: skip
        self.assertEqual(process.returncode, 2, process.stderr)
        self.assertRegex(
            process.stderr,
            r"vehicle\.toml:\d+:\d+: error: in static equilibrium 'forces\.front_tyre' is pressed in by [\d.]+ m of "
            r"its radius of 0\.6 m; stiffnesses are in N/m, not in N/mm\n",
        )

    def test_a_tyre_pressed_in_by_more_than_half_of_it_is_remarked_on(self):
        # Two tyres carry about 71 kN, which press in a linear one of 9e4 N/m by 0.39 m.
        process = self.run_program("--set", "vehicle.forces.front_tyre.spring.polynomial=[0.0, 9e4]",
                                   verb="equilibrium")  # fmt: skip
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertRegex(process.stderr, r"remark: .*'forces\.front_tyre' is pressed in by 0\.[345]")


if __name__ == "__main__":
    unittest.main()
