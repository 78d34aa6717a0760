"""Integrals over polygons, to check areas and second moments of sections by."""

import numpy as np


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


def box(left, bottom, right, top, is_hole=False):
    """The corners of a rectangle."""
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    return corners[::-1] if is_hole else corners
