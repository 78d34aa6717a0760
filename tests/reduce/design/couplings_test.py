"""Points that follow others, [[rigid_offsets]] and [[averages]], against closed forms.

Usage: couplings_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))

from reduce_case import ReduceTestCase, run_tests  # noqa: E402  after the path

E, AREA, INERTIA, RHO_A, LENGTH = 2.0e11, 2.0e-3, 3.0e-7, 15.0, 1.2
ALONG, ACROSS = np.array([0.8, 0.6]), np.array([-0.6, 0.8])
MASS, ROTARY, OFFSET = 7.0, 0.4, 0.35
CLAMPED = "[modes]\nall = true\ndamping_ratio = 0.0\n"
FREE = "[reduction]\nhighest_frequency = 300.0\n[modes]\ndamping_ratio = 0.01\n"
SECTION = f"""[materials.steel]
youngs_modulus = {E}
[sections.bar]
material = "steel"
area = {AREA}
second_moment = {INERTIA}
mass_per_length = {RHO_A}
"""


def place(along, across=0.0):
    return [float(value) for value in along * ALONG + across * ACROSS]


def make_line(first, last, elements):
    return f'[[lines]]\nfrom = "{first}"\nto = "{last}"\nsection = "bar"\nelements = {elements}\n'


def make_eccentric(elements, ending=CLAMPED, more=""):
    """A cantilever, and a mass fixed rigidly ahead of its tip."""
    return f"""{SECTION}[points]
