"""Curved lines, made of straight elements, against the closed forms of thin rings and arcs.

Chords are shorter than their arcs, and nearer to the centre, by shares of the square of their angle, so that all errors
fall with the square of the number of elements.

Usage: arc_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))

from reduce_case import ReduceTestCase, run_tests  # noqa: E402  after the path

E, RHO, AREA, SECOND_MOMENT, RADIUS = 2.0e11, 7800.0, 4.0e-4, 1.3e-8, 0.6


def make_design(angle, num_elements, rest):
    """An arc about (0.3, −0.2), which begins at an angle of 0.4 rad; of a whole turn a ring."""
    is_ring = angle == 2 * math.pi
    num_points = num_elements + (not is_ring)
    turns = [0.4 + angle * i / num_elements for i in range(num_points)]
    points = "".join(f"p{i} = [{0.3 + RADIUS * math.cos(t)!r}, {-0.2 + RADIUS * math.sin(t)!r}]\n"
                     for i, t in enumerate(turns))
    through = [f'"p{i}"' for i in range(num_points)] + (['"p0"'] if is_ring else [])
    return f"""[materials.steel]
youngs_modulus = {E}
density = {RHO}
[sections.bar]
material = "steel"
area = {AREA}
second_moment = {SECOND_MOMENT}
[points]
{points}[[lines]]
through = [{", ".join(through)}]
section = "bar"
elements = 1
[reference]
point = "p0"
{rest}"""


def make_design_via(rest="[modes]\ncount = 1\ndamping_ratio = 0.0\n"):
    """A quarter of the circle of make_design as an arc of 16 elements through a place beside its middle."""
    places = [[0.3 + RADIUS * math.cos(t), -0.2 + RADIUS * math.sin(t)] for t in (0.4, 1.3, 0.4 + math.pi / 2)]
    design = make_design(math.pi / 2, 16, rest)
    line = f'p0 = {places[0]}\nend = {places[2]}\n[[lines]]\nfrom = "p0"\nto = "end"\nvia = {places[1]}\n'
    before, after = design.split("p0 = ", 1)[0], design.split("]\nsection = ", 1)[1]
    return before + line + "section = " + after.replace("elements = 1", "elements = 16")


def calc_ring_frequencies(waves):
    """Both frequencies in Hz of a free ring with n waves, w = W cos nθ outwards and v = V sin nθ along it, of
    ½ ∫ EA ((v' + w)/R)² + EI ((v' − w'')/R²)² ds and ½ ∫ ρA (v̇² + ẇ²) ds. Where it does not stretch the lower one is
    that of [Blevins 1979], table 9-1: ω² = n² (n² − 1)²/(n² + 1) EI/(ρA R⁴)."""
    n, R = waves, RADIUS
    K = E * AREA / R**2 * np.array([[1, n], [n, n**2]]) + E * SECOND_MOMENT / R**4 * np.array([[n**4, n**3],
                                                                                              [n**3, n**2]])
    return np.sqrt(np.linalg.eigvalsh(K / (RHO * AREA))) / (2 * math.pi)


class ArcTest(ReduceTestCase):
    def build_arc(self, *arguments):
        (self.folder / "arc.toml").write_text(make_design(*arguments))
        self.build("arc.toml", "--force")
        return h5py.File(self.folder / "out/arc.h5")

    def test_an_arc_via_a_place_is_the_line_through_points_on_it(self):
        rest = '[interface]\nend = "xyr"\n[reduction]\nhighest_frequency = 200.0\n[modes]\ndamping_ratio = 0.0\n'
        (self.folder / "points.toml").write_text(make_design(math.pi / 2, 16, rest).replace("p16", "end"))
        (self.folder / "place.toml").write_text(make_design_via(rest))
        self.build("points.toml", "place.toml")
        with h5py.File(self.folder / "out/points.h5") as one, h5py.File(self.folder / "out/place.h5") as other:
            np.testing.assert_allclose(other["modes/frequency"], one["modes/frequency"], rtol=1e-10)
            self.assertEqual(list(other["points/name"]), [b"p0", b"end"])
            np.testing.assert_allclose(*(np.sort(file["nodes/position"], axis=0) for file in (one, other)), atol=1e-14)

    def test_arcs_that_are_refused(self):
        for old, new, message in (
            ('from = "p0"\nto = "end"', 'through = ["p0", "end"]', "'lines.0.via' stands beside 'through'"),
            ("elements = 16", "elements = 1", "is an arc of one element"),
            ("via = [", "via = [0.0, ", "'lines.0.via'"),
        ):
            (self.folder / "arc.toml").write_text(make_design_via().replace(old, new))
            result = self.build("arc.toml", code=2)
            self.assertIn(message, result.stderr)
            self.assertRegex(result.stderr, r"arc\.toml:\d+:\d+: error: ")
        (self.folder / "arc.toml").write_text(make_design_via())
        result = self.run_program("sensitivity", "arc.toml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("'lines.0.via' stands in a design whose derivatives are not computed", result.stderr)

    def assert_order_two(self, coarse, fine, expected, name):
        errors = [np.asarray(found) / expected - 1 for found in (coarse, fine)]
        self.assertLess(np.abs(errors[1]).max(), 5e-3, name)
        np.testing.assert_allclose(errors[0] / errors[1], 4.0, atol=0.15, err_msg=name)

    def test_the_closed_form_of_a_ring_tends_to_that_of_a_ring_that_does_not_stretch(self):
        for n in (2, 3):
            omega_squared = n**2 * (n**2 - 1) ** 2 / (n**2 + 1) * E * SECOND_MOMENT / (RHO * AREA * RADIUS**4)
            self.assertAlmostEqual(calc_ring_frequencies(n)[0] / (math.sqrt(omega_squared) / (2 * math.pi)), 1.0,
                                   places=3)

    def test_frequencies_of_a_free_ring(self):
        # Pairs of modes with 2, 3 and 4 waves are lower than the ring's breathing, √(E/ρ)/2πR.
        expected = np.repeat([calc_ring_frequencies(n)[0] for n in (2, 3, 4)], 2)
        rest = (f'[interface]\np3 = "x"\n[reduction]\nhighest_frequency = {0.9 * expected[-1]}\n'
                "[modes]\ndamping_ratio = 0.0\n")
        found = []
        for num_elements in (32, 64):
            with self.build_arc(2 * math.pi, num_elements, rest) as file:
                found.append(file["certificate/free_frequency"][:6])
                self.assertAlmostEqual(file["inertia/mass"][()].item(),
                                       RHO * AREA * 2 * num_elements * RADIUS * math.sin(math.pi / num_elements))
        self.assert_order_two(*found, expected, "frequencies of a ring")

    def test_flexibility_of_a_clamped_quarter_arc(self):
        """[Timoshenko 1955], §80, with axial forces: moments and axial forces of unit loads at the end, along x, along
        y and a moment, integrated over the arc."""
        R, a, b = RADIUS, RADIUS / (E * AREA), RADIUS / (E * SECOND_MOMENT)
        pi = math.pi
        # Angle from the wall; the wall's tangent is y here, and the end lies at (−R, R) from the wall.
        expected = {
            (0, 0): b * R**2 * (3 * pi / 4 - 2) + a * pi / 4,
            (0, 1): b * R**2 / 2 - a / 2,
            (1, 1): b * R**2 * pi / 4 + a * pi / 4,
            (0, 2): -b * R * (pi / 2 - 1),
            (1, 2): -b * R,
            (2, 2): b * pi / 2,
        }
        turn = np.array([[math.cos(0.4), math.sin(0.4), 0], [-math.sin(0.4), math.cos(0.4), 0], [0, 0, 1]])
        found = []
        for num_elements in (16, 32):
            rest = "[modes]\ncount = 1\ndamping_ratio = 0.0\n"
            with self.build_arc(pi / 2, num_elements, rest) as file:
                names = [name.decode() for name in file["points/name"]]
                at = 3 * names.index(f"p{num_elements}")
                block = file["deflections/point_load"][at : at + 3, at : at + 3]
            block = turn @ block @ turn.T
            found.append([block[place] for place in expected])
        self.assert_order_two(*found, np.array(list(expected.values())), "flexibility of an arc")


if __name__ == "__main__":
    run_tests()
