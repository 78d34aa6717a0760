"""Claims about modes that are chosen from the forcing, and about modes that join and leave during the run. All runs are
compared with runs of all modes."""

from collections.abc import Callable

import numpy as np

from sprung_tools.paper_report.claims import NAMES, Claim, Finding, Judge, percent
from sprung_tools.paper_report.mode_numbers import Comparison, compare
from sprung_tools.paper_report.mode_runs import ALL, FEW, METHODS, RECALLS, TOLERANCES, name_chosen, name_recall
from sprung_tools.paper_report.paper_runs import ROADS, name_start
from sprung_tools.paper_report.run_numbers import MIDDLE, SEAT, Numbers

RMS_MARGIN, PEAK_MARGIN = 0.01, 0.02
HISTORY_MARGIN = 0.01  # at the tightest threshold
COST = 0.5  # share of the cost of all modes
POINTS = {NAMES[MIDDLE]: MIDDLE, "seat": SEAT}

Row = tuple[str, str, str, tuple[str, ...], Judge]  # run, claim, criterion, needs, judge


def unsigned(share: float, digits: int) -> str:
    """A share without its sign."""
    return f"{100.0 * share:.{digits}f} %"


def within(
    name: str,
    calc: Callable[[Comparison], dict[str, float]],
    margin: float,
    form: Callable[[float, int], str] = percent,
) -> Judge:
    """Judges the relative differences of a run. calc: returns name of the point → share; form: formats a share."""

    def judge(numbers: Numbers) -> Finding:
        shares = calc(compare(numbers, name))
        words = ", ".join(f"{what} {form(share, 2)}".strip() for what, share in shares.items())
        return Finding(words, {what: bool(abs(share) <= margin) for what, share in shares.items()})

    return judge


def calc_deflection(case: Comparison) -> dict[str, float]:
    """The relative difference of the front end's peak deflection."""
    return {"": case.deflection()}


def calc_peaks(case: Comparison) -> dict[str, float]:
    """The relative differences of the peak vertical accelerations."""
    return {what: case.peak(point) for what, point in POINTS.items()}


def calc_horizontal_peaks(case: Comparison) -> dict[str, float]:
    """The relative differences of the peak horizontal accelerations."""
    return {what: case.horizontal_peak(point) for what, point in POINTS.items()}


def calc_rms(case: Comparison) -> dict[str, float]:
    """The relative differences of the r.m.s. accelerations."""
    return {what: case.rms(point) for what, point in POINTS.items()}


def calc_histories(case: Comparison) -> dict[str, float]:
    """The differences of the histories as shares."""
    return dict(zip(POINTS, case.histories()))


def calc_cost(numbers: Numbers, name: str) -> float:
    """The processor time of the program [s]."""
    return numbers.cost(name)


def calc_integration_cost(numbers: Numbers, name: str) -> float:
    """The processor time of the program without that before the first step [s]."""
    return numbers.cost(name) - numbers.cost(name_start(name))


def cheaper(name: str, than: str, most: float, calc: Callable[[Numbers, str], float] = calc_cost) -> Judge:
    """Judges processor times over those of another run, by each method with which both were timed."""

    def judge(numbers: Numbers) -> Finding:
        shares = {
            method: calc(numbers, f"{name}{suffix}") / calc(numbers, f"{than}{suffix}")
            for method, (_, suffix) in METHODS.items()
            if numbers.has_cost(f"{name}{suffix}")
        }
        words = ", ".join(f"{method} {share:.3f} times" for method, share in shares.items())
        return Finding(words, {method: share <= most for method, share in shares.items()})

    return judge


def tightens(numbers: Numbers) -> Finding:
    """Judges whether the histories differ least at the tightest threshold."""
    found = np.array([compare(numbers, name_recall(recall)).histories() for recall in RECALLS])
    words = ", ".join(
        f"{what} {100.0 * first:.1f} % to {100.0 * last:.1f} %"
        for what, first, last in zip(POINTS, found[0], found[-1])
    )
    return Finding(words, {what: bool(column[-1] == column.min()) for what, column in zip(POINTS, found.T)})


def warned(numbers: Numbers) -> Finding:
    """Judges whether the program warned."""
    warnings = numbers.run("bump_2modes").warnings
    return Finding(f"warnings: {len(warnings)}", {"": bool(warnings)})


