"""The axes in which nodes of an Abaqus deck are given: *SYSTEM."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.abaqus_blocks import Block, check_rows, read_reals

STRAIGHT = 1e-9  # sine of an angle that counts as none


class Axes(NamedTuple):
    """Where axes are."""

    origin: Floats  # 3
    rotation: Floats  # 3×3, the axes as columns

    def place(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """The global coordinates of a point, to the last digit where the axes are not turned."""
        local = np.array([x, y, z])
        turned = local if np.array_equal(self.rotation, np.eye(3)) else self.rotation @ local
        a, b, c = (self.origin + turned).tolist()
        return a, b, c


GLOBAL = Axes(np.zeros(3), np.eye(3))


def read_axes(block: Block) -> Axes:
    """Reads a *SYSTEM: origin and a point of the x-axis, then a point of the x–y plane, which is parallel to the global
    one if it is not given. Without data these are the global axes, with an origin alone they are
    moved ones. InputError if the points give none."""
    check_rows(block, 2, "of its points")
    first, second = read_reals(block, 0, 6, "its origin and a point of its x-axis"), read_reals(block, 1, 3, "a point")
    if not block.data:
        return GLOBAL
    numbers = np.array(first + [0.0] * (6 - len(first)))
    origin, along = numbers[:3], numbers[3:] - numbers[:3]
    if len(first) <= 3 and not second:
        return Axes(origin, np.eye(3))
    length = float(np.linalg.norm(along)) if len(first) > 3 else 0.0
    towards = np.array(second + [0.0] * (3 - len(second))) - origin if second else np.zeros(3)
    normal = np.cross(along, towards) if second else np.array([0.0, 0.0, 1.0])
    size = float(np.linalg.norm(normal))
    least = STRAIGHT * length * float(np.linalg.norm(towards))
    if not (length > 0.0 and size > least and abs(normal @ along) <= STRAIGHT * size * length):
        block.fail("its points give no x-axis and no x–y plane", block.data[-1][0])
    x, z = along / length, normal / size
    return Axes(origin, np.array([x, np.cross(z, x), z]).T)
