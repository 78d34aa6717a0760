"""Prints stresses and fatigue damage of flexible bodies in runs, and draws them along each body.

Stresses are those of the extreme fibres, N/A ± M/W, from the loads on the body and from its modes; the difference of
both tells what the modes lack. They are nominal stresses of the beam: what welds, holes and corners add belongs into
the detail category, or into --factor. Cycles are counted by rainflow (ASTM E1049-85, 5.4.5), as the span of the run is
repeated. Their damage follows a line of two slopes in double logarithmic scales, as in EN 1993-1-9, and adds up by
Palmgren and Miner. The damage is that of one repetition, the life the time until it is 1. Any line of one slope m
through the range S at N cycles is --category S·(N/2e6)^(1/m) --slopes m m.

The span of time is that of the run file's [statistics], or the one given. The table has the place with the greatest
damage of each body and run, by x and y in the axes of the body; with --at the places given. With --duty it also has the
damage of all runs together, each repeated as often as told, and the life in such duties."""

import argparse
import csv
import io
import json
import os
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import write_whole
from sprung_tools.plots.fatigue_picture import DrawnFatigue, Place, make_fatigue_figure
from sprung_tools.plots.picture_file import write_picture
from sprung_tools.runs.fatigue import Fatigue, calc_fatigue, combine_fatigue
from sprung_tools.runs.fatigue_measures import describe_place, pack_fatigue
from sprung_tools.runs.labelled_runs import Run, check_labelled_output, describe_spans, open_runs
from sprung_tools.runs.measures import JSON_FORMAT, JSON_VERSION, Measures, describe_run, pack_measures
from sprung_tools.runs.ride_measures import read_window
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.runs.section_stress import FROM_LOADS, find_gap, list_sources
from sprung_tools.runs.stations import ALONG_X
from sprung_tools.signals.fatigue_damage import LARGEST_STRESS, StrengthLine
from sprung_tools.signals.spans import Span
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

MPA, HOUR = 1e6, 3600.0
SAME_PLACE = 1e-6  # m
DUTY = "duty"  # the runs together, in tables
HEADINGS = ("body", "run", "from", "x m", "y m", "element", "side", "highest MPa", "lowest MPa", "largest range MPa",
            "damage", "life h")  # fmt: skip


class AskedPlace(NamedTuple):
    """A place of a body by its x, or by its x and y, in the axes of the body [m]."""

    body: str
    where: list[float]


class Found(NamedTuple):
    """The fatigue of a body in a run, or, where that is None, in a duty of runs; duration: of what is repeated [s];
    source: what the loads of the sections are from."""

    body: str
    run: Run | None
    duration: float
    source: str
    fatigue: Fatigue

    @property
    def label(self) -> str:
        return self.run.label if self.run else DUTY


def choose_bodies(runs: Sequence[Run], wanted: Sequence[str]) -> tuple[list[str], list[str]]:
    """The bodies asked for, else all whose stresses the runs tell; and what is missing of the others. InputError if a
    body asked for has no stresses, or none has."""
    bodies: list[str] = []
    gaps = []
    for run in runs:
        for body in wanted or run.results.names("recovery"):
            gap = find_gap(run.results, body)
            if gap and wanted:
                raise InputError(f"{run.results.path}: error: {gap}")
            if gap:
                gaps.append(f"remark: {run.label}: {gap}")
            elif body not in bodies:
                bodies.append(body)
    if not bodies:
        raise InputError(f"{runs[0].results.path}: error: " + (gaps[0].partition(": ")[2].partition(": ")[2] if gaps
                         else "no flexible body with loads of its sections"))  # fmt: skip
    return bodies, gaps


def find_fatigue(
    runs: Sequence[Run], windows: Sequence[Span], bodies: Sequence[str], line: StrengthLine, factor: float
) -> list[Found]:
    """The fatigue of all bodies in all runs that tell it."""
    return [
        Found(body, run, window[1] - window[0], source,
              calc_fatigue(run.results, body, source, window, line, factor))
        for body in bodies for run, window in zip(runs, windows) if not find_gap(run.results, body)
        for source in list_sources(run.results, body)
    ]  # fmt: skip


