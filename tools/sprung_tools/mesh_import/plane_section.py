"""The section that a group of lines has in the plane, from what the source says of each line.

With t along a line, n normal to the plane and d = n × t the direction of bending in it, a section with its height along
h and its width along w = h × t has

    ∫(d·r)² dA = hh (d·h)² + ww (d·w)² + 2 hw (d·h)(d·w),   r = h-coordinate h + w-coordinate w                    (1)

and bends out of the plane by a force in it unless ∫(d·r)(n·r) dA = 0.
"""

import math
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.mesh_import.frame_properties import Shape
from sprung_tools.mesh_import.line_mesh import LineMesh, shorten

SAME = 1e-9  # relative, within which second moments are the same
OUT_OF_PLANE = 1e-6  # share of the sum of both second moments that the product may have


class PlaneSection(NamedTuple):
    """A section in the plane, in the source's units; None for what is not known."""

    text: str = ""  # what the source says, for people
    material: str = ""
    area: float | None = None
    second_moment: float | None = None
    extra_mass: float = 0.0  # per length
    members: int = 1  # parallel ones
    left_out: tuple[str, ...] = ()


def choose_section(mesh: LineMesh, lines: Integers, plane: str) -> PlaneSection:
    """The section that all the lines have; one without numbers if they do not have the same."""
    numbers = np.unique(mesh.section_of[lines])
    counts = np.unique(mesh.counts[lines])
    count = int(counts[0])
    if counts.size > 1:
        return PlaneSection(left_out=("its lines are single and double ones: divide it",))
    if numbers.size > 1:
        names = [mesh.sections[k].text if k >= 0 else "none" for k in numbers]
        return PlaneSection(members=count, left_out=(f"its lines have several sections: {shorten(names)}",))
    if numbers[0] < 0:
        return PlaneSection(members=count, left_out=("the source gives it none that is understood",))
    section = mesh.sections[numbers[0]]
    known = PlaneSection(section.text, section.material, None, None, section.extra_mass, count, section.left_out)
    if section.shape is None:
        return known._replace(left_out=(*known.left_out, "its shape: it has no numbers that are understood"))
    known = known._replace(area=section.shape.area)
    if not section.bends:
        return stand_in_for_rod(known, section.shape)
    return add_second_moment(known, section.shape, mesh, lines, plane)


def stand_in_for_rod(known: PlaneSection, shape: Shape) -> PlaneSection:
    """A rod as a beam with the second moment of a round bar of its area, because a planar frame has no hinges."""
    moment = shape.hh or shape.area**2 / (4.0 * math.pi)
    what = "the hinges of the rod: here its ends are fixed, and it bends as a round bar of its area does"
    return known._replace(second_moment=moment, left_out=(*known.left_out, what))


def add_second_moment(known: PlaneSection, shape: Shape, mesh: LineMesh, lines: Integers, plane: str) -> PlaneSection:
    """The section with its second moment by (1), if it is the same for all lines."""
    ends = mesh.positions[mesh.lines[lines]]
    found = calc_in_plane(shape, ends[:, 1] - ends[:, 0], mesh.heights[lines], plane)
    if found is None:
        unknown = "its second moment: how it is turned about its axis is not said"
        return known._replace(left_out=(*known.left_out, unknown))
    moments, products = found
    left_out = list(known.left_out)
    if np.ptp(moments) > SAME * np.max(np.abs(moments)):
        many = f"its second moment, from {moments.min():.6g} to {moments.max():.6g} as its lines are turned"
        return known._replace(left_out=(*left_out, f"{many}: divide it"))
    if np.max(np.abs(products)) > OUT_OF_PLANE * (shape.hh + shape.ww):
        left_out.append("its bending out of the plane under forces in it")
    if not moments[0] > 0.0:
        return known._replace(left_out=(*left_out, f"its second moment, which is {moments[0]:.6g}"))
    return known._replace(second_moment=float(moments[0]), left_out=tuple(left_out))


def calc_in_plane(shape: Shape, tangents: Floats, heights: Floats, plane: str) -> tuple[Floats, Floats] | None:
    """The integrals of (d·r)² and of (d·r)(n·r) of each line [E]; None if one line's height is not known.

    tangents, heights: [E×3], of any length.
    """
    t = tangents / np.linalg.norm(tangents, axis=1, keepdims=True)
    if shape.hh == shape.ww and shape.hw == 0.0:
        return np.full(len(t), shape.hh), np.zeros(len(t))
    h = heights - np.sum(heights * t, axis=1, keepdims=True) * t
    sizes = np.linalg.norm(h, axis=1, keepdims=True)
    if not np.all(sizes > SAME * np.linalg.norm(heights, axis=1, keepdims=True)):  # NaN, too
        return None
    h = h / sizes
    w = np.cross(h, t)
    normal = np.cross(*(np.eye(3)["xyz".index(axis)] for axis in plane))
    d = np.cross(normal, t)
    dh, dw, nh, nw = (np.sum(a * b, axis=1) for a, b in ((d, h), (d, w), (normal + 0 * h, h), (normal + 0 * w, w)))
    moments = shape.hh * dh**2 + shape.ww * dw**2 + 2.0 * shape.hw * dh * dw
    products = shape.hh * dh * nh + shape.ww * dw * nw + shape.hw * (dh * nw + dw * nh)
    return moments, products
