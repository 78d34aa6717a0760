"""What is asked of modes that are chosen from the forcing, and join and leave during the run; each with a criterion that a
program can judge, as in claims.py, and what the runs say to it. All are compared with runs of all modes."""

import numpy as np

from sprung_tools.paper_report.claims import NAMES, Claim, Finding, percent
from sprung_tools.paper_report.mode_numbers import compare
from sprung_tools.paper_report.mode_runs import ALL, FEW, METHODS, RECALLS, TOLERANCES, name_chosen, name_recall
from sprung_tools.paper_report.paper_runs import ROADS, name_start
from sprung_tools.paper_report.run_numbers import MIDDLE, SEAT

RMS_MARGIN, PEAK_MARGIN = 0.01, 0.02
HISTORY_MARGIN = 0.01  # at the tightest thresholds
COST = 0.5  # of that of all modes
POINTS = {NAMES[MIDDLE]: MIDDLE, "seat": SEAT}


def unsigned(share, digits):
    return f"{100.0 * share:.{digits}f} %"


def within(name, calc, margin, form=percent):
    """Judges shares by which a run is off. calc: Comparison → dict of what was judged → share; form: how one is written."""

    def judge(numbers):
        shares = calc(compare(numbers, name))
        words = ", ".join(f"{what} {form(share, 2)}".strip() for what, share in shares.items())
        return Finding(words, {what: bool(abs(share) <= margin) for what, share in shares.items()})

    return judge


def calc_deflection(case):
    return {"": case.deflection()}


def calc_peaks(case):
    return {what: case.peak(point) for what, point in POINTS.items()}


def calc_horizontal_peaks(case):
    return {what: case.horizontal_peak(point) for what, point in POINTS.items()}


def calc_rms(case):
    return {what: case.rms(point) for what, point in POINTS.items()}


def calc_histories(case):
    return dict(zip(POINTS, case.histories()))


def calc_cost(numbers, name):
    """Processor time of the program [s]."""
    return numbers.costs[name]


def calc_integration_cost(numbers, name):
    """The same without what goes by before the first step."""
    return numbers.costs[name] - numbers.costs[name_start(name)]


def cheaper(name, than, most, calc=calc_cost):
    """Processor times by each method that was timed over that of another run."""

    def judge(numbers):
        shares = {
            method: calc(numbers, f"{name}{suffix}") / calc(numbers, f"{than}{suffix}")
            for method, (_, suffix) in METHODS.items()
            if f"{name}{suffix}" in numbers.costs
        }
        words = ", ".join(f"{method} {share:.3f} times" for method, share in shares.items())
        return Finding(words, {method: share <= most for method, share in shares.items()})

    return judge


def tightens(numbers):
    """Whether the histories' differences at the tightest thresholds are the least of all."""
    found = np.array([compare(numbers, name_recall(recall)).histories() for recall in RECALLS])
    words = ", ".join(
        f"{what} {100.0 * first:.1f} % to {100.0 * last:.1f} %" for what, first, last in zip(POINTS, found[0], found[-1])
    )
    return Finding(words, {what: bool(column[-1] == column.min()) for what, column in zip(POINTS, found.T)})


def warned(numbers):
    warnings = numbers.run("bump_2modes").warnings
    return Finding(f"warnings: {len(warnings)}", {"": bool(warnings)})


def list_mode_claims():
    """All of them, in the order of the report."""
    chosen = {road: name_chosen(road, TOLERANCES[0]) for road in ROADS}
    tightest = name_recall(RECALLS[-1])
    rms, peak, history = (f"{100.0 * margin:g} %" for margin in (RMS_MARGIN, PEAK_MARGIN, HISTORY_MARGIN))
    every = tuple(map(name_recall, RECALLS))
    rows = [
        ("terrain, chosen beforehand", "r.m.s. vertical acceleration", f"within {rms}",
         (chosen["terrain"],), within(chosen["terrain"], calc_rms, RMS_MARGIN)),
        ("bump, chosen beforehand", "r.m.s. vertical acceleration", f"within {rms}",
         (chosen["bump"],), within(chosen["bump"], calc_rms, RMS_MARGIN)),
        ("bump, chosen beforehand", "peak vertical acceleration", f"within the choice's tolerance, {100.0 * TOLERANCES[0]:g} %",
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
         f"r.m.s. of the difference within {history}", (tightest,), within(tightest, calc_histories, HISTORY_MARGIN, unsigned)),
        ("bump, 2 modes", "the run's summary", "warns", ("bump_2modes",), warned),
    ]  # fmt: skip
    timed = [
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
