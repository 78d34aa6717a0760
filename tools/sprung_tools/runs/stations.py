"""The stations of a body at which results files hold the loads of its sections: both ends of each element."""

import numpy as np

from sprung_tools.files.array_types import Floats, Integers

SLENDER = 0.1  # height over length up to which the loads of a body are drawn over its x


def place_stations(stations: Floats) -> tuple[Integers, Floats, str]:
    """Where the loads are drawn: the order of the stations, their places [m] and what these are. A slender body along
    x has the x of its frame; another one the length along its elements, one after the other."""
    ends = stations.reshape(-1, 2, 2)
    height, length = np.ptp(stations[:, 1]), np.ptp(stations[:, 0])
    if length > 0.0 and height <= SLENDER * length:
        flipped = ends[:, 0, 0] > ends[:, 1, 0]
        pairs = np.arange(len(stations)).reshape(-1, 2)
        pairs[flipped] = pairs[flipped][:, ::-1]
        order = pairs[np.argsort(np.mean(ends[:, :, 0], axis=1), kind="stable")].ravel()
        return order, stations[order, 0], "x in the body frame, m"
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    begins = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    along = np.stack([begins, begins + lengths], axis=1).ravel()
    return np.arange(len(stations)), along, "length along the elements in their order, m"