wall = {place(0.0)}
tip = {place(LENGTH)}
weight = {place(LENGTH + OFFSET)}
{make_line("wall", "tip", elements)}[[rigid_offsets]]
from = "tip"
to = "weight"
[[point_masses]]
point = "weight"
mass = {MASS}
inertia = {ROTARY}
[reference]
point = "wall"
{more}{ending}"""


def make_averaged(ending=CLAMPED, weights=""):
    """Three cantilevers that stand on one beam, whose ends carry a point by their mean motion."""
    feet = [0.0, 0.5, 1.5]
    points = "".join(f"foot{i} = {place(s)}\nend{i} = {place(s, LENGTH)}\n" for i, s in enumerate(feet))
    lines = "".join(make_line(f"foot{i}", f"end{i}", 2) for i in range(3))
    return f"""{SECTION}[points]
{points}load = {place(0.9, LENGTH + 0.2)}
{make_line("foot0", "foot1", 2)}{make_line("foot1", "foot2", 3)}{lines}[[averages]]
point = "load"
of = ["end0", "end1", "end2"]
{weights}[reference]
point = "foot1"
{ending}"""


class CouplingsTest(ReduceTestCase):
    def make_body(self, text):
        (self.folder / "body.toml").write_text(text)
        self.build("body.toml", "--force")
        return h5py.File(self.folder / "out/body.h5")

    def read_flexibility(self, file):
        """Deflections of the points under unit loads at the points, and the rows of each point."""
        names = [name.decode() for name in file["points/name"]]
        rows = {name: slice(3 * i, 3 * i + 3) for i, name in enumerate(names)}
        return file["deflections/point_load"][()], rows

    def test_deflection_under_a_force_at_the_offset(self):
        """F across, at the distance e ahead of the tip: F L³/3EI + F e L²/2EI and the angle F (L²/2EI + e L/EI)."""
        with self.make_body(make_eccentric(1)) as file:
            flexibility, rows = self.read_flexibility(file)
        EI = E * INERTIA
        at = flexibility[rows["weight"], rows["weight"]]
        deflection = LENGTH**3 / 3 + OFFSET * LENGTH**2 / 2
        angle = LENGTH**2 / 2 + OFFSET * LENGTH
        self.assertAlmostEqual(ACROSS @ at[:2, :2] @ ACROSS / ((deflection + OFFSET * angle) / EI), 1.0, places=10)
        self.assertAlmostEqual(ACROSS @ at[:2, 2] / (angle / EI), 1.0, places=10)
        self.assertAlmostEqual(ALONG @ at[:2, :2] @ ALONG / (LENGTH / (E * AREA)), 1.0, places=10)

    def test_frequencies_of_a_beam_with_an_eccentric_mass(self):
        """Clamped beam w = A (cosh − cos) + B (sinh − sin) of b x, with m of the mass at its tip:
        EI w''' = −ω² m (w + e w'), EI w'' = ω² (m e w + (J + m e²) w')."""

        def calc_determinant(b):
            z = b * LENGTH
            ch, c, sh, s = math.cosh(z), math.cos(z), math.sinh(z), math.sin(z)
            w, w1 = np.array([ch - c, sh - s]), b * np.array([sh + s, ch - c])
            w2, w3 = b**2 * np.array([ch + c, sh + s]), b**3 * np.array([sh - s, ch + c])
            omega2 = E * INERTIA * b**4 / RHO_A
            shear = E * INERTIA * w3 + omega2 * MASS * (w + OFFSET * w1)
            moment = E * INERTIA * w2 - omega2 * (MASS * OFFSET * w + (ROTARY + MASS * OFFSET**2) * w1)
            return np.linalg.det(np.array([shear, moment])) / (math.cosh(z) ** 2)

        grid = np.linspace(0.05, 5.0, 4000)
        values = [calc_determinant(b) for b in grid]
        roots = [brentq(calc_determinant, a, b) for a, b, f, g in zip(grid, grid[1:], values, values[1:]) if f * g < 0]
        expected = np.array(roots[:3]) ** 2 * math.sqrt(E * INERTIA / RHO_A) / (2 * math.pi)
        with self.make_body(make_eccentric(40)) as file:
            shapes, found = file["modes/shape"][()], file["modes/frequency"][()]
        sideways = np.abs(np.einsum("i,nik->nk", ACROSS, shapes[:, :2])).max(axis=0)
        lengthways = np.abs(np.einsum("i,nik->nk", ALONG, shapes[:, :2])).max(axis=0)
        np.testing.assert_allclose(found[sideways > 10 * lengthways][:3], expected, rtol=2e-6)

    def test_a_follower_keeps_mass_invariants_and_rigid_motions(self):
        more = '[interface]\ntip = "xyr"\nweight = "xyr"\n'
        with self.make_body(make_eccentric(6, ending=FREE, more=more)) as file:
            self.assertAlmostEqual(file["inertia/mass"][()].item(), RHO_A * LENGTH + MASS, places=10)
            first = (RHO_A * LENGTH**2 / 2 + MASS * (LENGTH + OFFSET)) * ALONG
            np.testing.assert_allclose(file["inertia/first_moment"][()].ravel(), first, rtol=1e-12)
            second = RHO_A * LENGTH**3 / 3 + MASS * (LENGTH + OFFSET) ** 2 + ROTARY
            self.assertAlmostEqual(file["inertia/second_moment"][()].item() / second, 1.0, places=12)
            self.assertGreater(file["modes/frequency"][0], 10.0)  # only three rigid motions, which are no modes
            names = [name.decode() for name in file["points/name"]]
            tip, weight = (file["points/node"][names.index(name)] for name in ("tip", "weight"))
            shapes = file["modes/shape"][()]
        offset = OFFSET * np.array([-ALONG[1], ALONG[0]])
        np.testing.assert_allclose(shapes[weight, :2], shapes[tip, :2] + np.outer(offset, shapes[tip, 2]), atol=1e-12)
        np.testing.assert_allclose(shapes[weight, 2], shapes[tip, 2], rtol=1e-12)
        result = self.run_program("check", "out/body.h5")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_lines_that_a_rigid_offset_joins_are_one_frame(self):
        """Two pieces of a bar with a rigid step between them bend as one: the step turns by the angle of the first."""
        text = f"""{SECTION}[points]
wall = {place(0.0)}
step = {place(LENGTH)}
above = {place(LENGTH, OFFSET)}
end = {place(2 * LENGTH, OFFSET)}
{make_line("wall", "step", 1)}{make_line("above", "end", 1)}[[rigid_offsets]]
from = "step"
to = "above"
[reference]
point = "wall"
{CLAMPED}"""
        with self.make_body(text) as file:
            flexibility, rows = self.read_flexibility(file)
        at = flexibility[rows["end"], rows["end"]]
        EI = E * INERTIA
        self.assertAlmostEqual(ACROSS @ at[:2, :2] @ ACROSS / ((2 * LENGTH) ** 3 / (3 * EI)), 1.0, places=9)
        along = 2 * LENGTH / (E * AREA) + OFFSET**2 * LENGTH / EI
        self.assertAlmostEqual(ALONG @ at[:2, :2] @ ALONG / along, 1.0, places=9)

    def test_a_load_on_an_average_spreads_and_adds_no_stiffness(self):
        """A force spreads by the weights, and by the moment of its arm; the ends move against each other as without the
        average."""
        weights = "weights = [1.0, 2.0, 1.5]\n"
        with self.make_body(make_averaged(weights=weights)) as file:
            with_average, rows = self.read_flexibility(file)
            frequencies = file["modes/frequency"][()]
        text = make_averaged()
        start, end = text.index("[[averages]]"), text.index("[reference]")
        text = "\n".join(line for line in (text[:start] + text[end:]).splitlines() if not line.startswith("load ="))
        with self.make_body(text) as file:
            alone, others = self.read_flexibility(file)
            np.testing.assert_allclose(frequencies, file["modes/frequency"][()], rtol=1e-7)
        ends = ["end0", "end1", "end2"]
        for row in ends:
            for column in ends:
                np.testing.assert_allclose(
                    with_average[rows[row], rows[column]], alone[others[row], others[column]], rtol=1e-8, atol=1e-14
                )
        # The force across, and the moment of its arm about the centre of the weights.
        share = np.array([1.0, 2.0, 1.5]) / 4.5
        stations = np.array([0.0, 0.5, 1.5])
        centre = share @ stations
        spread = share + (0.9 - centre) * share * (stations - centre) / (share @ (stations - centre) ** 2)
        moved = with_average[:, rows["load"]][:, :2] @ ACROSS
        summed = sum(s * with_average[:, rows[end]][:, :2] @ ACROSS for s, end in zip(spread, ends))
        np.testing.assert_allclose(moved, summed, rtol=1e-8, atol=1e-15)
        self.assertAlmostEqual(spread.sum(), 1.0, places=12)

    def test_a_fixed_interface_takes_followers_along(self):
        """The truth are the frequencies of the free body, which the basis holds the better the more modes it has.
        A point that only follows changes nothing."""
        interface = '[interface]\n{} = "xyr"\n{} = "xyr"\n'
        fixed = FREE.replace("[reduction]", '[reduction]\nbasis = "fixed-interface"').replace("300.0", "3000.0")
        eccentric = interface.format("wall", "tip")
        with self.make_body(make_eccentric(8, ending=eccentric + FREE)) as file:
            expected = file["modes/frequency"][()][:2]
        with self.make_body(make_eccentric(8, ending=eccentric + fixed)) as file:
            np.testing.assert_allclose(file["modes/frequency"][()][:2], expected, rtol=1e-4)
        averaged = make_averaged(ending=interface.format("end0", "foot2") + fixed)
        with self.make_body(averaged) as file:
            frequencies = file["modes/frequency"][()]
        start, end = averaged.index("[[averages]]"), averaged.index("[reference]")
        alone = averaged[:start] + averaged[end:]
        with self.make_body("\n".join(line for line in alone.splitlines() if not line.startswith("load ="))) as file:
            np.testing.assert_allclose(frequencies, file["modes/frequency"][()], rtol=1e-7)

    def test_couplings_that_are_refused(self):
        eccentric, averaged = make_eccentric(2), make_averaged()
        again = '[[rigid_offsets]]\nfrom = "wall"\nto = "weight"\n[reference]'
        chain = '[[rigid_offsets]]\nfrom = "weight"\nto = "tip"\n[reference]'
        for text, change, message in (
            (eccentric, ('from = "tip"', 'from = "tpi"'), "names the point 'tpi'"),
            (eccentric, ('from = "tip"\nto = "w', 'from = "weight"\nto = "w'), "is at the place of 'from'"),
            (eccentric, ("[reference]", again), "follows other points already"),
            (eccentric, ("[reference]", chain), "follows others itself"),
            (eccentric, ('point = "wall"', 'point = "weight"'), "take one of those as the reference"),
            (eccentric, (CLAMPED, FREE.replace("[red", '[interface]\nweight = "y"\n[red').replace(
                "[reduction]", '[reduction]\nbasis = "fixed-interface"')),
             "'interface.weight' names a point that follows others"),
            (eccentric, (CLAMPED, FREE.replace("[reduction]", '[reduction]\nbasis = "fixed-interface"')),
             "'reduction.basis' holds the freedoms of 'weight', a point that follows others; name those in"),
            (averaged, ('["end0", "end1", "end2"]', '["end0"]'), "expected at least 2"),
            (averaged, (f"load = {place(0.9, LENGTH + 0.2)}", f"load = {place(1.5)}"),
             "is a node of a line, which an average would hold"),
            (averaged, ('["end0", "end1", "end2"]', '["end0", "end0"]'), "names a node twice"),
            (averaged, ('["end0", "end1", "end2"]\n', '["end0", "end1"]\nweights = [1.0]\n'), "1 numbers for 2 points"),
        ):
            self.assertIn(change[0], text)
            (self.folder / "body.toml").write_text(text.replace(*change))
            result = self.build("body.toml", code=2)
            self.assertRegex(result.stderr, message)
            self.assertRegex(result.stderr, r"body\.toml:\d+:\d+: error: ")

    def test_matrices_of_a_frame_with_followers_are_refused_by_its_file(self):
        (self.folder / "body.toml").write_text(make_eccentric(2))
        result = self.run_program("matrices", "body.toml", "-o", "frame")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"^body\.toml: error: has points that follow others")
        self.assertEqual(list(self.folder.glob("frame_*")), [])


if __name__ == "__main__":
    run_tests()
