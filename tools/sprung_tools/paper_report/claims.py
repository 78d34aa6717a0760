"""What the paper claims, each with a criterion that a program can judge, and what the runs say to it.

The thresholds are a few round numbers for all claims alike, set before the table was first computed and never adapted
to it: a "no" is as good a result as a "yes". A share of 5 % is what two curves of a page's width can just be told apart by.

What the paper calls the centre of mass of the chassis is judged at both things it can mean (run_numbers.py).
"""

from typing import Callable, NamedTuple

import numpy as np

from sprung_tools.paper_report.run_numbers import CENTRE, MIDDLE, relative
from sprung_tools.signals.spectra import calc_rms

SIGNIFICANT = 0.05  # a difference that is seen; what stays below it is "no significant difference"
MARKED = 0.20  # a rise that is called marked or significant in so many words
EARLY, LATE = (2.0, 3.0), (4.0, 5.0)  # s, over the bump: both axles are past it, and the end of the run
SUSTAINED = 0.5  # late over early r.m.s., from which on an oscillation is sustained
HUMAN = 1  # of the bands of run_numbers.BANDS: 4 to 8 Hz, where people are most sensitive
HIGH_FROM = (
    2  # bands from this one on are "high frequency": 8 Hz and above, all vibration but bounce and pitch
)
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
    """What the runs say, in words, and for each point or case judged whether the claim holds."""

    found: str
    holds: dict  # name of what was judged → bool; one nameless entry where there is nothing to tell apart


class Claim(NamedTuple):
    """A claim, as one row of the table."""

    number: str
    source: str
    says: str
    criterion: str
    needs: tuple  # runs without which it cannot be judged
    judge: Callable  # Numbers → Finding
    timed: bool = False


def format_holds(holds):
    """`yes`, `no`, or which of what was judged is which."""
    words = {name: "yes" if value else "no" for name, value in holds.items()}
    if len(set(words.values())) == 1:
        return next(iter(words.values()))
    return ", ".join(f"{name}: {word}" for name, word in words.items())


def percent(share, digits=1):
    """A share with its sign, `+1.5 %`; what rounds to nothing has none."""
    text = f"{100.0 * share:+.{digits}f}"
    return f"{text if float(text) else text[1:]} %"


def at_both_points(judge_point):
    """Judges a claim at the middle and at the centre of mass. judge_point: (numbers, point) → (words, bool)."""

    def judge(numbers):
        found, holds = [], {}
        for point, name in NAMES.items():
            words, holds[name] = judge_point(numbers, point)
            found.append(f"{name} {words}")
        return Finding("; ".join(found), holds)

    return judge


def judge_frequencies(printed, superelement):
    def judge(numbers):
        found = numbers.clamped_frequencies(superelement)[: len(printed)]
        holds = all(f"{value:.2f}" == f"{wanted:.2f}" for value, wanted in zip(found, printed))
        return Finding(", ".join(f"{value:.2f}" for value in found) + " Hz", {"": holds})

    return judge


def judge_rigid_frequencies(numbers):
    found = numbers.run("bump_rigid").chassis_modes()
    holds = {name: abs(found[name] - wanted) <= RIGID_MARGIN for name, wanted in PRINTED_RIGID.items()}
    return Finding(", ".join(f"{name} {value:.3f} Hz" for name, value in found.items()), holds)


def differing_peaks(first, second, significant):
    """Highest and lowest displacement of two runs over the bump: the larger of both differences, as a share."""

    def judge(numbers, point):
        one, other = (numbers.run(name).displacement(point) for name in (first, second))
        shares = [relative(other.max(), one.max()), relative(other.min(), one.min())]
        differs = max(map(abs, shares)) >= SIGNIFICANT
        words = f"highest {1e3 * one.max():.1f} to {1e3 * other.max():.1f} mm ({percent(shares[0])}), "
        words += f"lowest {1e3 * one.min():.1f} to {1e3 * other.min():.1f} mm ({percent(shares[1])}), "
        words += f"at any moment at most {1e3 * np.max(np.abs(other - one)):.1f} mm apart"
        return words, bool(differs == significant)

    return at_both_points(judge)


def raised_peak(run):
    def judge(numbers, point):
        rigid = numbers.run("bump_rigid").peak_acceleration(point)
        other = numbers.run(run).peak_acceleration(point)
        share = relative(other, rigid)
        return f"{rigid:.1f} to {other:.1f} m/s² ({percent(share)})", share >= SIGNIFICANT

    return at_both_points(judge)


def raised_high_frequencies(road, run):
    def judge(numbers, point):
        rigid, other = (calc_high(numbers.run(f"{road}_{name}"), point) for name in ("rigid", run))
        share = relative(other, rigid)
        return f"{rigid:.2f} to {other:.2f} m/s² ({percent(share)})", share >= MARKED

    return at_both_points(judge)


