"""A picture of the fatigue of a body: damage and stresses along it; stress over time and cycles at a place."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.files.array_types import Floats
from sprung_tools.plots.picture_file import PANEL_HEIGHT, line_style, make_figure
from sprung_tools.runs.fatigue import Fatigue, count_at
from sprung_tools.runs.section_stress import FROM_MODES
from sprung_tools.signals.fatigue_damage import CATEGORY_CYCLES, StrengthLine, calc_range

MPA = 1e-6  # of a Pa
FLOOR = 1e-6  # of the greatest damage: what is drawn at least


class DrawnFatigue(NamedTuple):
    """The fatigue of a body in a run, and what it is from: its loads or its modes."""

    label: str
    source: str
    fatigue: Fatigue


class Place(NamedTuple):
    """A station's fibre, in the order of `Fatigue`."""

    station: int
    side: int


def choose_style(curves: Sequence[DrawnFatigue], curve: DrawnFatigue) -> dict[str, object]:
    """The look of a curve: a colour for each run, dashes for what is from modes."""
    labels = list(dict.fromkeys(one.label for one in curves))
    dashes = "--" if curve.source == FROM_MODES else "-"
    return {**line_style(labels.index(curve.label), len(labels)), "linestyle": dashes}


def draw_damage(axes: Axes, curves: Sequence[DrawnFatigue]) -> None:
    """Draws the damage along the body, that of the worse fibre."""
    greatest = max(float(np.max(one.fatigue.damage)) for one in curves)
    for one in curves:
        damage = np.max(one.fatigue.damage, axis=1)
        values = np.where(damage > FLOOR * greatest, damage, np.nan)
        axes.plot(
            one.fatigue.section.along, values, label=f"{one.label}, from {one.source}", **choose_style(curves, one)
        )
    if greatest > 0.0:
        axes.set_yscale("log")
    axes.set_ylabel("damage of a repetition")
    axes.legend(loc="best", frameon=False, fontsize=9)


def draw_envelope(axes: Axes, curves: Sequence[DrawnFatigue], place: Place) -> None:
    """Draws the highest and the lowest stress along the body, and marks a place."""
    for one in curves:
        section = one.fatigue.section
        for values in (np.max(section.stress, axis=(0, 2)), np.min(section.stress, axis=(0, 2))):
            axes.plot(section.along, MPA * values, **choose_style(curves, one))
    along = curves[0].fatigue.section
    axes.axvline(along.along[place.station], color="0.6", linewidth=0.8, zorder=0)
    axes.axhline(0.0, color="0.6", linewidth=0.8, zorder=0)
    axes.set_ylabel("stress, MPa: highest and lowest")
    axes.set_xlabel(along.axis)


def draw_history(axes: Axes, curves: Sequence[DrawnFatigue], place: Place) -> None:
    """Draws the stress of a fibre over time."""
    for one in curves:
        stress = one.fatigue.section.stress[:, place.station, place.side]
        axes.plot(one.fatigue.time, MPA * stress, **choose_style(curves, one))
    axes.set_ylabel("stress, MPa")
    axes.set_xlabel("time, s")


def calc_spectrum(ranges: Floats, counts: Floats) -> tuple[Floats, Floats]:
    """How many cycles have a range of at least that: numbers and ranges, the greatest range first."""
    order = np.argsort(-ranges, kind="stable")
    return np.cumsum(counts[order]), ranges[order]


def draw_spectrum(axes: Axes, curves: Sequence[DrawnFatigue], place: Place, line: StrengthLine) -> None:
    """Draws how many cycles of a repetition reach a range, beside the cycles that the range exhausts."""
    for one in curves:
        cycles = count_at(one.fatigue, *place)
        if cycles.ranges.size:
            axes.step(
                *calc_scaled(*calc_spectrum(cycles.ranges, cycles.counts)), where="pre", **choose_style(curves, one)
            )
    last = line.endurance or 50.0 * line.knee
    numbers = np.geomspace(1e4, last, 200)
    ranges = MPA * np.array([calc_range(line, number) for number in numbers])
    label = f"range that N cycles exhaust ({MPA * line.category:g} MPa at {CATEGORY_CYCLES:g})"
    axes.plot(numbers, ranges, color="0.5", linewidth=1.0, linestyle=":", label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.02 * float(np.max(ranges)) / 10.0)
    axes.set_ylabel("range, MPa")
    axes.set_xlabel("cycles of at least this range")
    axes.legend(loc="best", frameon=False, fontsize=9)


def calc_scaled(numbers: Floats, ranges: Floats) -> tuple[Floats, Floats]:
    """The same with the ranges in MPa."""
    return numbers, MPA * ranges


def make_fatigue_figure(
    body: str, curves: Sequence[DrawnFatigue], place: Place, line: StrengthLine, title: str
) -> Figure:
    """Draws damage and stresses along a body, and stress and cycles at one of its places."""
    section = curves[0].fatigue.section
    side = section.sides[place.station][place.side]
    where = f"at {section.name_place(place.station)}, on the {side} side"
    caption = "nominal stresses of the beam, without welds, holes and corners; dashed: from the modes"
    heights = [PANEL_HEIGHT, 0.8 * PANEL_HEIGHT, 0.8 * PANEL_HEIGHT, PANEL_HEIGHT]
    figure, panels = make_figure(heights, f"{title}: fatigue of {body}", caption, one_axis=False)
    draw_damage(panels[0], curves)
    draw_envelope(panels[1], curves, place)
    draw_history(panels[2], curves, place)
    draw_spectrum(panels[3], curves, place, line)
    panels[0].sharex(panels[1])
    for axes in panels[2:]:
        axes.set_title(where, fontsize=10, loc="left")
    for axes in panels:
        axes.grid(color="0.9", linewidth=0.6)
    return figure
