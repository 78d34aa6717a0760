"""How a run's vibration is judged at a seat: all measures of ISO 2631-1, absorbed power, third-octave bands.

The axes are the world's: fore-aft is along x, vertical along y. Pitch is the rotation of the body at the point. With
the multiplying factors of 8.2.2.1 for the seat surface the total is

    a_v = √(a_wx² + a_wz² + (0.4 m/rad · a_wry)²)                                                       (1)
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.point_motion import CENTRE
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import read_point
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.ride_measures import list_row_remarks, list_static_remarks, sampling_step
from sprung_tools.runs.rounding import calc_rounding, clear_rounding, read_acceleration
from sprung_tools.signals.absorbed_power import calc_absorbed_power
from sprung_tools.signals.ride_weighting import (
    LEFT,
    MEMORY,
    ROUNDING,
    RUNNING,
    SAMPLES_PER_PERIOD,
    WD,
    WE,
    WK,
    Weighting,
    calc_dose,
    calc_running_rms,
    describe_fault,
    weight_acceleration,
)
from sprung_tools.signals.spans import Span
from sprung_tools.signals.spectra import calc_rms
from sprung_tools.signals.third_octaves import NOMINAL, calc_third_octaves

PITCH = 0.4  # m/rad
# Annex C, C.2.3: from, up to [m/s²], words. The ranges overlap.
REACTIONS = (
    (0.0, 0.315, "not uncomfortable"), (0.315, 0.63, "a little uncomfortable"), (0.5, 1.0, "fairly uncomfortable"),
    (0.8, 1.6, "uncomfortable"), (1.25, 2.5, "very uncomfortable"), (2.0, np.inf, "extremely uncomfortable"),
)  # fmt: skip


class Vibration(NamedTuple):
    """The weighted accelerations of a point over the whole run [n]."""

    fore_aft: Floats  # Wd, m/s²
    vertical: Floats  # Wk, m/s²
    pitch: Floats | None  # We, rad/s²; None where the file does not tell it
    running: Floats  # r.m.s. of the vertical one over the second before, m/s²


class Assessment(NamedTuple):
    """The measures of a point over a span of time: weighted r.m.s. values, their total by (1), and of the vertical one
    the largest running r.m.s. (MTVV), vibration dose value and crest factor; absorbed power. Pitch and total are None
    where the file does not tell the rotation of the body."""

    fore_aft: float  # m/s²
    vertical: float  # m/s²
    pitch: float | None  # rad/s²
    total: float | None  # m/s²
    mtvv: float  # m/s²
    dose: float  # m/s^1.75
    crest: float
    power: float  # W


def name_body(point: str) -> str:
    """The body of a point. point: as calc_vibration() takes it."""
    group, name, *_ = point.split("/")
    return name.partition(".")[0] if group == "points" else name


def point_name(point: str) -> str:
    """The name of a point in tables: `points/chassis.seat` → `chassis.seat`. point: as calc_vibration() takes it."""
    group, name, *_ = point.split("/")
    return name if group == "points" else f"{name}.{CENTRE}"


def find_weighting_gap(results: ResultsFile, point: str) -> str:
    """Why a point has no weighted values and no absorbed power; empty if it has. point: as calc_vibration() takes
    it."""
    return results.describe_coarse(f"{point}/acceleration.y") or describe_fault(sampling_step(results))


def find_pitch_gap(results: ResultsFile, point: str) -> str:
    """Why the file does not tell the rotation of the body at a point; empty if it does. point: as calc_vibration()
    takes it."""
    dataset = f"bodies/{name_body(point)}/acceleration"
    if not results.has(dataset):
        return results.file.describe_missing(dataset)
    return f"'{dataset}' is not stored at every output" if results.file.every(dataset) > 1 else ""


def list_remarks(
    results: ResultsFile, points: Sequence[str], window: Span, *, with_mtvv: bool = True
) -> list[str]:
    """Which measures of points are left out because the samples are too few, or because the file does not tell the
    rotation of their bodies, and why; whether the span is too short for the MTVV, or begins while the weightings lack
    the vibration before the run; and what is said of values in static equilibrium and of tyres and suspensions.
    with_mtvv: whether that measure is asked for."""
    fine, remarks = part_coarse(results, points)
    fault = describe_fault(sampling_step(results)) if fine else ""
    if fault:
        names = ", ".join(map(point_name, fine))
        remarks.append(f"{names}: without the weighted values and the absorbed power: {fault}")
        fine = []
    gaps = {point: find_pitch_gap(results, point) for point in fine}
    remarks += [f"{point_name(point)}: without We and the total: {gap}" for point, gap in gaps.items() if gap]
    times = results.time[samples_between(results, *window)]
    length = float(times[-1] - times[0])
    if fine and with_mtvv and length < RUNNING * (1.0 - ROUNDING):
        remarks.append(
            f"the MTVV is the largest r.m.s. over {RUNNING:g} s, and the span has only {length:.3g} s: what is missing "
            "counts as 0, so that the MTVV is too low"
        )
    settled = float(results.time[0]) + MEMORY
    if fine and results.is_continued and window[0] < settled * (1.0 - ROUNDING):
        remarks.append(
            f"the run continues another one from {results.time[0]:.6g} s on, and its vibration before counts as 0: "
            f"the MTVV and the other weighted values hold from {settled:.4g} s on (--from), when {100.0 * LEFT:g} % is "
            "left of it in the filters"
        )
    return remarks + list_static_remarks(results) + list_row_remarks(results)


def part_coarse(results: ResultsFile, points: Sequence[str]) -> tuple[list[str], list[str]]:
    """Parts points into those whose acceleration is stored at every output, and remarks on the others. points: as
    calc_vibration() takes them."""
    by_reason: dict[str, list[str]] = {}
    for point in points:
        by_reason.setdefault(results.describe_coarse(f"{point}/acceleration.y"), []).append(point)
    fine = by_reason.pop("", [])
    return fine, [
        f"{', '.join(map(point_name, some))}: without the weighted values, the absorbed power and the third-octave "
        f"bands, and with the r.m.s. and the peak of the stored rows: {reason}"
        for reason, some in by_reason.items()
    ]


def read_pitch_acceleration(results: ResultsFile, point: str) -> Floats:
    """The angular acceleration [n], rad/s², of the body at a point. point: as calc_vibration() takes it."""
    group, name, *_ = point.split("/")
    body = name_body(point)
    angular, _ = results.series(f"bodies/{body}/acceleration.angle")
    if group == "points" and results.num_modes(body):
        modal, _ = read_numbers(results.file, f"bodies/{body}/modal/acceleration")
        angular = angular + modal @ read_point(results, name).shapes[2]
    return clear_rounding(angular, calc_rounding(results, point, "acceleration"))


def calc_vibration(results: ResultsFile, point: str) -> Vibration:
    """The weighted accelerations of a point. point: `points/chassis.seat` or `bodies/chassis/center_of_mass`."""
    step = sampling_step(results)

    def weigh(values: Floats, weighting: Weighting) -> Floats:
        try:
            return weight_acceleration(values, step, weighting)
        except ValueError as error:
            raise InputError(f"{results.path}: error: {error}") from error

    along, up = (read_acceleration(results, point, axis) for axis in ("x", "y"))
    vertical = weigh(up, WK)
    pitch = None if find_pitch_gap(results, point) else weigh(read_pitch_acceleration(results, point), WE)
    return Vibration(weigh(along, WD), vertical, pitch, calc_running_rms(vertical, step))


def calc_assessment(results: ResultsFile, point: str, window: Span, vibration: Vibration | None = None) -> Assessment:
    """All measures of a point over a span of time. vibration: of calc_vibration(), if it is known already."""
    felt = vibration or calc_vibration(results, point)
    inside = samples_between(results, *window)
    step = sampling_step(results)
    fore_aft, vertical = calc_rms(felt.fore_aft[inside]), calc_rms(felt.vertical[inside])
    pitch = None if felt.pitch is None else calc_rms(felt.pitch[inside])
    power = calc_absorbed_power(read_acceleration(results, point, "y"), step)[inside]
    return Assessment(
        fore_aft, vertical, pitch, None if pitch is None else calc_total(fore_aft, vertical, pitch),
        float(np.max(calc_running_rms(felt.vertical[inside], step))), calc_dose(felt.vertical[inside], step),
        float(np.max(np.abs(felt.vertical[inside]))) / vertical if vertical > 0.0 else 0.0, float(np.mean(power)),
    )  # fmt: skip


def calc_total(fore_aft: float, vertical: float, pitch: float) -> float:
    """The total of weighted r.m.s. values by (1)."""
    return float(np.sqrt(fore_aft**2 + vertical**2 + (PITCH * pitch) ** 2))


def calc_bands(results: ResultsFile, point: str, window: Span) -> list[float | None]:
    """The r.m.s. of a point's vertical acceleration in the third-octave bands over a span of time, m/s² [23]; None for
    bands of which the samples are too few: as for the weightings, SAMPLES_PER_PERIOD are needed."""
    step = sampling_step(results)
    acceleration = read_acceleration(results, point, "y")
    found = calc_third_octaves(acceleration, step, samples_between(results, *window))
    highest = (1.0 + ROUNDING) / (SAMPLES_PER_PERIOD * step)
    return [float(value) if centre <= highest else None for value, centre in zip(found, NOMINAL)]


def describe_comfort(total: float) -> str:
    """People's likely reaction in public transport to a total vibration [m/s²]: one or two of REACTIONS."""
    return " to ".join(words for low, high, words in REACTIONS if low <= total < high)
