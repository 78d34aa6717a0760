"""Response files (dynamics/output/response.md) with the names that they have in tables and pictures: `[LABEL=]FILE`."""

import os
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import RESPONSE, open_hdf5, read_numbers, read_real
from sprung_tools.files.stored_file import StoredFile
from sprung_tools.runs.labelled_runs import split_label

DEEPEST = 5  # parts of an output's name, at most


class Response(NamedTuple):
    """An open response file with its name in the legend. frequency: [m] Hz, of which it takes every first, second …"""

    label: str
    file: StoredFile
    frequency: Floats
    every: int = 1

    def values(self, output: str, *, is_spectrum: bool) -> tuple[Floats, str]:
        """Reads the magnitude of an output's response, or its spectral density [m]. Returns (values, unit). InputError
        if the file has none."""
        group = self._find_group(output)
        if not is_spectrum:
            pairs, unit = read_numbers(self.file, f"{group}/response")
            return np.hypot(pairs[:, 0], pairs[:, 1])[:: self.every], unit
        if not self.file.has_dataset(f"{group}/spectrum"):
            raise InputError(f"{self.file.filename}: error: has no spectra: its run file has no [response.road]")
        density, unit = read_numbers(self.file, f"{group}/spectrum")
        if np.any(density < 0.0):
            raise InputError(f"{self.file.filename}: error: dataset '{group}/spectrum' holds values below 0")
        return density[:: self.every], unit

    def rms(self, output: str) -> float:
        """The r.m.s. of an output, from a file with spectra."""
        return read_real(self.file, self._find_group(output), "rms")

    def _find_group(self, output: str) -> str:
        group = f"outputs/{output}"
        if not self.file.has_dataset(f"{group}/response"):
            raise InputError(f"{self.file.filename}: error: no output '{output}'; there are: {', '.join(self.names())}")
        return group

    def names(self) -> list[str]:
        """The outputs in the file."""
        found: list[str] = []
        waiting = [""]
        while waiting:
            place = waiting.pop()
            if self.file.has_dataset(f"outputs/{place}/response"):
                found.append(place)
            else:
                inside = (f"{place}/{name}".lstrip("/") for name in reversed(self.file.names(f"outputs/{place}")))
                waiting += inside if place.count("/") < DEEPEST else ()
        return found


def open_responses(arguments: Sequence[str]) -> list[Response]:
    """Opens files `[LABEL=]FILE`."""
    responses = []
    for argument in arguments:
        label, path = split_label(argument)
        file = open_hdf5(path, RESPONSE)
        frequency = read_numbers(file, "frequency")[0]
        if np.any(np.diff(frequency) <= 0.0):
            raise InputError(f"{path}: error: dataset 'frequency' must hold increasing values")
        responses.append(Response(label or os.path.basename(path), file, frequency))
    return responses
