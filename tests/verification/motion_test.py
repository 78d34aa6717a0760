#!/usr/bin/python3
"""Prescribed motion: that it is followed, the force that it needs, and its work in the energy book."""

import unittest

import numpy as np

from verification_case import VerificationCase

SLED = """
name = "sled"
gravity = [0.0, -9.81]
[bodies.sled]
mass = 3.0
inertia = 1.0
position = [0.0, 0.0]
[bodies.load]
mass = 2.0
inertia = 0.1
position = [0.0, -1.0]
points = {{ eye = [0.0, 0.6] }}
[[joints]]
name = "rail"
type = "translational"
a = "ground.origin"
b = "sled.origin"
axis = [1.0, 0.0]
[[joints]]
name = "hook"
type = "revolute"
a = "sled.origin"
b = "load.eye"
[[motions]]
name = "drive"
{0}
"""
FUNCTIONS = {
    "polynomial": (
        "{ polynomial = [0.0, 0.3, -0.2, 0.1] }",
        lambda t: 0.3 * t - 0.2 * t**2 + 0.1 * t**3,
        lambda t: -0.4 + 0.6 * t,
    ),
    "harmonic": (
        "{ harmonic = { amplitude = 0.4, frequency = 1.2 } }",
        lambda t: 0.4 * np.sin(2.4 * np.pi * t),
        lambda t: -0.4 * (2.4 * np.pi) ** 2 * np.sin(2.4 * np.pi * t),
    ),
    "step": (
        "{ step = { before = 0.0, after = 0.5, start = 0.3, end = 0.9 } }",
        lambda t: 0.5 * smooth(np.clip((t - 0.3) / 0.6, 0.0, 1.0)),
        lambda t: 0.5 / 0.36 * smooth_second(np.clip((t - 0.3) / 0.6, 0.0, 1.0)),
    ),
    # (t/2)² sin 3πt + 0.1 t, by the product rule.
    "growing harmonic": (
        "{ sum = [{ polynomial = [0.0, 0.1] },"
        " { product = [{ polynomial = [0.0, 0.0, 0.25] }, { harmonic = { amplitude = 1.0, frequency = 1.5 } }] }] }",
        lambda t: 0.25 * t**2 * np.sin(3.0 * np.pi * t) + 0.1 * t,
        lambda t: (0.5 - 0.25 * (3.0 * np.pi * t) ** 2) * np.sin(3.0 * np.pi * t)
        + 3.0 * np.pi * t * np.cos(3.0 * np.pi * t),
    ),
    # From rest, at 2 m/s² up to t = 0.6 s, then at the velocity reached there: the acceleration jumps twice.
    "ramp": (
        "{ pieces = [{ until = 0.3, function = 0.1 }, { until = 0.6, function = { polynomial = [0.19, -0.6, 1.0] } },"
        " { function = { polynomial = [-0.17, 0.6] } }] }",
        lambda t: 0.1 + np.clip(t - 0.3, 0.0, 0.3) ** 2 + 0.6 * np.clip(t - 0.6, 0.0, None),
        lambda t: np.where((t > 0.3 - 1e-9) & (t < 0.6 - 1e-9), 2.0, 0.0),
    ),
}


def smooth(u):
    return u**3 * (10.0 - 15.0 * u + 6.0 * u**2)


def smooth_second(u):
    return u * (60.0 - 180.0 * u + 120.0 * u**2)


