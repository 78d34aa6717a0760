"""Which histories of a run its results file does not hold, or not at every output, because of [output] in the run file.
"""

from collections.abc import Iterator

import numpy as np

from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.force_channels import list_force_channels
from sprung_tools.model.resolved_model import ROOT, has_resolved_model

RESULTANTS = "stress resultants"
MOST_NAMED = 4  # names in a list; of more their number is given


def list_gaps(results: ResultsFile) -> list[str]:
    """What is not stored, and what is stored less often, as texts; without those points whose motion follows from that
    of their bodies. Empty for files of version 1."""
    if not has_resolved_model(results):
        return []
    return [*list_missing(results), *list_coarse(results)]


def list_missing(results: ResultsFile) -> Iterator[str]:
    """The histories that are not stored and cannot be computed."""
    bodies = results.names("model/bodies")
    joints, forces = (results.names(f"{ROOT}/{group}") for group in ("joints", "forces"))
    flexible = [body for body in bodies if results.num_modes(body)]
    points = [one for one in results.names(f"{ROOT}/points")
              if results.file.attribute(f"{ROOT}/points/{one}", "body", str, "") in bodies]  # fmt: skip

    def has_loads(name: str) -> bool:
        return any(one.startswith("on_") for one in results.names(f"forces/{name}"))

    groups = {
        "motion of bodies": (bodies, lambda name: results.has(f"bodies/{name}/position")),
        "motion of points": (points, lambda name: results.has(f"points/{name}/position")),
        "joints": (joints, lambda name: results.has(f"joints/{name}/reaction")),
        "forces": (forces, lambda name: bool(list_force_channels(results, name))),
        "loads of forces on their bodies": (forces, has_loads),
        RESULTANTS: (flexible, lambda name: results.has(f"recovery/{name}/moment")),
    }
    for what, (names, is_there) in groups.items():
        missing = [name for name in names if not is_there(name)]
        if missing:
            yield f"{what} not stored: {shorten(missing, len(names))}"


def shorten(names: list[str], total: int) -> str:
    """The names in a list; `all`, or how many there are of many."""
    if len(names) == total:
        return "all"
    return ", ".join(names) if len(names) <= MOST_NAMED else f"{len(names)} of {total}"


def list_coarse(results: ResultsFile, *, with_resultants: bool = True) -> Iterator[str]:
    """The histories that are not stored at every output. with_resultants: also forces and moments of sections."""
    step = float(np.median(np.diff(results.time)))
    examples = {
        "motion of bodies": ("bodies", "{}/acceleration"), "joints": ("joints", "{}/reaction"),
        RESULTANTS: ("recovery", "{}/moment"), "motion of points": ("points", "{}/acceleration"),
    }  # fmt: skip
    if not with_resultants:
        del examples[RESULTANTS]
    for what, (group, pattern) in examples.items():
        every = {results.file.every(f"{group}/" + pattern.format(name)) for name in results.file.names(group)}
        yield from describe_steps(what, every, step)
    for what in ("bodies", "points"):
        motions = [[results.file.every(f"{what}/{name}/{one}") for one in ("position", "acceleration")]
                   for name in results.file.names(what)]  # fmt: skip
        coarser = {position for position, acceleration in motions if position != acceleration}
        yield from describe_steps(f"positions and velocities of {what}", coarser, step)
    forces = results.file.names("forces")
    channels = {one.quantity for name in forces for one in list_force_channels(results, name)}
    yield from describe_steps("forces", {results.file.every(quantity) for quantity in channels}, step)
    loads = {f"forces/{name}/{one}" for name in forces for one in results.names(f"forces/{name}") if "on_" in one}
    yield from describe_steps("loads of forces on their bodies", {results.file.every(one) for one in loads}, step)


def find_row_step(results: ResultsFile, quantity: str) -> float:
    """The time between the stored rows of a history that is not stored at every output [s]; 0 if it is."""
    every = results.every(quantity)
    return every * float(np.median(np.diff(results.time))) if every > 1 else 0.0


def describe_steps(what: str, every: set[int], step: float) -> Iterator[str]:
    """How often histories are stored; nothing if it is at every output."""
    coarse = sorted(one for one in every if one > 1)
    if coarse:
        yield f"{what} stored every {', '.join(f'{1e3 * one * step:g}' for one in coarse)} ms"
