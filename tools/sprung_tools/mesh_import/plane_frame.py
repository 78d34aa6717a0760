"""Making a plane frame of a mesh's line elements: in the frame each element is in exactly one group."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.line_mesh import LineMesh, shorten

Members = TypeVar("Members")

SAME_PLACE = 1e-9  # share of the frame's extent within which two nodes coincide, and a plane counts as flat
REST = "lines"  # the group of the elements that are in no set of the source
LONGEST_NAME = 127  # bytes in the name of a gmsh group
AXES = "xyz"


class PlaneFrame(NamedTuple):
    """What gmsh_writer writes: every line is in exactly one curve, every point is one node."""

    node_ids: Integers  # [N]
    positions: Floats  # [N×2] m
    line_ids: Integers  # [E]
    lines: Integers  # [E×2]
    curves: dict[str, Integers]  # name → line numbers
    points: dict[str, int]  # name → node number
    remarks: list[str]  # what became of the sets and nodes that are not kept as they were, a text each


def make_plane_frame(
    mesh: LineMesh, plane: str = "xy", wanted_sets: Sequence[str] = (), scale: float = 1.0
) -> PlaneFrame:
    """Makes a plane frame of a mesh's lines.

    plane: two of the source's axes, which become x and y; wanted_sets: the element sets that become curves where sets
    overlap; scale: the factor of all lengths. InputError if there are no lines, if they do not lie in the plane, if two
    nodes coincide, or if overlapping sets leave a line's section open.
    """
    if len(mesh.lines) == 0:
        raise InputError(f"{mesh.path}: error: no line elements; {describe_found(mesh)}")
    mesh, remarks = drop_unused_nodes(mesh)
    with np.errstate(over="ignore", invalid="ignore"):
        positions = scale * project(mesh, plane)
        if not np.isfinite(np.linalg.norm(np.ptp(positions, axis=0))):
            raise InputError(f"{mesh.path}: error: the frame is too large for numbers of double precision")
    check_places(mesh, positions)
    curves = choose_curves(mesh, wanted_sets, remarks)
    points = name_points(mesh, remarks)
    curves = rename_for_gmsh(curves, "element set", remarks)
    points = rename_for_gmsh(points, "node set", remarks)
    return PlaneFrame(mesh.node_ids, positions, mesh.line_ids, mesh.lines, curves, points, remarks)


def describe_found(mesh: LineMesh) -> str:
    """What a file without lines holds instead."""
    return "; ".join(["the file holds " + text for text in mesh.left_behind[:3]]) or "the file holds no elements"


def drop_unused_nodes(mesh: LineMesh) -> tuple[LineMesh, list[str]]:
    """Returns the mesh without the nodes that no line uses, and remarks on these."""
    used = np.unique(mesh.lines)
    if used.size == mesh.node_ids.size:
        return mesh, []
    number = np.full(mesh.node_ids.size, -1)
    number[used] = np.arange(used.size)
    unused = np.setdiff1d(np.arange(mesh.node_ids.size), used)
    sets = {}
    for name, nodes in mesh.node_sets.items():
        kept = number[np.asarray(nodes, dtype=int)]
        sets[name] = kept[kept >= 0]
    smaller = LineMesh(
        mesh.path, mesh.format, mesh.node_ids[used], mesh.positions[used], mesh.line_ids, number[mesh.lines],
        mesh.element_sets, sets, mesh.section_sets, mesh.left_behind, counts=mesh.counts,
    )  # fmt: skip
    return smaller, [f"nodes that no line uses: {shorten(mesh.node_ids[unused])}"]


def project(mesh: LineMesh, plane: str) -> Floats:
    """Positions [N×2] in the plane of two of the source's axes. If they do not lie in a plane, InputError says by how
    much."""
    kept = [AXES.index(axis) for axis in plane]
    (normal,) = {0, 1, 2} - set(kept)
    depth = mesh.positions[:, normal]
    extent = np.linalg.norm(np.ptp(mesh.positions, axis=0))
    if np.ptp(depth) > SAME_PLACE * extent:
        low, high = int(np.argmin(depth)), int(np.argmax(depth))
        others = [pair for pair in ("xy", "xz", "yz") if set(pair) != set(plane)]
        axis = AXES[normal]
        raise InputError(
            f"{mesh.path}: error: the lines do not lie in a plane parallel to {plane[0]}–{plane[1]}: "
            f"node {mesh.node_ids[low]} is at {axis} = {depth[low]:.9g}, node {mesh.node_ids[high]} at "
            f"{depth[high]:.9g}, {np.ptp(depth):.3g} apart; expected {SAME_PLACE * extent:.1g} at most, "
            f"or --plane {' or '.join(others)}; --unite-rails for two equal rails"
        )
    return mesh.positions[:, kept]


def check_places(mesh: LineMesh, positions: Floats) -> None:
    """Throws InputError if two nodes coincide, or if a line has no length."""
    bad = np.flatnonzero(mesh.lines[:, 0] == mesh.lines[:, 1])
    if bad.size:
        raise InputError(
            f"{mesh.path}: error: element {mesh.line_ids[bad[0]]} begins and ends at node "
            f"{mesh.node_ids[mesh.lines[bad[0], 0]]}"
        )
    extent = np.linalg.norm(np.ptp(positions, axis=0))
    near = float(SAME_PLACE * extent)
    pair = find_near_pair(positions, near)
    if pair is not None:
        a, b = sorted(mesh.node_ids[node] for node in pair)
        x, y = positions[pair[0]]
        raise InputError(
            f"{mesh.path}: error: nodes {a} and {b} are both at ({x:.9g}, {y:.9g}); elements meet at a common "
            "node, so merge them"
        )


def find_near_pair(positions: Floats, near: float) -> tuple[int, int] | None:
    """Finds two nodes that are at most `near` apart in x and in y; None if there are none.

    positions: [N×2]. The plane is divided into squares of that size; a node is compared only with those in its own and
    the eight neighbouring squares.
    """
    squares = np.floor((positions - positions.min(axis=0)) / (near or 1.0)).astype(int)
    nodes_in: dict[tuple[int, int], list[int]] = {}
    for node, (i, j) in enumerate(squares.tolist()):
        for square in ((i + a, j + b) for a in (-1, 0, 1) for b in (-1, 0, 1)):
            for other in nodes_in.get(square, ()):
                if np.all(np.abs(positions[node] - positions[other]) <= near):
                    return other, node
        nodes_in.setdefault((i, j), []).append(node)
    return None


def choose_curves(mesh: LineMesh, wanted_sets: Sequence[str], remarks: list[str]) -> dict[str, Integers]:
    """Divides the lines into groups: name → line numbers, each line once. Adds a remark on each set that is left out.

    Sets that do not overlap are all kept. Where sets overlap, those of wanted_sets are kept, or without these the sets
    to which the source gives sections; then the others that overlap none of the kept ones. Of the sets of two
    united rails the first ones are kept.
    """
    sets = {name: np.unique(lines) for name, lines in mesh.element_sets.items() if len(lines) > 0}
    for name in wanted_sets:
        if name not in sets:
            there = shorten(sets) or "no element sets of lines"
            raise InputError(f"{mesh.path}: error: no element set '{name}' of lines; the file has {there}")
    overlap = sum(lines.size for lines in sets.values()) > np.unique(np.concatenate([*sets.values(), []])).size
    first = wanted_sets or (tuple(n for n in mesh.section_sets if n in sets) if overlap else tuple(sets))
    taken = np.full(mesh.line_ids.size, None)
    curves = {}
    for name in first:
        if not wanted_sets and adds_nothing(mesh, name, sets[name], taken):
            continue
        check_overlap(mesh, name, sets[name], taken)
        taken[sets[name]] = name
        curves[name] = sets[name]
    for name, lines in sets.items():
        if name in curves:
            continue
        if wanted_sets:
            remarks.append(f"element set '{name}' ({lines.size} lines): not asked for")
        elif adds_nothing(mesh, name, lines, taken) or (first and any(taken[lines] != None)):  # noqa: E711
            others = sorted({taken[line] for line in lines} - {None})
            remarks.append(
                f"element set '{name}' ({lines.size} lines): overlaps '{shorten(others)}', which has the section"
            )
        else:
            check_overlap(mesh, name, lines, taken)
            taken[lines] = name
            curves[name] = lines
    rest = np.flatnonzero(taken == None)  # noqa: E711  compares each element
    if rest.size:
        name = REST
        while name in sets:
            name += "_"
        curves[name] = rest
        if sets:
            remarks.append(f"elements in no set, now in '{name}': {shorten(mesh.line_ids[rest])}")
    return curves


def adds_nothing(mesh: LineMesh, name: str, lines: Integers, taken: NDArray[np.object_]) -> bool:
    """Whether a set's lines, united with others, are those of one of their sets, or of several if all of them have
    sections. taken: each line's set so far, None without one [E]."""
    found = set(taken[lines])
    if None in found or np.any(mesh.counts[lines] == 1):
        return False
    return name in mesh.section_sets or any(np.count_nonzero(taken == one) == lines.size for one in found)


