#!/usr/bin/python3
"""Bodies without mass or inertia: against closed forms, and against the same link without a body."""

import math
import unittest

import numpy as np

from verification_case import VerificationCase

METHODS = ("exponential", "adams", "bdf", "generalized-alpha")

# A crank that turns, a rocker with a spring at its end, and what joins them.
FOUR_BAR = """
name = "four-bar"
gravity = [0.0, -9.81]
[ground.points]
post = [1.0, 0.0]
peg = [1.6, 0.9]
[bodies.crank]
mass = 2.0
inertia = 0.05
position = [0.0, 0.15]
angle = 1.5707963267948966
points = {{ foot = [-0.15, 0.0], end = [0.15, 0.0] }}
[bodies.rocker]
mass = 3.0
inertia = 0.2
position = [1.1, 0.35]
angle = 1.2924966677897853
points = {{ foot = [-0.3640054944640259, 0.0], end = [0.3640054944640259, 0.0] }}
{0}
[[joints]]
name = "crank_post"
type = "revolute"
a = "ground.origin"
b = "crank.foot"
[[joints]]
name = "rocker_post"
type = "revolute"
a = "ground.post"
b = "rocker.foot"
[[forces]]
name = "spring"
type = "spring-damper"
a = "rocker.end"
b = "ground.peg"
free_length = 0.5
spring = {{ polynomial = [0.0, 400.0] }}
damper = {{ coefficient = 6.0 }}
"""
LENGTH = math.sqrt(1.6)  # closes the joints as the bodies stand
LINK = f"""
[[joints]]
name = "link"
type = "distance"
a = "crank.end"
b = "rocker.end"
length = {LENGTH}
"""
BODY = f"""
[bodies.coupler]
mass = {{mass}}
inertia = {{inertia}}
position = [0.6, 0.5]
angle = 0.3217505543966422
points = {{{{ start = [{-0.5 * LENGTH}, 0.0], end = [{0.5 * LENGTH}, 0.0] }}}}
[[joints]]
name = "crank_pin"
type = "revolute"
a = "crank.end"
b = "coupler.start"
[[joints]]
name = "rocker_pin"
type = "revolute"
a = "coupler.end"
b = "rocker.end"
"""
MASSLESS = BODY.format(mass=0, inertia=0)

PENDULUM = """
name = "pendulum"
gravity = [0.0, -9.81]
[bodies.rod]
mass = 0.0
inertia = 0.0
position = [0.0, -0.4]
points = {{ top = [0.0, 0.4], end = [0.0, -0.4] }}
[bodies.weight]
mass = 3.0
inertia = 0.0
position = [0.0, -0.8]
[[joints]]
name = "pin"
type = "revolute"
a = "ground.origin"
b = "rod.top"
[[joints]]
name = "end"
type = "{0}"
a = "rod.end"
b = "weight.origin"
"""


