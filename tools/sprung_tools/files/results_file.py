"""Reading results files.

    with open_results("bump_2modes.h5") as results:
        time = results.time                                              # [n] s
        height, unit = results.series("bodies/chassis/displacement.y")   # [n] m, from static equilibrium

A *quantity* is written as the file names it (dynamics/output/results.md), with a component:
`bodies/chassis/position.angle`, `bodies/chassis/center_of_mass/acceleration.y`, `points/chassis.seat/velocity.x`,
`joints/pin/reaction.torque`, `bodies/chassis/modal/amplitude.2`. A component is x, y, angle, of reactions and of loads
of force elements x, y, torque, or a column's number from 1; quantities with one value per sample have none.
`displacement` is the position relative to static equilibrium.

A fault of a file, or a name that it does not hold, is an InputError whose text is `path: error: …`.
"""

import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import RESULTS, open_hdf5, read_numbers, read_text
from sprung_tools.files.point_motion import (
    BodyMotion,
    calc_derived,
    find_derived,
    list_derived_points,
    read_body_motion,
)
from sprung_tools.files.stored_file import StoredFile, name_group

COMPONENTS, LOAD_COMPONENTS = ("x", "y", "angle"), ("x", "y", "torque")
MOTION = ("position", "velocity", "acceleration")  # histories of each body


class Quantity(NamedTuple):
    """The parts of a quantity's name: dataset, component ("" if none), whether its static value is subtracted."""

    dataset: str
    component: str
    from_static: bool


def parse_quantity(text: str) -> Quantity:
    """Parses a quantity's name: `bodies/chassis/displacement.y` → Quantity("bodies/chassis/position", "y", True)."""
    folder, _, last = text.strip("/").rpartition("/")
    name, _, component = last.partition(".")
    from_static = name == "displacement"
    return Quantity(f"{folder}/{'position' if from_static else name}".strip("/"), component, from_static)


def list_components(dataset: str, columns: int) -> list[str]:
    """The names of the components of a history with some columns; none where columns have numbers alone."""
    group, *_, name = dataset.split("/")
    if group in ("bodies", "points") and columns in (2, 3) and "/modal/" not in dataset:
        return list(COMPONENTS[:columns])
    is_load = (group == "joints" and name.startswith("reaction")) or (group == "forces" and name.startswith("on_"))
    return list(LOAD_COMPONENTS) if is_load and columns == 3 else []


def open_results(path: str | Path) -> "ResultsFile":
    """Opens a results file. InputError if it cannot be used or its run did not finish."""
    file = open_hdf5(str(path), RESULTS)
    try:
        return ResultsFile(file)
    except InputError:
        file.close()
        raise


