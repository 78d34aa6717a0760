"""The axes in which nodes of an Abaqus deck are given: *SYSTEM."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.abaqus_blocks import Block, read_real

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
    rows = [[read_real(block, line, text) if text else 0.0 for text in fields] for line, fields in block.data]
    if not rows:
        return GLOBAL
    numbers = np.array((rows[0] + [0.0] * 6)[:6])
    origin, along = numbers[:3], numbers[3:] - numbers[:3]
    if len(rows[0]) <= 3:
        return Axes(origin, np.eye(3))
    length = float(np.linalg.norm(along))
    towards = np.array((rows[1] + [0.0] * 3)[:3]) - origin if len(rows) > 1 else np.zeros(3)
    normal = np.cross(along, towards) if len(rows) > 1 else np.array([0.0, 0.0, 1.0])
    size = float(np.linalg.norm(normal))
    least = STRAIGHT * length * float(np.linalg.norm(towards))
    if not (length > 0.0 and size > least and abs(normal @ along) <= STRAIGHT * size * length):
        block.fail("its points give no x-axis and no x–y plane", block.data[-1][0])
    x, z = along / length, normal / size
    return Axes(origin, np.array([x, np.cross(z, x), z]).T)
