"""Claims about the runs: how each is judged, and what the runs show.

The thresholds are a few round numbers, the same for all claims. They were set before the table was first computed and
never adapted to it: a "no" is as good a result as a "yes". On a page's width, two curves that differ by 5 % can just be
distinguished.

The paper's "centre of mass of the chassis" can mean two points; claims about it are judged at both (run_numbers.py).
"""

from collections.abc import Sequence
from typing import Callable, NamedTuple

import numpy as np

from sprung_tools.paper_report.run_numbers import CENTRE, MIDDLE, Numbers, RunNumbers, relative
from sprung_tools.signals.spectra import calc_rms

SIGNIFICANT = 0.05  # a visible difference; a smaller one is "no significant difference"
MARKED = 0.20  # a rise that the paper calls marked or significant
EARLY, LATE = (2.0, 3.0), (4.0, 5.0)  # s, over the bump: when both axles are past it, and the end of the run
SUSTAINED = 0.5  # late over early r.m.s. from which an oscillation counts as sustained
HUMAN = 1  # the place in run_numbers.BANDS of 4 to 8 Hz, where people are most sensitive
HIGH_FROM = 2  # the first band of "high frequency": 8 Hz and above, all vibration but bounce and pitch
PRINTED_CHASSIS = (6.11, 6.11, 38.31, 38.31, 83.36, 83.36)  # Hz
PRINTED_LINK = (88.92, 88.92)  # Hz
PRINTED_RIGID = {"bounce": 1.98, "pitch": 1.95}  # Hz
RIGID_MARGIN = 0.01  # Hz
PRINTED_RATIO, RATIO_MARGIN = 22.0, 0.10
PRINTED_BENDING, BENDING_MARGIN = 6.0, 0.5  # Hz
PRINTED_COSTS = {2: 2.08, 4: 5.18}
COST_MARGIN = 0.20
NAMES = {MIDDLE: "middle", CENTRE: "centre of mass"}


class Finding(NamedTuple):
    """What the runs show, in words, and for each point or case that is judged whether the claim holds."""

    found: str
    holds: dict[str, bool]  # name of the point or case → bool; the name is "" if there is only one


Judge = Callable[[Numbers], Finding]
PointJudge = Callable[[Numbers, str], tuple[str, bool]]  # the runs' numbers, a point → words, whether the claim holds


class Claim(NamedTuple):
    """A claim: one row of the table."""

    number: str
    source: str
    says: str
    criterion: str
    needs: tuple[str, ...]  # the runs without which it cannot be judged
    judge: Judge
    timed: bool = False


def format_holds(holds: dict[str, bool]) -> str:
    """`yes`, `no`, or the verdict on each point or case if they differ."""
    words = {name: "yes" if value else "no" for name, value in holds.items()}
    if len(set(words.values())) == 1:
        return next(iter(words.values()))
    return ", ".join(f"{name}: {word}" for name, word in words.items())


def percent(share: float, digits: int = 1) -> str:
    """A share with its sign, `+1.5 %`; a share that rounds to 0 has no sign."""
    text = f"{100.0 * share:+.{digits}f}"
    return f"{text if float(text) else text[1:]} %"


def at_both_points(judge_point: PointJudge) -> Judge:
    """Judges a claim at the middle and at the centre of mass."""

    def judge(numbers: Numbers) -> Finding:
        found, holds = [], {}
        for point, name in NAMES.items():
            words, holds[name] = judge_point(numbers, point)
            found.append(f"{name} {words}")
        return Finding("; ".join(found), holds)

    return judge


def equal_frequencies(printed: Sequence[float], superelement: str) -> Judge:
    """Judges a superelement's clamped frequencies by the printed digits."""

    def judge(numbers: Numbers) -> Finding:
        found = numbers.clamped_frequencies(superelement)[: len(printed)]
        holds = all(f"{value:.2f}" == f"{wanted:.2f}" for value, wanted in zip(found, printed))
        return Finding(", ".join(f"{value:.2f}" for value in found) + " Hz", {"": holds})

    return judge


def rigid_frequencies(numbers: Numbers) -> Finding:
    """Judges bounce and pitch of the assembled rigid truck."""
    found = numbers.run("bump_rigid").chassis_modes()
    holds = {name: abs(found[name] - wanted) <= RIGID_MARGIN for name, wanted in PRINTED_RIGID.items()}
    return Finding(", ".join(f"{name} {value:.3f} Hz" for name, value in found.items()), holds)


def differing_peaks(first: str, second: str, significant: bool) -> Judge:
    """Judges the highest and lowest displacement of two runs over the bump by the larger difference, as a share."""

    def judge(numbers: Numbers, point: str) -> tuple[str, bool]:
        one, other = (numbers.run(name).displacement(point) for name in (first, second))
        shares = [relative(other.max(), one.max()), relative(other.min(), one.min())]
        differs = max(abs(share) for share in shares) >= SIGNIFICANT
        words = f"highest {1e3 * one.max():.1f} to {1e3 * other.max():.1f} mm ({percent(shares[0])}), "
        words += f"lowest {1e3 * one.min():.1f} to {1e3 * other.min():.1f} mm ({percent(shares[1])}), "
        words += f"at any moment at most {1e3 * np.max(np.abs(other - one)):.1f} mm apart"
        return words, bool(differs == significant)

    return at_both_points(judge)


