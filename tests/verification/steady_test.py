#!/usr/bin/python3
"""Modes about steady motion of a whole system: on a rotating shaft, and on a carriage."""

import math
import os
import unittest

import numpy as np

from verification_case import ROOT, VerificationCase, run_program

HUB = """
name = "turning"
gravity = [0.0, 0.0]
[ground.points]
axis = [0.4, -0.3]
[bodies.hub]
mass = 2.0
inertia = 0.5
position = [0.4, -0.3]
points = {{ arm = [0.5, 0.0], left = [-1.0, 0.0], right = [1.0, 0.0], low = [0.0, -1.0], high = [0.0, 1.0] }}
[[joints]]
name = "bearing"
type = "revolute"
a = "ground.axis"
b = "hub.origin"
[[motions]]
name = "speed"
joint = "bearing"
function = {{ polynomial = [0.2, {speed}] }}
{rest}
"""
# A bar hinged at the arm: 0.5 m from the axis, its centre 0.3 m from the hinge.
PENDULUM = """
[bodies.bar]
mass = 3.0
inertia = 0.2
position = [1.19, -0.12]
angle = 0.3
points = { eye = [-0.3, 0.0] }
[[joints]]
name = "hinge"
type = "revolute"
a = "hub.arm"
b = "bar.eye"
"""
# A disc held to the hub's middle by 2 k in every direction: four ropes without length of their own, k/2 each.
ROTOR = """
[bodies.disc]
mass = 5.0
inertia = 0.1
position = [0.4, -0.3]
""" + "".join(f"""
[[forces]]
name = "to_{end}"
type = "spring-damper"
a = "hub.{end}"
b = "disc.origin"
free_length = 1e-12
spring = {{ polynomial = [0.0, 500.0] }}
""" for end in ("left", "right", "low", "high"))


