#!/usr/bin/python3
"""A slider-crank whose mass is almost all in its slider: links far lighter than usual must not decide anything."""

import math
import os
import re
import unittest

from scipy.integrate import quad
from scipy.optimize import brentq

from verification_case import VerificationCase, run_program

METHODS = ("exponential", "adams", "bdf", "generalized-alpha")
ROD = 2.0  # m; the crank has 1 m
START = 1.0  # rad, of the crank, which begins to turn at 1 rad/s


def slider_place(angle):
    return math.cos(angle) + math.sqrt(ROD**2 - math.sin(angle) ** 2)


def slider_rate(angle):
    """dx/dψ of the slider."""
    return -math.sin(angle) * (1.0 + math.cos(angle) / math.sqrt(ROD**2 - math.sin(angle) ** 2))


SPEED = slider_rate(START)  # m/s, of the slider at the start
DEAD_CENTRE = (ROD - 1.0 - slider_place(START)) / SPEED  # s, if the slider keeps it
ANGLE = -math.asin(math.sin(START) / ROD)  # of the rod


def slider_crank(mass, inertia):
    """A vehicle file. @param mass, inertia  of the crank and of the rod"""
    return f"""
name = "slider-crank"
gravity = [0.0, 0.0]
[bodies.crank]
mass = {mass}
inertia = {inertia}
position = [0.0, 0.0]
angle = {START}
points = {{ end = [1.0, 0.0] }}
[bodies.rod]
mass = {mass}
inertia = {inertia if mass else 0}
position = [{0.5 * (math.cos(START) + slider_place(START))!r}, {0.5 * math.sin(START)!r}]
angle = {ANGLE!r}
points = {{ start = [{-0.5 * ROD}, 0.0], end = [{0.5 * ROD}, 0.0] }}
[bodies.slider]
mass = 1.0
inertia = 0.1
position = [{slider_place(START)!r}, 0.0]
[[joints]]
name = "axle"
type = "revolute"
a = "ground.origin"
b = "crank.origin"
[[joints]]
name = "crank_pin"
type = "revolute"
a = "crank.end"
b = "rod.start"
[[joints]]
name = "slider_pin"
type = "revolute"
a = "rod.end"
b = "slider.origin"
[[joints]]
name = "guide"
type = "translational"
a = "ground.origin"
b = "slider.origin"
axis = [1.0, 0.0]
"""


def run_file(method, duration):
    return (
        f'start = "as-given"\nduration = {duration}\noutput_step = 0.01\n[joint_rates]\naxle = 1.0\n'
        f'[output]\nprecision = "double"\n[integrator]\nmethod = "{method}"\n'
    )


# A wheel pinned by its centre to an arm.
WHEEL_ON_ARM = """
name = "wheel on an arm"
gravity = [0.0, 0.0]
[bodies.arm]
mass = {mass}
inertia = {inertia}
position = [0.0, 0.0]
points = {{ end = [{length}, 0.0] }}
[bodies.wheel]
mass = 1.0
inertia = 0.05
position = [{length}, 0.0]
[[joints]]
name = "arm"
type = "revolute"
a = "ground.origin"
b = "arm.origin"
[[joints]]
name = "axle"
type = "revolute"
a = "arm.end"
b = "wheel.origin"
"""


def shrink(vehicle, size):
    """The vehicle with all lengths multiplied."""
    def scale(match):
        numbers = [float(number) * size for number in match[2].split(",")]
        return f"{match[1]}[{', '.join(map(repr, numbers))}]"
    return re.sub(r"((?:position|end|start) = )\[([^\]]*)\]", scale, vehicle)


