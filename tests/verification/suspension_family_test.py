#!/usr/bin/python3
"""Random small vehicles on each force element of a suspension: the default method against generalized-alpha.

The two share the elements, but neither the equations nor the steps. No run of the default method that ends well may be
off by more than ten times its tolerance. By hand with more vehicles: SPRUNG_FAMILY=300 suspension_family_test.py
"""

import math
import os
import unittest

import h5py
import numpy as np

from verification_case import VerificationCase

COUNT = int(os.environ.get("SPRUNG_FAMILY", "12"))
TOLERANCE = 1e-5
REFERENCE = 1e-8  # the error of generalized-alpha falls with its tolerance to the power 2/3

HEAD = """
name = "random"
gravity = [0.0, -9.81]
[bodies.base]
mass = 5.0
inertia = 1.0
position = [0.0, 0.0]
[bodies.load]
mass = {mass:.6g}
inertia = {inertia:.6g}
position = [0.0, {height:.6g}]
[[joints]]
name = "lift"
type = "translational"
a = "ground.origin"
b = "base.origin"
axis = [0.0, 1.0]
[[motions]]
name = "shake"
joint = "lift"
function = {{ sum = [{waves}] }}
"""
GUIDE = """
[[joints]]
name = "guide"
type = "translational"
a = "base.origin"
b = "load.origin"
axis = [0.0, 1.0]
"""
SPRING = """
[[forces]]
name = "spring"
type = "spring-damper"
a = "base.origin"
b = "load.origin"
free_length = {length:.6g}
spring = {{ polynomial = [0.0, {stiffness:.6g}] }}
damper = {{ coefficient = {damping:.6g} }}
"""


