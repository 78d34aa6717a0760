#!/usr/bin/python3
"""Force elements of suspensions, against closed forms and by two methods of integration."""

import math
import unittest

import numpy as np

from verification_case import VerificationCase

DISC = """
name = "disc"
gravity = {gravity}
[bodies.disc]
mass = 2.0
inertia = 0.5
position = {position}
"""
TIGHT = "[integrator]\nrelative_tolerance = 1e-8\n"


def of_method(method, tolerance):
    return f'[integrator]\nmethod = "{method}"\nrelative_tolerance = {tolerance:g}\n'


# Each method with its tolerance, and the error that counts as agreement: of second order the error of
# generalized-alpha falls with the tolerance to the power 2/3.
METHODS = (("exponential", 1e-8, 1e-7), ("bdf", 1e-8, 1e-5), ("generalized-alpha", 1e-8, 1e-5))

STOP = """
[[forces]]
name = "stop"
type = "hydraulic-stop"
a = "ground.origin"
b = "disc.origin"
contact_length = 0.5
{laws}
"""


class HydraulicStop(VerificationCase):
    def test_impact_on_a_constant_orifice(self):
        # m δ'' = −c δ'² has δ' = v/(1 + c v t/m), δ = m/c ln(1 + c v t/m) after the touch, here at 0.1/3 s.
        m, c, v = 2.0, 50.0, 3.0
        for method, tolerance, error in METHODS:
            with self.subTest(method=method):
                results = self.run_text(
                    DISC.format(gravity="[0.0, 0.0]", position="[0.6, 0.0]")
                    + STOP.format(laws="metering = { coefficient = 50.0 }"),
                    'start = "as-given"\nduration = 0.2\n[initial.disc]\nvelocity = [-3.0, 0.0]\n'
                    + of_method(method, tolerance),
                )
                t = np.maximum(results.time - 0.1 / v, 0.0)
                rate = v / (1.0 + c * v * t / m)
                overlap = np.where(t > 0.0, m / c * np.log1p(c * v * t / m), 0.1 - v * results.time)
                overlap = np.where(t > 0.0, overlap, -overlap)
                self.assert_close(results["forces/stop/rate"], rate, absolute=10.0 * error)
                self.assert_close(results["forces/stop/overlap"], overlap, absolute=error)
                self.assert_close(results["forces/stop/force"], np.where(t > 0.0, c * rate**2, 0.0), absolute=0.05)
                self.assertLess(results.summary["energy_closure"], 10.0 * error)

    def test_oil_flows_back_without_resistance(self):
        # Into a metered stop with a spring and out again: what is lost on the way in is lost once, and on the way
        # out the motion is that of the spring alone.
        results = self.run_text(
            DISC.format(gravity="[0.0, 0.0]", position="[0.5, 0.0]")
            + STOP.format(
                laws="spring = { polynomial = [0.0, 800.0] }\n"
                "metering = { table = [[0.0, 0.0], [0.04, 30.0], [0.08, 90.0]] }"
            ),
            'start = "as-given"\nduration = 0.5\noutput_step = 1e-4\n[initial.disc]\nvelocity = [-3.0, 0.0]\n' + TIGHT,
        )
        overlap, rate = results["forces/stop/overlap"], results["forces/stop/rate"]
        metering = np.interp(overlap, [0.0, 0.04, 0.08, 1.08], [0.0, 30.0, 90.0, 1590.0])
        law = 800.0 * overlap + np.where(rate > 0.0, metering * rate**2, 0.0)
        inside = overlap > 1e-8
        self.assert_close(results["forces/stop/force"], np.where(inside, law, 0.0), absolute=1e-5)
        deepest = overlap.max()
        self.assert_close(-rate[-1], deepest * math.sqrt(800.0 / 2.0), relative=1e-6)
        back = (rate < 0.0) & inside
        lost = results["energy/dissipated"]
        self.assert_close(lost[back], lost[-1], relative=1e-7)
        self.assertLess(results.summary["energy_closure"], 1e-7)


