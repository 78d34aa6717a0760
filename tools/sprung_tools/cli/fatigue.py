"""Prints stresses and fatigue damage of flexible bodies in runs, and draws them along each body.

Stresses are those of the extreme fibres, N/A ± M/W, from the loads on the body and from its modes; the difference of
both tells what the modes lack. They are nominal stresses of the beam: what welds, holes and corners add belongs into
the detail category, or into --factor. Cycles are counted by rainflow (ASTM E1049-85). Their damage follows a line of
two slopes in double logarithmic scales, as in EN 1993-1-9, and adds up by Palmgren and Miner. The life is the time
until the damage is 1 if the span is repeated. Any line of one slope m through the range S at N cycles is
--category S·(N/2e6)^(1/m) --slopes m m.

The span of time is that of the run file's [statistics], or the one given. The table has the place with the greatest
damage of each body and run; with --at the places given."""

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
from sprung_tools.runs.fatigue import Fatigue, calc_fatigue, calc_life, find_stations
from sprung_tools.runs.labelled_runs import Run, check_labelled_output, open_runs
from sprung_tools.runs.measures import JSON_FORMAT, JSON_VERSION, describe_run
from sprung_tools.runs.ride_measures import read_window
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.runs.section_stress import find_gap, list_sources
from sprung_tools.signals.fatigue_damage import StrengthLine
from sprung_tools.signals.spans import Span
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

MPA, HOUR = 1e6, 3600.0
SAME_PLACE = 1e-6  # m
HEADINGS = ("body", "run", "from", "at m", "element", "side", "highest MPa", "lowest MPa", "largest range MPa",
            "damage", "life h")  # fmt: skip
UNITS = {"damage": "1", "station": "m", "element": "1", "highest": "Pa", "lowest": "Pa", "largest_range": "Pa",
         "life": "s"}  # fmt: skip


class Found(NamedTuple):
    """The fatigue of a body in a run, over a span of time; source: what the loads of the sections are from."""

    body: str
    run: Run
    window: Span
    source: str
    fatigue: Fatigue


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
        Found(body, run, window, source, calc_fatigue(run.results, body, source, window, line, factor))
        for body in bodies for run, window in zip(runs, windows) if not find_gap(run.results, body)
        for source in list_sources(run.results, body)
    ]  # fmt: skip


def parse_places(texts: Sequence[str], bodies: Sequence[str]) -> list[tuple[str, float]]:
    """Places `BODY:METRES`. InputError for anything else."""
    places = []
    for text in texts:
        body, _, metres = text.rpartition(":")
        try:
            places.append((body, float(metres)))
        except ValueError:
            places.append((body, np.nan))
        if not np.isfinite(places[-1][1]):
            raise InputError(f"--at: error: '{text}' is not BODY:METRES")
        if body not in bodies:
            raise InputError(f"--at: error: no stresses of a body '{body}'; there are those of {', '.join(bodies)}")
    return places


def list_places(found: Found, asked: Sequence[tuple[str, float]]) -> list[Place]:
    """The fibres that the table shows of a body: the worst one, or both at each place asked for."""
    if not asked:
        return [Place(*found.fatigue.worst)]
    at_body = [place for body, place in asked if body == found.body]
    along = found.fatigue.section.along
    for place in at_body:
        if not np.min(along) - SAME_PLACE <= place <= np.max(along) + SAME_PLACE:
            reach = f"{np.min(along):.4g} to {np.max(along):.4g} m"
            raise InputError(f"--at: error: {place:g} m is beyond '{found.body}', which reaches from {reach}")
    return [
        Place(station, side) for place in at_body for station in find_stations(found.fatigue, place) for side in (0, 1)
    ]


def describe_place(found: Found, place: Place) -> dict[str, float | None]:
    """What the fatigue of a body is at a place, in SI units, in the order of UNITS."""
    section, stress = found.fatigue.section, found.fatigue.section.stress[:, place.station, place.side]
    damage = float(found.fatigue.damage[place])
    return {
        "damage": damage, "station": float(section.along[place.station]),
        "element": int(section.elements[place.station]),
        "highest": float(stress.max()), "lowest": float(stress.min()),
        "largest_range": float(found.fatigue.greatest_range[place]), "life": calc_life(damage, found.window),
    }  # fmt: skip


def make_rows(all_found: Sequence[Found], asked: Sequence[tuple[str, float]]) -> Iterator[tuple[str, ...]]:
    """The rows of the table."""
    for found in all_found:
        for place in list_places(found, asked):
            one = describe_place(found, place)
            side = found.fatigue.section.sides[place.station][place.side]
            stresses = (f"{(one[name] or 0.0) / MPA:.1f}" for name in ("highest", "lowest", "largest_range"))
            life = "–" if one["life"] is None else f"{one['life'] / HOUR:.4g}"
            yield (found.body, found.run.label, found.source, f"{one['station']:.3f}", f"{one['element']}", side,
                   *stresses, f"{one['damage']:.3e}", life)  # fmt: skip