class Steady(VerificationCase):
    def modes_of(self, rest, speed, *arguments):
        self.write(HUB.format(speed=speed, rest=rest))
        return self.modes(self.folder / "run.toml", *arguments)

    def write(self, vehicle):
        self.write_model(vehicle, 'duration = 1.0\nstart = "steady"\n')

    def test_pendulum_on_a_turning_arm(self):
        # It points outwards and swings in the centrifugal field: (J + m l²) ω² = m a l Ω².
        for speed in (4.0, -11.0):
            omega, num_rigid = self.modes_of(PENDULUM, speed)
            self.assertEqual(num_rigid, 0)
            self.assert_close(omega, [abs(speed) * math.sqrt(3.0 * 0.5 * 0.3 / (0.2 + 3.0 * 0.3**2))], relative=1e-7)

    def test_a_run_continues_the_steady_motion(self):
        self.write(HUB.format(speed=4.0, rest=PENDULUM))
        results = self.run_to_results(self.folder / "run.toml")
        self.assert_close(results["bodies/bar/velocity"][:, 2], 4.0, absolute=1e-6)
        self.assert_close(results["joints/hinge/coordinate"], 0.0, absolute=1e-6)

    def test_whirl_of_a_disc_seen_from_its_shaft(self):
        # 20 rad/s at rest; forward and backward whirl turn against the shaft's own Ω: |20 − Ω| and 20 + Ω, also above
        # 20 rad/s, where the Coriolis force alone holds the disc. Nothing holds its angle.
        for speed in (0.5, 7.0, 33.0):
            omega, num_rigid = self.modes_of(ROTOR, speed)
            self.assertEqual(num_rigid, 1)
            self.assert_close(omega, sorted([abs(20.0 - speed), 20.0 + speed]), relative=1e-6)

    def test_whirl_of_a_disc_on_parts_that_relax(self):
        # A bushing of 2000 N/m each way that turns with the hub, and a part that relaxes along its x: undamped
        # frequencies are those of the disc alone, as above; damped ones those of (x, y, ẋ, ẏ, e) seen from the hub.
        stiffness, time, speed, mass = 600.0, 0.05, 7.0, 5.0
        laws = "spring = { polynomial = [0.0, 2000.0] }"
        bushing = (
            '[[forces]]\nname = "mount"\ntype = "bushing"\na = "hub.origin"\nb = "disc.origin"\n'
            f"x = {{ {laws}, relaxation = {{ stiffness = {stiffness}, time = {time} }} }}\ny = {{ {laws} }}\n"
        )
        disc = ROTOR[: ROTOR.index("[[forces]]")]
        self.write(HUB.format(speed=speed, rest=disc + bushing))
        modes = self.program("modes", self.folder / "run.toml")["modes"]
        self.assertEqual([mode["rigid_body"] for mode in modes], [True, False, False])
        undamped = [2.0 * math.pi * mode["undamped_frequency"] for mode in modes[1:]]
        self.assert_close(undamped, [20.0 - speed, 20.0 + speed], relative=1e-6)
        k = 2000.0 / mass - speed**2
        matrix = np.array([[0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0],
                           [-k, 0.0, 0.0, 2.0 * speed, -stiffness / mass],
                           [0.0, -k, -2.0 * speed, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, -1.0 / time]])  # fmt: skip
        damped = sorted((s for s in np.linalg.eigvals(matrix) if s.imag > 0.0), key=lambda s: s.imag)
        for mode, s in zip(modes[1:], damped, strict=True):
            self.assert_close(mode["damped_frequency"], s.imag / (2.0 * math.pi), relative=1e-6)
            self.assert_close(mode["damping_ratio"], -s.real / abs(s), relative=1e-5)

    def test_internal_damping_makes_a_fast_shaft_unstable(self):
        # Damping that rotates with the shaft makes the whirl unstable above its critical speed.
        spring = "spring = { polynomial = [0.0, 500.0] }"
        self.assertIn(spring, ROTOR)
        damped = ROTOR.replace(spring, spring + "\ndamper = { coefficient = 3.0 }")
        self.modes_of(damped, 15.0)
        self.write(HUB.format(speed=25.0, rest=damped))
        self.assert_fails(3, "unstable")

    def test_reports_say_steady_and_a_stretched_bar_is_not_all_deflection(self):
        # Two bending modes, which rotation does not excite; the elongation of 0.1 µm is in modes left out.
        self.write_model(
            'name = "turning arm"\ngravity = [0.0, 0.0]\n'
            '[bodies.arm]\nsuperelement = "long_arm"\nposition = [0.0, 0.0]\n'
            '[[joints]]\nname = "shaft"\ntype = "revolute"\na = "ground.origin"\nb = "arm.chassis_end"\n'
            '[[motions]]\nname = "speed"\njoint = "shaft"\nfunction = { polynomial = [0.3, 5.0] }\n',
            'duration = 0.2\nstart = "steady"\n[modes]\narm = 2\n',
        )
        texts = {}
        for verb in ("run", "equilibrium", "modes"):
            command = [os.environ["SPRUNG_DYNAMICS"], verb, "run.toml", "--superelements"]
            superelements = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]
            texts[verb] = run_program([*command, superelements], cwd=self.folder, check=True).stdout
            self.assertNotIn("tatic equilibrium", texts[verb])
            self.assertRegex(texts[verb], "[Ss]teady motion")
        self.assertNotIn("modes are missing", texts["run"])

    def test_a_vehicle_at_constant_speed_is_in_the_balance_at_rest(self):
        # The motion of a point along x alone could be one about a far centre, too, which the road does not allow.
        templates = ROOT / "dynamics/models/templates"
        vehicle = (templates / "half_car.toml").read_text(encoding="utf-8") + (
            '[[motions]]\nname = "cruise"\npoint = "body.center_of_mass"\ncoordinate = "x"\n'
            "function = { polynomial = [0.0, 8.33] }\n"
        )
        found = []
        for start in ("equilibrium", "steady"):
            run = self.write_model(vehicle, f'duration = 1.0\nspeed = 8.33\nstart = "{start}"\n')
            found.append(self.program("equilibrium", run)["bodies"])
        for name, body in found[0].items():
            self.assert_close(list(found[1][name].values()), list(body.values()), absolute=1e-9)

    def test_motion_that_is_not_steady_is_refused(self):
        spring = ('[[forces]]\nname = "rope"\ntype = "spring-damper"\na = "ground.origin"\nb = "bar.origin"\n'
                  "free_length = 0.5\nspring = { polynomial = [0.0, 100.0] }\n")
        turning = HUB.format(speed=9.0, rest=PENDULUM)
        for vehicle in (
            turning + spring,
            turning.replace("gravity = [0.0, 0.0]", "gravity = [0.0, -1.0]"),
            turning.replace("polynomial = [0.2, 9.0]", "polynomial = [0.2, 9.0, 1.0]"),
        ):
            self.write(vehicle)
            self.assert_fails(2, "run.toml:3:9: error: 'start' can be \"steady\" only where the moving system sees")

    def assert_fails(self, code, words):
        process = run_program([os.environ["SPRUNG_DYNAMICS"], "modes", "run.toml"], cwd=self.folder)
        self.assertEqual(process.returncode, code, process.stdout + process.stderr)
        self.assertIn(words, process.stderr)


if __name__ == "__main__":
    unittest.main()
