"""Spans of time in which something holds."""

import numpy as np

from sprung_tools.files.array_types import Flags, Floats

Span = tuple[float, float]  # from, to [s]
OptionalSpan = tuple[float | None, float | None]  # None for the begin or the end of the run


def find_spans(holds: Flags, time: Floats) -> Floats:
    """The spans in which something holds, as (start, end) [k×2]: from its first sample to the sample after its last.

    holds: [n]; time: of the samples [n].
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(int)))
    return time[np.minimum(edges, time.size - 1)].reshape(-1, 2)
