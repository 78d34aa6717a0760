"""Warnings about the numbers of a run, from its results file: those that sprung-dynamics gave, and where the linear
modes of the vehicle are not valid. Files of programs that did not store their warnings have them computed anew."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags
from sprung_tools.files.hdf5_file import read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.files.stored_file import StoredFile
from sprung_tools.model.force_channels import CONTACT, find_force_channel
from sprung_tools.model.resolved_model import has_resolved_model, read_elements, read_settings
from sprung_tools.runs.labelled_runs import Run
from sprung_tools.runs.mode_history import read_neglected
from sprung_tools.runs.stored_histories import list_gaps

# The limits at which sprung-dynamics itself warns (dynamics/statistics/run_warnings.cpp).
TOO_MUCH_LEFT_OUT = 0.05  # share of the largest deflection or acceleration
ALARMING_CLOSURE = 1e-3  # relative
NEARLY = 0.9  # of the run's largest acceleration
CONTACT_CHANGES = ("touches the ground", "leaves the ground")  # as in dynamics/forces/tyre.cpp

SUMMARY, MODES, EQUILIBRIUM = "summary", "modes", "equilibrium"  # which numbers a warning concerns


class RunWarning(NamedTuple):
    """A warning: the numbers it concerns (SUMMARY, MODES, EQUILIBRIUM; of a response "response"), what these are of
    (bodies, points; empty: all), the text."""

    section: str
    of: tuple[str, ...]
    text: str


def list_warnings(results: ResultsFile) -> list[RunWarning]:
    """All warnings of a run, the gravest first."""
    if results.file.has_group("warnings"):
        given = read_warnings(results.file)
    elif not has_resolved_model(results):  # of version 1
        return warn_of_energy(results)
    else:
        given = [*warn_of_energy(results), *warn_of_missing_modes(results)]
    return [*given, *warn_of_wheels_in_the_air(results)]


def read_warnings(file: StoredFile) -> list[RunWarning]:
    """The warnings that sprung-dynamics gave, in a file of results or of a response."""
    concerns, of, texts = (read_texts(file, f"warnings/{name}") for name in ("concerns", "of", "text"))
    return [
        RunWarning(section, tuple(filter(None, names.split(", "))), text)
        for section, names, text in zip(concerns, of, texts)
    ]


def warn_of_energy(results: ResultsFile) -> list[RunWarning]:
    """The warning of an energy balance that does not close."""
    has_summary = results.file.has_group("summary")
    closure = results.file.attribute("summary", "energy_closure", float, 0.0) if has_summary else 0.0
    if closure <= ALARMING_CLOSURE:
        return []
    text = (
        f"the energy balance does not close (relative {closure:.1e}): do not trust this run; try a smaller relative "
        "tolerance"
    )
    return [RunWarning(SUMMARY, ("computation",), text)]


def warn_of_missing_modes(results: ResultsFile) -> list[RunWarning]:
    """The warning of the mode left out that would contribute most, in the summary and at the modes; none where modes
    join as they are needed."""
    if read_settings(results)["adaptivity"].get("enabled"):
        return []
    judged = find_judged(results)
    worst = TOO_MUCH_LEFT_OUT
    text = flexible = ""
    for body, values in read_neglected(results).items():
        for number in np.unique(values[judged, 2]):
            chosen = np.flatnonzero(judged & (values[:, 2] == number))
            shares = values[chosen, :2]
            if np.max(shares) <= worst:
                continue
            worst, flexible = float(np.max(shares)), body
            deflection, acceleration = 100.0 * np.max(shares, axis=0)
            time = results.time[chosen[np.argmax(np.max(shares, axis=1))]]
            text = (
                f"modes are missing: {body}.mode {number:.0f}, which was left out, would have reached "
                f"{deflection:.3g} % of the largest deflection and {acceleration:.3g} % of the largest acceleration so "
                f"far of the points asked for (first at t = {time:.3g} s); take more modes"
            )
    if not text:
        return []
    points = tuple(name for name in results.names("summary/points") if name.partition(".")[0] == flexible)
    return [RunWarning(SUMMARY, points, text), RunWarning(MODES, (flexible,), text)]


def find_judged(results: ResultsFile) -> Flags:
    """Samples from which the recorded shares are judged [n]: those after the points in the summary have come to nearly
    their largest acceleration. Before, shares of the largest value so far are shares of next to nothing."""
    largest = np.zeros_like(results.time)
    for point in results.names("summary/points"):
        quantity = f"points/{point}/acceleration.y"
        if results.has(quantity):
            largest = np.maximum(largest, np.abs(results.series(quantity)[0]))
    return np.maximum.accumulate(largest) >= NEARLY * np.max(largest)


def warn_of_wheels_in_the_air(results: ResultsFile) -> list[RunWarning]:
    """The warning that the vehicle's modes, which are those of small motion, do not hold while a wheel is off the
    ground."""
    if not results.has("model/modes/undamped_frequency"):
        return []
    tyres = [force.name for force in read_elements(results, "forces").values() if force.on_road]
    contacts = {name: find_force_channel(results, name, CONTACT) for name in tyres}
    has_events = results.file.has_dataset("events/text")
    happened = zip(*(read_texts(results.file, f"events/{part}") for part in ("object", "text"))) if has_events else ()
    changed = {name for name, text in happened if text in CONTACT_CHANGES}  # also where no contact is stored
    airborne = [
        name for name, one in contacts.items() if name in changed or one and np.any(results.series(one)[0] < 0.5)
    ]
    if not airborne:
        return []
    text = (
        "the vehicle's modes and frequencies are those of small motion about the equilibrium; here "
        f"{', '.join(airborne)} left the ground"
    )
    return [RunWarning(EQUILIBRIUM, tuple(airborne), text)]


def list_doubts(runs: Sequence[Run]) -> list[str]:
    """What the runs warned of, and what their files do not hold or hold thinned, each in a line: what every command
    says beside the numbers, curves and files that it makes of runs. Without what concerns the vehicle's modes about its
    equilibrium: only the measures and the page of `report` have them."""
    doubts = []
    for run in runs:
        warnings = dict.fromkeys(one.text for one in list_warnings(run.results) if one.section != EQUILIBRIUM)
        doubts += [f"warning: {run.label}: {text}" for text in warnings]
        doubts += [f"remark: {run.label}: {text}" for text in list_gaps(run.results)]
    return doubts
