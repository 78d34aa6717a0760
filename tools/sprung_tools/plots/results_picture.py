"""A picture of quantities of one or more runs over time, a panel for each quantity."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.files.results_file import ResultsFile
from sprung_tools.plots.history_panel import draw_panel
from sprung_tools.plots.picture_file import PANEL_HEIGHT, make_figure
from sprung_tools.runs.labelled_runs import Run, Shown
from sprung_tools.runs.run_caption import make_caption
from sprung_tools.signals.spans import OptionalSpan


def mark_road(axes: Axes, results: ResultsFile) -> None:
    """Shades the times in which the road under a tyre is not at height 0, and names the tyre."""
    for name in results.names("forces"):
        quantity = f"forces/{name}/road_height"
        if not results.has(quantity):
            continue
        over = np.flatnonzero(results.series(quantity)[0])
        if over.size == 0 or over.size > results.time.size // 2:
            continue
        axes.axvspan(results.time[over[0]], results.time[over[-1]], color="0.88", zorder=-1)
        axes.annotate(
            name.replace("_", " "), (results.time[over[0]], 1.0), xycoords=("data", "axes fraction"),
            xytext=(2, 3), textcoords="offset points", fontsize=8, color="0.35",
        )  # fmt: skip


def make_results_figure(
    runs: Sequence[Run], quantities: Sequence[Shown], span: OptionalSpan, title: str, with_road: bool
) -> Figure:
    """Draws a panel for each quantity, a title, and a caption of what the runs have in common."""
    legend = ("shaded: tyre over an obstacle",) if with_road else ()
    caption = make_caption([run.results for run in runs], legend)
    figure, panels = make_figure([PANEL_HEIGHT] * len(quantities), title, caption)
    for place, (axes, shown) in enumerate(zip(panels, quantities)):
        is_shown_by_all = draw_panel(axes, runs, shown, span)
        if place == 0 or not is_shown_by_all:  # else the legend above holds here too
            axes.legend(loc="best", frameon=False)
        if with_road:
            mark_road(axes, runs[0].results)
    panels[-1].set_xlabel("time, s")
    return figure