class Family(VerificationCase):
    def head(self, random, amplitude):
        """A load on a base that shakes in a sum of three waves. Returns the text and the mass of the load."""
        waves = ", ".join(
            f"{{ harmonic = {{ amplitude = {random.uniform(0.2, 1.0) * amplitude:.6g}, "
            f"frequency = {random.uniform(0.5, 6.0):.6g}, phase = {random.uniform(0.0, 6.0):.6g} }} }}"
            for _ in range(3)
        )
        mass = random.uniform(5.0, 50.0)
        text = HEAD.format(mass=mass, inertia=0.1 * mass * random.uniform(0.2, 1.0), height=0.5, waves=waves)
        return text, mass

    def spring(self, random, mass):
        """Parallel spring that bears the load at 0.5 m, at 1 Hz to 3 Hz, with little damping."""
        stiffness = mass * (2.0 * np.pi * random.uniform(1.0, 3.0)) ** 2
        damping = random.uniform(0.02, 0.3) * 2.0 * np.sqrt(mass * stiffness)
        return SPRING.format(length=0.5 + 9.81 * mass / stiffness, stiffness=stiffness, damping=damping), stiffness

    def positions(self, vehicle, name, method):
        """Positions of both bodies at all outputs; None where the program gives up."""
        path = self.folder / f"{name}.h5"
        run = self.write_model(
            vehicle, f'start = "as-given"\nduration = 1.5\noutput_step = 0.01\n[integrator]\n{method}\n'
        )
        summary = self.program("run", run, "-o", str(path))
        with h5py.File(path) as results:
            position = np.hstack([results[f"bodies/{body}/position"][:] for body in ("base", "load")])
        return position, summary

    def compare(self, make, seed):
        """Vehicle by vehicle, with one natural size for positions: no point is off its body's frame."""
        worst, restarts = 0.0, 0
        for number in range(COUNT):
            with self.subTest(number=number):
                vehicle = make(np.random.default_rng([seed, number]))
                found, summary = self.positions(vehicle, "default", f"relative_tolerance = {TOLERANCE:g}")
                reference, _ = self.positions(
                    vehicle, "reference", f'method = "generalized-alpha"\nrelative_tolerance = {REFERENCE:g}'
                )
                error = np.abs(found - reference).max()
                worst, restarts = max(worst, error), restarts + summary["switches"]
                self.assertLess(error, 10.0 * TOLERANCE, vehicle)
        if "SPRUNG_FAMILY" in os.environ:
            print(f"{self.id()}: {COUNT} vehicles, largest error {worst:.2e}, {restarts} switches")
        return restarts

    def test_hydraulic_stops(self):
        def make(random):
            text, mass = self.head(random, 0.05)
            spring, stiffness = self.spring(random, mass)
            text += GUIDE + spring
            for name, a, b in (("bump", "base.origin", "load.origin"), ("floor", "ground.origin", "load.origin")):
                c = random.uniform(0.5, 5.0) * mass
                rows = f"[[0.0, {c * random.uniform(0.0, 1.0):.6g}], [0.02, {c:.6g}], [0.05, {2.0 * c:.6g}]]"
                text += f"""
[[forces]]
name = "{name}"
type = "hydraulic-stop"
a = "{a}"
b = "{b}"
contact_length = {random.uniform(0.42, 0.5):.6g}
spring = {{ polynomial = [0.0, {stiffness * random.uniform(0.5, 10.0):.6g}] }}
metering = {{ table = {rows} }}
damping = {stiffness * random.uniform(0.0, 2.0):.6g}
"""
            return text

        self.assertGreater(self.compare(make, 1), 10 * COUNT)

    def test_bushings(self):
        def make(random):
            text, mass = self.head(random, 0.02)

            def direction(stiffness, reach, relaxes):
                force = stiffness * reach
                law = f"spring = {{ table = [[{-reach:.6g}, {-2.0 * force:.6g}], [0.0, 0.0], "
                law += f"[{reach:.6g}, {force:.6g}], [{2.0 * reach:.6g}, {6.0 * force:.6g}]] }}, "
                law += f"damper = {{ coefficient = {random.uniform(0.005, 0.03) * stiffness:.6g} }}"
                if relaxes:
                    share, time = random.uniform(0.3, 5.0), 10.0 ** random.uniform(-4.0, 0.0)
                    law += f", relaxation = {{ stiffness = {share * stiffness:.6g}, time = {time:.6g} }}"
                return "{ " + law + " }"

            stiffness = mass * (2.0 * np.pi * random.uniform(2.0, 6.0)) ** 2
            return text + f"""
[[forces]]
name = "mount"
type = "bushing"
a = "base.origin"
b = "load.origin"
angle = {random.uniform(-0.5, 0.5):.6g}
free_position = [{random.uniform(-0.02, 0.02):.6g}, {random.uniform(0.48, 0.52):.6g}]
free_angle = {random.uniform(-0.1, 0.1):.6g}
x = {direction(stiffness, 0.02, random.random() < 0.5)}
y = {direction(stiffness, 0.01, random.random() < 0.8)}
rotation = {direction(stiffness * 0.3, 0.1, random.random() < 0.5)}
"""

        self.assertGreater(self.compare(make, 2), 5 * COUNT)

    def test_leaf_springs_with_stops(self):
        # Friction and impacts together.
        def make(random):
            text, mass = self.head(random, 0.03)
            spring, stiffness = self.spring(random, mass)
            full = random.uniform(0.02, 0.4) * mass * 9.81
            beta = 10.0 ** random.uniform(-3.3, -2.0)
            slope = random.uniform(-1.0, 1.0) * full / 0.1
            return text + GUIDE + spring + f"""
[[forces]]
name = "leaf"
type = "leaf-spring"
a = "base.origin"
b = "load.origin"
free_length = 0.5
spring = {{ polynomial = [0.0, {0.3 * stiffness:.6g}] }}
friction = {{ table = [[-0.05, {full - 0.05 * slope:.6g}], [0.05, {full + 0.05 * slope:.6g}]] }}
presliding_deflection = {beta:.6g}
[[forces]]
name = "bump"
type = "hydraulic-stop"
a = "base.origin"
b = "load.origin"
contact_length = {random.uniform(0.44, 0.49):.6g}
spring = {{ polynomial = [0.0, {stiffness * random.uniform(1.0, 20.0):.6g}] }}
metering = {{ coefficient = {mass * random.uniform(0.0, 5.0):.6g} }}
"""

        self.assertGreater(self.compare(make, 3), 10 * COUNT)

    def test_air_springs_with_stops(self):
        # An auxiliary volume behind an orifice, from nearly closed to wide open, and an impact; some with a levelling
        # valve that acts from the start.
        def make(random):
            text, mass = self.head(random, 0.04)
            gauge = random.uniform(2e5, 7e5)
            area = mass * 9.81 / gauge
            volume, slope = area * random.uniform(0.15, 0.4), random.uniform(-3.0, 0.5) * area
            table = ", ".join(f"[{h}, {area + slope * (h - 0.5):.6g}]" for h in (0.45, 0.5, 0.55))
            load, valve = f"{mass * 9.81 * random.uniform(0.9, 1.1):.6g}", ""
            opening = 10.0 ** random.uniform(-2.8, -0.8) * math.sqrt(area)
            if random.random() < 0.3:
                load = '"static"'
                valve = (
                    "levelling = { dead_band = 0.004, full_opening = 0.02, "
                    f"delay = {10.0 ** random.uniform(-1.0, 1.0):.6g}, supply_gauge_pressure = 9e5, "
                    f"orifice = {{ diameter = {0.02 * math.sqrt(area):.6g} }} }}"
                )
            return text + GUIDE + f"""
[[forces]]
name = "air"
type = "air-spring"
a = "base.origin"
b = "load.origin"
design_height = 0.5
effective_area = [{table}]
volume = {volume:.6g}
load = {load}
exponent = {random.uniform(1.0, 1.4):.6g}
auxiliary = {{ volume = {volume * random.uniform(0.3, 3.0):.6g}, orifice = {{ diameter = {opening:.6g} }} }}
{valve}
[[forces]]
name = "absorber"
type = "spring-damper"
a = "base.origin"
b = "load.origin"
free_length = 0.5
damper = {{ coefficient = {mass * random.uniform(0.2, 2.0):.6g} }}
[[forces]]
name = "bump"
type = "hydraulic-stop"
a = "base.origin"
b = "load.origin"
contact_length = {random.uniform(0.44, 0.47):.6g}
spring = {{ polynomial = [0.0, {mass * 10.0 ** random.uniform(2.5, 4.0):.6g}] }}
metering = {{ coefficient = {mass * random.uniform(0.0, 5.0):.6g} }}
"""

        self.assertGreater(self.compare(make, 4), 5 * COUNT)

    def test_coupled_air_springs_with_levelling(self):
        # Two bellows side by side, between which gas flows, and one with a valve carry a load that pitches and meets
        # stops. Some have auxiliary volumes. Two springs hold the load upright, which coupled bellows do not.
        def make(random):
            text, mass = self.head(random, 0.03)
            gauge = random.uniform(2e5, 7e5)
            area = mass * 9.81 / 3.0 / gauge
            volume, side = area * random.uniform(0.15, 0.4), random.uniform(0.2, 0.5)
            line = 10.0 ** random.uniform(-2.5, -0.7) * math.sqrt(area)
            auxiliary = ""
            if random.random() < 0.5:
                opening = 10.0 ** random.uniform(-2.5, -0.8) * math.sqrt(area)
                auxiliary = f"auxiliary = {{ volume = {volume * random.uniform(0.3, 3.0):.6g}, "
                auxiliary += f"orifice = {{ diameter = {opening:.6g} }} }}"
            for body in ("base", "load"):
                text += f"[bodies.{body}.points]\nleft = [{-side:.6g}, 0.0]\nright = [{side:.6g}, 0.0]\n"
            text += GUIDE.replace("translational", "pin-in-slot") + f"""
[[forces]]
name = "air"
type = "air-spring"
a = "base.left"
b = "load.left"
design_height = 0.5
effective_area = {area:.6g}
volume = {volume:.6g}
load = {mass * 9.81 / 3.0:.6g}
exponent = {random.uniform(1.0, 1.4):.6g}
partner = {{ a = "base.right", b = "load.right", line = {{ diameter = {line:.6g} }} }}
{auxiliary}
[[forces]]
name = "level"
type = "air-spring"
a = "base.origin"
b = "load.origin"
design_height = 0.5
effective_area = {area:.6g}
volume = {volume:.6g}
load = "static"
[forces.levelling]
dead_band = {random.uniform(0.001, 0.006):.6g}
full_opening = 0.015
delay = {10.0 ** random.uniform(-1.0, 0.5):.6g}
supply_gauge_pressure = 9e5
orifice = {{ diameter = {0.03 * math.sqrt(area):.6g} }}
"""
            for name, reach in (("left", random.uniform(0.42, 0.47)), ("right", random.uniform(0.42, 0.47))):
                text += f"""
[[forces]]
name = "absorber_{name}"
type = "spring-damper"
a = "base.{name}"
b = "load.{name}"
free_length = 0.5
spring = {{ polynomial = [0.0, {mass * random.uniform(10.0, 60.0):.6g}] }}
damper = {{ coefficient = {mass * random.uniform(0.3, 1.5):.6g} }}
[[forces]]
name = "bump_{name}"
type = "hydraulic-stop"
a = "base.{name}"
b = "load.{name}"
contact_length = {reach:.6g}
spring = {{ polynomial = [0.0, {mass * 10.0 ** random.uniform(2.5, 4.0):.6g}] }}
"""
            return text

        self.assertGreater(self.compare(make, 5), COUNT)


if __name__ == "__main__":
    unittest.main()
