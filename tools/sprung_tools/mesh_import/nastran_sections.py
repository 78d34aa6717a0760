"""Sections, materials and masses of Nastran decks: PBAR, PBARL, PBEAM, PBEAML, PROD, PTUBE, CONROD; MAT1; CONM2.

The height of a section lies along y of its element, in plane 1: hh is Nastran's I1, and ww its I2.
Source: MSC Nastran, Quick Reference Guide, "Bulk Data Entries".
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.frame_properties import Material, PointMass, Section, Shape, are_possible
from sprung_tools.mesh_import.nastran_cards import Card
from sprung_tools.mesh_import.section_shapes import (
    make_angle,
    make_box,
    make_channel,
    make_closed_hat,
    make_double_box,
    make_hat,
    make_hexagon,
    make_i,
    make_pair,
    make_rectangle,
    make_tube,
    make_z,
    mirror,
    turn,
)

# Type of PBARL and PBEAML → number of its dimensions, and the shape that they make. The figures of the guide have z to
# the right, and our width is to its other side.
SHAPES: dict[str, tuple[int, Callable[..., Shape]]] = {
    "ROD": (1, make_tube),
    "TUBE": (2, make_tube),
    "TUBE2": (2, lambda radius, wall: make_tube(radius, radius - wall)),
    "BAR": (2, make_rectangle),
    "BOX": (4, lambda width, height, flange, web: make_box(width, height, web, web, flange, flange)),
    "BOX1": (6, lambda width, height, top, bottom, left, right: make_box(width, height, left, right, top, bottom)),
    "I": (6, lambda height, bottom, top, web, under, over: make_i(height, bottom, top, web, under, over)),
    "I1": (4, lambda out, web, inner, height: make_i(height, out + web, out + web, web, *2 * ((height - inner) / 2,))),
    "T": (4, lambda width, height, flange, web: make_i(height, 0.0, width, web, 0.0, flange)),
    "T2": (4, lambda width, height, flange, web: make_i(height, width, 0.0, web, flange, 0.0)),
    "T1": (4, lambda width, height, flange, web: turn(make_i(height + flange, width, 0.0, web, flange, 0.0))),
    "H": (4, lambda inner, legs, height, bar: make_pair(inner, bar, legs / 2, height)),
    "CHAN": (4, make_channel),
    "CHAN1": (4, lambda out, web, inner, height: make_channel(out + web, height, web, (height - inner) / 2)),
    "CHAN2": (4, lambda leg, plate, height, width: turn(make_channel(height, width, plate, leg))),
    "CROSS": (4, lambda out, upright, height, bar: make_pair(upright, height, out / 2, bar)),
    "L": (4, lambda width, height, lying, upright: mirror(make_angle(width, height, lying, upright))),
    "Z": (4, lambda flange, web, inner, height: mirror(make_z(flange, web, inner, height))),
    "HAT": (4, make_hat),
    "HAT1": (5, make_closed_hat),
    "HEXA": (3, lambda slant, width, height: make_hexagon(width, height, slant)),
    "DBOX": (10, lambda width, height, middle, left, inner, right, *rest: mirror(
        make_double_box(width, height, middle, (left, inner, right), (rest[0], rest[1]), (rest[2], rest[3])))),
}  # fmt: skip
WITH_OTHER_CENTRE = {"T", "T1", "T2", "CHAN", "CHAN1", "CHAN2", "L", "HAT", "HAT1", "DBOX"}
EQUAL_DIMENSIONS = {"I": ((1, 2), (4, 5)), "BOX1": ((2, 3), (4, 5))}  # with which the shear centre is the centroid
SECTION_CARDS = {"PBAR", "PBARL", "PBEAM", "PBEAML", "PROD", "PTUBE"}
MATERIAL_CARDS = {"MAT1"}
MASS_CARDS = {"CONM2"}
SAME_PLACE = 1e-9  # relative to the node's distance from the origin, within which a mass is at its node


def read_section(card: Card) -> Section:
    """Reads a property of bars, beams, rods or tubes. InputError if a number is none."""
    text = f"{card.name} {card.field(0)}"
    material = card.field(1)
    if card.name == "PBAR":
        moments = [card.real(place, "second moment") for place in (3, 4, 18)]
        shape = make_general(card, card.real(2, "area"), moments)
        left_out = ["shear flexibility (K1, K2)"] if any(card.field(place) for place in (16, 17)) else []
        return Section(text, material, shape, True, card.real(6, "mass per length"), tuple(left_out))
    if card.name == "PBEAM":
        return read_beam_section(card, text, material)
    if card.name in ("PBARL", "PBEAML"):
        return read_shaped_section(card, text, material)
    if card.name == "PTUBE":
        diameter, wall = card.real(2, "diameter"), card.real(3, "wall")
        shape = make_shape(make_tube, [diameter / 2.0, max(diameter / 2.0 - wall, 0.0) if wall else 0.0])
        other = card.real(5, "diameter") if card.field(5) else diameter
        taper = (f"its taper to the diameter {other:g}: the section at end A is taken",) if other != diameter else ()
        return Section(text, material, shape, False, card.real(4, "mass per length"), taper)
    shape = make_general(card, card.real(2, "area"), [0.0, 0.0, 0.0])
    return Section(text, material, shape, False, card.real(5, "mass per length"))


def read_rod_section(card: Card) -> Section:
    """Reads the section that a CONROD has itself."""
    shape = make_general(card, card.real(4, "area"), [0.0, 0.0, 0.0])
    return Section(f"CONROD {card.field(0)}", card.field(3), shape, False, card.real(7, "mass per length"))


def make_general(card: Card, area: float, moments: Sequence[float]) -> Shape | None:
    """A shape from its numbers: area; I1, I2, I12 with z to the other side than w. None without an area. InputError if
    one is negative that must not be, or if no section has such moments."""
    first, second, product = moments
    for name, value in (("area", area), ("I1", first), ("I2", second)):
        if value < 0.0:
            card.fail(f"its {name} is {value:g}, expected ≥ 0")
    if not are_possible(first, second, product):
        card.fail(f"its I12 is {product:g}, but I12² ≤ I1·I2, which is {first * second:g}")
    return Shape(area, first, second, -product) if area > 0.0 else None


def make_shape(make: Callable[..., Shape], dimensions: Sequence[float]) -> Shape | None:
    """A shape from its dimensions; None where these make none."""
    try:
        return make(*dimensions)
    except ValueError:
        return None


def read_shaped_section(card: Card, text: str, material: str) -> Section:
    """Reads a PBARL, or a PBEAML at its end A."""
    kind = card.field(3).upper() or card.field(2).upper()
    count, make = SHAPES.get(kind, (0, None))
    dimensions = [card.real(place, "dimension") for place in range(8, 8 + count)]
    text = f"{text}, {kind} {' × '.join(f'{one:g}' for one in dimensions)}".strip()
    if make is None:
        return Section(text, material, None, left_out=(f"the shape {kind}, and the mass per length behind it",))
    shape = make_shape(make, dimensions)
    rest = [one for one in card.fields[8 + count + 1 :] if one]
    left_out: tuple[str, ...] = ()
    if card.name == "PBEAML" and rest:
        left_out = ("its further stations, with their mass per length: the section at end A is taken",)
    if card.name == "PBARL" and any(card.is_filled(k) for k in range(8 + count + 1, len(card.fields))):
        left_out += ("what stands behind its mass per length",)
    unequal = any(dimensions[a] != dimensions[b] for a, b in EQUAL_DIMENSIONS.get(kind, ()))
    if unequal or kind in WITH_OTHER_CENTRE:
        left_out += ("the way from its shear centre, where Nastran has the axis, to its centroid",)
    return Section(text, material, shape, True, card.real(8 + count, "mass per length"), left_out)


def read_beam_section(card: Card, text: str, material: str) -> Section:
    """Reads a PBEAM at its end A."""
    moments = [card.real(place, "second moment") for place in (3, 4, 5)]
    left_out, place = compare_stations(card)
    # Behind the stations stand K1, K2, S1, S2, NSI(A), NSI(B), CW(A), CW(B), then M1(A), M2(A), M1(B), …, N2(B).
    for what, places in (
        ("its torsion constant (J)", range(6, 7)),
        ("its stress points (C1 to F2)", range(0) if is_station(card, 8) else range(8, 16)),
        ("the relief of shear by its taper (S1, S2)", range(place + 2, place + 4)),
        ("the moment of inertia of its non-structural mass (NSI)", range(place + 4, place + 6)),
        ("its warping (CW)", range(place + 6, place + 8)),
        ("the offsets of its mass and its neutral axis from its shear centre (M1, M2, N1, N2)",
         range(place + 8, place + 16)),
        ("what stands behind these fields", range(place + 16, len(card.fields))),
    ):  # fmt: skip
        if any(card.is_filled(k) for k in places):
            left_out.append(what)
    return Section(
        text, material, make_general(card, card.real(2, "area"), moments), True, card.real(7, "mass per length"),
        (*left_out, "shear flexibility (K1, K2 are 1 unless given)"),
    )  # fmt: skip


def compare_stations(card: Card) -> tuple[list[str], int]:
    """Returns (what of the further stations of a PBEAM differs from end A, the place behind them).

    A station begins with whether there are stresses; then follow its place and the numbers of end A again, which are
    those of end A where they are blank. Behind YES stands a line of stress points.
    """
    left_out: dict[str, None] = {}
    place = 8 if is_station(card, 8) else 16
    while is_station(card, place):
        given = [k for k in (2, 3, 4, 5, 7) if card.field(place + k)]
        changed = [k for k in given if card.real(place + k, "number") != card.real(k, "number")]
        if set(changed) - {7}:
            left_out["its taper: the section at end A is taken"] = None
        if 7 in changed:
            there, here = card.real(place + 7, "number"), card.real(7, "number")
            text = f"its non-structural mass of {there:g} per length at a further station: that of end A, {here:g}"
            left_out[f"{text}, is taken"] = None
        has_points = card.field(place).upper() == "YES" and not is_station(card, place + 8)
        place += 16 if has_points else 8
    return list(left_out), place


def is_station(card: Card, place: int) -> bool:
    """Whether a station of a PBEAM begins at a place."""
    return card.field(place).upper() in ("YES", "YESA", "NO")


def read_material(card: Card) -> tuple[Material, list[str]]:
    """Reads a MAT1. Without E it follows from G and ν; without ν it follows from E and G. Returns (the material, what
    is left out of it)."""
    modulus, shear, ratio, density = (card.real(place, "number") for place in (1, 2, 3, 4))
    given_ratio = ratio if card.field(3) else None
    if not modulus and shear and given_ratio is not None:
        modulus = 2.0 * shear * (1.0 + given_ratio)
    if given_ratio is None and modulus and shear:
        given_ratio = modulus / (2.0 * shear) - 1.0
        if not -1.0 < given_ratio <= 0.5:
            left_out = f"G = {shear:g} of MAT1 {card.field(0)}, with which Poisson's ratio would be {given_ratio:.3g}"
            return Material(card.field(0), modulus, None, density or None), [left_out]
    return Material(card.field(0), modulus or None, given_ratio, density or None), []


def read_mass(card: Card, number: Mapping[int, int], find_node: Callable[[Card, int], Floats]) -> PointMass:
    """Reads a CONM2. InputError if its node is not there.

    number: id of a node → its 0-based number; find_node: the position of a node in the basic system [3], by its id.
    """
    node = card.integer(1, "node")
    if node not in number:
        card.fail(f"names node {node}, which is not there: truncated?")
    offset = np.array([card.real(place, "offset") for place in (4, 5, 6)])
    system = card.integer(2, "coordinate system", 0)
    if system == -1:  # the numbers are the mass's position, and its axes are those of the basic system
        position = find_node(card, node)
        offset = offset - position
        offset[np.abs(offset) <= SAME_PLACE * np.linalg.norm(position)] = 0.0
    i11, i21, i22, i31, i32, i33 = (card.real(place, "moment of inertia") for place in range(8, 14))
    inertia = np.array([[i11, -i21, -i31], [-i21, i22, -i32], [-i31, -i32, i33]])
    reason = ""
    if np.any(offset):
        reason = f"it is away from its node by {', '.join(f'{one:g}' for one in offset)}"
    elif system > 0 and np.any(inertia):
        reason = f"its moments of inertia are in coordinate system {card.field(2)}"
    return PointMass(f"CONM2 {card.field(0)} at node {node}", number[node], card.real(3, "mass"), inertia, reason)
