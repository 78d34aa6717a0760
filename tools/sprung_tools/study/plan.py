"""The runs of a study: for each point what `--set` changes, which superelements and which road it uses, and the hash of
everything that it reads."""

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.files.toml_text import cut_key, flatten_settings, split_key, strip_quotes
from sprung_tools.programs.calls import format_overrides
from sprung_tools.programs.finding import Programs
from sprung_tools.study.description import DESIGN, RANDOM_ROAD, Study
from sprung_tools.study.designs import Variant, hash_parts, make_variant, reduce_variant
from sprung_tools.study.machine_faults import is_of_machine
from sprung_tools.study.one_run import Task
from sprung_tools.study.random_roads import write_road
from sprung_tools.study.sampling import Point

ROW_VERSION = 3  # counts up when the same input gives other rows


class Draft(NamedTuple):
    """A run before stage one. changed: of the run and vehicle file, without a random road; of_designs: of designs."""

    changed: dict[str, Any]
    of_designs: dict[str, Any]
    variants: dict[str, Variant]
    road: dict[str, Any] | None
    road_hash: str
    problem: str


class Planner:
    """Makes the tasks of a study. folder: of the study, where variants of designs and roads are put."""

    def __init__(self, study: Study, folder: Path, programs: Programs) -> None:
        self.study, self.folder, self.programs = study, folder, programs
        self._run = TomlFile(study.run)
        self._hashes: dict[Path, str] = {}
        self._vehicles: dict[Path, dict[str, Any]] = {}  # root tables of vehicle files
        self._variants: dict[str, Variant | InputError] = {}
        self._roads: dict[str, tuple[dict[str, Any], str] | InputError] = {}

    def draft(self, point: Point) -> Draft:
        """What a point changes. A design or a road that cannot be made is the run's problem."""
        changed = flatten_settings(self.study.overrides)
        for parameter, value in zip(self.study.parameters, point):
            changed |= parameter.settings(value)
        all_changes = json.dumps(changed, default=str, sort_keys=True)
        road_changes = take_inside(changed, RANDOM_ROAD) if self.study.random_road else {}
        of_designs = {key: value for key, value in changed.items() if cut_key(key, DESIGN)}
        variants: dict[str, Variant] = {}
        road, road_hash, problem = None, "", ""
        try:
            for name, design in self.study.designs.items():
                variants[name] = self._make_variant(design, take_inside(changed, DESIGN, name))
            if self.study.random_road:
                road, road_hash = self._make_road(self.study.random_road | road_changes)
        except InputError as error:
            if is_of_machine(str(error)):
                raise
            problem, road_hash = str(error), all_changes  # a row of its own
        return Draft(changed, of_designs, variants, road, road_hash, problem)

    def finish(self, draft: Draft, failures: Mapping[Path, str]) -> Task:
        """The task of a run, after stage one. failures: folders of variants that could not be reduced, and why."""
        problem = draft.problem or next(
            (failures[one.folder] for one in draft.variants.values() if one.folder in failures), ""
        )
        overrides = format_overrides(draft.changed)
        strength = [str(self.study.strength)] if self.study.strength else []
        parts = [str(ROW_VERSION), self._hash(self.programs.dynamics), self.study.command, *self.study.measures,
                 *strength, "overrides", *overrides, draft.road_hash, problem]  # fmt: skip
        superelements: tuple[Path, ...] = ()
        if not problem:
            vehicle = self.study.run.parent / str(draft.changed.get("vehicle", self._run.data.get("vehicle", "")))
            superelements = tuple(self._list_superelements(vehicle, draft))
            for file in (self.study.run, vehicle, *self._list_files(vehicle, draft), *superelements):
                parts += [file.name, self._hash(file)]
        if draft.road is not None:
            overrides += format_overrides({"road": draft.road})
        of_designs = tuple(format_overrides(draft.of_designs))
        return Task(hash_parts([part.encode() for part in parts]), tuple(overrides), superelements, problem, of_designs)

    def _make_variant(self, design: Path, changes: Mapping[str, Any]) -> Variant:
        key = json.dumps([str(design), changes])
        if key not in self._variants:
            try:
                self._variants[key] = make_variant(design, changes, self.folder / "designs")
            except InputError as error:
                self._variants[key] = error
        return raise_error(self._variants[key])

    def _make_road(self, settings: Mapping[str, Any]) -> tuple[dict[str, Any], str]:
        key = json.dumps(settings, sort_keys=True)
        if key not in self._roads:
            try:
                self._roads[key] = write_road(settings, self.folder / "roads")
            except InputError as error:
                self._roads[key] = error
        return raise_error(self._roads[key])

    def _read_vehicle(self, vehicle: Path) -> dict[str, Any]:
        """The root table of a vehicle file; empty if there is none, which the program then tells."""
        if vehicle not in self._vehicles:
            self._vehicles[vehicle] = TomlFile(vehicle).data if vehicle.is_file() else {}
        return self._vehicles[vehicle]

    def _list_superelements(self, vehicle: Path, draft: Draft) -> list[Path]:
        """The files of the superelements that a vehicle names: of the study's designs, else of its folder. A file that
        is not there is left for the program to miss."""
        names = set(find_superelements(self._read_vehicle(vehicle).get("bodies")))
        for key, value in draft.changed.items():
            *_, last = ("", *map(strip_quotes, split_key(key)))
            names.update(find_superelements({last: value}))
        files = []
        for name in sorted(names):
            if name in draft.variants:
                files.append(draft.variants[name].superelement)
            elif self.study.superelements is not None and (self.study.superelements / f"{name}.h5").is_file():
                files.append(self.study.superelements / f"{name}.h5")
        return files

    def _list_files(self, vehicle: Path, draft: Draft) -> list[Path]:
        """The files that texts in the run file, in the vehicle file and in the changes name, such as that of a road."""
        tables = (self._run.data, self._read_vehicle(vehicle), draft.changed)
        texts = {text for table in tables for text in list_texts(table)}
        paths = {folder / text for text in texts for folder in {self.study.run.parent, vehicle.parent}}
        return sorted(path for path in paths - {self.study.run, vehicle} if self._hash(path))

    def _hash(self, path: Path) -> str:
        if path not in self._hashes:
            self._hashes[path] = calc_hash(path)
        return self._hashes[path]


