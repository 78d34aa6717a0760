"""What a run's modes did over time: which took part, when that changed, and what those left out would have done."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_texts, text_of

MODES_CHANGED = "modes"  # kind of the event of a mode that joins or leaves


class ModeHistory(NamedTuple):
    """A body's modes over a run of n samples.

    number: of each mode in its superelement [modes]; frequency: clamped, Hz [modes]; is_active: whether it took part
    [n×modes].
    """

    body: str
    number: np.ndarray
    frequency: np.ndarray
    is_active: np.ndarray


class Neglect(NamedTuple):
    """What a mode left out would have reached, as a share of the largest of the run up to then, and when [s]."""

    share: float
    body: str
    mode: int
    time: float


def read_mode_histories(results):
    """Histories of all bodies that have modes, by name. InputError if none has."""
    file = results.file
    found = []
    for body in results.names("bodies"):
        if results.num_modes(body) == 0:
            continue
        number, _ = read_numbers(file, f"bodies/{body}/modal/mode_number")
        active, _ = read_numbers(file, f"bodies/{body}/modal/active")
        superelement = text_of(file[f"model/bodies/{body}"].attrs["superelement"])
        of_all, _ = read_numbers(file, f"model/superelements/{superelement}/frequency")
        number = number.astype(int)
        found.append(ModeHistory(body, number, of_all[number - 1], active > 0.5))
    if not found:
        raise InputError(f"{results.path}: error: no body of this run has modes")
    return found


def count_active(results):
    """How many modes of all bodies take part at each sample [n]."""
    return np.sum([np.sum(history.is_active, axis=1) for history in read_mode_histories(results)], axis=0)


def find_change_times(results):
    """Instants at which modes joined or left [s], ascending, each once."""
    time, _ = read_numbers(results.file, "events/time")
    kinds = read_texts(results.file, "events/kind")
    return np.unique([when for when, kind in zip(time, kinds) if kind == MODES_CHANGED])


def read_neglected(results):
    """Of each body the mode left out that misses most, over time: dict of body → [n×3], its share of the largest
    deflection and acceleration so far, and its number. Empty where the run did not look."""
    names = {body: f"bodies/{body}/modal/neglected" for body in results.names("bodies")}
    return {body: read_numbers(results.file, name)[0] for body, name in names.items() if name in results.file}


def find_worst_neglect(results, column):
    """The mode left out that would have reached most of the deflection (column 0) or of the acceleration (1). None where
    the run did not look, or where nothing was left out."""
    worst = None
    for body, values in read_neglected(results).items():
        sample = int(np.argmax(values[:, column]))
        share = float(values[sample, column])
        if share > (worst.share if worst else 0.0):
            worst = Neglect(share, body, int(values[sample, 2]), float(results.time[sample]))
    return worst
