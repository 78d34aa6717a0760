"""Matrices that CalculiX 2.20 wrote of a free block of solid elements, and the frequencies that it found itself.

Usage: calculix_block_test.py PROGRAM SOURCE_DIR [unittest arguments]

The folder calculix_block has CalculiX's input, its .sti, .mas and .dof files, and a design that reads them.
"""

import shutil
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))

from reduce_case import SOURCE, ReduceTestCase, run_tests  # noqa: E402  after the path

# From the .dat file of *FREQUENCY with 16 modes, Hz; the first six are rigid motions. The block is symmetric about
# the plane z = 0, and a planar body has the modes symmetric about it.
CALCULIX = (304.6045, 327.4209, 749.9281, 888.6014, 944.6853, 1311.717, 1558.864, 1869.564, 1956.708, 2484.842)
SYMMETRIC = (327.4209, 944.6853, 1311.717, 1956.708)


class CalculixBlockTest(ReduceTestCase):
    def test_frequencies_and_mass_are_those_of_calculix(self):
        shutil.copytree(SOURCE / "tests/reduce/matrices/calculix_block", self.folder, dirs_exist_ok=True)
        self.build("block.toml")
        with h5py.File(self.folder / "out/block.h5") as file:
            kinds = file["modes/kind"].asstr()[()]
            found = file["modes/frequency"][()][kinds == "free"]
            mass = file["inertia/mass"][()].item()
        self.assertTrue(set(SYMMETRIC) <= set(CALCULIX))
        np.testing.assert_allclose(found, SYMMETRIC, rtol=2e-7)  # half of its last digit
        self.assertAlmostEqual(mass, 7850.0 * 2.0 * 0.12 * 0.08, places=8)


if __name__ == "__main__":
    run_tests()
