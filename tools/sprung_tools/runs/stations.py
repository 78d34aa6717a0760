"""The stations of a body at which results files hold the loads of its sections: both ends of each element."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import ResultsFile

SLENDER = 0.1  # height over length up to which the loads of a body are drawn over its x
TOUCHING = 1e-9  # of the length: elements that overlap by less follow each other
ALONG_X = "x in the body frame, m"
ALONG_ELEMENTS = "length along the elements in their order, m"


class Layout(NamedTuple):
    """How the loads along a body are drawn.

    order: of the stations, from the first one drawn to the last; along: places of these [m]; axis: what they are;
    signs: 1 or -1 for each station in the order of the file, by which its bending moment is multiplied.
    """

    order: Integers
    along: Floats
    axis: str
    signs: Floats


def read_stations(results: ResultsFile, body: str) -> Floats:
    """Positions of the stations of a body in its axes [stations×2] m. InputError if they are not pairs."""
    name = f"recovery/{body}/station"
    stations, _ = read_numbers(results.file, name)
    if len(stations) % 2:
        raise InputError(f"{results.path}: error: '{name}' has {len(stations)} rows, expected two for each element")
    return stations


def is_drawn_over_x(stations: Floats) -> bool:
    """Whether a body is a slender chain along x: its elements follow each other along x, in whatever order, and none
    stands upright."""
    height, length = np.ptp(stations[:, 1]), np.ptp(stations[:, 0])
    if length == 0.0 or height > SLENDER * length:
        return False
    width, rise = np.abs(np.diff(stations.reshape(-1, 2, 2), axis=1))[:, 0].T
    if np.any((width <= TOUCHING * length) & (rise > TOUCHING * length)):
        return False
    ends = np.sort(stations[:, 0].reshape(-1, 2), axis=1)
    ends = ends[np.argsort(np.mean(ends, axis=1), kind="stable")]
    return bool(np.all(ends[1:, 0] >= ends[:-1, 1] - TOUCHING * length))


def place_stations(stations: Floats) -> Layout:
    """How to draw the loads of a body with stations at these positions [stations×2] m: over the x of its frame where
    is_drawn_over_x(), else along its elements, one after the other.

    A positive moment stretches the right of an element, seen from its first end. Over x all elements count as drawn in
    the direction of x, so that a positive moment stretches the side of -y of each of them.
    """
    ends = stations.reshape(-1, 2, 2)
    if is_drawn_over_x(stations):
        turned = ends[:, 0, 0] > ends[:, 1, 0]
        pairs = np.arange(len(stations)).reshape(-1, 2)
        pairs[turned] = pairs[turned][:, ::-1]
        order = pairs[np.argsort(np.mean(ends[:, :, 0], axis=1), kind="stable")].ravel()
        return Layout(order, stations[order, 0], ALONG_X, np.repeat(np.where(turned, -1.0, 1.0), 2))
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    begins = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    along = np.stack([begins, begins + lengths], axis=1).ravel()
    return Layout(np.arange(len(stations)), along, ALONG_ELEMENTS, np.ones(len(stations)))
