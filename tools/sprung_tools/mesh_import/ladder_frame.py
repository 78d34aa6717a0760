"""A three-dimensional frame with two equal rails, united into the vehicle's middle plane.

The in-plane motion of a frame that is symmetric about the plane is symmetric, too: mirror images move together, and no
node leaves its distance from the plane in first order. So a line and its mirror image become one line of two parallel
members. A member that runs straight across turns as a whole with its ends: it is a mass with a moment of inertia about
its own axis. Its bending between its ends, and its torsion in unsymmetric motion, are left out. So are members that run
across at an angle, but for their mass (carried_masses.py).
"""

import dataclasses
import math
from collections.abc import Iterator
from typing import NoReturn

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.carried_masses import Carriers, merge_masses
from sprung_tools.mesh_import.equal_sections import find_difference
from sprung_tools.mesh_import.frame_properties import PointMass, Section
from sprung_tools.mesh_import.line_mesh import LineMesh, shorten
from sprung_tools.mesh_import.place_index import PlaceIndex

SAME_PLACE = 1e-6  # share of the frame's extent within which mirror images, and projections of nodes, coincide
SAME_MOMENT = 1e-9  # relative
IN_MIDDLE = "_middle"  # ends the name of a set's lines in the middle plane where it has double ones, too


class Mirror:
    """A mesh and its mirror images. InputError if it is not symmetric."""

    def __init__(self, mesh: LineMesh, plane: str) -> None:
        self.mesh, self.plane = mesh, plane
        (self.normal,) = {0, 1, 2} - {"xyz".index(axis) for axis in plane}
        used = np.unique(mesh.lines)
        across = mesh.positions[used, self.normal]
        self.middle = float(across.min() + across.max()) / 2.0
        self.near = SAME_PLACE * float(np.linalg.norm(np.ptp(mesh.positions[used], axis=0)))
        self.image = self.find_images(used)
        self.partner = self.find_partners()

    def find_images(self, used: Integers) -> dict[int, int]:
        """The mirror image of each node in use."""
        index = PlaceIndex(self.mesh.positions, used, self.near)
        image = {}
        for node in used.tolist():
            place = self.mesh.positions[node].copy()
            place[self.normal] = 2.0 * self.middle - place[self.normal]
            found = index.find(place)
            if found is None:
                x, y, z = self.mesh.positions[node]
                axis = "xyz"[self.normal]
                raise InputError(
                    f"{self.mesh.path}: error: node {self.mesh.node_ids[node]} at ({x:.9g}, {y:.9g}, {z:.9g}) has no "
                    f"mirror image: the frame is not symmetric about {axis} = {self.middle:.9g} within {self.near:.2g}"
                )
            image[node] = found
        return image

    def find_partners(self) -> Integers:
        """The mirror image of each line [E]."""
        at: dict[frozenset[int], list[int]] = {}
        for line, ends in enumerate(self.mesh.lines.tolist()):
            at.setdefault(frozenset(ends), []).append(line)
        partner = np.full(len(self.mesh.lines), -1)
        for line, (a, b) in enumerate(self.mesh.lines.tolist()):
            images = at.get(frozenset((self.image[a], self.image[b])), [])
            own = at[frozenset((a, b))]
            if len(images) != len(own):
                self.fail(line, "has no mirror image")
            partner[line] = images[own.index(line)]
            difference = find_difference(self.mesh, line, int(partner[line]), self.plane)
            if difference:
                self.fail(line, f"and its mirror image {self.mesh.line_ids[partner[line]]} {difference}")
        return partner

    def fail(self, line: int, what: str) -> NoReturn:
        """Throws InputError that names a line."""
        raise InputError(
            f"{self.mesh.path}: error: element {self.mesh.line_ids[line]} {what}: the frame is not symmetric about "
            f"{'xyz'[self.normal]} = {self.middle:.9g}"
        )


