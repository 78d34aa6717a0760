"""The bending moment in a body that a run took as rigid, from the forces on it, its own inertia and its superelement.

The loads are the forces F and torques T on the points, in body axes, and d'Alembert's forces of the rigid motion. With
the section loads L of unit loads, which the file of a superelement has (reduce, "Section loads"), the moments are those
of the finite element model; sprung-dynamics computes the same (section_loads, eq. 2):

    moments = Σ (L_x F_x + L_y F_y + L_ψ T) + (L_ax, L_ay)·Aᵀ(R̈ − g) + L_α θ̈ + L_ω θ̇²                   (1)

A file without them has the modal equations without the deformation in the motion (bodies, eqs. 3–5), a statics problem:

    K η = Σ (Φᵀ Aᵀ F + φᵀ T) + Pᵀ Aᵀ (g − R̈) − c θ̈ + d θ̇²,   moments = Σ resultants_k η_k                  (2)

Φ and φ are the displacement and the rotation of a point by the modes. (2) is exact but for the load on an element times
its length if the file has as many vectors as the model has freedoms. With fewer, its moments are those of these vectors
alone, and mostly too small. The results file holds the forces and torques of joints and force elements on each of their
points.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import SUPERELEMENT, open_hdf5, read_numbers, read_text
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.files.stored_file import StoredFile
from sprung_tools.model.resolved_model import Point, read_elements, read_gravity, read_point

MOMENTS = (2, 5)  # the places of M among the resultants N, Q, M at both ends of an element


class SectionLoads(NamedTuple):
    """The moments of unit loads, S stations: both ends of each element."""

    point_load: Floats  # S×3p, N·m per N, N, N·m on the node of each named point
    acceleration: Floats  # S×4, N·m per m/s², m/s², rad/s², rad²/s²


class Superelement(NamedTuple):
    """The part of a superelement file (reduce/superelement/superelement.md) that (1) and (2) need: n modes, N nodes, E
    elements, p points."""

    path: str
    content_hash: str
    stiffness: Floats  # n×n, 1/s²
    resultants: Floats  # E×6×n
    shape: Floats  # N×3×n
    positions: Floats  # N×2, m
    elements: Integers  # E×2, nodes
    P: Floats  # 2×n
    c: Floats  # n
    d: Floats  # n
    mass: float  # kg
    point_nodes: Integers  # p
    num_freedoms: int  # of the finite element model
    section_loads: SectionLoads | None  # None: the file has none


def read_superelement(path: str | Path) -> Superelement:
    """Reads a superelement file for (1) and (2). InputError if it cannot be used."""
    with open_hdf5(str(path), SUPERELEMENT) as file:
        return Superelement(
            path=str(path),
            content_hash=read_text(file, "", "content_hash", ""),
            stiffness=read_numbers(file, "matrices/stiffness")[0],
            resultants=read_numbers(file, "resultants")[0],
            shape=read_numbers(file, "modes/shape")[0],
            positions=read_numbers(file, "nodes/position")[0],
            elements=read_numbers(file, "elements/node")[0].astype(int),
            P=read_numbers(file, "inertia/P")[0],
            c=read_numbers(file, "inertia/c")[0],
            d=read_numbers(file, "inertia/d")[0],
            mass=float(read_numbers(file, "inertia/mass")[0][0]),
            point_nodes=read_numbers(file, "points/node")[0].astype(int),
            num_freedoms=file.attribute("", "num_elastic_dofs", int),
            section_loads=read_section_loads(file),
        )


def read_section_loads(file: StoredFile) -> SectionLoads | None:
    """Reads the moments of unit loads; None if the file has none."""
    if not file.has_group("section_loads"):
        return None
    found = [read_numbers(file, f"section_loads/{name}")[0][:, MOMENTS, :] for name in SectionLoads._fields]
    return SectionLoads(*(values.reshape(-1, values.shape[2]) for values in found))


def has_all_loads(superelement: Superelement) -> bool:
    """Whether the moments of a rigid body are those of the finite element model: by (1), or by (2) with all vectors."""
    return superelement.section_loads is not None or superelement.stiffness.shape[0] >= superelement.num_freedoms


def check_same(results: ResultsFile, body: str, superelement: Superelement) -> None:
    """Throws InputError if a superelement is not the one that a body had in its run."""
    name = results.superelement(body)
    kept = f"model/superelements/{name}"
    is_kept = name != "" and results.file.has_group(kept)
    if not is_kept or read_text(results.file, kept, "content_hash", "") != superelement.content_hash:
        raise InputError(
            f"{superelement.path}: error: is not the superelement that '{body}' had in {results.path} "
            "(another content hash)"
        )


def calc_point_shape(point: Point, superelement: Superelement) -> Floats:
    """The displacement and rotation of a point by each mode [3×n]: those of its node, with which an offset turns; 0 for
    a point that moves with the body frame."""
    if point.node < 0:
        return np.zeros((3, superelement.stiffness.shape[0]))
    shape = superelement.shape[point.node].copy()
    x, y = point.position - superelement.positions[point.node]
    shape[:2] += np.array([[-y], [x]]) * shape[2]
    return shape


def turn_into_body(vectors: Floats, angle: Floats) -> Floats:
    """World vectors [m×2] in the axes of a body that is turned by angle [m]: Aᵀ v."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([cos * vectors[:, 0] + sin * vectors[:, 1], cos * vectors[:, 1] - sin * vectors[:, 0]], axis=1)


