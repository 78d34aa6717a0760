"""Motion that is nothing but rounding, as that of a vehicle at rest, which counts as none."""

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import ROOT, has_resolved_model, read_gravity

ROUNDING = 1e-12  # of the largest size of a vector: a component that stays below is nothing but rounding
MANY = 10.0  # rounding errors of a position that add up; up to 4 have been seen, see calc_rounding()
FREQUENCIES = "model/modes/undamped_frequency"


def clear_rounding(values: Floats, rounding: float) -> Floats:
    """Values; zeros if all are below the rounding."""
    return np.zeros_like(values) if np.max(np.abs(values)) < rounding else values


def clear_each(values: Floats, rounding: float) -> Floats:
    """Values; each is zero that by itself is below the rounding."""
    return np.where(np.abs(values) < rounding, 0.0, values)


def calc_rounding(results: ResultsFile, point: str, what: str) -> float:
    """The size of a point's motion below which it is nothing but rounding: of its position or displacement [m], or of
    its acceleration [m/s²]. point: its group, `points/chassis.seat`.

    A length L, that of the way or of a body, is rounded by εL. Springs answer by an acceleration of εLω², ω the highest
    frequency of the vehicle's modes. On a level road it was 0.01 to 4 times this, for half cars to semitrailers.
    """
    length = max(find_largest(results, f"{point}/position"), find_longest(results))
    if what != "acceleration":
        return ROUNDING * length
    size = find_largest(results, f"{point}/acceleration")
    if has_resolved_model(results):
        size = max(size, float(np.max(np.abs(read_gravity(results)))))
    frequency = read_numbers(results.file, FREQUENCIES)[0] if results.file.has_dataset(FREQUENCIES) else np.zeros(0)
    highest = 2.0 * np.pi * float(np.max(frequency, initial=0.0))  # rad/s
    return max(ROUNDING * size, MANY * float(np.finfo(float).eps) * length * highest**2)


def find_largest(results: ResultsFile, quantity: str) -> float:
    """The largest component of a vector over the run; 0 if it is not stored."""
    if not results.has(quantity):
        return 0.0
    return max(float(np.max(np.abs(results.series(f"{quantity}.{axis}")[0]))) for axis in "xy")


def find_longest(results: ResultsFile) -> float:
    """The largest coordinate [m] of a body over the run, or of a point in the frame of its body, as far as the file
    holds them."""
    if "longest" not in results.kept:
        lengths = [find_largest(results, f"bodies/{body}/position") for body in results.names("bodies")]
        for name in results.names(f"{ROOT}/points") if has_resolved_model(results) else []:
            lengths.append(float(np.max(np.abs(read_numbers(results.file, f"{ROOT}/points/{name}/position")[0]))))
        results.kept["longest"] = max(lengths, default=0.0)
    return float(results.kept["longest"])


def read_acceleration(results: ResultsFile, point: str, axis: str, *, may_be_coarse: bool = False) -> Floats:
    """A point's acceleration along an axis [n], m/s²; 0 where it is nothing but rounding. point: as calc_rounding()
    takes it. InputError if it is not stored at every output, unless it may be coarse: then it is interpolated between
    its rows."""
    if not may_be_coarse:
        results.check_every_output(f"{point}/acceleration.{axis}")
    values, _ = results.series(f"{point}/acceleration.{axis}")
    return clear_rounding(values, calc_rounding(results, point, "acceleration"))
