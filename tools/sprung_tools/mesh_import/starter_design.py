"""A starter design for a converted mesh: what the source says of materials, sections and masses, for people to
complete.

What the source does not say, or what a planar frame cannot hold, stands in it as a comment. Numbers that are not known
are left out, so that sprung-reduce refuses the design until somebody gives them.
"""

import json
import math
import os
from collections.abc import Iterable

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.frame_properties import Material, PointMass
from sprung_tools.mesh_import.line_mesh import LineMesh
from sprung_tools.mesh_import.plane_frame import PlaneFrame
from sprung_tools.mesh_import.plane_section import PlaneSection, choose_section
from sprung_tools.mesh_import.units import Units

ALL_MODES = 300  # freedoms up to which the starter design asks for all modes
FEW_MODES = 12  # that it asks for beyond
UNKNOWN = "unknown"  # name of the material of sections whose material the source does not say
WIDTH = 118  # of a comment's lines
LIKELY_MODULI = (1e8, 2e12)  # Pa, of materials of frames
LIKELY_DENSITIES = (10.0, 3e4)  # kg/m³, from foam to what is heavier than any metal


def format_design(mesh: LineMesh, frame: PlaneFrame, plane: str, units: Units, mesh_name: str) -> str:
    """The text of the design. mesh_name: the mesh's file beside it."""
    name = os.path.splitext(mesh_name)[0]
    sections = {curve: choose_section(mesh, lines, plane) for curve, lines in frame.curves.items()}
    left_out = [*frame.remarks, *mesh.left_behind, *list_left_out(mesh, frame, plane, units)]
    points, masses, _ = list_masses(mesh, frame, plane, units)
    reference = name_reference(frame, points)
    parts = [
        make_comment(f"Starter design of {os.path.basename(mesh.path)} ({mesh.format}), written by tools/convert_mesh: "
                     f"complete it, then run sprung-reduce build. {units.describe()}"),
        [f"name = {quote(name)}", f"mesh = {quote(mesh_name)}", 'theory = "euler-bernoulli"  # or "timoshenko"'],
        *(format_material(material, units) for material in list_materials(mesh, sections.values())),
        *(format_section(curve, section, mesh, units) for curve, section in sections.items()),
        ["[points]", *points] if points else [],
        *masses,
        [
            "[reference]", f"point = {quote(reference)}  # the node nearest to the middle of all lines",
            'condition = "clamped"',
        ],
        ["[modes]", choose_modes(frame), "damping_ratio = 0.01  # chosen"],
        [line for text in ("Not taken from the source:", *left_out) for line in make_comment(text)] if left_out else [],
    ]  # fmt: skip
    return "\n\n".join("\n".join(part) for part in parts if part) + "\n"


def list_left_out(mesh: LineMesh, frame: PlaneFrame, plane: str, units: Units) -> list[str]:
    """What of the masses and sections is not in the design, a text each."""
    texts = list_masses(mesh, frame, plane, units)[2]
    for curve, lines in frame.curves.items():
        texts += [f"of section '{curve}': {text}" for text in choose_section(mesh, lines, plane).left_out]
    return texts


def quote(text: str) -> str:
    """A text as TOML's basic string."""
    return json.dumps(text, ensure_ascii=False)


def make_comment(text: str) -> list[str]:
    """A text as comment lines."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + len(word) > WIDTH:
            lines.append("  ")
        lines[-1] += word if lines[-1] in ("", "  ") else f" {word}"
    return [f"# {line}" for line in lines]


def choose_modes(frame: PlaneFrame) -> str:
    """All modes of a small frame; a few of a large one."""
    return "all = true" if 3 * (len(frame.node_ids) - 1) <= ALL_MODES else f"count = {FEW_MODES}"


def list_materials(mesh: LineMesh, sections: Iterable[PlaneSection]) -> list[Material]:
    """The materials of the sections, each once."""
    unknown = Material(UNKNOWN, None)
    found = (mesh.materials.get(section.material, unknown) for section in sections)
    return list({material.name: material for material in found}.values())


def name_material(name: str) -> str:
    """A material's name in the design: a Nastran number gets a word before it."""
    return f"material_{name}" if name.isdecimal() else name


def format_number(key: str, value: float | None, unit: str, unknown: str = "the source does not say") -> str:
    """A key with its number; as a comment where it is not known. unknown: why it is not."""
    if value is None or not math.isfinite(value):
        why = unknown if value is None else "the source's number is too large"
        return f"# {key} =   # {unit}: {why}"
    return f"{key} = {float(value)!r}"


def format_material(material: Material, units: Units) -> list[str]:
    """A material's table."""
    modulus = None if material.youngs_modulus is None else units.stress * material.youngs_modulus
    density = None if material.density is None else units.density * material.density
    lines = [f"[materials.{quote(name_material(material.name))}]", format_number("youngs_modulus", modulus, "Pa")]
    lines.append(format_number("density", density, "kg/m³"))
    if material.poissons_ratio is not None:
        lines.append(format_number("poissons_ratio", material.poissons_ratio, ""))
    return lines


