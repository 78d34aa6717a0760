"""Measures of a run for the driver and the wheels, from one results file over a span of time."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags, Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_real
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.force_channels import (
    CONTACT,
    DEFLECTION,
    EXTENT,
    FORCE,
    find_force_channel,
    list_force_channels,
    read_force_channel,
)
from sprung_tools.model.resolved_model import read_element, read_elements, read_settings
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.rounding import ROUNDING, clear_each, read_acceleration
from sprung_tools.signals.ride_weighting import HIGHEST, SAMPLES_PER_PERIOD, calc_dose, weight_acceleration
from sprung_tools.signals.spans import Span
from sprung_tools.signals.spectra import calc_rms

END_STOP = "hydraulic-stop"  # kind of the elements that act from a deflection of 0 on


class Comfort(NamedTuple):
    """Measures of a point's vertical acceleration [m/s²]; dose: vibration dose value [m/s^1.75]."""

    rms: float
    peak: float
    weighted_rms: float
    dose: float


class Travel(NamedTuple):
    """How far a suspension moves: largest deflections from balance [m], compression is positive; None where the
    deflection in balance is not known.

    whole: the way from balance to the compression stop [m], None without one, too; hits: how often that stop was
    struck, stopped: the time on it [s], both None without one; rebound_hits, rebound_stopped: of the rebound stop.
    """

    compression: float | None
    rebound: float | None
    whole: float | None
    hits: int | None
    stopped: float | None
    rebound_hits: int | None
    rebound_stopped: float | None


class Contact(NamedTuple):
    """A tyre's contact with the road: static and greatest load [N], r.m.s. of the difference from the static load [N],
    time off the ground [s], time without load [s]. A tyre is also without load where it still reaches the road but
    rises faster than it springs back. static and dynamic_rms are None where the static load is not known.
    """

    static: float | None
    greatest: float
    dynamic_rms: float | None
    off_ground: float
    unloaded: float

    def over_static(self, load: float | None) -> float | None:
        """A load over the static one; None where that is not known, or 0."""
        return load / self.static if load is not None and self.static else None


def read_window(results: ResultsFile, start: float | None = None, end: float | None = None) -> Span:
    """The span of time (from, to) [s] that is judged: as given, else the statistics window of the run; only the part
    that the run has."""
    if start is None or end is None:
        settings = read_settings(results)
        start = settings["statistics_from"] if start is None else start
        end = settings["statistics_to"] if end is None else end
    return max(float(start), float(results.time[0])), min(float(end), float(results.time[-1]))


def sampling_step(results: ResultsFile) -> float:
    """The time between samples [s]. InputError if they are not equally spaced (the last one may come early): nothing
    is interpolated, because what lies between the samples is not known."""
    steps = np.diff(results.time)
    step = float(np.median(steps))
    uneven = np.flatnonzero(np.abs(steps[:-1] - step) > 1e-6 * step)
    if uneven.size:
        first = int(uneven[0])
        raise InputError(
            f"{results.path}: error: the samples in 'time' are not equally spaced: {steps[first]:.6g} s from sample "
            f"{first + 1} at {results.time[first]:.6g} s to the next, {step:.6g} s in the middle of all, expected "
            "equal ones, as sprung-dynamics stores them: interpolate all histories to equal steps of at most "
            f"{1e3 / (HIGHEST * SAMPLES_PER_PERIOD):g} ms, or make the run again"
        )
    return step


def calc_comfort(results: ResultsFile, point: str, window: Span) -> Comfort:
    """Measures of a point's vertical acceleration as people feel it. point: `points/chassis.seat` or
    `bodies/chassis/center_of_mass`."""
    step = sampling_step(results)
    inside = samples_between(results, *window)
    acceleration = read_acceleration(results, point, "y")
    try:
        weighted = weight_acceleration(acceleration, step)[inside]
    except ValueError as error:
        raise InputError(f"{results.path}: error: {error}") from error
    return Comfort(*calc_plain(acceleration[inside]), calc_rms(weighted), calc_dose(weighted, step))


def calc_plain(acceleration: Floats) -> tuple[float, float]:
    """The measures of an acceleration that are not weighted: r.m.s. and peak."""
    return calc_rms(acceleration), float(np.max(np.abs(acceleration)))


def list_seats(results: ResultsFile) -> list[str]:
    """Every point called seat, as `points/BODY.seat`."""
    return [f"points/{name}" for name in results.names("points") if name.rpartition(".")[2] == "seat"]


def find_tyres(results: ResultsFile) -> list[str]:
    """The names of the tyres whose histories are stored."""
    drawn = [force.name for force in read_elements(results, "forces").values() if force.drawing == "wheel"]
    return [name for name in drawn if list_force_channels(results, name)]


