"""How the vibration of a linear vehicle on a random road is judged at a seat, from the spectra of its response.

For a stationary random vibration of one-sided spectral density S, a filter H gives

    r.m.s. = √(∫ |H|² S df)                                                                             (1)

by the trapezoidal rule over the frequencies of the file. So it is with the filters of the third-octave bands. The
measures of single shocks (MTVV, vibration dose, crest factor) belong to a time history, not to a spectrum.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import ComplexNumbers, Floats
from sprung_tools.runs.labelled_responses import Response
from sprung_tools.runs.ride_assessment import calc_total
from sprung_tools.signals.absorbed_power import FEET_PER_METRE, calc_response
from sprung_tools.signals.ride_weighting import HIGHEST, LOWEST, WD, WE, WK, Weighting, calc_weighting
from sprung_tools.signals.third_octaves import BAND_EDGES, BANDS, calc_band

LEAST_IN_BAND = 8  # frequencies, of a smooth spectrum the error of the trapezoidal rule is then below 0.1 %

MISSED = 200  # frequencies, for what lies beyond those of the file

MOST_CHANGE = 0.02  # of r.m.s. values, by leaving out every second frequency, or by what lies beyond the frequencies


class LinearAssessment(NamedTuple):
    """The measures of a point: r.m.s. of the vertical acceleration, weighted r.m.s. values, their total, absorbed
    power."""

    rms: float  # m/s²
    fore_aft: float  # m/s²
    vertical: float  # m/s²
    pitch: float  # rad/s²
    total: float  # m/s²
    power: float  # W


def calc_filtered_rms(frequency: Floats, density: Floats, response: ComplexNumbers) -> float:
    """The r.m.s. by (1)."""
    return float(np.sqrt(np.trapz(np.abs(response) ** 2 * density, frequency)))


def calc_linear_assessment(response: Response, point: str) -> LinearAssessment:
    """The measures of a point BODY.POINT. InputError if the file has not its accelerations, or has no spectra."""
    frequency = response.frequency
    along, up, turn = (
        response.values(f"points/{point}/acceleration.{axis}", is_spectrum=True)[0] for axis in ("x", "y", "angle")
    )
    fore_aft, vertical, pitch = (
        calc_filtered_rms(frequency, density, calc_weighting(weighting, frequency))
        for density, weighting in ((along, WD), (up, WK), (turn, WE))
    )
    power = calc_filtered_rms(frequency, up, FEET_PER_METRE * calc_response(frequency)) ** 2
    rms = calc_filtered_rms(frequency, up, np.ones_like(frequency, dtype=complex))
    return LinearAssessment(rms, fore_aft, vertical, pitch, calc_total(fore_aft, vertical, pitch), power)


def calc_linear_bands(frequency: Floats, density: Floats) -> list[float | None]:
    """The r.m.s. in the third-octave bands of NOMINAL [23] of a spectral density [m] over frequencies [m] Hz; None for
    bands that are not within the frequencies, or have fewer than LEAST_IN_BAND of them."""
    found: list[float | None] = []
    for centre in 10.0 ** (BANDS / 10.0):
        low, high = centre * BAND_EDGES
        inside = np.count_nonzero((frequency >= low) & (frequency <= high))
        is_known = inside >= LEAST_IN_BAND and frequency[0] <= low and frequency[-1] >= high
        found.append(calc_filtered_rms(frequency, density, calc_band(frequency, centre)) if is_known else None)
    return found


def list_frequency_remarks(response: Response, points: Sequence[str]) -> list[str]:
    """What is doubtful about the measures of points because of the frequencies of the file."""
    return list_range_remarks(response, points) + list_density_remarks(response, points)


def calc_cut_share(frequency: Floats, density: Floats, weighting: Weighting) -> float:
    """By how much a weighted r.m.s. value would grow if the spectral density went on beyond the frequencies with its
    values at the ends."""
    inside = calc_filtered_rms(frequency, density, calc_weighting(weighting, frequency)) ** 2
    beyond = 0.0
    for value, start, end in ((density[0], LOWEST, frequency[0]), (density[-1], frequency[-1], HIGHEST)):
        if start < end:
            missed = np.geomspace(start, end, MISSED)
            beyond += calc_filtered_rms(missed, np.full(MISSED, value), calc_weighting(weighting, missed)) ** 2
    return float(np.sqrt(1.0 + beyond / inside)) - 1.0 if inside > 0.0 else 0.0


def list_range_remarks(response: Response, points: Sequence[str]) -> list[str]:
    """That the range of the frequencies cuts off what the weightings let through, if that may be much."""
    frequency = response.frequency
    shares = []
    for point in points:
        for axis, weighting in (("x", WD), ("y", WK), ("angle", WE)):
            density = response.values(f"points/{point}/acceleration.{axis}", is_spectrum=True)[0]
            shares.append((calc_cut_share(frequency, density, weighting), point))
    worst, where = max(shares, default=(0.0, ""))
    if worst <= MOST_CHANGE:
        return []
    return [
        f"frequencies from {frequency[0]:g} to {frequency[-1]:g} Hz cut off the weightings, which let pass from "
        f"{LOWEST:g} to {HIGHEST:g} Hz: if the spectra went on as they end, a weighted r.m.s. value of {where} would "
        f"be {100.0 * worst:.3g} % larger; take a wider range (response.from, response.to)"
    ]


def list_density_remarks(response: Response, points: Sequence[str]) -> list[str]:
    """That the frequencies are too few for the measures of points, if every second of them gives others."""
    if response.frequency.size < 3:
        return []
    halves = response._replace(frequency=response.frequency[::2], every=2 * response.every)
    changes = []
    for point in points:
        fine, coarse = calc_linear_assessment(response, point), calc_linear_assessment(halves, point)
        for one, other in ((fine.vertical, coarse.vertical), (fine.rms, coarse.rms), (fine.fore_aft, coarse.fore_aft)):
            changes.append((abs(other - one) / one if one > 0.0 else 0.0, point))
    worst, where = max(changes, default=(0.0, ""))
    if worst <= MOST_CHANGE:
        return []
    return [
        f"{response.frequency.size} frequencies are too few: every second of them changes an r.m.s. value of {where} "
        f"by {100.0 * worst:.2g} %; take more (response.number)"
    ]


def list_points(response: Response) -> list[str]:
    """The points BODY.POINT of whose accelerations a response file has the spectra."""
    ending = "/acceleration.y"
    return [
        name.removeprefix("points/").removesuffix(ending)
        for name in response.names() if name.startswith("points/") and name.endswith(ending)
    ]  # fmt: skip