def format_section(curve: str, section: PlaneSection, mesh: LineMesh, units: Units) -> list[str]:
    """A section's table."""
    lines = make_comment(section.text) if section.text else []
    lines.append(f"[sections.{quote(curve)}]")
    known = section.material in mesh.materials
    lines.append(f"material = {quote(name_material(section.material) if known else UNKNOWN)}")
    area = None if section.area is None else units.length**2 * section.area
    moment = None if section.second_moment is None else units.length**4 * section.second_moment
    lines.append(format_number("area", area, "m²"))
    left_open = "the source does not say" if area is None else "why not, is said at the end of this file"
    lines.append(format_number("second_moment", moment, "m⁴, for bending in the plane", left_open))
    if section.section_modulus is not None:
        lines.append(format_number("section_modulus", units.length**3 * section.section_modulus, "m³"))
    density = mesh.materials[section.material].density if known else None
    if section.extra_mass:
        lines += format_mass_per_length(area, density, units.mass_per_length * section.extra_mass, units)
    if section.members != 1:
        lines.append(f"count = {section.members}")
    return lines


def format_mass_per_length(area: float | None, density: float | None, extra: float, units: Units) -> list[str]:
    """The mass per length of a section with non-structural mass. area [m²], extra [kg/m], density in the source's unit.

    A source without a density has this mass alone, so the design has it, too. Without an area it is left open.
    """
    if density is None:
        text = "the non-structural mass alone, since the source gives no density: with one, add density · area"
        return [*make_comment(text), format_number("mass_per_length", extra, "kg/m")]
    if area is None:
        return [f"# mass_per_length =   # kg/m: density · area, and {extra:.9g} of non-structural mass"]
    return [format_number("mass_per_length", units.density * density * area + extra, "kg/m")]


def list_masses(
    mesh: LineMesh, frame: PlaneFrame, plane: str, units: Units
) -> tuple[list[str], list[list[str]], list[str]]:
    """Returns (lines of [points], tables of the masses, remarks on those that are not taken)."""
    names = {node: name for name, node in reversed(frame.points.items())}
    number = {int(node): place for place, node in enumerate(frame.node_ids)}
    normal = ({0, 1, 2} - {"xyz".index(axis) for axis in plane}).pop()
    points: list[str] = []
    tables: list[list[str]] = []
    remarks: list[str] = []
    for one in mesh.point_masses:
        place = number.get(int(mesh.node_ids[one.node]))
        if one.left_out or place is None or one.mass < 0.0:
            why = one.left_out or ("its node has no line" if place is None else "it is < 0")
            remarks.append(f"{one.text}, {describe_size(one, units)}: {why}")
            continue
        if place not in names:
            names[place] = make_name(f"node_{frame.node_ids[place]}", frame)
            points.append(format_point(names[place], frame.positions[place]))
        inertia = 0.0 if one.inertia is None else units.inertia * float(one.inertia[normal, normal])
        tables.append([
            *make_comment(one.text), "[[point_masses]]", f"point = {quote(names[place])}",
            f"mass = {float(units.mass * one.mass)!r}", f"inertia = {inertia!r}",
        ])  # fmt: skip
    return points, tables, remarks


def describe_size(one: PointMass, units: Units) -> str:
    """A mass for people, or its moments of inertia where it has these alone."""
    if one.mass or one.inertia is None:
        return f"{units.mass * one.mass:g} kg"
    return f"moments of inertia up to {units.inertia * float(np.max(np.abs(one.inertia))):g} kg m²"


def make_name(wanted: str, frame: PlaneFrame) -> str:
    """A name that no point of the mesh has."""
    while wanted in frame.points:
        wanted += "_"
    return wanted


def format_point(name: str, position: Floats) -> str:
    """A line of [points]."""
    return f"{quote(name)} = [{float(position[0])!r}, {float(position[1])!r}]"


def name_reference(frame: PlaneFrame, points: list[str]) -> str:
    """The name of the node nearest to the middle of all lines. Adds it to the lines of [points] if it has none yet."""
    ends = frame.positions[frame.lines]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    middle = lengths @ ends.mean(axis=1) / lengths.sum()
    node = int(np.argmin(np.linalg.norm(frame.positions - middle, axis=1)))
    for name, place in frame.points.items():
        if place == node:
            return name
    name = make_name("reference", frame)
    points.append(format_point(name, frame.positions[node]))
    return name


def find_doubts(mesh: LineMesh, frame: PlaneFrame, units: Units) -> list[str]:
    """What makes it doubtful that the source's units were given right: sizes, moduli and densities that no vehicle's
    frame has."""
    doubts = []
    extent = float(np.max(np.ptp(frame.positions, axis=0)))
    if extent > 100.0:
        doubts.append(f"the frame is {extent:g} m long: if its unit is the millimetre, give --scale 1e-3")
    elif extent < 1e-2:
        doubts.append(f"the frame is {extent:g} m long: see --scale")
    used = {mesh.sections[k].material for k in np.unique(mesh.section_of) if k >= 0}
    for name in sorted(used & set(mesh.materials)):
        modulus, density = mesh.materials[name].youngs_modulus, mesh.materials[name].density
        if modulus is not None and not is_within(LIKELY_MODULI, units.stress * modulus):
            doubts.append(
                f"Young's modulus of '{name}' is {units.stress * modulus:.3g} Pa: are length and force in metres and "
                "newtons? See --scale and --force"
            )
        if density is not None and not is_within(LIKELY_DENSITIES, units.density * density):
            doubts.append(
                f"the density of '{name}' is {units.density * density:.3g} kg/m³: is it in units of mass, here of "
                f"{units.mass:g} kg, and not of weight? See --scale and --force"
            )
    return doubts


def is_within(bounds: tuple[float, float], value: float) -> bool:
    """Whether a value is between two bounds."""
    return bounds[0] <= value <= bounds[1]
