"""Motion that is nothing but rounding, as that of a vehicle at rest, which counts as none."""

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import has_resolved_model, read_gravity

ROUNDING = 1e-12  # of the largest size of a vector: a component that stays below is nothing but rounding


def clear_rounding(values: Floats, size: float) -> Floats:
    """Values; zeros if all are rounding of something of this size."""
    return np.zeros_like(values) if np.max(np.abs(values)) < ROUNDING * size else values


def clear_each(values: Floats, size: float) -> Floats:
    """Values; each is zero that by itself is rounding of something of this size."""
    return np.where(np.abs(values) < ROUNDING * size, 0.0, values)


def calc_size(results: ResultsFile, point: str, what: str) -> float:
    """The size that rounding of a point's motion is judged by: the largest of the vector over the run, of its position
    for a displacement; an acceleration is at least of gravity's size. point: its group, `points/chassis.seat`."""
    stored = "position" if what == "displacement" else what
    size = 0.0
    if results.has(f"{point}/{stored}"):
        size = max(float(np.max(np.abs(results.series(f"{point}/{stored}.{axis}")[0]))) for axis in "xy")
    if what == "acceleration" and has_resolved_model(results):
        size = max(size, float(np.max(np.abs(read_gravity(results)))))
    return size


def read_acceleration(results: ResultsFile, point: str, axis: str, *, may_be_coarse: bool = False) -> Floats:
    """A point's acceleration along an axis [n], m/s²; 0 where it is nothing but rounding. point: as calc_size() takes
    it. InputError if it is not stored at every output, unless it may be coarse: then it is interpolated between its
    rows."""
    if not may_be_coarse:
        results.check_every_output(f"{point}/acceleration.{axis}")
    values, _ = results.series(f"{point}/acceleration.{axis}")
    return clear_rounding(values, calc_size(results, point, "acceleration"))
