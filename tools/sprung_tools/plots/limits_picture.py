"""A picture of ride-limiting speeds over roughness and over the height of obstacles."""

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.plots.picture_file import PANEL_HEIGHT, line_style, make_figure

KMH, MM = 3.6, 1e3  # of a m/s, of a m
MARGIN = 1.08  # of an axis over the largest value on it
MARKER, WIDER = 6.0, 4.0  # points: a mark beyond the bounds, and what that of each further vehicle has more
Points = Sequence[tuple[float, float]]


class Curve(NamedTuple):
    """The limits of a vehicle: (roughness or height [m], speed [m/s]); below, above: where it has none within the
    bounds that were tried, with the bound in its place."""

    label: str
    points: Points
    below: Points = ()
    above: Points = ()


class Panel(NamedTuple):
    """Limits of one kind: of all vehicles; what: they are drawn over; markers, words: of limits below and above what
    was tried."""

    curves: Sequence[Curve]
    what: str
    markers: tuple[str, str]
    words: tuple[str, str]


def scale_points(points: Points) -> tuple[list[float], list[float]]:
    """Places in mm, speeds in km/h."""
    return [MM * x for x, _ in points], [KMH * speed for _, speed in points]


def draw_panel(axes: Axes, panel: Panel) -> None:
    """Draws speeds in km/h, with m/s at the right."""
    curves = panel.curves
    for place, curve in enumerate(curves):
        style = line_style(place, len(curves))
        axes.plot(*scale_points(curve.points), marker="o", markersize=4, label=curve.label, **style)
        for points, marker in zip((curve.below, curve.above), panel.markers):
            axes.plot(*scale_points(points), marker, markersize=MARKER + WIDER * place, markerfacecolor="none",
                      color=style["color"])  # fmt: skip
    for beyond, marker, words in zip(zip(*((one.below, one.above) for one in curves)), panel.markers, panel.words):
        if any(beyond):
            axes.plot([], [], marker, markersize=MARKER, markerfacecolor="none", color="0.35", label=words)
    xs, ys = scale_points([point for one in curves for point in (*one.points, *one.below, *one.above)])
    axes.set_xlim(0.0, MARGIN * max(xs))
    axes.set_ylim(0.0, MARGIN * max(ys))
    axes.set_xlabel(panel.what)
    axes.set_ylabel("speed, km/h")
    other = axes.secondary_yaxis("right", functions=(lambda speed: speed / KMH, lambda speed: speed * KMH))
    other.set_ylabel("m/s")
    axes.grid(color="0.9", linewidth=0.6)
    axes.legend(loc="best", frameon=False)


def make_terrain_panel(curves: Sequence[Curve], power: float, bounds: tuple[float, float]) -> Panel:
    """Limits over terrain. power: the limit [W]; bounds: of the roughness that was tried [m]."""
    low, high = (f"{MM * one:g} mm" for one in bounds)
    what = f"r.m.s. roughness at {power:g} W of absorbed power, mm"
    return Panel(curves, what, ("<", ">"), (f"limit below {low}", f"limit above {high}"))


def make_obstacle_panel(curves: Sequence[Curve], acceleration: str, bounds: tuple[float, float]) -> Panel:
    """Limits over obstacles. acceleration: the limit; bounds: of the speed that was tried [m/s]."""
    low, high = (f"{one:g} m/s" for one in bounds)
    what = f"height of a half-round obstacle at {acceleration} at the driver, mm"
    return Panel(curves, what, ("v", "^"), (f"limit below {low}", f"limit above {high}"))


def make_limits_figure(title: str, panels: Sequence[Panel]) -> Figure:
    """Draws each kind of limit that there is."""
    drawn = [panel for panel in panels if any(one.points or one.below or one.above for one in panel.curves)]
    heights = [1.2 * PANEL_HEIGHT] * max(1, len(drawn))
    figure, axes = make_figure(heights, f"{title}: ride-limiting speeds", "as in NRMM", one_axis=False)
    for one, panel in zip(axes, drawn):
        draw_panel(one, panel)
    return figure
