"""Whole numbers in few words."""

from collections.abc import Sequence

import numpy as np

from sprung_tools.files.array_types import Integers


def format_ranges(numbers: Integers | Sequence[int]) -> str:
    """Ascending whole numbers as ranges: 1, 2, 3, 7 → "1–3, 7"."""
    values = np.asarray(numbers, dtype=int)
    if values.size == 0:
        return ""
    ranges = np.split(values, 1 + np.flatnonzero(np.diff(values) > 1))
    return ", ".join(f"{one[0]}" if one.size == 1 else f"{one[0]}–{one[-1]}" for one in ranges)