class FourBar(VerificationCase):
    """A coupler without mass is a link between two points: joint of type distance."""

    def run_method(self, parts, method):
        tolerance = 1e-7 if method == "generalized-alpha" else 1e-9
        run = (
            f'start = "as-given"\nduration = 1.0\n[joint_rates]\ncrank_post = 5.0\n'
            f'[integrator]\nmethod = "{method}"\nrelative_tolerance = {tolerance}\n'
        )
        return self.run_text(FOUR_BAR.format(parts), run)

    def test_a_massless_coupler_is_a_link(self):
        expected = self.run_method(LINK, "adams")
        angle, rocker = expected["joints/crank_post/coordinate"], expected["bodies/rocker/acceleration"]
        # Force of the link on the rocker, along it.
        force = np.linalg.norm(expected["joints/link/reaction"][:, :2], axis=1)
        for method in METHODS:
            with self.subTest(method):
                results = self.run_method(MASSLESS, method)
                error = 2e-5 if method == "generalized-alpha" else 1e-7
                self.assert_close(results["joints/crank_post/coordinate"], angle, absolute=error)
                self.assert_close(results["bodies/rocker/acceleration"], rocker, absolute=2e3 * error)
                self.assertLess(results.summary["energy_closure"], 20.0 * error)
                start, end = (results[f"joints/{name}/reaction"] for name in ("crank_pin", "rocker_pin"))
                # Both ends feel the same force, along the coupler.
                self.assert_close(start[:, :2], end[:, :2], absolute=1e-8 * np.max(force))
                self.assert_close(np.linalg.norm(end[:, :2], axis=1), force, absolute=2e3 * error)
                along = results["bodies/coupler/position"][:, 2]
                across = -np.sin(along) * end[:, 0] + np.cos(along) * end[:, 1]
                self.assert_close(across, 0.0, absolute=1e-8 * np.max(force))

    def test_equilibrium_and_modes_are_those_of_the_link(self):
        found = {}
        for name, parts in (("link", LINK), ("coupler", MASSLESS)):
            run = self.write_model(FOUR_BAR.format(parts), "duration = 1.0\n")
            mode = self.program("modes", run)["modes"][0]
            results = self.run_to_results(run)
            found[name] = [mode["undamped_frequency"], mode["damping_ratio"], *results["bodies/rocker/position"][0]]
            rocker = results["bodies/rocker/position"]
            self.assert_close(rocker[-1], rocker[0], absolute=1e-9)
        self.assert_close(found["coupler"], found["link"], relative=1e-8)

    def test_a_light_coupler_tends_to_the_massless_one(self):
        # An error proportional to the mass: nothing of the stand-in is left in the motion.
        exact = self.run_method(MASSLESS, "exponential")["joints/crank_post/coordinate"]
        errors = []
        for mass in (1e-2, 1e-3):
            light = self.run_method(BODY.format(mass=mass, inertia=0.1 * mass), "exponential")
            errors.append(np.max(np.abs(light["joints/crank_post/coordinate"] - exact)))
        self.assertGreater(errors[0], 1e-5)
        self.assert_close(errors[0] / errors[1], 10.0, relative=0.05)


class PointMass(VerificationCase):
    def test_on_a_massless_rod_it_is_the_mathematical_pendulum(self):
        # Welded to the rod, from 5 rad/s at the bottom: energy gives the rate by the angle, and the rod's force.
        for method in METHODS:
            with self.subTest(method):
                tolerance = 1e-7 if method == "generalized-alpha" else 1e-9
                results = self.run_text(
                    PENDULUM.format("fixed"),
                    f'start = "as-given"\nduration = 1.5\n[joint_rates]\npin = 5.0\n'
                    f'[integrator]\nmethod = "{method}"\nrelative_tolerance = {tolerance}\n',
                )
                angle, rate = results["joints/pin/coordinate"], results["joints/pin/rate"]
                self.assert_close(rate**2, 25.0 - 2.0 * 9.81 / 0.8 * (1.0 - np.cos(angle)),
                                  absolute=1e-3 if method == "generalized-alpha" else 1e-6)
                tension = 3.0 * (9.81 * np.cos(angle) + 0.8 * rate**2)
                reaction = results["joints/pin/reaction"][:, :2]
                self.assert_close(np.linalg.norm(reaction, axis=1), np.abs(tension), relative=1e-6, absolute=1e-6)
        modes, _ = self.modes(self.folder / "run.toml")
        self.assert_close(modes, [math.sqrt(9.81 / 0.8)], relative=1e-7)


class Refused(VerificationCase):
    def refuse(self, vehicle, verb="run"):
        return self.refuse_text(vehicle, "duration = 0.1\n", verb)

    def test_a_freedom_without_mass_is_named(self):
        # A point mass that a pin lets spin.
        for verb in ("run", "modes", "equilibrium"):
            message = self.refuse(PENDULUM.format("revolute"), verb)
            self.assertIn("vehicle.toml:11:11: error: 'bodies.weight' can move without moving any mass "
                          "('weight.angle' is free), so that no acceleration follows from its forces; give it an "
                          "inertia, or a joint that holds it", message)

    def test_a_free_body_without_mass_is_named(self):
        message = self.refuse(PENDULUM.format("fixed") + "[bodies.ghost]\nmass = 0\ninertia = 1\nposition = [3, 0]\n")
        self.assertIn("'bodies.ghost' can move without moving any mass ('ghost.", message)

    def test_a_vehicle_without_any_mass_is_refused(self):
        message = self.refuse(PENDULUM.format("fixed").replace("mass = 3.0", "mass = 0.0"))
        self.assertIn("no body of the vehicle has a mass", message)


if __name__ == "__main__":
    unittest.main()
