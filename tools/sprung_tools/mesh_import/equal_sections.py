"""Whether two lines of a mesh have sections that are the same in the plane, whatever the source calls these."""

import math

import numpy as np

from sprung_tools.mesh_import.frame_properties import Material, Section, Shape
from sprung_tools.mesh_import.line_mesh import LineMesh
from sprung_tools.mesh_import.plane_section import calc_in_plane

SAME = 1e-9  # relative

OTHER = "have different sections"
TURNED = "are turned in different ways"


def find_difference(mesh: LineMesh, line: int, other: int, plane: str) -> str:
    """What tells the sections of two lines from each other in the plane; empty if nothing does. Areas, second moments
    and the numbers of materials are compared, not names and descriptions."""
    sections = [find_section(mesh, one) for one in (line, other)]
    one, two = sections
    if one is None or two is None:
        return "" if one is two else OTHER
    if find_values(mesh, one) != find_values(mesh, two):
        return OTHER
    if one.shape is None or two.shape is None:
        return "" if one.shape is two.shape else OTHER
    if not are_same(one.shape.area, two.shape.area):
        return OTHER
    if not one.bends:
        return "" if are_same(one.shape.hh, two.shape.hh) else OTHER
    return compare_bending(mesh, (line, other), (one.shape, two.shape), plane)


def compare_bending(mesh: LineMesh, lines: tuple[int, int], shapes: tuple[Shape, Shape], plane: str) -> str:
    """What tells the bending of two lines in the plane from each other."""
    moments = []
    for line, shape in zip(lines, shapes):
        ends = mesh.positions[mesh.lines[line]]
        found = calc_in_plane(shape, ends[1:] - ends[:1], mesh.heights[[line]], plane)
        moments.append(None if found is None else float(found[0][0]))
    one, two = moments
    if one is None or two is None:  # how it is turned is not known
        return "" if have_same_integrals(*shapes) else OTHER
    if are_same(one, two):
        return ""
    return TURNED if have_same_integrals(*shapes) else OTHER


def find_section(mesh: LineMesh, line: int) -> Section | None:
    """A line's section; None if the source does not say."""
    return mesh.sections[mesh.section_of[line]] if mesh.section_of[line] >= 0 else None


def find_values(mesh: LineMesh, section: Section) -> tuple[Material | str, bool, float]:
    """What a section has beside its shape: the numbers of its material, or its name where it has none."""
    material = mesh.materials.get(section.material)
    return (material._replace(name="") if material else section.material), section.bends, section.extra_mass


def have_same_integrals(one: Shape, two: Shape) -> bool:
    """Whether two shapes have the same second moments, or are each other's mirror image."""
    pairs = ((one.hh, two.hh), (one.ww, two.ww), (abs(one.hw), abs(two.hw)))
    size = max(one.hh, one.ww)
    return all(math.isclose(a, b, rel_tol=SAME, abs_tol=SAME * size) for a, b in pairs)


def are_same(one: float, two: float) -> bool:
    """Whether two numbers are the same but for rounding."""
    return bool(np.isclose(one, two, rtol=SAME, atol=0.0))