def list_mode_claims() -> list[Claim]:
    """All claims, in the order of the report."""
    chosen = {road: name_chosen(road, TOLERANCES[0]) for road in ROADS}
    tightest = name_recall(RECALLS[-1])
    rms, peak, history = (f"{100.0 * margin:g} %" for margin in (RMS_MARGIN, PEAK_MARGIN, HISTORY_MARGIN))
    every = tuple(map(name_recall, RECALLS))
    rows: list[Row] = [
        ("terrain, chosen beforehand", "r.m.s. vertical acceleration", f"within {rms}",
         (chosen["terrain"],), within(chosen["terrain"], calc_rms, RMS_MARGIN)),
        ("bump, chosen beforehand", "r.m.s. vertical acceleration", f"within {rms}",
         (chosen["bump"],), within(chosen["bump"], calc_rms, RMS_MARGIN)),
        ("bump, chosen beforehand", "peak vertical acceleration",
         f"within the choice's tolerance, {100.0 * TOLERANCES[0]:g} %",
         (chosen["bump"],), within(chosen["bump"], calc_peaks, TOLERANCES[0])),
        ("bump, adaptive", "front end's peak deflection", f"within {peak}",
         ("bump_adaptive",), within("bump_adaptive", calc_deflection, PEAK_MARGIN)),
        ("bump, adaptive", "peak vertical acceleration", f"within {peak}",
         ("bump_adaptive",), within("bump_adaptive", calc_peaks, PEAK_MARGIN)),
        ("bump, adaptive", "peak horizontal acceleration", f"within {peak}",
         ("bump_adaptive",), within("bump_adaptive", calc_horizontal_peaks, PEAK_MARGIN)),
        ("terrain, adaptive", "r.m.s. vertical acceleration", f"within {rms}",
         ("terrain_adaptive",), within("terrain_adaptive", calc_rms, RMS_MARGIN)),
        ("terrain, adaptive", "peak vertical acceleration", f"within {peak}",
         ("terrain_adaptive",), within("terrain_adaptive", calc_peaks, PEAK_MARGIN)),
        ("terrain, adaptive", "peak horizontal acceleration", f"within {peak}",
         ("terrain_adaptive",), within("terrain_adaptive", calc_horizontal_peaks, PEAK_MARGIN)),
        ("bump, adaptive", "thresholds tightened: histories of the vertical acceleration",
         f"nearest at the tightest, {100.0 * RECALLS[-1]:g} %", every, tightens),
        ("bump, adaptive", f"histories of the vertical acceleration at {100.0 * RECALLS[-1]:g} %",
         f"r.m.s. of the difference within {history}",
         (tightest,), within(tightest, calc_histories, HISTORY_MARGIN, unsigned)),
        ("bump, 2 modes", "the run's summary", "warns", ("bump_2modes",), warned),
    ]  # fmt: skip
    timed: list[Row] = [
        ("bump, adaptive", "processor time of the integration", f"at most {COST:g} times that of fixed {ALL} modes",
         (), cheaper("bump_adaptive", f"bump_{ALL}modes", COST, calc_integration_cost)),
        ("bump, adaptive", "processor time of the program", f"at most {COST:g} times that of fixed {ALL} modes",
         (), cheaper("bump_adaptive", f"bump_{ALL}modes", COST)),
        (f"bump, adaptive, {FEW} available", "processor time", f"less than that of fixed {FEW} modes",
         (), cheaper(f"bump_adaptive_of_{FEW}", f"bump_{FEW}modes", 1.0)),
        ("terrain, chosen beforehand", "processor time, the choice included", f"less than that of fixed {ALL} modes",
         (), cheaper(chosen["terrain"], f"terrain_{ALL}modes", 1.0)),
    ]  # fmt: skip
    full = {road: f"{road}_{ALL}modes" for road in ROADS}
    claims = []
    for number, (run, says, criterion, needs, judge) in enumerate(rows + timed, start=1):
        needs = (*needs, full[run.partition(",")[0]])
        claims.append(Claim(f"{number}", run, says, criterion, needs, judge, timed=number > len(rows)))
    return claims
