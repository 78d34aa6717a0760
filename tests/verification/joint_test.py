#!/usr/bin/python3
"""Joints one by one, with their reactions, against closed forms."""

import math
import unittest

import numpy as np

from verification_case import VerificationCase


class Slide(VerificationCase):
    def test_block_on_an_inclined_rail(self):
        # Rail at an angle of 0.5 rad through a point of a body that is not its centre; a = g sin, N = m g cos, and
        # the rail's torque about that point holds the weight's lever.
        results = self.run_text(
            """
name = "block"
gravity = [0.0, -9.81]
[bodies.block]
mass = 2.0
inertia = 0.3
position = [0.3, 1.2]
angle = 0.5
points = { foot = [0.1, -0.2] }
[[joints]]
name = "rail"
type = "translational"
a = "ground.origin"
b = "block.foot"
axis = [0.8775825618903728, 0.479425538604203]
""",
            'start = "as-given"\nduration = 1.0\n[integrator]\nrelative_tolerance = 1e-9\n',
        )
        along = results["joints/rail/coordinate"]
        expected = along[0] - 0.5 * 9.81 * math.sin(0.5) * results.time**2
        self.assert_close(along, expected, absolute=1e-8)
        self.assert_close(results["joints/rail/rate"], -9.81 * math.sin(0.5) * results.time, absolute=1e-8)
        force = results["joints/rail/reaction"][:, :2]  # on the ground
        normal = np.array([-math.sin(0.5), math.cos(0.5)])
        self.assert_close(force @ normal, -2.0 * 9.81 * math.cos(0.5), relative=1e-9)
        self.assert_close(force @ [math.cos(0.5), math.sin(0.5)], 0.0, absolute=1e-9)
        # About the ground's point: force at the foot, whose way along the rail is its lever, and the torque on the
        # block about its foot, which balances the rail's normal force at the centre of mass.
        torque = results["joints/rail/reaction"][:, 2]
        lever = -0.1  # of the centre of mass along the rail, from the foot
        self.assert_close(torque, -2.0 * 9.81 * math.cos(0.5) * (along + lever), absolute=1e-7)


class Weld(VerificationCase):
    def test_two_welded_bodies_swing_as_one(self):
        # A bar of 1 kg, 1 m, pinned at its end, with a disc of 2 kg, 0.1 kg·m² welded to its other end.
        head = """
name = "{0}"
gravity = [0.0, -9.81]
[[joints]]
name = "pin"
type = "revolute"
a = "ground.origin"
b = "bar.end"
"""
        two = head.format("two") + """
[bodies.bar]
mass = 1.0
inertia = 0.08333333333333333
position = [0.5, 0.0]
points = { end = [-0.5, 0.0], tip = [0.5, 0.0] }
[bodies.disc]
mass = 2.0
inertia = 0.1
position = [1.0, 0.0]
angle = 0.7
[[joints]]
name = "weld"
type = "fixed"
a = "bar.tip"
b = "disc.origin"
"""
        center = (0.5 + 2.0 * 1.0) / 3.0
        inertia = 1.0 / 12.0 + (center - 0.5) ** 2 + 0.1 + 2.0 * (1.0 - center) ** 2
        one = head.format("one") + f"""
[bodies.bar]
mass = 3.0
inertia = {inertia!r}
position = [{center!r}, 0.0]
points = {{ end = [{-center!r}, 0.0] }}
"""
        run = 'start = "as-given"\nduration = 2.0\n[integrator]\nrelative_tolerance = 1e-9\n'
        welded = self.run_text(two, run)
        angle = welded["bodies/bar/position"][:, 2]
        self.assert_close(welded["bodies/disc/position"][:, 2], angle + 0.7, absolute=1e-11)
        # The weld gives the disc its acceleration: the reaction is on the bar.
        weld = welded["joints/weld/reaction"]
        acceleration = welded["bodies/disc/acceleration"]
        self.assert_close(-weld[:, :2], 2.0 * (acceleration[:, :2] + [0.0, 9.81]), absolute=1e-8)
        self.assert_close(-weld[:, 2], 0.1 * acceleration[:, 2], absolute=1e-8)
        single = self.run_text(one, run)
        self.assert_close(angle, single["bodies/bar/position"][:, 2], absolute=1e-7)


