"""A frame of line elements read from another program's mesh file, and how it becomes a plane frame with one group for
each element: what the readers give (abaqus_deck, nastran_deck, meshio_source) and what gmsh_writer takes."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError

SAME_PLACE = 1e-9  # of the frame's extent: nodes nearer than this are one, a plane is flat to this
REST = "lines"  # the group of elements that the source puts in no set
LONGEST_NAME = 127  # bytes, of a group in gmsh
AXES = "xyz"


class MeshError(InputError):
    """A mesh file that cannot be used; the text is `path: error: …` or `path:line: error: …`."""


@dataclass
class LineMesh:
    """N nodes and E two-node lines. Sets hold 0-based numbers of nodes or lines, in the source's order."""

    path: str
    format: str  # in words, for messages
    node_ids: np.ndarray  # [N] the source's numbers, > 0, unique
    positions: np.ndarray  # [N×3] m
    line_ids: np.ndarray  # [E] > 0, unique
    lines: np.ndarray  # [E×2] 0-based nodes
    element_sets: dict = field(default_factory=dict)
    node_sets: dict = field(default_factory=dict)
    section_sets: tuple = ()  # names of those element sets that the source gives sections to
    left_behind: list = field(default_factory=list)  # what the source holds and this does not, a text each


class PlaneFrame(NamedTuple):
    """What is written: every line in exactly one curve, every point one node."""

    node_ids: np.ndarray  # [N]
    positions: np.ndarray  # [N×2] m
    line_ids: np.ndarray  # [E]
    lines: np.ndarray  # [E×2]
    curves: dict  # name → line numbers
    points: dict  # name → node number
    remarks: list  # what became of the sets and nodes that are not kept as they were, a text each


def make_plane_frame(mesh, plane="xy", wanted_sets=(), scale=1.0):
    """Takes a mesh's lines, in the plane asked for, with each line in one group.

    plane: two of the source's axes, which become x and y; wanted_sets: the element sets that become curves where sets
    overlap; scale: of all lengths. MeshError without lines, off the plane, with two nodes at one place, or where
    overlapping sets leave a line's section open.
    """
    if len(mesh.lines) == 0:
        raise MeshError(f"{mesh.path}: error: no line elements; {describe_found(mesh)}")
    mesh, remarks = drop_unused_nodes(mesh)
    positions = scale * project(mesh, plane)
    check_places(mesh, positions)
    curves = choose_curves(mesh, wanted_sets, remarks)
    points = name_points(mesh, remarks)
    curves = rename_for_gmsh(curves, "element set", remarks)
    points = rename_for_gmsh(points, "node set", remarks)
    return PlaneFrame(mesh.node_ids, positions, mesh.line_ids, mesh.lines, curves, points, remarks)


def describe_found(mesh):
    """What a file without lines does hold."""
    return (
        "; ".join(["the file holds " + text for text in mesh.left_behind[:3]]) or "the file holds no elements"
    )


def shorten(items, most=8):
    """Comma-separated, at most so many."""
    texts = [str(item) for item in items]
    return ", ".join(texts[:most]) + (f", … ({len(texts)} in all)" if len(texts) > most else "")


def drop_unused_nodes(mesh):
    """The mesh with those nodes alone that a line uses, and a remark on the others."""
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
        mesh.element_sets, sets, mesh.section_sets, mesh.left_behind,
    )  # fmt: skip
    return smaller, [f"nodes that no line uses: {shorten(mesh.node_ids[unused])}"]


def project(mesh, plane):
    """Positions [N×2] in the plane of two of the source's axes. MeshError, with the deviation, if they lie off it."""
    kept = [AXES.index(axis) for axis in plane]
    (normal,) = {0, 1, 2} - set(kept)
    depth = mesh.positions[:, normal]
    extent = np.linalg.norm(np.ptp(mesh.positions, axis=0))
    if np.ptp(depth) > SAME_PLACE * extent:
        low, high = int(np.argmin(depth)), int(np.argmax(depth))
        others = [a + b for a, b in ("xy", "xz", "yz") if {a, b} != set(plane)]
        axis = AXES[normal]
        raise MeshError(
            f"{mesh.path}: error: the lines do not lie in a plane parallel to {plane[0]}–{plane[1]}: "
            f"node {mesh.node_ids[low]} is at {axis} = {depth[low]:.9g}, node {mesh.node_ids[high]} at {depth[high]:.9g}, "
            f"{np.ptp(depth):.3g} apart; expected {SAME_PLACE * extent:.1g} at most, or --plane {' or '.join(others)}"
        )
    return mesh.positions[:, kept]