def calc_high(run, point):
    return float(np.sqrt(np.sum(run.band_rms(point)[HIGH_FROM:] ** 2)))


def decay(run, sustained):
    def judge(numbers, point):
        numbers = numbers.run(run)
        early, late = numbers.rms_between(point, *EARLY), numbers.rms_between(point, *LATE)
        ratio = late / early
        return f"{early:.2f} to {late:.2f} m/s², ratio {ratio:.2f}", bool((ratio >= SUSTAINED) == sustained)

    return at_both_points(judge)


def alike(first, second, quantity):
    """Histories of a quantity, "displacement" or "acceleration": r.m.s. of the difference as a share of the first's."""

    def judge(numbers, point):
        one, other = (getattr(numbers.run(name), quantity)(point) for name in (first, second))
        share = calc_rms(other - one) / calc_rms(one)
        return (
            f"{100.0 * share:.1f} % (r.m.s. {percent(relative(calc_rms(other), calc_rms(one)))})",
            share < SIGNIFICANT,
        )

    return at_both_points(judge)


def raised_rms(run):
    def judge(numbers, point):
        rigid, other = (numbers.run(name).rms_acceleration(point) for name in ("terrain_rigid", run))
        share = relative(other, rigid)
        return f"{rigid:.2f} to {other:.2f} m/s² ({percent(share)})", share >= MARKED

    return at_both_points(judge)


def raised_human_band(run):
    def judge(numbers, point):
        rigid, other = (numbers.run(name).band_rms(point)[HUMAN] for name in ("terrain_rigid", run))
        share = relative(other, rigid)
        return f"{rigid:.2f} to {other:.2f} m/s² ({percent(share)})", bool(share >= MARKED)

    return at_both_points(judge)


def deflection_ratio(run):
    def judge(numbers):
        end = numbers.run(run).front_end
        words = f"{abs(1e3 * end.largest):.1f} mm over {abs(1e3 * end.static):.2f} mm: ratio {end.ratio:.1f}"
        return Finding(words, {"": abs(end.ratio / PRINTED_RATIO - 1.0) <= RATIO_MARGIN})

    return judge


def deflection_frequency(run):
    def judge(numbers):
        end = numbers.run(run).front_end
        words = f"{end.frequency:.2f} Hz; {end.crossings:.1f} upward crossings of the mean each second"
        return Finding(words, {"": abs(end.frequency - PRINTED_BENDING) <= BENDING_MARGIN})

    return judge


def cost(count, calc, suffix):
    """calc: (numbers, run name) → cost of a run; suffix: of the runs' names."""

    def judge(numbers):
        found, holds = [], {}
        for road in ("bump", "terrain"):
            ratio = calc(numbers, f"{road}_{count}modes{suffix}") / calc(numbers, f"{road}_rigid{suffix}")
            found.append(f"{road} {ratio:.2f}")
            holds[road] = bool(abs(ratio / PRINTED_COSTS[count] - 1.0) <= COST_MARGIN)
        return Finding(", ".join(found), holds)

    return judge


