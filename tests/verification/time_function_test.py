#!/usr/bin/python3
"""Functions of time as forces: the undamped disc on its wire, against sums of its responses to steps, ramps and
oscillations."""

import math
import unittest

import numpy as np

from verification_case import VerificationCase

METHODS = ("exponential", "adams", "bdf", "generalized-alpha")
VEHICLE = """
name = "disc on a wire"
gravity = [0.0, 0.0]
[bodies.disc]
mass = 2.0
inertia = 0.5
position = [0.0, 0.0]
[[joints]]
name = "axle"
type = "revolute"
a = "ground.origin"
b = "disc.origin"
[[forces]]
name = "wire"
type = "rotational-spring-damper"
a = "ground.origin"
b = "disc.origin"
spring = {{ polynomial = [0.0, 80.0] }}
[[forces]]
name = "hand"
type = "applied"
point = "disc.origin"
torque = {0}
"""
OMEGA = math.sqrt(80.0 / 0.5)  # of the disc on its wire


class FunctionsOfTime(VerificationCase):
    """The undamped disc on its wire, J φ″ + k φ = T(t) from rest: a sum of responses to steps, ramps, harmonics."""

    def turn(self, torque, run, method="exponential", fixed_step=None):
        tolerance = 1e-6 if method == "generalized-alpha" else 1e-8
        accuracy = f"fixed_step = {fixed_step}" if fixed_step else f"relative_tolerance = {tolerance}"
        return self.run_text(
            VEHICLE.format(torque),
            f'start = "as-given"\n{run}[integrator]\nmethod = "{method}"\n{accuracy}\n',
        )

    @staticmethod
    def respond_to_step(t):
        """To a torque of 1 N·m from t = 0 on."""
        return np.where(t > 0.0, (1.0 - np.cos(OMEGA * t)) / 80.0, 0.0)

    @staticmethod
    def respond_to_ramp(t):
        """To a torque of t N·m from t = 0 on."""
        return np.where(t > 0.0, (t - np.sin(OMEGA * t) / OMEGA) / 80.0, 0.0)

    @staticmethod
    def respond_to_cosine(t, omega):
        """To a torque of cos ωt from t = 0 on, ω not the disc's."""
        return (np.cos(omega * t) - np.cos(OMEGA * t)) / (0.5 * (OMEGA**2 - omega**2))

    def test_a_rectangular_pulse_by_all_methods(self):
        # 30 N·m from 0.1037 s to 0.4011 s, of a table and of pieces. The torque before and after the jump is that of
        # the last and of the next piece; work is 30 N·m times the angle turned meanwhile.
        functions = (
            "{ table = [[0.1037, 0.0], [0.1037, 30.0], [0.4011, 30.0], [0.4011, 0.0]] }",
            "{ pieces = [{ until = 0.1037, function = 0 }, { until = 0.4011, function = 30 }, { function = 0 }] }",
        )
        for method in METHODS:
            for function in functions if method == "exponential" else functions[:1]:
                with self.subTest(method=method, function=function):
                    results = self.turn(function, "duration = 1.0\noutput_step = 1e-3\n", method)
                    t = results.time
                    angle = 30.0 * (self.respond_to_step(t - 0.1037) - self.respond_to_step(t - 0.4011))
                    error = 2e-5 if method == "generalized-alpha" else 1e-7
                    self.assert_close(results["bodies/disc/position"][:, 2], angle, absolute=error)
                    at_end = 30.0 * self.respond_to_step(np.array(0.4011 - 0.1037))
                    self.assert_close(results["energy/input"][-1], 30.0 * at_end, relative=20.0 * error)
                    inside = (t > 0.1037) & (t < 0.4011)
                    self.assert_close(results["forces/hand/torque"], np.where(inside, 30.0, 0.0))

    def test_an_output_at_a_jump_has_the_value_behind_it(self):
        torque = "{ table = [[0.1, 0.0], [0.1, 30.0], [0.3, 30.0], [0.3, 0.0]] }"
        for method in METHODS:
            with self.subTest(method=method):
                results = self.turn(torque, "duration = 0.5\noutput_step = 0.05\n", method)
                self.assertEqual(len(results.time), 11)
                self.assert_close(results["forces/hand/torque"], [0, 0, 30, 30, 30, 30, 0, 0, 0, 0, 0])
                spring = 80.0 * results["bodies/disc/position"][:, 2]
                acceleration = (results["forces/hand/torque"] - spring) / 0.5
                self.assert_close(results["bodies/disc/acceleration"][:, 2], acceleration, absolute=1e-9)

    def test_a_run_that_ends_at_a_jump_is_the_beginning_of_a_longer_one(self):
        # The last output has the value behind the jump: with it the disc accelerates.
        torque = "{ table = [[0.1, 0.0], [0.1, 30.0]] }"
        for method in METHODS:
            with self.subTest(method=method):
                results = self.turn(torque, "duration = 0.1\noutput_step = 0.05\n", method)
                self.assert_close(results["forces/hand/torque"], [0, 0, 30])
                self.assert_close(results["bodies/disc/acceleration"][:, 2], [0, 0, 60], absolute=1e-9)

    def test_order_of_convergence_is_kept_across_jumps(self):
        # Generalized-α is of second order, with a part of a step before each jump: four times smaller errors with
        # half the step. A step across a jump would be of first order.
        torque = "{ table = [[0.1037, 0.0], [0.1037, 30.0], [0.4011, 50.0], [0.4011, -10.0]] }"
        errors = []
        for step in (4e-3, 2e-3, 1e-3):
            results = self.turn(torque, "duration = 1.0\noutput_step = 1e-2\n", "generalized-alpha", step)
            t = results.time
            slope = 20.0 / (0.4011 - 0.1037)
            angle = (
                30.0 * self.respond_to_step(t - 0.1037) + slope * self.respond_to_ramp(t - 0.1037)
                - 60.0 * self.respond_to_step(t - 0.4011) - slope * self.respond_to_ramp(t - 0.4011)
            )  # fmt: skip
            errors.append(np.max(np.abs(results["bodies/disc/position"][:, 2] - angle)))
        for coarse, fine in zip(errors, errors[1:]):
            self.assertGreater(coarse / fine, 3.6)
            self.assertLess(coarse / fine, 4.4)

    def test_a_beat_is_the_product_of_two_oscillations(self):
        # 40 sin 2π3t sin 2π4t = 20 cos 2πt − 20 cos 14πt
        torque = (
            "{ product = [{ harmonic = { amplitude = 40.0, frequency = 3.0 } },"
            " { harmonic = { amplitude = 1.0, frequency = 4.0 } }] }"
        )
        for method in METHODS:
            with self.subTest(method):
                results = self.turn(torque, "duration = 2.0\n", method)
                t = results.time
                angle = 20.0 * (
                    self.respond_to_cosine(t, 2.0 * math.pi) - self.respond_to_cosine(t, 14.0 * math.pi)
                )
                error = 2e-4 if method == "generalized-alpha" else 1e-6
                self.assert_close(results["bodies/disc/position"][:, 2], angle, absolute=error)
                applied = 40.0 * np.sin(6.0 * math.pi * t) * np.sin(8.0 * math.pi * t)
                self.assert_close(results["forces/hand/torque"], applied, absolute=1e-11)

    def test_ramps_that_begin_with_a_jump(self):
        # A sum: 10 t from the start, and from 0.35 s on 20 N·m falling by 40 N·m/s for half a second.
        torque = (
            "{ sum = [{ polynomial = [0.0, 10.0] }, { table = [[0.35, 0.0], [0.35, 20.0], [0.85, 0.0]] }] }"
        )
        for method in METHODS:
            with self.subTest(method):
                results = self.turn(torque, "duration = 1.5\n", method)
                t = results.time
                angle = (
                    10.0 * self.respond_to_ramp(t) + 20.0 * self.respond_to_step(t - 0.35)
                    - 40.0 * self.respond_to_ramp(t - 0.35) + 40.0 * self.respond_to_ramp(t - 0.85)
                )  # fmt: skip
                error = 1e-4 if method == "generalized-alpha" else 1e-6
                self.assert_close(results["bodies/disc/position"][:, 2], angle, absolute=error)

    def test_jumps_that_differ_by_rounding_are_one(self):
        # 0.1 + 0.2 is not 0.3: between both, the torque would be 30 N·m for 5e-17 s.
        jumps = (("0.3", 30), ("0.30000000000000004", -30), ("0.3000000002", 8))
        tables = ", ".join(f"{{ table = [[{time}, 0], [{time}, {value}]] }}" for time, value in jumps)
        torque = f"{{ sum = [{tables}] }}"
        for method in METHODS:
            with self.subTest(method):
                results = self.turn(torque, "duration = 0.6\n", method)
                angle = 8.0 * self.respond_to_step(results.time - 0.3)
                error = 2e-5 if method == "generalized-alpha" else 1e-7
                self.assert_close(results["bodies/disc/position"][:, 2], angle, absolute=error)
                self.assertLess(results.summary["steps"], 2000)

    def test_the_balance_is_with_the_torque_at_the_start(self):
        # At t = 0 the torque jumps from 0 to 8 N·m: the run begins in balance with the later value.
        results = self.run_text(VEHICLE.format("{ table = [[0.0, 0.0], [0.0, 8.0]] }"), "duration = 0.2\n")
        self.assert_close(results["bodies/disc/position"][:, 2], 0.1, absolute=1e-10)


if __name__ == "__main__":
    unittest.main()
