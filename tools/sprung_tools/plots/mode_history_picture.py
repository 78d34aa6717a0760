"""A picture of the active modes over time, the contribution of those left out, and quantities of the run."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.reduced_vectors import Vector, count_vectors
from sprung_tools.model.resolved_model import has_resolved_model, read_settings
from sprung_tools.plots.history_panel import draw_panel, show_span
from sprung_tools.plots.picture_file import COLOURS, make_figure
from sprung_tools.runs.labelled_runs import Run, Shown, samples_between
from sprung_tools.runs.mode_history import (
    ModeHistory,
    find_change_times,
    find_worst_neglect,
    read_mode_histories,
    read_neglected,
)
from sprung_tools.runs.run_caption import make_caption
from sprung_tools.signals.spans import OptionalSpan, find_spans

INDICATOR_HEIGHT, QUANTITY_HEIGHT = 1.9, 2.8  # inches
LEAST_HEIGHT, HEIGHT_PER_MODE, MOST_HEIGHT = 1.3, 0.12, 4.2  # inches, of a panel with modes
LABELLED_FREQUENCIES = 9  # at most beside the modes of a panel
LEAST_PERCENT = 1e-3  # where the panel of shares begins
ABOVE = 2.0  # its upper end over the largest share
NEGLECT = {"deflection": COLOURS[0], "acceleration": COLOURS[2]}  # the first columns of `neglected`


def describe_activity(results: ResultsFile, history: ModeHistory) -> str:
    """The title above a body's modes. It is about the whole run, even if only a part of the run is drawn."""
    number = count_vectors(history.vectors)
    if np.all(history.is_active):
        if len(history.vectors) == 1:
            return f"{history.body}: the only {number.split()[1]} of the run takes part throughout"
        return f"{history.body}: all {number} of the run take part throughout"
    counts = np.sum(history.is_active, axis=1)
    changes = find_change_times(results).size
    return (
        f"{history.body}: {np.mean(counts):.1f} of {number} take part on the run's average, "
        f"{np.max(counts)} at most; changes at {changes} instants"
    )


def describe_frequency(vector: Vector) -> str:
    """A vector's frequency in three digits, or its kind."""
    if vector.frequency is None:
        return vector.kind
    return f"{vector.frequency:.3g}" if vector.frequency < 100.0 else f"{vector.frequency:.0f}"


def draw_modes(axes: Axes, results: ResultsFile, history: ModeHistory) -> None:
    """Draws a bar for each mode while it takes part. At the right is its frequency, or its kind if it is no mode of the
    body; nothing of files that do not say its kind."""
    rows = np.arange(1, len(history.vectors) + 1)
    for row in rows:
        spans = find_spans(history.is_active[:, row - 1], results.time)
        bars = [(start, end - start) for start, end in spans]
        axes.broken_barh(bars, (row - 0.36, 0.72), color=COLOURS[1], linewidth=0.0)
    axes.set_ylim(0.3, rows[-1] + 0.7)
    step = max(1, -(-rows.size // LABELLED_FREQUENCIES))
    places = rows[::step]
    axes.set_yticks(places, [f"{history.vectors[row - 1].number}" for row in places])
    axes.set_ylabel(count_vectors(history.vectors).split()[1].removesuffix("s"))
    axes.set_title(describe_activity(results, history), loc="left", fontsize=10.5)
    axes.grid(axis="x", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    right = axes.twinx()
    right.set_ylim(axes.get_ylim())
    right.set_yticks(places, [describe_frequency(history.vectors[row - 1]) for row in places])
    right.set_ylabel("frequency, Hz")
    right.spines["top"].set_visible(False)


def draw_neglected(axes: Axes, results: ResultsFile) -> None:
    """Draws the largest share of a mode left out, and the share at which it joins if modes join and leave."""
    found = np.max(np.array([values[:, :2] for values in read_neglected(results).values()]), axis=0)
    for column, (name, colour) in enumerate(NEGLECT.items()):
        percent = 100.0 * found[:, column]
        worst = find_worst_neglect(results, column)
        label = f"of the largest {name} so far"
        if worst:
            label += f": {100.0 * worst.share:.3g} % at most, {worst.body} mode {worst.mode} at {worst.time:.4g} s"
        drawn = np.where(percent > LEAST_PERCENT, percent, np.nan)
        axes.semilogy(results.time, drawn, color=colour, linewidth=0.9, label=label)
    adaptivity = read_settings(results)["adaptivity"] if has_resolved_model(results) else {}
    if adaptivity.get("enabled"):
        recall = adaptivity["recall"]
        axes.axhline(100.0 * recall, color="0.3", linewidth=0.9, linestyle="--", label=f"recall, {100.0 * recall:g} %")
    axes.set_ylim(LEAST_PERCENT, ABOVE * max(axes.dataLim.ymax, LEAST_PERCENT))
    axes.set_ylabel("left out, %")
    axes.grid(color="0.9", linewidth=0.6)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderpad=0.0, frameon=False, fontsize=9.5)


def make_mode_history_figure(
    runs: Sequence[Run], quantities: Sequence[Shown], span: OptionalSpan, title: str = ""
) -> Figure:
    """Draws the first run's modes over time, the shares of those left out, and quantities of all runs.

    InputError if the first run has no modes.
    """
    results = runs[0].results
    histories = read_mode_histories(results)
    has_neglected = bool(read_neglected(results))
    heights = [np.clip(HEIGHT_PER_MODE * len(one.vectors), LEAST_HEIGHT, MOST_HEIGHT) for one in histories]
    heights += [INDICATOR_HEIGHT] * has_neglected + [QUANTITY_HEIGHT] * len(quantities)
    figure, panels = make_figure(heights, title or results.title, make_caption([run.results for run in runs]))
    for axes, history in zip(panels, histories):
        draw_modes(axes, results, history)
    if has_neglected:
        draw_neglected(panels[len(histories)], results)
    for axes, shown in zip(panels[-len(quantities) :], quantities):
        draw_panel(axes, runs, shown, span)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderpad=0.0, frameon=False, fontsize=9.5, ncols=3)
    inside = results.time[samples_between(results, *span)]
    show_span(panels[-1], inside[0], inside[-1])
    panels[-1].set_xlabel("time, s")
    return figure
