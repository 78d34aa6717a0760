"""Stresses at the extreme fibres of a body's sections.

    σ = N/A − M/W on the left of an element's direction, N/A + M/W on its right                               (1)

N and M are axial force and bending moment of a section (dynamics/output/results.md), A and W its area and section
modulus, W = I/e with the distance e of the extreme fibre from the centroid. They are nominal stresses of the beam:
without those of shear, and without what welds, holes and corners add. The springs of a design, those of its foundations
too, are elements without a section, A = W = 0, and have no stresses.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags, Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.runs.stations import place_stations, read_stations
from sprung_tools.runs.stored_histories import find_row_step

FROM_LOADS, FROM_MODES = "loads", "modes"
ENDINGS = {FROM_LOADS: "_from_loads", FROM_MODES: ""}  # of the datasets
SIDES = ("left", "right")


class SectionStress(NamedTuple):
    """The stresses of a body over time.

    positions: of each station in the body frame [stations × 2] m; along: its place in a diagram [stations] m, and axis
    says what it is; elements: the element of each station, from 1, where springs count but have no stations; sides:
    which way each of its two fibres lies from the centroid, such as "+y" [stations × 2]; stress: of these fibres
    [n × stations × 2] Pa.
    """

    positions: Floats
    along: Floats
    axis: str
    elements: Integers
    sides: list[tuple[str, str]]
    stress: Floats

    def name_place(self, station: int) -> str:
        """Where a station is, in the axes of its body."""
        x, y = self.positions[station]
        return f"({x + 0.0:.4g}, {y + 0.0:.4g}) m"


def list_sources(results: ResultsFile, body: str) -> list[str]:
    """Of what the file has the loads of a body's sections: from its loads, from its modes."""
    return [source for source, ending in ENDINGS.items() if results.has(f"recovery/{body}/moment{ending}")]


def list_stressed_bodies(results: ResultsFile) -> list[str]:
    """The bodies whose stresses the file tells."""
    return [body for body in results.names("recovery") if not find_gap(results, body)]


def find_gap(results: ResultsFile, body: str) -> str:
    """What the file lacks for a body's stresses; empty if it has all."""
    if not list_sources(results, body):
        return f"no loads of the sections of '{body}'"
    sizes = (("area", "areas"), ("section_modulus", "section moduli"))
    for name, what in sizes:
        if not results.file.has_dataset(f"recovery/{body}/{name}"):
            return f"no {what} of the sections of '{body}': sprung-reduce build makes its superelement with them"
    has_section = find_sections(results, body)
    if not np.any(has_section):
        return f"no sections of '{body}': all its elements are springs"
    for name, what in sizes:
        if np.any(read_numbers(results.file, f"recovery/{body}/{name}")[0][has_section] <= 0.0):
            return f"not all {what} of the sections of '{body}': its design needs 'section_modulus' or a 'shape'"
    return ""


def find_sections(results: ResultsFile, body: str) -> Flags:
    """Which stations of a body have a section, those of all elements but springs [stations]."""
    area, modulus = (read_numbers(results.file, f"recovery/{body}/{name}")[0] for name in ("area", "section_modulus"))
    is_spring = np.all((np.stack([area, modulus]) == 0.0).reshape(2, -1, 2), axis=(0, 2))
    return np.repeat(~is_spring, 2)


def name_datasets(body: str, source: str) -> list[str]:
    """The datasets of axial force and bending moment of a body."""
    return [f"recovery/{body}/{name}{ENDINGS[source]}" for name in ("axial", "moment")]


def calc_section_stress(results: ResultsFile, body: str, source: str) -> SectionStress:
    """The stresses of a body, from its loads or from its modes. The stations are in the order of `along`. InputError if
    the file lacks something."""
    gap = find_gap(results, body)
    if gap:
        raise InputError(f"{results.path}: error: {gap}")
    stations = read_stations(results, body)
    others = [f"recovery/{body}/{name}" for name in ("area", "section_modulus")]
    axial, moment, area, modulus = (
        read_numbers(results.file, name)[0] for name in (*name_datasets(body, source), *others)
    )
    layout = place_stations(stations)
    has_section = find_sections(results, body)[layout.order]
    order, along = layout.order[has_section], layout.along[has_section]
    mean, bending = axial[:, order] / area[order], moment[:, order] / modulus[order]
    sides = [name_sides(*stations[[2 * element, 2 * element + 1]]) for element in order // 2]
    stress = np.stack([mean - bending, mean + bending], axis=-1)
    return SectionStress(stations[order], along, layout.axis, order // 2 + 1, sides, stress)


def list_stress_remarks(results: ResultsFile, bodies: Iterable[str]) -> list[str]:
    """That the stresses of bodies are those of few rows, if they are."""
    return [
        f"stresses of '{body}' are those of rows every {1e3 * step:g} ms: what lies between is not seen"
        for body in bodies
        if (step := find_row_step(results, name_datasets(body, list_sources(results, body)[0])[1])) > 0.0
    ]


def name_sides(first: Floats, second: Floats) -> tuple[str, str]:
    """Which way the left and the right of an element lie, by the axis of the body frame closest to it."""
    x, y = second - first
    if abs(x) >= abs(y):
        return ("+y", "-y") if x > 0.0 else ("-y", "+y")
    return ("-x", "+x") if y > 0.0 else ("+x", "-x")