BUSHING = """
[[forces]]
name = "mount"
type = "bushing"
a = "ground.origin"
b = "disc.origin"
{laws}
"""


class Bushing(VerificationCase):
    LAWS = """
x = { spring = { polynomial = [0.0, 800.0] }, damper = { coefficient = 4.0 } }
y = { spring = { polynomial = [0.0, 1800.0] } }
rotation = { spring = { polynomial = [0.0, 60.0] }, damper = { coefficient = 0.5 } }
"""

    def test_free_vibration_in_its_three_directions(self):
        # Damped oscillators: x'' + c/m x' + k/m x = 0. Its axes are those of the ground.
        for method, tolerance, error in METHODS:
            with self.subTest(method=method):
                results = self.run_text(
                    DISC.format(gravity="[0.0, 0.0]", position="[0.1, 0.05]") + BUSHING.format(laws=self.LAWS),
                    'start = "as-given"\nduration = 1.0\n[initial.disc]\nangular_velocity = 2.0\n'
                    + of_method(method, tolerance),
                )
                t = results.time
                d, w = 4.0 / 4.0, math.sqrt(400.0 - 1.0)
                x = 0.1 * np.exp(-d * t) * (np.cos(w * t) + d / w * np.sin(w * t))
                e, u = 0.5, math.sqrt(120.0 - 0.25)
                angle = 2.0 / u * np.exp(-e * t) * np.sin(u * t)
                expected = np.column_stack([x, 0.05 * np.cos(30.0 * t), angle])
                self.assert_close(results["bodies/disc/position"], expected, absolute=10.0 * error)
                self.assert_close(results["forces/mount/force_y"], -1800.0 * 0.05 * np.cos(30.0 * t), absolute=0.02)
                self.assertLess(results.summary["energy_closure"], 10.0 * error)

    def test_axes_turn_with_its_first_point(self):
        # The same bushing seen the other way round: a on the disc. Turned by half a right angle, the disc's x axis
        # meets ground at equal distances along both axes. Together they exert no torque on the pair.
        results = self.run_text(
            DISC.format(gravity="[0.0, 0.0]", position="[0.1, 0.0]")
            + BUSHING.format(laws=self.LAWS).replace("ground.origin", "DISC").replace("disc.origin", "ground.origin")
            .replace("DISC", "disc.origin"),
            'start = "as-given"\nduration = 0.5\n[initial.disc]\nangular_velocity = 1.0\n' + TIGHT,
        )
        position = results["bodies/disc/position"]
        cosine, sine = np.cos(position[:, 2]), np.sin(position[:, 2])
        deflection = np.column_stack(
            [-cosine * position[:, 0] - sine * position[:, 1], sine * position[:, 0] - cosine * position[:, 1]]
        )
        self.assert_close(results["forces/mount/deflection_x"], deflection[:, 0], absolute=1e-11)
        self.assert_close(results["forces/mount/deflection_y"], deflection[:, 1], absolute=1e-11)
        on_disc, on_ground = results["forces/mount/on_a"], results["forces/mount/on_b"]
        self.assert_close(on_disc[:, :2], -on_ground[:, :2], absolute=1e-10)
        about_ground = on_disc[:, 2] + on_ground[:, 2] + position[:, 0] * on_disc[:, 1] - position[:, 1] * on_disc[:, 0]
        self.assert_close(about_ground, 0.0, absolute=1e-10)
        self.assertLess(results.summary["energy_closure"], 1e-7)

    def test_equilibrium_and_modes(self):
        run = self.write_model(
            DISC.format(gravity="[0.0, -10.0]", position="[0.0, 0.0]") + BUSHING.format(laws=self.LAWS),
            "duration = 0.1\n",
        )
        balance = self.program("equilibrium", run)
        self.assert_close(balance["bodies"]["disc"]["y"], -20.0 / 1800.0, absolute=1e-9)
        self.assert_close(self.modes(run)[0], [math.sqrt(120.0), 20.0, 30.0], relative=1e-7)


if __name__ == "__main__":
    unittest.main()
