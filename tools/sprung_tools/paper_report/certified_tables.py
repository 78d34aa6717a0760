"""The report's tables on the certified chassis: which of the paper's conclusions depend on its basis, and whether
choosing and changing vectors still save anything."""

from collections.abc import Callable
from typing import NamedTuple

from sprung_tools.paper_report.certified_runs import FREE_RATIO, METHODS, MODELS, TRUTH
from sprung_tools.paper_report.claims import (
    Judge,
    alike,
    decay,
    deflection_frequency,
    deflection_ratio,
    differing_peaks,
    format_holds,
    percent,
    raised_high_frequencies,
    raised_human_band,
    raised_peak,
    raised_rms,
)
from sprung_tools.paper_report.mode_numbers import Comparison
from sprung_tools.paper_report.mode_tables import COST_HEADINGS
from sprung_tools.paper_report.paper_runs import ROADS
from sprung_tools.paper_report.run_numbers import MIDDLE, SEAT, Numbers
from sprung_tools.terminal.text_table import Table

NAMES = {
    "free_all": "all 36 free modes",
    "free_12": "12 free modes",
    "free_auto": "free modes chosen beforehand",
    "free_adaptive": "free modes, adaptive from 2",
    "certified": "certified, all 15 vectors",
    "certified_auto": "certified, chosen beforehand",
    "certified_adaptive": "certified, adaptive from 2",
}


class BasisClaim(NamedTuple):
    """A claim of the paper about the flexible chassis. judge: of a chassis by its name in the runs; models: those of
    the paper's sets of modes for which there are such runs."""

    number: str
    says: str
    judge: Callable[[str], Judge]
    models: tuple[str, ...] = ("2modes", "4modes")


def list_basis_claims() -> list[BasisClaim]:
    """The paper's claims about the flexible chassis, by the numbers of paper_claims.list_claims()."""
    return [
        BasisClaim("4", "bump: the rigid chassis' peak displacement differs significantly",
                   lambda m: differing_peaks("bump_rigid", f"bump_{m}", True)),
        BasisClaim("5", "bump: modes above the second are negligible for displacement",
                   lambda m: differing_peaks("bump_2modes", f"bump_{m}", False), ("4modes",)),
        BasisClaim("6, 7", "bump: flexibility raises the peak acceleration", lambda m: raised_peak(f"bump_{m}")),
        BasisClaim("8, 9", "bump: significantly higher frequency content",
                   lambda m: raised_high_frequencies("bump", m)),
        BasisClaim("10", "bump: without modal damping the oscillation is sustained",
                   lambda m: decay(f"bump_{m}_undamped", True), ("2modes",)),
        BasisClaim("11", "bump: with 1 % of modal damping it decays", lambda m: decay(f"bump_{m}", False)),
        BasisClaim("12", "terrain: displacement of the rigid and the flexible chassis alike",
                   lambda m: alike("terrain_rigid", f"terrain_{m}", "displacement")),
        BasisClaim("13", "terrain: displacement with 2 and with more modes alike",
                   lambda m: alike("terrain_2modes", f"terrain_{m}", "displacement"), ("4modes",)),
        BasisClaim("14", "terrain: flexible long arms without effect on displacement",
                   lambda m: alike(f"terrain_{m}", f"terrain_{m}_links", "displacement"), ("2modes",)),
        BasisClaim("15, 16", "terrain: flexibility raises the acceleration significantly",
                   lambda m: raised_rms(f"terrain_{m}")),
        BasisClaim("17", "terrain: more vibration from 4 to 8 Hz", lambda m: raised_human_band(f"terrain_{m}")),
        BasisClaim("18", "terrain: high frequency content", lambda m: raised_high_frequencies("terrain", m)),
        BasisClaim("19", "terrain: flexible long arms without effect on the acceleration",
                   lambda m: alike(f"terrain_{m}", f"terrain_{m}_links", "acceleration"), ("2modes",)),
        BasisClaim("21, 22", "terrain: front end's peak 22 times its static deflection",
                   lambda m: deflection_ratio(f"terrain_{m}")),
        BasisClaim("21, 22 damped", f"the same, certified with {100.0 * FREE_RATIO:g} % of modal damping",
                   lambda m: deflection_ratio("terrain_certified_damped" if m == "certified" else f"terrain_{m}")),
        BasisClaim("24, 25", "terrain: front end vibrates at about 6 Hz",
                   lambda m: deflection_frequency(f"terrain_{m}")),
    ]  # fmt: skip