class PinInSlot(VerificationCase):
    def test_quick_return(self):
        # A crank of 0.3 m about (0, 0.5) drives a lever about the origin by a pin in its slot: lever angle
        # atan2(0.5 + 0.3 sin, 0.3 cos).
        results = self.run_text(
            """
name = "quick return"
gravity = [0.0, 0.0]
[bodies.crank]
mass = 1.0
inertia = 0.05
position = [0.0, 0.5]
points = { pin = [0.3, 0.0] }
[bodies.lever]
mass = 2.0
inertia = 0.2
position = [0.2, 0.4]
angle = 1.03
points = { pivot = [-0.4, 0.0] }
[ground.points]
crank = [0.0, 0.5]
[[joints]]
name = "crank"
type = "revolute"
a = "ground.crank"
b = "crank.origin"
[[joints]]
name = "lever"
type = "revolute"
a = "ground.origin"
b = "lever.pivot"
[[joints]]
name = "slot"
type = "pin-in-slot"
a = "lever.pivot"
b = "crank.pin"
axis = [1.0, 0.0]
[[motions]]
name = "motor"
joint = "crank"
function = { polynomial = [0.0, 6.0] }
""",
            'start = "as-given"\nduration = 2.0\n',
        )
        crank = 6.0 * results.time
        x, y = 0.3 * np.cos(crank), 0.5 + 0.3 * np.sin(crank)
        self.assert_close(results["bodies/lever/position"][:, 2], np.unwrap(np.arctan2(y, x)), absolute=1e-9)
        self.assert_close(results["joints/slot/coordinate"], np.hypot(x, y), absolute=1e-9)
        # The lever's balance about its pivot, J = 0.2 + 2 · 0.4²: the slot's force stands across it at the pin.
        torque = (0.2 + 2.0 * 0.4**2) * results["bodies/lever/acceleration"][:, 2]
        # The pivot's reaction passes through the pivot; the slot's, on the lever at its point a there, brings its
        # torque.
        self.assert_close(results["joints/slot/reaction"][:, 2], torque, absolute=1e-6 * np.max(np.abs(torque)))


class Actuator(VerificationCase):
    def test_length_that_is_a_function_of_time(self):
        # A jib of 4 kg pinned at the origin, held by a cylinder from (0, 2) to its end at 2 m.
        results = self.run_text(
            """
name = "jib"
gravity = [0.0, -9.81]
[bodies.jib]
mass = 4.0
inertia = 1.3333333333333333
position = [1.0, 0.0]
points = { root = [-1.0, 0.0], tip = [1.0, 0.0] }
[ground.points]
mast = [0.0, 2.0]
[[joints]]
name = "root"
type = "revolute"
a = "ground.origin"
b = "jib.root"
[[joints]]
name = "cylinder"
type = "distance"
a = "ground.mast"
b = "jib.tip"
length = { step = { before = 2.8284271247461903, after = 2.0, start = 0.2, end = 1.2 } }
""",
            "duration = 2.0\n",
        )
        # Isosceles with two sides of 2 m: length = 4 sin(half the angle at the origin).
        length = results["joints/cylinder/coordinate"]
        self.assert_close(length[[0, -1]], [math.sqrt(8.0), 2.0], absolute=1e-10)
        self.assert_close(
            results["bodies/jib/position"][:, 2], 0.5 * math.pi - 2.0 * np.arcsin(0.25 * length), absolute=1e-9
        )
        # Raised to 30°: the centre rises 0.5 m, which the cylinder's work pays.
        self.assert_close(results["energy/input"][-1], 4.0 * 9.81 * 0.5, relative=1e-5)
        self.assertLess(results.summary["energy_closure"], 1e-6)


CRANK = """
name = "crank and piston"
gravity = [0.0, -9.81]
[bodies.crank]
mass = 1.0
inertia = 0.05
position = [0.2, 0.15]
angle = 0.6435011087932844
points = { axle = [-0.25, 0.0], pin = [0.25, 0.0] }
[bodies.rod]
mass = 0.8
inertia = 0.1
position = [1.0, 0.15]
angle = -0.2526802551420786
points = { pin = [-0.62, 0.0], gudgeon = [0.62, 0.0] }
[bodies.piston]
mass = 2.0
inertia = 0.02
position = [1.6, 0.0]
[[joints]]
name = "axle"
type = "revolute"
a = "ground.origin"
b = "crank.axle"
[[joints]]
name = "pin"
type = "revolute"
a = "crank.pin"
b = "rod.pin"
[[joints]]
name = "gudgeon"
type = "revolute"
a = "rod.gudgeon"
b = "piston.origin"
[[joints]]
name = "rail"
type = "translational"
a = "ground.origin"
b = "piston.origin"
axis = [1.0, 0.0]
"""


