"""A run's modes over time: which were active, when that changed, and how much the others would have contributed."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags, Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.reduced_vectors import Vector, read_vectors

MODES_CHANGED = "modes"  # kind of the event in which modes join or leave


class ModeHistory(NamedTuple):
    """A body's modes over a run of n samples.

    vectors: what they are; is_active: whether each took part [n×modes].
    """

    body: str
    vectors: list[Vector]
    is_active: Flags


class Neglect(NamedTuple):
    """What a mode that was left out would have reached: its share of the run's largest value until then, and the time
    [s]."""

    share: float
    body: str
    mode: int
    time: float


def read_mode_histories(results: ResultsFile) -> list[ModeHistory]:
    """Reads the histories of all bodies that have modes, in the order of their names. InputError if none has."""
    file = results.file
    found = []
    for body in results.names("bodies"):
        if results.num_modes(body) == 0:
            continue
        active, _ = read_numbers(file, f"bodies/{body}/modal/active")
        found.append(ModeHistory(body, read_vectors(results, body), active > 0.5))
    if not found:
        raise InputError(f"{results.path}: error: no body of this run has modes")
    return found


def count_active(results: ResultsFile) -> Integers:
    """The number of active modes of all bodies at each sample [n]."""
    counts = [np.sum(history.is_active, axis=1) for history in read_mode_histories(results)]
    return np.sum(np.array(counts), axis=0)


def find_change_times(results: ResultsFile) -> Floats:
    """The times at which modes joined or left [s], ascending, each once."""
    time, _ = read_numbers(results.file, "events/time")
    kinds = read_texts(results.file, "events/kind")
    return np.unique([when for when, kind in zip(time, kinds) if kind == MODES_CHANGED])


def read_neglected(results: ResultsFile) -> dict[str, Floats]:
    """Reads for each body which of the modes left out would have contributed most at each sample: body → [n×3], the
    mode's shares of the largest deflection and of the largest acceleration so far, and its number. Empty if the run did
    not record it."""
    names = {body: f"bodies/{body}/modal/neglected" for body in results.names("bodies")}
    return {body: read_numbers(results.file, name)[0] for body, name in names.items() if results.has(name)}


def find_worst_neglect(results: ResultsFile, column: int) -> Neglect | None:
    """The mode left out that would have contributed most to the deflection (column 0) or to the acceleration (1). None
    if the run did not record it, or if nothing was left out."""
    worst: Neglect | None = None
    for body, values in read_neglected(results).items():
        sample = int(np.argmax(values[:, column]))
        share = float(values[sample, column])
        if share > (worst.share if worst else 0.0):
            worst = Neglect(share, body, int(values[sample, 2]), float(results.time[sample]))
    return worst