class Rates(VerificationCase):
    """Whether a rate is free is a matter of the positions: masses and sizes do not decide it."""

    def test_a_wheel_on_a_light_arm_turns_as_asked(self):
        for length, mass, inertia in ((0.02, 0, 0), (1e-3, 0, 0), (0.02, 1e-12, 1e-12), (1.0, 0, 0), (1.0, 1.0, 1e-9)):
            for rates in ("arm = 2.0\naxle = 10.0\n", "axle = 10.0\narm = 2.0\n"):
                with self.subTest(length=length, mass=mass, inertia=inertia, rates=rates):
                    results = self.run_text(
                        WHEEL_ON_ARM.format(length=length, mass=mass, inertia=inertia),
                        'start = "as-given"\nduration = 0.1\n[output]\nprecision = "double"\n[joint_rates]\n' + rates,
                    )  # fmt: skip
                    self.assert_close(results["joints/arm/rate"], 2.0, relative=1e-6)
                    self.assert_close(results["joints/axle/rate"], 10.0, relative=1e-6)

    def test_mechanisms_of_any_size(self):
        for size in (1e-6, 1e-3, 1e3):
            for mass, inertia in ((1.0, 0.1 * size**2), (1e-8, 1e-8 * size**2)):
                with self.subTest(size=size, mass=mass):
                    vehicle = shrink(slider_crank(mass, inertia), size)
                    vehicle = vehicle.replace("inertia = 0.1", f"inertia = {0.1 * size**2}")
                    results = self.run_text(vehicle, run_file("adams", 0.01))
                    self.assert_close(results["bodies/slider/velocity"][0, 0], size * SPEED, relative=1e-9)


class HeavyRod(VerificationCase):
    """A rod with almost all of the mass between a light crank and a light slider."""

    ROD = 0.1  # kg m², of 1 kg

    def accelerate(self, angle, rate):
        """From T = ½ J(ψ) ψ̇² of the rod and its weight: ψ̈ = −(½ J′ ψ̇² + V′)/J, by differences in ψ."""

        def inertia_and_height(at):
            tilt = math.asin(math.sin(at) / ROD)
            d_tilt = math.cos(at) / (ROD * math.cos(tilt))
            dx = -math.sin(at) - 0.5 * ROD * math.sin(tilt) * d_tilt
            dy = 0.5 * math.cos(at)
            return dx**2 + dy**2 + self.ROD * d_tilt**2, 0.5 * math.sin(at)

        h = 1e-5
        (j_low, y_low), (j, _), (j_high, y_high) = (inertia_and_height(angle + k * h) for k in (-1, 0, 1))
        return -(0.5 * (j_high - j_low) / (2 * h) * rate**2 + 9.81 * (y_high - y_low) / (2 * h)) / j

    def vehicle(self, light, slider):
        text = slider_crank(light, light).replace("gravity = [0.0, 0.0]", "gravity = [0.0, -9.81]")
        rod = text.index("[bodies.rod]")
        text = text[:rod] + re.sub(r"mass = .*\ninertia = .*", f"mass = 1.0\ninertia = {self.ROD}", text[rod:], count=1)
        slider_at = text.index("[bodies.slider]")
        return text[:slider_at] + text[slider_at:].replace(
            "mass = 1.0\ninertia = 0.1", f"mass = {slider}\ninertia = {light}", 1
        )

    def test_light_ends_accelerate_with_it(self):
        for light in (1e-6, 1e-9, 1e-12):
            for method in METHODS:
                with self.subTest(light=light, method=method):
                    results = self.run_text(self.vehicle(light, light), run_file(method, 0.5))
                    for row in (0, -1):
                        angle, rate, found = (
                            results[f"bodies/crank/{name}"][row, 2] for name in ("position", "velocity", "acceleration")
                        )
                        expected = self.accelerate(angle, rate)
                        self.assertAlmostEqual(found, expected, delta=(2e-6 + 10.0 * light) * abs(expected))

    def test_masses_too_far_apart_are_refused(self):
        message = self.refuse_text(self.vehicle(1e-12, 1e-15), run_file("adams", 1.0))
        self.assertIn("'bodies.slider.mass' is 1e-15 kg beside a body of 1 kg: more than a factor of 1e+12 apart they "
                      "cannot be calculated together; give it more, or none", message)


# A flap is hinged with a soft spring at the end of a heavy body, which slides on a spring of 100 N/m for each kg.
FLAP = """
name = "flap on a truck"
gravity = [0.0, -9.81]
[bodies.truck]
mass = 1000.0
inertia = 1333.0
position = [1.0, 0.0]
points = {{ end = [2.0, 0.0] }}
[bodies.flap]
mass = {mass}
inertia = {inertia}
position = [{centre!r}, 0.0]
points = {{ pin = [{pin!r}, 0.0] }}
[[joints]]
name = "guide"
type = "translational"
a = "ground.origin"
b = "truck.origin"
axis = [1.0, 0.0]
[[joints]]
name = "hinge"
type = "revolute"
a = "truck.end"
b = "flap.pin"
[[forces]]
name = "buffer"
type = "spring-damper"
a = "ground.origin"
b = "truck.origin"
free_length = 1.0
spring = {{ polynomial = [0.0, 100000.0] }}
[[forces]]
name = "coil"
type = "rotational-spring-damper"
a = "truck.end"
b = "flap.pin"
free_angle = 0.0
spring = {{ polynomial = [0.0, {stiffness!r}] }}
"""


