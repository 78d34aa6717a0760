"""Runs of the truck as a study makes them: a process for each, or all in one process."""

import json
import resource
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sprung_tools.benchmark.targets import Target
from sprung_tools.files.errors import InputError
from sprung_tools.files.project import ROOT
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.programs.calls import Outcome, call, make_command
from sprung_tools.programs.in_process import call_here, load_module
from sprung_tools.terminal.text_table import format_table

WANTED_SHARE = 15.0 / 4.0  # of a run of the bump in all to its integration


class Kind(NamedTuple):
    """What is run: a file, with the outputs that it asks for, and whether they are stored in a results file."""

    run: Path
    is_stored: bool = False


KINDS = {
    "bump": Kind(ROOT / "dynamics/models/truck/bump.toml"),
    "bump, stored": Kind(ROOT / "dynamics/models/truck/bump.toml", is_stored=True),
    "terrain": Kind(ROOT / "dynamics/models/truck/terrain.toml"),
}


class ManyRuns(NamedTuple):
    """Processor time of a run [s]: by a process of its own; in a process that has made runs before, None where the
    module is not built; of its integration without outputs and without the indicator of modes left out."""

    by_process: float
    in_process: float | None
    integration: float


def measure_many_runs(
    program: Path, superelements: Path, repetitions: int, duration: float | None
) -> dict[str, ManyRuns]:
    """Measures runs of all kinds."""
    with tempfile.TemporaryDirectory() as folder:
        results = Path(folder) / "results.h5"
        return {
            name: measure_kind(program, superelements, kind, results, repetitions, duration)
            for name, kind in KINDS.items()
        }


def measure_kind(
    program: Path, superelements: Path, kind: Kind, results: Path, repetitions: int, duration: float | None
) -> ManyRuns:
    """Measures runs in turns, so that a drift of the machine's speed meets all. Returns medians."""
    end = duration if duration is not None else float(TomlFile(kind.run).data["duration"])
    # Of a shortened run the statistics end with it.
    settings = [f"duration={end}", *([f"statistics.to={end}"] if duration is not None else [])]
    command = make_command(program, "run", kind.run, superelements, settings, results if kind.is_stored else None)
    # Outputs at the start and the end only, which the statistics must hold, and no modes left out are followed.
    bare = make_command(
        program, "run", kind.run, superelements,
        [*settings, f"output_step={end}", "statistics.from=0", f"statistics.to={end}", "adaptivity.indicator=false"],
    )  # fmt: skip
    has_module = load_module(program).call is not None
    if has_module:
        check(call_here(command))  # fills the caches
    processes, here, integrations = [], [], []
    for _ in range(repetitions):
        processes.append(measure(lambda: call(command), resource.RUSAGE_CHILDREN))
        if has_module:
            here.append(measure(lambda: call_here(command), resource.RUSAGE_SELF))
        integrations.append(json.loads(check(call_here(bare)).printed)["integration_cpu_time"])
    return ManyRuns(float(np.median(processes)), float(np.median(here)) if here else None,
                    float(np.median(integrations)))  # fmt: skip


def measure(run: Callable[[], Outcome], who: int) -> float:
    """The processor time that a run takes, and the reading of its JSON [s]."""
    before, began = resource.getrusage(who), time.process_time()
    json.loads(check(run()).printed)
    after = resource.getrusage(who)
    if who == resource.RUSAGE_SELF:
        return time.process_time() - began
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def check(outcome: Outcome) -> Outcome:
    """An outcome that is good. InputError for another."""
    if outcome.exit_code != 0:
        raise InputError(outcome.error)
    return outcome


def format_many_runs(kinds: dict[str, ManyRuns]) -> str:
    """A table of the costs."""
    rows = []
    for kind, runs in kinds.items():
        costs = {"a process for each run": runs.by_process, "all runs in one process": runs.in_process,
                 "integration alone, without outputs": runs.integration}  # fmt: skip
        rows += [
            (kind, name, f"{1e3 * cost:.1f} ms", f"{1.0 / cost:.1f}", f"{cost / runs.integration:.2f}",
             f"{1e3 * (cost - runs.integration):.1f} ms")
            for name, cost in costs.items()
            if cost is not None
        ]  # fmt: skip
    headings = ("run", "", "CPU time", "runs per second and core", "to the integration", "beside the integration")
    return format_table(headings, rows)


def check_many_runs(kinds: dict[str, ManyRuns]) -> list[Target]:
    """The target for many runs."""
    runs = kinds["bump"]
    if runs.in_process is None:
        return []
    share = runs.in_process / runs.integration
    return [("bump, runs in one process to their integration", f"≤ {WANTED_SHARE:g}", share, share <= WANTED_SHARE)]
