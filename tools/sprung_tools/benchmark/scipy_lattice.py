"""scipy's modes of a held frame, as a program of its own, whose memory can be measured.

Usage: python3 -m sprung_tools.benchmark.scipy_lattice PREFIX REFERENCE NUM_MODES
"""

import sys
import time

import numpy as np
from scipy.io import mmread
from scipy.sparse.linalg import eigsh


def solve_held_frame(prefix: str, reference: int, num_modes: int) -> float:
    """Lanczos iteration on K⁻¹M of the matrices that `sprung-reduce matrices` wrote, without the freedoms of the node
    `reference` (from 1). Returns the processor time without that of reading [s]."""
    stiffness, mass = (mmread(f"{prefix}_{name}.mtx").tocsc() for name in ("stiffness", "mass"))
    free = np.setdiff1d(np.arange(stiffness.shape[0]), 3 * (reference - 1) + np.arange(3))
    stiffness, mass = (matrix[free][:, free] for matrix in (stiffness, mass))
    start = time.process_time()
    eigsh(stiffness, k=min(num_modes, free.size - 1), M=mass, sigma=0.0)
    return time.process_time() - start


if __name__ == "__main__":
    print(solve_held_frame(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
