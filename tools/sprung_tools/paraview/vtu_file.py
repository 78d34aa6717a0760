"""The common parts of the VTU files of modes and runs."""

import numpy as np

from sprung_tools.files.array_types import Floats

RESULTANTS = {"axial": "axial_force", "shear": "shear_force", "moment": "bending_moment"}


def in_space(vectors: Floats) -> Floats:
    """Vectors [… × 2] as vectors [… × 3] with z = 0."""
    return np.concatenate([vectors, np.zeros((*vectors.shape[:-1], 1))], axis=-1)