def find_duty(all_found: Sequence[Found], repetitions: Sequence[float], num_runs: int) -> list[Found]:
    """The fatigue of the bodies that all runs tell, in a duty that has each run so many times. InputError if there is
    none, or if the runs do not have the same sections."""
    together: dict[tuple[str, str], list[Found]] = {}
    for found in all_found:
        together.setdefault((found.body, found.source), []).append(found)
    duty = []
    for (body, source), parts in together.items():
        if len(parts) < num_runs:
            continue
        try:
            fatigue = combine_fatigue([part.fatigue for part in parts], repetitions)
        except ValueError as error:
            raise InputError(f"--duty: error: '{body}': {error}") from error
        duration = sum(number * part.duration for number, part in zip(repetitions, parts))
        duty.append(Found(body, None, duration, source, fatigue))
    if not duty:
        raise InputError("--duty: error: no body has stresses in all runs, from its loads or from its modes")
    return duty


def list_duty_remarks(all_found: Sequence[Found], duty: Sequence[Found]) -> list[str]:
    """What is not in the duty, because not all runs have it."""
    there = {(one.body, one.source) for one in duty}
    left = dict.fromkeys((one.body, one.source) for one in all_found if (one.body, one.source) not in there)
    return [f"remark: {DUTY}: without '{body}' from its {source}, which not all runs have" for body, source in left]


def parse_places(texts: Sequence[str], bodies: Sequence[str]) -> list[AskedPlace]:
    """Places `BODY:X` or `BODY:X,Y`. InputError for anything else."""
    places = []
    for text in texts:
        body, _, metres = text.rpartition(":")
        try:
            where = [float(one) for one in metres.split(",")]
        except ValueError:
            where = []
        if not 1 <= len(where) <= 2 or not np.all(np.isfinite(where)):
            raise InputError(f"--at: error: '{text}' is not BODY:X or BODY:X,Y in m")
        if body not in bodies:
            raise InputError(f"--at: error: no stresses of a body '{body}'; there are those of {', '.join(bodies)}")
        places.append(AskedPlace(body, where))
    return places


def find_stations(found: Found, asked: AskedPlace) -> list[int]:
    """The stations closest to a place of a body: one for each of the elements that meet there. InputError if the place
    lies beyond the body, or if a body that is not a chain along x has no y to tell it by."""
    section, where = found.fatigue.section, asked.where
    if len(where) == 1 and section.axis != ALONG_X:
        raise InputError(f"--at: error: '{found.body}' has sections above each other: give {found.body}:X,Y")
    place = ", ".join(f"{one:g}" for one in where)
    near = section.positions[:, : len(where)]
    low, high = np.min(near, axis=0), np.max(near, axis=0)
    if np.any(where < low - SAME_PLACE) or np.any(where > high + SAME_PLACE):
        reach = ", ".join(f"{one} from {a:.4g} to {b:.4g} m" for one, a, b in zip("xy", low, high))
        raise InputError(f"--at: error: {place} m is beyond '{found.body}', which reaches in {reach}")
    distances = np.linalg.norm(near - where, axis=1)
    nearest = int(np.argmin(distances))
    ends = section.positions[section.elements == section.elements[nearest]]
    if distances[nearest] > 0.5 * np.linalg.norm(np.ptp(ends, axis=0)) + SAME_PLACE:
        raise InputError(f"--at: error: '{found.body}' has no section at {place} m; the nearest is at "
                         f"{section.name_place(nearest)}")  # fmt: skip
    return [int(station) for station in np.flatnonzero(distances <= distances[nearest] + SAME_PLACE)]


def list_places(found: Found, asked: Sequence[AskedPlace]) -> list[Place]:
    """The fibres that the table shows of a body: the worst one, or both at each place asked for."""
    if not asked:
        return [Place(*found.fatigue.worst)]
    at_body = [place for place in asked if place.body == found.body]
    return [Place(station, side) for place in at_body for station in find_stations(found, place) for side in (0, 1)]


def make_rows(all_found: Sequence[Found], asked: Sequence[AskedPlace]) -> Iterator[tuple[str, ...]]:
    """The rows of the table."""
    for found in all_found:
        for place in list_places(found, asked):
            one = describe_place(found.fatigue, found.duration, *place)
            side = found.fatigue.section.sides[place.station][place.side]
            stresses = (f"{(one[name] or 0.0) / MPA:.1f}" for name in ("highest", "lowest", "largest_range"))
            life = "–" if one["life"] is None else f"{one['life'] / HOUR:.4g}"
            yield (found.body, found.label, found.source, f"{one['x']:.3f}", f"{one['y']:.3f}", f"{one['element']}",
                   side, *stresses, f"{one['damage']:.3e}", life)  # fmt: skip


