"""The section that a group of lines has in the plane, from what the source says of each line.

With t along a line, n normal to the plane and d = n × t the direction of bending in it, a section with its height along
h and its width along w = h × t has

    ∫(d·r)² dA = hh (d·h)² + ww (d·w)² + 2 hw (d·h)(d·w),   r = h-coordinate h + w-coordinate w                    (1)

and bends out of the plane by a force in it unless ∫(d·r)(n·r) dA = 0. Bent in the plane alone, it has the section
modulus

    W = ∫(d·r)² dA / max |d·r|                                                                                     (2)
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
    section_modulus: float | None = None
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
    known = PlaneSection(
        section.text, section.material, extra_mass=section.extra_mass, members=count, left_out=section.left_out
    )
    if section.shape is None:
        return known._replace(left_out=(*known.left_out, "its shape: it has no numbers that are understood"))
    known = known._replace(area=section.shape.area)
    if not section.bends:
        return stand_in_for_rod(known, section.shape)
    return add_second_moment(known, section.shape, mesh, lines, plane)


def stand_in_for_rod(known: PlaneSection, shape: Shape) -> PlaneSection:
    """A rod as a beam with the second moment of a round bar of its area, because a planar frame has no hinges."""
    moment = shape.hh or shape.area**2 / (4.0 * math.pi)
    radius = shape.half_axes[0] or math.sqrt(shape.area / math.pi)
    what = "the hinges of the rod: here its ends are fixed, and it bends as a round bar of its area does"
    return known._replace(second_moment=moment, section_modulus=moment / radius, left_out=(*known.left_out, what))


def add_second_moment(known: PlaneSection, shape: Shape, mesh: LineMesh, lines: Integers, plane: str) -> PlaneSection:
    """The section with its second moment by (1) and its section modulus by (2), if they are the same for all lines."""
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
    modulus, what = None, "the source does not give its outline"
    extremes = calc_extremes(shape, ends[:, 1] - ends[:, 0], mesh.heights[lines], plane)
    if extremes is not None:
        moduli = moments / extremes
        if np.ptp(moduli) > SAME * np.max(moduli):
            what = f"it is from {moduli.min():.6g} to {moduli.max():.6g} as its lines are turned, divide it"
        else:
            modulus = float(moduli[0])
    elif shape.corners:
        what = "how it is turned about its axis is not said"
    if modulus is None:
        left_out.append(f"its section modulus, which stresses need: {what}")
    return known._replace(second_moment=float(moments[0]), section_modulus=modulus, left_out=tuple(left_out))


def calc_in_plane(shape: Shape, tangents: Floats, heights: Floats, plane: str) -> tuple[Floats, Floats] | None:
    """The integrals of (d·r)² and of (d·r)(n·r) of each line [E]; None if one line's height is not known.

    tangents, heights: [E×3], of any length.
    """
    if shape.hh == shape.ww and shape.hw == 0.0:
        return np.full(len(tangents), shape.hh), np.zeros(len(tangents))
    directions = calc_directions(tangents, heights, plane)
    if directions is None:
        return None
    dh, dw, nh, nw = directions
    moments = shape.hh * dh**2 + shape.ww * dw**2 + 2.0 * shape.hw * dh * dw
    products = shape.hh * dh * nh + shape.ww * dw * nw + shape.hw * (dh * nw + dw * nh)
    return moments, products


def calc_extremes(shape: Shape, tangents: Floats, heights: Floats, plane: str) -> Floats | None:
    """The largest |d·r| of each line [E]; None if the outline or one line's height is not known."""
    across, up = shape.half_axes
    if across == up > 0.0:
        return np.full(len(tangents), up)
    directions = calc_directions(tangents, heights, plane)
    if directions is None or not (shape.corners or up > 0.0):
        return None
    dh, dw = directions[:2]
    if not shape.corners:
        return np.hypot(up * dh, across * dw)
    w, h = np.array(shape.corners).T
    return np.max(np.abs(np.outer(dh, h) + np.outer(dw, w)), axis=1)


def calc_directions(tangents: Floats, heights: Floats, plane: str) -> tuple[Floats, Floats, Floats, Floats] | None:
    """d·h, d·w, n·h and n·w of each line [E]; None if one line's height is not known."""
    t = tangents / np.linalg.norm(tangents, axis=1, keepdims=True)
    h = heights - np.sum(heights * t, axis=1, keepdims=True) * t
    sizes = np.linalg.norm(h, axis=1, keepdims=True)
    if not np.all(sizes > SAME * np.linalg.norm(heights, axis=1, keepdims=True)):  # NaN, too
        return None
    h = h / sizes
    w = np.cross(h, t)
    normal = np.cross(*(np.eye(3)["xyz".index(axis)] for axis in plane))
    d = np.cross(normal, t)
    return np.sum(d * h, axis=1), np.sum(d * w, axis=1), h @ normal, w @ normal
