#!/usr/bin/python3
"""What modes about an equilibrium leave out of the forces there, which is told beside them."""

import math
import os
import unittest

import numpy as np

from verification_case import VerificationCase, run_program

MOUNTED = """
name = "mounted"
gravity = [0.0, 0.0]
[ground.points]
wall = [0.0, 0.0]
[bodies.b]
mass = 1.0
inertia = 1.0
position = [0.0, 0.0]
[[forces]]
name = "mount"
type = "bushing"
a = "ground.wall"
b = "b.origin"
x = { spring = { polynomial = [0.0, 400.0] } }
y = { spring = {y} }
rotation = { spring = { polynomial = [0.0, 110.0] } }
"""

# Resting on the spring of its stop, and damped by the square of the rate of its overlap alone: not at rest.
DISC = """
name = "disc"
gravity = [0.0, -9.81]
[bodies.disc]
mass = 400.0
inertia = 10.0
position = [0.0, 0.8]
points = {{ unused = [{unused}, 0.0] }}
[[joints]]
name = "guide"
type = "translational"
axis = [0.0, 1.0]
a = "ground.origin"
b = "disc.origin"
[[forces]]
name = "stop"
type = "hydraulic-stop"
a = "ground.origin"
b = "disc.origin"
contact_length = 1.0
spring = {{ polynomial = [0.0, 4e4] }}
metering = {{ coefficient = 9e4 }}
"""


