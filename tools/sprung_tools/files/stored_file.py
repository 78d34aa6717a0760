"""An HDF5 file of one of the project's formats, open for reading. No fault of it passes this module unseen.

Each dataset is checked against the format's layout when it is read: whether it is there, its type, its shape, that its
numbers are finite and its indices in range, and that the file holds as many bytes as the dataset says. The attributes
are checked when they are read. Every fault is an InputError whose text is `path: error: …`.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import h5py
import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.last_read import note_file
from sprung_tools.files.layout import Layout, Numbers, Size, Texts, fill_pattern

# What h5py makes of the faults that HDF5 finds in a file: it has no error of its own.
H5PY_ERRORS = (
    OSError, KeyError, RuntimeError, ValueError, TypeError, OverflowError, MemoryError, NotImplementedError,
    SystemError,
)  # fmt: skip
LARGEST = 1e100  # of what a run or a body may have, in SI units: squares of it are finite
MOST_COMPRESSED = 1100  # bytes that deflate, which compresses best among HDF5's own filters, makes of one at most


@contextmanager
def reading(path: str, what: str) -> Iterator[None]:
    """Turns the errors of calls of h5py into an InputError. what: is being read, for the message."""
    try:
        yield
    except H5PY_ERRORS as error:
        reason = str(error).strip("'\"").partition("\n")[0] or type(error).__name__
        raise InputError(f"{path}: error: {what} is damaged ({reason})") from error


class StoredFile:
    """An open file. Paths in it are given without a slash before them; "" is the root group."""

    def __init__(self, file: h5py.File, layout: Layout) -> None:
        self.filename: str = file.filename
        self._file = file
        self._layout = layout
        self._is_closed = False
        self._found: dict[str, h5py.Group | h5py.Dataset | None] = {}  # by path; the file does not change while open

    def __enter__(self) -> "StoredFile":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file. Reading from it is an error from then on."""
        self._is_closed = True
        self._file.close()

    def fail(self, what: str) -> InputError:
        """The error that says what is wrong with the file."""
        return InputError(f"{self.filename}: error: {what}")

    def has_group(self, name: str) -> bool:
        """Whether there is a group of this path."""
        return isinstance(self._find(name), h5py.Group)

    def has_dataset(self, name: str) -> bool:
        """Whether there is a dataset of this path."""
        return isinstance(self._find(name), h5py.Dataset)

    def names(self, group: str) -> list[str]:
        """The names in a group, in order; none if there is no such group."""
        found = self._find(group)
        if not isinstance(found, h5py.Group):
            return []
        with reading(self.filename, f"group '{group}'"):
            return sorted(found)

    def shape(self, name: str) -> tuple[int, ...] | None:
        """The shape of a dataset; None if there is no such dataset."""
        found = self._find(name)
        if not isinstance(found, h5py.Dataset):
            return None
        with reading(self.filename, f"dataset '{name}'"):
            shape: tuple[int, ...] | None = found.shape
            return shape

    def list_histories(self, group: str) -> list[str]:
        """The histories in a group, at any depth: the names of datasets with a row for every output, or for some."""
        found = []
        for name in (f"{group}/{one}" for one in self.names(group)):
            rule = self._layout.find(name)
            if not self.has_dataset(name):
                found += self.list_histories(name)
            elif rule and isinstance(rule.rule, Numbers) and rule.rule.shape[0] == "time":
                found.append(name)
        return found

    def attributes(self, name: str) -> dict[str, Any]:
        """The attributes of a group or a dataset: numbers, texts, and arrays of these. Those that the layout demands
        are there and have its types."""
        found = self._find(name)
        if found is None:
            raise self.fail(f"no group '{name}'")
        values: dict[str, Any] = {}
        with reading(self.filename, f"an attribute of '{name or '/'}'"):
            for key, value in found.attrs.items():
                values[key] = simplify(value)
        for key, wanted in self._layout.list_attributes(name).items():
            self._check_attribute(values, name, key, wanted)
        return values

    def attribute(self, name: str, key: str, wanted: type, default: Any = None) -> Any:
        """An attribute of a group or a dataset, as the type wanted: float, int or str.

        InputError if it is of another type; if it is missing, unless there is a default.
        """
        found = self._find(name)
        if found is None:
            raise self.fail(f"no group '{name}'")
        with reading(self.filename, f"attribute '{key}' of '{name or '/'}'"):
            values = {key: simplify(found.attrs[key])} if key in found.attrs else {}
        if not values and default is not None:
            return default
        self._check_attribute(values, name, key, wanted)
        return values[key]

    def numbers(self, name: str) -> tuple[Floats, str]:
        """Reads a dataset of numbers. Returns (values, unit). Of a history that is not stored at every output, the
        values between are interpolated linearly, so that all histories have the rows of `time`."""
        dataset = self._dataset(name)
        if dataset is None:
            raise self.fail(self.describe_missing(name))
        with reading(self.filename, f"dataset '{name}'"):
            kind = dataset.dtype.kind
        if kind not in "fiu":
            raise self.fail(f"dataset '{name}' does not hold numbers")
        found = self._layout.find(name)
        rule = found.rule if found and isinstance(found.rule, Numbers) else None
        every = self.every(name)
        if found and rule:
            shape = [self._resolve(name, size, found.names) for size in rule.shape]
            if every > 1 and shape[0] is not None:
                shape[0] = self.count_rows(name, every, shape[0])
            self._check_shape(name, dataset, tuple(shape))
        self._check_size(name, dataset)
        with reading(self.filename, f"dataset '{name}'"):
            values = np.asarray(dataset[()], dtype=float)
        if every > 1:
            values = interpolate_rows(values, every, (self.shape("time") or (0,))[0])
        largest = np.max(np.abs(values), initial=0.0)
        if not largest <= LARGEST:
            what = f"as large as {largest:g}" if np.isfinite(largest) else "that are not finite"
            raise self.fail(f"dataset '{name}' holds values {what}")
        if found and rule and rule.within is not None:
            self._check_indices(name, values, self._resolve(name, rule.within, found.names))
        return values, self.attribute(name, "unit", str, "")

    def count_rows(self, name: str, every: int, count: int) -> int:
        """The rows that a history of `count` outputs has if it is stored at each `every`-th and the last one; files of
        earlier versions do not have the last one."""
        rows = -(-count // every)
        is_extra = (count - 1) % every != 0
        return rows + 1 if is_extra and (self.shape(name) or (0,))[0] == rows + 1 else rows

    def every(self, name: str) -> int:
        """The number of outputs from one stored row of a history to the next. 1 for a history that is not stored."""
        if not self.has_dataset(name):
            return 1
        every: int = self.attribute(name, "every", int, 1)
        if every < 1:
            raise self.fail(f"attribute 'every' of '{name}' is {every}, expected 1 or more")
        return every

    def texts(self, name: str) -> list[str]:
        """Reads a dataset of strings."""
        dataset = self._dataset(name)
        kind = ""
        if dataset is not None:
            with reading(self.filename, f"dataset '{name}'"):
                kind = dataset.dtype.kind
        if dataset is None or kind not in "SO":
            raise self.fail(f"no dataset '{name}' of strings")
        found = self._layout.find(name)
        if found and isinstance(found.rule, Texts):
            size = self._resolve(name, found.rule.size, found.names)
            if dataset.shape != () or size not in (None, 1):
                self._check_shape(name, dataset, (size,))
        self._check_size(name, dataset)
        with reading(self.filename, f"dataset '{name}'"):
            return [decode(value) for value in np.atleast_1d(dataset[()])]

    def _find(self, name: str) -> h5py.Group | h5py.Dataset | None:
        """The object of a path; None if a name on the way is not there. A name that is there and leads nowhere is an
        error."""
        if self._is_closed:
            raise self.fail("the file is closed; read what is needed before, or open it again")
        note_file(self.filename)
        found: h5py.Group | h5py.Dataset | None = self._file
        path = ""
        for part in filter(None, name.split("/")):
            path += f"/{part}"
            if path not in self._found:
                with reading(self.filename, f"'{name}'"):
                    group = found if isinstance(found, h5py.Group) and found.id.links.exists(part.encode()) else None
                    self._found[path] = group[part] if group is not None else None
            found = self._found[path]
            if found is None:
                return None
        return found

    def _dataset(self, name: str) -> h5py.Dataset | None:
        found = self._find(name)
        return found if isinstance(found, h5py.Dataset) else None

    def describe_missing(self, name: str) -> str:
        """Says that there is no such dataset, and for a history what chooses whether it is stored."""
        key = name_group(name)
        if key in self._layout.chosen:
            return f"'{name}' is not stored; '{key}' in [output.store] of the run file chooses what is"
        return f"no dataset '{name}'"

    def _check_attribute(self, values: dict[str, Any], name: str, key: str, wanted: type) -> None:
        """Throws InputError if an attribute is missing or of another type; makes it of the type wanted."""
        value = values.get(key)
        where = f"attribute '{key}' of '{name or '/'}'"
        if value is None:
            raise self.fail(f"no {where}")
        if wanted is str and not isinstance(value, str):
            raise self.fail(f"{where} is not a text")
        if wanted is not str and (isinstance(value, bool) or not isinstance(value, (int, float)) or value != value):
            raise self.fail(f"{where} is not a number")
        if wanted is int and not float(value).is_integer():
            raise self.fail(f"{where} is {value:g}, expected a whole number")
        values[key] = wanted(value)

    def _resolve(self, name: str, size: Size, names: tuple[str, ...]) -> int | None:
        """A size as a number; None if any will do."""
        if size is None or isinstance(size, int):
            return size
        pattern, axis = (size, 0) if isinstance(size, str) else size
        other = fill_pattern(pattern, names)
        shape = self.shape(other)
        if shape is None or len(shape) <= axis:
            raise self.fail(f"no dataset '{other}', which '{name}' belongs to")
        return shape[axis]

    def _check_shape(self, name: str, dataset: h5py.Dataset, expected: tuple[int | None, ...]) -> None:
        shape = dataset.shape
        fits = shape is not None and len(shape) == len(expected)
        if not fits or any(want is not None and size != want for size, want in zip(shape, expected)):
            shown = " × ".join("any" if size is None else str(size) for size in expected)
            raise self.fail(f"dataset '{name}' has shape {shape}, expected {shown}")

    def _check_size(self, name: str, dataset: h5py.Dataset) -> None:
        """Throws InputError if a dataset says that it is larger than what the file holds of it: HDF5 would fill the
        rest with zeros, and ask for the memory first."""
        with reading(self.filename, f"dataset '{name}'"):
            declared = (dataset.size or 0) * dataset.dtype.itemsize
            stored = min(dataset.id.get_storage_size(), self._file.id.get_filesize())
            factor = MOST_COMPRESSED if dataset.compression is not None else 1
        if declared > factor * stored:
            raise self.fail(f"dataset '{name}' is damaged (it has {declared} bytes, the file holds {stored} of them)")

    def _check_indices(self, name: str, values: Floats, count: int | None) -> None:
        outside = values[(values != np.floor(values)) | (values < 0) | (values >= (count or 0))]
        if outside.size:
            expected = f"expected a whole number from 0 to {(count or 0) - 1}"
            raise self.fail(f"dataset '{name}' holds {outside.flat[0]:g}, {expected}")


def interpolate_rows(values: Floats, every: int, count: int) -> Floats:
    """Values at `count` outputs from those at each `every`-th and at the last one; in files that do not have it, they
    stay as they are behind the one before."""
    if len(values) == 0:
        return values
    at = np.arange(count)
    stored = np.minimum(every * np.arange(len(values)), count - 1)
    before = np.minimum(at // every, len(values) - 1)
    after = np.minimum(before + 1, len(values) - 1)
    share = ((at - stored[before]) / np.maximum(stored[after] - stored[before], 1)).reshape(
        -1, *(1,) * (values.ndim - 1)
    )
    interpolated: Floats = values[before] + share * (values[after] - values[before])
    return interpolated


def name_group(history: str) -> str:
    """The key in [output.store] and [output.step] that chooses how a history is stored."""
    return "wrenches" if "/on_" in history else history.partition("/")[0]


def decode(value: Any) -> str:
    """A string of HDF5 as str: h5py gives bytes, padded bytes or str."""
    if isinstance(value, bytes):
        return value.decode("utf-8").rstrip("\0")
    if isinstance(value, str):
        value.encode("utf-8")  # bytes that are no UTF-8 are lone surrogates in it, which nothing can print
        return value
    raise ValueError(f"{type(value).__name__} in place of a text")


def simplify(value: Any) -> Any:
    """An attribute as int, float or str if it is one value; else as h5py gives it."""
    if isinstance(value, (np.ndarray, np.generic)) and value.size == 1:
        value = value.item()
    return decode(value) if isinstance(value, (bytes, str)) else value
