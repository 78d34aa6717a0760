"""The table of a study: a row for each run, with parameters, measures, exit code, error and hash; as CSV and HDF5
(tools/README.md, "Studies")."""

import csv
import io
from collections.abc import Iterable
from typing import Any, NamedTuple

import h5py
import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.toml_text import format_value
from sprung_tools.study.description import COLUMNS_BEFORE, COLUMNS_BEHIND
from sprung_tools.study.execution import Finished
from sprung_tools.study.one_run import Task

FORMAT, VERSION = "sprung-study", 1


class Column(NamedTuple):
    """A column of numbers. name: the label of the measure; values: [runs], NaN where a run has no such value; unit:
    empty if it is not known."""

    measure: str
    name: str
    unit: str
    values: Floats


def make_measure_columns(finished: Finished) -> list[Column]:
    """The measures of all runs, each name once, in the order in which the runs have them."""
    units: dict[str, str] = {}
    for row in finished.rows:
        for name, one in row.measures.items():
            units.setdefault(name, one.unit)
    columns = []
    for name, unit in units.items():
        found = [row.measures[name].value if name in row.measures else None for row in finished.rows]
        columns.append(
            Column(
                name,
                finished.study.measures.get(name, name),
                unit,
                np.array([np.nan if one is None else one for one in found]),
            )
        )
    return columns


def format_cell(value: Any) -> str:
    """A value of a parameter as a cell: texts without quotes."""
    return value if isinstance(value, str) else format_value(value)


def are_numbers(values: Iterable[Any]) -> bool:
    """Whether all values are numbers, which false and true are not."""
    return all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in values)


def list_distinct(values: Iterable[Any]) -> list[str]:
    """The distinct values of a parameter as cells: numbers in their order, lists of numbers by the first number that
    differs, others in the order in which they come."""
    distinct = {format_cell(one): one for one in values}
    if are_numbers(distinct.values()) or all(isinstance(one, list) and are_numbers(one) for one in distinct.values()):
        return sorted(distinct, key=lambda cell: distinct[cell])
    return list(distinct)


def format_number(value: float) -> str:
    """A number with all its digits; empty if it is not there."""
    return "" if np.isnan(value) else repr(float(value))


def format_settings(task: Task) -> str:
    """All that a run changes."""
    return " ".join((*task.overrides, *task.of_designs))


def format_csv(finished: Finished, columns: list[Column]) -> str:
    """The table as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = [one.name for one in finished.study.parameters]
    headings = [f"{one.name} [{one.unit}]" if one.unit else one.name for one in columns]
    writer.writerow([*COLUMNS_BEFORE, *names, *headings, *COLUMNS_BEHIND])
    for number, (point, task, row) in enumerate(zip(finished.points, finished.tasks, finished.rows)):
        writer.writerow([
            number + 1, *map(format_cell, point), *(format_number(one.values[number]) for one in columns),
            row.exit_code, int(row.converged), "; ".join(row.warnings), row.error, format_settings(task), row.hash,
        ])  # fmt: skip
    return text.getvalue()


def make_hdf5(finished: Finished, columns: list[Column]) -> bytes:
    """The table as the bytes of an HDF5 file."""
    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:
        file.attrs.update({"format": np.bytes_(FORMAT), "version": VERSION, "units": np.bytes_("SI")})
        for number, parameter in enumerate(finished.study.parameters):
            values = [point[number] for point in finished.points]
            data = np.array(values, dtype=float) if are_numbers(values) else encode_texts(map(format_cell, values))
            dataset = write_dataset(file, f"parameters/{parameter.name}", data)
            dataset.attrs["keys"] = encode_texts(parameter.keys)
        for one in columns:
            dataset = write_dataset(file, f"measures/{one.measure}", one.values)
            dataset.attrs["unit"] = np.bytes_(one.unit)
            dataset.attrs["label"] = np.bytes_(one.name.encode("utf-8"))
        rows = finished.rows
        write_dataset(file, "exit_code", np.array([row.exit_code for row in rows]))
        write_dataset(file, "converged", np.array([int(row.converged) for row in rows]))
        texts = {
            "warnings": ["; ".join(row.warnings) for row in rows], "error": [row.error for row in rows],
            "set": [format_settings(task) for task in finished.tasks], "hash": [row.hash for row in rows],
        }  # fmt: skip
        for name, values in texts.items():
            write_dataset(file, name, encode_texts(values))
    return memory.getvalue()


def encode_texts(values: Any) -> Any:
    """Texts as an array of UTF-8 strings."""
    return np.array([one.encode("utf-8") for one in values] or [b""])


def write_dataset(file: h5py.File, name: str, values: Any) -> h5py.Dataset:
    """Writes a dataset as all files of the project have them: chunked, with checksums, without times."""
    return file.create_dataset(name, data=values, chunks=True, fletcher32=True, track_times=False)
