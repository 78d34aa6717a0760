"""The report's tables on modes that are chosen from the forcing, or join and leave during the run.

Like those of tables.py they leave out the rows of runs that were not made.
"""

from collections.abc import Callable

from sprung_tools.paper_report.claims import percent
from sprung_tools.paper_report.mode_numbers import Choice, Comparison, can_compare, compare
from sprung_tools.paper_report.mode_runs import (
    ALL,
    DROP_OF_RECALL,
    FEW,
    FIXED_COUNTS,
    METHODS,
    RECALLS,
    TOLERANCES,
    name_chosen,
    name_recall,
    name_watched,
)
from sprung_tools.paper_report.paper_runs import ROADS, name_modes
from sprung_tools.paper_report.run_numbers import LEFT_OUT, MIDDLE, SEAT, TOGETHER, Numbers
from sprung_tools.terminal.number_ranges import format_ranges
from sprung_tools.terminal.text_table import Table

FROM_FEW = f"from 2, {ALL} available"
ACTIVITY = ("modes active: mean, most", "instants of change", "evaluations", "evaluations over all modes")
COST_HEADINGS = tuple(f"{method} {what}" for method in METHODS for what in ("s", "over all modes"))


def name_set(count: int) -> str:
    return f"all {count} modes" if count == ALL else f"{count} modes"


def list_adaptive_cases(suffix: str = "") -> dict[str, str]:
    """The fixed sets and the adaptive runs over the bump: name of the row → name of the run."""
    fixed = {f"fixed, {name_set(n)}": f"bump_{name_modes(n)}{suffix}" for n in FIXED_COUNTS}
    adaptive = {FROM_FEW: f"bump_adaptive{suffix}", f"from 2, {FEW} available": f"bump_adaptive_of_{FEW}{suffix}"}
    return fixed | adaptive


def format_histories(case: Comparison, digits: int = 0) -> str:
    """The differences of the acceleration's histories, of middle and seat."""
    return ", ".join(f"{100.0 * share:.{digits}f} %" for share in case.histories())


def format_activity(case: Comparison) -> tuple[str, ...]:
    """The cells under ACTIVITY."""
    return (
        f"{case.active.mean():.1f}, {case.active.max()}",
        f"{case.changes()}",
        f"{case.run.evaluations}",
        f"{case.effort():.2f}",
    )


def make_choice_table(numbers: Numbers) -> Table:
    """Modes chosen before the run: which, the predicted error, and the error."""
    rows = []
    for road in reversed(ROADS):
        for tolerance in TOLERANCES:
            name = name_chosen(road, tolerance)
            if not can_compare(numbers, name):
                continue
            case, choice = compare(numbers, name), Choice(numbers.run(name))
            rms = [
                f"{case.run.rms_acceleration(p):.3f}, {case.full.rms_acceleration(p):.3f}, {percent(case.rms(p), 2)}"
                for p in (MIDDLE, SEAT)
            ]
            rows.append(
                (
                    f"{road}, {100.0 * tolerance:g} %",
                    f"{len(choice.kept)}: {format_ranges(choice.kept)}",
                    f"{100.0 * choice.neglected:.2f} % of the {choice.neglected_of}"
                    if choice.neglected_of
                    else "nothing",
                    *rms,
                    ", ".join(percent(case.peak(point)) for point in (MIDDLE, SEAT)),
                    format_histories(case),
                    f"{case.run.evaluations}",
                    f"{case.effort():.2f}",
                )
            )
    headings = (
        "road, tolerance", "modes kept", "left out, predicted", "r.m.s. middle m/s²: chosen, all, off by",
        "r.m.s. seat m/s²: chosen, all, off by", "peak acceleration off by: middle, seat",
        "histories off by: middle, seat", "evaluations", "evaluations over all modes",
    )  # fmt: skip
    return headings, rows


def make_adaptive_table(numbers: Numbers) -> Table:
    """Over the bump: adaptive runs compared with fixed sets, by each method."""
    rows = []
    for method, (_, suffix) in METHODS.items():
        for model, name in list_adaptive_cases(suffix).items():
            if not can_compare(numbers, name, suffix):
                continue
            case = compare(numbers, name, suffix)
            rows.append(
                (
                    f"{method}: {model}",
                    f"{1e3 * case.run.peak_deflection():.2f}, {percent(case.deflection())}",
                    *(f"{case.run.peak_acceleration(p):.1f}, {percent(case.peak(p))}" for p in (MIDDLE, SEAT)),
                    format_histories(case),
                    *format_activity(case),
                    f"{case.run.closure:.0e}",
                )
            )
    headings = (
        "bump", "front end's peak mm, off by", "middle's peak m/s², off by", "seat's peak m/s², off by",
        "histories off by: middle, seat", *ACTIVITY, "energy closure",
    )  # fmt: skip
    return headings, rows


