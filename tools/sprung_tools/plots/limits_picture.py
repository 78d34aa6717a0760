"""A picture of ride-limiting speeds over roughness and over the height of obstacles."""

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.plots.picture_file import PANEL_HEIGHT, line_style, make_figure

KMH = 3.6  # of a m/s
Points = Sequence[tuple[float, float]]


class Curve(NamedTuple):
    """The limits of a vehicle: (roughness or height [m], speed [m/s])."""

    label: str
    points: Points


def draw_curves(axes: Axes, curves: Sequence[Curve], scale: float, what: str) -> None:
    """Draws speeds in km/h, with m/s at the right. scale: of what they are drawn over."""
    for place, curve in enumerate(curves):
        xs, ys = [scale * x for x, _ in curve.points], [KMH * speed for _, speed in curve.points]
        axes.plot(xs, ys, marker="o", markersize=4, label=curve.label, **line_style(place, len(curves)))
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(what)
    axes.set_ylabel("speed, km/h")
    other = axes.secondary_yaxis("right", functions=(lambda speed: speed / KMH, lambda speed: speed * KMH))
    other.set_ylabel("m/s")
    axes.grid(color="0.9", linewidth=0.6)
    axes.legend(loc="best", frameon=False)


def make_limits_figure(
    title: str, terrain: Sequence[Curve], obstacles: Sequence[Curve], power: float, acceleration: str
) -> Figure:
    """Draws a panel for each kind of limit that there is."""
    kinds = [
        (terrain, 1e3, f"r.m.s. roughness at {power:g} W of absorbed power, mm"),
        (obstacles, 1e3, f"height of a half-round obstacle at {acceleration} at the driver, mm"),
    ]
    drawn = [kind for kind in kinds if any(curve.points for curve in kind[0])]
    heights = [1.2 * PANEL_HEIGHT] * max(1, len(drawn))
    figure, panels = make_figure(heights, f"{title}: ride-limiting speeds", "as in NRMM", one_axis=False)
    for axes, (curves, scale, what) in zip(panels, drawn):
        draw_curves(axes, curves, scale, what)
    return figure