class SoftFlap(VerificationCase):
    """What holds a light body is not taken for rounding of the weight of a heavy one."""

    HALF = 0.005  # m, half of the flap's length

    def test_it_sags_and_swings_on_its_own_spring(self):
        for mass in (1e-3, 1e-6, 1e-8):
            with self.subTest(mass=mass):
                moment = mass * 9.81 * self.HALF  # N m
                stiffness = 2.0 * moment
                vehicle = FLAP.format(mass=mass, inertia=mass * self.HALF**2 / 3.0, centre=3.0 + self.HALF,
                                      pin=-self.HALF, stiffness=stiffness)  # fmt: skip
                run = self.write_model(vehicle, "duration = 1.0\n")
                # k α + m g c cos α = 0, and ω² = (k − m g c sin α) / J about the hinge; the truck hardly moves
                sag = brentq(lambda angle: stiffness * angle + moment * math.cos(angle), -1.5, 0.0)
                swing = math.sqrt((stiffness - moment * math.sin(sag)) / (4.0 / 3.0 * mass * self.HALF**2))
                balance = self.program("equilibrium", run)
                self.assertEqual(balance["neutral"], [])
                self.assert_close(balance["bodies"]["flap"]["angle"], sag, absolute=1e-10)
                elastic, num_rigid = self.modes(run)
                self.assertEqual(num_rigid, 0)
                self.assert_close(sorted(elastic), [10.0, swing], relative=3e-6)


class SliderCrank(VerificationCase):
    def test_the_slider_keeps_its_speed(self):
        # It has all of the kinetic energy, but for ½ J ψ̇², which changes by less than 2 J as ψ̇ stays below 2 rad/s.
        for mass, inertia in ((0, 0), (0, 1e-12), (0, 1e-9), (1e-9, 1e-9), (0, 1e-6), (1e-6, 1e-6)):
            for method in METHODS:
                with self.subTest(mass=mass, inertia=inertia, method=method):
                    results = self.run_text(slider_crank(mass, inertia), run_file(method, 1.0))
                    place = slider_place(START) + SPEED * results.time
                    self.assert_close(
                        results["bodies/slider/position"][:, 0], place, absolute=2e-8 + inertia + 2.0 * mass
                    )
                    self.assertLess(results.summary["energy_closure"], 1e-4)

    def test_a_light_crank_is_carried_over_its_dead_centre(self):
        # There the crank has all of the energy: it turns at 1100 rad/s. Time by angle: dt = dψ √((J + m x'²)/2T).
        inertia = 1e-6
        for method in ("exponential", "adams", "bdf"):
            with self.subTest(method):
                results = self.run_text(slider_crank(0, inertia), run_file(method, 3.0))
                energy = 0.5 * (inertia + SPEED**2)
                end = results["joints/axle/coordinate"][-1]
                self.assertGreater(end, math.pi + 1.0)
                time, _ = quad(
                    lambda angle: math.sqrt((inertia + slider_rate(angle) ** 2) / (2.0 * energy)),
                    START, end, points=[math.pi], limit=500,
                )  # fmt: skip
                self.assertAlmostEqual(time, 3.0, delta=2e-4)

    def test_without_any_mass_in_the_links_the_dead_centre_ends_the_run(self):
        # The slider cannot stop there, nor go on: the run stops just before it, and names that time.
        for method in METHODS:
            with self.subTest(method):
                run = self.write_model(slider_crank(0, 0), run_file(method, 3.0))
                process = run_program([os.environ["SPRUNG_DYNAMICS"], "run", str(run), "--quiet"], cwd=self.folder)
                self.assertEqual(process.returncode, 3, process.stderr)
                found = re.search(r"at t = ([0-9.]+) s", process.stderr)
                self.assertIsNotNone(found, process.stderr)
                self.assertIn("singular", process.stderr)
                self.assertLess(float(found[1]), DEAD_CENTRE)
                self.assertGreater(float(found[1]), DEAD_CENTRE - 1e-3)


if __name__ == "__main__":
    unittest.main()
