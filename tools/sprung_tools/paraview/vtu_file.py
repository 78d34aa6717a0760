"""What the VTU files of modes and runs share."""

import numpy as np

RESULTANTS = {"axial": "axial_force", "shear": "shear_force", "moment": "bending_moment"}


def in_space(vectors):
    """[… × 2] → [… × 3] with z = 0."""
    return np.concatenate([vectors, np.zeros((*vectors.shape[:-1], 1))], axis=-1)
