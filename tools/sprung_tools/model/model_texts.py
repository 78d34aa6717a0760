"""Run file and vehicle file as a results file keeps them, with what `--set` changed."""

import tomllib
from collections.abc import Iterator, Sequence
from typing import Any

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import text_of
from sprung_tools.files.results_file import ResultsFile


def read_run_file(results: ResultsFile) -> dict[str, Any]:
    """The run file with its overrides, as a dict; empty if the results keep none. InputError if it is not TOML."""
    run = parse_text(results, "model/run_text")
    for keys, value in list_overrides(results):
        if not is_of_vehicle(keys):
            set_value(run, keys, value)
    return run


def read_vehicle_file(results: ResultsFile, *, required: bool = True) -> dict[str, Any]:
    """The vehicle file with its overrides (`--set vehicle.…`), as a dict. InputError if it is not TOML, or if the
    results keep none; then an empty dict where it is not `required`."""
    if required and "model/vehicle_text" not in results.file:
        raise InputError(f"{results.path}: error: no dataset 'model/vehicle_text'")
    vehicle = parse_text(results, "model/vehicle_text")
    for keys, value in list_overrides(results):
        if is_of_vehicle(keys):
            set_value(vehicle, keys[1:], value)
    return vehicle


def read_compression_stop(results: ResultsFile, name: str) -> float | None:
    """The deflection at which a suspension's compression stop begins [m], None if it has none. InputError if the
    results keep no vehicle file."""
    for force in read_vehicle_file(results).get("forces", ()):
        if force.get("name") == name:
            return force.get("compression_stop", {}).get("deflection")
    return None


def parse_text(results: ResultsFile, name: str) -> dict[str, Any]:
    """A dataset of one TOML text as a dict; empty if it is not there. InputError if it is not TOML."""
    dataset = results.file.get(name)
    if dataset is None:
        return {}
    try:
        return tomllib.loads(text_of(dataset[()]))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{results.path}: error: '{name}' is not TOML ({error})") from error


def list_overrides(results: ResultsFile) -> Iterator[tuple[list[str], str]]:
    """(keys, value) of each `--set KEY.PATH=VALUE` of the run; the value as it was written."""
    for assignment in results.file.get("model/overrides", ()):
        path, _, value = text_of(assignment).partition("=")
        yield [key.strip().strip("\"'") for key in path.split(".")], value


def is_of_vehicle(keys: Sequence[str]) -> bool:
    """Whether an override is one of the vehicle file (`vehicle` alone is the run file's key that names that file)."""
    return len(keys) > 1 and keys[0] == "vehicle"


def set_value(table: Any, keys: Sequence[str], value: str) -> None:
    """Sets a key in nested tables; an entry of an array is named by its `name` or its position from 0. A bare word is a
    string."""
    for key in keys[:-1]:
        if isinstance(table, list):
            named = [entry for entry in table if entry.get("name") == key]
            table = named[0] if named else table[int(key)]
        else:
            table = table.setdefault(key, {})
    try:
        table[keys[-1]] = tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        table[keys[-1]] = value.strip()
