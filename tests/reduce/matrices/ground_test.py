"""Matrices of a body that springs hold to the ground, and rounding that looks like it.

Usage: ground_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))
sys.path.insert(0, str(Path(__file__).resolve().parent))

import matrix_files as files  # noqa: E402  after the path
from reduce_case import ReduceTestCase, run_tests  # noqa: E402

# A steel beam of 40 elements, of numbers with many digits.
NUM, LENGTH, BENDING, MASS = 40, 4.1 / 1.03, 2.07e11 / 1.1 * 6.1e-6, 7850.0 * 2.4e-3
AXIAL = BENDING / 6.1e-6 * 2.4e-3
SPRING = 1e6  # N/m
# The free beam: cos x cosh x = 1, ω = (x/L)² √(EI/m). Forty elements are right to 1e-6.
FREE = [(x / LENGTH) ** 2 * math.sqrt(BENDING / MASS) / (2.0 * math.pi) for x in (4.730041, 7.853205)]


class Ground(ReduceTestCase):
    def write(self, stiffness, reference="mid"):
        _, mass = self.make_beam()
        ids = range(1, NUM + 2)
        files.write_matrix_market(self.folder / "k.mtx", stiffness)
        files.write_matrix_market(self.folder / "m.mtx", mass)
        files.write_freedoms(self.folder / "f.csv", files.plane_freedoms(ids))
        files.write_nodes(self.folder / "n.csv", ids, [(i * LENGTH / NUM, 0.0) for i in range(NUM + 1)])
        (self.folder / "body.toml").write_text(
            f"[points]\na = [0.0, 0.0]\nmid = [{LENGTH / 2.0}, 0.0]\nb = [{LENGTH}, 0.0]\n"
            '[matrices]\nformat = "matrix-market"\nstiffness = "k.mtx"\nmass = "m.mtx"\nfreedoms = "f.csv"\n'
            f'nodes = "n.csv"\n[reference]\npoint = "{reference}"\n[interface]\na = "y"\nmid = "y"\nb = "y"\n'
            "[reduction]\nhighest_frequency = 200.0\n[modes]\ndamping_ratio = 0.01\n", encoding="utf-8")  # fmt: skip

    def make_beam(self):
        return files.make_beam(NUM, LENGTH / NUM, axial=AXIAL, bending=BENDING, mass=MASS)

    def build_free(self, stiffness, reference="mid"):
        self.write(stiffness, reference)
        printed = self.build("body.toml", "--force").stdout
        with h5py.File(self.folder / "out/body.h5") as file:
            free = [kind == b"free" for kind in file["modes/kind"]]
            return printed, file["modes/frequency"][free], file["certificate/static_flexibility"][()]

    # By 2e-5 of the entries, so that they pass the check of forces. √(2k/mL)/2π is the rigid beam's frequency along y,
    # by hand. Turning about the middle is quicker: arms of three eighths of L, radius of gyration L/√12.
    def test_springs_to_the_ground_are_refused_with_frequency_stiffness_and_place(self):
        hand = math.sqrt(2.0 * SPRING / (MASS * LENGTH)) / (2.0 * math.pi)
        for reference in ("mid", "a"):
            stiffness, _ = self.make_beam()
            for node in (5, 35):
                stiffness[3 * node + 1, 3 * node + 1] += SPRING
            self.write(stiffness, reference)
            error = self.build("body.toml", code=2).stderr
            self.assertIn("k.mtx: error: the stiffness resists rigid motion, by ", error)
            self.assertIn("put them into the vehicle file", error)
            self.assertRegex(error, r"as at y of node (6|36)")
            self.assertRegex(error, r"would vibrate at \d+\.\d+ Hz; its lowest elastic frequency is \d+")
            said = float(error.split("would vibrate at ")[1].split()[0])
            self.assertAlmostEqual(said / (hand * 0.375 * math.sqrt(12.0)), 1.0, delta=2e-3)

    # 0.03 Hz beside 57 Hz change elastic ω² by less than 1e-6: what is reduced is free, and the user is told.
    def test_very_soft_springs_are_removed_and_told_of(self):
        stiffness, _ = self.make_beam()
        stiffness[3 * 20 + 1, 3 * 20 + 1] += (2.0 * math.pi * 0.03) ** 2 * MASS * LENGTH
        printed, modes, _ = self.build_free(stiffness)
        self.assertIn("remark: the stiffness resists rigid motion", printed)
        np.testing.assert_allclose(modes[:2], FREE, rtol=1e-5)

    # Ten digits, as in decks with fields of 16 columns.
    def test_rounded_numbers_are_those_of_a_free_body_whatever_its_reference(self):
        exact, _ = self.make_beam()
        rounded = np.vectorize(lambda value: float(f"{value:.9e}"))(exact)
        results = [self.build_free(rounded, reference) for reference in ("mid", "a", "b")]
        for printed, modes, flexibility in results:
            self.assertNotIn("remark", printed)
            np.testing.assert_allclose(modes[:2], FREE, rtol=1e-4)
            np.testing.assert_allclose(modes, results[0][1], rtol=1e-9)
            np.testing.assert_allclose(flexibility, results[0][2], rtol=1e-7)


if __name__ == "__main__":
    run_tests()
