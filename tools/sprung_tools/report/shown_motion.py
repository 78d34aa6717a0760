"""Along which axis the motion of monitored points is shown: the vertical one of a vehicle; of a mechanism that along
which the point moves more."""

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import read_elements
from sprung_tools.runs.rounding import calc_size, clear_rounding

VERTICAL = "y"


def is_vehicle(results: ResultsFile) -> bool:
    """Whether the model stands on a road."""
    return any(force.on_road for force in read_elements(results, "forces").values())


def choose_axes(results: ResultsFile, point: str) -> tuple[str, ...]:
    """The axes along which a point's motion is shown, that of the larger motion first."""
    if is_vehicle(results):
        return (VERTICAL,)
    for what in ("position", "acceleration"):
        if results.has(f"points/{point}/{what}"):
            ranges = {axis: float(np.ptp(read_motion(results, point, what, axis)[0])) for axis in "yx"}
            moving = [axis for axis in sorted(ranges, key=lambda axis: -ranges[axis]) if ranges[axis] > 0.0]
            return tuple(moving) or (VERTICAL,)
    return (VERTICAL,)


def name_axis(results: ResultsFile, axis: str) -> str:
    """What follows the name of a quantity along an axis; nothing for a vehicle, whose motion is all vertical."""
    return "" if is_vehicle(results) else f" along {axis}"


def read_motion(results: ResultsFile, point: str, what: str, axis: str) -> tuple[Floats, str]:
    """A point's displacement, position or acceleration [n] and its unit; 0 where it is nothing but rounding."""
    values, unit = results.series(f"points/{point}/{what}.{axis}")
    return clear_rounding(values, calc_size(results, f"points/{point}", what)), unit
