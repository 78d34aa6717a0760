"""Whether the names of a study's measures mean something of its vehicle: a point, a force or a body that it does not
have is a slip, which every run would have."""

from collections.abc import Iterable, Sequence
from difflib import get_close_matches

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import read_elements
from sprung_tools.runs.fatigue_measures import FATIGUE, FATIGUE_UNITS
from sprung_tools.runs.labelled_responses import Response
from sprung_tools.runs.measures import UNITS_OF, find_points
from sprung_tools.runs.ride_of_response import list_points
from sprung_tools.runs.section_stress import ENDINGS

SLIP = "measures: error: "  # what the text of such an error begins with
PARTNER = " partner"  # of the second of two coupled springs


def check_names(results: ResultsFile, wanted: Iterable[str]) -> None:
    """InputError for the first measure without a wildcard that no run of this vehicle has."""
    forces, bodies = list(read_elements(results, "forces")), results.names("model/bodies")
    there = {"suspensions": ("suspension", forces), "tyres": ("tyre", forces), "loads": ("body", bodies),
             "stresses": ("body", bodies), FATIGUE: ("body", bodies)}  # fmt: skip
    units = {**UNITS_OF, FATIGUE: FATIGUE_UNITS}
    for name in (one for one in wanted if "*" not in one):
        group, *middle, measure = name.split("/")
        thing = "/".join(middle)
        if group == FATIGUE:
            thing, _, source = thing.rpartition("/")
            check_name(source, [f"from_{one}" for one in ENDINGS], f"'{name}': stresses are")
        if group in ("points", "bands"):
            check_point(results, thing)
        elif group in there:
            kind, names = there[group]
            check_name(thing.removesuffix(PARTNER), names, f"the vehicle has no {kind}")
        if group in units:
            check_name(measure, list(units[group]), f"{group}/… has no measure")


def check_point(results: ResultsFile, point: str) -> None:
    """InputError for a point BODY.POINT that the vehicle does not have."""
    (folder,) = find_points(results, [point])
    if not results.has(f"{folder}/acceleration"):
        check_name(point, [one for one in results.names("points") if one != point], "the vehicle has no point")


def check_response_points(response: Response, points: Iterable[str]) -> None:
    """InputError for the first point whose motion a response does not have."""
    for point in points:
        check_name(point, list_points(response), "the response has no point")


def check_name(name: str, there: Sequence[str], what: str) -> None:
    """InputError if a name is not there, with the one that is like it."""
    if name not in there:
        like = get_close_matches(name, there, n=1)
        raise InputError(f"{SLIP}{what} '{name}'" + (f" (did you mean '{like[0]}'?)" if like else ""))
