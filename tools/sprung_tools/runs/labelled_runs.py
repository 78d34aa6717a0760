"""Runs and quantities with the names that they have in tables and pictures: `[LABEL=]FILE`, `[LABEL=]QUANTITY`."""

import os
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import ResultsFile, open_results
from sprung_tools.files.whole_file import check_output
from sprung_tools.model.reduced_vectors import count_vectors, read_vectors
from sprung_tools.signals.spans import Span


class Run(NamedTuple):
    """An open results file with the name it has in legends and tables."""

    label: str
    results: ResultsFile


class Shown(NamedTuple):
    """A quantity with the name it has on axes and in tables."""

    label: str
    quantity: str


def split_label(argument: str) -> tuple[str, str]:
    """Splits `LABEL=VALUE` into (LABEL, VALUE); without a label, or if the argument is an existing file, ("",
    argument)."""
    label, separator, value = argument.partition("=")
    return (label, value) if separator and not os.path.exists(argument) else ("", argument)


def join_titles(titles: Iterable[str]) -> str:
    """The heading of what shows several vehicles: the title of each, once."""
    return ", ".join(dict.fromkeys(titles))


def check_labelled_output(path: str, arguments: Iterable[str]) -> None:
    """InputError if the file to be written is one of the files `[LABEL=]FILE`."""
    check_output(path, [split_label(one)[1] for one in arguments])


def open_runs(arguments: Iterable[str]) -> list[Run]:
    """Opens the files `[LABEL=]FILE` and gives each a name of its own. InputError as open_results()."""
    runs: list[Run] = []
    for argument in arguments:
        label, path = split_label(argument)
        results = open_results(path)
        runs.append(Run(label or describe(results), results))
    runs = distinguish(runs, [os.path.basename(run.results.path) for run in runs])
    return distinguish(runs, [f"no. {number}" for number in range(1, len(runs) + 1)])


def distinguish(runs: list[Run], additions: Sequence[str]) -> list[Run]:
    """Adds a text to each label if two of them are equal."""
    if len({run.label for run in runs}) == len(runs):
        return runs
    return [Run(f"{run.label} ({addition})", run.results) for run, addition in zip(runs, additions)]


def describe_spans(runs: Sequence[Run], spans: Iterable[Span]) -> str:
    """The span of time of each run: `rigid 0 to 4 s, 2 modes 0.5 to 2 s`."""
    return ", ".join(f"{run.label} {start:g} to {end:g} s" for run, (start, end) in zip(runs, spans, strict=True))


def shown_quantities(arguments: Iterable[str]) -> list[Shown]:
    """The quantities `[LABEL=]QUANTITY`; one without a label is its own label."""
    pairs = [split_label(argument) for argument in arguments]
    return [Shown(label or quantity, quantity) for label, quantity in pairs]


def runs_with(runs: Sequence[Run], shown: Shown) -> list[Run]:
    """The runs that hold a quantity; a rigid body has no deflection, for example. InputError if none does."""
    found = [run for run in runs if run.results.has(shown.quantity)]
    if not found:
        runs[0].results.series(shown.quantity)  # throws an InputError that names what the file holds
    return found


def list_lacking(runs: Sequence[Run], quantities: Iterable[Shown]) -> list[str]:
    """Which runs lack a quantity that others have, each in a line."""
    return [
        f"remark: {run.label}: has no '{shown.quantity}'"
        for shown in quantities for run in runs if not run.results.has(shown.quantity)
    ]  # fmt: skip


def describe(results: ResultsFile) -> str:
    """Names a run after its flexible bodies: `chassis 2 modes`, or `rigid`."""
    flexible = [body for body in results.names("bodies") if results.num_modes(body)]
    return ", ".join(f"{body} {count_vectors(read_vectors(results, body))}" for body in flexible) or "rigid"


def samples_between(results: ResultsFile, start: float | None, end: float | None, every: int = 1) -> Flags:
    """Which samples lie from `start` to `end` [s]; None stands for the run's begin or end. every: of a history whose
    rows are stored at each such output only, those rows: between them it is interpolated, and an r.m.s. of that would
    be too small. InputError if there are none."""
    first = results.time[0] if start is None else start
    last = results.time[-1] if end is None else end
    inside = (results.time >= first) & (results.time <= last) & (np.arange(results.time.size) % every == 0)
    if not np.any(inside):
        kind = "samples" if every == 1 else f"rows, of which every {every} samples have one,"
        raise InputError(
            f"{results.path}: error: no {kind} from {first:g} to {last:g} s; the run has those from "
            f"{results.time[0]:g} to {results.time[-1]:g} s"
        )
    return inside
