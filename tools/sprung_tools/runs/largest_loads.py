"""The largest loads of sections along bodies: bending moment, shear and axial force, from the loads on a body where the
file has them, else from its modes, and how far the two differ."""

import os
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_real
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.rigid_body_loads import (
    Superelement,
    calc_rigid_moments,
    find_common_rows,
    has_all_loads,
    read_superelement,
)
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.ride_measures import read_window
from sprung_tools.runs.section_stress import ENDINGS, FROM_LOADS, FROM_MODES
from sprung_tools.runs.stations import place_stations, read_stations
from sprung_tools.signals.spans import Span

MOMENT, SHEAR, AXIAL = LOADS = ("moment", "shear", "axial")


class Peak(NamedTuple):
    """A load of largest size: its value with its sign [N·m or N], the station's x and y in the body frame [m], the time
    [s]; step: the time between the stored rows that it is the largest of [s], 0 where it is that of all outputs."""

    value: float
    x: float
    y: float
    time: float
    step: float = 0.0


def find_peak(results: ResultsFile, values: Floats, stations: Floats, window: Span, every: int = 1) -> Peak:
    """Where and when loads [n×stations] are largest. stations: their positions in the body frame [stations×2] m;
    every: as samples_between() takes it."""
    inside = np.flatnonzero(samples_between(results, *window, every))
    row, column = np.unravel_index(np.argmax(np.abs(values[inside])), (inside.size, values.shape[1]))
    sample = inside[row]
    step = every * float(np.median(np.diff(results.time))) if every > 1 else 0.0
    x, y = map(float, stations[column])
    return Peak(float(values[sample, column]), x, y, float(results.time[sample]), step)


def find_signs(load: str, stations: Floats) -> Floats:
    """By what the values of a load at the stations are multiplied, so that all elements that are drawn over x count in
    its direction: a moment of one that runs against it, by -1, as place_stations() tells."""
    return place_stations(stations).signs if load.startswith(MOMENT) else np.ones(len(stations))


def has_load(results: ResultsFile, body: str, load: str, source: str) -> bool:
    """Whether the file has a load of a body from its loads or from its modes; a body without modes has no stations of
    the latter."""
    return (results.file.shape(f"recovery/{body}/{load}{ENDINGS[source]}") or (0, 0))[1] > 0


class OwnPeak(NamedTuple):
    """A load of largest size: its value with its sign [N·m or N], the number of its station from 0, the time [s]."""

    value: float
    station: int
    time: float


def read_own(results: ResultsFile, body: str, name: str) -> OwnPeak | None:
    """The largest value of a body that the run itself has found over all of its outputs within the span of its
    statistics, of which the file may hold only some; None in older files. name: `moment_from_loads`."""
    group = f"summary/sections/{body}"
    there = results.file.attributes(group) if results.file.has_group(group) else ()
    if f"{name}_station" not in there:
        return None
    value, time = (read_real(results.file, group, key) for key in (name, f"{name}_time"))
    stations = read_stations(results, body)
    number = results.file.attribute(group, f"{name}_station", int)
    if not 0 <= number < len(stations):
        has = f"'{group}' has {name}_station = {number}"
        raise InputError(f"{results.path}: error: {has}, expected at least 0 and below {len(stations)}")
    return OwnPeak(value * float(find_signs(name, stations)[number]), number, time)


def read_own_peak(results: ResultsFile, body: str, name: str, window: Span) -> Peak | None:
    """The same with the place of its station; None for another span than that of the run's statistics, too."""
    own = read_own(results, body, name) if window == read_window(results) else None
    if own is None:
        return None
    stations = read_stations(results, body)
    x, y = map(float, stations[own.station])
    return Peak(own.value, x, y, own.time)


def calc_peak(results: ResultsFile, body: str, load: str, source: str, window: Span) -> Peak | None:
    """The largest of LOADS along a body, from its loads or from its modes; None if the file lacks it."""
    if not has_load(results, body, load, source):
        return None
    own = read_own_peak(results, body, f"{load}{ENDINGS[source]}", window)
    if own is not None:
        return own
    dataset = f"recovery/{body}/{load}{ENDINGS[source]}"
    values, _ = read_numbers(results.file, dataset)
    stations = read_stations(results, body)
    return find_peak(results, values * find_signs(load, stations), stations, window, results.file.every(dataset))


def find_best_peak(results: ResultsFile, body: str, load: str, window: Span) -> Peak | None:
    """The largest of LOADS along a body from its loads where the file has them, else from its modes; None if it lacks
    both."""
    peaks = (calc_peak(results, body, load, source, window) for source in (FROM_LOADS, FROM_MODES))
    return next((peak for peak in peaks if peak is not None), None)


def find_bending(results: ResultsFile, body: str, window: Span, superelements: str | None) -> Peak | None:
    """A body's largest moment. Where the file has none of a rigid body, it takes the folder of its superelement, else
    the result is None."""
    superelement = open_missing(results, body, superelements)
    if superelement is None:
        return find_best_peak(results, body, MOMENT, window)
    moments, stations = calc_rigid_moments(results, body, superelement)
    every = find_common_rows(results, body)
    return find_peak(results, moments * find_signs(MOMENT, stations), stations, window, every)


def open_missing(results: ResultsFile, body: str, superelements: str | None) -> Superelement | None:
    """Reads the superelement by which the moments of a rigid body are computed that the file has not; None if it has
    them, or no folder is given."""
    name = results.superelement(body)
    is_there = any(has_load(results, body, MOMENT, source) for source in (FROM_LOADS, FROM_MODES))
    if is_there or superelements is None or not name:
        return None
    return read_superelement(os.path.join(superelements, f"{name}.h5"))


def list_moment_remarks(results: ResultsFile, superelements: str | None) -> list[str]:
    """Of which rigid bodies find_bending() gives moments that lack something."""
    remarks = []
    for body in results.names("bodies"):
        superelement = open_missing(results, body, superelements)
        if superelement is not None and not has_all_loads(superelement):
            count, total = superelement.stiffness.shape[0], superelement.num_freedoms
            remarks.append(
                f"{body}: the moment may be too small: {superelement.path} has no section loads, and {count} of the "
                f"{total} vectors that the model has; build it again, or have the run store 'recovery'"
            )
    return remarks


def calc_moment_difference(results: ResultsFile, body: str, window: Span) -> float | None:
    """The largest difference between a body's bending moments from its loads and from its modes, N·m; None if the file
    lacks one of them."""
    sources = (FROM_LOADS, FROM_MODES)
    if not all(has_load(results, body, MOMENT, source) for source in sources):
        return None
    own = read_own_peak(results, body, f"{MOMENT}_difference", window)
    if own is not None:
        return abs(own.value)
    from_loads, from_modes = (
        read_numbers(results.file, f"recovery/{body}/{MOMENT}{ENDINGS[source]}")[0] for source in sources
    )
    return float(np.max(np.abs(from_loads - from_modes)[samples_between(results, *window)]))
