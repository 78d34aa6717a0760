"""How the sections of beams in Abaqus decks are turned about their axes.

The 1-direction of a beam in space is near the way to its orientation node, or else the one that its section gives, or
(0, 0, -1). A planar beam has (0, 0, -1) whatever is given; CalculiX makes a beam in space of it. Normals of nodes give
the 2-direction. Source: Abaqus 2016, Analysis User's Guide, "Beam element cross-section orientation".
"""

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.mesh_import.abaqus_assembly import Assembly
from sprung_tools.mesh_import.abaqus_part import PLANAR, Element
from sprung_tools.mesh_import.abaqus_properties import DEFAULT_WIDTH, calc_height
from sprung_tools.mesh_import.line_mesh import shorten

SAME = 1e-9  # of the cosine between two directions that are one


class Orientation:
    """The 2-directions of an assembly's beams, and remarks on what was not taken."""

    def __init__(self, whole: Assembly) -> None:
        self._normals = whole.normals
        self._passed_over: dict[int, None] = {}  # planar beams to which another 1-direction is given
        self._open: dict[int, None] = {}  # beams with normals

    def find_height(self, number: int, element: Element, tangent: Floats, width: Floats, rotation: Floats) -> Floats:
        """The 2-direction [3] of a line of an element; NaN where it is not known.

        width: the 1-direction that is given; rotation: of the instance.
        """
        height = calc_height(tangent, width)
        if PLANAR.match(element.kind):
            planar = calc_height(tangent, rotation @ np.array(DEFAULT_WIDTH))
            if not abs(planar @ height) > 1.0 - SAME:
                self._passed_over[number] = None
            return planar
        if number in self._normals["E"] or not self._normals["N"].isdisjoint(element.nodes):
            self._open[number] = None
            return np.full(3, np.nan)
        return height

    def list_remarks(self) -> list[str]:
        """What was not taken, a text each."""
        texts = []
        if self._passed_over:
            what = "theirs is (0, 0, -1), as in Abaqus; CalculiX takes the given ones"
            texts.append(f"1-directions that are given to planar beams {shorten(self._passed_over)}: {what}")
        if self._open:
            texts.append(f"normals of nodes, by *NODE or *NORMAL, which turn beams {shorten(self._open)}")
        return texts
