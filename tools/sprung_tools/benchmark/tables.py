"""Tables of the cost of evaluations and runs."""

from collections.abc import Sequence
from typing import Any

from sprung_tools.benchmark.programs import Times
from sprung_tools.benchmark.whole_runs import BASELINE, Rungs
from sprung_tools.terminal.text_table import Rows, format_table


def evaluation_rows(times: Times) -> Rows:
    """The rows of format_evaluations()."""
    modes = sorted({modes for _, modes in times})
    return [
        (
            str(count),
            f"{1e6 * times['fast', count]:.2f}",
            f"{1e6 * times['dense', count]:.2f}",
            f"{times['dense', count] / times['fast', count]:.2f}",
            f"{times['fast', count] / times['fast', modes[0]]:.2f}",
        )
        for count in modes
    ]


def format_evaluations(times: Times) -> str:
    """Formats the times of one evaluation of the equations of motion."""
    headings = ("modes", "fast µs", "dense µs", "dense/fast", "fast/rigid fast")
    return format_table(headings, evaluation_rows(times))


def fastest_rigid(results: Rungs, run: str) -> float | None:
    """The shortest time of a rigid run that is good enough; None if there is none."""
    times = [
        rung.seconds
        for (name, modes, method), rung in results.items()
        if rung and name == run and modes == 0 and method != BASELINE
    ]
    return min(times, default=None)


def ratio(value: float | None, to: float | None, digits: int = 2) -> str:
    """A ratio as text; empty if a value is missing."""
    return f"{value / to:.{digits}f}" if value is not None and to else ""


def format_runs(results: Rungs, firsts: Rungs, durations: dict[str, float]) -> str:
    """Formats the rungs that are good enough. The arguments are those of Measurements."""
    rows: list[tuple[str, ...]] = []
    for (run, modes, method), rung in results.items():
        if rung is None:
            rows.append((run, str(modes), method, *["–"] * 8))
            continue
        baseline, first_baseline = results.get((run, modes, BASELINE)), firsts.get((run, modes, BASELINE))
        first = firsts[run, modes, method]
        rows.append(
            (
                run,
                str(modes),
                method,
                f"{rung.tolerance:g}",
                str(rung.evaluations),
                str(rung.steps),
                f"{1e3 * rung.seconds:.2f}",
                f"{durations[run] / rung.seconds:.0f}",
                ratio(rung.seconds, fastest_rigid(results, run)),
                ratio(baseline.seconds if baseline else None, rung.seconds, 1),
                ratio(first_baseline.seconds if first_baseline else None, first.seconds if first else None, 1),
            )
        )
    headings = (
        "run", "modes", "method", "tolerance", "evaluations", "steps", "CPU ms", "times real time",
        "to fastest rigid", "baseline/this", "at first good tolerances",
    )  # fmt: skip
    return format_table(headings, rows)


def format_growth(lines: Sequence[dict[str, Any]]) -> str:
    """Formats the lines of measure_growth()."""
    rows = []
    before: dict[str, dict[str, Any]] = {}
    for line in lines:
        last = before.get(line["chain"])
        rows.append(
            (
                line["chain"],
                str(line["bodies"]),
                str(line["factor_entries"]),
                f"{1e6 * line['seconds_per_evaluation']:.2f}",
                f"{line['evaluations_per_step']:.2f}",
                f"{1e6 * line['seconds_per_step']:.2f}",
                ratio(line["seconds_per_step"], last["seconds_per_step"] if last else None, 1),
                f"{1e3 * line['seconds_to_start']:.2f}",
            )
        )
        before[line["chain"]] = line
    headings = (
        "chain", "bodies", "factor entries", "evaluation µs", "evaluations a step", "step µs", "step to above",
        "start ms",
    )  # fmt: skip
    return format_table(headings, rows)
