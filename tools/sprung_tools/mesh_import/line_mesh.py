"""A frame of line elements as it was read from another program's mesh file: what each of the readers returns."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.mesh_import.frame_properties import Material, PointMass, Section

LARGEST_NUMBER = 2**31 - 1  # of a node or an element
MOST_MEMBERS = 10_000_000  # of a set that is written as a range


@dataclass
class LineMesh:
    """N nodes and E two-node lines. Sets hold 0-based numbers of nodes or lines, in the source's order."""

    path: str
    format: str  # in words, for messages
    node_ids: Integers  # [N] the source's numbers, > 0, unique
    positions: Floats  # [N×3] m
    line_ids: Integers  # [E] > 0, unique
    lines: Integers  # [E×2] 0-based nodes
    element_sets: dict[str, Integers] = field(default_factory=dict)
    node_sets: dict[str, Integers] = field(default_factory=dict)
    section_sets: tuple[str, ...] = ()  # names of the element sets to which the source gives sections
    left_behind: list[str] = field(default_factory=list)  # what the source holds and the mesh does not, a text each
    doubts: list[str] = field(default_factory=list)  # whether the source is what it should be, a text each
    sections: list[Section] = field(default_factory=list)
    section_of: Integers = field(default_factory=lambda: np.zeros(0, dtype=int))  # [E] places in sections, -1: none
    heights: Floats = field(default_factory=lambda: np.zeros((0, 3)))  # [E×3] along the section's height; NaN: unknown
    materials: dict[str, Material] = field(default_factory=dict)
    point_masses: list[PointMass] = field(default_factory=list)
    counts: Integers = field(default_factory=lambda: np.zeros(0, dtype=int))  # [E] parallel members of each line

    def __post_init__(self) -> None:
        """Fills what a reader has not given: lines without a section, single members."""
        size = len(self.lines)
        if len(self.section_of) != size:
            self.section_of = np.full(size, -1)
        if len(self.heights) != size:
            self.heights = np.full((size, 3), np.nan)
        if len(self.counts) != size:
            self.counts = np.ones(size, dtype=int)


def shorten(items: Iterable[object], most: int = 8) -> str:
    """The first items, separated by commas; how many there are if these are not all."""
    texts = [str(item) for item in items]
    return ", ".join(texts[:most]) + (f", … ({len(texts)} in all)" if len(texts) > most else "")


def order_along(size: int) -> list[int]:
    """The places of a line's nodes from end to end, where the middle nodes stand behind both ends. size: ≥ 2 nodes."""
    return [0, *range(2, size), 1]


def describe_split(count: int) -> list[str]:
    """What becomes of lines with middle nodes, of which there are `count`: one text, or none."""
    return [f"middle nodes of {count} lines: each has become straight ones from node to node"] if count else []


def pick_members(sets: Mapping[str, Iterable[int]], number: Mapping[int, int]) -> dict[str, Integers]:
    """Sets of ids as sets of 0-based numbers, each member once. Members without a number are left out.

    number: id → 0-based number.
    """
    picked = {}
    for name, members in sets.items():
        kept = dict.fromkeys(number[member] for member in members if member in number)
        picked[name] = np.array(list(kept), dtype=int)
    return picked
