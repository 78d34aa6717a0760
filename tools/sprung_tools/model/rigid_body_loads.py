"""The bending moment in a body that a run took as rigid, from the forces on it, its own inertia and its superelement.

Without the deformation in the motion, the modal equations (bodies, eqs. 3–5) become a statics problem. Its loads are
the forces F and torques T on the points and d'Alembert's forces of the rigid motion:

    K η = Σ (Φᵀ Aᵀ F + φᵀ T) + Pᵀ Aᵀ (g − R̈) − c θ̈ + d θ̇²,   moments = Σ resultants_k η_k                  (1)

Φ and φ are the displacement and the rotation of a point by the modes. The results file holds the forces and torques of
joints and force elements on each of their points. (1) takes all modes of the superelement, so η is the finite element
solution.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import SUPERELEMENT, open_hdf5, read_numbers, read_text
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import Point, read_elements, read_gravity, read_point

MOMENTS = (2, 5)  # the places of M among the resultants N, Q, M at both ends of an element


class Superelement(NamedTuple):
    """The part of a superelement file (reduce/superelement/superelement.md) that (1) needs: n modes, N nodes, E
    elements."""

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


def read_superelement(path: str | Path) -> Superelement:
    """Reads a superelement file for (1). InputError if it cannot be used."""
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
        )


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


def collect_loads(results: ResultsFile, body: str) -> list[tuple[Point, Floats]]:
    """The loads on a body's points: (point, [m×3] force x, y and torque, world axes)."""
    loads: list[tuple[Point, Floats]] = []

    def add(name: str, dataset: str) -> None:
        point = read_point(results, name)
        if point.body == body:
            loads.append((point, read_numbers(results.file, dataset)[0]))

    for joint in read_elements(results, "joints").values():
        for role, dataset in (("a", "reaction"), ("b", "reaction_b")):
            add(joint.points[role], f"joints/{joint.name}/{dataset}")
    for force in read_elements(results, "forces").values():
        for role, name in force.points.items():
            add(name, f"forces/{force.name}/on_{role}")
    return loads


def calc_rigid_moments(results: ResultsFile, body: str, superelement: Superelement) -> tuple[Floats, Floats]:
    """The bending moments of a rigid body by (1). Returns (moments [m×stations] N·m, stations [stations×2] m) in the
    layout of /recovery: both ends of each element. InputError if the superelement is not the run's.
    """
    check_same(results, body, superelement)
    position, _ = read_numbers(results.file, f"bodies/{body}/position")
    velocity, _ = read_numbers(results.file, f"bodies/{body}/velocity")
    acceleration, _ = read_numbers(results.file, f"bodies/{body}/acceleration")
    angle = position[:, 2]
    loads = turn_into_body(read_gravity(results) - acceleration[:, :2], angle) @ superelement.P
    loads -= np.outer(acceleration[:, 2], superelement.c)
    loads += np.outer(velocity[:, 2] ** 2, superelement.d)
    for point, wrench in collect_loads(results, body):
        shape = calc_point_shape(point, superelement)
        loads += turn_into_body(wrench[:, :2], angle) @ shape[:2] + np.outer(wrench[:, 2], shape[2])
    amplitudes = np.linalg.solve(superelement.stiffness, loads.T).T
    moments = amplitudes @ superelement.resultants[:, MOMENTS, :].reshape(-1, superelement.stiffness.shape[0]).T
    return moments, superelement.positions[superelement.elements].reshape(-1, 2)
