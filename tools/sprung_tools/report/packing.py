"""Numbers on the page: arrays are base64 of little-endian float32; histories hold the samples that are needed to draw
them.

Thinning keeps the least and the greatest value in each of many short spans of time, so that no peak is lost. It is only
for drawing: statistics and spectra are computed before.
"""

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sprung_tools.files.array_types import Floats, Integers

Packed = dict[str, Any]  # an object of the page's JSON


def encode(values: NDArray[Any]) -> str:
    """Encodes numbers as base64 text of float32."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")


def find_kept(values: Floats, most: int) -> Integers:
    """Chooses the samples to draw a history [n] with: about `most` at most, among them the least and greatest of each
    span."""
    size = values.size
    if size <= most:
        return np.arange(size)
    edges = np.linspace(0, size, most // 2 + 1).astype(int)
    kept = [0, size - 1]
    for first, last in zip(edges[:-1], edges[1:]):
        span = values[first:last]
        kept += [first + int(np.argmin(span)), first + int(np.argmax(span))]
    return np.unique(kept)