def pack_profile(found: Found) -> dict[str, Any]:
    """Damage and stresses along a body for JSON."""
    section = found.fatigue.section
    return {
        "body": found.body, "from": found.source, "axis": section.axis, "along": section.along.tolist(),
        **dict(zip("xy", section.positions.T.tolist())), "element": section.elements.tolist(),
        "sides": section.sides, "damage": found.fatigue.damage.tolist(),
        "largest_range": found.fatigue.greatest_range.tolist(), "highest": section.stress.max(axis=0).tolist(),
        "lowest": section.stress.min(axis=0).tolist(),
    }  # fmt: skip


def pack_all(found: Sequence[Found]) -> dict[str, Any]:
    """The measures of bodies, and their damage and stresses along them, for JSON."""
    measures: Measures = {}
    for one in found:
        measures |= pack_fatigue(one.body, one.source, one.fatigue, one.duration)
    return {"measures": pack_measures(measures), "along": [pack_profile(one) for one in found]}


def make_json(runs: Sequence[Run], windows: Sequence[Span], all_found: Sequence[Found], duty: Sequence[Found],
              asked: argparse.Namespace, line: StrengthLine, remarks: Sequence[str]) -> str:  # fmt: skip
    """Everything as JSON, in SI units."""
    packed = [
        {"label": run.label, "file": run.results.path, **describe_run(run.results, window),
         **pack_all([one for one in all_found if one.run is run])}
        for run, window in zip(runs, windows)
    ]  # fmt: skip
    whole = {"format": JSON_FORMAT, "version": JSON_VERSION, "strength_line": line._asdict(),
             "stress_factor": asked.factor, "remarks": [one.removeprefix("remark: ") for one in remarks],
             "runs": packed}  # fmt: skip
    if duty:
        whole[DUTY] = {"repetitions": asked.duty, **pack_all(duty)}
    return json.dumps(whole, indent=1, ensure_ascii=False, allow_nan=False)


def write_histories(path: str, all_found: Sequence[Found], asked: Sequence[AskedPlace]) -> None:
    """Writes the stresses of a run over time at the places of the table, as CSV."""
    headings, columns = ["time [s]"], [all_found[0].fatigue.time]
    for found in all_found:
        section = found.fatigue.section
        for place in list_places(found, asked):
            element, side = section.elements[place.station], section.sides[place.station][place.side]
            where = f"{found.body} at {section.name_place(place.station)}, element {element}, {side}"
            headings.append(f"{where}, from {found.source} [Pa]")
            columns.append(section.stress[:, place.station, place.side])
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows(zip(*(column.tolist() for column in columns)))
    write_whole(path, table.getvalue())


def choose_drawn(all_found: Sequence[Found], asked: Sequence[AskedPlace]) -> tuple[str, Place]:
    """The body and the place that the picture shows: the first one asked for, else the one with the greatest damage."""
    candidates = [one for one in all_found if not asked or one.body == asked[0].body]
    worst = max(candidates, key=lambda one: (one.fatigue.damage.max(), one.fatigue.greatest_range.max()))
    places = list_places(worst, asked[:1])
    return worst.body, max(places, key=lambda place: (worst.fatigue.damage[place], worst.fatigue.greatest_range[place]))


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(__doc__, "tools/fatigue rigid=terrain_rigid.h5 '2 modes=terrain_2modes.h5' --category 71 -o "
                         "fatigue.png")  # fmt: skip
    parser.add_argument("runs", metavar="[LABEL=]FILE", nargs="+", help="results file, and its name in the tables")
    parser.add_argument("--category", type=float, required=True, metavar="MPA",
                        help="stress range that 2 million cycles exhaust, MPa (detail category)")  # fmt: skip
    parser.add_argument("--slopes", type=float, nargs=2, default=(3.0, 5.0), metavar=("M1", "M2"),
                        help="slopes of the line above and below the knee (default: 3 5)")  # fmt: skip
    parser.add_argument("--knee", type=float, default=5e6, metavar="N", help="cycles at the knee (default: 5e6)")
    parser.add_argument("--endurance", type=float, metavar="N",
                        help="cycles at which the line ends: smaller ranges do no damage (default: none)")  # fmt: skip
    parser.add_argument("--strength", type=float, metavar="MPA",
                        help="ultimate strength, MPa: corrects for the mean stress by Goodman's line")  # fmt: skip
    parser.add_argument("--factor", type=float, default=1.0, metavar="F", help="multiplies all stresses (default: 1)")
    parser.add_argument("--bodies", nargs="+", metavar="BODY", default=(), help="bodies (default: all that are known)")
    parser.add_argument("--at", action="append", metavar="BODY:X[,Y]", default=[],
                        help="a place in the axes of a body, m; may be given several times")  # fmt: skip
    parser.add_argument("--duty", type=float, nargs="+", metavar="N",
                        help="how often each run is repeated in a duty: a number for each file")  # fmt: skip
    parser.add_argument("--from", dest="start", type=float, metavar="S", help="judge from this time, s")
    parser.add_argument("--to", dest="end", type=float, metavar="S", help="judge up to this time, s")
    parser.add_argument("-o", "--output", metavar="PICTURE", help="picture to write (.png, .svg, .pdf)")
    parser.add_argument("--histories", metavar="TABLE", help="write the stresses of one run over time (.csv)")
    parser.add_argument("--json", action="store_true", help="print one JSON object with all numbers in SI units")
    return parser.parse_args()


