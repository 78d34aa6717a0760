"""Tables and picture of tools/benchmark."""

import io

from matplotlib.figure import Figure

from sprung_tools.benchmark.measurements import BASELINE
from sprung_tools.terminal.text_table import format_table

COLOURS = ("#000000", "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9")
MARKERS = ("o", "s", "^", "D", "v", "P")
WANTED_EVALUATION, WANTED_BASELINE, WANTED_REAL_TIME, WANTED_EVALUATIONS = 8.0, 15.0, 150.0, 4000
WANTED_RIGID_SHARE = {2: 1.5, 4: 2.2}  # of the time of the rigid run, by modes
WANTED_EVALUATION_SHARE = {2: 1.25, 4: 1.5}
WANTED_GROWTH = 13.0  # for ten times the bodies


def evaluation_rows(times):
    """times as measure_evaluations() gives them."""
    modes = sorted({modes for _, modes in times})
    return [
        (
            str(count),
            f"{1e6 * times['fast', count]:.2f}",
            f"{1e6 * times['dense', count]:.2f}",
            f"{times['dense', count] / times['fast', count]:.2f}",
            f"{times['fast', count] / times['fast', modes[0]]:.2f}",
        )
        for count in modes
    ]


def format_evaluations(times):
    """One evaluation of the equations of motion."""
    headings = ("modes", "fast µs", "dense µs", "dense/fast", "fast/rigid fast")
    return format_table(headings, evaluation_rows(times))


def fastest_rigid(results, run):
    """The shortest time of a rigid run that is good enough, None if there is none."""
    times = [
        rung.seconds
        for (name, modes, method), rung in results.items()
        if rung and name == run and modes == 0 and method != BASELINE
    ]
    return min(times, default=None)


def ratio(value, to, digits=2):
    """As text; empty where either is missing."""
    return f"{value / to:.{digits}f}" if value is not None and to else ""


def format_runs(results, firsts, durations):
    """results: {(run, modes, method): the rung that is good enough, or None}; firsts: the same of those that are so by
    themselves, be it by chance; durations {run: s}."""
    rows = []
    for (run, modes, method), rung in results.items():
        if rung is None:
            rows.append((run, str(modes), method, *["–"] * 8))
            continue
        baseline, first_baseline = results.get((run, modes, BASELINE)), firsts.get((run, modes, BASELINE))
        rows.append(
            (
                run,
                str(modes),
                method,
                f"{rung.tolerance:g}",
                str(rung.evaluations),
                str(rung.steps),
                f"{1e3 * rung.seconds:.2f}",
                f"{durations[run] / rung.seconds:.0f}",
                ratio(rung.seconds, fastest_rigid(results, run)),
                ratio(baseline.seconds if baseline else None, rung.seconds, 1),
                ratio(first_baseline.seconds if first_baseline else None, firsts[run, modes, method].seconds, 1),
            )
        )
    headings = (
        "run", "modes", "method", "tolerance", "evaluations", "steps", "CPU ms", "times real time",
        "to fastest rigid", "baseline/this", "at first good tolerances",
    )  # fmt: skip
    return format_table(headings, rows)


def format_growth(lines):
    """lines as measure_growth() gives them."""
    rows = []
    before = {}
    for line in lines:
        last = before.get(line["chain"])
        rows.append(
            (
                line["chain"],
                str(line["bodies"]),
                str(line["factor_entries"]),
                f"{1e6 * line['seconds_per_evaluation']:.2f}",
                f"{line['evaluations_per_step']:.2f}",
                f"{1e6 * line['seconds_per_step']:.2f}",
                ratio(line["seconds_per_step"], last and last["seconds_per_step"], 1),
                f"{1e3 * line['seconds_to_start']:.2f}",
            )
        )
        before[line["chain"]] = line
    headings = (
        "chain", "bodies", "factor entries", "evaluation µs", "evaluations a step", "step µs", "step to above",
        "start ms",
    )  # fmt: skip
    return format_table(headings, rows)


def best(results, run, modes):
    """The fastest rung of all integrators, None if none is good enough."""
    found = [
        rung
        for (name, count, method), rung in results.items()
        if rung and name == run and count == modes and method != BASELINE
    ]
    return min(found, key=lambda rung: rung.seconds, default=None)


def check_targets(times, results, firsts, durations, growth):
    """All targets that the measurements speak of, as (what, wanted, measured, met)."""
    targets = []

    def at_least(what, wanted, value):
        targets.append((what, f"≥ {wanted:g}", value, value >= wanted))

    def at_most(what, wanted, value):
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


def format_targets(targets):
    """As check_targets() gives them."""
    rows = [(what, wanted, f"{value:.4g}", "yes" if met else "no") for what, wanted, value, met in targets]
    return format_table(("target", "wanted", "measured", "met"), rows)


def work_precision_csv(ladders):
    """ladders: {(run, modes, method): rungs}. One line for each rung."""
    lines = ["run,modes,method,tolerance,evaluations,steps,cpu_s,height_error_m,peak_error,rms_error,deflection_error"]
    for (run, modes, method), rungs in ladders.items():
        for rung in rungs:
            errors = ",".join(f"{error:.4e}" for error in rung.errors)
            lines.append(
                f"{run},{modes},{method},{rung.tolerance:g},{rung.evaluations},{rung.steps},{rung.seconds:.4e},{errors}"
            )
    return "\n".join(lines) + "\n"


def draw_work_precision(ladders):
    """Error of the chassis height against CPU time, a panel for each run and number of modes. Returns PNG bytes."""
    panels = list(dict.fromkeys((run, modes) for run, modes, _ in ladders))
    methods = list(dict.fromkeys(method for *_, method in ladders))
    figure = Figure(figsize=(4.2 * len(panels), 4.2), layout="constrained")
    for axes, (run, modes) in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels):
        for (name, count, method), rungs in ladders.items():
            if (name, count) != (run, modes) or not rungs:
                continue
            place = methods.index(method)
            axes.loglog(
                [1e3 * rung.seconds for rung in rungs],
                [max(rung.errors.height, 1e-12) for rung in rungs],
                color=COLOURS[place % len(COLOURS)],
                marker=MARKERS[place % len(MARKERS)],
                markersize=4,
                label=method,
            )
        axes.set_title(f"{run}, {modes} modes")
        axes.set_xlabel("CPU time, ms")
        axes.set_ylabel("largest error of the chassis height, m")
        axes.grid(color="0.9", linewidth=0.6)
        axes.legend(frameon=False)
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=150)
    return picture.getvalue()
