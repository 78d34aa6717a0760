#!/usr/bin/python3
"""Brackets of frequencies that rounding or kinks spoil become wider, and hold the true ones nevertheless; there are
none where forces are not conservative."""

import os
import re
import unittest

import numpy as np
import scipy.io
import scipy.linalg

from verification_case import VerificationCase, run_program

ROUNDING = 2e-7  # of differences of the forces, by which the vehicle's stiffness is found
ANTENNA = """
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.beam]
material = "steel"
shape = "rectangle"
width = 0.1
height = 0.1
[sections.rod]
material = "steel"
shape = "tube"
outer_diameter = 0.006
wall = 0.003
[points]
a = [0, 0]
m = [2, 0]
b = [4, 0]
tip = [2, 1]
[[lines]]
through = ["a", "m", "b"]
section = "beam"
elements = 6
[[lines]]
from = "m"
to = "tip"
section = "rod"
elements = 6
[reference]
point = "{reference}"
[interface]
a = "xyr"
b = "xyr"
[reduction]
basis = "free"
highest_frequency = 100
tolerance = 0.01
[modes]
damping_ratio = 0.0
"""
ON_SPRINGS = """
name = "antenna"
gravity = [0.0, 0.0]
[ground.points]
a = [0.0, 0.0]
b = [4.0, 0.0]
[bodies.frame]
superelement = "{name}"
position = [{x}, {y}]
[[forces]]
name = "a"
type = "bushing"
a = "ground.a"
b = "frame.a"
x = {{ spring = {{ polynomial = [0.0, {rate}] }} }}
y = {{ spring = {{ polynomial = [0.0, {rate}] }} }}
[[forces]]
name = "b"
type = "bushing"
a = "ground.b"
b = "frame.b"
y = {{ spring = {{ polynomial = [0.0, {rate}] }} }}
"""


BLOCK = """
name = "block"
gravity = [0.0, 0.0]
[bodies.block]
mass = 3.0
inertia = 0.5
position = [0.0, 0.0]
[[forces]]
name = "mount"
type = "bushing"
a = "ground.origin"
b = "block.origin"
x = {{ spring = {{ polynomial = [0.0, 2000.0] }} }}
y = {{ spring = {law} }}
rotation = {{ spring = {{ polynomial = [0.0, 900.0] }} }}
"""
FOLLOWING = """
[[forces]]
name = "thrust"
type = "applied"
point = "block.origin"
axes = "following"
force = [40.0, 0.0]
"""