class Rates(VerificationCase):
    def start(self, rates, run="", vehicle=CRANK):
        return self.run_text(vehicle, f'start = "as-given"\nduration = 0.02\n{run}\n[joint_rates]\n{rates}\n')

    def refused(self, rates, vehicle=CRANK):
        return self.refuse_text(vehicle, f'duration = 0.02\nstart = "as-given"\n[joint_rates]\n{rates}\n')

    def test_a_rate_moves_the_mechanism_from_the_start(self):
        # Crank of 0.5 m at an angle α, rod of 1.24 m: the piston's rate by the crank's.
        results = self.start("axle = 4.0")
        alpha = results["joints/axle/coordinate"][0]
        rod = math.sqrt(1.24**2 - (0.5 * math.sin(alpha)) ** 2)
        by_angle = -0.5 * math.sin(alpha) - 0.25 * math.sin(alpha) * math.cos(alpha) / rod
        self.assert_close(results["joints/axle/rate"][0], 4.0, relative=1e-12)
        self.assert_close(results["joints/rail/rate"][0], 4.0 * by_angle, relative=1e-10)
        # The same start from the other end, and with two rates that agree.
        other = self.start(f"rail = {4.0 * by_angle!r}\naxle = 4.0")
        self.assert_close(other["joints/axle/rate"][0], 4.0, relative=1e-10)
        self.assertLess(other.summary["energy_closure"], 1e-6)

    def test_rates_that_contradict_the_joints_are_refused(self):
        message = self.refused("axle = 0.0\nrail = 1.0")
        self.assertIn("run.toml:6:8: error: 'joint_rates.rail' must be 0 m/s, as the joints, prescribed motion and the "
                      "rates before it require, got 1", message)
        motor = '[[motions]]\nname = "motor"\njoint = "axle"\nfunction = { polynomial = [0.6435011087932844, 2.0] }\n'
        message = self.refused("axle = 3.0", CRANK + motor)
        self.assertIn("run.toml:5:8: error: 'joint_rates.axle' must be 2 rad/s", message)
        self.assert_close(self.start("axle = 2", "", CRANK + motor)["joints/axle/rate"][0], 2.0, relative=1e-12)

    def test_rates_of_what_has_none_are_refused(self):
        self.assertIn(
            "'joint_rates.axel' is about no joint of the vehicle (did you mean 'axle'?)", self.refused("axel = 1.0")
        )
        weld = CRANK.replace('type = "revolute"\na = "rod.gudgeon"', 'type = "fixed"\na = "rod.gudgeon"')
        weld = weld.replace('type = "translational"', 'type = "pin-in-slot"')
        self.assertIn(
            "'joint_rates.gudgeon' is about a fixed joint, which has no coordinate", self.refused("gudgeon = 1.0", weld)
        )

    def test_a_rate_adds_to_speed_and_initial_motion(self):
        # A disc on a free frame: the joint's torque leaves the total angular momentum as it was.
        vehicle = """
name = "wheel"
gravity = [0.0, 0.0]
[bodies.frame]
mass = 4.0
inertia = 3.0
position = [0.0, 0.0]
[bodies.disc]
mass = 1.0
inertia = 1.0
position = [0.0, 0.0]
[[joints]]
name = "hub"
type = "revolute"
a = "frame.origin"
b = "disc.origin"
"""
        results = self.start("hub = 8.0", "speed = 2.0\n[initial.frame]\nangular_velocity = 1.0\n", vehicle)
        frame, disc = (results[f"bodies/{name}/velocity"][0] for name in ("frame", "disc"))
        self.assert_close(frame[:2], [2.0, 0.0], absolute=1e-12)
        self.assert_close(disc[2] - frame[2], 8.0, relative=1e-12)
        self.assert_close(3.0 * frame[2] + disc[2], 3.0, relative=1e-12)


if __name__ == "__main__":
    unittest.main()
