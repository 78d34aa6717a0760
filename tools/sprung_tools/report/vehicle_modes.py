"""The vehicle's own modes on the page: the table, the nodes of all bodies in equilibrium, and by how much they
move."""

from collections.abc import Sequence

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.vehicle_shape import DrawnBody
from sprung_tools.report.packing import Packed, encode
from sprung_tools.runs.vehicle_modes import VehicleMode, read_vehicle_modes

MOST_DRAWN = 24


def pack_vehicle_modes(results: ResultsFile, bodies: Sequence[DrawnBody]) -> Packed:
    """The modes with their frequencies; with shapes, the nodes' places in equilibrium [N×2] m, and for each mode and
    body the displacements of the nodes [N×2], of which the largest of the mode is 1."""
    modes = read_vehicle_modes(results, bodies)
    equilibrium = {body.name: calc_equilibrium(results, body) for body in bodies} if modes and modes[0].shape else {}
    return {
        "table": [
            {"number": mode.number, "f": mode.frequency, "damping": mode.damping, "who": mode.words} for mode in modes
        ],
        "equilibrium": {name: encode(places) for name, (places, _) in equilibrium.items()},
        "shapes": [pack_shape(mode, bodies, equilibrium) for mode in modes[:MOST_DRAWN] if equilibrium],
    }  # fmt: skip


def calc_equilibrium(results: ResultsFile, body: DrawnBody) -> tuple[Floats, Floats]:
    """Where a body's nodes are in equilibrium [N×2] m, with their static deflection, and its frame (x, y, angle)."""
    position, _ = read_numbers(results.file, f"model/equilibrium/bodies/{body.name}")
    local = body.places
    if body.shapes.shape[2] > 0:
        amplitude, _ = read_numbers(results.file, f"model/equilibrium/modal/{body.name}")
        local = local + body.shapes @ amplitude
    return position[:2] + local @ turn(position[2]).T, position


def turn(angle: float) -> Floats:
    """The rotation by an angle [2×2]."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def pack_shape(
    mode: VehicleMode, bodies: Sequence[DrawnBody], equilibrium: dict[str, tuple[Floats, Floats]]
) -> dict[str, str]:
    """The displacements of all nodes in a mode, for small motion about the equilibrium."""
    moved = {}
    for body in bodies:
        places, frame = equilibrium[body.name]
        shape = mode.shape[body.name]
        arm = places - frame[:2]
        moved[body.name] = shape[:2] + shape[2] * np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
        if body.shapes.shape[2] > 0:
            moved[body.name] = moved[body.name] + (body.shapes @ shape[3:]) @ turn(frame[2]).T
    largest = max(float(np.max(np.linalg.norm(one, axis=1))) for one in moved.values())
    return {name: encode(one / largest) for name, one in moved.items()}