def list_claims():
    """All claims, in the order of the paper."""
    both = ("bump_rigid", "bump_2modes", "bump_4modes")
    terrain = ("terrain_rigid", "terrain_2modes", "terrain_4modes")
    links = ("terrain_links", "terrain_2modes_links")
    seen, unseen = f"{100 * SIGNIFICANT:g} % or more", f"below {100 * SIGNIFICANT:g} %"
    marked = f"{100 * MARKED:g} % or more"
    history = f"r.m.s. of the difference of both histories {unseen} of the first's r.m.s."

    def evaluations(numbers, run):
        return numbers.run(run).evaluations

    def processor_time(numbers, run):
        return numbers.costs[run]

    claims = [
        Claim("1", "section 4", "the chassis' frequencies, clamped in the middle", "equal to the printed two decimals",
              both[:1], judge_frequencies(PRINTED_CHASSIS, "chassis")),
        Claim("2", "section 4", "a long arm's frequencies, clamped in the middle", "equal to the printed two decimals",
              both[:1], judge_frequencies(PRINTED_LINK, "long_arm")),
        Claim("3", "Table 1", "bounce 1.98 Hz, pitch 1.95 Hz", "both within 0.01 Hz in the assembled rigid truck",
              both[:1], judge_rigid_frequencies),
        Claim("4", "Fig. 9", "rigid and flexible chassis: significant differences of peak displacement",
              f"rigid to 2 modes: highest or lowest differs by {seen}",
              both[:2], differing_peaks(both[0], both[1], True)),
        Claim("5", "Fig. 9", "modes above the second: negligible for displacement",
              f"2 to 4 modes: highest and lowest differ by {unseen}",
              both[1:], differing_peaks(both[1], both[2], False)),
        Claim("6", "Fig. 10", "flexibility raises the peak acceleration",
              f"2 modes: peak higher than rigid by {seen}", both[:2], raised_peak(both[1])),
        Claim("7", "Fig. 10", "the same", f"4 modes: peak higher than rigid by {seen}",
              (both[0], both[2]), raised_peak(both[2])),
        Claim("8", "Fig. 10", "significantly higher frequency content", f"2 modes: r.m.s. above 8 Hz higher by {marked}",
              both[:2], raised_high_frequencies("bump", "2modes")),
        Claim("9", "Fig. 10", "the same", f"4 modes: r.m.s. above 8 Hz higher by {marked}",
              (both[0], both[2]), raised_high_frequencies("bump", "4modes")),
        Claim("10", "Fig. 11", "without modal damping the oscillation is sustained",
              f"r.m.s. acceleration of 4 to 5 s over that of 2 to 3 s: {SUSTAINED:g} or more",
              ("bump_2modes_undamped",), decay("bump_2modes_undamped", True)),
        Claim("11", "Fig. 11", "with 1 % of modal damping it decays", f"the same ratio below {SUSTAINED:g}",
              both[1:2], decay("bump_2modes", False)),
        Claim("12", "Fig. 12", "displacement over terrain: rigid and flexible alike", f"rigid, 2 modes: {history}",
              terrain[:2], alike(*terrain[:2], "displacement")),
        Claim("13", "Fig. 12", "the same for 2 and 4 modes", "the same", terrain[1:], alike(*terrain[1:], "displacement")),
        Claim("14", "Fig. 12", "the same for flexible long arms", "2 modes without and with flexible arms: the same",
              (terrain[1], links[1]), alike(terrain[1], links[1], "displacement")),
        Claim("15", "Fig. 13", "flexibility raises the acceleration level significantly",
              f"2 modes: r.m.s. higher than rigid by {marked}", terrain[:2], raised_rms(terrain[1])),
        Claim("16", "Fig. 13", "the same", f"4 modes: r.m.s. higher than rigid by {marked}",
              (terrain[0], terrain[2]), raised_rms(terrain[2])),
        Claim("17", "Fig. 13", "more vibration near the resonance of the human body",
              f"2 modes: r.m.s. from 4 to 8 Hz higher by {marked}", terrain[:2], raised_human_band(terrain[1])),
        Claim("18", "Fig. 13", "high frequency content", f"2 modes: r.m.s. above 8 Hz higher by {marked}",
              terrain[:2], raised_high_frequencies("terrain", "2modes")),
        Claim("19", "Fig. 13", "flexible long arms without effect on the acceleration",
              f"2 modes without and with flexible arms: {history}",
              (terrain[1], links[1]), alike(terrain[1], links[1], "acceleration")),
        Claim("20", "Fig. 13", "the same", "rigid chassis without and with flexible arms: the same",
              (terrain[0], links[0]), alike(terrain[0], links[0], "acceleration")),
    ]  # fmt: skip
    number = 20
    for run, name in (
        ("terrain_2modes", "2 modes"),
        ("terrain_4modes", "4 modes"),
        ("terrain_36modes", "all 36 modes"),
    ):
        number += 1
        claims.append(
            Claim(f"{number}", "Fig. 14", "front end: dynamic peak 22 times the static deflection",
                  f"{name}: between {PRINTED_RATIO * (1 - RATIO_MARGIN):.1f} and {PRINTED_RATIO * (1 + RATIO_MARGIN):.1f}",
                  (run,), deflection_ratio(run))
        )  # fmt: skip
    for run, name in (
        ("terrain_2modes", "2 modes"),
        ("terrain_4modes", "4 modes"),
        ("terrain_36modes", "all 36 modes"),
    ):
        number += 1
        claims.append(
            Claim(f"{number}", "Fig. 14", "front end vibrates at about 6 Hz",
                  f"{name}: highest peak of the deflection's spectrum between 5.5 and 6.5 Hz",
                  (run,), deflection_frequency(run))
        )  # fmt: skip
    # Evaluations by a method that sees one rate of change at a time, as the paper's did; time by the one that is used.
    costs = (
        ("evaluations by Adams' method", evaluations, "_adams", False),
        ("processor time by the default method", processor_time, "", True),
    )
    for unit, calc, suffix, timed in costs:
        for count, printed in PRINTED_COSTS.items():
            number += 1
            claims.append(
                Claim(f"{number}", "section 4.1", f"{count} modes cost {printed} times the rigid model",
                      f"{unit}: within {100 * COST_MARGIN:g} % of that", tuple(name + suffix for name in (*both, *terrain)), cost(count, calc, suffix), timed)
            )  # fmt: skip
    return claims
