"""A picture of quantities of one or more runs over time, a panel for each quantity."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.files.results_file import ResultsFile
from sprung_tools.plots.history_panel import draw_panel
from sprung_tools.plots.picture_file import PANEL_HEIGHT, add_legend, make_figure
from sprung_tools.runs.labelled_runs import Run, Shown, samples_between
from sprung_tools.runs.run_caption import make_caption
from sprung_tools.signals.spans import OptionalSpan


class Obstacle(NamedTuple):
    """A stretch of time in which the road under a tyre is not at height 0."""

    tyre: str
    start: float
    end: float


def list_obstacles(results: ResultsFile, span: OptionalSpan) -> list[Obstacle]:
    """The obstacles that tyres pass over within a span of time; none of a road that is seldom level."""
    inside = samples_between(results, *span)
    time = results.time[inside]
    found = []
    for name in results.names("forces"):
        quantity = f"forces/{name}/road_height"
        if not results.has(quantity):
            continue
        is_over = results.series(quantity)[0] != 0.0
        if 2 * np.count_nonzero(is_over) > is_over.size:
            continue
        over = np.flatnonzero(is_over[inside])
        found += [Obstacle(name, time[one[0]], time[one[-1]])
                  for one in np.split(over, np.flatnonzero(np.diff(over) > 1) + 1) if one.size]  # fmt: skip
    return found


def mark_obstacles(axes: Axes, obstacles: Sequence[Obstacle]) -> None:
    """Shades the times of obstacles, and names each tyre at its first one."""
    named = set()
    for tyre, start, end in obstacles:
        axes.axvspan(start, end, color="0.88", zorder=-1)
        if tyre not in named:
            axes.annotate(
                tyre.replace("_", " "), (start, 1.0), xycoords=("data", "axes fraction"),
                xytext=(2, 3), textcoords="offset points", fontsize=8, color="0.35",
            )  # fmt: skip
        named.add(tyre)


def describe_obstacles(runs: Sequence[Run], obstacles: Sequence[Obstacle]) -> str:
    """What the caption says of them."""
    if not obstacles:
        return "no obstacle on a level road here"
    whose = f" in '{runs[0].label}'" if len(runs) > 1 else ""
    return f"shaded: tyre over an obstacle{whose}"


def make_results_figure(
    runs: Sequence[Run], quantities: Sequence[Shown], span: OptionalSpan, title: str, with_road: bool
) -> Figure:
    """Draws a panel for each quantity, a title, and a caption of what the runs have in common."""
    obstacles = list_obstacles(runs[0].results, span) if with_road else []
    legend = (describe_obstacles(runs, obstacles),) if with_road else ()
    caption = make_caption([run.results for run in runs], legend)
    figure, panels = make_figure([PANEL_HEIGHT] * len(quantities), title, caption)
    for place, (axes, shown) in enumerate(zip(panels, quantities)):
        is_shown_by_all = draw_panel(axes, runs, shown, span)
        if place == 0 or not is_shown_by_all:  # else the legend above holds here too
            add_legend(axes)
        mark_obstacles(axes, obstacles)
    panels[-1].set_xlabel("time, s")
    return figure
