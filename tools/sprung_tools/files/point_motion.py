"""The motion of points from that of their body: of points whose histories a results file does not hold, and of the
nodes of a drawn body.

    r = R + A(θ) (u₀ + s Φη),   s is the magnification of the deflection, 1 for none            (bodies, eq. 1)
"""

import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.stored_file import StoredFile

RESOLVED = "model/resolved"
HISTORY = re.compile(
    r"points/(?P<point>[^/]+)/(?P<what>position|velocity|acceleration|deflection)"
    r"|bodies/(?P<body>[^/]+)/center_of_mass/(?P<motion>position|velocity|acceleration)"
)
UNITS = {"position": "m", "velocity": "m/s", "acceleration": "m/s^2", "deflection": "m"}
CENTRE = "center_of_mass"


class Motion(NamedTuple):
    """The motion of N points in k samples, world axes."""

    position: Floats  # [k×N×2] m, with the deflection magnified
    velocity: Floats  # [k×N×2] m/s
    acceleration: Floats  # [k×N×2] m/s²


class BodyMotion(NamedTuple):
    """The motion of a body frame, and of n modes; none of a rigid body."""

    position: Floats  # [k×3] m, m, rad
    velocity: Floats  # [k×3]
    acceleration: Floats  # [k×3]
    amplitude: Floats  # [k×n]
    rate: Floats  # [k×n]
    change: Floats  # [k×n], the second derivative


class DerivedPoint(NamedTuple):
    """A point's motion that follows from that of its body."""

    point: str  # body.point
    body: str
    what: str  # position, velocity, acceleration, deflection


def read_body_motion(file: StoredFile, body: str) -> BodyMotion:
    """Reads the motion of a body. InputError if the file does not hold it."""
    frame = [file.numbers(f"bodies/{body}/{what}")[0] for what in ("position", "velocity", "acceleration")]
    modal = f"bodies/{body}/modal"
    if (file.shape(f"{modal}/mode_number") or (0,))[0] == 0:
        return BodyMotion(*frame, *(np.zeros((len(frame[0]), 0)) for _ in range(3)))
    return BodyMotion(*frame, *(file.numbers(f"{modal}/{what}")[0] for what in ("amplitude", "rate", "acceleration")))


def calc_motion(body: BodyMotion, places: Floats, shapes: Floats, magnification: float = 1.0) -> Motion:
    """The motion of points of a body. places: [N×2] m, undeformed, body frame; shapes: [N×2×n] m per unit amplitude."""
    bend, rate, change = (np.einsum("ndm,km->knd", shapes, one) for one in (body.amplitude, body.rate, body.change))
    angle = body.position[:, 2, None]
    omega, alpha = body.velocity[:, 2, None, None], body.acceleration[:, 2, None, None]

    def to_world(local: Floats) -> Floats:
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([c * local[..., 0] - s * local[..., 1], s * local[..., 0] + c * local[..., 1]], axis=-1)

    def cross_z(vector: Floats) -> Floats:
        """e_z × vector."""
        return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)

    arm = to_world(places + bend)
    bending = to_world(rate)
    return Motion(
        body.position[:, None, :2] + to_world(places + magnification * bend),
        body.velocity[:, None, :2] + omega * cross_z(arm) + bending,
        body.acceleration[:, None, :2] + alpha * cross_z(arm) - omega**2 * arm + 2.0 * omega * cross_z(bending)
        + to_world(change),
    )  # fmt: skip


def is_linear(file: StoredFile, body: str) -> bool:
    """Whether the motions of a body's points follow linearly from those of its frame and its modes, and the file holds
    these. Where axial forces stiffen the body they do not: the file then holds the motions themselves."""
    about = f"{RESOLVED}/bodies/{body}"
    if not file.has_group(about) or file.attribute(about, "is_stiffened", int, 0):
        return False
    return file.has_dataset(f"bodies/{body}/position") and file.has_dataset(f"bodies/{body}/acceleration")


def find_derived(file: StoredFile, dataset: str) -> DerivedPoint | None:
    """The point's motion that a dataset's name stands for, if it follows from what the file holds."""
    found = HISTORY.fullmatch(dataset)
    if not found:
        return None
    point = found["point"] or f"{found['body']}.{CENTRE}"
    body = point.partition(".")[0]
    group = f"{RESOLVED}/points/{point}"
    if not file.has_group(group) or not is_linear(file, body):
        return None
    what = found["what"] or found["motion"]
    if what == "deflection" and not file.has_dataset(f"{group}/shapes"):
        return None
    return DerivedPoint(point, body, what)


def calc_derived(file: StoredFile, derived: DerivedPoint, known: Mapping[str, BodyMotion]) -> tuple[Floats, str]:
    """The history [n×2] of a point's motion, and its unit. known: motions of bodies that have been read before."""
    body = known.get(derived.body) or read_body_motion(file, derived.body)
    group = f"{RESOLVED}/points/{derived.point}"
    place, _ = file.numbers(f"{group}/position")
    shapes = np.zeros((3, body.amplitude.shape[1]))
    if file.has_dataset(f"{group}/shapes"):
        shapes, _ = file.numbers(f"{group}/shapes")
    unit = UNITS[derived.what]
    if derived.what == "deflection":
        return body.amplitude @ shapes[:2].T, unit
    values: Floats = getattr(calc_motion(body, place[None, :], shapes[None, :2]), derived.what)[:, 0]
    return values, unit


def list_derived_points(file: StoredFile) -> list[str]:
    """The points of bodies whose motion is known from that of their bodies, centres of mass excepted."""
    names = [name for name in file.names(f"{RESOLVED}/points") if name.partition(".")[2] != CENTRE]
    bodies = {name.partition(".")[0] for name in names}
    known = {body for body in bodies if is_linear(file, body)}
    return [name for name in names if name.partition(".")[0] in known]