class Kinds:
    """What the lines are [E each]: rails of which one of two is kept, lines in the middle plane, members straight
    across, members across at an angle."""

    def __init__(self, mirror: Mirror) -> None:
        mesh = mirror.mesh
        across = mesh.positions[mesh.lines][:, :, mirror.normal] - mirror.middle
        way = mesh.positions[mesh.lines[:, 1]] - mesh.positions[mesh.lines[:, 0]]
        way[:, mirror.normal] = 0.0
        side = np.where(np.abs(across) <= mirror.near, 0, np.sign(across))
        self.straight = np.linalg.norm(way, axis=1) <= mirror.near
        self.middle = ~self.straight & np.all(side == 0, axis=1)
        self.rail = ~self.straight & (side[:, 0] == side[:, 1]) & (side[:, 0] != 0)
        self.kept_rail = self.rail & (side[:, 0] > 0)
        self.oblique = ~(self.straight | self.middle | self.rail)
        self.kept = self.kept_rail | self.middle


def unite_rails(mesh: LineMesh, plane: str) -> LineMesh:
    """Unites a ladder frame into its middle plane. InputError if it is not symmetric, or has no lines beside the
    plane."""
    if len(mesh.lines) == 0:
        return mesh
    mirror = Mirror(mesh, plane)
    kinds = Kinds(mirror)
    if not np.any(kinds.rail):
        raise InputError(f"{mesh.path}: error: no lines on both sides of {'xyz'[mirror.normal]} = {mirror.middle:.9g}")
    united = unite_nodes(mirror, kinds)
    kept = np.flatnonzero(kinds.kept)
    place = {int(line): number for number, line in enumerate(kept)}
    counts = np.where(kinds.rail[kept], 2, 1)
    masses, mass_remarks = list_masses(mirror, kinds)
    carriers = Carriers(mesh, united, kept, np.flatnonzero(kinds.oblique), plane, mirror.near)
    point_masses = [*carriers.carry(mesh.point_masses), *merge_masses(carriers.carry(masses))]
    positions = mesh.positions.copy()
    positions[:, mirror.normal] = mirror.middle
    sets, set_remarks = map_sets(mesh, mirror, kinds, place)
    stays = united == np.arange(len(united))  # the others are one with these
    node = np.cumsum(stays)[united] - 1
    return dataclasses.replace(
        mesh,
        node_ids=mesh.node_ids[stays],
        positions=positions[stays],
        line_ids=mesh.line_ids[kept],
        lines=node[mesh.lines[kept]],
        element_sets=sets,
        node_sets={name: np.unique(node[nodes]) for name, nodes in mesh.node_sets.items()},
        section_sets=tuple(name for name in sets if name.removesuffix(IN_MIDDLE) in mesh.section_sets),
        section_of=mesh.section_of[kept],
        heights=mesh.heights[kept],
        counts=counts,
        point_masses=[one._replace(node=int(node[one.node])) for one in point_masses],
        left_behind=[
            *describe(mirror, kinds), *carriers.describe(), *list_one_sided(mirror), *mass_remarks, *set_remarks,
            *mesh.left_behind,
        ],
    )


def unite_nodes(mirror: Mirror, kinds: Kinds) -> Integers:
    """For each node [N] the one that stands for it: mirror images are one, and the nodes of a member straight across
    are."""
    parent = np.arange(len(mirror.mesh.node_ids))

    def find(node: int) -> int:
        while parent[node] != node:
            parent[node] = parent[parent[node]]
            node = int(parent[node])
        return node

    straight: list[tuple[int, int]] = [(a, b) for a, b in mirror.mesh.lines[kinds.straight].tolist()]
    for a, b in [*mirror.image.items(), *straight]:
        low, high = sorted((find(a), find(b)))
        parent[high] = low
    return np.array([find(node) for node in range(len(parent))], dtype=int)


def find_mass(mesh: LineMesh, line: int) -> tuple[float, Section] | None:
    """A line's mass per length, and its section; None if the source does not say."""
    if mesh.section_of[line] < 0:
        return None
    section = mesh.sections[mesh.section_of[line]]
    material = mesh.materials.get(section.material)
    if section.shape is None or material is None or material.density is None:
        return None
    return material.density * section.shape.area + section.extra_mass, section


