"""Sections, materials and masses of Abaqus and CalculiX decks: *BEAM SECTION, *BEAM GENERAL SECTION, *SOLID SECTION of
trusses; *MATERIAL with *ELASTIC and *DENSITY; *MASS, *ROTARY INERTIA.

The height of a section lies along its 2-direction, the width along its 1-direction: hh is Abaqus' I11, and ww its I22.
Source: Abaqus 2016, Keywords Reference Guide; Analysis User's Guide, "Beam cross-section library".
"""

import math
from collections.abc import Callable, Container, Mapping, Sequence

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.abaqus_blocks import Block, check_rows, read_real, read_reals
from sprung_tools.mesh_import.abaqus_keywords import find_words
from sprung_tools.mesh_import.frame_properties import Material, Section, Shape, are_possible
from sprung_tools.mesh_import.section_shapes import (
    make_angle,
    make_box,
    make_ellipse,
    make_hexagonal_tube,
    make_i,
    make_rectangle,
    make_trapezoid,
    make_tube,
    make_walls,
)

SECTION_BLOCKS = {"BEAM SECTION", "BEAM GENERAL SECTION", "SOLID SECTION"}
MATERIAL_BLOCKS = {"MATERIAL", "ELASTIC", "DENSITY"}
MASS_BLOCKS = {"MASS", "ROTARY INERTIA"}
NUMBERS = {  # parameters that are numbers
    "BEAM SECTION": ("POISSON", "OFFSET1", "OFFSET2"),
    "BEAM GENERAL SECTION": ("DENSITY", "POISSON", "ZERO", "OFFSET1", "OFFSET2"),
    "MASS": ("ALPHA", "COMPOSITE"),
    "ROTARY INERTIA": ("ALPHA", "COMPOSITE"),
}
DEFAULT_WIDTH = (0.0, 0.0, -1.0)  # the 1-direction of a section that gives none

MOST_WALLS = 10_000  # segments of an ARBITRARY section
OFF_AXIS = 1e-6  # distance of the centroid from the nodes that is told, relative to the root of the area

# Type of section → number of its dimensions, and the shape that they make, about the section's origin at the nodes.
SHAPES: dict[str, tuple[int, Callable[..., Shape]]] = {
    "RECT": (2, make_rectangle),
    "BOX": (6, lambda a, b, right, top, left, bottom: make_box(a, b, left, right, top, bottom)),
    "CIRC": (1, make_tube),
    "PIPE": (2, lambda radius, wall: make_tube(radius, radius - wall)),
    "THICK PIPE": (2, lambda radius, wall: make_tube(radius, radius - wall)),
    "I": (7, lambda low, height, bottom, top, under, over, web: lower(
        make_i(height, bottom, top, web, under, over), low - height / 2.0)),
    "L": (4, make_angle),
    "HEX": (2, make_hexagonal_tube),
    "TRAPEZOID": (4, lambda bottom, height, top, low: lower(make_trapezoid(bottom, height, top), low)),
}  # fmt: skip


# The types of sections that are told from each other by their beginnings.
KINDS = (*SHAPES, "ARBITRARY", "ELBOW", "GENERAL", "LINEAR", "MESHED", "NONLINEAR GENERAL")


def find_kind(block: Block) -> str:
    """The type of a section. InputError if it gives none and has no default."""
    text = block.parameters.get("SECTION", "GENERAL" if block.keyword == "BEAM GENERAL SECTION" else "")
    if not text:
        block.fail("has no SECTION")
    found = find_words(text, KINDS)
    return found[0] if len(found) == 1 else text.upper()


def lower(shape: Shape, height: float) -> Shape:
    """The shape with its origin higher by a height."""
    return shape._replace(h=shape.h - height)


def read_row(block: Block, place: int) -> list[float]:
    """The numbers of a data line, blank ones as 0; none if there is no such line."""
    if place >= len(block.data):
        return []
    line, fields = block.data[place]
    return [read_real(block, line, text) if text else 0.0 for text in fields]