class Brackets(VerificationCase):
    def find_bracket(self, vehicle):
        """Of the lowest mode, heave."""
        found = self.program("modes", self.write_model(vehicle, "duration = 1.0\n"), "--bracket")
        return found["modes"][0]["bracket"]

    def test_a_kink_beside_the_equilibrium_widens_them(self):
        # 1 N/mm where it rests and 2 N/mm beyond a kink: sqrt(1000/3)/2π. Far from the kink the bracket is narrow.
        truth = np.sqrt(1000.0 / 3.0) / (2.0 * np.pi)
        for distance in (10.0 ** np.arange(-6.0, -0.99, 0.25)).tolist():  # numpy 2 writes its numbers otherwise
            table = [[-1.0, -1000.0], [0.0, 0.0], [distance, 1000.0 * distance], [1.0, 2000.0 - 1000.0 * distance]]
            with self.subTest(distance=distance):
                lower, upper = self.find_bracket(BLOCK.format(law="{ table = %s }" % table))
                self.assertLessEqual(lower, (1.0 + ROUNDING) * truth)
                self.assertGreaterEqual(upper, (1.0 - ROUNDING) * truth)
                if distance > 1e-2:
                    self.assertLess(upper - lower, 1e-6 * truth)

    def test_a_force_that_follows_a_body_has_none(self):
        law = "{ polynomial = [0.0, 1000.0] }"
        self.find_bracket(BLOCK.format(law=law))
        run = self.write_model(BLOCK.format(law=law) + FOLLOWING, "duration = 1.0\n")
        process = run_program([os.environ["SPRUNG_DYNAMICS"], "modes", run, "--bracket"], cwd=self.folder)
        self.assertEqual(process.returncode, 3)
        self.assertIn("the stiffness at rest is not symmetric, as with forces that follow a body", process.stderr)

    def test_rounding_beside_a_soft_reference_widens_them(self):
        # A beam of 4 m on three stiff springs, with a thin rod on it whose tip is the reference node: the vehicle's
        # stiffness is then a small difference of large terms. Expected: the frame's full matrices with the springs
        # on their diagonal, which have no such terms.
        for name, reference in (("soft", "tip"), ("stiff", "m")):
            (self.folder / f"{name}.toml").write_text(ANTENNA.format(reference=reference), encoding="utf-8")
        for command in (("build", "soft.toml", "stiff.toml", "--output-dir", "."),
                        ("matrices", "stiff.toml", "-o", "full")):  # fmt: skip
            run_program([os.environ["SPRUNG_REDUCE"], *command], cwd=self.folder, check=True)
        stiffness, mass = (
            scipy.io.mmread(self.folder / f"full_{name}.mtx").toarray() for name in ("stiffness", "mass")
        )
        for rate in (1e4, 1e10):
            held = stiffness + np.diag(rate * np.isin(np.arange(len(stiffness)), self.find_held_freedoms()))
            truth = 1.0 / (2.0 * np.pi * np.sqrt(scipy.linalg.eigh(mass, held, eigvals_only=True)[::-1]))
            for name, x, y in (("soft", 2.0, 1.0), ("stiff", 2.0, 0.0)):
                run = self.write_model(ON_SPRINGS.format(name=name, x=x, y=y, rate=rate), "duration = 1.0\n")
                found = self.program("modes", run, "--bracket", "--set", 'modes.frame="all"', superelements=self.folder)
                is_rounded = [w for w in found["warnings"] if "rounding beside the largest stiffness" in w["text"]]
                self.assertEqual(len(is_rounded), int(name == "soft" and rate > 1e9), (name, rate, is_rounded))
                brackets = [(k, mode["bracket"]) for k, mode in enumerate(found["modes"]) if "bracket" in mode]
                self.assertGreater(len(brackets), 2)
                for k, (lower, upper) in brackets:
                    with self.subTest(reference=name, rate=rate, mode=k + 1):
                        self.assertLessEqual(lower, (1.0 + ROUNDING) * truth[k])
                        self.assertGreaterEqual(upper, (1.0 - ROUNDING) * truth[k])

    def test_axial_forces_that_change_frequencies_by_more_are_warned_of(self):
        # A twentieth of the Euler load of the pinned beam lowers its first bending by about a fortieth.
        (self.folder / "m.toml").write_text(ANTENNA.format(reference="m"), encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "m.toml"], cwd=self.folder, check=True)
        push = '[[forces]]\nname = "push"\ntype = "applied"\npoint = "frame.b"\nforce = [-5e4, 0.0]\n'
        for load, told in (("", False), (push, True)):
            vehicle = ON_SPRINGS.format(name="m", x=2.0, y=0.0, rate=1e9) + load
            run = self.write_model(vehicle, "duration = 1.0\n[modes]\nframe = \"all\"\n")
            found = self.program("modes", run, "--bracket", superelements=self.folder)
            texts = [one["text"] for one in found["warnings"] if "brackets leave out axial forces" in one["text"]]
            self.assertEqual(len(texts), int(told), found["warnings"])
        percent, mode, frequency = re.search(r"by up to (\S+) % \(mode (\d+), to (\S+) Hz\)", texts[0]).groups()
        words = ("--set", "stiffening.frame=true")
        stiffened = self.program("modes", run, *words, superelements=self.folder)["modes"][int(mode) - 1]
        self.assert_close(float(frequency), stiffened["undamped_frequency"], relative=1e-4)
        change = stiffened["undamped_frequency"] / found["modes"][int(mode) - 1]["undamped_frequency"] - 1.0
        self.assert_close(float(percent), -100.0 * change, relative=0.05)
        self.assertLess(change, -0.01)

    def find_held_freedoms(self):
        """Indices of x and y at the beam's left end and of y at its right end, in the matrices of the frame."""
        nodes = np.loadtxt(self.folder / "full_nodes.csv", delimiter=",", skiprows=1)[:, 1:]
        places = {tuple(np.round(place - nodes[0], 9)): 3 * number for number, place in enumerate(nodes)}
        return [places[0.0, 0.0], places[0.0, 0.0] + 1, places[4.0, 0.0] + 1]


if __name__ == "__main__":
    unittest.main()
