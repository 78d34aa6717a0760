"""Writing a plane frame as a gmsh 4.1 mesh: as text, every number with the 17 digits that reproduce it exactly."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from sprung_tools.files.whole_file import write_whole
from sprung_tools.mesh_import.plane_frame import PlaneFrame

LINE, POINT = 1, 15  # gmsh's numbers of the two-node line and the point


def format_msh(frame: PlaneFrame) -> str:
    """The text of the file. Each curve is one discrete curve entity and one physical group; each point likewise.

    Node and line numbers are the frame's own. Source: gmsh reference manual 4.8, "MSH file format".
    """
    places = [(f"{x:.17g} {y:.17g} 0") for x, y in frame.positions]
    names_of: dict[int, list[int]] = {}  # node → numbers of its physical points
    for number, node in enumerate(frame.points.values(), start=1):
        names_of.setdefault(node, []).append(number)
    ends = sorted(names_of)  # nodes that are point entities, tagged from 1
    parts = [["$MeshFormat", "4.1 0 8", "$EndMeshFormat"]]
    parts.append(format_names(frame))
    parts.append(format_entities(frame, places, ends, names_of))
    parts.append(format_nodes(frame, places, ends))
    parts.append(format_elements(frame, ends))
    return "\n".join(line for part in parts for line in part) + "\n"


def format_names(frame: PlaneFrame) -> list[str]:
    """$PhysicalNames: dimension, number, name."""
    names = [f'0 {number} "{name}"' for number, name in enumerate(frame.points, start=1)]
    names += [f'1 {number} "{name}"' for number, name in enumerate(frame.curves, start=1)]
    return ["$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"]


def format_entities(
    frame: PlaneFrame, places: Sequence[str], ends: Sequence[int], names_of: dict[int, list[int]]
) -> list[str]:
    """$Entities: each point with its groups; each curve with bounding box and group, without bounding points."""
    lines = ["$Entities", f"{len(ends)} {len(frame.curves)} 0 0"]
    for tag, node in enumerate(ends, start=1):
        groups = names_of[node]
        lines.append(f"{tag} {places[node]} {len(groups)} {' '.join(map(str, groups))}")
    for tag, members in enumerate(frame.curves.values(), start=1):
        corners = frame.positions[np.unique(frame.lines[members])]
        (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
        lines.append(f"{tag} {x0:.17g} {y0:.17g} 0 {x1:.17g} {y1:.17g} 0 1 {tag} 0")
    return [*lines, "$EndEntities"]


def format_nodes(frame: PlaneFrame, places: Sequence[str], ends: Sequence[int]) -> list[str]:
    """$Nodes: a block for each point entity, then for each curve a block of the nodes that no earlier block has."""
    blocks = [(0, tag, [node]) for tag, node in enumerate(ends, start=1)]
    seen = set(ends)
    for tag, members in enumerate(frame.curves.values(), start=1):
        nodes = [node for node in map(int, np.unique(frame.lines[members])) if node not in seen]
        seen.update(nodes)
        if nodes:
            blocks.append((1, tag, nodes))
    ids = frame.node_ids
    lines = ["$Nodes", f"{len(blocks)} {ids.size} {ids.min()} {ids.max()}"]
    for dimension, tag, nodes in blocks:
        lines.append(f"{dimension} {tag} 0 {len(nodes)}")
        lines += [str(ids[node]) for node in nodes]
        lines += [places[node] for node in nodes]
    return [*lines, "$EndNodes"]


def format_elements(frame: PlaneFrame, ends: Sequence[int]) -> list[str]:
    """$Elements: the lines have their own numbers; the points have the numbers after the last line's."""
    after = int(frame.line_ids.max())
    lines = ["$Elements", f"{len(frame.curves) + len(ends)} {len(frame.lines) + len(ends)} "
             f"{frame.line_ids.min()} {after + len(ends)}"]  # fmt: skip
    for tag, node in enumerate(ends, start=1):
        lines += [f"0 {tag} {POINT} 1", f"{after + tag} {frame.node_ids[node]}"]
    for tag, members in enumerate(frame.curves.values(), start=1):
        lines.append(f"1 {tag} {LINE} {len(members)}")
        for member in members:
            first, second = frame.node_ids[frame.lines[member]]
            lines.append(f"{frame.line_ids[member]} {first} {second}")
    return [*lines, "$EndElements"]


def write_msh(frame: PlaneFrame, path: str | Path) -> None:
    """Writes the mesh whole or not at all. InputError if it cannot be written."""
    write_whole(path, format_msh(frame))