def make_basis_claims_table(numbers: Numbers) -> Table:
    """The paper's claims with the certified chassis, beside the verdicts with 2 and 4 clamped modes."""
    rows = []
    for claim in list_basis_claims():
        finding = claim.judge("certified")(numbers)
        verdicts = {model: claim.judge(model)(numbers).holds for model in claim.models}
        cells = [format_holds(verdicts[model]) if model in verdicts else "–" for model in ("2modes", "4modes")]
        depends = any(holds != finding.holds for holds in verdicts.values())
        verdict = format_holds(finding.holds)
        rows.append((claim.number, claim.says, *cells, finding.found, verdict, "yes" if depends else "no"))
    headings = ("", "paper says", "2 modes", "4 modes", "certified: we find", "certified", "depends on the basis")
    return headings, rows


def make_basis_accuracy_table(numbers: Numbers) -> Table:
    """Fixed, chosen and changing vectors of the certified chassis and free modes, against all free modes."""
    rows = []
    for road in ROADS:
        for model in MODELS:
            case = compare_with_truth(numbers, road, model)
            effort = [f"{case.run.evaluations}", f"{case.effort():.2f}"]
            adams = compare_with_truth(numbers, road, model, "_adams") if road == "bump" else None
            rows.append(
                (
                    f"{road}: {NAMES[model]}",
                    f"{case.active.mean():.1f}",
                    *(percent(case.rms(point), 2) for point in (MIDDLE, SEAT)),
                    *(percent(case.peak(point), 2) for point in (MIDDLE, SEAT)),
                    ", ".join(f"{100.0 * share:.1f} %" for share in case.histories()),
                    *effort,
                    f"{adams.effort():.2f}" if adams else "–",
                )
            )
    headings = (
        "", "modes active: mean", "r.m.s. middle off by", "r.m.s. seat off by", "peak middle off by",
        "peak seat off by", "histories off by: middle, seat", "evaluations", "evaluations over all modes",
        "evaluations by Adams over all modes",
    )  # fmt: skip
    return headings, rows


def compare_with_truth(numbers: Numbers, road: str, model: str, suffix: str = "") -> Comparison:
    """Compares a run with that of all free modes by the same method."""
    return Comparison(numbers.run(f"{road}_{model}{suffix}"), numbers.run(f"{road}_{TRUTH}{suffix}"))


def make_basis_cost_table(numbers: Numbers) -> Table:
    """Processor times of these runs; no rows if nothing was timed."""
    rows = []
    for road in ROADS if numbers.costs is not None else ():
        for model in MODELS:
            cells = []
            for _, suffix in METHODS.values():
                if suffix and road != "bump":
                    cells += ["–", "–"]
                    continue
                time, full = (numbers.cost(f"{road}_{one}{suffix}") for one in (model, TRUTH))
                cells += [f"{time:.2f}", f"{time / full:.2f}"]
            rows.append((f"{road}: {NAMES[model]}", *cells))
    return ("", *COST_HEADINGS), rows


def list_certified_tables() -> dict[str, Callable[[Numbers], Table]]:
    """All tables of this section: name of the marker → function that makes the table."""
    return {
        "certified claims": make_basis_claims_table,
        "certified accuracy": make_basis_accuracy_table,
        "certified cost": make_basis_cost_table,
    }