def read_section(
    block: Block, materials: Mapping[str, Material], types: Container[str] = ()
) -> tuple[Section, Floats, Material | None]:
    """Reads a section. Returns (section, its 1-direction [3], the material if the section gives one itself).

    materials: name in capitals → material of the deck; types: of the section's elements.
    """
    check_numbers(block)
    if block.keyword == "SOLID SECTION":
        area = (read_row(block, 0) or [0.0])[0]
        shape = Shape(area, 0.0, 0.0) if area > 0.0 else None
        section = Section(describe(block), block.parameters.get("MATERIAL", "").upper(), shape, False)
        return section, np.array(DEFAULT_WIDTH), None
    kind = find_kind(block)
    place = count_shape_lines(block, kind)  # of the 1-direction
    dimensions = read_row(block, 0) if kind != "MESHED" else []
    shape, remark = read_walls(block, place) if kind == "ARBITRARY" else make_shape(block, kind, dimensions)
    if kind != "MESHED":
        check_lines_behind(block, place)
    left_out = [remark] if remark else []
    if "NODAL THICKNESS" in block.parameters:
        shape = None
        left_out.append("its dimensions at the nodes, by *NODAL THICKNESS")
    if kind == "GENERAL" and "U1" in types and any(dimensions[4:5]):
        left_out.append(f"the shear coefficient of its elements U1, {dimensions[4]:g}")
    left_out += [f"its {key}" for key in ("OFFSET1", "OFFSET2") if read_parameter(block, key)]
    left_out += ["its taper: the section at the first end is taken"] if "TAPER" in block.parameters else []
    if read_parameter(block, "POISSON"):
        left_out.append("its POISSON, by which its area changes under large strains")
    if shape and math.hypot(shape.w, shape.h) > OFF_AXIS * math.sqrt(shape.area):
        left_out.append("the way from its nodes to its centroid")
    width = read_row(block, place)
    if block.keyword == "BEAM SECTION" and not any(width) and any(read_row(block, place + 1)):
        left_out.append("that CalculiX passes over its blank line: here it is the default 1-direction, as in Abaqus")
    direction = np.array((width + [0.0] * 3)[:3]) if any(width) else np.array(DEFAULT_WIDTH)
    text = f"{describe(block)}: {' × '.join(f'{one:g}' for one in dimensions)}"
    material = None
    if block.keyword == "BEAM GENERAL SECTION" and kind != "MESHED":
        material, remarks = read_own_material(block, place + 1, materials)
        left_out += remarks
    name = material.name if material else block.parameters.get("MATERIAL", "").upper()
    return Section(text, name, shape, True, 0.0, tuple(left_out)), direction, material


def count_shape_lines(block: Block, kind: str) -> int:
    """The number of data lines that give a section's dimensions."""
    if kind == "MESHED":
        return 0
    if kind != "ARBITRARY":
        return 2 if "TAPER" in block.parameters else 1
    count = (read_row(block, 0) or [0.0])[0]
    if not (1.0 <= count <= MOST_WALLS and count == int(count)):
        block.fail(f"ARBITRARY has {count:g} segments, expected a whole number from 1 to {MOST_WALLS}",
                   block.data[0][0] if block.data else None)  # fmt: skip
    return int(count)


def read_walls(block: Block, count: int) -> tuple[Shape | None, str]:
    """Reads the dimensions of an ARBITRARY section: number of segments, first point, then each further point with the
    thickness of the segment that ends there, one in a line. Returns (the shape or None, what is left out)."""
    rows = [read_row(block, place) for place in range(count)]
    rows[0] = rows[0][1:]
    points, walls = [], []
    for place, row in enumerate(rows):
        expected = 3 if place else 5
        if len(row) < expected:
            line = block.data[min(place, len(block.data) - 1)][0]
            block.fail(f"ARBITRARY has no coordinates and thickness of segment {place + 1} of {count}", line)
        points += [(row[0], row[1]), (row[2], row[3])] if place == 0 else [(row[0], row[1])]
        walls.append(row[expected - 1])
    try:
        return make_walls(points, walls), ""
    except ValueError as error:
        return None, f"the shape ARBITRARY, which {error}"


