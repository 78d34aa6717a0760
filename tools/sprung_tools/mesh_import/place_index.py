"""Finding the point at a place among many."""

import itertools

import numpy as np

from sprung_tools.files.array_types import Floats, Integers


class PlaceIndex:
    """Points in cubes as large as the distance within which two places are the same."""

    def __init__(self, positions: Floats, chosen: Integers, near: float) -> None:
        """positions: [N×3] of all points; chosen: the points that can be found; near: the distance along each axis."""
        self._positions, self._near = positions, near or 1.0
        self._cubes: dict[tuple[int, ...], list[int]] = {}
        for point in chosen.tolist():
            self._cubes.setdefault(self._cube(positions[point]), []).append(point)

    def _cube(self, place: Floats) -> tuple[int, ...]:
        return tuple(np.floor(place / self._near).astype(int).tolist())

    def find(self, place: Floats) -> int | None:
        """A point that is near a place; None if there is none."""
        cube = self._cube(place)
        for step in itertools.product((0, -1, 1), repeat=3):
            for point in self._cubes.get(tuple(a + b for a, b in zip(cube, step)), ()):
                if np.all(np.abs(self._positions[point] - place) <= self._near):
                    return point
        return None
