"""What a source knows of a frame beside its mesh: materials, sections and point masses, in the source's units."""

import math
from typing import NamedTuple

from sprung_tools.files.array_types import Floats

MOMENTS_ROUNDING = 1e-3  # relative, of second moments of a thin wall that are given with four digits


class Material(NamedTuple):
    """An isotropic linear elastic material; None for what the source does not say."""

    name: str
    youngs_modulus: float | None
    poissons_ratio: float | None = None
    density: float | None = None


class Shape(NamedTuple):
    """Integrals over a section about its centroid, and its outline. h is the coordinate along its height, w along its
    width. Without corners and half-axes the outline is not known."""

    area: float
    hh: float  # ∫h² dA
    ww: float  # ∫w² dA
    hw: float = 0.0  # ∫h w dA
    w: float = 0.0  # where the centroid is, from the origin that the section's description has
    h: float = 0.0
    corners: tuple[tuple[float, float], ...] = ()  # (w, h) about the centroid; their convex hull holds the section
    half_axes: tuple[float, float] = (0.0, 0.0)  # along w and h, of a round section


def are_possible(hh: float, ww: float, hw: float) -> bool:
    """Whether a section can have these second moments: (∫h w dA)² ≤ ∫h² dA · ∫w² dA, but for their rounding."""
    return abs(hw) <= (1.0 + MOMENTS_ROUNDING) * math.sqrt(hh) * math.sqrt(ww)


class Section(NamedTuple):
    """A section of a line."""

    text: str  # what the source says, for people
    material: str  # name, empty if the source gives none
    shape: Shape | None  # None where the source gives none that is understood
    bends: bool = True  # False: a rod, which carries axial force alone; its shape has an area alone
    extra_mass: float = 0.0  # per length, beside area times density
    left_out: tuple[str, ...] = ()  # what of the section is not taken, a text each


class PointMass(NamedTuple):
    """A mass at a node."""

    text: str  # what the source says, for people
    node: int  # 0-based
    mass: float
    inertia: Floats | None = None  # [3×3] about the node; None for none
    left_out: str = ""  # why it cannot be taken; empty if it can
