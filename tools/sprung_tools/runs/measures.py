"""All measures of a run or of a response under names of their own, with units: what `ride --json` prints, and what a
study collects.

A name is a path OBJECT/MEASURE such as `points/chassis.seat/wk_rms`; tools/README.md, "Measures", lists them all.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_real, read_text, read_texts
from sprung_tools.files.point_motion import CENTRE
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.files.stored_file import StoredFile
from sprung_tools.runs.labelled_responses import Response
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.largest_loads import (
    AXIAL,
    LOADS,
    SHEAR,
    calc_moment_difference,
    calc_peak,
    find_bending,
    find_best_peak,
)
from sprung_tools.runs.ride_assessment import calc_assessment, calc_bands, find_weighting_gap, point_name
from sprung_tools.runs.ride_measures import (
    calc_comfort,
    calc_contact,
    calc_plain,
    calc_travel,
    find_suspensions,
    find_tyres,
    list_seats,
    read_window,
)
from sprung_tools.runs.ride_of_response import (
    calc_linear_assessment,
    calc_linear_bands,
    list_frequency_remarks,
    list_points,
)
from sprung_tools.runs.rounding import read_acceleration
from sprung_tools.runs.run_warnings import ALARMING_CLOSURE, RunWarning, list_warnings, read_warnings
from sprung_tools.runs.section_stress import FROM_MODES, calc_section_stress, list_sources, list_stressed_bodies
from sprung_tools.runs.stored_histories import list_gaps
from sprung_tools.runs.vehicle_modes import WHERE
from sprung_tools.signals.spans import Span
from sprung_tools.signals.spectra import calc_rms
from sprung_tools.signals.third_octaves import NOMINAL

JSON_FORMAT, JSON_VERSION = "sprung-measures", 4  # tools/README.md, "Measures"
HISTORIES, OF_HISTORIES = "histories/", ("min", "max", "rms", "mean")
UNKNOWN = "the run has no such value (tools/README.md, Measures, tells when a value is null)"
# The units of the measures of each kind of object; those of the summary follow from the ends of their names.
POINT_UNITS = {
    "rms": "m/s^2", "peak": "m/s^2", "wk_rms": "m/s^2", "vdv": "m/s^1.75", "mtvv": "m/s^2", "crest_factor": "1",
    "wd_rms": "m/s^2", "we_rms": "rad/s^2", "total": "m/s^2", "absorbed_power": "W",
}  # fmt: skip
SUSPENSION_UNITS = {"compression": "m", "rebound": "m", "way_to_stop": "m", "stop_hits": "1", "time_on_stop": "s",
                    "rebound_stop_hits": "1", "time_on_rebound_stop": "s"}  # fmt: skip
TYRE_UNITS = {
    "static_load": "N", "greatest_load": "N", "dynamic_load_rms": "N", "time_off_ground": "s", "time_without_load": "s",
}  # fmt: skip
LOAD_UNITS = {
    "moment": "N m", "x": "m", "y": "m", "time": "s", "shear": "N", "axial": "N",
    "moment_size": "N m", "shear_size": "N", "axial_size": "N",
    "moment_from_modes": "N m", "shear_from_modes": "N", "axial_from_modes": "N", "moment_difference": "N m",
}  # fmt: skip
STRESS_UNITS = {"highest": "Pa", "lowest": "Pa", "largest_range": "Pa", "x": "m", "y": "m"}
BAND_UNITS = {f"{frequency:g}": "m/s^2" for frequency in NOMINAL}
MODE_UNITS = {"frequency": "Hz", "damping_ratio": "1"}
MOTION_UNITS = {"displacement": "m", "acceleration": "m/s^2", "constraint": "m"}
UNITS_OF = {
    "points": POINT_UNITS, "suspensions": SUSPENSION_UNITS, "tyres": TYRE_UNITS, "loads": LOAD_UNITS,
    "stresses": STRESS_UNITS,
    "modes": MODE_UNITS,
}  # fmt: skip


class Measure(NamedTuple):
    """A number with its unit; None where the object has no such value, as the way to a stop where there is no stop."""

    value: float | None
    unit: str


Measures = dict[str, Measure]  # by name
Objects = dict[str, Callable[[], Measures]]  # by name: computes the measures of the object


def combine(name: str, units: dict[str, str], values: Iterable[float | None]) -> Measures:
    """The measures of an object: its values in the order of the units. InputError if one is not finite."""
    measures = {}
    for (measure, unit), value in zip(units.items(), values, strict=True):
        if value is not None and not math.isfinite(value):
            raise InputError(f"{name}/{measure}: error: the measure is {value}, expected a finite number")
        measures[f"{name}/{measure}"] = Measure(None if value is None else float(value), unit)
    return measures


def find_points(results: ResultsFile, wanted: Sequence[str] = ()) -> list[str]:
    """The points to judge: those asked for; without any, every point called seat and the centre of mass of its body;
    without seats, the centres of mass of all bodies; of these, the ones whose acceleration the file has. Returns groups
    such as `points/chassis.seat`.
    """
    if not wanted:
        seats = list_seats(results)
        bodies = sorted({seat.split("/")[1].partition(".")[0] for seat in seats}) or results.names("bodies")
        found = seats + [f"bodies/{body}/{CENTRE}" for body in bodies]
        return [point for point in found if results.has(f"{point}/acceleration")]
    points = []
    for name in wanted:
        body, _, point = name.partition(".")
        is_centre = point == CENTRE and not results.file.has_dataset(f"points/{name}/acceleration")
        points.append(f"bodies/{body}/{CENTRE}" if is_centre else f"points/{name}")
    return points


def list_objects(
    results: ResultsFile, window: Span, points: Sequence[str] = (), superelements: str | None = None
) -> Objects:
    """What a run has measures of. points: BODY.POINT to judge, as find_points() takes them; superelements: folder of
    the superelement files, for the moments of rigid bodies."""
    objects: Objects = {"summary": partial(read_summary, results, window)}
    for folder in find_points(results, points):
        name = f"points/{point_name(folder)}"
        objects[name] = partial(measure_point, results, name, folder, window)
        bands = f"bands/{point_name(folder)}"
        objects[bands] = partial(measure_bands, results, bands, folder, window)
    for force in find_suspensions(results):
        objects[f"suspensions/{force}"] = partial(measure_suspension, results, force, window)
    for force in find_tyres(results):
        objects[f"tyres/{force}"] = partial(measure_tyre, results, force, window)
    for body in results.names("bodies"):
        objects[f"loads/{body}"] = partial(measure_loads, results, body, window, superelements)
    for body in list_stressed_bodies(results):
        objects[f"stresses/{body}"] = partial(measure_stresses, results, body, window)
    return objects | list_mode_objects(results)


def list_mode_objects(results: ResultsFile) -> Objects:
    """The vehicle's modes about its equilibrium that oscillate, `modes/K` with the number K that
    `sprung-dynamics modes` gives; none if the run did not start from equilibrium."""
    if not results.has(f"{WHERE}/undamped_frequency"):
        return {}
    frequency, _ = read_numbers(results.file, f"{WHERE}/undamped_frequency")
    damping, _ = read_numbers(results.file, f"{WHERE}/damping_ratio")
    return {
        f"modes/{k}": partial(combine, f"modes/{k}", MODE_UNITS, pair)
        for k, pair in enumerate(zip(frequency, damping), start=1) if pair[0] > 0.0
    }  # fmt: skip


def measure_point(results: ResultsFile, name: str, folder: str, window: Span) -> Measures:
    """The vibration of a point. folder: its group, `points/chassis.seat` for example."""
    return combine(name, POINT_UNITS, calc_point_values(results, folder, window))


def calc_point_values(results: ResultsFile, folder: str, window: Span) -> tuple[float | None, ...]:
    """The measures of a point in the order of POINT_UNITS; None for those that the file does not tell. folder: its
    group, `points/chassis.seat` for example."""
    if find_weighting_gap(results, folder):
        inside = samples_between(results, *window, results.every(f"{folder}/acceleration.y"))
        plain = calc_plain(read_acceleration(results, folder, "y", may_be_coarse=True)[inside])
        return (*plain, *[None] * (len(POINT_UNITS) - len(plain)))
    one, more = calc_comfort(results, folder, window), calc_assessment(results, folder, window)
    return (one.rms, one.peak, one.weighted_rms, one.dose, more.mtvv, more.crest, more.fore_aft, more.pitch, more.total,
            more.power)  # fmt: skip


def measure_bands(results: ResultsFile, name: str, folder: str, window: Span) -> Measures:
    """The r.m.s. of a point's vertical acceleration in third-octave bands, each under its nominal frequency in Hz;
    None of bands of which the samples are too few, and of all where it is not stored at every output."""
    is_coarse = results.describe_coarse(f"{folder}/acceleration.y") != ""
    return combine(name, BAND_UNITS, [None] * len(NOMINAL) if is_coarse else calc_bands(results, folder, window))


def measure_suspension(results: ResultsFile, name: str, window: Span) -> Measures:
    """The travel of a suspension."""
    one = calc_travel(results, name, window)
    return combine(f"suspensions/{name}", SUSPENSION_UNITS, one)


def measure_tyre(results: ResultsFile, name: str, window: Span) -> Measures:
    """The loads of a tyre."""
    one = calc_contact(results, name, window)
    values = (one.static, one.greatest, one.dynamic_rms, one.off_ground, one.unloaded)
    return combine(f"tyres/{name}", TYRE_UNITS, values)


def measure_loads(results: ResultsFile, body: str, window: Span, superelements: str | None) -> Measures:
    """The largest bending moment, shear and axial force of a body, from its loads where the file has them, else from
    its modes; their sizes; beside them those from the modes, and the largest difference of the moments; none of a body
    without moments."""
    bending = find_bending(results, body, window, superelements)
    if bending is None:
        return {}
    forces = [find_best_peak(results, body, load, window) for load in (SHEAR, AXIAL)]
    from_modes = [calc_peak(results, body, load, FROM_MODES, window) for load in LOADS]
    values = [peak and peak.value for peak in (bending, *forces)]
    sizes = [None if value is None else abs(value) for value in values]
    moment, *others = values
    return combine(f"loads/{body}", LOAD_UNITS, [
        moment, bending.x, bending.y, bending.time, *others, *sizes, *(peak and peak.value for peak in from_modes),
        calc_moment_difference(results, body, window),
    ])  # fmt: skip


def measure_stresses(results: ResultsFile, body: str, window: Span) -> Measures:
    """The stresses of a body's extreme fibres, from its loads where the file has them, else from its modes; x and y: of
    the stress of largest size."""
    section = calc_section_stress(results, body, list_sources(results, body)[0])
    stress = section.stress[samples_between(results, *window)]
    largest = np.unravel_index(int(np.argmax(np.abs(stress))), stress.shape)
    values = (stress.max(), stress.min(), np.ptp(stress, axis=0).max(), *section.positions[largest[1]])
    return combine(f"stresses/{body}", STRESS_UNITS, map(float, values))


def read_summary(results: ResultsFile, window: Span) -> Measures:
    """Everything in /summary, which sprung-dynamics computed; what it has of points only for the span of its own."""
    points = results.names("summary/points") if window == read_window(results) else []
    groups = {"summary": "", **{f"summary/points/{name}": "" for name in points}}
    return {
        f"{group}/{key}": Measure(read_real(results.file, group, key), MOTION_UNITS.get(key.partition("_")[0], "1"))
        for group in groups if results.file.has_group(group) for key in results.file.attributes(group)
    }  # fmt: skip


def list_linear_objects(response: Response, points: Sequence[str] = ()) -> Objects:
    """What the response of a linear vehicle on a random road has measures of: its points, and the r.m.s. of all
    outputs. points: BODY.POINT to judge (default: all of the file)."""
    objects: Objects = {}
    for point in points or list_points(response):
        objects[f"points/{point}"] = partial(measure_linear_point, response, point)
        objects[f"bands/{point}"] = partial(measure_linear_bands, response, point)
    for output in response.names():
        objects[f"outputs/{output}"] = partial(measure_output, response, output)
    return objects


def measure_linear_point(response: Response, point: str) -> Measures:
    """The vibration of a point of the linear vehicle."""
    one = calc_linear_assessment(response, point)
    values = {"rms": one.rms, "wk_rms": one.vertical, "wd_rms": one.fore_aft, "we_rms": one.pitch, "total": one.total,
              "absorbed_power": one.power}  # fmt: skip
    return combine(f"points/{point}", {name: POINT_UNITS[name] for name in values}, values.values())


def measure_linear_bands(response: Response, point: str) -> Measures:
    """The r.m.s. of the vertical acceleration of a point of the linear vehicle in third-octave bands."""
    density, _ = response.values(f"points/{point}/acceleration.y", is_spectrum=True)
    return combine(f"bands/{point}", BAND_UNITS, calc_linear_bands(response.frequency, density))


def measure_output(response: Response, output: str) -> Measures:
    """The r.m.s. of an output; none without a random road."""
    group = f"outputs/{output}"
    if "rms" not in response.file.attributes(group):
        return {}
    return {f"{group}/rms": Measure(response.rms(output), read_text(response.file, group, "unit"))}


def calc_measures(objects: Objects) -> Measures:
    """The measures of all objects."""
    return {name: measure for calc in objects.values() for name, measure in calc().items()}


def is_converged(results: ResultsFile) -> bool:
    """Whether no check of a run failed, as sprung-dynamics judges it for its exit code. A run that has not ended has no
    such judgement: then whether its energy balance closes."""
    closes = read_real(results.file, "summary", "energy_closure") <= ALARMING_CLOSURE
    return bool(results.file.attribute("summary", "converged", int, int(closes)))


def describe_run(results: ResultsFile, window: Span) -> dict[str, Any]:
    """What stands beside the measures of a run in JSON."""
    return {
        "kind": "run", "title": results.title, "set": read_overrides(results.file),
        "parameters": read_parameters(results), "span": {"from": window[0], "to": window[1], "unit": "s"},
        "converged": is_converged(results), "warnings": pack_warnings(list_warnings(results)),
        "not_stored": list_gaps(results),
    }  # fmt: skip


def read_parameters(results: ResultsFile) -> dict[str, Any]:
    """What was asked for in a run, by the names of `sprung-dynamics run --json`."""
    names = {"speed": "speed", "duration": "duration", "output_step": "output_step", "method": "integrator",
             "relative_tolerance": "relative_tolerance"}  # fmt: skip
    stored = results.file.attributes("model")
    found = {name: stored[key] for name, key in names.items() if key in stored}
    if results.file.has_group("model/road"):
        found["road"] = read_text(results.file, "model/road", "shape")
    flexible = [body for body in results.names("bodies") if results.num_modes(body)]
    return {**found, "modes": {body: [int(one) for one in results.mode_numbers(body)] for body in flexible}}


def describe_response(response: Response, points: Sequence[str] = ()) -> dict[str, Any]:
    """What stands beside the measures of a response in JSON. points: as list_linear_objects() takes them."""
    file = response.file
    told = read_texts(file, "remarks") if file.has_dataset("remarks") else []
    return {
        "kind": "response", "title": read_text(file, "", "title", ""), "set": read_overrides(file),
        "parameters": {"speed": read_real(file, "", "speed")},
        "span": {"from": float(response.frequency[0]), "to": float(response.frequency[-1]), "unit": "Hz"},
        "converged": True, "warnings": pack_warnings(read_warnings(file) if file.has_group("warnings") else []),
        "remarks": told + list_frequency_remarks(response, points or list_points(response)),
    }  # fmt: skip


def pack_warnings(warnings: Iterable[RunWarning]) -> list[dict[str, Any]]:
    """Warnings for JSON."""
    return [{"concerns": one.section, "of": one.of, "text": one.text} for one in warnings]


def read_overrides(file: StoredFile) -> list[str]:
    """What --set changed."""
    name = "model/overrides"
    return read_texts(file, name) if file.has_dataset(name) else []


def pack_measures(measures: Measures) -> dict[str, dict[str, Any]]:
    """Measures for JSON."""
    return {name: one._asdict() for name, one in measures.items()}


def list_history_objects(results: ResultsFile, window: Span, wanted: Iterable[str]) -> Objects:
    """The objects `histories/QUANTITY` that names of measures mention; QUANTITY is any of the results file, as
    ResultsFile.series() takes it."""
    names = [name.rpartition("/")[0] for name in wanted if name.startswith(HISTORIES)]
    there = [name for name in names if results.has(name.removeprefix(HISTORIES))]
    return {name: partial(measure_history, results, name, window) for name in there}


def measure_history(results: ResultsFile, name: str, window: Span) -> Measures:
    """Lowest, highest, r.m.s. and mean value of a quantity over a span of time."""
    values, unit = results.series(name.removeprefix(HISTORIES))
    values = values[samples_between(results, *window, results.every(name.removeprefix(HISTORIES)))]
    found = (values.min(), values.max(), calc_rms(values), values.mean())
    return combine(name, dict.fromkeys(OF_HISTORIES, unit), found)
