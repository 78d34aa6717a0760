"""Numbers on the page: arrays as base64 of little-endian float32, histories by the samples that are needed to draw them.

Thinning keeps, in each of many short spans of time, the least and the greatest value where they are, so that no peak is
lost. It is for drawing alone: everything that is computed is computed before it.
"""

import base64

import numpy as np


def encode(values):
    """Numbers as base64 text of float32."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")


def find_kept(values, most):
    """The samples of a history [n] to draw it by: at most about `most`, with the least and greatest of each span."""
    size = values.size
    if size <= most:
        return np.arange(size)
    edges = np.linspace(0, size, most // 2 + 1).astype(int)
    kept = [0, size - 1]
    for first, last in zip(edges[:-1], edges[1:]):
        span = values[first:last]
        kept += [first + int(np.argmin(span)), first + int(np.argmax(span))]
    return np.unique(kept)
