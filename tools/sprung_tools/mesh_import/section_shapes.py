"""Areas and second moments of sections made of rectangles, and of round ones."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from sprung_tools.mesh_import.frame_properties import Shape

LARGEST = 1e30  # length that a section may have, in any unit: its fourth power is still a number


class Rectangle(NamedTuple):
    """A part of a section, with sides along width and height; a hole has a negative sign."""

    width: float
    height: float
    w: float = 0.0  # of its middle
    h: float = 0.0
    sign: float = 1.0


def combine(parts: Sequence[Rectangle]) -> Shape:
    """The shape of several rectangles about their common centroid. ValueError if a side or the area is not
    positive."""
    for part in parts:
        if not (0.0 < part.width < LARGEST and 0.0 < part.height < LARGEST):
            raise ValueError(f"has a part of {part.width:g} by {part.height:g}")
    areas = [part.sign * part.width * part.height for part in parts]
    area = sum(areas)
    if not area > 0.0:
        raise ValueError(f"has the area {area:g}")
    w0 = sum(one * part.w for one, part in zip(areas, parts)) / area
    h0 = sum(one * part.h for one, part in zip(areas, parts)) / area
    return Shape(
        area,
        sum(one * (part.height**2 / 12.0 + (part.h - h0) ** 2) for one, part in zip(areas, parts)),
        sum(one * (part.width**2 / 12.0 + (part.w - w0) ** 2) for one, part in zip(areas, parts)),
        sum(one * (part.h - h0) * (part.w - w0) for one, part in zip(areas, parts)),
    )


def make_rectangle(width: float, height: float) -> Shape:
    """A solid rectangle."""
    return combine([Rectangle(width, height)])


def make_box(width: float, height: float, left: float, right: float, top: float, bottom: float) -> Shape:
    """A hollow rectangle with the thickness of each wall."""
    hole = Rectangle(width - left - right, height - top - bottom, (left - right) / 2.0, (bottom - top) / 2.0, -1.0)
    return combine([Rectangle(width, height), hole])


def make_i(height: float, bottom: float, top: float, web: float, under: float, over: float) -> Shape:
    """An I section: whole height, widths of the bottom and the top flange, thicknesses of web, bottom and top flange.

    A T is an I without one of its flanges: width and thickness 0.
    """
    parts = [Rectangle(web, height - under - over, 0.0, (under - over) / 2.0)]
    if bottom or under:
        parts.append(Rectangle(bottom, under, 0.0, (under - height) / 2.0))
    if top or over:
        parts.append(Rectangle(top, over, 0.0, (height - over) / 2.0))
    return combine(parts)


def make_channel(width: float, height: float, web: float, flange: float) -> Shape:
    """A channel with an upright web at its left side: whole width and height, thickness of web and flanges."""
    hole = Rectangle(width - web, height - 2.0 * flange, web / 2.0, 0.0, -1.0)
    return combine([Rectangle(width, height), hole])


def make_pair(width: float, height: float, side_width: float, side_height: float) -> Shape:
    """A rectangle with two others at its sides: an H, or a cross."""
    aside = (width + side_width) / 2.0
    sides = [Rectangle(side_width, side_height, w) for w in (-aside, aside)]
    return combine([Rectangle(width, height), *sides])


def turn(shape: Shape) -> Shape:
    """The shape turned by a quarter: its width becomes its height."""
    return Shape(shape.area, shape.ww, shape.hh, -shape.hw)


def make_tube(outer: float, inner: float = 0.0) -> Shape:
    """A ring, or a disc; outer, inner: radii. ValueError if they are not in order."""
    if not 0.0 <= inner < outer < LARGEST:
        raise ValueError(f"has the radii {outer:g} and {inner:g}")
    moment = math.pi * (outer**4 - inner**4) / 4.0
    return Shape(math.pi * (outer**2 - inner**2), moment, moment)


def make_ellipse(width: float, height: float) -> Shape:
    """A solid ellipse with the axes width and height. ValueError if they are not positive."""
    if not (0.0 < width < LARGEST and 0.0 < height < LARGEST):
        raise ValueError(f"has the axes {width:g} and {height:g}")
    area = math.pi * width * height / 4.0
    return Shape(area, area * height**2 / 16.0, area * width**2 / 16.0)
