"""Springs and bushings inside a body against closed forms.

Usage: springs_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))

from reduce_case import ReduceTestCase, run_tests  # noqa: E402  after the path

E, AREA, INERTIA, MASS, LENGTH, GAP = 2.0e9, 1.0e-3, 1.0e-7, 5.0, 0.8, 0.05
AXIAL, ROTATIONAL = 3.0e5, 700.0
TRANSVERSE = 0.3 * 12 * ROTATIONAL / GAP**2


def make_design(num_elements, transverse=TRANSVERSE, more="", condition="[modes]\nall = true\n"):
    """Two equal bars in a line at an angle, with a bushing across the gap between them, clamped at one end."""
    places = {"wall": 0.0, "left": LENGTH, "right": LENGTH + GAP, "end": 2 * LENGTH + GAP}
    points = "\n".join(f"{name} = [{0.6 * s!r}, {0.8 * s!r}]" for name, s in places.items())
    return f"""[materials.stuff]
youngs_modulus = {E}
[sections.bar]
material = "stuff"
area = {AREA}
second_moment = {INERTIA}
mass_per_length = {MASS}
[points]
{points}
[[lines]]
from = "wall"
to = "left"
section = "bar"
elements = {num_elements}
[[lines]]
from = "right"
to = "end"
section = "bar"
elements = {num_elements}
[[springs]]
from = "left"
to = "right"
axial_stiffness = {AXIAL}
transverse_stiffness = {transverse}
rotational_stiffness = {ROTATIONAL}
{more}[reference]
point = "wall"
{condition}damping_ratio = 0.0
"""


class SpringsTest(ReduceTestCase):
    def make_body(self, *arguments, **options):
        (self.folder / "bars.toml").write_text(make_design(*arguments, **options))
        self.build("bars.toml", "--force")
        return h5py.File(self.folder / "out/bars.h5")

    def test_two_springs_between_the_same_points_add_up(self):
        """In a mesh file: lines are refused there."""
        (self.folder / "bars.msh").write_text(
            '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 "bar"\n$EndPhysicalNames\n'
            "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1.1 0 0\n4 2.1 0 0\n$EndNodes\n"
            "$Elements\n2\n1 1 2 1 5 1 2\n2 1 2 1 6 3 4\n$EndElements\n"
        )
        found = []
        for stiffnesses in ((1e6,), (1e5, 9e5)):
            springs = "".join(
                f'[[springs]]\nfrom = "left"\nto = "right"\naxial_stiffness = {one}\n'
                f"rotational_stiffness = {ROTATIONAL / len(stiffnesses)}\n"
                for one in stiffnesses
            )
            (self.folder / "bars.toml").write_text(
                f'mesh = "bars.msh"\n[materials.stuff]\nyoungs_modulus = {E}\n[sections.bar]\nmaterial = "stuff"\n'
                f"area = {AREA}\nsecond_moment = {INERTIA}\nmass_per_length = {MASS}\n{springs}"
                "[points]\nwall = [0.0, 0.0]\nleft = [1.0, 0.0]\nright = [1.1, 0.0]\nend = [2.1, 0.0]\n"
                '[reference]\npoint = "wall"\n[modes]\nall = true\ndamping_ratio = 0.0\n'
            )
            self.build("bars.toml", "--force")
            with h5py.File(self.folder / "out/bars.h5") as file:
                found.append(file["modes/frequency"][()])
        np.testing.assert_allclose(found[0], found[1], rtol=1e-8)

    def test_sections_of_springs_do_not_share_a_name(self):
        """'left to right' → 'end' and 'left' → 'right to end' are other springs, and a section may be called as one."""
        design = make_design(1).replace("[reference]", '[reference]\n', 1)
        (self.folder / "bars.toml").write_text(
            design.replace("[sections.bar]", '[sections."springs.0"]', 1).replace('"bar"', '"springs.0"'))
        process = self.run_program("build", "bars.toml")
        self.assertEqual(process.returncode, 2)
        self.assertIn("has a section that is called 'springs.0', as one under [sections]", process.stderr)

    def test_deflections_under_forces_at_the_end(self):
        """Exact for any number of elements: along F (2 L/EA + 1/k), across by the moments F x and the shear force F in
        bars and bushing."""
        with self.make_body(1) as file:
            names = [name.decode() for name in file["points/name"]]
            at = 3 * names.index("end")
            flexibility = file["deflections/point_load"][at : at + 2, at : at + 2]
        along, across = np.array([0.6, 0.8]), np.array([-0.8, 0.6])
        self.assertAlmostEqual(along @ flexibility @ along / (2 * LENGTH / (E * AREA) + 1 / AXIAL), 1.0, places=9)
        arm = LENGTH + GAP / 2  # of the force about the middle of the bushing
        far = 2 * LENGTH + GAP  # from the wall
        bending = (LENGTH**3 + far**3 - (far - LENGTH) ** 3) / (3 * E * INERTIA)
        expected = bending + arm**2 / ROTATIONAL + 1 / TRANSVERSE
        self.assertAlmostEqual(across @ flexibility @ across / expected, 1.0, places=9)

    def test_frequencies_of_two_bars_with_a_spring(self):
        """Of motion along the bars, clamped – spring – free: tan 2z = 2 k L/(EA z) with z = ω L √(m/EA)."""
        equation = lambda z: math.sin(2 * z) * z * E * AREA - 2 * AXIAL * LENGTH * math.cos(2 * z)  # noqa: E731
        grid = np.linspace(1e-3, 6.0, 2000)
        roots = [brentq(equation, a, b) for a, b in zip(grid, grid[1:]) if equation(a) * equation(b) < 0]
        expected = np.array(roots[:3]) / LENGTH * math.sqrt(E * AREA / MASS) / (2 * math.pi)
        with self.make_body(40) as file:
            shapes, found = file["modes/shape"][()], file["modes/frequency"][()]
        axial = np.abs(np.einsum("i,nik->nk", [0.6, 0.8], shapes[:, :2])).max(axis=0)
        across = np.abs(np.einsum("i,nik->nk", [-0.8, 0.6], shapes[:, :2])).max(axis=0)
        np.testing.assert_allclose(found[axial > 100 * across][:3], expected, rtol=2e-3)

    def test_a_bushing_moves_rigidly_with_the_body_and_has_no_mass(self):
        more = '[interface]\nend = "xyr"\n'
        condition = "[reduction]\nhighest_frequency = 100.0\n[modes]\n"
        with self.make_body(4, more=more, condition=condition) as file:
            self.assertAlmostEqual(file["inertia/mass"][()].item(), 2 * LENGTH * MASS, places=9)
            self.assertGreater(file["modes/frequency"][0], 1.0)  # no third rigid motion is lost among the modes
        result = self.run_program("check", "out/bars.h5")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_springs_that_are_refused(self):
        largest = 12 * ROTATIONAL / GAP**2
        for change, message in (
            ((f"transverse_stiffness = {TRANSVERSE}", f"transverse_stiffness = {1.01 * largest}"), "expected at most"),
            (('from = "left"\nto = "right"', 'from = "left"\nto = "rihgt"'), "names the point 'rihgt'"),
            (('from = "left"\nto = "right"', 'from = "left"\nto = "left"'), "is at the place of 'from'"),
            ((f"axial_stiffness = {AXIAL}", "axial_stiffness = 0.0"), "axial_stiffness"),
            ((f"axial_stiffness = {AXIAL}", "stiffness = 1.0"), "stiffness"),
        ):
            text = make_design(2)
            self.assertIn(change[0], text)
            (self.folder / "bars.toml").write_text(text.replace(*change))
            result = self.build("bars.toml", code=2)
            self.assertIn(message, result.stderr)
            self.assertRegex(result.stderr, r"bars\.toml:\d+:\d+: error: ")


if __name__ == "__main__":
    run_tests()
