"""Elastic foundations inside a body, [[foundations]], against closed forms; springs between nodes of a mesh file.

Usage: foundations_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))

from reduce_case import ReduceTestCase, run_tests  # noqa: E402  after the path

E, AREA, INERTIA, RHO_A, LENGTH = 2.0e11, 2.0e-3, 3.0e-7, 15.0, 4.0
ALONG, ACROSS = np.array([0.8, 0.6]), np.array([-0.6, 0.8])
CLAMPED = "[modes]\ncount = 4\ndamping_ratio = 0.0\n"
SECTION = f"""[materials.steel]
youngs_modulus = {E}
[sections.bar]
material = "steel"
area = {AREA}
second_moment = {INERTIA}
mass_per_length = {RHO_A}
[sections.stub]
material = "steel"
area = 1e-6
second_moment = 1e-14
mass_per_length = 1e-6
"""


def place(along, across=0.0):
    return [float(value) for value in along * ALONG + across * ACROSS]


def make_line(first, last, elements, section="bar"):
    return f'[[lines]]\nfrom = "{first}"\nto = "{last}"\nsection = "{section}"\nelements = {elements}\n'


def make_bedded(stiffness, half, tangential=""):
    """A beam on a foundation of a rigid part, which moves with the reference beside its beginning. A soft stub connects
    the two."""
    return f"""{SECTION}[points]
part = {place(-0.5)}
left = {place(0.0)}
middle = {place(LENGTH / 2)}
right = {place(LENGTH)}
{make_line("part", "left", 1, "stub")}{make_line("left", "middle", half)}
{make_line("middle", "right", half)}[[foundations]]
from = "left"
to = "right"
part = "part"
normal_stiffness = {stiffness}
{tangential}[[point_masses]]
point = "part"
mass = 100.0
inertia = 50.0
[reference]
point = "part"
{CLAMPED}"""


def make_sandwich(gap, stiffness, ending):
    """Two equal beams, one above the other, with a foundation between them, fixed to each other at the beginning by a
    soft stub."""
    return f"""{SECTION}[points]
