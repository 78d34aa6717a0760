"""How a vehicle looks and moves, from its results file alone: what the animation and ParaView draw.

A body is drawn by nodes and straight lines in its body frame. A body with a superelement has the superelement's nodes
and elements, and its named points away from nodes hang on their node; a rigid body has its named points, joined to its
origin. Nodes move with the body frame and the modes:

    r = R + A(θ) (u₀ + s Φη),   s the magnification of the deflection, 1 for where they are     (bodies, eq. 1)
"""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_attribute, read_numbers, text_of
from sprung_tools.model.resolved_model import GROUND, read_elements, read_points

HANGS_ON = 1e-6  # of the body's extent: a point nearer to its node than this is that node
UNDRAWN = ("center_of_mass",)
LINKS = {"spring": "spring", "rod": "rod", "pin": "joint"}  # drawings between two points: kinds of links


class DrawnBody(NamedTuple):
    """N nodes, L lines, n modes of the run (0: rigid)."""

    name: str
    places: np.ndarray  # [N×2] m, undeformed, body frame
    lines: np.ndarray  # [L×2] 0-based nodes; the superelement's elements come first
    shapes: np.ndarray  # [N×2×n] m per unit amplitude
    points: dict  # name of a point without its body → node
    num_elements: int  # of the superelement, 0 without one


class Motion(NamedTuple):
    """Of k samples and N nodes, world axes."""

    position: np.ndarray  # [k×N×2] m, with the deflection magnified
    velocity: np.ndarray  # [k×N×2] m/s
    acceleration: np.ndarray  # [k×N×2] m/s²


class Wheel(NamedTuple):
    """A tyre: its circle about a node."""

    name: str
    body: str
    node: int
    radius: float  # m


class Link(NamedTuple):
    """What is drawn between two points: a spring-damper, a rod that keeps their distance, or a joint, whose place is
    that of its first point."""

    name: str
    kind: str  # spring, rod, joint
    ends: tuple  # two (body, node), or (None, (x, y)) on the ground


def read_bodies(results):
    """All bodies of a run, in the order of their names. InputError if there is none."""
    names = results.names("model/bodies")
    if not names:
        raise InputError(f"{results.path}: error: no bodies in 'model/bodies'")
    return [read_body(results, name) for name in names]


def read_body(results, name):
    group = results.file[f"model/bodies/{name}"]
    points = {point: one for point, one in read_points(results, name).items() if point not in UNDRAWN}
    superelement = text_of(group.attrs.get("superelement", ""))
    if not superelement:
        return join_to_origin(name, {point: one.position for point, one in points.items()})
    return hang_on_nodes(results, name, superelement, points)


def join_to_origin(name, points):
    """A rigid body: a line from its origin to each of its points."""
    others = {point: place for point, place in points.items() if np.any(place != 0.0)}
    places = np.array([(0.0, 0.0), *others.values()])
    lines = np.array([(0, node) for node in range(1, len(places))], dtype=int).reshape(-1, 2)
    numbers = {point: 0 for point in points} | {point: node for node, point in enumerate(others, start=1)}
    return DrawnBody(name, places, lines, np.zeros((len(places), 2, 0)), numbers, 0)


def hang_on_nodes(results, name, superelement, points):
    """A body of a superelement: its frame, and the points away from nodes, each joined to the node it moves with."""
    where = f"model/superelements/{superelement}"
    places, _ = read_numbers(results.file, f"{where}/node_positions")
    elements = read_numbers(results.file, f"{where}/elements")[0].astype(int)
    chosen = np.zeros(0, dtype=int)
    if results.num_modes(name) > 0:
        chosen = read_numbers(results.file, f"bodies/{name}/modal/mode_number")[0].astype(int) - 1
    shapes = read_numbers(results.file, f"{where}/shapes")[0][:, :, chosen]
    extent = np.linalg.norm(np.ptp(places, axis=0))
    numbers, new_places, new_lines, new_shapes = {}, [], [], []
    for point, one in points.items():
        node = one.node if one.node >= 0 else int(np.argmin(np.linalg.norm(places - one.position, axis=1)))
        if np.linalg.norm(one.position - places[node]) <= HANGS_ON * extent:
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


def calc_motion(results, body, samples, magnification=1.0):
    """Where a body's nodes are in some samples (indices or slice), and how they move there."""
    state = {}
    for what in ("position", "velocity", "acceleration"):
        state[what] = read_numbers(results.file, f"bodies/{body.name}/{what}")[0][samples]
    eta = {what: np.zeros((len(state["position"]), 0)) for what in ("amplitude", "rate", "acceleration")}
    if body.shapes.shape[2] > 0:
        for what in eta:
            eta[what] = read_numbers(results.file, f"bodies/{body.name}/modal/{what}")[0][samples]
    bend, rate, change = (np.einsum("ndm,km->knd", body.shapes, one) for one in eta.values())
    angle = state["position"][:, 2, None]
    omega, alpha = state["velocity"][:, 2, None, None], state["acceleration"][:, 2, None, None]

    def to_world(local):
        c, s = np.cos(angle), np.sin(angle)
        return np.stack(
            [c * local[..., 0] - s * local[..., 1], s * local[..., 0] + c * local[..., 1]], axis=-1
        )

    def turned(vector):
        return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)

    arm = to_world(body.places + bend)
    bending = to_world(rate)
    return Motion(
        state["position"][:, None, :2] + to_world(body.places + magnification * bend),
        state["velocity"][:, None, :2] + omega * turned(arm) + bending,
        state["acceleration"][:, None, :2] + alpha * turned(arm) - omega**2 * arm + 2.0 * omega * turned(bending)
        + to_world(change),
    )  # fmt: skip


def read_wheels(results, bodies):
    """The tyres."""
    wheels = []
    for force in read_elements(results, "forces").values():
        if force.drawing == "wheel":
            (centre,) = force.points.values()
            place = find_point(centre, bodies, {})
            if place is not None:
                wheels.append(Wheel(force.name, *place, force.parameters["radius"]))
    return wheels


def read_links(results, bodies):
    """What is drawn between two points: springs, rods and joints."""
    ground = read_points(results, GROUND)
    links = []
    for group in ("forces", "joints"):
        for element in read_elements(results, group).values():
            ends = tuple(find_point(point, bodies, ground) for point in element.points.values())
            if element.drawing in LINKS and None not in ends:
                links.append(Link(element.name, LINKS[element.drawing], ends))
    return links


def find_point(reference, bodies, ground):
    """`body.point` → (body, node); on the ground (None, (x, y)); None for a point that is not drawn."""
    body_name, _, point = reference.partition(".")
    if body_name == GROUND and point in ground:
        return None, tuple(map(float, ground[point].position))
    for body in bodies:
        if body.name == body_name and point in body.points:
            return body.name, body.points[point]
    return None


def read_road(results):
    """The road's course [k], [k] m in world axes, ascending in x; None if the file has none."""
    if "model/road" not in results.file:
        return None
    distance, height = (
        read_numbers(results.file, f"model/road/{name}")[0] for name in ("distance", "height")
    )
    origin, direction = (float(read_attribute(results.file, "model/road", name)) for name in ("origin", "direction"))
    x = (distance + origin) / direction
    order = np.argsort(x, kind="stable")
    return x[order], height[order]
