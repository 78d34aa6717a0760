"""One run of a study: it starts the program and takes the measures from what it wrote."""

import json
import math
import os
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import RESPONSE, open_hdf5, read_numbers
from sprung_tools.files.results_file import ResultsFile, open_results
from sprung_tools.programs.calls import (
    BAD_INPUT,
    CHECK_FAILED,
    GOOD,
    INTERRUPTED,
    Outcome,
    make_command,
    name_override,
)
from sprung_tools.programs.kept_process import call_kept
from sprung_tools.runs.fatigue_measures import list_fatigue_objects
from sprung_tools.runs.labelled_responses import Response
from sprung_tools.runs.measures import (
    UNKNOWN,
    Measure,
    Measures,
    Objects,
    find_points,
    is_converged,
    list_history_objects,
    list_linear_objects,
    list_objects,
)
from sprung_tools.runs.ride_assessment import list_remarks
from sprung_tools.runs.ride_measures import list_row_remarks, list_static_remarks, read_window
from sprung_tools.runs.section_stress import list_stress_remarks, list_stressed_bodies
from sprung_tools.runs.ride_of_response import list_frequency_remarks
from sprung_tools.runs.ride_of_response import list_points as list_judged
from sprung_tools.runs.run_warnings import list_warnings
from sprung_tools.runs.stored_histories import list_coarse
from sprung_tools.signals.spans import Span
from sprung_tools.study.description import Strength
from sprung_tools.study.kept_rows import Row, keep_row
from sprung_tools.study.machine_faults import is_of_machine
from sprung_tools.study.measure_names import check_names, check_response_points
from sprung_tools.study.storage import choose_storage

OF_RESULTANTS = ("stresses", "histories", "fatigue")  # measures that need the loads of sections at every output
ERROR = ": error: "  # in the text of an error, behind the place
PROGRAM = "program/"  # what the names of values in the program's own JSON begin with


class Task(NamedTuple):
    """A run that is to be made. superelements: the files that it reads; problem: why it cannot be made, else empty;
    of_designs: what is changed of designs, as `design.NAME.KEY=VALUE`."""

    hash: str
    overrides: tuple[str, ...]
    superelements: tuple[Path, ...]
    problem: str
    of_designs: tuple[str, ...] = ()


class Measured(NamedTuple):
    """What is taken from a run: whether it converged, its warnings, its measures."""

    converged: bool
    warnings: tuple[str, ...]
    measures: Measures


class Setting(NamedTuple):
    """What all runs of a study share. rows: the file of rows; scratch: a folder for files that do not stay; results:
    the folder of the results files, if they are kept; has_one_vehicle: whether all runs are of one vehicle file;
    strength: for measures of fatigue."""

    rows: Path
    program: Path
    command: str
    run: Path
    measures: tuple[str, ...]
    scratch: Path
    results: Path | None
    has_one_vehicle: bool
    strength: Strength | None

    @property
    def needs_file(self) -> bool:
        """Whether measures are taken from a file, which modes and equilibrium do not write."""
        wanted = self.results is not None or any(not name.startswith(PROGRAM) for name in self.measures)
        return wanted and self.command in ("run", "response")


def make_and_keep(task: Task, setting: Setting) -> Row:
    """Makes a run, and keeps its row unless the run was interrupted or failed for a reason that says nothing about
    it."""
    row = make_run(task, setting)
    if row.exit_code != INTERRUPTED and not is_of_machine(row.error):
        keep_row(setting.rows, row)
    return row


def make_run(task: Task, setting: Setting) -> Row:
    """Makes a run, and measures it. Every failure is told in the row."""
    began = time.monotonic()
    if task.problem:
        return Row(task.hash, BAD_INPUT, task.problem, False, (), {}, 0.0)
    with tempfile.TemporaryDirectory(dir=setting.scratch) as name:
        folder = Path(name)
        (folder / "bodies").mkdir()
        for file in task.superelements:
            (folder / "bodies" / file.name).symlink_to(file.resolve())
        output = folder / "results.h5" if setting.needs_file else None
        overrides = list(task.overrides)
        if setting.command == "run" and setting.results is None and output is not None:
            overrides += choose_storage(setting.measures, task.overrides)
        command = make_command(setting.program, setting.command, setting.run, folder / "bodies", overrides, output)
        outcome = call_kept(command)
        exit_code, error = outcome.exit_code, name_override(outcome.error, overrides)
        measured = Measured(False, (), {})
        if exit_code in (GOOD, CHECK_FAILED):
            try:
                measured = measure(setting, outcome, output)
                if output is not None and setting.results is not None:
                    os.replace(output, setting.results / f"{task.hash[:16]}.h5")
            except InputError as problem:
                exit_code, error = BAD_INPUT, str(problem)
        error = error.replace(f"{folder}/", "")  # so that the same error is the same text
    return Row(task.hash, exit_code, error, *measured, time.monotonic() - began)


