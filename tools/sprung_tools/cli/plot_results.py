"""Draws quantities of one or more runs over time into a picture, a panel for each quantity."""

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from sprung_tools.plots.history_panel import draw_panel
from sprung_tools.plots.picture_file import MARGIN_HEIGHT, PANEL_HEIGHT, SETTINGS, WIDTH, write_picture
from sprung_tools.runs.labelled_runs import add_run_arguments, open_runs, shown_quantities
from sprung_tools.runs.run_caption import make_caption
from sprung_tools.terminal.program import make_parser


def mark_road(axes, results):
    """Shades the time in which the road under a tyre is not at height 0, a tyre's name to each."""
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


def make_figure(runs, quantities, span, title, with_road):
    """A panel for each quantity, a title, and the caption of what the runs share."""
    matplotlib.rcParams.update(SETTINGS)
    height = MARGIN_HEIGHT + PANEL_HEIGHT * len(quantities)
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    panels = figure.subplots(len(quantities), sharex=True, squeeze=False)[:, 0]
    for place, (axes, shown) in enumerate(zip(panels, quantities)):
        is_shown_by_all = draw_panel(axes, runs, shown, span)
        if place == 0 or not is_shown_by_all:  # else the legend above holds here too
            axes.legend(loc="best", frameon=False)
        if with_road:
            mark_road(axes, runs[0].results)
    panels[-1].set_xlabel("time, s")
    figure.suptitle(title)
    legend = ("shaded: tyre over an obstacle",) if with_road else ()
    figure.supxlabel(make_caption([run.results for run in runs], legend), fontsize=8.5, color="0.25")
    return figure


def main():
    parser = make_parser(
        __doc__,
        "tools/plot_results -o bump.png rigid=bump_rigid.h5 '2 modes=bump_2modes.h5' \\\n"
        "    --show 'heave=bodies/chassis/displacement.y' --show points/chassis.seat/acceleration.y",
    )
    add_run_arguments(parser)
    parser.add_argument(
        "-o", "--output", required=True, metavar="PICTURE", help="file to write (.png, .svg, .pdf)"
    )
    parser.add_argument("--title", default="", help="heading; the run's title if not given")
    parser.add_argument(
        "--mark-road", action="store_true", help="shade the time in which a tyre is on an obstacle"
    )
    arguments = parser.parse_args()

    runs = open_runs(arguments.runs)
    title = arguments.title or runs[0].results.title
    span = (arguments.start, arguments.end)
    figure = make_figure(runs, shown_quantities(arguments.show), span, title, arguments.mark_road)
    write_picture(figure, arguments.output)
    print(arguments.output)
    return 0
