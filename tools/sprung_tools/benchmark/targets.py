"""The project's targets for the cost of evaluations and runs, and whether the measurements meet them."""

from collections.abc import Sequence
from typing import Any

from sprung_tools.benchmark.programs import Times
from sprung_tools.benchmark.whole_runs import BASELINE, Rung, Rungs
from sprung_tools.terminal.text_table import format_table

Target = tuple[str, str, float, bool]  # what, wanted, measured, met

WANTED_EVALUATION, WANTED_BASELINE, WANTED_REAL_TIME, WANTED_EVALUATIONS = 8.0, 15.0, 150.0, 4000
WANTED_RIGID_SHARE = {2: 1.5, 4: 2.2}  # modes → time over that of the rigid run
WANTED_EVALUATION_SHARE = {2: 1.25, 4: 1.5}  # modes → time of an evaluation over that of the rigid model
WANTED_GROWTH = 13.0  # for ten times the bodies


def best(results: Rungs, run: str, modes: int) -> Rung | None:
    """The fastest rung of all integrators; None if none is good enough."""
    found: list[Rung] = [
        rung
        for (name, count, method), rung in results.items()
        if rung is not None and name == run and count == modes and method != BASELINE
    ]
    return min(found, key=lambda rung: rung.seconds) if found else None


def check_targets(
    times: Times, results: Rungs, firsts: Rungs, durations: dict[str, float], growth: Sequence[dict[str, Any]]
) -> list[Target]:
    """Checks all targets for which there are measurements."""
    targets: list[Target] = []

    def at_least(what: str, wanted: float, value: float) -> None:
        targets.append((what, f"≥ {wanted:g}", value, value >= wanted))

    def at_most(what: str, wanted: float, value: float) -> None:
        targets.append((what, f"≤ {wanted:g}", value, value <= wanted))

    for modes in (0, 2, 4):
        if ("dense", modes) in times:
            at_least(f"evaluation, {modes} modes: dense/fast", WANTED_EVALUATION,
                     times["dense", modes] / times["fast", modes])  # fmt: skip
    for modes, wanted in WANTED_EVALUATION_SHARE.items():
        if ("fast", modes) in times:
            at_most(f"evaluation, {modes} modes to rigid", wanted, times["fast", modes] / times["fast", 0])
    for run, duration in durations.items():
        rigid = best(results, run, 0)
        if run == "bump" and rigid:
            at_most("bump, rigid: evaluations", WANTED_EVALUATIONS, rigid.evaluations)
        for modes, wanted in WANTED_RIGID_SHARE.items():
            rung = best(results, run, modes)
            if rung and rigid:
                at_most(f"{run}, {modes} modes to fastest rigid", wanted, rung.seconds / rigid.seconds)
        rung = best(results, run, 2)
        if run == "terrain" and rung:
            at_least("terrain, 2 modes: times real time", WANTED_REAL_TIME, duration / rung.seconds)
        for modes in (0, 2, 4):
            for rungs, how in ((results, ""), (firsts, ", first good tolerances")):
                rung, baseline = best(rungs, run, modes), rungs.get((run, modes, BASELINE))
                if rung and baseline:
                    at_least(f"{run}, {modes} modes: baseline/fastest{how}", WANTED_BASELINE,
                             baseline.seconds / rung.seconds)  # fmt: skip
    for last, line in zip(growth, growth[1:]):
        if last["chain"] == line["chain"] and line["bodies"] == 10 * last["bodies"]:
            at_most(f"{line['chain']} chain, {last['bodies']} to {line['bodies']} bodies: step", WANTED_GROWTH,
                    line["seconds_per_step"] / last["seconds_per_step"])  # fmt: skip
    return targets


def format_targets(targets: Sequence[Target]) -> str:
    """Formats the targets of check_targets()."""
    rows = [(what, wanted, f"{value:.4g}", "yes" if met else "no") for what, wanted, value, met in targets]
    return format_table(("target", "wanted", "measured", "met"), rows)