class LinearModes(VerificationCase):
    def find_modes(self, spring, more=""):
        run = self.write_model(MOUNTED.replace("{y}", spring) + more, "duration = 1.0\n")
        return self.program("modes", run)

    def test_a_following_force_is_told_beside_the_modes(self):
        # K = [400 0 0; 0 100 100; 0 0 110 − 0], a force along the body's own x: triangular, so that ω² are the
        # entries of its diagonal. Undamped modes are those of the symmetric part.
        jet = '[[forces]]\nname = "jet"\ntype = "applied"\npoint = "b.origin"\naxes = "following"\nforce = [-100, 0]\n'
        found = self.find_modes("{ polynomial = [0.0, 100.0] }", jet)
        damped = sorted(mode["damped_frequency"] for mode in found["modes"])
        self.assert_close(damped, np.sqrt([100.0, 110.0, 400.0]) / (2.0 * math.pi), relative=1e-6)
        (text,) = (one["text"] for one in found["warnings"])
        self.assertIn("the stiffness at rest is not symmetric", text)
        self.assertEqual(self.find_modes("{ polynomial = [0.0, 100.0] }")["warnings"], [])

    def test_a_kink_at_rest_is_told_beside_the_modes(self):
        found = self.find_modes("{ table = [[-1.0, -100.0], [0.0, 0.0], [1.0, 400.0]] }")
        (text,) = (one["text"] for one in found["warnings"])
        self.assertEqual(text, "'mount' changes its law at static equilibrium: the mean of its two slopes is used")
        self.assertEqual(self.find_modes("{ table = [[-1.0, -100.0], [0.2, 20.0], [1.0, 400.0]] }")["warnings"], [])

    def test_the_slope_at_rest_counts_however_close_a_kink_is(self):
        # The natural size is 20 m. A kink at 2 to 4 mm gave 4/3 of one slope less 1/3 of the other.
        far = '[bodies.far]\nmass = 1.0\ninertia = 1.0\nposition = [0.0, 0.0]\n' \
              'points = { tip = [20.0, 0.0] }\n[[joints]]\nname = "held"\ntype = "fixed"\n' \
              'a = "ground.origin"\nb = "far.origin"\n'  # fmt: skip
        for kink in (5e-3, 3e-3, 1e-3, 1e-4, 1e-5):
            below = f"{{ table = [[-1.0, -100.0], [{kink}, {100.0 * kink}], [1.0, {400.0 - 300.0 * kink}]] }}"
            above = f"{{ table = [[-1.0, {-100.0 - 300.0 * kink}], [{-kink}, {-400.0 * kink}], [1.0, 400.0]] }}"
            for spring, stiffness in ((below, 100.0), (above, 400.0)):
                with self.subTest(kink=kink, stiffness=stiffness):
                    found = self.find_modes(spring, far)
                    omega = [2.0 * math.pi * mode["undamped_frequency"] for mode in found["modes"]]
                    expected = sorted(math.sqrt(k) for k in (stiffness, 110.0, 400.0))
                    self.assert_close(sorted(omega), expected, relative=1e-6)
                    said = ["'mount' changes its law very close to static equilibrium: its slope there is used, which "
                            "holds in small motion alone"] if kink < 4e-3 else []  # fmt: skip
                    self.assertEqual([one["text"] for one in found["warnings"]], said)

    def test_the_slope_of_a_damper_at_rest_counts_however_close_its_knees_are(self):
        # 9 N·s/m within ±knee, 1 beyond: ζ = c/2√(km).
        for knee in (5e-2, 1e-3, 1e-4):
            with self.subTest(knee=knee):
                ends = 9.0 * knee + 1.0 - knee
                table = f"[[-1.0, {-ends}], [{-knee}, {-9.0 * knee}], [{knee}, {9.0 * knee}], [1.0, {ends}]]"
                found = self.find_modes(f"{{ polynomial = [0.0, 100.0] }}, damper = {{ table = {table} }}")
                (ratio,) = (mode["damping_ratio"] for mode in found["modes"] if mode["damping_ratio"] > 0.0)
                self.assert_close(ratio, 9.0 / (2.0 * math.sqrt(100.0)), relative=1e-6)

    def test_forces_with_two_slopes_are_named_where_there_are_some(self):
        damper = "damper = { compression = 5.0, rebound = 9.0 }"
        linear = "{ polynomial = [0.0, 100.0] }"
        for spring, is_named in ((f"{linear}, {damper}", True), (linear, False)):
            run = self.write_model(MOUNTED.replace("{y}", spring), "duration = 1.0\n")
            process = run_program([os.environ["SPRUNG_DYNAMICS"], "modes", run, "--quiet"], cwd=self.folder)
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertEqual("With the mean of the two slopes at rest: mount\n" in process.stdout, is_named)
            self.assertEqual("two slopes" in process.stdout, is_named)
        # Against 7 N·s/m, the mean: ζ = c/2√(km).
        (mode,) = (one for one in self.find_modes(f"{linear}, {damper}")["modes"]
                   if one["damping_ratio"] > 0.0)
        self.assert_close(mode["damping_ratio"], 7.0 / (2.0 * math.sqrt(100.0)), relative=1e-6)

    def test_damping_by_the_square_of_a_rate_is_none_near_rest_whatever_the_size_of_the_vehicle(self):
        # Differences alone, whose steps grow with the vehicle, gave 6 % of critical with a point at 10 m.
        for unused in (0.1, 1.0, 10.0):
            run = self.write_model(DISC.format(unused=unused), "duration = 1.0\n")
            (mode,) = self.program("modes", run)["modes"]
            self.assert_close(mode["undamped_frequency"], math.sqrt(4e4 / 400.0) / (2.0 * math.pi), relative=1e-6)
            self.assertLess(abs(mode["damping_ratio"]), 1e-9)


