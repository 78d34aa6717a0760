"""Integrals over polygons, to check areas and second moments of sections by."""

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.mesh_import.plane_section import calc_extremes


def integrate(*outlines):
    """(area, ∫h², ∫w², ∫hw about the centroid, w, h of the centroid) of the area within outlines of corners (w, h), by
    Green's theorem. The corners of a hole run clockwise, those of an outline the other way."""
    sums = np.zeros(6)
    for outline in outlines:
        (w, h), (v, g) = np.array(outline, dtype=float).T, np.roll(outline, -1, axis=0).T
        cross = w * g - v * h
        sums += [
            np.sum(cross) / 2, np.sum(cross * (w + v)) / 6, np.sum(cross * (h + g)) / 6,
            np.sum(cross * (h * h + h * g + g * g)) / 12, np.sum(cross * (w * w + w * v + v * v)) / 12,
            np.sum(cross * (w * g + 2 * w * h + 2 * v * g + v * h)) / 24,
        ]  # fmt: skip
    area, w0, h0 = sums[0], sums[1] / sums[0], sums[2] / sums[0]
    return area, sums[3] - area * h0**2, sums[4] - area * w0**2, sums[5] - area * w0 * h0, w0, h0


DIRECTIONS = np.array([(np.sin(angle), np.cos(angle)) for angle in np.linspace(0.0, np.pi, 12, endpoint=False)])


def find_farthest(outlines):
    """The largest distance from the centroid along each of DIRECTIONS (w, h) that a corner of outlines has."""
    corners = np.concatenate([np.array(one, dtype=float) for one in outlines]) - integrate(*outlines)[4:]
    return np.max(np.abs(DIRECTIONS @ corners.T), axis=1)


def find_extremes(shape):
    """The same by a Shape, for a line along x with d along y: its height is turned by each angle."""
    heights = np.array([(0.0, h, w) for w, h in DIRECTIONS])
    return calc_extremes(shape, np.tile((1.0, 0.0, 0.0), (len(heights), 1)), heights, "xy")


def box(left, bottom, right, top, is_hole=False):
    """The corners of a rectangle."""
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    return corners[::-1] if is_hole else corners
