"""The model as it was run, from `/model/resolved` of a results file (dynamics/output/results.md): the input files'
values after `--set`, and the defaults.

Files of version 1 do not hold it. What needs it then throws an InputError that says so.
"""

from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_texts
from sprung_tools.files.results_file import ResultsFile

ROOT = "model/resolved"
GROUND = "ground"
# The roles of the first points of an element that is drawn as that, and its parameters that are numbers. A coupled air
# spring has the points of its partner besides.
POINTS_OF = {"wheel": ("wheel",), "spring": ("a", "b"), "rod": ("a", "b"), "pin": ("a", "b")}
NUMBERS_OF = {"wheel": ("radius",)}
STOPS = {"compression_stop", "rebound_stop"}  # parameters that an element may have; they are numbers


class Point(NamedTuple):
    """A named point of a body, or of the ground."""

    name: str  # body.point
    body: str
    position: Floats  # [2] m, undeformed, from the origin of the body frame
    node: int  # 0-based node of the superelement with which it moves; -1: it moves with the body frame
    shapes: Floats  # [3×n] displacement and rotation by each of the body's modes of the run


class Element(NamedTuple):
    """A joint or a force element."""

    name: str
    kind: str
    drawing: str  # how a picture shows it: wheel, spring, rod, pin, none
    on_road: bool
    points: dict[str, str]  # role of the point ("a", "b", "wheel") → body.point
    parameters: dict[str, Any]  # numbers, texts and flags by name; without functions and lists


def has_resolved_model(results: ResultsFile) -> bool:
    """Whether a file holds the model as run."""
    return results.file.has_group(ROOT)


def find_group(results: ResultsFile, name: str = "") -> str:
    """Returns the path of a group below /model/resolved. InputError if the file does not hold the model as run, or if
    the group is missing."""
    path = f"{ROOT}/{name}".rstrip("/")
    if not has_resolved_model(results):
        raise InputError(
            f"{results.path}: error: holds no '{ROOT}', the model as run, which files have from version 2 on: "
            "run it again"
        )
    if not results.file.has_group(path):
        raise InputError(f"{results.path}: error: no group '{path}'")
    return path


def read_attributes(results: ResultsFile, name: str = "") -> dict[str, Any]:
    """Reads the attributes of a group below /model/resolved, which are numbers and texts, without those that name
    units."""
    group = find_group(results, name)
    found: dict[str, Any] = {}
    for key, value in results.file.attributes(group).items():
        if key.endswith("_unit") or key in ("unit", "argument_unit"):
            continue
        if not isinstance(value, (int, float, str)) or value != value:
            raise InputError(f"{results.path}: error: attribute '{key}' of '{group}' is neither a number nor a text")
        found[key] = value
    return found


def read_settings(results: ResultsFile) -> dict[str, Any]:
    """Reads speed, duration, output step, statistics window and start, with `integrator` and `adaptivity` as dicts."""
    parts = {name: read_attributes(results, f"settings/{name}") for name in ("integrator", "adaptivity")}
    return read_attributes(results, "settings") | parts


def read_direction(results: ResultsFile) -> float:
    """Reads the direction of travel: 1 towards +x, -1 towards -x."""
    return float(read_attributes(results)["direction"])


def read_gravity(results: ResultsFile) -> Floats:
    """Reads the gravity [2] m/s²."""
    find_group(results)
    return read_numbers(results.file, f"{ROOT}/gravity")[0]


def read_road_settings(results: ResultsFile) -> dict[str, Any]:
    """Reads the shape of the road and its parameters; for a road from a table the file's name."""
    return read_attributes(results, "road") | read_attributes(results, "road/parameters")


def read_point(results: ResultsFile, name: str) -> Point:
    """Reads a point by its name body.point. InputError if there is none."""
    where = f"points/{name}"
    attributes = read_attributes(results, where)
    position, _ = read_numbers(results.file, f"{ROOT}/{where}/position")
    shapes: Floats = np.zeros((3, 0))
    if results.file.has_dataset(f"{ROOT}/{where}/shapes"):
        shapes, _ = read_numbers(results.file, f"{ROOT}/{where}/shapes")
    point = Point(name, attributes["body"], position, int(attributes["node"]), shapes)
    check_point(results, f"{ROOT}/{where}", point)
    return point


def read_points(results: ResultsFile, body: str) -> dict[str, Point]:
    """Reads all points of a body, or of the ground, by the part of their names after the dot."""
    names = results.names(find_group(results, "points"))
    points = (read_point(results, name) for name in names if name.partition(".")[0] == body)
    return {point.name.partition(".")[2]: point for point in points}


def read_elements(results: ResultsFile, group: str) -> dict[str, Element]:
    """Reads the `joints` or the `forces` by their names. The prescribed motions are among the joints."""
    elements: dict[str, Element] = results.kept.get(group, {})
    if elements:
        return elements
    for name in results.names(find_group(results, group)):
        attributes = read_attributes(results, f"{group}/{name}")
        where = f"{ROOT}/{group}/{name}"
        points = zip(read_texts(results.file, f"{where}/point_roles"), read_texts(results.file, f"{where}/points"))
        element = Element(
            name,
            attributes["kind"],
            attributes["drawing"],
            bool(attributes["on_road"]),
            dict(points),
            read_attributes(results, f"{group}/{name}/parameters"),
        )
        check_element(results, where, element)
        elements[name] = element
    results.kept[group] = elements
    return elements


def read_element(results: ResultsFile, group: str, name: str) -> Element:
    """Reads one of the `joints` or the `forces`. InputError if the model as run does not have it."""
    find_group(results, f"{group}/{name}")
    return read_elements(results, group)[name]


def check_point(results: ResultsFile, where: str, point: Point) -> None:
    """Throws InputError if a point does not fit to its body's superelement: its node, or the number of its shapes."""
    modes = results.num_modes(point.body)
    if point.shapes.shape[1] != modes:
        raise InputError(
            f"{results.path}: error: '{where}' has shapes of {point.shapes.shape[1]} modes, its body has {modes}"
        )
    nodes = results.file.shape(f"model/superelements/{results.superelement(point.body)}/node_positions")
    if not -1 <= point.node < (nodes[0] if nodes else 0):
        raise InputError(f"{results.path}: error: '{where}' is at node {point.node}, which its body does not have")


def check_element(results: ResultsFile, where: str, element: Element) -> None:
    """Throws InputError if an element lacks what its drawing needs: its points, the radius of a wheel."""
    expected = POINTS_OF.get(element.drawing, tuple(element.points))
    if tuple(element.points)[: len(expected)] != expected:
        roles = ", ".join(element.points) or "no points"
        raise InputError(
            f"{results.path}: error: '{where}' has the point roles {roles}, expected {', '.join(expected)}"
        )
    needed = NUMBERS_OF.get(element.drawing, ())
    for key in {*needed, *STOPS.intersection(element.parameters)}:
        if not isinstance(element.parameters.get(key), (int, float)):
            raise InputError(f"{results.path}: error: '{where}/parameters' has no attribute '{key}' that is a number")
