"""Areas and second moments of sections made of rectangles, of thin walls, and of round and polygonal ones."""

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
    corners = [
        (part.w - w0 + side * part.width / 2.0, part.h - h0 + end * part.height / 2.0)
        for part in parts if part.sign > 0.0 for side in (-1.0, 1.0) for end in (-1.0, 1.0)
    ]  # fmt: skip
    return Shape(
        area,
        sum(one * (part.height**2 / 12.0 + (part.h - h0) ** 2) for one, part in zip(areas, parts)),
        sum(one * (part.width**2 / 12.0 + (part.w - w0) ** 2) for one, part in zip(areas, parts)),
        sum(one * (part.h - h0) * (part.w - w0) for one, part in zip(areas, parts)),
        w0,
        h0,
        tuple(corners),
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


def make_angle(width: float, height: float, lying: float, upright: float) -> Shape:
    """An L with its corner at the left of the bottom: whole width and height, thickness of both legs."""
    hole = Rectangle(width - upright, height - lying, upright / 2.0, lying / 2.0, -1.0)
    whole = combine([Rectangle(width, height), hole])
    left, low = -width / 2.0 - whole.w, -height / 2.0 - whole.h
    ends = ((0.0, 0.0), (width, 0.0), (width, lying), (upright, height), (0.0, height))
    return whole._replace(corners=tuple((left + w, low + h) for w, h in ends))


def make_z(flange: float, web: float, inner: float, height: float) -> Shape:
    """A Z of a web and two flanges beside it, the upper one to its left: width of a flange, thickness of the web, inner
    and whole height."""
    wall, aside = (height - inner) / 2.0, (web + flange) / 2.0
    up = (height - wall) / 2.0
    return combine([Rectangle(web, height), Rectangle(flange, wall, -aside, up), Rectangle(flange, wall, aside, -up)])


def make_hat(height: float, wall: float, top: float, brim: float) -> Shape:
    """A hat of one thickness: whole height, width of its top, width of each brim beside it."""
    aside, low = (top + brim) / 2.0, (wall - height) / 2.0
    hole = Rectangle(top - 2.0 * wall, height - wall, 0.0, -wall / 2.0, -1.0)
    brims = [Rectangle(brim, wall, w, low) for w in (-aside, aside)]
    return combine([Rectangle(top, height), hole, *brims])


def make_closed_hat(base: float, height: float, top: float, wall: float, plate: float) -> Shape:
    """A hat that stands on a plate of its whole width: whole width and height, width of the top, thickness of the hat
    and of the plate."""
    hat, brim = height - plate, (base - top) / 2.0
    aside, low = (top + brim) / 2.0, (wall - hat) / 2.0
    hole = Rectangle(top - 2.0 * wall, hat - wall, 0.0, -wall / 2.0, -1.0)
    brims = [Rectangle(brim, wall, w, low) for w in (-aside, aside)] if brim else []
    return combine([Rectangle(top, hat), hole, *brims, Rectangle(base, plate, 0.0, -height / 2.0)])


def make_double_box(
    width: float, height: float, middle: float, walls: tuple[float, float, float],
    left: tuple[float, float], right: tuple[float, float],
) -> Shape:  # fmt: skip
    """Two boxes side by side: whole width and height, where the middle of the inner wall is from the left, thickness of
    the left, the inner and the right wall, of the left box's top and bottom, and of the right box's."""
    ends = ((walls[0], middle - walls[1] / 2.0), (middle + walls[1] / 2.0, width - walls[2]))
    holes = [
        Rectangle(end - begin, height - top - bottom, (begin + end - width) / 2.0, (bottom - top) / 2.0, -1.0)
        for (begin, end), (top, bottom) in zip(ends, (left, right))
    ]
    return combine([Rectangle(width, height), *holes])


def mirror(shape: Shape) -> Shape:
    """The shape with its width in the opposite direction."""
    return shape._replace(hw=-shape.hw, w=-shape.w, corners=tuple((-w, h) for w, h in shape.corners))


def make_walls(points: Sequence[tuple[float, float]], walls: Sequence[float]) -> Shape:
    """Thin straight walls from point to point (w, h). A wall has no second moment about its own middle line; its
    corners are half its thickness away from this line. ValueError if a thickness is negative or there is no area."""
    if not all(0.0 <= wall < LARGEST for wall in walls) or not all(abs(x) < LARGEST for point in points for x in point):
        raise ValueError(f"has walls of {', '.join(f'{wall:g}' for wall in walls)}")
    pairs = list(zip(points, points[1:]))
    sides = [(b[0] - a[0], b[1] - a[1]) for a, b in pairs]
    middles = [((a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0) for a, b in pairs]
    areas = [wall * math.hypot(*side) for wall, side in zip(walls, sides)]
    area = sum(areas)
    if not area > 0.0:
        raise ValueError(f"has the area {area:g}")
    w0 = sum(one * w for one, (w, _) in zip(areas, middles)) / area
    h0 = sum(one * h for one, (_, h) in zip(areas, middles)) / area
    each = [(one, *side, w - w0, h - h0) for one, side, (w, h) in zip(areas, sides, middles)]
    away = [wall / 2.0 / (math.hypot(*side) or 1.0) for wall, side in zip(walls, sides)]
    corners = [
        (w - w0 - sign * half * dh, h - h0 + sign * half * dw)
        for pair, (dw, dh), half, one in zip(pairs, sides, away, areas) if one > 0.0
        for w, h in pair for sign in (-1.0, 1.0)
    ]  # fmt: skip
    return Shape(
        area,
        sum(one * (dh * dh / 12.0 + h * h) for one, _, dh, _, h in each),
        sum(one * (dw * dw / 12.0 + w * w) for one, dw, _, w, _ in each),
        sum(one * (dh * dw / 12.0 + h * w) for one, dw, dh, w, h in each),
        w0,
        h0,
        tuple(corners),
    )


def make_trapezoid(bottom: float, height: float, top: float) -> Shape:
    """A solid symmetric trapezoid; its origin is in the middle of its bottom. ValueError if a side is not positive."""
    if not all(0.0 < side < LARGEST for side in (bottom, height, top)):
        raise ValueError(f"has the sides {bottom:g}, {height:g} and {top:g}")
    both = bottom + top
    centre = height * (bottom + 2.0 * top) / (3.0 * both)
    ends = ((bottom / 2.0, -centre), (top / 2.0, height - centre))
    return Shape(
        both * height / 2.0,
        height**3 * (bottom**2 + 4.0 * bottom * top + top**2) / (36.0 * both),
        height * both * (bottom**2 + top**2) / 48.0,
        h=centre,
        corners=tuple((sign * w, h) for w, h in ends for sign in (-1.0, 1.0)),
    )


def make_hexagon(width: float, height: float, slant: float) -> Shape:
    """A solid hexagon, pointed at both sides: whole width, height, width of each point. ValueError if they do not
    fit."""
    if not (0.0 < slant < width / 2.0 < LARGEST and 0.0 < height < LARGEST):
        raise ValueError(f"has the width {width:g}, points of {slant:g} and the height {height:g}")
    half, flat = height / 2.0, width - 2.0 * slant  # two trapezoids with a common base
    ends = ((width / 2.0, 0.0), (flat / 2.0, half), (flat / 2.0, -half))
    return Shape(
        half * (width + flat), half**3 * (width + 3.0 * flat) / 6.0,
        half * (width + flat) * (width**2 + flat**2) / 24.0,
        corners=tuple((sign * w, h) for w, h in ends for sign in (-1.0, 1.0)),
    )  # fmt: skip


def make_hexagonal_tube(radius: float, wall: float) -> Shape:
    """A regular hexagon with a wall; radius: of the circle through its outer corners. Where these lie on the circle is
    not known. ValueError if the wall is too thick."""
    inner = radius - 2.0 * wall / math.sqrt(3.0)
    if not (wall > 0.0 and 0.0 < inner < radius < LARGEST):
        raise ValueError(f"has the radius {radius:g} and the wall {wall:g}")
    moment = 5.0 * math.sqrt(3.0) / 16.0 * (radius**4 - inner**4)
    return Shape(1.5 * math.sqrt(3.0) * (radius**2 - inner**2), moment, moment)


def turn(shape: Shape) -> Shape:
    """The shape turned by a quarter: its width becomes its height."""
    corners = tuple((-h, w) for w, h in shape.corners)
    return Shape(shape.area, shape.ww, shape.hh, -shape.hw, corners=corners, half_axes=shape.half_axes[::-1])


def make_tube(outer: float, inner: float = 0.0) -> Shape:
    """A ring, or a disc; outer, inner: radii. ValueError if they are not in order."""
    if not 0.0 <= inner < outer < LARGEST:
        raise ValueError(f"has the radii {outer:g} and {inner:g}")
    moment = math.pi * (outer**4 - inner**4) / 4.0
    return Shape(math.pi * (outer**2 - inner**2), moment, moment, half_axes=(outer, outer))


def make_ellipse(width: float, height: float) -> Shape:
    """A solid ellipse with the axes width and height. ValueError if they are not positive."""
    if not (0.0 < width < LARGEST and 0.0 < height < LARGEST):
        raise ValueError(f"has the axes {width:g} and {height:g}")
    area = math.pi * width * height / 4.0
    return Shape(area, area * height**2 / 16.0, area * width**2 / 16.0, half_axes=(width / 2.0, height / 2.0))
