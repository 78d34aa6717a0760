"""The ride on the page: how the vibration of the seats is judged, third-octave bands, suspensions, tyres."""

from collections.abc import Iterable

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.report.histories import Channel
from sprung_tools.report.packing import Packed
from sprung_tools.report.shown_motion import list_monitored
from sprung_tools.runs.ride_assessment import (
    Vibration,
    calc_assessment,
    calc_bands,
    calc_vibration,
    describe_comfort,
    list_remarks,
)
from sprung_tools.runs.ride_measures import (
    calc_contact,
    calc_travel,
    find_suspensions,
    find_tyres,
    list_seats,
    read_window,
)
from sprung_tools.signals.third_octaves import BOUNDED, NOMINAL, PROFICIENCY, calc_comfort_boundary

MOST_POINTS = 6


def list_judged(results: ResultsFile) -> list[str]:
    """The points whose vibration is judged, as `points/BODY.POINT`: the seats; without any, the points in the
    summary."""
    points = list_seats(results) or [f"points/{name}" for name in list_monitored(results)]
    return [point for point in points if results.has(f"{point}/acceleration")][:MOST_POINTS]


def calc_vibrations(results: ResultsFile) -> dict[str, Vibration]:
    """The weighted accelerations of the points that are judged. InputError if the samples do not allow it."""
    return {point: calc_vibration(results, point) for point in list_judged(results)}


def list_ride_channels(vibrations: dict[str, Vibration]) -> list[Channel]:
    """The running r.m.s. of each point as a history."""
    return [
        Channel("Ride", f"{name_of(point)}, running r.m.s. over 1 s (Wk)", one.running, "m/s^2")
        for point, one in vibrations.items()
    ]


def name_of(point: str) -> str:
    """The name of a point on the page: `points/chassis.seat` → `chassis.seat`."""
    return point.removeprefix("points/")


def pack_ride(results: ResultsFile, vibrations: dict[str, Vibration], problem: str) -> Packed | None:
    """The measures of one run; None for a mechanism, which has neither tyres nor a seat. problem: why the vibration
    cannot be judged, or empty."""
    tyres, springs = find_tyres(results), find_suspensions(results)
    if not tyres and not list_seats(results):
        return None
    window = read_window(results)
    points = []
    for point, vibration in vibrations.items():
        found = calc_assessment(results, point, window, vibration)
        words = None if found.total is None else describe_comfort(found.total)
        points.append({
            "name": name_of(point), **found._asdict(), "words": words,
            "bands": clean(calc_bands(results, point, window)),
        })  # fmt: skip
    travels: list[Packed] = []
    contacts: list[Packed] = []
    try:
        travels = [{"name": name, **calc_travel(results, name, window)._asdict()} for name in springs]
        contacts = [{"name": name, **calc_contact(results, name, window)._asdict()} for name in tyres]
    except InputError as error:  # unequally spaced samples; the rest of the page does not need equal ones
        problem = problem or str(error)
    return {"problem": problem, "remarks": list_remarks(results, list(vibrations), window), "points": points,
            "travel": travels, "tyres": contacts}  # fmt: skip


def clean(values: Iterable[float | None]) -> list[float | None]:
    """Numbers with six digits, which are enough to draw them; None stays."""
    return [None if value is None else float(f"{value:.6g}") for value in values]


def pack_boundaries() -> Packed:
    """The third-octave bands and the boundaries of reduced comfort over them; None where there is no boundary."""
    centres = np.array(NOMINAL)
    inside = (centres >= BOUNDED[0]) & (centres <= BOUNDED[1])
    curves = {
        exposure: [value if within else None for value, within in
                   zip(clean(calc_comfort_boundary(exposure, centres)), inside)]
        for exposure in PROFICIENCY
    }  # fmt: skip
    return {"centres": list(NOMINAL), "curves": curves}
