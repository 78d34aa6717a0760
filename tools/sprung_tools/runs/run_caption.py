"""The caption under a picture: what its runs have in common, so that the picture can be judged alone."""

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.random_road import read_random_road
from sprung_tools.model.resolved_model import has_resolved_model, read_elements, read_road_settings, read_settings

LINE_LENGTH = 118  # characters that fit under a picture
# Keys of a road that its description has, with words and units.
ROAD_NUMBERS = {
    "rms": ("r.m.s.", " m"), "density": ("density at 0.1 1/m", " m³"), "length": ("length", " m"),
    "height": ("height", " m"), "seed": ("seed", ""),
}  # fmt: skip


def make_caption(results: Sequence[ResultsFile], remarks: Sequence[str] = ()) -> str:
    """Makes the caption of several runs: speed, road, integrator and sampling, as far as all of them share it.

    remarks: further parts. Returns lines of text; what a file does not hold is left out.
    """
    lists = [list_parts(one) for one in results]
    shared = [part for part in lists[0] if all(part in other for other in lists[1:])]
    unbroken = [part.replace(" ", "\N{NO-BREAK SPACE}") for part in (*shared, *remarks)]
    lines = textwrap.fill("; ".join(unbroken), LINE_LENGTH, break_long_words=False)
    return lines.replace("\N{NO-BREAK SPACE}", " ")


def list_parts(results: ResultsFile) -> list[str]:
    """The caption's parts of one run, in order; for a file of version 1 only the sampling."""
    parts = []
    if has_resolved_model(results):
        settings = read_settings(results)
        on_road = any(force.on_road for force in read_elements(results, "forces").values())
        if on_road or settings["speed"] != 0.0:
            parts.append(f"initial speed {settings['speed']:g} m/s")
        if on_road:
            parts.append(describe_road(results))
        parts.append("integrator: " + describe_integrator(settings["integrator"]))
    step = (results.time[-1] - results.time[0]) / (results.time.size - 1)
    parts.append(f"a sample every {1e3 * step:g} ms")
    return parts


def describe_integrator(settings: Mapping[str, Any]) -> str:
    """`method exponential, relative tolerance 1e-06`. An unlimited step, and a step that is not fixed, are left out."""
    shown = {key: value for key, value in settings.items() if value not in (math.inf, 0.0)}
    return ", ".join(f"{key.replace('_', ' ')} {value}" for key, value in shown.items())


def describe_road(results: ResultsFile) -> str:
    """`road: half-sine, length 0.4 m, height 0.2 m`, `road: random, ISO 8608 class C, length 500 m, seed 7`; for a road
    from a table its file."""
    road = read_road_settings(results) | read_random_road(results)
    parts = [f"road: {road['shape']}"]
    if isinstance(road.get("class"), str):
        parts.append(f"ISO 8608 class {road['class']}")
    for key, (name, unit) in ROAD_NUMBERS.items():
        if isinstance(road.get(key), (int, float)):
            parts.append(f"{name} {road[key]:g}{unit}")
    if road.get("file"):
        parts.append(road["file"])
    return ", ".join(parts)
