"""The model as it was run, from `/model/resolved` of a results file (dynamics/output/results.md): the input files'
values after `--set`, and the defaults.

Files of version 1 do not hold it. What needs it then throws an InputError that says so.
"""

from typing import Any, NamedTuple

import h5py
import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_texts, text_of
from sprung_tools.files.results_file import ResultsFile

ROOT = "model/resolved"
GROUND = "ground"


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
    return ROOT in results.file


def open_group(results: ResultsFile, name: str = "") -> h5py.Group:
    """Opens a group below /model/resolved. InputError if the file does not hold the model as run."""
    path = f"{ROOT}/{name}".rstrip("/")
    if not has_resolved_model(results):
        raise InputError(
            f"{results.path}: error: holds no '{ROOT}', the model as run, which files have from version 2 on: "
            "run it again"
        )
    if path not in results.file:
        raise InputError(f"{results.path}: error: no group '{path}'")
    return results.file[path]


def read_attributes(group: h5py.Group) -> dict[str, Any]:
    """Reads the attributes of a group without those that name units."""
    found: dict[str, Any] = {}
    for name, value in group.attrs.items():
        if name.endswith("_unit") or name in ("unit", "argument_unit"):
            continue
        found[name] = text_of(value) if isinstance(value, (bytes, str)) else value.item()
    return found


def read_settings(results: ResultsFile) -> dict[str, Any]:
    """Reads speed, duration, output step, statistics window and start, with `integrator` and `adaptivity` as dicts."""
    group = open_group(results, "settings")
    parts = {name: read_attributes(group[name]) for name in ("integrator", "adaptivity")}
    return read_attributes(group) | parts


def read_direction(results: ResultsFile) -> float:
    """Reads the direction of travel: 1 towards +x, -1 towards -x."""
    return float(read_attributes(open_group(results))["direction"])


def read_gravity(results: ResultsFile) -> Floats:
    """Reads the gravity [2] m/s²."""
    open_group(results)
    return read_numbers(results.file, f"{ROOT}/gravity")[0]


def read_road_settings(results: ResultsFile) -> dict[str, Any]:
    """Reads the shape of the road and its parameters; for a road from a table the file's name."""
    group = open_group(results, "road")
    return read_attributes(group) | read_attributes(group["parameters"])


def read_point(results: ResultsFile, name: str) -> Point:
    """Reads a point by its name body.point. InputError if there is none."""
    where = f"points/{name}"
    attributes = read_attributes(open_group(results, where))
    position, _ = read_numbers(results.file, f"{ROOT}/{where}/position")
    shapes: Floats = np.zeros((3, 0))
    if f"{ROOT}/{where}/shapes" in results.file:
        shapes, _ = read_numbers(results.file, f"{ROOT}/{where}/shapes")
    return Point(name, attributes["body"], position, int(attributes["node"]), shapes)


def read_points(results: ResultsFile, body: str) -> dict[str, Point]:
    """Reads all points of a body, or of the ground, by the part of their names after the dot."""
    names = sorted(open_group(results, "points"))
    points = (read_point(results, name) for name in names if name.partition(".")[0] == body)
    return {point.name.partition(".")[2]: point for point in points}


def read_elements(results: ResultsFile, group: str) -> dict[str, Element]:
    """Reads the `joints` or the `forces` by their names. The prescribed motions are among the joints."""
    elements: dict[str, Element] = {}
    for name, item in open_group(results, group).items():
        attributes = read_attributes(item)
        where = f"{ROOT}/{group}/{name}"
        points = zip(read_texts(results.file, f"{where}/point_roles"), read_texts(results.file, f"{where}/points"))
        elements[name] = Element(
            name,
            attributes["kind"],
            attributes["drawing"],
            bool(attributes["on_road"]),
            dict(points),
            read_attributes(item["parameters"]),
        )
    return elements