def measure(setting: Setting, outcome: Outcome, output: Path | None) -> Measured:
    """Takes the measures of a run. One that cannot be computed is a warning."""
    wanted = [name for name in setting.measures if not name.startswith(PROGRAM)]
    converged = outcome.exit_code == GOOD
    measures: Measures = {}
    warnings: tuple[str, ...] = ()
    if output is not None and setting.command == "run":
        with open_results(output) as results:
            converged = is_converged(results)
            warnings = tuple(dict.fromkeys(one.text for one in list_warnings(results)))
            if setting.has_one_vehicle:
                check_names(results, wanted)
            # The run has found the largest loads itself, of all its outputs.
            with_resultants = any(fnmatchcase(one, name.split("/")[0]) for name in wanted for one in OF_RESULTANTS)
            coarse = ", ".join(list_coarse(results, with_resultants=with_resultants))
            warnings += (f"largest values may be larger than measured: {coarse}",) if coarse else ()
            window = read_window(results)
            objects = list_wanted_objects(wanted, partial(list_objects, results, window))
            objects |= list_history_objects(results, window, wanted)
            if setting.strength is not None:
                objects |= list_fatigue_objects(results, window, *setting.strength)
            warnings += tuple(list_remarks_of(results, wanted, window))
            measures, problems = pick(objects, wanted)
            warnings += tuple(problems)
            unknown = [name for name in wanted if name in measures and measures[name].value is None]
            warnings += tuple(f"{name}: {UNKNOWN}" for name in unknown)
    elif output is not None:
        with open_hdf5(output, RESPONSE) as file:
            response = Response("", file, read_numbers(file, "frequency")[0])
            if setting.has_one_vehicle:
                check_response_points(response, list_points(wanted))
            measures, problems = pick(list_wanted_objects(wanted, partial(list_linear_objects, response)), wanted)
            warnings += tuple(problems)
            if any(name.startswith("points/") for name in wanted):
                warnings += tuple(list_frequency_remarks(response, list_points(wanted) or list_judged(response)))
    said = dict(flatten("program", read_json(outcome)))
    measures |= {
        name: Measure(value, "") for name, value in said.items()
        if any(fnmatchcase(name, one) for one in setting.measures)
    }  # fmt: skip
    order = {name: number for number, name in enumerate(setting.measures)}
    return Measured(converged, warnings, dict(sorted(measures.items(), key=lambda one: order.get(one[0], len(order)))))


def list_points(wanted: Sequence[str]) -> list[str]:
    """The points BODY.POINT that names of measures mention, without patterns."""
    points = [name.split("/")[1] for name in wanted if name.startswith(("points/", "bands/"))]
    return list(dict.fromkeys(point for point in points if "*" not in point))


def list_wanted_objects(wanted: Sequence[str], list_all: Callable[[Sequence[str]], Objects]) -> Objects:
    """The objects of the points that names of measures mention, and where one is a pattern also those of the points
    that the tools choose. list_all: the objects for points; none stands for the tools' choice."""
    named = list_points(wanted)
    has_pattern = any("*" in name.split("/")[1] for name in wanted if name.startswith(("points/", "bands/")))
    objects = list_all([]) if has_pattern or not named else {}
    return objects | list_all(named) if named else objects


def list_remarks_of(results: ResultsFile, wanted: Sequence[str], window: Span) -> list[str]:
    """What is to be said of the measures that are wanted, beside the warnings of the run."""

    def is_wanted(name: str) -> bool:
        return any(fnmatchcase(name.split("/")[0], one.split("/")[0]) for one in wanted)

    named = list_points(wanted)
    points = find_points(results, named) if is_wanted("points") or is_wanted("bands") else []
    with_mtvv = any(one.endswith("/mtvv") or one.endswith("*") for one in wanted)
    of_forces = [*list_static_remarks(results), *list_row_remarks(results)]
    of_points = list_remarks(results, points, window, with_mtvv=with_mtvv) if points else []
    remarks = [one for one in of_points if one not in of_forces]
    remarks += of_forces if is_wanted("suspensions") or is_wanted("tyres") else []
    return remarks + (list_stress_remarks(results, list_stressed_bodies(results)) if is_wanted("stresses") else [])


def pick(objects: Objects, wanted: Sequence[str]) -> tuple[Measures, list[str]]:
    """The measures whose names are wanted, from the objects that have some of them, and why objects have none because
    they cannot be computed. Others are not computed."""
    found: Measures = {}
    problems = []
    for name, calc in objects.items():
        if any(fnmatchcase(name, one.rpartition("/")[0]) or one.startswith(f"{name}/") for one in wanted):
            try:
                measures = calc()
            except InputError as error:
                if is_of_machine(str(error)):
                    raise
                problems.append(f"{name}: cannot be computed ({str(error).partition(ERROR)[2] or error})")
                continue
            found |= {key: one for key, one in measures.items() if any(fnmatchcase(key, pattern) for pattern in wanted)}
    return found, problems


def read_json(outcome: Outcome) -> Any:
    """What the program printed. InputError if it is no JSON."""
    try:
        return json.loads(outcome.printed)
    except ValueError as error:
        raise InputError(f"error: the program printed no JSON ({error})") from error


def flatten(path: str, value: Any) -> Iterator[tuple[str, float]]:
    """The numbers in JSON, by paths; entries of lists go by their numbers from 1."""
    if isinstance(value, dict):
        for key, one in value.items():
            yield from flatten(f"{path}/{key}", one)
    elif isinstance(value, list):
        for number, one in enumerate(value, start=1):
            yield from flatten(f"{path}/{number}", one)
    elif isinstance(value, (int, float)) and math.isfinite(value):
        yield path, float(value)
