"""Prints measures of runs for driver, wheels and frame: vibration as people feel it (ISO 2631-1), absorbed power,
suspension travel and bump-stop hits, dynamic tyre loads, time off the ground and without load, the largest bending
moment of each flexible body.

The span of time is that of the run file's [statistics], or the one given. Vibration is vertical, in m/s², the dose
(VDV) in m/s^1.75; MTVV is the largest running r.m.s. of Wk over 1 s. Beside it stand the weighted r.m.s. fore and aft
(Wd), of the pitch (We, rad/s²), and the total of all three; and the power that a person absorbs, W. Before the span,
vibration of the run counts in these values as a person still feels it. --json also gives the r.m.s. in third-octave
bands. Travel is from static equilibrium, compression is positive. Of a run that
starts as given, in which no equilibrium was sought, static loads and deflections are mean values over the span; of one
that continues another run they are not known. Loads are those of all parallel members together. A tyre is also without
load where it reaches the road but rises faster than it springs back. A moment is positive where it stretches the side
of -y of a body along x, else the right of its element, seen from its first end. It is that from the loads on the body;
beside it stand that from its modes and the largest difference of the two, which tells what the modes lack. With
--superelements the tool also computes the bending moment of bodies that a run took as rigid, from the forces on them,
where the file has none: the run did not store 'recovery', or its program was older. Of a response file with the spectra
on a random road (sprung-dynamics response), the tool prints the r.m.s. values and the absorbed power of the linear
vehicle."""

import argparse
import json
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import RESPONSE, open_hdf5
from sprung_tools.runs.labelled_responses import Response, open_responses
from sprung_tools.runs.labelled_runs import Run, describe_spans, open_runs, split_label
from sprung_tools.runs.largest_loads import MOMENT, calc_moment_difference, calc_peak, find_bending, list_moment_remarks
from sprung_tools.runs.measures import (
    JSON_FORMAT,
    JSON_VERSION,
    calc_measures,
    calc_point_values,
    describe_response,
    describe_run,
    find_points,
    list_linear_objects,
    list_objects,
    pack_measures,
)
from sprung_tools.runs.ride_assessment import list_remarks, point_name
from sprung_tools.runs.ride_measures import (
    calc_contact,
    calc_travel,
    find_suspensions,
    find_tyres,
    read_window,
)
from sprung_tools.runs.ride_of_response import calc_linear_assessment, list_points
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.runs.section_stress import FROM_MODES, list_stress_remarks, list_stressed_bodies
from sprung_tools.signals.spans import Span
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import MISSING, format_cell, format_table

COMFORT = ("point", "run", "r.m.s. m/s²", "peak m/s²", "Wk r.m.s. m/s²", "VDV m/s^1.75", "MTVV m/s²", "crest factor",
           "Wd fore-aft m/s²", "We pitch rad/s²", "total m/s²", "absorbed W")  # fmt: skip
LINEAR = ("point", "response", "r.m.s. m/s²", "Wk r.m.s. m/s²", "Wd fore-aft m/s²", "We pitch rad/s²", "total m/s²",
          "absorbed W")  # fmt: skip
TRAVEL = ("suspension", "run", "compression mm", "of travel", "rebound mm", "stop hits", "on the stop s",
          "rebound stop hits", "on it s")  # fmt: skip
CONTACT = ("tyre", "run", "static kN", "r.m.s. dynamic kN", "over static", "greatest kN", "off the ground s",
           "without load s")  # fmt: skip
BENDING = ("body", "run", "largest moment kN m", "at x m", "y m", "at s", "from modes kN m", "largest difference kN m")
DIFFERENCE_NOTE = (
    "remark: the largest difference is that of the two moments at one place and time, wherever they differ most; what "
    "'its modes miss' is another number (tools/README.md, Measures)"
)


def join_names(listed: Iterable[Iterable[str]]) -> list[str]:
    """All names of some lists, each once, in the order of their first appearance."""
    return list(dict.fromkeys(name for names in listed for name in names))