class ResultsFile:
    """A complete results file, open for reading; made by open_results()."""

    def __init__(self, file: StoredFile) -> None:
        self.file = file
        self.path: str = file.filename
        self._motions: dict[str, BodyMotion] = {}  # of bodies, from which those of points were computed
        self.kept: dict[str, Any] = {}  # what readers have made of groups of the file, by their names
        if file.attribute("", "complete", int, 0) != 1:
            raise InputError(
                f"{self.path}: error: the run that wrote this file did not finish (complete = 0); "
                "sprung-dynamics run --resume completes it"
            )
        self.time, _ = read_numbers(file, "time")
        if self.time.ndim != 1 or self.time.size < 2 or np.any(np.diff(self.time) <= 0):
            raise InputError(f"{self.path}: error: dataset 'time' must be two or more increasing values")

    def __enter__(self) -> "ResultsFile":
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    @property
    def title(self) -> str:
        """The run's title; the file's name if it has none."""
        return read_text(self.file, "", "title", "") or os.path.basename(self.path)

    @property
    def is_from_balance(self) -> bool:
        """Whether static equilibrium was sought. Displacements are counted from there, and the run starts there unless
        it is continued."""
        group = "model/equilibrium"
        return self.file.has_group(group) and self.file.attribute(group, "is_static_equilibrium", int, 0) == 1

    @property
    def is_continued(self) -> bool:
        """Whether the run continues another one (`continue_from`): only such a run starts later than at 0."""
        return bool(self.time[0] > 0.0)

    def names(self, group: str) -> list[str]:
        """The names in a group, e.g. names("bodies"); empty if there is no such group. Joints and forces are in the
        order of the vehicle file. Among the points are those that are not stored, but follow from the motion of their
        bodies."""
        names = self.file.names(group)
        kind = group.strip("/").rpartition("/")[2]
        if kind in ("joints", "forces"):
            return sorted(names, key=lambda name: self._read_places(kind).get(name, 0))
        if group.strip("/") == "points":
            return sorted({*names, *list_derived_points(self.file)})
        return names

    def _read_places(self, kind: str) -> dict[str, int]:
        """The places of joints or forces in the vehicle file; 0 of each that the file does not tell."""
        key = f"places of {kind}"
        if key not in self.kept:
            group = f"model/resolved/{kind}"
            told = set(self.file.names(group))
            self.kept[key] = {
                name: self.file.attribute(f"{group}/{name}", "place", int, 0) if name in told else 0
                for name in told.union(self.file.names(kind))
            }
        places: dict[str, int] = self.kept[key]
        return places

    def has(self, quantity: str) -> bool:
        """Whether the file holds the dataset behind a quantity, or what it follows from."""
        dataset = parse_quantity(quantity).dataset
        return self.file.has_dataset(dataset) or find_derived(self.file, dataset) is not None

    def has_series(self, quantity: str) -> bool:
        """Whether series() gives a quantity: its dataset is a history, and its component one of its columns."""
        wanted = parse_quantity(quantity)
        if not self.has(quantity):
            return False
        every = self.file.every(wanted.dataset)
        shape = self.file.shape(wanted.dataset) or (self.time.size, 2)  # a point's motion that follows from its body
        if len(shape) > 2 or shape[:1] != (self.file.count_rows(wanted.dataset, every, self.time.size),):
            return False
        try:
            column = self._column(shape, wanted, quantity)
            if wanted.from_static and column is not None:
                self._static_value(wanted.dataset, column)
        except InputError:
            return False
        return True

    def history(self, dataset: str) -> tuple[Floats, str]:
        """Reads a dataset, or computes it if it is the motion of a point that is not stored. Returns (values, unit)."""
        derived = None if self.file.has_dataset(dataset) else find_derived(self.file, dataset)
        if derived is None:
            return read_numbers(self.file, dataset)
        if derived.body not in self._motions:
            self._motions[derived.body] = read_body_motion(self.file, derived.body)
        return calc_derived(self.file, derived, self._motions)

    def _find_stored(self, quantity: str) -> str:
        """The dataset behind a quantity; of a point that is not stored, that of its body."""
        dataset = parse_quantity(quantity).dataset
        if not self.file.has_dataset(dataset):
            derived = find_derived(self.file, dataset)
            if derived:  # a deflection follows from amplitudes, which are stored as often as positions are
                dataset = f"bodies/{derived.body}/{'position' if derived.what == 'deflection' else derived.what}"
        return dataset

    def every(self, quantity: str) -> int:
        """The number of outputs from one stored row of a quantity to the next. What stands between is interpolated."""
        return self.file.every(self._find_stored(quantity))

    def describe_coarse(self, quantity: str) -> str:
        """That the dataset behind a quantity is not stored at every output, and what to do; empty if it is. For
        spectra, filters and counts interpolation is not enough."""
        dataset = self._find_stored(quantity)
        every = self.file.every(dataset)
        if every == 1:
            return ""
        step = float(np.median(np.diff(self.time)))
        return (
            f"'{dataset}' is stored every {1e3 * every * step:g} ms only, but is needed at every output: make the run "
            f"again with --set output.step.{name_group(dataset)}={step:.9g}, and first with --dry-run, which says how "
            "large its results will be"
        )

    def check_every_output(self, quantity: str) -> None:
        """Throws InputError if the dataset behind a quantity is not stored at every output."""
        coarse = self.describe_coarse(quantity)
        if coarse:
            raise InputError(f"{self.path}: error: {coarse}")

    def num_modes(self, body: str) -> int:
        """The number of modes that a body has in the run, 0 if it is rigid."""
        shape = self.file.shape(f"bodies/{body}/modal/mode_number")
        return shape[0] if shape else 0

    def mode_numbers(self, body: str) -> Integers:
        """The numbers in its superelement of the modes that a body has in the run; empty if it is rigid. InputError if
        the superelement has no such mode."""
        if self.num_modes(body) == 0:
            return np.zeros(0, dtype=int)
        name = f"bodies/{body}/modal/mode_number"
        numbers, _ = read_numbers(self.file, name)
        if not self.superelement(body):
            raise InputError(f"{self.path}: error: 'model/bodies/{body}' does not name the superelement of its modes")
        shapes = f"model/superelements/{self.superelement(body)}/shapes"
        shape = self.file.shape(shapes)
        if not shape:
            raise InputError(f"{self.path}: error: no dataset '{shapes}'")
        if not np.all(np.isin(numbers, np.arange(1, shape[-1] + 1))):
            raise InputError(
                f"{self.path}: error: dataset '{name}' holds numbers that are not those of a mode, 1 to {shape[-1]}"
            )
        return numbers.astype(int)

    def superelement(self, body: str) -> str:
        """The name of a body's superelement, empty if it has none."""
        group = f"model/bodies/{body}"
        return read_text(self.file, group, "superelement", "") if self.file.has_group(group) else ""

    def force_kind(self, force: str) -> str:
        """The kind of a force, `tyre` for example; empty if the file does not say."""
        return read_text(self.file, f"forces/{force}", "kind", "")

    def series(self, quantity: str) -> tuple[Floats, str]:
        """Reads a quantity's history. Returns (values [n], unit). InputError names what the file holds instead."""
        wanted = parse_quantity(quantity)
        if not self.has(quantity):
            raise self._no_such(quantity, wanted.dataset)
        values, unit = self.history(wanted.dataset)
        if values.ndim not in (1, 2) or values.shape[0] != self.time.size:
            raise InputError(
                f"{self.path}: error: dataset '{wanted.dataset}' has shape {values.shape}, "
                f"expected {self.time.size} rows, one for each sample"
            )
        column = self._column(values.shape, wanted, quantity)
        if column is None:
            return values, unit
        values = values[:, column]
        if wanted.from_static:
            values = values - self._static_value(wanted.dataset, column)
        units = [part.strip() for part in unit.split(",")]  # "m, m, rad": one for each column
        return values, (units[column] if column < len(units) else unit)

    def _no_such(self, quantity: str, dataset: str) -> InputError:
        group, name, *_ = (*dataset.split("/"), "")
        owner = "bodies" if group == "recovery" else group
        is_motion = group == "bodies" and dataset.removeprefix(f"{group}/{name}/") in MOTION
        stored = {name_group(one) for one in self.file.list_histories(f"{group}/{name}")}
        is_left_out = is_motion or name_group(dataset) not in stored
        if self.file.has_group(f"model/resolved/{owner}/{name}") and is_left_out:
            return self.file.fail(self.file.describe_missing(dataset))
        folder = quantity.strip("/") if self.file.has_group(quantity.strip("/")) else dataset
        while folder and not self.file.has_group(folder):
            folder = folder.rpartition("/")[0]
        there = ", ".join(self.names(folder)) or "nothing"
        return InputError(f"{self.path}: error: no quantity '{quantity}': '/{folder}' holds {there}")

    def _column(self, shape: tuple[int, ...], wanted: Quantity, quantity: str) -> int | None:
        component, is_vector = wanted.component, len(shape) == 2
        if not is_vector and component == "":
            return None
        columns = shape[1] if is_vector else 1
        known = list_components(wanted.dataset, columns)
        if is_vector and component in known:
            return known.index(component)
        if is_vector and component.isdecimal() and 1 <= int(component) <= columns:
            return int(component) - 1
        expected = "none" if not is_vector else ", ".join(known) or f"1 to {columns}"
        raise InputError(f"{self.path}: error: '{quantity}' has component '{component}', expected {expected}")

    def _static_value(self, dataset: str, column: int) -> float:
        if not self.is_from_balance:
            raise InputError(f"{self.path}: error: no displacement in '{dataset}': static equilibrium was not sought")
        # The equilibrium holds bodies' frames and points, and a centre of mass as a point:
        # bodies/A/center_of_mass → points/A.center_of_mass.
        group, name, *rest = dataset.split("/")[:-1]
        place = f"points/{name}.{rest[0]}" if group == "bodies" and rest else f"{group}/{name}"
        return float(read_numbers(self.file, f"model/equilibrium/{place}")[0][column])