def check_overlap(mesh: LineMesh, name: str, lines: Integers, taken: NDArray[np.object_]) -> None:
    """Throws InputError if a line of the set is already in another one. taken: each line's set so far, None without one
    [E]."""
    for line in lines:
        if taken[line] is not None:
            raise InputError(
                f"{mesh.path}: error: element {mesh.line_ids[line]} is in the sets '{taken[line]}' and '{name}', which "
                "leaves its section open; name the sets that stand for sections with --sections"
            )


def name_points(mesh: LineMesh, remarks: list[str]) -> dict[str, int]:
    """Names points: name → node. A set of one node gives a point of its name, a set of several NAME_1, NAME_2, …"""
    points: dict[str, int] = {}
    for name, nodes in mesh.node_sets.items():
        if len(nodes) == 0:
            remarks.append(f"node set '{name}': has no node of a line")
        names = [name] if len(nodes) == 1 else [f"{name}_{number}" for number in range(1, len(nodes) + 1)]
        if len(nodes) > 1:
            remarks.append(
                f"node set '{name}' has {len(nodes)} nodes: one point for each, '{names[0]}' to '{names[-1]}'"
            )
        for point, node in zip(names, nodes):
            if point in points:
                raise InputError(f"{mesh.path}: error: two node sets give points of the name '{point}'")
            points[point] = int(node)
    return points


def rename_for_gmsh(groups: Mapping[str, Members], kind: str, remarks: list[str]) -> dict[str, Members]:
    """Gives the groups (name → members) names that gmsh keeps: at most LONGEST_NAME bytes on one line, not blank,
    without a blank at either end and without double quotes. Adds a remark on each new name. kind: what a group was, for
    the remark."""
    renamed: dict[str, Members] = {}
    for name, members in groups.items():
        plain = "".join(letter if letter.isprintable() else " " for letter in name.replace('"', "'")).strip()
        if len(plain.encode()) > LONGEST_NAME:
            plain = plain.encode()[: LONGEST_NAME - 7].decode(errors="ignore").strip()  # room for _2, _3, …
        plain = plain or "unnamed"
        given, number = plain, 1
        while given in renamed or (given != name and given in groups):
            number += 1
            given = f"{plain}_{number}"
        if given != name:
            remarks.append(f"{kind} '{name}': now '{given}', because gmsh has no such names")
        renamed[given] = members
    return renamed
