"""Prints the extremes and the r.m.s. of quantities of one or more runs, as a table.

The span of time is that of the run file's [statistics], as in `ride`, or the one given."""

import argparse

import numpy as np

from sprung_tools.cli.arguments import add_run_arguments
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import has_resolved_model
from sprung_tools.runs.labelled_runs import (
    Run,
    Shown,
    describe_spans,
    list_lacking,
    open_runs,
    runs_with,
    samples_between,
    shown_quantities,
)
from sprung_tools.runs.ride_measures import read_window
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.signals.spans import Span
from sprung_tools.signals.spectra import calc_rms
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

HEADINGS = ("quantity", "run", "least", "at s", "greatest", "at s", "r.m.s.", "unit")


def find_span(results: ResultsFile, arguments: argparse.Namespace) -> Span:
    """The span of time as given, else that of the run's statistics; the whole run in a file of version 1, which does
    not tell it."""
    whole = (float(results.time[0]), float(results.time[-1]))
    start, end = (None, None) if has_resolved_model(results) else whole
    return read_window(
        results, start if arguments.start is None else arguments.start, end if arguments.end is None else arguments.end
    )


def calc_row(run: Run, shown: Shown, window: Span) -> tuple[str, ...]:
    """A row of the table: the statistics of a quantity over its stored rows in a span of time."""
    inside = samples_between(run.results, *window, run.results.every(shown.quantity))
    time = run.results.time[inside]
    values, unit = run.results.series(shown.quantity)
    values = values[inside]
    least, greatest = int(np.argmin(values)), int(np.argmax(values))
    numbers = (values[least], time[least], values[greatest], time[greatest], calc_rms(values))
    formats = ("{:.5g}", "{:.3f}", "{:.5g}", "{:.3f}", "{:.5g}")
    return (shown.label, run.label, *(form.format(number) for form, number in zip(formats, numbers)), unit)


def main() -> int:
    parser = make_parser(
        __doc__,
        "tools/report_peaks rigid=bump_rigid.h5 '2 modes=bump_2modes.h5' \\\n"
        "    --show 'heave=bodies/chassis/displacement.y' --show points/chassis.seat/acceleration.y",
    )
    add_run_arguments(parser)
    arguments = parser.parse_args()
    runs = open_runs(arguments.runs)
    quantities = shown_quantities(arguments.show)
    windows = {run.label: find_span(run.results, arguments) for run in runs}
    rows = [calc_row(run, shown, windows[run.label]) for shown in quantities for run in runs_with(runs, shown)]
    print(f"statistics over: {describe_spans(runs, list(windows.values()))}\n")
    doubts = [*list_doubts(runs), *list_lacking(runs, quantities)]
    if doubts:
        print("\n".join(doubts) + "\n")
    print(format_table(HEADINGS, rows))
    return 0
