"""The commands of the two programs as functions."""

import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sprung.results import Folder, Mode, Response, Results
from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_text import flatten_settings, split_key
from sprung_tools.programs.calls import (
    BAD_INPUT,
    CHECK_FAILED,
    GOOD,
    INTERRUPTED,
    Outcome,
    as_path,
    call,
    format_overrides,
    make_command,
)
from sprung_tools.programs.finding import DYNAMICS, REDUCE, find_program
from sprung_tools.programs.in_process import call_here, load_module

PathLike = str | Path
Overrides = Mapping[str, Any] | None


class NumericalError(Exception):
    """A computation that did not come to its end, or a program that was ended from outside."""


def build(designs: PathLike | Iterable[PathLike], output_dir: PathLike, *, force: bool = False) -> list[Path]:
    """Reduces designs to superelements; those that are up to date are left alone unless they are forced. designs: one,
    or several.

    Returns their files. InputError for a design that cannot be used."""
    files = [Path(design) for design in ([designs] if isinstance(designs, (str, Path)) else designs)]
    command: list[PathLike] = [find_program(REDUCE), "build", *map(as_path, files), "--quiet"]
    command += ["--output-dir", as_path(output_dir)]
    check(call(command + ["--force"] * force), GOOD)
    return [Path(output_dir) / f"{file.stem}.h5" for file in files]


def run(
    file: PathLike,
    *,
    superelements: PathLike | None = None,
    overrides: Overrides = None,
    output: PathLike | None = None,
) -> Results:
    """Makes a run.

    overrides: keys of the run file, and of the vehicle file after `vehicle.`, with their values, as `--set` takes them.
    A table stands for its keys: {"road": {"height": 0.1}} changes the height alone. As a whole count a road with its
    shape, an empty table, and the value of a key of a body, a joint, a motion or a force, such as a spring's law.
    output: results file; without it the file goes away with the Results. A run of which a check failed has results,
    too: see Results.converged.
    """
    with prepare_output(output) as (path, folder):
        start("run", file, superelements, overrides, path)
        return Results(path, folder)


def response(
    file: PathLike,
    *,
    superelements: PathLike | None = None,
    overrides: Overrides = None,
    output: PathLike | None = None,
) -> Response:
    """Computes the frequency response to the road about the equilibrium. The arguments are those of run()."""
    with prepare_output(output) as (path, folder):
        start("response", file, superelements, overrides, path)
        return Response(path, folder)


def modes(file: PathLike, *, superelements: PathLike | None = None, overrides: Overrides = None) -> list[Mode]:
    """Computes the vehicle's modes about its equilibrium, the lowest first."""
    return [Mode(**one) for one in start("modes", file, superelements, overrides)["modes"]]


def equilibrium(
    file: PathLike, *, superelements: PathLike | None = None, overrides: Overrides = None
) -> dict[str, Any]:  # fmt: skip
    """Computes the static equilibrium: what `sprung-dynamics equilibrium --json` prints."""
    return start("equilibrium", file, superelements, overrides)


def explain_calls() -> str:
    """Whether the commands of sprung-dynamics are done in this process, or by processes and why."""
    program = find_program(DYNAMICS)
    module = load_module(program)
    return f"in this process, by {module.what}" if module.call else f"by processes of {program}: {module.what}"


@contextmanager
def prepare_output(output: PathLike | None) -> Iterator[tuple[Path, Folder | None]]:
    """The file to be written, and the folder that goes away with it where none is given; at once after an error."""
    if output is not None:
        yield Path(output), None
        return
    folder = Folder(prefix="sprung-")
    try:
        yield Path(folder.name) / "results.h5", folder
    except BaseException:
        folder.cleanup()
        raise


def start(
    verb: str, file: PathLike, superelements: PathLike | None, overrides: Overrides, output: Path | None = None
) -> dict[str, Any]:
    """Has sprung-dynamics do something. Returns the JSON that it prints."""
    where = None if superelements is None else Path(superelements)
    settings = format_overrides(list_settings(overrides))
    outcome = call_here(make_command(find_program(DYNAMICS), verb, Path(file), where, settings, output))
    check(outcome, GOOD, CHECK_FAILED)
    found: dict[str, Any] = json.loads(outcome.printed)
    return found


def list_settings(overrides: object) -> dict[str, Any]:
    """The keys and values of overrides, with a key for each value in a table. TypeError for what is no mapping."""
    if overrides is None:
        return {}
    if not isinstance(overrides, Mapping):
        raise TypeError(f"overrides is {overrides!r}, expected a mapping such as {{'road.height': 0.1}}")
    return flatten_settings(overrides, is_value=is_whole)


def is_whole(key: str, table: Mapping[str, Any]) -> bool:
    """Whether a table is the value of its key as a whole: a road with its shape, on which its other keys depend; in the
    vehicle file `vehicle.forces.suspension.spring`, and whatever else belongs to a body or an element; an empty one."""
    parts = split_key(key)
    return not table or (key == "road" and "shape" in table) or (parts[:1] == ["vehicle"] and len(parts) > 3)


def check(outcome: Outcome, *good: int) -> None:
    """Throws the error of a program that did not end with one of the exit codes that are good."""
    if outcome.exit_code in good:
        return
    if outcome.exit_code == INTERRUPTED:
        raise KeyboardInterrupt
    if outcome.exit_code == BAD_INPUT:
        raise InputError(outcome.error)
    raise NumericalError(outcome.error)
