"""The vehicle's own modes about its equilibrium, and who moves in each, in words: "chassis bending, 95 %"."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.vehicle_shape import DrawnBody

WHERE = "model/modes"


class VehicleMode(NamedTuple):
    """A mode: its number among all, from 1, as `sprung-dynamics modes` prints it; undamped frequency [Hz], damping
    ratio, the bodies that move in words, and its shape: for each body the displacement x, y [m], the rotation [rad] and
    the modal amplitudes; mass-normalised."""

    number: int
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
    modes = []
    for k in map(int, np.flatnonzero(frequency > 0.0)):
        shape = {name: shapes[places, k] for name, places in rows.items() if places}
        modes.append(VehicleMode(k + 1, float(frequency[k]), float(damping[k]), participants[k], shape))
    return modes
