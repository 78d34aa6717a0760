"""Along which axis the motion of monitored points is shown: the vertical one of a vehicle; of a mechanism that along
which the point moves more. A point of a vehicle is shown vertically in all runs, so that one on a road can be compared
with one on a test rig, which has no road."""

from collections.abc import Iterable

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.hdf5_file import read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import ROOT, read_elements
from sprung_tools.runs.rounding import calc_rounding, clear_rounding

VERTICAL = "y"


def list_monitored(results: ResultsFile) -> list[str]:
    """The points in the run's summary, in the order of the vehicle file; the origins of all bodies if it has none."""
    found = results.names("summary/points")
    listed = f"{ROOT}/settings/output_points"
    order = read_texts(results.file, listed) if results.file.has_dataset(listed) else []
    points = [point for point in order if point in found] + [point for point in found if point not in order]
    return points or [f"{body}.origin" for body in results.names("bodies")]


class ShownMotion:
    """Which motion of each point is shown, in all runs of a page."""

    def __init__(self, all_results: Iterable[ResultsFile]):
        self._vertical = {  # points of runs on a road
            point
            for results in all_results
            if any(force.on_road for force in read_elements(results, "forces").values())
            for point in list_monitored(results)
        }

    def choose_axes(self, results: ResultsFile, point: str) -> tuple[str, ...]:
        """The axes along which a point's motion is shown, that of the larger motion first."""
        if point in self._vertical:
            return (VERTICAL,)
        for what in ("position", "acceleration"):
            if results.has(f"points/{point}/{what}"):
                ranges = {axis: float(np.ptp(read_motion(results, point, what, axis)[0])) for axis in "yx"}
                moving = [axis for axis in sorted(ranges, key=lambda axis: -ranges[axis]) if ranges[axis] > 0.0]
                return tuple(moving) or (VERTICAL,)
        return (VERTICAL,)

    def name_axis(self, point: str, axis: str) -> str:
        """What follows the name of a quantity along an axis; nothing for a vehicle, whose motion is all vertical."""
        return "" if point in self._vertical else f" along {axis}"

    def name_group(self, point: str) -> str:
        """The group of a point's histories in the page's menus."""
        return "Vertical motion" if point in self._vertical else "Motion of points"


def read_motion(results: ResultsFile, point: str, what: str, axis: str) -> tuple[Floats, str]:
    """A point's displacement, position or acceleration [n] and its unit; 0 where it is nothing but rounding."""
    values, unit = results.series(f"points/{point}/{what}.{axis}")
    return clear_rounding(values, calc_rounding(results, f"points/{point}", what)), unit