def list_masses(mirror: Mirror, kinds: Kinds) -> tuple[list[PointMass], list[str]]:
    """Returns (the masses in place of the members across, at their own ends; remarks)."""
    mesh = mirror.mesh
    masses: list[PointMass] = []
    unknown: list[int] = []
    for line in np.flatnonzero(kinds.straight | kinds.oblique).tolist():
        found = find_mass(mesh, line)
        if found is None:
            unknown.append(int(mesh.line_ids[line]))
            continue
        per_length, section = found
        ends = mesh.lines[line]
        length = float(np.linalg.norm(mesh.positions[ends[1]] - mesh.positions[ends[0]]))
        inertia = np.zeros((3, 3))
        shape, density = section.shape, mesh.materials[section.material].density
        if kinds.straight[line] and shape is not None and density is not None:
            inertia[mirror.normal, mirror.normal] = density * (shape.hh + shape.ww) * length / 2.0
        text = f"half of element {mesh.line_ids[line]} across, {section.text}"
        masses += [PointMass(text, int(end), per_length * length / 2.0, inertia) for end in ends]
    remarks = [f"masses of members across, whose section is not known: {shorten(unknown)}"] if unknown else []
    return masses, remarks


def list_one_sided(mirror: Mirror) -> list[str]:
    """Remarks on point masses that the mirror image of their node does not have."""
    mesh = mirror.mesh
    masses: dict[int, float] = {}
    for one in mesh.point_masses:
        masses[one.node] = masses.get(one.node, 0.0) + one.mass
    unlike = [
        int(mesh.node_ids[node])
        for node, mass in masses.items()
        if not math.isclose(mass, masses.get(mirror.image.get(node, node), 0.0), rel_tol=SAME_MOMENT)
    ]
    if not unlike:
        return []
    return [f"rolling, which masses cause that have no equal one on the other side: nodes {shorten(unlike)}"]


def map_sets(
    mesh: LineMesh, mirror: Mirror, kinds: Kinds, place: dict[int, int]
) -> tuple[dict[str, Integers], list[str]]:
    """Returns (the element sets with the united lines, those with kept lines first; remarks). place: kept line → its
    new number. A set with single and double lines is divided."""
    sets: dict[str, Integers] = {}
    remarks: list[str] = []
    for name, members in sorted(mesh.element_sets.items(), key=lambda item: not np.any(kinds.kept[item[1]])):
        rails = members[kinds.rail[members]]
        double = {place[int(line if kinds.kept[line] else mirror.partner[line])] for line in rails}
        single = {place[line] for line in members.tolist() if kinds.middle[line]}
        if double:
            sets[name] = np.array(sorted(double), dtype=int)
        if single:
            sets[name + IN_MIDDLE if double else name] = np.array(sorted(single), dtype=int)
        if double and single:
            remarks.append(f"element set '{name}': its lines in the middle plane are now in '{name}{IN_MIDDLE}'")
        if not double and not single and len(members):
            remarks.append(f"element set '{name}': all its lines run across")
    return sets, remarks


def describe(mirror: Mirror, kinds: Kinds) -> Iterator[str]:
    """Yields what was united, and what was left out."""
    mesh = mirror.mesh
    axis = "xyz"[mirror.normal]
    pairs, single = np.count_nonzero(kinds.kept_rail), np.count_nonzero(kinds.middle)
    yield (
        f"two rails about {axis} = {mirror.middle:g} united: {pairs} pairs of lines are one line of two members each; "
        f"{single} lines in the middle plane are single"
    )
    if np.any(kinds.straight):
        yield (
            f"bending and torsion of {np.count_nonzero(kinds.straight)} lines straight across, which are masses with a "
            f"moment of inertia about their axis: {shorten(mesh.line_ids[kinds.straight])}"
        )
    if np.any(kinds.oblique):
        found = shorten(mesh.line_ids[kinds.oblique])
        yield f"the stiffness of lines across at an angle: {found}; half of their mass is at each end"
    way: Floats = np.diff(mesh.positions[mesh.lines[kinds.kept_rail]], axis=1)[:, 0]
    sine = float(np.max(np.abs(way[:, mirror.normal]) / np.linalg.norm(way, axis=1), initial=0.0))
    if sine > SAME_PLACE:
        shorter = 100.0 * (1.0 - np.sqrt(max(1.0 - sine**2, 0.0)))
        yield (
            f"the angle of rails to the plane, up to {np.degrees(np.arcsin(min(sine, 1.0))):.2g}°: they are projected, "
            f"and become shorter by up to {shorter:.2g} %"
        )
