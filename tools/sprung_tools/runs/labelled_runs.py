"""Runs on a tool's command line: files `[LABEL=]FILE`, quantities `[LABEL=]QUANTITY`, spans of time."""

import os
from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results


class Run(NamedTuple):
    """An open results file with the name it has in legends and tables."""

    label: str
    results: object


class Shown(NamedTuple):
    """A quantity with the name it has on axes and in tables."""

    label: str
    quantity: str


def split_label(argument):
    """`LABEL=VALUE` → (LABEL, VALUE); without a label, or where a file has this very name, ("", argument)."""
    label, separator, value = argument.partition("=")
    return (label, value) if separator and not os.path.exists(argument) else ("", argument)


def open_runs(arguments):
    """Opens the files of add_run_arguments(), each under a name of its own. InputError as open_results()."""
    runs = []
    for argument in arguments:
        label, path = split_label(argument)
        results = open_results(path)
        runs.append(Run(label or describe(results), results))
    for tell_apart in (lambda run, _: os.path.basename(run.results.path), lambda _, number: f"no. {number}"):
        labels = [run.label for run in runs]
        if len(set(labels)) < len(labels):
            runs = [Run(f"{run.label} ({tell_apart(run, number)})", run.results) for number, run in enumerate(runs, 1)]
    return runs


def shown_quantities(arguments):
    """The quantities of add_run_arguments()."""
    pairs = [split_label(argument) for argument in arguments]
    return [Shown(label or quantity, quantity) for label, quantity in pairs]


def runs_with(runs, shown):
    """Those runs that hold a quantity (a rigid body has no deflection). InputError if none does."""
    found = [run for run in runs if run.results.has(shown.quantity)]
    if not found:
        runs[0].results.series(shown.quantity)  # raises, naming what there is
    return found


def describe(results):
    """A run named by what is flexible in it: `chassis 2 modes`, or `rigid`."""
    flexible = [(body, results.num_modes(body)) for body in results.names("bodies")]
    return ", ".join(f"{body} {count} modes" for body, count in flexible if count > 0) or "rigid"


def samples_between(results, start, end):
    """Which samples lie from `start` to `end` [s], None for the run's own. InputError if there are none."""
    first = results.time[0] if start is None else start
    last = results.time[-1] if end is None else end
    inside = (results.time >= first) & (results.time <= last)
    if not np.any(inside):
        raise InputError(f"{results.path}: error: no samples from {first:g} to {last:g} s")
    return inside
