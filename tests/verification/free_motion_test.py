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


if __name__ == "__main__":
    unittest.main()