def calc_hash(path: str | Path) -> str:
    """The SHA-256 of a file; empty if there is none."""
    if not os.path.isfile(path):
        return ""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def reduce_variants(
    programs: Programs, drafts: Iterable[Draft], pool: Executor, report: Callable[[], None]
) -> dict[Path, str]:
    """Stage one for each distinct variant. report: called as each is done. Returns the folders of those that failed,
    and why."""
    variants = {one.folder: one for draft in drafts for one in draft.variants.values()}
    waiting = {folder: pool.submit(reduce_variant, programs.reduce, one) for folder, one in variants.items()}
    failures = {}
    for folder, done in waiting.items():
        error = done.result()
        if error:
            failures[folder] = error
        report()
    return failures


def raise_error(value: Any) -> Any:
    """A value; an InputError is raised instead."""
    if isinstance(value, InputError):
        raise value
    return value


def take_inside(settings: dict[str, Any], *names: str) -> dict[str, Any]:
    """Takes the settings whose keys begin with parts of these names, without them."""
    found = {key: rest for key in settings if (rest := cut_key(key, *names))}
    return {rest: settings.pop(key) for key, rest in found.items()}


def list_texts(value: Any) -> list[str]:
    """All texts in tables and lists."""
    if isinstance(value, str):
        return [value]
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [text for part in parts for text in list_texts(part)]


def find_superelements(table: Any) -> list[str]:
    """The superelements that a table of a vehicle file names, or the tables in it."""
    if not isinstance(table, dict):
        return []
    name = table.get("superelement")
    inside = [found for one in table.values() for found in find_superelements(one)]
    return [name, *inside] if isinstance(name, str) else inside
