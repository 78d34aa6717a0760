"""Point masses of a united ladder frame at nodes that only members across at an angle join.

These members are left out but for their mass, so such a node has no line. Its masses go to the ends of rails, or of
lines in the middle plane, to which its members lead: to the nearest ones before and behind it, by the lever rule

    mₐ = m (x_b − x) / (x_b − x_a),   m_b = m (x − x_a) / (x_b − x_a)                                              (1)

with x along the rails. This keeps the mass and its first moment along the rails, not its height.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.frame_properties import PointMass
from sprung_tools.mesh_import.line_mesh import LineMesh, shorten


class Carriers:
    """The nodes of a united frame that can hold masses in place of others."""

    def __init__(
        self, mesh: LineMesh, united: Integers, kept: Integers, oblique: Integers, plane: str, near: float
    ) -> None:
        """united: the node that stands for each node [N]; kept: the lines that stay; oblique: the members across at an
        angle; plane: of the frame; near: the distance within which two places are the same."""
        self.mesh, self.united, self.near = mesh, united, near
        self.with_lines = set(united[mesh.lines[kept]].reshape(-1).tolist())
        self.without = set(united[mesh.lines].reshape(-1).tolist()) - self.with_lines
        self.beside: dict[int, set[int]] = {}
        for a, b in united[mesh.lines[oblique]].tolist():
            self.beside.setdefault(a, set()).add(b)
            self.beside.setdefault(b, set()).add(a)
        axes = ["xyz".index(axis) for axis in plane]
        extents = np.ptp(mesh.positions[mesh.lines[kept]][:, :, axes].reshape(-1, 2), axis=0)
        self.along, self.up = axes if extents[0] >= extents[1] else axes[::-1]
        self.relieved: dict[int, float] = {}  # node whose masses have gone elsewhere → how much higher or lower

    def carry(self, masses: Iterable[PointMass]) -> list[PointMass]:
        """The masses at nodes of the united frame. InputError if one has nowhere to go."""
        carried = []
        for one in masses:
            node = int(self.united[one.node])
            if node not in self.without or one.left_out:
                carried.append(one._replace(node=node))
            else:
                carried += self.share(one, node)
        return carried

    def share(self, one: PointMass, node: int) -> list[PointMass]:
        """A mass at a node without a line, shared by the nodes that carry it."""
        mesh, place = self.mesh, self.mesh.positions[node]
        ends = self.find_ends(node)
        shares = share_out(place[self.along], mesh.positions[ends, self.along], self.near)
        if shares is None:
            axis = "xyz"[self.along]
            raise InputError(
                f"{mesh.path}: error: node {mesh.node_ids[one.node]} at {axis} = {place[self.along]:.9g} has a mass, "
                f"but only members across lead to it, and not from rails on both sides along {axis}: a plane frame "
                "cannot carry it; join it by lines in the middle plane, or take its members out"
            )
        taking = np.flatnonzero(shares)
        texts = [one.text if taking.size == 1 else f"{one.text}, {share:.4g} of it" for share in shares]
        away = np.max(np.abs(mesh.positions[ends, self.up][taking] - place[self.up]))
        known = self.relieved.get(int(mesh.node_ids[one.node]), 0.0)
        self.relieved[int(mesh.node_ids[one.node])] = max(known, float(away))
        return [
            one._replace(
                text=texts[k], node=ends[k], mass=float(shares[k]) * one.mass,
                inertia=None if one.inertia is None else shares[k] * one.inertia,
            )
            for k in taking
        ]  # fmt: skip

    def find_ends(self, node: int) -> list[int]:
        """The nodes with lines to which members across at an angle lead from a node without."""
        found, waiting = {node}, [node]
        while waiting:
            at = waiting.pop()
            reached = self.beside.get(at, set()) - found if at in self.without else set()
            found |= reached
            waiting += reached
        return sorted(found & self.with_lines)

    def describe(self) -> list[str]:
        """What became of the masses that went elsewhere: one text, or none."""
        if not self.relieved:
            return []
        away = max(self.relieved.values())
        height = f", up to {away:g} away along {'xyz'[self.up]}" if away > self.near else ""
        return [
            f"the joints of members across at an angle alone, {shorten(self.relieved)}: their masses are at the "
            f"nearest ends before and behind, by the lever rule along {'xyz'[self.along]}{height}"
        ]


def share_out(place: float, ends: Floats, near: float) -> Floats | None:
    """The shares [n] that the ends nearest to a place on both sides take by (1), in equal parts where several are at
    one x; None if the place is not between ends. ends: x of each [n]; near: the distance within which two x are one."""
    ends = np.where(np.abs(ends - place) <= near, place, ends)
    before, behind = ends[ends <= place], ends[ends >= place]
    if before.size == 0 or behind.size == 0:
        return None
    low, high = before.max(), behind.min()
    lever = 1.0 if high == low else (high - place) / (high - low)
    at_low, at_high = np.abs(ends - low) <= near, np.abs(ends - high) <= near
    shares: Floats = lever * at_low / at_low.sum() + (1.0 - lever) * at_high / at_high.sum()
    return shares


def merge_masses(masses: Sequence[PointMass]) -> list[PointMass]:
    """The masses with those of one node as one."""
    merged: dict[int, PointMass] = {}
    for one in masses:
        before = merged.get(one.node)
        if before is None:
            merged[one.node] = one._replace(text="members across")
            continue
        inertia = before.inertia if one.inertia is None else one.inertia
        if before.inertia is not None and one.inertia is not None:
            inertia = before.inertia + one.inertia
        merged[one.node] = before._replace(mass=before.mass + one.mass, inertia=inertia)
    return list(merged.values())