def list_loads(results: ResultsFile, body: str) -> list[tuple[Point, str]]:
    """The loads on a body's points: (point, dataset [m×3] of force x, y and torque, world axes)."""
    named = [
        (joint.points[role], f"joints/{joint.name}/{dataset}")
        for joint in read_elements(results, "joints").values()
        for role, dataset in (("a", "reaction"), ("b", "reaction_b"))
    ]
    named += [
        (name, f"forces/{force.name}/on_{role}")
        for force in read_elements(results, "forces").values()
        for role, name in force.points.items()
    ]
    loads = [(read_point(results, name), dataset) for name, dataset in named]
    return [(point, dataset) for point, dataset in loads if point.body == body]


def find_common_rows(results: ResultsFile, body: str) -> int:
    """The number of outputs from one row to the next at which all that the moments follow from is stored: loads that
    are interpolated do not balance a motion that is not."""
    motion = [f"bodies/{body}/{what}" for what in ("position", "velocity", "acceleration")]
    every = [results.file.every(name) for name in [*motion, *(dataset for _, dataset in list_loads(results, body))]]
    return int(np.lcm.reduce(every))


def calc_rigid_moments(results: ResultsFile, body: str, superelement: Superelement) -> tuple[Floats, Floats]:
    """The bending moments of a rigid body by (1), or by (2) where the file of its superelement has no section loads.
    Returns (moments [m×stations] N·m, stations [stations×2] m) in the layout of /recovery: both ends of each element.
    They hold at the rows that find_common_rows() tells. InputError if the superelement is not the run's.
    """
    check_same(results, body, superelement)
    motion = read_motion(results, body)
    wrenches = [
        (point, np.column_stack([turn_into_body(wrench[:, :2], motion.angle), wrench[:, 2]]))
        for point, wrench in ((point, read_numbers(results.file, name)[0]) for point, name in list_loads(results, body))
    ]  # fmt: skip
    if superelement.section_loads is None:
        moments = calc_modal_moments(motion, wrenches, superelement)
    else:
        moments = calc_section_moments(motion, wrenches, superelement, superelement.section_loads)
    return moments, superelement.positions[superelement.elements].reshape(-1, 2)


class RigidMotion(NamedTuple):
    """The motion of a rigid body [m]."""

    angle: Floats  # rad
    acceleration: Floats  # [m×2] of the origin less gravity, body axes, m/s²
    angular: Floats  # rad/s²
    rate_squared: Floats  # rad²/s²


Wrenches = list[tuple[Point, Floats]]  # point, [m×3] force x, y and torque, body axes


def read_motion(results: ResultsFile, body: str) -> RigidMotion:
    """Reads the motion of a rigid body."""
    position, velocity, acceleration = (
        read_numbers(results.file, f"bodies/{body}/{what}")[0] for what in ("position", "velocity", "acceleration")
    )
    relative = turn_into_body(acceleration[:, :2] - read_gravity(results), position[:, 2])
    return RigidMotion(position[:, 2], relative, acceleration[:, 2], velocity[:, 2] ** 2)


def calc_section_moments(
    motion: RigidMotion, wrenches: Wrenches, superelement: Superelement, unit: SectionLoads
) -> Floats:
    """The moments by (1). A force at the centre of mass is spread as the mass is; a load on the body frame acts where
    the body is held."""
    causes = np.column_stack([motion.acceleration, motion.angular, motion.rate_squared])
    moments = causes @ unit.acceleration.T
    for point, wrench in wrenches:
        if point.node >= 0:
            first = 3 * int(np.flatnonzero(superelement.point_nodes == point.node)[0])
            x, y = point.position - superelement.positions[point.node]
            torque = wrench[:, 2] + x * wrench[:, 1] - y * wrench[:, 0]
            on_node = np.column_stack([wrench[:, :2], torque])
            moments += on_node @ unit.point_load[:, first : first + 3].T
        elif point.name.endswith(".center_of_mass"):
            moments -= wrench[:, :2] @ unit.acceleration[:, :2].T / superelement.mass
    return moments


def calc_modal_moments(motion: RigidMotion, wrenches: Wrenches, superelement: Superelement) -> Floats:
    """The moments by (2)."""
    loads = -motion.acceleration @ superelement.P
    loads -= np.outer(motion.angular, superelement.c)
    loads += np.outer(motion.rate_squared, superelement.d)
    for point, wrench in wrenches:
        loads += wrench @ calc_point_shape(point, superelement)
    amplitudes = np.linalg.solve(superelement.stiffness, loads.T).T
    by_mode = superelement.resultants[:, MOMENTS, :].reshape(-1, superelement.stiffness.shape[0])
    return np.asarray(amplitudes @ by_mode.T)