def find_suspensions(results: ResultsFile) -> dict[str, str]:
    """The springs along a line, and the end stops, whose histories are stored: the quantity of the deflection by the
    element's name, and by `NAME partner` of the second of two coupled springs."""
    found = {}
    for force in read_elements(results, "forces").values():
        is_wanted = force.drawing == "spring" or force.kind == END_STOP
        channels = list_force_channels(results, force.name) if is_wanted else []
        if any(one.role == EXTENT for one in channels):
            for one in (one for one in channels if one.role == DEFLECTION):
                prefix = one.name.removesuffix("overlap").removesuffix("deflection").replace("_", "")
                found[f"{force.name} {prefix}".rstrip()] = one.quantity
    return found


def calc_travel(results: ResultsFile, name: str, window: Span) -> Travel:
    """How far a suspension, named as find_suspensions() does, moves from its balance. A stop counts as struck where a
    sample is beyond it."""
    quantity = find_suspensions(results)[name]
    every = results.every(quantity)
    inside = samples_between(results, *window, every)
    deflection, _ = results.series(quantity)
    static = calc_static(results, quantity, deflection, inside)
    element = read_element(results, "forces", quantity.split("/")[1])
    stop = 0.0 if element.kind == END_STOP else element.parameters.get("compression_stop")
    rebound_stop = element.parameters.get("rebound_stop")
    deflection = deflection[inside]
    row_step = every * sampling_step(results)
    # A deflection is a difference of lengths that are some times as large, and has their rounding.
    travel = clear_each(deflection - (static or 0.0), 10.0 * ROUNDING * float(np.max(np.abs(deflection))))
    return Travel(
        None if static is None else float(travel.max()),
        None if static is None else float(travel.min()),
        None if stop is None or static is None else stop - static,
        *count_hits(None if stop is None else deflection > stop, row_step),
        *count_hits(None if rebound_stop is None else deflection < rebound_stop, row_step),
    )


def count_hits(struck: Flags | None, row_step: float) -> tuple[int | None, float | None]:
    """How often a stop is struck by samples, and the time on it [s]; None without a stop. struck: of each sample."""
    if struck is None:
        return None, None
    hits = int(np.count_nonzero(struck[1:] & ~struck[:-1]) + struck[0])
    return hits, float(np.count_nonzero(struck) * row_step)


def calc_static(results: ResultsFile, quantity: str, values: Floats, inside: Flags) -> float | None:
    """The value of a force element's channel in static equilibrium on level ground; its mean over the span if
    equilibrium was not sought. A file of an older program does not hold it: there it is the first value, and None if
    the run continues another one. quantity: as `forces/front_tyre/force`"""
    if not results.is_from_balance:
        return float(np.mean(values[inside]))
    _, element, channel = quantity.split("/")
    group = f"model/equilibrium/forces/{element}"
    if results.file.has_group(group):
        return read_real(results.file, group, channel)
    return None if results.is_continued else float(values[0])


def list_row_remarks(results: ResultsFile) -> list[str]:
    """That suspensions and tyres are judged by few rows, if they are."""
    loads = (find_force_channel(results, name, FORCE) for name in find_tyres(results))
    judged = [*find_suspensions(results).values(), *(quantity for quantity in loads if quantity is not None)]
    every = max((results.every(quantity) for quantity in judged), default=1)
    if every == 1:
        return []
    return [
        f"suspensions and tyres are judged by rows every {1e3 * every * sampling_step(results):g} ms: what lies "
        "between, such as the largest load and short times off the ground, is not seen"
    ]


def list_static_remarks(results: ResultsFile) -> list[str]:
    """Why values in static equilibrium are not known, or what stands in their place; empty if they are known."""
    if not find_tyres(results) and not find_suspensions(results):
        return []
    if not results.is_from_balance:
        return [
            "static equilibrium was not sought: static loads are mean values over the span, and travel counts from "
            "mean deflections"
        ]
    if results.is_continued and not results.file.has_group("model/equilibrium/forces"):
        return [
            f"static loads and travel are not known: the run continues another one from {results.time[0]:.6g} s on, "
            "and its file holds neither loads nor deflections in static equilibrium; those of the first run do"
        ]
    return []


def calc_contact(results: ResultsFile, name: str, window: Span) -> Contact:
    """A tyre's loads, its time off the ground and its time without load; the loads are those of all its wheels
    together."""
    force, _ = read_force_channel(results, name, FORCE)
    contact, _ = read_force_channel(results, name, CONTACT)
    quantity = find_force_channel(results, name, FORCE) or ""  # it is there: its history was read
    every = results.every(quantity)
    inside = samples_between(results, *window, every)
    static = calc_static(results, quantity, force, inside)
    dynamic_rms = None if static is None else calc_rms(force[inside] - static)
    row_step = every * sampling_step(results)
    off_ground, unloaded = (
        float(np.count_nonzero(bare) * row_step) for bare in (contact[inside] == 0, force[inside] <= 0.0)
    )
    return Contact(static, float(force[inside].max()), dynamic_rms, off_ground, unloaded)