class Sled(VerificationCase):
    def test_follows_each_function_and_reports_its_force(self):
        for name, (function, position, acceleration) in FUNCTIONS.items():
            with self.subTest(name):
                results = self.run_text(SLED.format(f'joint = "rail"\nfunction = {function}'),
                                        "duration = 1.5\n[integrator]\nrelative_tolerance = 1e-8\n")
                self.assert_close(results["bodies/sled/position"][:, 0], position(results.time), absolute=1e-11)
                self.assert_close(results["joints/drive/coordinate"], position(results.time), absolute=1e-11)
                # All that moves: the sled as driven and the load as it swings.
                sled, load = results["bodies/sled/acceleration"][:, 0], results["bodies/load/acceleration"][:, 0]
                self.assert_close(sled, acceleration(results.time), absolute=1e-9)
                self.assert_close(results["joints/drive/drive"], 3.0 * sled + 2.0 * load, absolute=1e-8)
                self.assertLess(results.summary["energy_closure"], 1e-7)
                self.assertGreater(np.ptp(results["energy/input"]), 0.05)

    def test_a_table_is_a_smooth_curve_through_its_points(self):
        table = "{ table = [[0.2, 0.0], [0.5, 0.3], [0.9, -0.1], [1.2, 0.2]] }"
        results = self.run_text(SLED.format(f'joint = "rail"\nfunction = {table}'), "duration = 1.5\n")
        position = results["bodies/sled/position"][:, 0]
        for time, value in ((0.0, 0.0), (0.2, 0.0), (0.5, 0.3), (0.9, -0.1), (1.2, 0.2), (1.5, 0.2)):
            self.assert_close(position[results.row(time)], value, absolute=1e-10)
        self.assertLess(results.summary["energy_closure"], 1e-6)

    def test_of_a_point_against_the_world(self):
        # The load's own angle driven: its torque is about the point.
        results = self.run_text(
            SLED.format('point = "load.origin"\ncoordinate = "angle"\n'
                        "function = { harmonic = { amplitude = 0.5, frequency = 0.8 } }"),
            "duration = 1.5\n[integrator]\nrelative_tolerance = 1e-8\n")
        angle = 0.5 * np.sin(1.6 * np.pi * results.time)
        self.assert_close(results["bodies/load/position"][:, 2], angle, absolute=1e-11)
        # J α = drive + lever × hook's force; the hook's reaction is on the sled, 0.6 m along the load's y.
        force = -results["joints/hook/reaction"][:, :2]
        lever = 0.6 * np.column_stack([-np.sin(angle), np.cos(angle)])
        torque = lever[:, 0] * force[:, 1] - lever[:, 1] * force[:, 0]
        self.assert_close(0.1 * results["bodies/load/acceleration"][:, 2], results["joints/drive/drive"] + torque,
                          absolute=1e-8)
        # The motor's stator is fixed to the world, and the rail is free along x, so momentum along x is conserved.
        momentum = 3.0 * results["bodies/sled/velocity"][:, 0] + 2.0 * results["bodies/load/velocity"][:, 0]
        self.assert_close(momentum, momentum[0], absolute=1e-6)
        self.assertLess(results.summary["energy_closure"], 1e-7)

    def test_of_a_joint_whose_second_point_is_on_the_ground(self):
        # The coordinate of b relative to a is then minus that of a relative to b.
        function = 'joint = "rail"\nfunction = { harmonic = { amplitude = 0.4, frequency = 1.2 } }'
        vehicle = SLED.format(function)
        turned = vehicle.replace('a = "ground.origin"\nb = "sled.origin"', 'a = "sled.origin"\nb = "ground.origin"')
        self.assertNotEqual(turned, vehicle)
        run = 'duration = 0.5\n[integrator]\nrelative_tolerance = 1e-9\n'
        found = [self.run_text(text, run)["bodies/sled/position"][:, 0] for text in (vehicle, turned)]
        self.assert_close(found[1], -found[0], absolute=1e-7)

    def test_balance_before_the_start_holds_still(self):
        # At t = 0 the rail moves at 0.3 m/s. The equilibrium is that at rest, and the run begins with the motion.
        results = self.run_text(
            SLED.format(f'joint = "rail"\nfunction = {FUNCTIONS["polynomial"][0]}'), "duration = 0.1\n"
        )
        self.assert_close(results["bodies/load/position"][0], [0.0, -0.6, 0.0], absolute=1e-9)
        self.assert_close(results["bodies/sled/velocity"][0], [0.3, 0.0, 0.0], absolute=1e-12)


class Shaft(VerificationCase):
    def test_steady_motion_of_bodies_that_are_carried_round_is_refused(self):
        # The load's frame does not move like one rigid body with the rest, so there is no steady motion.
        vehicle = SLED.format('point = "load.origin"\ncoordinate = "angle"\nfunction = { polynomial = [0.0, 5.0] }')
        message = self.refuse_text(vehicle, 'duration = 1.0\nstart = "steady"\n', "modes")
        self.assertIn("run.toml:3:9: error: 'start' can be \"steady\" only where", message)


if __name__ == "__main__":
    unittest.main()
