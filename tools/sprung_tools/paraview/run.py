"""A run for ParaView: a VTU file for each instant, bodies as lines where they are."""

import os
from collections.abc import Sequence
from pathlib import Path

import meshio
import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import ResultsFile, open_results
from sprung_tools.model.vehicle_shape import DrawnBody, calc_motion, read_bodies
from sprung_tools.paraview.vtu_file import RESULTANTS, in_space
from sprung_tools.runs.labelled_runs import Run, describe, samples_between
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.signals.spans import OptionalSpan
from sprung_tools.terminal.progress_bar import Progress


def choose_samples(results: ResultsFile, span: OptionalSpan, every: float | None) -> Integers:
    """Chooses the samples to write within a span of time: the first of each step of `every` seconds, to a thousandth of
    the time between samples; all samples if `every` is None."""
    inside = np.flatnonzero(samples_between(results, *span))
    if every is None or inside.size < 2:
        return inside
    time = results.time[inside]
    step = np.floor((time - time[0] + 1e-3 * np.median(np.diff(time))) / every)
    return inside[np.unique(step, return_index=True)[1]]


def read_resultants(results: ResultsFile, bodies: Sequence[DrawnBody], samples: Integers) -> dict[str, Floats]:
    """Reads the resultants at the first and second end of every line: name → [k×L×2]. Lines of rigid bodies and offsets
    have NaN."""
    total = sum(len(body.lines) for body in bodies)
    found: dict[str, Floats] = {name: np.full((len(samples), total, 2), np.nan) for name in RESULTANTS.values()}
    first = 0
    for body in bodies:
        for what, name in RESULTANTS.items():
            if results.has(f"recovery/{body.name}/{what}"):
                values = read_numbers(results.file, f"recovery/{body.name}/{what}")[0][samples]
                if values.shape[1] != 2 * body.num_elements:
                    raise InputError(
                        f"{results.path}: error: 'recovery/{body.name}/{what}' has {values.shape[1]} stations, "
                        f"expected {2 * body.num_elements}: both ends of {body.num_elements} elements"
                    )
                found[name][:, first : first + body.num_elements] = values.reshape(len(samples), -1, 2)
        first += len(body.lines)
    return found


def export_run(
    path: str | Path, folder: str, span: OptionalSpan, every: float | None, magnification: float
) -> list[tuple[float, str]]:
    """Writes a VTU file for each instant that choose_samples() takes. Returns what the PVD file lists."""
    with open_results(path) as results:
        bodies = read_bodies(results)
        samples = choose_samples(results, span, every)
        motions = [calc_motion(results, body, samples, magnification) for body in bodies]
        plain = [calc_motion(results, body, samples, 0.0).position for body in bodies]
        places = [calc_motion(results, body, samples).position for body in bodies]
        resultants = read_resultants(results, bodies, samples)
        time = results.time[samples]
        doubts = list_doubts([Run(describe(results), results)])
    starts = np.cumsum([0, *(len(body.places) for body in bodies)])
    lines = np.concatenate([body.lines + start for body, start in zip(bodies, starts)])
    number = np.concatenate([np.full(len(body.lines), k) for k, body in enumerate(bodies, start=1)])

    def gather(arrays: Sequence[Floats]) -> Floats:
        return in_space(np.concatenate(arrays, axis=1))

    position = gather([motion.position for motion in motions])
    data = {
        "velocity": gather([motion.velocity for motion in motions]),
        "acceleration": gather([motion.acceleration for motion in motions]),
        "deflection": gather([place - rigid for place, rigid in zip(places, plain)]),
    }
    entries = []
    with Progress("instants", len(samples)) as progress:
        for k, instant in enumerate(time):
            mesh = meshio.Mesh(
                position[k],
                [("line", lines)],
                point_data={name: values[k] for name, values in data.items()},
                cell_data={"body": [number], **{name: [values[k]] for name, values in resultants.items()}},
            )
            name = f"instant_{k:06d}.vtu"
            mesh.write(os.path.join(folder, name), binary=True)
            entries.append((float(instant), name))
            progress.step()
    for doubt in doubts:
        print(doubt)
    print("bodies: " + ", ".join(f"{k} {body.name}" for k, body in enumerate(bodies, start=1)))
    return entries
