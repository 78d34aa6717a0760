"""A superelement's modes for ParaView: a VTU file for each mode, the frame bent by it."""

import os
from collections.abc import Sequence
from pathlib import Path

import meshio
import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import SUPERELEMENT, open_hdf5, read_numbers, read_texts
from sprung_tools.paraview.vtu_file import RESULTANTS, in_space
from sprung_tools.terminal.progress_bar import Progress

MODE_SIZE = 0.1  # of the frame's extent: the largest displacement that a mode is drawn with
ROUNDING = 1e-12  # of the way that a rotation takes over the frame's extent: smaller displacements are none


def export_modes(
    path: str | Path, folder: str, wanted: Sequence[int] | None, magnification: float
) -> list[tuple[float, str]]:
    """Writes a VTU file for each mode. Returns what the PVD file lists.

    wanted: numbers of modes, all if None; magnification: factor of the usual displacements. InputError for a mode that
    is not there, or has no displacements to draw.
    """
    with open_hdf5(path, SUPERELEMENT) as file:
        places, _ = read_numbers(file, "nodes/position")
        elements = read_numbers(file, "elements/node")[0].astype(int)
        shapes, _ = read_numbers(file, "modes/shape")
        frequency, _ = read_numbers(file, "modes/frequency")
        resultants, _ = read_numbers(file, "resultants")
        sections = read_texts(file, "elements/section")
    numbers = list(dict.fromkeys(wanted or range(1, frequency.size + 1)))
    for number in numbers:
        if not 1 <= number <= frequency.size:
            raise InputError(f"{path}: error: no mode {number}; the file has modes 1 to {frequency.size}")
    kinds = sorted(set(sections))
    extent = np.linalg.norm(np.ptp(places, axis=0))
    entries: list[tuple[float, str]] = []
    with Progress("modes", len(numbers)) as progress:
        for number in numbers:
            shape = shapes[:, :, number - 1]
            largest = np.max(np.abs(shape[:, :2]))
            if largest <= ROUNDING * extent * np.max(np.abs(shape[:, 2])):  # both are 0, or all nodes only turn
                raise InputError(f"{path}: error: mode {number} displaces no node: there is nothing to draw")
            scale = magnification * MODE_SIZE * extent / largest
            turn = np.zeros((len(places), 3))
            turn[:, 2] = scale * shape[:, 2]
            ends = scale * resultants[:, :, number - 1].reshape(-1, 2, 3)
            cell_data = {name: [ends[:, :, k]] for k, name in enumerate(RESULTANTS.values())}
            cell_data["section"] = [np.array([kinds.index(name) + 1 for name in sections])]
            mesh = meshio.Mesh(
                in_space(places + scale * shape[:, :2]),
                [("line", elements)],
                point_data={"displacement": in_space(scale * shape[:, :2]), "rotation": turn},
                cell_data=cell_data,
            )
            name = f"mode_{number:03d}.vtu"
            mesh.write(os.path.join(folder, name), binary=True)
            entries.append((number, name))  # not its frequency: two modes may have the same one
            progress.step()
    print("sections: " + ", ".join(f"{k} {name}" for k, name in enumerate(kinds, start=1)))
    return entries
