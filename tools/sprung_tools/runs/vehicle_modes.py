"""The vehicle's own modes about its equilibrium, and who moves in each, in words: "chassis bending, 95 %"."""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_real, read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.vehicle_shape import DrawnBody, read_wheels

WHERE = "model/modes"
SHARE = re.compile(r"^(?P<body>.*?)(?: \(mode (?P<mode>\d+)\))? (?P<percent>\d+) %$")  # of a mode's participants
WORTH_NAMING = 0.25  # share of a body's energy from which one of its motions is named


class VehicleMode(NamedTuple):
    """A mode: undamped frequency [Hz], damping ratio, the bodies that move in words, and its shape: for each body the
    displacement x, y [m], the rotation [rad] and the modal amplitudes; mass-normalised."""

    frequency: float
    damping: float
    words: str
    shape: dict[str, Floats]


def read_vehicle_modes(results: ResultsFile, bodies: Sequence[DrawnBody]) -> list[VehicleMode]:
    """Reads the modes that oscillate, the lowest first; an empty list if the run did not start from equilibrium."""
    if not results.has(f"{WHERE}/undamped_frequency"):
        return []
    frequency, _ = read_numbers(results.file, f"{WHERE}/undamped_frequency")
    damping, _ = read_numbers(results.file, f"{WHERE}/damping_ratio")
    participants = read_texts(results.file, f"{WHERE}/participants")
    has_shapes = results.has(f"{WHERE}/shapes")
    shapes = read_numbers(results.file, f"{WHERE}/shapes")[0] if has_shapes else np.zeros((0, frequency.size))
    coordinates = read_texts(results.file, f"{WHERE}/coordinates") if has_shapes else []
    rows = {body.name: [k for k, name in enumerate(coordinates) if name.startswith(f"{body.name}.")] for body in bodies}
    for body in bodies if has_shapes else ():
        if len(rows[body.name]) != 3 + body.shapes.shape[2]:
            raise InputError(
                f"{results.path}: error: '{WHERE}/coordinates' has {len(rows[body.name])} of '{body.name}', "
                f"expected {3 + body.shapes.shape[2]}"
            )
    drawn = {body.name: body for body in bodies}
    with_wheels = {wheel.body for wheel in read_wheels(results, bodies)}
    modes = []
    for number in np.flatnonzero(frequency > 0.0):
        shape = {name: shapes[places, number] for name, places in rows.items() if places}
        words = describe_participants(results, participants[number], shape, drawn, with_wheels)
        modes.append(VehicleMode(float(frequency[number]), float(damping[number]), words, shape))
    return modes


def describe_participants(
    results: ResultsFile, text: str, shape: Mapping[str, Floats], drawn: Mapping[str, DrawnBody], with_wheels: set[str]
) -> str:
    """The bodies that take part, with their motion and their share of the kinetic energy: "chassis (mode 1) 95 %" →
    "chassis bending, 95 %"."""
    words = []
    for part in text.split(", "):
        found = SHARE.match(part)
        if not found or found["body"] not in shape:
            words.append(part)
        elif found["mode"]:
            what = describe_mode(results, drawn[found["body"]], int(found["mode"]))
            words.append(f"{found['body']} {what}, {found['percent']} %")
        else:
            what = describe_rigid_motion(results, found["body"], shape[found["body"]], found["body"] in with_wheels)
            words.append(f"{found['body']} {what}, {found['percent']} %")
    return "; ".join(words)


def describe_mode(results: ResultsFile, body: DrawnBody, number: int) -> str:
    """What a mode of a body is: bending or stretching, by where its nodes move more, across the body or along it."""
    numbers = results.mode_numbers(body.name).tolist()
    if number not in numbers:
        return f"deformation (mode {number})"
    shape = body.shapes[:, :, numbers.index(number)]
    centred = body.places - np.mean(body.places, axis=0)
    along = np.linalg.svd(centred, full_matrices=False)[2][0]
    across = np.array([-along[1], along[0]])
    return "bending" if np.linalg.norm(shape @ across) >= np.linalg.norm(shape @ along) else "stretching"


def describe_rigid_motion(results: ResultsFile, body: str, shape: Floats, has_wheel: bool) -> str:
    """The motions of a body that moves as a whole: those with a large share of its energy, the largest first."""
    where = f"model/resolved/bodies/{body}"
    mass, inertia = (read_real(results.file, where, name) for name in ("mass", "inertia"))
    x, y = read_numbers(results.file, f"{where}/center_of_mass")[0]
    turn, _ = read_numbers(results.file, f"model/equilibrium/bodies/{body}")
    c, s = np.cos(turn[2]), np.sin(turn[2])
    along, up = shape[0] - shape[2] * (s * x + c * y), shape[1] + shape[2] * (c * x - s * y)
    energies = {
        "fore-aft": mass * along**2,
        "hop" if has_wheel else "heave": mass * up**2,
        "turning" if has_wheel else "pitch": inertia * shape[2] ** 2,
    }
    total = sum(energies.values())
    ranked = sorted(energies, key=lambda name: -energies[name])
    return " and ".join(name for name in ranked if total > 0.0 and energies[name] >= WORTH_NAMING * total) or "at rest"