def make_recall_table(numbers: Numbers) -> Table:
    """Over the bump: adaptive runs with tighter and tighter thresholds."""
    rows = []
    for recall in RECALLS:
        name = name_recall(recall)
        if not can_compare(numbers, name):
            continue
        case = compare(numbers, name)
        rows.append(
            (
                f"{100.0 * recall:g} %, {100.0 * DROP_OF_RECALL * recall:g} %",
                percent(case.deflection(), 2),
                *(percent(case.peak(point), 2) for point in (MIDDLE, SEAT)),
                format_histories(case, 1),
                *format_activity(case),
            )
        )
    headings = (
        "recall, drop", "front end's peak off by", "middle's peak off by", "seat's peak off by",
        "histories off by: middle, seat", *ACTIVITY,
    )  # fmt: skip
    return headings, rows


def make_terrain_table(numbers: Numbers) -> Table:
    """Over terrain: fixed sets, modes chosen beforehand, modes that change."""
    models = {f"fixed, {name_set(n)}": f"terrain_{name_modes(n)}" for n in FIXED_COUNTS} | {
        "chosen beforehand": name_chosen("terrain", TOLERANCES[0]),
        FROM_FEW: "terrain_adaptive",
    }
    rows = []
    for model, name in models.items():
        if not can_compare(numbers, name):
            continue
        case = compare(numbers, name)
        rows.append(
            (
                model,
                *(f"{case.run.rms_acceleration(p):.3f}, {percent(case.rms(p))}" for p in (MIDDLE, SEAT)),
                *(f"{case.run.peak_acceleration(p):.1f}, {percent(case.peak(p))}" for p in (MIDDLE, SEAT)),
                format_histories(case),
                *format_activity(case),
            )
        )
    headings = (
        "terrain", "r.m.s. middle m/s², off by", "r.m.s. seat m/s², off by", "middle's peak m/s², off by",
        "seat's peak m/s², off by", "histories off by: middle, seat", *ACTIVITY,
    )  # fmt: skip
    return headings, rows


def make_neglect_table(numbers: Numbers) -> Table:
    """The effect of modes left out that the program reported for fixed sets, and their actual errors."""
    rows = []
    for road in ROADS:
        for count in FIXED_COUNTS:
            name = f"{road}_{name_modes(count)}"
            if not can_compare(numbers, name):
                continue
            case = compare(numbers, name)
            rows.append(
                (
                    f"{road}, {name_set(count)}",
                    case.run.read_summary(LEFT_OUT) or "–",
                    case.run.read_summary(TOGETHER) or "–",
                    format_histories(case),
                    *(f"{100.0 * share:.1f} %" for share in case.largest_differences()),
                    "yes" if case.run.warnings else "no",
                )
            )
    headings = (
        "", "told: the mode that misses most", "told: all together", "missed: histories of middle, seat",
        "missed: front end's deflection",
        "missed: middle's acceleration", "missed: seat's acceleration", "warns",
    )  # fmt: skip
    return headings, rows


def make_mode_cost_table(numbers: Numbers) -> Table:
    """Processor times, also over those of all modes by the same method; no rows if nothing was timed."""
    if numbers.costs is None:
        return ("", *COST_HEADINGS), []
    rows = []
    cases = list_adaptive_cases()
    cases[f"fixed, all {ALL} modes, with the indicator"] = name_watched(f"bump_{ALL}modes")
    cases["chosen beforehand"] = name_chosen("bump", TOLERANCES[0])
    for model, name in cases.items():
        cells: list[str] = []
        for _, suffix in METHODS.values():
            stem, watched, _ = name.partition("_watched")
            timed = f"{stem}{suffix}{watched}"
            if not numbers.has_cost(timed):
                cells += ["–", "–"]
                continue
            time, full = numbers.cost(timed), numbers.cost(f"bump_{ALL}modes{suffix}")
            cells += [f"{time:.2f}", f"{time / full:.2f}"]
        rows.append((f"bump: {model}", *cells))
    full = numbers.cost(f"terrain_{ALL}modes")
    for model, name in {
        f"fixed, all {ALL} modes": f"terrain_{ALL}modes",
        f"fixed, all {ALL} modes, with the indicator": name_watched(f"terrain_{ALL}modes"),
        "chosen beforehand": name_chosen("terrain", TOLERANCES[0]),
        FROM_FEW: "terrain_adaptive",
    }.items():
        time = numbers.cost(name)
        rows.append((f"terrain: {model}", f"{time:.2f}", f"{time / full:.2f}", "–", "–"))
    return ("", *COST_HEADINGS), rows


def list_mode_tables() -> dict[str, Callable[[Numbers], Table]]:
    """All tables of this section: name of the marker → function that makes the table."""
    return {
        "mode choice": make_choice_table,
        "adaptive bump": make_adaptive_table,
        "recall": make_recall_table,
        "adaptive terrain": make_terrain_table,
        "neglected": make_neglect_table,
        "mode cost": make_mode_cost_table,
    }
