"""Tapered lines of a design against closed forms.

Usage: tapered_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, jv

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))

from reduce_case import ReduceTestCase, run_tests  # noqa: E402  after the path

IRON = "[materials.iron]\nyoungs_modulus = 1.0e11\ndensity = 7200.0\n"
E, RHO, WIDTH, LENGTH = 2.0e11, 7800.0, 0.02, 1.3


def make_design(root, tip, num_elements, section='["root", "tip"]'):
    """A cantilever of constant width, whose height goes from root to tip."""
    return f"""[materials.steel]
youngs_modulus = {E}
density = {RHO}
[sections.root]
material = "steel"
shape = "rectangle"
width = {WIDTH}
height = {root}
[sections.tip]
material = "steel"
shape = "rectangle"
width = {WIDTH}
height = {tip}
[points]
wall = [0.0, 0.0]
end = [{0.6 * LENGTH}, {0.8 * LENGTH}]
[[lines]]
from = "wall"
to = "end"
section = {section}
elements = {num_elements}
[reference]
point = "wall"
[modes]
count = 3
damping_ratio = 0.0
"""


class TaperedTest(ReduceTestCase):
    def make_body(self, *arguments, **options):
        (self.folder / "cantilever.toml").write_text(make_design(*arguments, **options))
        self.build("cantilever.toml", "--force")
        return h5py.File(self.folder / "out/cantilever.h5")

    def find_tip_flexibility(self, root, tip, num_elements):
        """Deflection of the end across the beam under a force of 1 N across it."""
        with self.make_body(root, tip, num_elements) as file:
            names = [name.decode() for name in file["points/name"]]
            at = 3 * names.index("end")
            across = np.array([-0.8, 0.6])
            return across @ file["deflections/point_load"][at : at + 2, at : at + 2] @ across

    def test_deflection_and_mass_of_a_tapered_cantilever(self):
        """δ = ∫(L − x)²/EI dx, I = b h³/12, h linear in x. The error falls with the square of the elements."""
        h0, h1 = 0.06, 0.02
        s = (h1 - h0) / LENGTH
        primitive = lambda h: -(h1**2) / (2 * h**2) + 2 * h1 / h + math.log(h)  # noqa: E731
        expected = 12 / (E * WIDTH) * (primitive(h1) - primitive(h0)) / s**3
        errors = [self.find_tip_flexibility(h0, h1, n) / expected - 1 for n in (16, 32)]
        self.assertLess(abs(errors[1]), 1e-3)
        self.assertAlmostEqual(errors[0] / errors[1], 4.0, delta=0.05)
        with h5py.File(self.folder / "out/cantilever.h5") as file:
            # The area is linear in x, and that of the middles is exact.
            self.assertAlmostEqual(file["inertia/mass"][()].item(), RHO * WIDTH * LENGTH * (h0 + h1) / 2, places=10)

    def test_frequency_of_a_wedge(self):
        """A wedge with a sharp edge at its end [Kirchhoff 1882]: ω = (z/2)² √(EI/ρA)/L² of the section at the wall,
        with J₁(z) I₂(z) + I₁(z) J₂(z) = 0."""
        root = 0.06
        z = brentq(lambda z: jv(1, z) * iv(2, z) + iv(1, z) * jv(2, z), 4.0, 5.0)
        expected = (z / 2) ** 2 * math.sqrt(E * root**2 / 12 / RHO) / LENGTH**2 / (2 * math.pi)
        with self.make_body(root, 1e-9 * root, 80) as file:
            self.assertAlmostEqual(file["modes/frequency"][0] / expected, 1.0, delta=1e-3)

    def test_equal_ends_are_a_line_of_one_section(self):
        with self.make_body(0.06, 0.06, 5) as tapered, \
                h5py.File(self.folder / "copy.h5", "w") as copy:  # fmt: skip
            copy["f"] = tapered["modes/frequency"][()]
        with self.make_body(0.06, 0.06, 5, section='"root"') as uniform, h5py.File(self.folder / "copy.h5") as copy:
            np.testing.assert_allclose(copy["f"], uniform["modes/frequency"], rtol=1e-12)

    def test_tapers_that_are_refused(self):
        for change, message in (
            (('["root", "tip"]', '["root"]'), "names 1 sections"),
            (('["root", "tip"]', '["root", "top"]'), "names the section 'top', which is not defined"),
            (('from = "wall"\nto = "end"', 'through = ["wall", "end"]'), "a tapered line has 'from' and 'to'"),
            ((f"height = {0.02}", f"height = {0.02}\ncount = 2"), "different keys"),
            (('[sections.tip]\nmaterial = "steel"', f'{IRON}[sections.tip]\nmaterial = "iron"'),
             "names two sections with different 'material'"),
            (("height = 0.06\n[sections.tip]", "height = 0.06\ncount = 3\n[sections.tip]\ncount = 2"),
             "names two sections with different 'count'"),
            (("elements = 4", "elements = [4]"), "'lines.0.elements' must be an integer"),
        ):
            (self.folder / "cantilever.toml").write_text(make_design(0.06, 0.02, 4).replace(*change))
            result = self.build("cantilever.toml", code=2)
            self.assertIn(message, result.stderr)
            self.assertRegex(result.stderr, r"cantilever\.toml:\d+:\d+: error: ")


if __name__ == "__main__":
    run_tests()