def read_line(arguments: argparse.Namespace) -> StrengthLine:
    """The strength line of the command line. InputError for a value that no line has."""
    values = (("--category", arguments.category), *(("--slopes", slope) for slope in arguments.slopes),
              ("--knee", arguments.knee), ("--endurance", arguments.endurance), ("--strength", arguments.strength),
              ("--factor", arguments.factor), *(("--duty", number) for number in arguments.duty or ()))  # fmt: skip
    for name, value in values:
        if value is not None and not 0.0 < value < float("inf"):
            raise InputError(f"{name}: error: is {value:g}, expected a finite value > 0")
    for name, value in (("--category", arguments.category), ("--strength", arguments.strength)):
        if value is not None and MPA * value > LARGEST_STRESS:
            raise InputError(f"{name}: error: is {value:g}, expected at most {LARGEST_STRESS / MPA:g} MPa")
    strength = None if arguments.strength is None else MPA * arguments.strength
    slopes = (arguments.slopes[0], arguments.slopes[1])
    return StrengthLine(MPA * arguments.category, slopes, arguments.knee, arguments.endurance, strength)


def list_source_remarks(runs: Sequence[Run], bodies: Sequence[str]) -> list[str]:
    """Which bodies have no stresses from their loads."""
    return [
        f"remark: {run.label}: no stresses of '{body}' from its loads: it has [stiffening], or its superelement has no "
        "section loads"
        for body in bodies for run in runs
        if not find_gap(run.results, body) and FROM_LOADS not in list_sources(run.results, body)
    ]  # fmt: skip


def main() -> int:
    arguments = parse_arguments()
    line = read_line(arguments)
    if arguments.duty and len(arguments.duty) != len(arguments.runs):
        raise InputError(f"--duty: error: has {len(arguments.duty)} numbers, expected one for each of the "
                         f"{len(arguments.runs)} runs")  # fmt: skip
    if arguments.histories and len(arguments.runs) > 1:
        raise InputError("--histories: error: takes one run, because runs have times of their own")
    for output in (arguments.output, arguments.histories):
        if output:
            check_labelled_output(output, arguments.runs)
    if arguments.output and os.path.abspath(arguments.output) == os.path.abspath(arguments.histories or ""):
        raise InputError(f"{arguments.histories}: error: is the name of the picture, too")
    runs = open_runs(arguments.runs)
    if arguments.duty and any(run.label == DUTY for run in runs):
        raise InputError(f"--duty: error: a run has the label '{DUTY}', which the runs together have; give another one")
    windows = [read_window(run.results, arguments.start, arguments.end) for run in runs]
    bodies, gaps = choose_bodies(runs, arguments.bodies)
    asked = parse_places(arguments.at, bodies)
    all_found = find_fatigue(runs, windows, bodies, line, arguments.factor)
    duty = find_duty(all_found, arguments.duty, len(runs)) if arguments.duty else []
    remarks = [*gaps, *list_source_remarks(runs, bodies), *(list_duty_remarks(all_found, duty) if duty else [])]
    if arguments.output:
        body, place = choose_drawn(all_found, asked)
        curves = [DrawnFatigue(one.label, one.source, one.fatigue) for one in all_found if one.body == body]
        write_picture(make_fatigue_figure(body, curves, place, line, runs[0].results.title), arguments.output)
    if arguments.histories:
        write_histories(arguments.histories, all_found, asked)
    if arguments.json:
        print(make_json(runs, windows, all_found, duty, arguments, line, remarks))
        return 0
    spans = describe_spans(runs, windows)
    doubts = [f"statistics over: {spans}; nominal stresses of the beam", *list_doubts(runs), *remarks]
    rows = sorted(make_rows([*all_found, *duty], asked), key=lambda row: bodies.index(row[0]))
    print("\n".join(doubts) + "\n\n" + format_table(HEADINGS, rows))
    return 0