def check_lines_behind(block: Block, place: int) -> None:
    """Throws InputError if the lines behind a section's dimensions, from `place` on, are not what they should be: a
    1-direction; of a *BEAM SECTION numbers of integration points, of a *BEAM GENERAL SECTION moduli."""
    expected = f"{place} with the dimensions"
    for number, (line, fields) in enumerate(block.data[place:]):
        given = [text for text in fields if text]
        if number == 0 and len(given) > 3:
            block.fail(f"its 1-direction has {len(given)} numbers, expected 3; behind {expected}", line)
        if block.keyword == "BEAM SECTION" and number > 0:
            are_counts = number == 1 and all(text.isdecimal() for text in given)
            if given and not are_counts:
                found = "numbers of integration points, expected whole ones" if number == 1 else "a further data line"
                block.fail(f"has {found}; behind {expected} and the 1-direction", line)
        elif number > 0 and given and fields[0] and not read_real(block, line, fields[0]) > 0.0:
            found = f"Young's modulus is {fields[0]}, expected > 0"
            block.fail(f"its {found}; behind {expected} and the 1-direction", line)


def describe(block: Block) -> str:
    """A section for people: `*BEAM SECTION (line 12), RECT`."""
    return f"*{block.keyword} (line {block.line}) {block.parameters.get('SECTION', '')}".rstrip()


def make_shape(block: Block, kind: str, numbers: Sequence[float]) -> tuple[Shape | None, str]:
    """Returns (the shape or None, what is left out or assumed). numbers: of the section's first data line."""
    try:
        if kind in ("GENERAL", "LINEAR") and len(numbers) >= 4:
            area, i11, i12, i22 = numbers[:4]
            for name, value in (("area", area), ("I11", i11), ("I22", i22)):
                if value < 0.0:
                    block.fail(f"its {name} is {value:g}, expected ≥ 0", block.data[0][0])
            if not are_possible(i11, i22, i12):
                block.fail(f"its I12 is {i12:g}, but I12² ≤ I11·I22, which is {i11 * i22:g}", block.data[0][0])
            return (Shape(area, i11, i22, i12), "") if area > 0.0 else (None, "its area, which is not positive")
        count, make = SHAPES.get(kind, (0, None))
        most = {"CIRC": 2, "GENERAL": 7, "LINEAR": 7}.get(kind, count)
        if most and any(numbers[most:]):
            block.fail(f"its shape {kind} has {len(numbers)} numbers, expected {most} at most", block.data[0][0])
        if kind == "CIRC" and len([one for one in numbers if one]) == 2:
            return make_ellipse(numbers[0], numbers[1]), ""  # CalculiX: the lengths of both axes
        if make is None:
            return None, f"the shape {kind}"
        if kind == "BOX" and len(numbers) == 3:
            numbers = [*numbers, *[numbers[2]] * 3]
        if len(numbers) < count:
            return None, f"the shape {kind}, which has {len(numbers)} numbers, expected {count}"
        remark = "that CalculiX takes the number of a CIRC for a diameter: here it is a radius, as in Abaqus"
        return make(*numbers[:count]), remark if kind == "CIRC" else ""
    except ValueError as error:
        return None, f"the shape {kind}, which {error}"


def read_own_material(
    block: Block, place: int, materials: Mapping[str, Material]
) -> tuple[Material | None, list[str]]:
    """The material that a *BEAM GENERAL SECTION gives itself, and what of it is left out: E and G in the data line at
    `place`, and DENSITY; where it names a MATERIAL, this one with the section's DENSITY, and None without a DENSITY.
    POISSON is not the material's ratio, which follows from E and G."""
    name, density = f"SECTION OF {block.parameters.get('ELSET', '').upper()}", read_parameter(block, "DENSITY")
    if block.parameters.get("MATERIAL"):
        named = materials.get(block.parameters["MATERIAL"].upper())
        return named._replace(name=name, density=density) if named and density is not None else None, []
    left_out = ["its moduli at further temperatures"] if any(read_row(block, place + 1)) else []
    modulus, shear = (read_row(block, place) + [0.0, 0.0])[:2]
    ratio = modulus / (2.0 * shear) - 1.0 if modulus > 0.0 and shear > 0.0 else None
    if ratio is not None and not -1.0 < ratio <= 0.5:
        left_out.append(f"its shear modulus, {shear:g}, with which Poisson's ratio would be {ratio:.3g}")
        ratio = None
    return Material(name, modulus if modulus > 0.0 else None, ratio, density), left_out


