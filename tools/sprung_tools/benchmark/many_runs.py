"""Many runs of the truck over its bump, as a study makes them: a process for each, or all in one process."""

import json
import resource
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

RUN = ROOT / "dynamics/models/truck/bump.toml"
WANTED_SHARE = 15.0 / 4.0  # of a run in all to its integration


class ManyRuns(NamedTuple):
    """Processor time of a run [s]: by a process of its own; in a process that has made runs before, None where the
    module is not built; of its integration without outputs and without the indicator of modes left out."""

    by_process: float
    in_process: float | None
    integration: float


def measure_many_runs(program: Path, superelements: Path, repetitions: int, duration: float | None) -> ManyRuns:
    """Measures runs in turns, so that a drift of the machine's speed meets all. Returns medians."""
    end = duration if duration is not None else float(TomlFile(RUN).data["duration"])
    settings = [f"duration={end}"]
    command = make_command(program, "run", RUN, superelements, settings)
    # Outputs at the start and the end only, and no modes left out are followed.
    settings += [f"output_step={end}", "adaptivity.indicator=false"]
    bare = make_command(program, "run", RUN, superelements, settings)
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


def format_many_runs(runs: ManyRuns) -> str:
    """A table of the costs."""
    rows = [("a process for each run", runs.by_process)]
    if runs.in_process is not None:
        rows.append(("all runs in one process", runs.in_process))
    rows.append(("integration alone, without outputs", runs.integration))
    return format_table(
        ("", "CPU time", "runs per second and core", "to the integration", "beside the integration"),
        [
            (name, f"{1e3 * cost:.1f} ms", f"{1.0 / cost:.1f}", f"{cost / runs.integration:.2f}",
             f"{1e3 * (cost - runs.integration):.1f} ms")
            for name, cost in rows
        ],
    )  # fmt: skip


def check_many_runs(runs: ManyRuns) -> list[Target]:
    """The target for many runs."""
    if runs.in_process is None:
        return []
    share = runs.in_process / runs.integration
    return [("bump, runs in one process to their integration", f"≤ {WANTED_SHARE:g}", share, share <= WANTED_SHARE)]