def check_places(mesh, positions):
    """MeshError if two nodes are at one place, or a line has no length."""
    bad = np.flatnonzero(mesh.lines[:, 0] == mesh.lines[:, 1])
    if bad.size:
        raise MeshError(
            f"{mesh.path}: error: element {mesh.line_ids[bad[0]]} begins and ends at node "
            f"{mesh.node_ids[mesh.lines[bad[0], 0]]}"
        )
    extent = np.linalg.norm(np.ptp(positions, axis=0))
    near = SAME_PLACE * extent
    pair = find_near_pair(positions, near)
    if pair is not None:
        a, b = sorted(mesh.node_ids[node] for node in pair)
        x, y = positions[pair[0]]
        raise MeshError(
            f"{mesh.path}: error: nodes {a} and {b} are both at ({x:.9g}, {y:.9g}); elements meet at a common "
            "node, so merge them"
        )


def find_near_pair(positions, near):
    """Two nodes [N×2] no further than `near` apart in x and in y, or None. Each is sought among those of its own and
    the eight neighbouring squares of that size alone, so that many nodes above one another take no longer."""
    squares = np.floor((positions - positions.min(axis=0)) / (near or 1.0)).astype(int)
    nodes_in = {}
    for node, (i, j) in enumerate(squares.tolist()):
        for square in ((i + a, j + b) for a in (-1, 0, 1) for b in (-1, 0, 1)):
            for other in nodes_in.get(square, ()):
                if np.all(np.abs(positions[node] - positions[other]) <= near):
                    return other, node
        nodes_in.setdefault((i, j), []).append(node)
    return None


def choose_curves(mesh, wanted_sets, remarks):
    """The group of each line: name → line numbers, together all lines, none twice; says in remarks what it left out.

    Sets that do not overlap are all kept. Where they do, those of wanted_sets, else those that the source gives
    sections to, are kept, and of the others those that overlap nothing kept.
    """
    sets = {name: np.unique(lines) for name, lines in mesh.element_sets.items() if len(lines) > 0}
    for name in wanted_sets:
        if name not in sets:
            there = shorten(sets) or "no element sets of lines"
            raise MeshError(f"{mesh.path}: error: no element set '{name}' of lines; the file has {there}")
    overlap = (
        sum(lines.size for lines in sets.values()) > np.unique(np.concatenate([*sets.values(), []])).size
    )
    first = wanted_sets or (tuple(n for n in mesh.section_sets if n in sets) if overlap else tuple(sets))
    taken = np.full(mesh.line_ids.size, None)
    curves = {}
    for name in first:
        check_overlap(mesh, name, sets[name], taken)
        taken[sets[name]] = name
        curves[name] = sets[name]
    for name, lines in sets.items():
        if name in curves:
            continue
        if wanted_sets:
            remarks.append(f"element set '{name}' ({lines.size} lines): not asked for")
        elif first and any(taken[line] is not None for line in lines):
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


def check_overlap(mesh, name, lines, taken):
    """MeshError if a line of the set is taken already."""
    for line in lines:
        if taken[line] is not None:
            raise MeshError(
                f"{mesh.path}: error: element {mesh.line_ids[line]} is in the sets '{taken[line]}' and '{name}', which "
                "leaves its section open; name the sets that stand for sections with --sections"
            )


def name_points(mesh, remarks):
    """Name → node: a set of one node gives its name, one of several gives NAME_1, NAME_2, …"""
    points = {}
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
                raise MeshError(f"{mesh.path}: error: two node sets give points of the name '{point}'")
            points[point] = int(node)
    return points


def rename_for_gmsh(groups, kind, remarks):
    """The groups (name → members) under names that gmsh keeps: of at most LONGEST_NAME bytes on one line, not blank, no
    blank at either end, no double quote; says in remarks what it renamed. kind: what a group was, for the remark."""
    renamed = {}
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


def pick_members(sets, number):
    """Sets of ids as sets of numbers (id → number), each member once, without those that have none."""
    picked = {}
    for name, members in sets.items():
        kept = dict.fromkeys(number[member] for member in members if member in number)
        picked[name] = np.array(list(kept), dtype=int)
    return picked
