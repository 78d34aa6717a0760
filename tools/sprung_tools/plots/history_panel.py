"""A quantity of one or more runs over time, in a panel of a picture."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from sprung_tools.files.errors import InputError
from sprung_tools.plots.picture_file import label_unit, line_style
from sprung_tools.runs.labelled_runs import Run, Shown, runs_with, samples_between
from sprung_tools.signals.spans import OptionalSpan

# unit → the unit that is drawn, the factor, and the peak above which the unit is kept.
SCALES = {"m": ("mm", 1e3, 0.5), "N": ("kN", 1e-3, np.inf)}


def drawn_unit(unit: str, peak: float) -> tuple[str, float]:
    """Chooses a unit in which an axis' numbers are easy to read. Returns (unit, factor)."""
    name, factor, below = SCALES.get(unit, (unit, 1.0, np.inf))
    return (name, factor) if peak < below else (unit, 1.0)


def show_span(axes: Axes, start: float, end: float) -> None:
    """Has an axis of time show a span, unless it is that of a single sample."""
    if start < end:
        axes.set_xlim(start, end)


def draw_panel(axes: Axes, runs: Sequence[Run], shown: Shown, span: OptionalSpan) -> bool:
    """Draws one quantity of all runs that have it, over the samples of a span of time. Returns whether all runs have
    it."""
    curves = []
    for run in runs_with(runs, shown):
        inside = samples_between(run.results, *span)
        values, unit = run.results.series(shown.quantity)
        curves.append((run, run.results.time[inside], values[inside], unit))
    units = {unit for *_, unit in curves}
    if len(units) > 1:
        raise InputError(
            f"{curves[-1][0].results.path}: error: '{shown.quantity}' is in {sorted(units)} in these files"
        )
    unit, factor = drawn_unit(units.pop(), max(np.max(np.abs(values)) for _, _, values, _ in curves))
    for run, time, values, _ in curves:
        axes.plot(time, factor * values, label=run.label, **line_style(runs.index(run), len(runs)))
    show_span(axes, min(time[0] for _, time, _, _ in curves), max(time[-1] for _, time, _, _ in curves))
    axes.set_ylabel(f"{shown.label}, {label_unit(unit)}" if unit else shown.label)
    axes.axhline(0.0, color="0.6", linewidth=0.8, zorder=0)
    axes.grid(color="0.9", linewidth=0.6)
    return len(curves) == len(runs)
