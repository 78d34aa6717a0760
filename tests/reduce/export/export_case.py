"""A straight beam for tests of exports, whose integrals the test makes itself, and the export of its superelement."""

import csv
import sys
from pathlib import Path

import h5py
import numpy as np

for folder in ("program", "matrices"):
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / folder))

import matrix_files as files  # noqa: E402  after the path
from reduce_case import ReduceTestCase, run_tests  # noqa: E402

__all__ = ["CLAMPED", "DESIGN", "FREE", "NUM_ELEMENTS", "PLACES", "Expected", "ExportCase", "files", "run_tests"]

NUM_ELEMENTS = 3
MASS_PER_LENGTH = 420.0
# The beam lies beside the reference node's axes, so that no integral vanishes by chance.
DESIGN = f"""[materials.stuff]
youngs_modulus = 1e6
density = 4200.0
[sections.bar]
material = "stuff"
area = 0.1
second_moment = 1e-3
[points]
a = [0.0, 0.0]
b = [1.0, 0.0]
c = [3.0, 0.0]
[[lines]]
through = ["a", "b", "c"]
section = "bar"
elements = [1, {NUM_ELEMENTS - 1}]
[reference]
point = "b"
"""
CLAMPED = "[modes]\nall = true\ndamping_ratio = 0.02\n"
FREE = "[reduction]\nhighest_frequency = 2.0\n[modes]\ndamping_ratio = 0.02\n"
PLACES = np.arange(NUM_ELEMENTS + 1.0) - 1.0  # of the nodes, from the reference node


def integrate(function):
    """∫ function(element, ξ) ρA dx by Gauss quadrature, exact for products of two cubics."""
    points, weights = np.polynomial.legendre.leggauss(4)
    return sum(0.5 * weight * MASS_PER_LENGTH * function(element, 0.5 * (point + 1.0))
               for element in range(NUM_ELEMENTS) for point, weight in zip(points, weights))


def interpolate(shapes, element, xi):
    """(x, φ_x, φ_y) in an element of 1 m from shapes 3N×n in the order of PLACES."""
    a, b = shapes[3 * element : 3 * element + 3], shapes[3 * element + 3 : 3 * element + 6]
    across = ((1 - 3 * xi**2 + 2 * xi**3) * a[1] + (xi - 2 * xi**2 + xi**3) * a[2]
              + (3 * xi**2 - 2 * xi**3) * b[1] + (xi**3 - xi**2) * b[2])
    return PLACES[element] + xi, (1 - xi) * a[0] + xi * b[0], across


class Expected:
    """Integrals of shapes 3N×n in the order of PLACES."""

    def __init__(self, shapes):
        self.K, self.M = files.make_beam(NUM_ELEMENTS)
        n = len(PLACES)
        along_x, along_y, rotation = np.zeros((3, 3 * n))
        along_x[0::3] = along_y[1::3] = rotation[2::3] = 1.0
        rotation[1::3] = PLACES
        self.mass = along_x @ self.M @ along_x
        self.centre = along_y @ self.M @ rotation / self.mass
        self.second_moment = rotation @ self.M @ rotation
        self.P = np.array([along_x, along_y]) @ self.M @ shapes
        self.c = rotation @ self.M @ shapes
        self.x_phi_x, self.x_phi_y = (
            integrate(lambda e, xi, d=d: np.multiply(*self.pick(shapes, e, xi, 0, d))) for d in (1, 2))
        self.xx, self.xy, self.yy = (
            integrate(lambda e, xi, i=i, j=j: np.outer(*self.pick(shapes, e, xi, i, j)))
            for i, j in ((1, 1), (1, 2), (2, 2)))
        self.stiffness, self.M_ff = shapes.T @ self.K @ shapes, shapes.T @ self.M @ shapes

    @staticmethod
    def pick(shapes, element, xi, i, j):
        values = interpolate(shapes, element, xi)
        return values[i], values[j]

    def clamped_frequencies(self):
        held = [i for i in range(len(self.K)) if i // 3 != 1]
        squares = np.linalg.eigvals(np.linalg.solve(self.M[np.ix_(held, held)], self.K[np.ix_(held, held)]))
        return np.sqrt(np.sort(squares.real)) / (2.0 * np.pi)


class ExportCase(ReduceTestCase):
    def make_body(self, rest=CLAMPED):
        (self.folder / "beam.toml").write_text(DESIGN + rest)
        self.build("beam.toml", "--force")
        return h5py.File(self.folder / "out/beam.h5")

    def export(self, target):
        result = self.run_program("export", "out/beam.h5", "--to", target, "-o", "body")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("left out: ", result.stdout)
        for line in result.stdout.splitlines():
            if not line.startswith("left out: "):
                self.assertTrue((self.folder / line).exists(), line)
        return result.stdout

    def read_csv(self, name):
        with open(self.folder / name, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def order(self, positions):
        np.testing.assert_allclose(np.sort(positions), PLACES, atol=1e-14)
        return np.argsort(positions)

    def assert_frequencies(self, stiffness, mass, expected):
        squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness))
        found = np.sqrt(np.sort(squares.real)) / (2.0 * np.pi)
        np.testing.assert_allclose(found[: len(expected)], expected, rtol=1e-9)
