"""The bending moment in a body that a run took as rigid, from the forces on it, its own inertia and its superelement.

Without the deformation in the motion, the modal equations (bodies, eqs. 3–5) become a statics problem. Its loads are
the forces F on the points and d'Alembert's forces of the rigid motion:

    K η = Σ Φᵀ Aᵀ F + Pᵀ Aᵀ (g − R̈) − c θ̈ + d θ̇²,   moments = Σ resultants_k η_k                           (1)

It takes all modes of the superelement, so η is the finite element solution.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import SUPERELEMENT, open_hdf5, read_numbers, text_of
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.model_texts import read_vehicle_file

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
    points: dict[str, int]  # name → node
    P: Floats  # 2×n
    c: Floats  # n
    d: Floats  # n


def read_superelement(path: str | Path) -> Superelement:
    """Reads a superelement file for (1). InputError if it cannot be used."""
    with open_hdf5(str(path), SUPERELEMENT) as file:
        names = [text_of(name) for name in file["points/name"]]
        return Superelement(
            path=str(path),
            content_hash=text_of(file.attrs.get("content_hash", "")),
            stiffness=read_numbers(file, "matrices/stiffness")[0],
            resultants=read_numbers(file, "resultants")[0],
            shape=read_numbers(file, "modes/shape")[0],
            positions=read_numbers(file, "nodes/position")[0],
            elements=read_numbers(file, "elements/node")[0].astype(int),
            points=dict(zip(names, read_numbers(file, "points/node")[0].astype(int))),
            P=read_numbers(file, "inertia/P")[0],
            c=read_numbers(file, "inertia/c")[0],
            d=read_numbers(file, "inertia/d")[0],
        )


def check_same(results: ResultsFile, body: str, superelement: Superelement) -> None:
    """Throws InputError if a superelement is not the one that a body had in its run."""
    name = results.superelement(body)
    kept = results.file.get(f"model/superelements/{name}") if name else None
    if kept is None or text_of(kept.attrs.get("content_hash", "")) != superelement.content_hash:
        raise InputError(
            f"{superelement.path}: error: is not the superelement that '{body}' had in {results.path} "
            "(another content hash)"
        )


def calc_point_shape(vehicle: dict[str, Any], body: str, point: str, superelement: Superelement) -> Floats:
    """The displacement of a body's point by each mode [2×n]; an offset from a node turns with the node.

    KeyError if the superelement does not have the point.
    """
    described = vehicle["bodies"][body].get("points", {}).get(point, {"node": point})
    node = superelement.points[described["node"]] if isinstance(described, dict) else None
    if node is None:
        raise KeyError(point)
    x, y = described.get("offset", (0.0, 0.0))
    rotation = superelement.shape[node, 2]
    return superelement.shape[node, :2] + np.array([[-y], [x]]) * rotation


def turn_into_body(vectors: Floats, angle: Floats) -> Floats:
    """World vectors [m×2] in the axes of a body that is turned by angle [m]: Aᵀ v."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([cos * vectors[:, 0] + sin * vectors[:, 1], cos * vectors[:, 1] - sin * vectors[:, 0]], axis=1)


Load = tuple[str, Floats]  # point, world force [m×2]


def owns(body: str, reference: str) -> bool:
    """Whether a reference `body.point` is to a body."""
    return reference.partition(".")[0] == body


def collect_loads(results: ResultsFile, vehicle: dict[str, Any], body: str) -> list[Load]:
    """The forces on a body's points. InputError if a torque, or a kind of force that is not known here, acts on the
    body; other bodies do not matter."""
    pairs = [*collect_reactions(results, vehicle, body), *collect_forces(results, vehicle, body)]
    return [(reference.partition(".")[2], force) for reference, force in pairs if owns(body, reference)]


def collect_reactions(results: ResultsFile, vehicle: dict[str, Any], body: str) -> Iterator[Load]:
    """Yields the reactions of the joints at a body, at both of a joint's ends."""
    joints = {joint["name"]: joint for joint in vehicle.get("joints", ())}
    for motion in vehicle.get("motions", ()):
        driven = joints.get(motion.get("joint"), {"a": motion.get("point", ""), "b": ""})
        if owns(body, driven["a"]) or owns(body, driven["b"]):
            raise InputError(f"{results.path}: error: motion '{motion['name']}' drives '{body}', not known here")
    for joint in joints.values():
        if not (owns(body, joint["a"]) or owns(body, joint["b"])):
            continue
        reaction, _ = read_numbers(results.file, f"joints/{joint['name']}/reaction")
        if np.any(np.abs(reaction[:, 2]) > 1e-9 * max(1.0, np.max(np.abs(reaction)))):
            raise InputError(f"{results.path}: error: joint '{joint['name']}' carries a torque, not known here")
        yield joint["a"], reaction[:, :2]
        yield joint["b"], -reaction[:, :2]


def collect_forces(results: ResultsFile, vehicle: dict[str, Any], body: str) -> Iterator[Load]:
    """Yields the tyre forces and the spring-damper forces at a body, at both of a spring-damper's ends."""
    for force in vehicle.get("forces", ()):
        if not any(owns(body, force.get(end, "")) for end in ("a", "b", "wheel", "point")):
            continue
        group = f"forces/{force['name']}"
        if force["type"] == "tyre":
            values, _ = read_numbers(results.file, f"{group}/force")
            longitudinal = np.zeros_like(values)
            if f"{group}/longitudinal_force" in results.file:
                longitudinal, _ = read_numbers(results.file, f"{group}/longitudinal_force")
            yield force["wheel"], np.stack([longitudinal, values], axis=1)
        elif force["type"] == "spring-damper":
            values, _ = read_numbers(results.file, f"{group}/force")
            a, b = (read_numbers(results.file, f"points/{force[end]}/position")[0] for end in "ab")
            along = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
            yield force["a"], -values[:, None] * along
            yield force["b"], values[:, None] * along
        else:
            raise InputError(f"{results.path}: error: force '{force['name']}' of type '{force['type']}' not known here")


def calc_rigid_moments(results: ResultsFile, body: str, superelement: Superelement) -> tuple[Floats, Floats]:
    """The bending moments of a rigid body by (1). Returns (moments [m×stations] N·m, stations [stations×2] m) in the
    layout of /recovery: both ends of each element. InputError if the superelement is not the run's.
    """
    check_same(results, body, superelement)
    vehicle = read_vehicle_file(results)
    position, _ = read_numbers(results.file, f"bodies/{body}/position")
    velocity, _ = read_numbers(results.file, f"bodies/{body}/velocity")
    acceleration, _ = read_numbers(results.file, f"bodies/{body}/acceleration")
    angle = position[:, 2]
    gravity = np.array(vehicle.get("gravity", (0.0, -9.80665)))
    loads = turn_into_body(gravity - acceleration[:, :2], angle) @ superelement.P
    loads -= np.outer(acceleration[:, 2], superelement.c)
    loads += np.outer(velocity[:, 2] ** 2, superelement.d)
    for point, force in collect_loads(results, vehicle, body):
        try:
            shape = calc_point_shape(vehicle, body, point, superelement)
        except KeyError as error:
            raise InputError(f"{results.path}: error: '{body}.{point}' is no node of the superelement") from error
        loads += turn_into_body(force, angle) @ shape
    amplitudes = np.linalg.solve(superelement.stiffness, loads.T).T
    moments = amplitudes @ superelement.resultants[:, MOMENTS, :].reshape(-1, superelement.stiffness.shape[0]).T
    return moments, superelement.positions[superelement.elements].reshape(-1, 2)
