"""Coordinate systems of Nastran decks: rectangular, cylindrical and spherical ones, by points (CORD2…) or nodes
(CORD1…), each in terms of another one."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.nastran_cards import Card

CARDS = {"CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S"}
SMALLEST_SINE = 1e-9  # of the angle between a system's z axis and the point in its x–z plane


class CoordinateSystems:
    """All systems of a deck. System 0 is the basic one."""

    def __init__(self, find_node: Callable[[Card, int], Floats]) -> None:
        """find_node: the position of a node in the basic system, by its number; it throws if it is not there."""
        self._cards: dict[int, tuple[Card, int]] = {}  # number → card, place of its first field
        self._frames: dict[int, tuple[Floats, Floats]] = {0: (np.zeros(3), np.eye(3))}  # origin, axes as columns
        self._waiting: list[int] = []
        self._find_node = find_node

    def add(self, card: Card) -> None:
        """Takes in a card; CORD1… may define two systems."""
        for first in (0, 4) if card.name[4] == "1" and card.field(4) else (0,):
            number = card.integer(first, "coordinate system")
            known, _ = self._cards.get(number, (card, first))
            if known.fields != card.fields or number <= 0:
                card.fail(f"coordinate system {number} is defined twice" if number > 0 else "numbers begin at 1")
            self._cards[number] = (card, first)

    def place(self, asking: Card, system: int, coordinates: Sequence[float]) -> Floats:
        """A point's position in the basic system. asking: the card that names the system, for the message."""
        origin, axes = self._frame(asking, system)
        return origin + axes @ self._straighten(system, coordinates)

    def turn(self, asking: Card, system: int, vector: Sequence[float], at: Floats) -> Floats:
        """A vector's components in the basic system. at: position [3] where it is, which gives curved systems their
        directions."""
        origin, axes = self._frame(asking, system)
        kind = self._kind(system)
        local = np.asarray(vector, dtype=float)
        x, y, z = axes.T @ (at - origin)
        around = math.atan2(y, x)
        spin = np.array([[math.cos(around), -math.sin(around), 0], [math.sin(around), math.cos(around), 0], [0, 0, 1]])
        if kind == "C":
            local = spin @ local
        elif kind == "S":
            down = math.atan2(math.hypot(x, y), z)
            radial = np.array([math.sin(down), 0.0, math.cos(down)])
            polar = np.array([math.cos(down), 0.0, -math.sin(down)])
            local = spin @ (local[0] * radial + local[1] * polar + local[2] * np.array([0.0, 1.0, 0.0]))
        turned: Floats = axes @ local
        return turned

    def _kind(self, system: int) -> str:
        """R, C or S."""
        return self._cards[system][0].name[5] if system else "R"

    def _straighten(self, system: int, coordinates: Sequence[float]) -> Floats:
        """Coordinates of a system's kind as rectangular ones along its axes."""
        a, b, c = coordinates
        kind = self._kind(system)
        if kind == "C":
            return np.array([a * math.cos(math.radians(b)), a * math.sin(math.radians(b)), c])
        if kind == "S":
            sine = a * math.sin(math.radians(b))
            z = a * math.cos(math.radians(b))
            return np.array([sine * math.cos(math.radians(c)), sine * math.sin(math.radians(c)), z])
        return np.array([a, b, c])

    def _frame(self, asking: Card, system: int) -> tuple[Floats, Floats]:
        """Origin and axes of a system. InputError if it is not there, defined by itself, or has no direction."""
        if system in self._frames:
            return self._frames[system]
        if system not in self._cards:
            asking.fail(f"names coordinate system {system}, which is not there: truncated?")
        card, first = self._cards[system]
        if system in self._waiting:
            card.fail(f"coordinate system {system} is defined by itself")
        self._waiting.append(system)
        if card.name[4] == "1":
            corners = [self._find_node(card, card.integer(first + place, "node")) for place in (1, 2, 3)]
        else:
            other = card.integer(1, "coordinate system", 0)
            numbers = [card.real(place, "coordinate") for place in range(2, 11)]
            corners = [self.place(card, other, numbers[start : start + 3]) for start in (0, 3, 6)]
        self._waiting.pop()
        self._frames[system] = make_frame(card, *corners)
        return self._frames[system]


def make_frame(card: Card, origin: Floats, on_z: Floats, on_xz: Floats) -> tuple[Floats, Floats]:
    """Origin and axes (columns) of a system given by three points. InputError if these lie on a line."""
    z, third = on_z - origin, on_xz - origin
    y = np.cross(z, third)
    if not np.linalg.norm(y) > SMALLEST_SINE * np.linalg.norm(z) * np.linalg.norm(third):
        card.fail("has its three points on a line")
    z = z / np.linalg.norm(z)
    y = y / np.linalg.norm(y)
    return origin, np.column_stack([np.cross(y, z), y, z])
