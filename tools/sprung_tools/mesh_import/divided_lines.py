"""Dividing the lines of a plane frame into several elements."""

import numpy as np

from sprung_tools.mesh_import.plane_frame import PlaneFrame


def divide_lines(frame: PlaneFrame, parts: int) -> PlaneFrame:
    """Each line as so many equal ones, with new nodes after the others. Lines are numbered anew.

    parts: ≥ 1.
    """
    if parts == 1:
        return frame
    num_lines, num_nodes, inner = len(frame.lines), len(frame.node_ids), parts - 1
    starts, ends = frame.positions[frame.lines[:, 0]], frame.positions[frame.lines[:, 1]]
    shares = (np.arange(1, parts) / parts)[:, None]
    between = starts[:, None] + shares * (ends - starts)[:, None]  # [E×(parts − 1)×2]
    new_nodes = num_nodes + np.arange(num_lines * inner).reshape(num_lines, inner)
    chains = np.column_stack([frame.lines[:, :1], new_nodes, frame.lines[:, 1:]])
    new_ids = frame.node_ids.max() + 1 + np.arange(num_lines * inner)
    return frame._replace(
        node_ids=np.concatenate([frame.node_ids, new_ids]),
        positions=np.concatenate([frame.positions, between.reshape(-1, 2)]),
        line_ids=np.arange(1, num_lines * parts + 1),
        lines=np.stack([chains[:, :-1], chains[:, 1:]], axis=2).reshape(-1, 2),
        curves={
            name: (parts * np.asarray(members)[:, None] + np.arange(parts)).ravel()
            for name, members in frame.curves.items()
        },
    )
