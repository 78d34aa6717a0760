"""Opening HDF5 files of the project's formats, and reading their datasets and attributes.

Every fault of a file is an InputError whose text is `path: error: …`.
"""

import os
from pathlib import Path

import h5py

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError, WrongFormatError
from sprung_tools.files.last_read import note_file
from sprung_tools.files.results_layout import RESULTS_LAYOUT
from sprung_tools.files.stored_file import H5PY_ERRORS, StoredFile
from sprung_tools.files.superelement_layout import RESPONSE_LAYOUT, SUPERELEMENT_LAYOUT

RESULTS, SUPERELEMENT = "sprung-results", "sprung-superelement"
RESPONSE, MODE_CHOICE = "sprung-response", "sprung-mode-choice"
NEWEST_VERSIONS = {RESULTS: 2, SUPERELEMENT: 7, RESPONSE: 1, MODE_CHOICE: 1}  # that are understood here
TAKEN_BY = {  # by which commands
    RESULTS: "report, ride and plot_results take results",
    SUPERELEMENT: "compare_frequencies and export_paraview take superelements",
    RESPONSE: "plot_response draws a response, ride prints its measures",
    MODE_CHOICE: "plot_modes draws a choice of modes",
}
LAYOUTS = {
    RESULTS: RESULTS_LAYOUT, SUPERELEMENT: SUPERELEMENT_LAYOUT, RESPONSE: RESPONSE_LAYOUT, MODE_CHOICE: RESULTS_LAYOUT,
}  # fmt: skip


def open_hdf5(path: str | Path, wanted_format: str) -> StoredFile:
    """Opens a file of one of the formats above.

    InputError if it is missing, empty, damaged or too new; WrongFormatError if it is of another format.
    """
    if not os.path.exists(path):
        raise InputError(f"{path}: error: no such file")
    if os.path.isdir(path):
        raise InputError(f"{path}: error: is a folder, expected a {wanted_format} file")
    if os.path.getsize(path) == 0:
        raise InputError(f"{path}: error: the file is empty")
    note_file(str(path))
    try:
        file = StoredFile(h5py.File(path, "r"), LAYOUTS[wanted_format])
    except H5PY_ERRORS as error:
        raise InputError(f"{path}: error: not a readable HDF5 file ({error})") from error
    try:
        check_format(file, wanted_format)
    except InputError:
        file.close()
        raise
    return file


def check_format(file: StoredFile, wanted_format: str) -> None:
    """Throws InputError if a file is of another format (WrongFormatError), or too new."""
    path = file.filename
    found = file.attribute("", "format", str, "") or None
    if found is None:
        raise WrongFormatError(f"{path}: error: no attribute 'format', expected '{wanted_format}'", found)
    if found != wanted_format:
        advice = f"; {TAKEN_BY[found]}" if found in TAKEN_BY else ""
        raise WrongFormatError(f"{path}: error: format is '{found}', expected '{wanted_format}'{advice}", found)
    version = file.attribute("", "version", int, 0)
    newest_version = NEWEST_VERSIONS[wanted_format]
    if not 1 <= version <= newest_version:
        raise InputError(f"{path}: error: version {version} of {wanted_format}; this tool reads 1 to {newest_version}")


def read_numbers(file: StoredFile, name: str) -> tuple[Floats, str]:
    """Reads a dataset of numbers. Returns (values, unit). InputError if it is missing, damaged, not finite, or of
    another shape than the format says."""
    return file.numbers(name)


def read_texts(file: StoredFile, name: str) -> list[str]:
    """Reads a dataset of strings. InputError if it is missing, damaged or does not hold strings."""
    return file.texts(name)


def read_real(file: StoredFile, group: str, name: str) -> float:
    """Reads an attribute of a group that is a number. InputError if the group or the attribute is missing."""
    number: float = file.attribute(group, name, float)
    return number


def read_text(file: StoredFile, group: str, name: str, default: str | None = None) -> str:
    """Reads an attribute of a group that is a text. InputError if the group is missing, or the attribute where there is
    no default."""
    text: str = file.attribute(group, name, str, default)
    return text
