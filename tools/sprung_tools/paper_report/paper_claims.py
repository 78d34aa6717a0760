"""What the paper claims: each claim with its criterion, in the order of the paper."""

from sprung_tools.paper_report.claims import (
    COST_MARGIN,
    MARKED,
    PRINTED_CHASSIS,
    PRINTED_COSTS,
    PRINTED_LINK,
    PRINTED_RATIO,
    RATIO_MARGIN,
    SIGNIFICANT,
    SUSTAINED,
    Claim,
    alike,
    cost,
    decay,
    deflection_frequency,
    deflection_ratio,
    differing_peaks,
    equal_frequencies,
    raised_high_frequencies,
    raised_human_band,
    raised_peak,
    raised_rms,
    rigid_frequencies,
)
from sprung_tools.paper_report.run_numbers import Numbers


def list_claims() -> list[Claim]:
    """All claims, in the order of the paper."""
    both = ("bump_rigid", "bump_2modes", "bump_4modes")
    terrain = ("terrain_rigid", "terrain_2modes", "terrain_4modes")
    links = ("terrain_links", "terrain_2modes_links")
    seen, unseen = f"{100 * SIGNIFICANT:g} % or more", f"below {100 * SIGNIFICANT:g} %"
    marked = f"{100 * MARKED:g} % or more"
    history = f"r.m.s. of the difference of both histories {unseen} of the first's r.m.s."

    claims = [
        Claim("1", "section 4", "the chassis' frequencies, clamped in the middle", "equal to the printed two decimals",
              both[:1], equal_frequencies(PRINTED_CHASSIS, "chassis")),
        Claim("2", "section 4", "a long arm's frequencies, clamped in the middle", "equal to the printed two decimals",
              both[:1], equal_frequencies(PRINTED_LINK, "long_arm")),
        Claim("3", "Table 1", "bounce 1.98 Hz, pitch 1.95 Hz", "both within 0.01 Hz in the assembled rigid truck",
              both[:1], rigid_frequencies),
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
        Claim("8", "Fig. 10", "significantly higher frequency content",
              f"2 modes: r.m.s. above 8 Hz higher by {marked}", both[:2], raised_high_frequencies("bump", "2modes")),
        Claim("9", "Fig. 10", "the same", f"4 modes: r.m.s. above 8 Hz higher by {marked}",
              (both[0], both[2]), raised_high_frequencies("bump", "4modes")),
        Claim("10", "Fig. 11", "without modal damping the oscillation is sustained",
              f"r.m.s. acceleration of 4 to 5 s over that of 2 to 3 s: {SUSTAINED:g} or more",
              ("bump_2modes_undamped",), decay("bump_2modes_undamped", True)),
        Claim("11", "Fig. 11", "with 1 % of modal damping it decays", f"the same ratio below {SUSTAINED:g}",
              both[1:2], decay("bump_2modes", False)),
        Claim("12", "Fig. 12", "displacement over terrain: rigid and flexible alike", f"rigid, 2 modes: {history}",
              terrain[:2], alike(*terrain[:2], "displacement")),
        Claim("13", "Fig. 12", "the same for 2 and 4 modes", "the same",
              terrain[1:], alike(*terrain[1:], "displacement")),
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
    claims += list_front_end_claims(len(claims))
    return claims + list_cost_claims(len(claims), tuple(both) + tuple(terrain))


def list_front_end_claims(count: int) -> list[Claim]:
    """The claims about the front end's deflection; `count` claims stand before them."""
    models = {"terrain_2modes": "2 modes", "terrain_4modes": "4 modes", "terrain_36modes": "all 36 modes"}
    low, high = PRINTED_RATIO * (1 - RATIO_MARGIN), PRINTED_RATIO * (1 + RATIO_MARGIN)
    rows = [
        ("front end: dynamic peak 22 times the static deflection", f"{name}: between {low:.1f} and {high:.1f}",
         (run,), deflection_ratio(run))
        for run, name in models.items()
    ] + [
        ("front end vibrates at about 6 Hz",
         f"{name}: highest peak of the deflection's spectrum between 5.5 and 6.5 Hz", (run,), deflection_frequency(run))
        for run, name in models.items()
    ]  # fmt: skip
    return [Claim(f"{number}", "Fig. 14", *row) for number, row in enumerate(rows, start=count + 1)]


def list_cost_claims(count: int, runs: tuple[str, ...]) -> list[Claim]:
    """The claims about the cost of modes in some runs; `count` claims stand before them.

    Evaluations are those of a method that sees one rate of change at a time, as the paper's did; times are those of the
    default method.
    """
    claims = []
    for unit, calc, suffix, timed in (
        ("evaluations by Adams' method", calc_evaluations, "_adams", False),
        ("processor time by the default method", Numbers.cost, "", True),
    ):
        for modes, printed in PRINTED_COSTS.items():
            count += 1
            claims.append(
                Claim(f"{count}", "section 4.1", f"{modes} modes cost {printed} times the rigid model",
                      f"{unit}: within {100 * COST_MARGIN:g} % of that", tuple(name + suffix for name in runs),
                      cost(modes, calc, suffix), timed)
            )  # fmt: skip
    return claims


def calc_evaluations(numbers: Numbers, run: str) -> float:
    """The evaluations of the equations of motion in a run."""
    return numbers.run(run).evaluations