def make_comfort_rows(
    runs: Sequence[Run], points: Sequence[Sequence[str]], windows: Sequence[Span]
) -> Iterator[tuple[str, ...]]:
    """The rows of the table of vibration. points: of each run, as find_points() gives them."""
    for point in join_names(points):
        for run, some, window in zip(runs, points, windows):
            if point not in some:
                continue
            numbers = calc_point_values(run.results, point, window)
            yield (point_name(point), run.label, *(MISSING if value is None else f"{value:.4g}" for value in numbers))


def make_linear_rows(responses: Sequence[Response], wanted: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """The rows of the table of linear vehicles on a random road. wanted: points, all of the files if there is none."""
    for point in wanted or join_names(list_points(response) for response in responses):
        for response in responses:
            one = calc_linear_assessment(response, point)
            numbers = (one.rms, one.vertical, one.fore_aft, one.pitch, one.total, one.power)
            yield (point, response.label, *(f"{value:.4g}" for value in numbers))


def part_files(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Parts files `[LABEL=]FILE` into results of runs and responses."""
    runs, responses = [], []
    for argument in arguments:
        try:
            open_hdf5(split_label(argument)[1], RESPONSE).close()
            responses.append(argument)
        except InputError:  # whatever else is wrong with it, open_runs() tells
            runs.append(argument)
    return runs, responses


def make_travel_rows(runs: Sequence[Run], windows: Sequence[Span]) -> Iterator[tuple[str, ...]]:
    """The rows of the table of suspensions."""
    listed = [find_suspensions(run.results) for run in runs]
    for name in join_names(listed):
        for run, there, window in zip(runs, listed, windows):
            if name not in there:
                yield (name, run.label, *[MISSING] * len(TRAVEL[2:]))
                continue
            one = calc_travel(run.results, name, window)
            whole = one.whole or 0.0
            share = MISSING if one.compression is None or whole <= 0.0 else f"{100 * one.compression / whole:.0f} %"
            hits = (format_cell(one.hits, 0), format_cell(one.stopped, 3),
                    format_cell(one.rebound_hits, 0), format_cell(one.rebound_stopped, 3))  # fmt: skip
            compression, rebound = (format_cell(value, 1, 1e3) for value in (one.compression, one.rebound))
            yield (name, run.label, compression, share, rebound, *hits)


def make_contact_rows(runs: Sequence[Run], windows: Sequence[Span]) -> Iterator[tuple[str, ...]]:
    """The rows of the table of tyres."""
    listed = [find_tyres(run.results) for run in runs]
    for name in join_names(listed):
        for run, there, window in zip(runs, listed, windows):
            if name not in there:
                yield (name, run.label, *[MISSING] * len(CONTACT[2:]))
                continue
            one = calc_contact(run.results, name, window)
            yield (
                name, run.label, *(format_cell(value, 2, 1e-3) for value in (one.static, one.dynamic_rms)),
                format_cell(one.over_static(one.dynamic_rms), 3), f"{1e-3 * one.greatest:.1f}",
                f"{one.off_ground:.3f}", f"{one.unloaded:.3f}",
            )  # fmt: skip


def make_bending_rows(
    runs: Sequence[Run], windows: Sequence[Span], superelements: str | None
) -> Iterator[tuple[str, ...]]:
    """The rows of the table of bending moments, of the runs that have some."""
    listed = [run.results.names("bodies") for run in runs]
    for body in join_names(listed):
        for run, there, window in zip(runs, listed, windows):
            found = find_bending(run.results, body, window, superelements) if body in there else None
            if not found:
                continue
            from_modes = calc_peak(run.results, body, MOMENT, FROM_MODES, window)
            both = (from_modes and from_modes.value, calc_moment_difference(run.results, body, window))
            yield (
                body, run.label, f"{1e-3 * found.value:.4g}", f"{found.x:.3f}", f"{found.y:.3f}",
                f"{found.time:.3f}",
                *(MISSING if value is None else f"{1e-3 * value:.4g}" for value in both),
            )  # fmt: skip


def make_json(
    runs: Sequence[Run], windows: Sequence[Span], responses: Sequence[Response], points: Sequence[str],
    superelements: str | None,
) -> str:  # fmt: skip
    """All measures of runs and responses as JSON."""
    packed: list[dict[str, Any]] = []
    for run, window in zip(runs, windows):
        objects = list_objects(run.results, window, points, superelements)
        judged = find_points(run.results, points)
        packed.append({"label": run.label, "file": run.results.path, **describe_run(run.results, window),
                       "remarks": list_remarks(run.results, judged, window)
                       + list_moment_remarks(run.results, superelements)
                       + list_stress_remarks(run.results, list_stressed_bodies(run.results)),
                       "measures": pack_measures(calc_measures(objects))})  # fmt: skip
    for response in responses:
        packed.append({"label": response.label, "file": response.file.filename, **describe_response(response, points),
                       "measures": pack_measures(calc_measures(list_linear_objects(response, points)))})  # fmt: skip
    return json.dumps({"format": JSON_FORMAT, "version": JSON_VERSION, "runs": packed}, indent=1, ensure_ascii=False,
                      allow_nan=False)  # fmt: skip


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(__doc__, "tools/ride rigid=terrain_rigid.h5 '2 modes=terrain_2modes.h5' --points chassis.seat")
    parser.add_argument(
        "runs", metavar="[LABEL=]FILE", nargs="+", help="results or response file, and its name in the tables"
    )
    parser.add_argument(
        "--points", nargs="+", metavar="BODY.POINT", default=(),
        help="points whose vibration is judged, BODY.center_of_mass for a centre of mass (default: of a run the seats "
        "and the centres of mass of their bodies, without a seat those of all bodies; of a response all points in its "
        "file, origins of axles too)",
    )  # fmt: skip
    parser.add_argument("--from", dest="start", type=float, metavar="S", help="judge from this time, s")
    parser.add_argument("--to", dest="end", type=float, metavar="S", help="judge up to this time, s")
    parser.add_argument(
        "--superelements",
        metavar="FOLDER",
        help="folder of the superelement files, for the moments of bodies taken as rigid",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object with all measures in SI units")
    return parser.parse_args()


def check_arguments(arguments: argparse.Namespace, responses: Sequence[str]) -> None:
    """Throws InputError for an option of runs where there is none."""
    of_runs = {"--from": arguments.start, "--to": arguments.end, "--superelements": arguments.superelements}
    for name, value in of_runs.items():
        if len(responses) == len(arguments.runs) and value is not None:
            raise InputError(f"{name}: error: {split_label(responses[0])[1]} is a response, and the option is of runs")


def main() -> int:
    arguments = parse_arguments()
    files, response_files = part_files(arguments.runs)
    runs, responses = open_runs(files), open_responses(response_files)
    check_arguments(arguments, response_files)
    windows = [read_window(run.results, arguments.start, arguments.end) for run in runs]
    if arguments.json:
        print(make_json(runs, windows, responses, arguments.points, arguments.superelements))
        return 0
    points = [find_points(run.results, arguments.points) for run in runs]
    tables: list[tuple[Sequence[str], Iterator[tuple[str, ...]]]]
    tables = [(LINEAR, make_linear_rows(responses, arguments.points))]
    if runs:
        tables += [
            (COMFORT, make_comfort_rows(runs, points, windows)),
            (TRAVEL, make_travel_rows(runs, windows)),
            (CONTACT, make_contact_rows(runs, windows)),
            (BENDING, make_bending_rows(runs, windows, arguments.superelements)),
        ]
    text = [f"statistics over: {describe_spans(runs, windows)}"] if runs else []
    for response in responses:
        low, high = response.frequency[0], response.frequency[-1]
        text.append(f"{response.label}: linear, on its random road, from {low:g} to {high:g} Hz")
    doubts = list_doubts(runs)
    for response in responses:
        told = describe_response(response, arguments.points)
        doubts += [f"warning: {response.label}: {warning['text']}" for warning in told["warnings"]]
        doubts += [f"remark: {response.label}: {remark}" for remark in told["remarks"]]
    for run, some, window in zip(runs, points, windows):
        remarks = list_remarks(run.results, some, window) + list_moment_remarks(run.results, arguments.superelements)
        doubts += [f"remark: {run.label}: {remark}" for remark in remarks]
    if doubts:
        text.append("\n".join(doubts))
    for headings, rows in tables:
        cells = list(rows)
        if cells:
            text.append(format_table(headings, cells))
        if headings == BENDING and any(row[-1] != MISSING for row in cells):
            text.append(DIFFERENCE_NOTE)
    print("\n\n".join(text))
    return 0