a = {place(0.0)}
b = {place(LENGTH)}
c = {place(0.0, gap)}
d = {place(LENGTH, gap)}
{make_line("a", "b", 40)}{make_line("c", "d", 40)}{make_line("a", "c", 1, "stub")}[[foundations]]
from = "a"
to = "b"
on = ["c", "d"]
normal_stiffness = {stiffness}
tangential_stiffness = {stiffness}
[reference]
point = "a"
{ending}"""


class FoundationsTest(ReduceTestCase):
    def make_body(self, text):
        (self.folder / "body.toml").write_text(text)
        self.build("body.toml", "--force")
        return h5py.File(self.folder / "out/body.h5")

    def test_deflection_of_a_long_beam_under_a_force(self):
        """w = F λ/2k under the force, λ⁴ = k/4EI [Hetényi 1946, §3]; the ends are 14/λ away. The error falls with the
        square of the element's length."""
        decay = 7.0
        stiffness = 4 * E * INERTIA * decay**4
        errors = []
        for half in (100, 200):
            with self.make_body(make_bedded(stiffness, half)) as file:
                names = [name.decode() for name in file["points/name"]]
                at = 3 * names.index("middle")
                w = ACROSS @ file["deflections/point_load"][at : at + 2, at : at + 2] @ ACROSS
            errors.append(w / (decay / (2 * stiffness)) - 1)
        self.assertLess(abs(errors[1]), 1e-3)
        self.assertLess(abs(errors[1]), 0.3 * abs(errors[0]))

    def test_frequencies_of_a_free_beam_on_a_foundation(self):
        """ω² = k/m + EI b⁴/m with the b of the free beam: 0 twice, then cosh bL cos bL = 1."""
        stiffness = 2.0e5
        with self.make_body(make_bedded(stiffness, 60, f"tangential_stiffness = {100 * stiffness}\n")) as file:
            found = file["modes/frequency"][()]
        b = np.array([0.0, 0.0, 4.730040744862704, 7.853204624095838]) / LENGTH
        expected = np.sqrt((stiffness + E * INERTIA * b**4) / RHO_A) / (2 * math.pi)
        np.testing.assert_allclose(found, expected, rtol=2e-3)

    def test_two_beams_with_a_foundation_between_them(self):
        """Out of phase, the middle of the foundation at rest: ω² = 2k/m for translation across. All rigid motion is
        free: the body has a free basis, its mass is that of the beams, and the checks from the file pass."""
        stiffness, gap = 4.0e4, 0.3
        ending = """[interface]
b = "xyr"
[reduction]
highest_frequency = 40.0
[modes]
damping_ratio = 0.01
"""
        with self.make_body(make_sandwich(gap, stiffness, ending)) as file:
            found, shapes = file["modes/frequency"][()], file["modes/shape"][()]
            self.assertAlmostEqual(file["inertia/mass"][()].item(), 2 * RHO_A * LENGTH, delta=1e-5)
            elements = file["elements/node"][()]
        # the stub and 41 bushings join the beams
        self.assertEqual(len(elements), 80 + 1 + 41)
        expected = math.sqrt(2 * stiffness / RHO_A) / (2 * math.pi)
        self.assertLess(np.abs(found / expected - 1).min(), 3e-3)
        self.assertEqual(shapes.shape[0], 82)
        result = self.run_program("check", "out/body.h5")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_two_beams_that_a_foundation_alone_joins(self):
        """Out of phase, the middle of the foundation at rest: ω² = 2k/m for translation along and across. Either end of
        the second beam may be named first. Without tangential stiffness one beam slides."""
        stiffness, gap = 4.0e4, 0.3
        ending = "[reduction]\nhighest_frequency = 40.0\n[modes]\ndamping_ratio = 0.01\n"
        alone = make_sandwich(gap, stiffness, ending).replace(make_line("a", "c", 1, "stub"), "")
        for text in (alone, alone.replace('["c", "d"]', '["d", "c"]')):
            with self.make_body(text) as file:
                found = file["modes/frequency"][()]
                self.assertAlmostEqual(file["inertia/mass"][()].item(), 2 * RHO_A * LENGTH, places=9)
            expected = math.sqrt(2 * stiffness / RHO_A) / (2 * math.pi)
            np.testing.assert_allclose(found[:2], expected, rtol=1e-3)
        (self.folder / "body.toml").write_text(alone.replace(f"tangential_stiffness = {stiffness}\n", ""))
        self.assertRegex(self.build("body.toml", code=3).stderr, "what nothing holds moves most at node")
        (self.folder / "body.toml").write_text(alone[: alone.index("[[found")] + alone[alone.index("[reference]") :])
        self.assertIn("the frame falls into 2 parts", self.build("body.toml", code=2).stderr)

    def test_beams_of_a_mesh_file_that_a_foundation_alone_joins(self):
        """The same body as from lines."""
        ending = "[reduction]\nhighest_frequency = 40.0\n[modes]\ndamping_ratio = 0.01\n"
        text = make_sandwich(0.3, 4.0e4, ending).replace(make_line("a", "c", 1, "stub"), "")
        with self.make_body(text) as file:
            expected = file["modes/frequency"][()]
        points = [place(0.0), place(LENGTH), place(0.0, 0.3), place(LENGTH, 0.3)]
        geometry = [f"Point({i + 1}) = {{{x}, {y}, 0}};" for i, (x, y) in enumerate(points)]
        geometry += ["Line(1) = {1, 2};", "Line(2) = {3, 4};", "Transfinite Curve {1, 2} = 41;"]
        geometry += ['Physical Curve("bar") = {1, 2};']
        (self.folder / "two.geo").write_text("\n".join(geometry) + "\n")
        start, end = text.index("[[lines]]"), text.index("[[foundations]]")
        with self.make_body('mesh = "two.geo"\n' + text[:start] + text[end:]) as file:
            np.testing.assert_allclose(file["modes/frequency"][()], expected, rtol=1e-7)

    def read_flexibility(self):
        """Deflections of the points a and b under unit loads there, and the lowest frequency and the mass."""
        self.build("ladder_frame.toml", "--force")
        with h5py.File(self.folder / "out/ladder_frame.h5") as file:
            names = [name.decode() for name in file["points/name"]]
            rows = [3 * names.index(name) + i for name in "ab" for i in range(3)]
            flexibility = file["deflections/point_load"][()][np.ix_(rows, rows)]
            return flexibility, file["modes/frequency"][0], file["inertia/mass"][()].item()

    def test_a_spring_and_a_rigid_offset_between_nodes_of_a_mesh_file(self):
        """A spring of the stiffness k along v changes the flexibility G to G − G v vᵀG/(1/k + vᵀG v)."""
        self.change("ladder_frame.toml", "load = [3.0, 0.8]", "load = [3.0, 0.8]\na = [3.0, 0.0]\nb = [4.0, 0.8]")
        before, frequency, mass = self.read_flexibility()
        stiffness, small = 2.0e7, 1e-6
        spring = f"""[[springs]]
from = "a"
to = "b"
axial_stiffness = {stiffness}
transverse_stiffness = {small}
rotational_stiffness = {small}
[reference]"""
        self.change("ladder_frame.toml", "[reference]", spring)
        after, braced, _ = self.read_flexibility()
        along = np.array([1.0, 0.8, 0.0]) / math.hypot(1.0, 0.8)
        v = np.concatenate([-along, along])
        moved = before @ v
        expected = before - np.outer(moved, moved) / (1 / stiffness + v @ moved)
        np.testing.assert_allclose(after, expected, atol=1e-8 * np.abs(before).max())
        self.assertGreater(braced, frequency)
        self.change("ladder_frame.toml", "[points]", "[points]\nweight = [6.5, 0.1]")
        offset = """[[rigid_offsets]]
from = "rear_end"
to = "weight"
[[point_masses]]
point = "weight"
mass = 30.0
[reference]"""
        self.change("ladder_frame.toml", "[reference]", offset)
        _, loaded, total = self.read_flexibility()
        self.assertAlmostEqual(total - mass, 30.0, places=9)
        self.assertLess(loaded, braced)

    def test_foundations_that_are_refused(self):
        text = make_bedded(1e5, 3)
        for change, message in (
            (('part = "part"\nnormal', "normal"), "expected either 'part'"),
            (('part = "part"\nnormal', 'on = ["part"]\nnormal'), "names 1 points"),
            (('part = "part"\nnormal', 'on = ["part", "left"]\nnormal'), "do not face"),
            (('to = "right"\npart', 'to = "left"\npart'), "is at the place of the line's first point"),
            (('to = "middle"\n', f'to = "middle"\nvia = {place(LENGTH / 4, 0.1)}\n'),
             "is not reached from the first point along a straight line of elements: none joins node"),
            (("normal_stiffness = 100000.0", "normal_stiffness = -1.0"), "normal_stiffness"),
        ):
            self.assertIn(change[0], text)
            (self.folder / "body.toml").write_text(text.replace(*change))
            result = self.build("body.toml", code=2)
            self.assertIn(message, result.stderr)
            self.assertRegex(result.stderr, r"body\.toml:\d+:\d+: error: ")


if __name__ == "__main__":
    run_tests()
