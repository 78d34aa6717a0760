#!/usr/bin/python3
"""Random loops of links with springs at some of their hinges: as many motions are free as the springs leave over."""

import math
import random
import unittest

from verification_case import VerificationCase

LOOPS = 300


def make_loop(rng):
    """Links from one pin on the ground to another, without weight, and rotational springs at their free angles. Returns
    the vehicle file and the number of free motions: of n links with n + 1 pins n − 2, less the springs."""
    count = rng.randint(3, 8)
    springs = rng.sample(range(count - 1), rng.randint(1, count - 2))
    corners = [(0.0, 0.0)]
    heading = rng.uniform(-math.pi, math.pi)
    for _ in range(count):
        heading += rng.choice((-1.0, 1.0)) * rng.uniform(0.4, 1.8)
        length = 10.0 ** rng.uniform(-0.5, 0.5)
        x, y = corners[-1]
        corners.append((x + length * math.cos(heading), y + length * math.sin(heading)))
    text = f'name = "loop"\ngravity = [0.0, 0.0]\n[ground.points]\nlast = [{corners[-1][0]!r}, {corners[-1][1]!r}]\n'
    joints, angles = [("ground.origin", "b0.start")], []
    for k, ((x, y), (x_end, y_end)) in enumerate(zip(corners, corners[1:])):
        length, angle = math.hypot(x_end - x, y_end - y), math.atan2(y_end - y, x_end - x)
        mass = 10.0 ** rng.uniform(-1.0, 2.0)
        text += (
            f"[bodies.b{k}]\nmass = {mass}\ninertia = {mass * length**2 / 12.0}\n"
            f"position = [{0.5 * (x + x_end)!r}, {0.5 * (y + y_end)!r}]\nangle = {angle!r}\n"
            f"points = {{ start = [{-0.5 * length!r}, 0.0], end = [{0.5 * length!r}, 0.0] }}\n"
        )
        joints.append((f"b{k}.end", f"b{k + 1}.start" if k + 1 < count else "ground.last"))
        angles.append(angle)
    for number, (a, b) in enumerate(joints):
        text += f'[[joints]]\nname = "pin{number}"\ntype = "revolute"\na = "{a}"\nb = "{b}"\n'
    for k in springs:
        stiffness = 10.0 ** rng.uniform(1.0, 5.0)  # N m/rad
        text += (
            f'[[forces]]\nname = "spring{k}"\ntype = "rotational-spring-damper"\n'
            f'a = "b{k}.end"\nb = "b{k + 1}.start"\n'
            f"free_angle = {angles[k + 1] - angles[k]!r}\nspring = {{ polynomial = [0.0, {stiffness}] }}\n"
        )
    return text, count - 2 - len(springs)


class Loops(VerificationCase):
    def test_what_springs_leave_over_is_free_and_stable(self):
        for seed in range(LOOPS):
            vehicle, num_free = make_loop(random.Random(seed))
            with self.subTest(seed=seed):
                balance = self.program("equilibrium", self.write_model(vehicle, "duration = 1.0\n"))
                self.assertEqual((len(balance["neutral"]), balance["stable"]), (num_free, True))


def make_pair(coupling):
    """Two sliders of 1 kg, the first on 1000 N/m to the ground, with a spring between them."""
    text = 'name = "pair"\ngravity = [0.0, 0.0]\n'
    for k in range(2):
        text += f"[bodies.b{k}]\nmass = 1.0\ninertia = 0.1\nposition = [{k + 1.0}, 0.0]\n"
    for k, (last, stiffness) in enumerate((("ground", 1000.0), ("b0", coupling))):
        text += (
            f'[[joints]]\nname = "guide{k}"\ntype = "translational"\na = "ground.origin"\nb = "b{k}.origin"\n'
            f'axis = [1.0, 0.0]\n[[forces]]\nname = "spring{k}"\ntype = "spring-damper"\na = "{last}.origin"\n'
            f'b = "b{k}.origin"\nfree_length = 1.0\nspring = {{ polynomial = [0.0, {stiffness}] }}\n'
        )
    return text


class HiddenByRounding(VerificationCase):
    def test_a_held_motion_that_a_stiff_spring_hides_is_doubted(self):
        right = math.sqrt(1000.0 / 2.0) / (2.0 * math.pi)  # both move together
        for coupling in (1e8, 1e12, 1e14):
            with self.subTest(coupling=coupling):
                found = self.program("modes", self.write_model(make_pair(coupling), "duration = 1.0\n"))
                told = found["modes"][0]["undamped_frequency"]
                is_doubted = any("rounding beside the largest stiffness" in one["text"] for one in found["warnings"])
                self.assertTrue(is_doubted or abs(told - right) < 1e-4 * right, told)
                self.assertEqual(is_doubted, coupling > 1e9)


if __name__ == "__main__":
    unittest.main()