def raised_peak(run: str) -> Judge:
    """Judges whether flexibility raises the peak acceleration over the bump."""

    def judge(numbers: Numbers, point: str) -> tuple[str, bool]:
        rigid = numbers.run("bump_rigid").peak_acceleration(point)
        other = numbers.run(run).peak_acceleration(point)
        share = relative(other, rigid)
        return f"{rigid:.1f} to {other:.1f} m/s² ({percent(share)})", share >= SIGNIFICANT

    return at_both_points(judge)


def raised_high_frequencies(road: str, run: str) -> Judge:
    """Judges whether flexibility raises the vibration above 8 Hz."""

    def judge(numbers: Numbers, point: str) -> tuple[str, bool]:
        rigid, other = (calc_high(numbers.run(f"{road}_{name}"), point) for name in ("rigid", run))
        share = relative(other, rigid)
        return f"{rigid:.2f} to {other:.2f} m/s² ({percent(share)})", share >= MARKED

    return at_both_points(judge)


def calc_high(run: RunNumbers, point: str) -> float:
    """The r.m.s. acceleration at high frequencies, m/s²."""
    return float(np.sqrt(np.sum(run.band_rms(point)[HIGH_FROM:] ** 2)))


def decay(run: str, sustained: bool) -> Judge:
    """Judges whether the oscillation after the bump is sustained, or whether it decays."""

    def judge(numbers: Numbers, point: str) -> tuple[str, bool]:
        one = numbers.run(run)
        early, late = one.rms_between(point, *EARLY), one.rms_between(point, *LATE)
        ratio = late / early
        return f"{early:.2f} to {late:.2f} m/s², ratio {ratio:.2f}", bool((ratio >= SUSTAINED) == sustained)

    return at_both_points(judge)


def alike(first: str, second: str, quantity: str) -> Judge:
    """Judges histories of a quantity, "displacement" or "acceleration", by the r.m.s. of their difference as a share of
    the first's r.m.s."""

    def judge(numbers: Numbers, point: str) -> tuple[str, bool]:
        one, other = (getattr(numbers.run(name), quantity)(point) for name in (first, second))
        share = calc_rms(other - one) / calc_rms(one)
        words = f"{100.0 * share:.1f} % (r.m.s. {percent(relative(calc_rms(other), calc_rms(one)))})"
        return words, share < SIGNIFICANT

    return at_both_points(judge)


def raised_rms(run: str) -> Judge:
    """Judges whether flexibility raises the acceleration over terrain."""

    def judge(numbers: Numbers, point: str) -> tuple[str, bool]:
        rigid, other = (numbers.run(name).rms_acceleration(point) for name in ("terrain_rigid", run))
        share = relative(other, rigid)
        return f"{rigid:.2f} to {other:.2f} m/s² ({percent(share)})", share >= MARKED

    return at_both_points(judge)


def raised_human_band(run: str) -> Judge:
    """Judges whether flexibility raises the vibration to which people are most sensitive."""

    def judge(numbers: Numbers, point: str) -> tuple[str, bool]:
        rigid, other = (numbers.run(name).band_rms(point)[HUMAN] for name in ("terrain_rigid", run))
        share = relative(other, rigid)
        return f"{rigid:.2f} to {other:.2f} m/s² ({percent(share)})", bool(share >= MARKED)

    return at_both_points(judge)


def deflection_ratio(run: str) -> Judge:
    """Judges the front end's peak deflection over the static one."""

    def judge(numbers: Numbers) -> Finding:
        end = numbers.run(run).front_end
        words = f"{abs(1e3 * end.largest):.1f} mm over {abs(1e3 * end.static):.2f} mm: ratio {end.ratio:.1f}"
        return Finding(words, {"": abs(end.ratio / PRINTED_RATIO - 1.0) <= RATIO_MARGIN})

    return judge


def deflection_frequency(run: str) -> Judge:
    """Judges the front end's dominant frequency."""

    def judge(numbers: Numbers) -> Finding:
        end = numbers.run(run).front_end
        words = f"{end.frequency:.2f} Hz; {end.crossings:.1f} upward crossings of the mean each second"
        return Finding(words, {"": abs(end.frequency - PRINTED_BENDING) <= BENDING_MARGIN})

    return judge


def cost(count: int, calc: Callable[[Numbers, str], float], suffix: str) -> Judge:
    """Judges what a number of modes costs over the rigid model. calc: the cost of a run by its name; suffix: of the
    runs' names."""

    def judge(numbers: Numbers) -> Finding:
        found, holds = [], {}
        for road in ("bump", "terrain"):
            ratio = calc(numbers, f"{road}_{count}modes{suffix}") / calc(numbers, f"{road}_rigid{suffix}")
            found.append(f"{road} {ratio:.2f}")
            holds[road] = bool(abs(ratio / PRINTED_COSTS[count] - 1.0) <= COST_MARGIN)
        return Finding(", ".join(found), holds)

    return judge
