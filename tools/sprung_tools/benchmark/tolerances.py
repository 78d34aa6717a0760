"""What the tolerance of a run means: errors over the tolerance, by the number of modes."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sprung_tools.benchmark.programs import run_program
from sprung_tools.benchmark.whole_runs import REFERENCE_METHOD, Series, read_series
from sprung_tools.files.project import ROOT
from sprung_tools.terminal.progress_bar import Progress
from sprung_tools.terminal.text_table import format_table

TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
REFERENCE_TOLERANCE = 1e-11
MODES = (0, 2, 4, 36)


class ToleranceCost(NamedTuple):
    """A run at a tolerance: the largest error of the chassis height [m], the r.m.s. error of its acceleration over the
    r.m.s. of that, evaluations and processor time [s]."""

    height: float
    acceleration: float
    evaluations: int
    seconds: float


Accuracies = dict[tuple[str, float, int], ToleranceCost]  # run, tolerance, modes


def compare_series(series: Series, reference: Series) -> tuple[float, float]:
    """The errors of height and acceleration, as in ToleranceCost."""
    off = series.acceleration - reference.acceleration
    return (
        float(np.max(np.abs(series.height - reference.height))),
        float(np.sqrt(np.mean(off**2) / np.mean(reference.acceleration**2))),
    )


def measure_tolerances(
    program: Path, superelements: Path, folder: Path, runs: Sequence[str], modes: Sequence[int],
    tolerances: Sequence[float], duration: float | None,
) -> Accuracies:  # fmt: skip
    """Runs the truck by the default method with each number of modes at each tolerance, and at a tolerance that is much
    smaller. folder: for the files that run_benchmark (program) writes."""
    found: Accuracies = {}
    path = folder / "series.bin"
    with Progress("tolerances", len(runs) * len(modes)) as progress:
        for run in runs:
            for count in modes:
                command: list[str | Path | float] = [
                    program, ROOT / f"dynamics/models/truck/{run}.toml", superelements, "--modes", count,
                    "--method", REFERENCE_METHOD, "--series", path,
                ]  # fmt: skip
                if duration is not None:
                    command += ["--duration", duration]
                text = run_program([*command, "--tolerance", REFERENCE_TOLERANCE, *tolerances])
                samples = np.array(read_series(path)).T.reshape(1 + len(tolerances), -1, 4)
                reference, *others = (Series(*one.T) for one in samples)
                costs = [json.loads(line) for line in text.splitlines()][1:]
                for tolerance, series, cost in zip(tolerances, others, costs):
                    found[run, tolerance, count] = ToleranceCost(
                        *compare_series(series, reference), cost["evaluations"], float(np.median(cost["seconds"]))
                    )
                progress.step()
    return found


def format_tolerances(found: Accuracies) -> str:
    """Formats a table of the errors over the tolerance and of the cost, a row for each run and tolerance."""
    modes = list(dict.fromkeys(count for *_, count in found))
    headings = [
        "run", "tolerance", *(f"height {count}" for count in modes), *(f"acc. {count}" for count in modes),
        *(f"evals {count}" for count in modes), *(f"ms {count}" for count in modes),
    ]  # fmt: skip
    rows = []
    for run, tolerance in dict.fromkeys((run, tolerance) for run, tolerance, _ in found):
        costs = [found[run, tolerance, count] for count in modes]
        rows.append(
            [run, f"{tolerance:g}", *(f"{one.height / tolerance:.3g}" for one in costs),
             *(f"{one.acceleration / tolerance:.3g}" for one in costs), *(str(one.evaluations) for one in costs),
             *(f"{1e3 * one.seconds:.0f}" for one in costs)]
        )  # fmt: skip
    return format_table(headings, rows)
