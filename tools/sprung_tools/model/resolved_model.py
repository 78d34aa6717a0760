"""The model as it was run, from `/model/resolved` of a results file (dynamics/output/results.md): after `--set` and
defaults, whatever the input files say.

Files of version 1 do not hold it; what needs it then raises an InputError that says so.
"""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers, read_texts, text_of

ROOT = "model/resolved"
GROUND = "ground"


class Point(NamedTuple):
    """A named point of a body, or of the ground."""

    name: str  # body.point
    body: str
    position: np.ndarray  # [2] m, undeformed, from the origin of the body frame
    node: int  # 0-based, of the superelement, with which it moves; -1: with the body frame
    shapes: np.ndarray  # [3×n] displacement and rotation by the body's modes of the run


class Element(NamedTuple):
    """A joint or a force element."""

    name: str
    kind: str
    drawing: str  # how a picture shows it: wheel, spring, rod, pin, none
    on_road: bool
    points: dict  # what a point is to it ("a", "b", "wheel") → body.point
    parameters: dict  # numbers, texts and flags by name; functions and lists are left out


def has_resolved_model(results):
    return ROOT in results.file


def open_group(results, name=""):
    """A group below /model/resolved. InputError if the file does not hold the model as run."""
    path = f"{ROOT}/{name}".rstrip("/")
    if not has_resolved_model(results):
        raise InputError(
            f"{results.path}: error: holds no '{ROOT}', the model as run, which files have from version 2 on: "
            "run it again"
        )
    if path not in results.file:
        raise InputError(f"{results.path}: error: no group '{path}'")
    return results.file[path]


def read_attributes(group):
    """The attributes of a group: texts as str, numbers as Python's; units are left out."""
    found = {}
    for name, value in group.attrs.items():
        if name.endswith("_unit") or name in ("unit", "argument_unit"):
            continue
        found[name] = text_of(value) if isinstance(value, (bytes, str)) else value.item()
    return found


def read_settings(results):
    """Speed, duration, output step, statistics window and start, with `integrator` and `adaptivity` as dicts."""
    group = open_group(results, "settings")
    parts = {name: read_attributes(group[name]) for name in ("integrator", "adaptivity")}
    return read_attributes(group) | parts


def read_direction(results):
    """+1 for a vehicle that travels towards +x, -1 towards -x."""
    return float(read_attributes(open_group(results))["direction"])


def read_gravity(results):
    """[2] m/s²"""
    open_group(results)
    return read_numbers(results.file, f"{ROOT}/gravity")[0]


def read_road_settings(results):
    """Shape of the road and what it was made with, as a dict; of a road from a table its file's name."""
    group = open_group(results, "road")
    return read_attributes(group) | read_attributes(group["parameters"])


def read_point(results, name):
    """A point by its name body.point. InputError if there is none."""
    where = f"points/{name}"
    attributes = read_attributes(open_group(results, where))
    position, _ = read_numbers(results.file, f"{ROOT}/{where}/position")
    shapes = np.zeros((3, 0))
    if f"{ROOT}/{where}/shapes" in results.file:
        shapes, _ = read_numbers(results.file, f"{ROOT}/{where}/shapes")
    return Point(name, attributes["body"], position, int(attributes["node"]), shapes)


def read_points(results, body):
    """All points of a body, or of the ground, by the part of their names behind the dot."""
    names = sorted(open_group(results, "points"))
    points = (read_point(results, name) for name in names if name.partition(".")[0] == body)
    return {point.name.partition(".")[2]: point for point in points}


def read_elements(results, group):
    """The `joints` or `forces`, prescribed motions among the joints, by name."""
    elements = {}
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