def read_parameter(block: Block, key: str) -> float | None:
    """A parameter's number; None if it is not there. InputError if it is none."""
    text = block.parameters.get(key)
    return None if text is None else read_real(block, block.place, text, f"{key}=")


def check_numbers(block: Block) -> None:
    """Throws InputError if a parameter is no number that should be one, whether it is used here or not."""
    for key in NUMBERS.get(block.keyword, ()):
        read_parameter(block, key)


class Materials:
    """The materials of a deck, as their blocks come one after the other."""

    def __init__(self) -> None:
        self.found: dict[str, Material] = {}  # name in capitals → material
        self.left_behind: list[str] = []
        self._current = ""

    def read(self, block: Block) -> None:
        """Takes in a block of MATERIAL_BLOCKS."""
        if block.keyword == "MATERIAL":
            self._current = block.parameters.get("NAME", "").upper()
            if self._current in self.found:
                self.left_behind.append(f"the material {self._current} before {block.describe()}, which has its name")
            self.found[self._current] = Material(self._current, None)
            return
        row = read_row(block, 0)
        kind = block.parameters.get("TYPE", "ISOTROPIC").upper()
        is_other = "PORE FLUID" in block.parameters or not "ISOTROPIC".startswith(kind)
        if self._current not in self.found or not row or is_other:
            self.left_behind.append(block.describe())
            return
        material = self.found[self._current]
        if block.keyword == "ELASTIC":
            material = material._replace(youngs_modulus=row[0] or None, poissons_ratio=row[1] if row[1:] else None)
        else:
            material = material._replace(density=row[0] or None)
        self.found[self._current] = material
        if len(block.data) > 1:
            self.left_behind.append(f"{block.describe()}: its first line alone is taken")

    def end(self) -> None:
        """Ends the material that is being read: what follows does not belong to it."""
        self._current = ""


def read_mass(block: Block) -> tuple[float, Floats | None, str]:
    """Reads a *MASS or a *ROTARY INERTIA. Returns (mass, moments of inertia [3×3] or None, why it cannot be taken or
    an empty text). InputError if it has no number, or more than it can have."""
    check_numbers(block)
    kind = block.parameters.get("TYPE", "ISOTROPIC").upper()
    is_one_number = block.keyword == "MASS" and "ISOTROPIC".startswith(kind)
    what = "its mass" if block.keyword == "MASS" else "its moments of inertia"
    row = read_reals(block, 0, 1 if is_one_number else 6, what)
    if not row:
        block.fail(f"has no number of {what}")
    check_rows(block, 1, f"of {what}")
    if block.keyword == "MASS":
        return row[0], None, "" if is_one_number else f"its type is {kind}"
    i11, i22, i33, i12, i13, i23 = (row + [0.0] * 6)[:6]
    turned = "ORIENTATION" in block.parameters
    left_out = f"its axes are those of the orientation {block.parameters['ORIENTATION']}" if turned else ""
    return 0.0, np.array([[i11, i12, i13], [i12, i22, i23], [i13, i23, i33]]), left_out


def calc_height(tangent: Floats, width: Floats) -> Floats:
    """The 2-direction [3] of a line along `tangent` with its 1-direction near `width`: t × n₁; NaN along the line."""
    height = np.cross(tangent, width)
    size = float(np.linalg.norm(height))
    return height / size if math.isfinite(size) and size > 0.0 else np.full(3, np.nan)
