"""Prints the extremes and the r.m.s. of quantities of one or more runs, as a table."""

import numpy as np

from sprung_tools.cli.arguments import add_run_arguments
from sprung_tools.runs.labelled_runs import (
    Run,
    Shown,
    list_lacking,
    open_runs,
    runs_with,
    samples_between,
    shown_quantities,
)
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.signals.spectra import calc_rms
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

HEADINGS = ("quantity", "run", "least", "at s", "greatest", "at s", "r.m.s.", "unit")


def calc_row(run: Run, shown: Shown, start: float | None, end: float | None) -> tuple[str, ...]:
    """A row of the table: the statistics of a quantity over its stored rows from start to end [s]."""
    inside = samples_between(run.results, start, end, run.results.every(shown.quantity))
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
    rows = [
        calc_row(run, shown, arguments.start, arguments.end)
        for shown in quantities
        for run in runs_with(runs, shown)
    ]
    doubts = [*list_doubts(runs), *list_lacking(runs, quantities)]
    if doubts:
        print("\n".join(doubts) + "\n")
    print(format_table(HEADINGS, rows))
    return 0