class Chains(VerificationCase):
    """Masses on springs and dampers above each other, whose laws have kinks beside rest, at 1e-6 to 0.06 m and 1e-4 to
    0.1 m/s. Expected: the eigenvalues of the matrices that belong to the slopes at rest."""

    def write_chain(self, random, count):
        """@return masses, stiffness and damping matrix"""
        masses = 10 ** random.uniform(0.0, 1.5, count)
        stiffness, damping = np.zeros((count, count)), np.zeros((count, count))
        far = 10 ** random.uniform(-1.0, 1.5)  # for other natural sizes
        text = f'name = "chain"\ngravity = [0.0, -9.81]\n[ground.points]\nfar = [{far}, 0.0]\n'
        for i, mass in enumerate(masses):
            load = 9.81 * np.sum(masses[i:])
            slope = mass * (2.0 * math.pi * 10 ** random.uniform(-0.3, 1.0)) ** 2
            rate = 0.02 * math.sqrt(slope * mass)
            rest, below, above, knee = random.uniform(0.01, 0.2), *10 ** random.uniform([-6, -6, -4], [-1.2, -1.2, -1])
            other = 10 ** random.uniform(-1.0, 1.0, 3)  # slopes beyond the kinks, over those at rest
            places = [-below - 0.5, -below, above, above + 0.5]
            forces = [-below - 0.5 * other[0], -below, above, above + 0.5 * other[1]]
            spring = [[rest + place, load + slope * force] for place, force in zip(places, forces)]
            damper = [[sign * (knee + more), sign * rate * (knee + other[2] * more)]
                      for sign, more in ((-1.0, 1.0), (-1.0, 0.0), (1.0, 0.0), (1.0, 1.0))]  # fmt: skip
            for matrix, value in ((stiffness, slope), (damping, rate)):
                ends = np.zeros(count)
                ends[max(i - 1, 0) : i + 1] = [-1.0, 1.0][-min(i + 1, 2) :]
                matrix += value * np.outer(ends, ends)
            lower = f"b{i - 1}.origin" if i else "ground.origin"
            text += f'[bodies.b{i}]\nmass = {mass}\ninertia = 1.0\nposition = [0.0, {0.5 * (i + 1)}]\n[[joints]]\n' \
                    f'name = "guide_{i}"\ntype = "translational"\naxis = [0.0, 1.0]\na = "ground.origin"\n' \
                    f'b = "b{i}.origin"\n[[forces]]\nname = "spring_{i}"\ntype = "spring-damper"\na = "{lower}"\n' \
                    f'b = "b{i}.origin"\nfree_length = {0.5 + rest}\n' \
                    f'spring = {{ table = {[[*map(float, row)] for row in spring]} }}\n' \
                    f'damper = {{ table = {[[*map(float, row)] for row in damper]} }}\n'  # fmt: skip
        self.write_model(text, "duration = 1.0\n")
        return masses, stiffness, damping

    def test_modes_are_those_of_the_slopes_at_rest(self):
        # 283 of 300 such chains had frequencies that were wrong, by up to 170 %.
        for seed in range(40):
            with self.subTest(seed=seed):
                random = np.random.default_rng(seed)
                masses, stiffness, damping = self.write_chain(random, random.integers(1, 7))
                root = 1.0 / np.sqrt(masses)
                expected = np.sqrt(np.linalg.eigvalsh(root[:, None] * stiffness * root))
                modes = self.program("modes", self.folder / "run.toml")["modes"]
                found = sorted(2.0 * math.pi * mode["undamped_frequency"] for mode in modes)
                self.assert_close(found, expected, relative=1e-6)
                decay = [2.0 * math.pi * mode["damped_frequency"] * mode["damping_ratio"]
                         / math.sqrt(1.0 - mode["damping_ratio"] ** 2) for mode in modes]  # fmt: skip
                self.assert_close(sum(decay), 0.5 * np.sum(np.diag(damping) / masses), relative=1e-6)


class Overdamped(VerificationCase):
    def test_a_mode_that_does_not_oscillate_is_told_with_its_decay(self):
        # A disc of 2 kg on 200 N/m and 100 N·s/m along x: ω = 10 1/s, ζ = 2.5, and s² + 50 s + 100 = 0.
        vehicle = """
name = "slow disc"
gravity = [0.0, 0.0]
[bodies.disc]
mass = 2.0
inertia = 1.0
position = [0.0, 0.0]
[[joints]]
name = "rail"
type = "translational"
a = "ground.origin"
b = "disc.origin"
axis = [1.0, 0.0]
[[forces]]
name = "mount"
type = "bushing"
a = "ground.origin"
b = "disc.origin"
x = { spring = { polynomial = [0.0, 200.0] }, damper = { coefficient = 100.0 } }
"""
        run = self.write_model(vehicle, "duration = 0.1\n")
        (mode,) = self.program("modes", run)["modes"]
        self.assertEqual(mode["damped_frequency"], 0.0)
        self.assert_close(mode["damping_ratio"], 2.5, relative=1e-6)
        self.assert_close(mode["decay_rate"], 25.0 + math.sqrt(525.0), relative=1e-6)
        table = run_program([os.environ["SPRUNG_DYNAMICS"], "modes", "run.toml"], cwd=self.folder, check=True).stdout
        self.assertIn("does not oscillate, decays at 47.9 1/s: disc", table)


if __name__ == "__main__":
    unittest.main()
