"""The bending moment in a body that a run took as rigid: from the forces on it and its own inertia, by its superelement.

With the deformation left out of the motion, the modal equations (bodies, eqs. 3–5) become a statics
problem, the loads being the forces F on the points and d'Alembert's forces of the rigid motion:

    K η = Σ Φᵀ Aᵀ F + Pᵀ Aᵀ (g − R̈) − c θ̈ + d θ̇²,   moments = Σ resultants_k η_k                           (1)

All modes of the superelement take part, so η is the finite element solution.
"""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import SUPERELEMENT, open_hdf5, read_numbers, text_of
from sprung_tools.model.model_texts import read_vehicle_file

MOMENTS = (2, 5)  # of the resultants N, Q, M at both ends of an element


class Superelement(NamedTuple):
    """What (1) needs of a file (reduce/superelement/superelement.md): n modes, N nodes, E elements."""

    path: str
    content_hash: str
    stiffness: np.ndarray  # n×n, 1/s²
    resultants: np.ndarray  # E×6×n
    shape: np.ndarray  # N×3×n
    positions: np.ndarray  # N×2, m
    elements: np.ndarray  # E×2, nodes
    points: dict  # name → node
    P: np.ndarray  # 2×n
    c: np.ndarray  # n
    d: np.ndarray  # n


def read_superelement(path):
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


def check_same(results, body, superelement):
    """InputError if a superelement is not the one that a body had in its run."""
    name = text_of(results.file[f"model/bodies/{body}"].attrs.get("superelement", ""))
    kept = results.file.get(f"model/superelements/{name}") if name else None
    if kept is None or text_of(kept.attrs.get("content_hash", "")) != superelement.content_hash:
        raise InputError(
            f"{superelement.path}: error: is not the superelement that '{body}' had in {results.path} (another content hash)"
        )


def calc_point_shape(vehicle, body, point, superelement):
    """Displacement of a point of a body by each mode [2×n]; an offset from a node turns with it."""
    described = vehicle["bodies"][body].get("points", {}).get(point, {"node": point})
    node = superelement.points[described["node"]] if isinstance(described, dict) else None
    if node is None:
        raise KeyError(point)
    x, y = described.get("offset", (0.0, 0.0))
    rotation = superelement.shape[node, 2]
    return superelement.shape[node, :2] + np.array([[-y], [x]]) * rotation


def turn_into_body(vectors, angle):
    """World vectors [m×2] in the axes of a body that is turned by angle [m]: Aᵀ v."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack(
        [cos * vectors[:, 0] + sin * vectors[:, 1], cos * vectors[:, 1] - sin * vectors[:, 0]], axis=1
    )


def collect_loads(results, vehicle, body):
    """The forces on a body's points: a list of (point, world force [m×2]). InputError if a kind not known here, or a
    torque, acts on the body; what acts on others does not matter."""
    loads = []

    def add(reference, force):
        owner, _, point = reference.partition(".")
        if owner == body:
            loads.append((point, force))

    def acts_on_body(*references):
        return any(reference.partition(".")[0] == body for reference in references)

    joints = {joint["name"]: joint for joint in vehicle.get("joints", ())}
    for motion in vehicle.get("motions", ()):
        driven = joints.get(motion.get("joint"), {"a": motion.get("point", ""), "b": ""})
        if acts_on_body(driven["a"], driven["b"]):
            raise InputError(
                f"{results.path}: error: motion '{motion['name']}' drives '{body}', not known here"
            )
    for joint in joints.values():
        if not acts_on_body(joint["a"], joint["b"]):
            continue
        reaction, _ = read_numbers(results.file, f"joints/{joint['name']}/reaction")
        if np.any(np.abs(reaction[:, 2]) > 1e-9 * max(1.0, np.max(np.abs(reaction)))):
            raise InputError(
                f"{results.path}: error: joint '{joint['name']}' carries a torque, not known here"
            )
        add(joint["a"], reaction[:, :2])
        add(joint["b"], -reaction[:, :2])
    for force in vehicle.get("forces", ()):
        if not acts_on_body(*(force.get(end, "") for end in ("a", "b", "wheel", "point"))):
            continue
        group = f"forces/{force['name']}"
        if force["type"] in ("tyre", "spring-damper"):
            values, _ = read_numbers(results.file, f"{group}/force")
        if force["type"] == "tyre":
            longitudinal = np.zeros_like(values)
            if f"{group}/longitudinal_force" in results.file:
                longitudinal, _ = read_numbers(results.file, f"{group}/longitudinal_force")
            add(force["wheel"], np.stack([longitudinal, values], axis=1))
        elif force["type"] == "spring-damper":
            a, b = (read_numbers(results.file, f"points/{force[end]}/position")[0] for end in "ab")
            along = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
            add(force["a"], -values[:, None] * along)
            add(force["b"], values[:, None] * along)
        else:
            raise InputError(
                f"{results.path}: error: force '{force['name']}' of type '{force['type']}' not known here"
            )
    return loads


def calc_rigid_moments(results, body, superelement):
    """Bending moments of a rigid body by (1). Returns (moments [m×stations] N·m, stations [stations×2] m) in the
    layout of /recovery: both ends of each element. InputError if the superelement is another than the run's.
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
            raise InputError(
                f"{results.path}: error: '{body}.{point}' is no node of the superelement"
            ) from error
        loads += turn_into_body(force, angle) @ shape
    amplitudes = np.linalg.solve(superelement.stiffness, loads.T).T
    moments = (
        amplitudes @ superelement.resultants[:, MOMENTS, :].reshape(-1, superelement.stiffness.shape[0]).T
    )
    return moments, superelement.positions[superelement.elements].reshape(-1, 2)
