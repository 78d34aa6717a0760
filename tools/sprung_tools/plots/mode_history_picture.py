"""A picture of which modes took part over time, and of what those left out would have done, above what the run did."""

import numpy as np

from sprung_tools.model.resolved_model import has_resolved_model, read_settings
from sprung_tools.plots.history_panel import draw_panel
from sprung_tools.plots.picture_file import COLOURS, make_figure
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.runs.mode_history import find_change_times, find_worst_neglect, read_mode_histories, read_neglected
from sprung_tools.runs.run_caption import make_caption

INDICATOR_HEIGHT, QUANTITY_HEIGHT = 1.9, 2.8  # inches
LEAST_HEIGHT, HEIGHT_PER_MODE, MOST_HEIGHT = 1.3, 0.12, 4.2  # inches, of a panel with modes
LABELLED_FREQUENCIES = 9  # at most, beside the modes of a panel
LEAST_PERCENT = 1e-3  # of the panel with shares
NEGLECT = {"deflection": COLOURS[0], "acceleration": COLOURS[2]}  # columns of `neglected`


def find_spans(is_active, time):
    """Spans (start, length) [s] in which a mode takes part [n], each sample standing for the time up to the next."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], is_active.astype(int), [0]))))
    ends = np.append(time, time[-1])
    return [(ends[first], ends[last] - ends[first]) for first, last in edges.reshape(-1, 2)]


def describe_activity(results, history):
    """What stands above a body's modes: of the whole run, also where only a part of it is drawn."""
    number = history.is_active.shape[1]
    if np.all(history.is_active):
        return f"{history.body}: all {number} modes of the run take part throughout"
    counts = np.sum(history.is_active, axis=1)
    changes = find_change_times(results).size
    return (
        f"{history.body}: {np.mean(counts):.1f} of {number} modes take part on the run's average, "
        f"{np.max(counts)} at most; "
        f"changes at {changes} instants"
    )


def draw_modes(axes, results, history):
    """A bar for each mode while it takes part; clamped frequencies at the right."""
    rows = np.arange(1, history.number.size + 1)
    for row, is_active in zip(rows, history.is_active.T):
        axes.broken_barh(find_spans(is_active, results.time), (row - 0.36, 0.72), color=COLOURS[1], linewidth=0.0)
    axes.set_ylim(0.3, rows[-1] + 0.7)
    step = max(1, -(-rows.size // LABELLED_FREQUENCIES))
    places = rows[::step]
    axes.set_yticks(places, [f"{history.number[row - 1]}" for row in places])
    axes.set_ylabel("mode")
    axes.set_title(describe_activity(results, history), loc="left", fontsize=10.5)
    axes.grid(axis="x", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    right = axes.twinx()
    right.set_ylim(axes.get_ylim())
    right.set_yticks(places, [f"{history.frequency[row - 1]:.3g}" if history.frequency[row - 1] < 100.0
                              else f"{history.frequency[row - 1]:.0f}" for row in places])  # fmt: skip
    right.set_ylabel("clamped\nfrequency, Hz")
    right.spines["top"].set_visible(False)


def draw_neglected(axes, results):
    """What the mode left out that misses most would have reached; the share at which it joins, in a run whose modes
    join and leave."""
    found = np.max([values[:, :2] for values in read_neglected(results).values()], axis=0)
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
    axes.set_ylim(LEAST_PERCENT, None)
    axes.set_ylabel("left out, %")
    axes.grid(color="0.9", linewidth=0.6)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderpad=0.0, frameon=False, fontsize=9.5)


def make_mode_history_figure(runs, quantities, span, title=""):
    """Modes of the first run over time, shares left out, and quantities of all runs.

    runs: list of Run, the first with modes (InputError if it has none); quantities: list of Shown; span: (from, to)
    [s].
    """
    results = runs[0].results
    histories = read_mode_histories(results)
    has_neglected = bool(read_neglected(results))
    heights = [np.clip(HEIGHT_PER_MODE * one.number.size, LEAST_HEIGHT, MOST_HEIGHT) for one in histories]
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
    panels[-1].set_xlim(inside[0], inside[-1])
    panels[-1].set_xlabel("time, s")
    return figure