def pack_fatigue(found: Found) -> dict[str, dict[str, Any]]:
    """The measures of a body's worst place for JSON."""
    name = f"fatigue/{found.body}/from_{found.source}"
    worst = describe_place(found, Place(*found.fatigue.worst))
    return {f"{name}/{key}": {"value": worst[key], "unit": unit} for key, unit in UNITS.items()}


def pack_profile(found: Found) -> dict[str, Any]:
    """Damage and stresses along a body for JSON."""
    section = found.fatigue.section
    return {
        "body": found.body, "from": found.source, "axis": section.axis, "station": section.along.tolist(),
        "element": section.elements.tolist(), "sides": section.sides, "damage": found.fatigue.damage.tolist(),
        "largest_range": found.fatigue.greatest_range.tolist(), "highest": section.stress.max(axis=0).tolist(),
        "lowest": section.stress.min(axis=0).tolist(),
    }  # fmt: skip


def make_json(runs: Sequence[Run], windows: Sequence[Span], all_found: Sequence[Found], line: StrengthLine,
              factor: float) -> str:  # fmt: skip
    """Everything as JSON, in SI units."""
    packed = []
    for run, window in zip(runs, windows):
        of_run = [one for one in all_found if one.run is run]
        measures = {name: value for one in of_run for name, value in pack_fatigue(one).items()}
        packed.append({"label": run.label, "file": run.results.path, **describe_run(run.results, window),
                       "measures": measures, "along": [pack_profile(one) for one in of_run]})  # fmt: skip
    whole = {"format": JSON_FORMAT, "version": JSON_VERSION, "strength_line": line._asdict(), "stress_factor": factor,
             "runs": packed}  # fmt: skip
    return json.dumps(whole, indent=1, ensure_ascii=False, allow_nan=False)


def write_histories(path: str, all_found: Sequence[Found], asked: Sequence[tuple[str, float]]) -> None:
    """Writes the stresses of a run over time at the places of the table, as CSV."""
    headings, columns = ["time [s]"], [all_found[0].fatigue.time]
    for found in all_found:
        section = found.fatigue.section
        for place in list_places(found, asked):
            where = f"{found.body} at {section.along[place.station]:.4g} m, element {section.elements[place.station]}"
            headings.append(f"{where}, {section.sides[place.station][place.side]}, from {found.source} [Pa]")
            columns.append(section.stress[:, place.station, place.side])
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows(zip(*(column.tolist() for column in columns)))
    write_whole(path, table.getvalue())


def choose_drawn(all_found: Sequence[Found], asked: Sequence[tuple[str, float]]) -> tuple[str, Place]:
    """The body and the place that the picture shows: the first one asked for, else the one with the greatest damage."""
    candidates = [one for one in all_found if not asked or one.body == asked[0][0]]
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
    parser.add_argument("--at", action="append", metavar="BODY:METRES", default=[],
                        help="a place along a body; may be given several times")  # fmt: skip
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
              ("--factor", arguments.factor))  # fmt: skip
    for name, value in values:
        if value is not None and not 0.0 < value < float("inf"):
            raise InputError(f"{name}: error: is {value:g}, expected a finite value > 0")
    strength = None if arguments.strength is None else MPA * arguments.strength
    slopes = (arguments.slopes[0], arguments.slopes[1])
    return StrengthLine(MPA * arguments.category, slopes, arguments.knee, arguments.endurance, strength)


def main() -> int:
    arguments = parse_arguments()
    line = read_line(arguments)
    if arguments.histories and len(arguments.runs) > 1:
        raise InputError("--histories: error: takes one run, because runs have times of their own")
    for output in (arguments.output, arguments.histories):
        if output:
            check_labelled_output(output, arguments.runs)
    if arguments.output and os.path.abspath(arguments.output) == os.path.abspath(arguments.histories or ""):
        raise InputError(f"{arguments.histories}: error: is the name of the picture, too")
    runs = open_runs(arguments.runs)
    windows = [read_window(run.results, arguments.start, arguments.end) for run in runs]
    bodies, gaps = choose_bodies(runs, arguments.bodies)
    asked = parse_places(arguments.at, bodies)
    all_found = find_fatigue(runs, windows, bodies, line, arguments.factor)
    if arguments.output:
        body, place = choose_drawn(all_found, asked)
        curves = [DrawnFatigue(one.run.label, one.source, one.fatigue) for one in all_found if one.body == body]
        write_picture(make_fatigue_figure(body, curves, place, line, runs[0].results.title), arguments.output)
    if arguments.histories:
        write_histories(arguments.histories, all_found, asked)
    if arguments.json:
        print(make_json(runs, windows, all_found, line, arguments.factor))
        return 0
    spans = ", ".join(f"{run.label} {start:g} to {end:g} s" for run, (start, end) in zip(runs, windows))
    doubts = [f"statistics over: {spans}; nominal stresses of the beam", *list_doubts(runs), *gaps]
    print("\n".join(doubts) + "\n\n" + format_table(HEADINGS, list(make_rows(all_found, asked))))
    return 0
