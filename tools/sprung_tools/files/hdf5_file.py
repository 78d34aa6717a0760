"""Opening HDF5 files of the project's formats, and reading their datasets and attributes.

Every fault of a file is an InputError whose text is `path: error: …`.
"""

import os
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError, WrongFormatError

RESULTS, SUPERELEMENT = "sprung-results", "sprung-superelement"
RESPONSE, MODE_CHOICE = "sprung-response", "sprung-mode-choice"
NEWEST_VERSIONS = {RESULTS: 2, SUPERELEMENT: 2, RESPONSE: 1, MODE_CHOICE: 1}  # that are understood here


def text_of(value: Any) -> str:
    """Returns an attribute or a dataset of one string as str. h5py gives bytes, padded bytes or str, alone or in an
    array."""
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.item()
    return value.decode("utf-8").rstrip("\0") if isinstance(value, bytes) else str(value)


def open_hdf5(path: str | Path, wanted_format: str) -> h5py.File:
    """Opens a file of one of the formats above.

    InputError if it is missing, empty, damaged or too new; WrongFormatError if it is of another format.
    """
    if not os.path.exists(path):
        raise InputError(f"{path}: error: no such file")
    if os.path.isdir(path):
        raise InputError(f"{path}: error: is a folder, expected a {wanted_format} file")
    if os.path.getsize(path) == 0:
        raise InputError(f"{path}: error: the file is empty")
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise InputError(f"{path}: error: not a readable HDF5 file ({error})") from error
    found = text_of(file.attrs["format"]) if "format" in file.attrs else None
    version = int(file.attrs.get("version", 0))
    newest_version = NEWEST_VERSIONS[wanted_format]
    if found == wanted_format and 1 <= version <= newest_version:
        return file
    file.close()
    if found is None:
        raise WrongFormatError(f"{path}: error: no attribute 'format', expected '{wanted_format}'", found)
    if found != wanted_format:
        raise WrongFormatError(f"{path}: error: format is '{found}', expected '{wanted_format}'", found)
    raise InputError(f"{path}: error: version {version} of {wanted_format}; this tool reads 1 to {newest_version}")


def read_numbers(file: h5py.File, name: str) -> tuple[Floats, str]:
    """Reads a dataset of numbers. Returns (values, unit). InputError if it is missing, damaged or not finite."""
    path = file.filename
    dataset = file.get(name)
    if not isinstance(dataset, h5py.Dataset):
        raise InputError(f"{path}: error: no dataset '{name}'")
    if dataset.dtype.kind not in "fiu":
        raise InputError(f"{path}: error: dataset '{name}' does not hold numbers")
    try:
        values = np.asarray(dataset[()], dtype=float)
    except OSError as error:
        raise InputError(f"{path}: error: dataset '{name}' is damaged ({error})") from error
    if not np.all(np.isfinite(values)):
        raise InputError(f"{path}: error: dataset '{name}' holds values that are not finite")
    return values, text_of(dataset.attrs.get("unit", ""))


def read_texts(file: h5py.File, name: str) -> list[str]:
    """Reads a dataset of strings. InputError if it is missing, damaged or does not hold strings."""
    dataset = file.get(name)
    if not isinstance(dataset, h5py.Dataset) or dataset.dtype.kind not in "SO":
        raise InputError(f"{file.filename}: error: no dataset '{name}' of strings")
    try:
        return [text_of(one) for one in np.atleast_1d(dataset[()])]
    except OSError as error:
        raise InputError(f"{file.filename}: error: dataset '{name}' is damaged ({error})") from error


def read_attribute(file: h5py.File, group: str, name: str) -> Any:
    """Reads an attribute of a group. InputError if the group or the attribute is missing."""
    if group not in file:
        raise InputError(f"{file.filename}: error: no group '{group}'")
    if name not in file[group].attrs:
        raise InputError(f"{file.filename}: error: no attribute '{name}' of '{group}'")
    return file[group].attrs[name]
