"""The caption under a picture: what its runs have in common, so that the picture can be judged alone."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.model_texts import read_run_file

LINE_LENGTH = 118  # characters that fit under a picture


def make_caption(results: Sequence[ResultsFile], remarks: Sequence[str] = ()) -> str:
    """Makes the caption of several runs: speed, road, integrator and sampling, as far as all of them share it.

    remarks: further parts. Returns lines of text; what a file does not hold is left out.
    """
    lists = [list_parts(one) for one in results]
    shared = [part for part in lists[0] if all(part in other for other in lists[1:])]
    unbroken = [part.replace(" ", "\N{NO-BREAK SPACE}") for part in (*shared, *remarks)]
    return textwrap.fill("; ".join(unbroken), LINE_LENGTH).replace("\N{NO-BREAK SPACE}", " ")


def list_parts(results: ResultsFile) -> list[str]:
    """The caption's parts of one run, in order."""
    run = read_run_file(results)
    parts = []
    if "speed" in run:
        parts.append(f"initial speed {run['speed']:g} m/s")
    if "road" in run:
        parts.append(describe_road(run["road"]))
    if "integrator" in run:
        settings = [f"{key.replace('_', ' ')} {value}" for key, value in run["integrator"].items()]
        parts.append("integrator: " + ", ".join(settings))
    step = (results.time[-1] - results.time[0]) / (results.time.size - 1)
    parts.append(f"a sample every {1e3 * step:g} ms")
    return parts


def describe_road(road: Mapping[str, Any]) -> str:
    """Describes a run file's table [road]: `road: half-sine, length 0.4 m, height 0.2 m`. Its numbers are lengths in
    metres."""
    parts = [f"road: {road.get('shape', 'flat')}"]
    for key, value in road.items():
        if isinstance(value, (int, float)) and key != "start":
            parts.append(f"{key} {value:g} m")
        elif key == "file":
            parts.append(str(value))
    return ", ".join(parts)
