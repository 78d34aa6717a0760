"""The shape and motion of a vehicle, from its results file alone, for the animation and ParaView.

A body is drawn by nodes and straight lines in its body frame. A body with a superelement has the superelement's nodes
and elements; a named point away from all nodes is joined to the node with which it moves. A rigid body has its named
points, joined to its origin.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_real
from sprung_tools.files.point_motion import BodyMotion, Motion, read_body_motion
from sprung_tools.files.point_motion import calc_motion as calc_point_motion
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import GROUND, Point, read_elements, read_points

Samples = Integers | Sequence[int]  # indices
End = tuple[str, int] | tuple[None, tuple[float, float]]  # body and node; None and (x, y) on the ground

SAME_PLACE = 1e-6  # share of the body's extent within which a point coincides with its node
UNDRAWN = ("center_of_mass",)
LINKS = {"spring": "spring", "rod": "rod", "pin": "joint"}  # drawing of an element between two points → kind of link


class DrawnBody(NamedTuple):
    """How a body is drawn: N nodes, L lines, n modes of the run (0: rigid)."""

    name: str
    places: Floats  # [N×2] m, undeformed, body frame
    lines: Integers  # [L×2] 0-based nodes; the superelement's elements come first
    shapes: Floats  # [N×2×n] m per unit amplitude
    points: dict[str, int]  # name of a point without its body → node
    num_elements: int  # of the superelement; 0 without one


class Wheel(NamedTuple):
    """A tyre: its circle about a node."""

    name: str
    body: str
    node: int
    radius: float  # m


class Link(NamedTuple):
    """An element drawn between two points: a spring-damper, a rod that keeps their distance, or a joint, which is drawn
    at its first point."""

    name: str
    kind: str  # spring, rod, joint
    ends: tuple[End, End]


def read_bodies(results: ResultsFile) -> list[DrawnBody]:
    """Reads all bodies of a run, in the order of their names. InputError if there is none."""
    names = results.names("model/bodies")
    if not names:
        raise InputError(f"{results.path}: error: no bodies in 'model/bodies'")
    return [read_body(results, name) for name in names]


def read_body(results: ResultsFile, name: str) -> DrawnBody:
    """Reads one body."""
    points = {point: one for point, one in read_points(results, name).items() if point not in UNDRAWN}
    superelement = results.superelement(name)
    if not superelement:
        return join_to_origin(name, {point: one.position for point, one in points.items()})
    return join_to_nodes(results, name, superelement, points)


def join_to_origin(name: str, points: Mapping[str, Floats]) -> DrawnBody:
    """A rigid body: lines from its origin to its points."""
    others = {point: place for point, place in points.items() if np.any(place != 0.0)}
    places = np.array([(0.0, 0.0), *others.values()])
    lines = np.array([(0, node) for node in range(1, len(places))], dtype=int).reshape(-1, 2)
    numbers = {point: 0 for point in points} | {point: node for node, point in enumerate(others, start=1)}
    return DrawnBody(name, places, lines, np.zeros((len(places), 2, 0)), numbers, 0)


def join_to_nodes(results: ResultsFile, name: str, superelement: str, points: Mapping[str, Point]) -> DrawnBody:
    """A body with a superelement: its elements, and lines to the points away from all nodes."""
    where = f"model/superelements/{superelement}"
    places, _ = read_numbers(results.file, f"{where}/node_positions")
    elements = read_numbers(results.file, f"{where}/elements")[0].astype(int)
    chosen = results.mode_numbers(name) - 1
    shapes = read_numbers(results.file, f"{where}/shapes")[0][:, :, chosen]
    extent = np.linalg.norm(np.ptp(places, axis=0))
    numbers: dict[str, int] = {}
    new_places: list[Floats] = []
    new_lines: list[tuple[int, int]] = []
    new_shapes: list[Floats] = []
    for point, one in points.items():
        node = one.node if one.node >= 0 else int(np.argmin(np.linalg.norm(places - one.position, axis=1)))
        if np.linalg.norm(one.position - places[node]) <= SAME_PLACE * extent:
            numbers[point] = node
            continue
        numbers[point] = len(places) + len(new_places)
        new_places.append(one.position)
        new_lines.append((node, numbers[point]))
        new_shapes.append(one.shapes[:2])
    count = len(new_places)
    return DrawnBody(
        name,
        np.concatenate([places, np.reshape(new_places, (count, 2))]),
        np.concatenate([elements, np.array(new_lines, dtype=int).reshape(count, 2)]),
        np.concatenate([shapes[:, :2], np.reshape(new_shapes, (count, 2, len(chosen)))]),
        numbers,
        len(elements),
    )


def calc_motion(results: ResultsFile, body: DrawnBody, samples: Samples, magnification: float = 1.0) -> Motion:
    """The positions, velocities and accelerations of a body's nodes in some samples."""
    state = BodyMotion(*(values[samples] for values in read_body_motion(results.file, body.name)))
    return calc_point_motion(state, body.places, body.shapes, magnification)


def read_wheels(results: ResultsFile, bodies: Sequence[DrawnBody]) -> list[Wheel]:
    """Reads the tyres."""
    wheels = []
    for force in read_elements(results, "forces").values():
        if force.drawing == "wheel":
            body, node = find_point(force.points["wheel"], bodies, {}) or (None, None)
            if isinstance(body, str) and isinstance(node, int):
                wheels.append(Wheel(force.name, body, node, force.parameters["radius"]))
    return wheels


def read_links(results: ResultsFile, bodies: Sequence[DrawnBody]) -> list[Link]:
    """Reads what is drawn between two points: springs, rods and joints. Coupled springs have two pairs of points."""
    ground = read_points(results, GROUND)
    links = []
    for group in ("forces", "joints"):
        for element in read_elements(results, group).values():
            if element.drawing not in LINKS:
                continue
            ends = [find_point(point, bodies, ground) for point in element.points.values()]
            for first, second in zip(ends[::2], ends[1::2]):
                if first is not None and second is not None:
                    links.append(Link(element.name, LINKS[element.drawing], (first, second)))
    return links


def find_point(reference: str, bodies: Sequence[DrawnBody], ground: Mapping[str, Point]) -> End | None:
    """Finds the point that `body.point` refers to; None for a point that is not drawn."""
    body_name, _, point = reference.partition(".")
    if body_name == GROUND and point in ground:
        x, y = ground[point].position
        return None, (float(x), float(y))
    for body in bodies:
        if body.name == body_name and point in body.points:
            return body.name, body.points[point]
    return None


def read_road(results: ResultsFile) -> tuple[Floats, Floats] | None:
    """Reads the road as x [k], height [k] m in world axes, ascending in x; None if the file has none."""
    if not results.file.has_group("model/road"):
        return None
    distance, height = (read_numbers(results.file, f"model/road/{name}")[0] for name in ("distance", "height"))
    origin, direction = (read_real(results.file, "model/road", name) for name in ("origin", "direction"))
    x = (distance + origin) / direction
    order = np.argsort(x, kind="stable")
    return x[order], height[order]
