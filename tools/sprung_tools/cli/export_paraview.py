"""Writes a superelement's modes, or a run as a moving vehicle, for ParaView: VTU files and a PVD file that lists them.

A superelement gives one file for each mode: the frame bent by it, with the vectors `displacement` and `rotation`. A run
gives one file for each instant: bodies as lines where they are, with `velocity`, `acceleration`, `deflection` at their
nodes and the beam resultants at both ends of each element (first, second)."""

import math
import os
import re
import shutil
from urllib.parse import quote

import meshio
import numpy as np

from sprung_tools.files.results_file import ResultsError, open_hdf5, open_results, read_numbers, read_texts
from sprung_tools.model.vehicle_shape import calc_motion, read_bodies
from sprung_tools.runs.labelled_runs import samples_between
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.progress_bar import Progress

SUPERELEMENT, RESULTS = "sprung-superelement", "sprung-results"
LIST = "list.pvd"
OURS = re.compile(r"(mode|instant)_\d+\.vtu")  # the files in the folder
MODE_SIZE = 0.1  # of the frame's extent: the largest displacement that a mode is drawn with
RESULTANTS = {"axial": "axial_force", "shear": "shear_force", "moment": "bending_moment"}


def in_space(vectors):
    """[… × 2] → [… × 3] with z = 0."""
    return np.concatenate([vectors, np.zeros((*vectors.shape[:-1], 1))], axis=-1)


def write_collection(path, entries):
    """The PVD file: (time or mode number, name of the VTU file) each."""
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">',
        "<Collection>",
    ]
    lines += [f'<DataSet timestep="{value:.9g}" part="0" file="{name}"/>' for value, name in entries]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([*lines, "</Collection>", "</VTKFile>", ""]))


def export_modes(path, folder, wanted, magnification):
    """One VTU file for each mode, its displacements `magnification` times as large as usual. Returns what the PVD file lists. ResultsError for a mode that is not there."""
    with open_hdf5(path, SUPERELEMENT, 2) as file:
        places, _ = read_numbers(file, "nodes/position")
        elements = read_numbers(file, "elements/node")[0].astype(int)
        shapes, _ = read_numbers(file, "modes/shape")
        frequency, _ = read_numbers(file, "modes/frequency")
        resultants, _ = read_numbers(file, "resultants")
        sections = read_texts(file, "elements/section")
    numbers = list(dict.fromkeys(wanted or range(1, frequency.size + 1)))
    for number in numbers:
        if not 1 <= number <= frequency.size:
            raise ResultsError(f"{path}: error: no mode {number}; the file has modes 1 to {frequency.size}")
    kinds = sorted(set(sections))
    extent = np.linalg.norm(np.ptp(places, axis=0))
    entries = []
    with Progress("modes", len(numbers)) as progress:
        for number in numbers:
            shape = shapes[:, :, number - 1]
            scale = magnification * MODE_SIZE * extent / np.max(np.abs(shape[:, :2]))
            turn = np.zeros((len(places), 3))
            turn[:, 2] = scale * shape[:, 2]
            ends = scale * resultants[:, :, number - 1].reshape(-1, 2, 3)
            cell_data = {name: [ends[:, :, k]] for k, name in enumerate(RESULTANTS.values())}
            cell_data["section"] = [np.array([kinds.index(name) + 1 for name in sections])]
            mesh = meshio.Mesh(
                in_space(places + scale * shape[:, :2]),
                [("line", elements)],
                point_data={"displacement": in_space(scale * shape[:, :2]), "rotation": turn},
                cell_data=cell_data,
            )
            name = f"mode_{number:03d}.vtu"
            mesh.write(os.path.join(folder, name), binary=True)
            entries.append((number, name))  # not its frequency: ParaView takes equal times for one
            progress.step()
    print("sections: " + ", ".join(f"{k} {name}" for k, name in enumerate(kinds, start=1)))
    return entries


def choose_samples(results, arguments):
    """The samples to write: the first of each step of --every seconds, to a thousandth of a step."""
    inside = np.flatnonzero(samples_between(results, arguments.start, arguments.end))
    if arguments.every is None:
        return inside
    time = results.time[inside]
    step = np.floor((time - time[0]) / arguments.every + 1e-3)
    return inside[np.unique(step, return_index=True)[1]]


def read_resultants(results, bodies, samples):
    """Name → [k×L×2] at the first and second end of every line; NaN where there is none (rigid bodies, offsets)."""
    total = sum(len(body.lines) for body in bodies)
    found = {name: np.full((len(samples), total, 2), np.nan) for name in RESULTANTS.values()}
    first = 0
    for body in bodies:
        for what, name in RESULTANTS.items():
            if results.has(f"recovery/{body.name}/{what}"):
                values = read_numbers(results.file, f"recovery/{body.name}/{what}")[0][samples]
                found[name][:, first : first + body.num_elements] = values.reshape(len(samples), -1, 2)
        first += len(body.lines)
    return found


def export_run(path, folder, arguments):
    """One VTU file for each instant. Returns what the PVD file lists."""
    with open_results(path) as results:
        bodies = read_bodies(results)
        samples = choose_samples(results, arguments)
        motions = [calc_motion(results, body, samples, arguments.magnify) for body in bodies]
        plain = [calc_motion(results, body, samples, 0.0).position for body in bodies]
        places = [calc_motion(results, body, samples).position for body in bodies]
        resultants = read_resultants(results, bodies, samples)
        time = results.time[samples]
    starts = np.cumsum([0, *(len(body.places) for body in bodies)])
    lines = np.concatenate([body.lines + start for body, start in zip(bodies, starts)])
    number = np.concatenate([np.full(len(body.lines), k) for k, body in enumerate(bodies, start=1)])

    def gather(arrays):
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
    print("bodies: " + ", ".join(f"{k} {body.name}" for k, body in enumerate(bodies, start=1)))
    return entries


def check_target(path, stem):
    """ResultsError if the folder is there and holds anything but what this tool writes, which it would take away."""
    if not os.path.lexists(stem):
        return
    strange = [stem] if not os.path.isdir(stem) else [name for name in os.listdir(stem) if not OURS.fullmatch(name)]
    if strange:
        raise ResultsError(
            f"{path}: error: '{stem}' is there and is not of this tool (it holds {strange[0]}); choose another name"
        )


def write_folder(path, arguments):
    """Writes NAME.pvd and the folder NAME beside it, whole or not at all. ResultsError if they cannot be written."""
    stem = path.removesuffix(".pvd")
    check_target(path, stem)
    unfinished = os.path.join(os.path.dirname(stem), f".unfinished-{os.getpid()}-{os.path.basename(stem)}")
    try:
        os.mkdir(unfinished)
        if arguments.is_run:
            entries = export_run(arguments.file, unfinished, arguments)
        else:
            entries = export_modes(arguments.file, unfinished, arguments.modes, arguments.magnify)
        folder = quote(os.path.basename(stem))
        write_collection(os.path.join(unfinished, LIST), [(value, f"{folder}/{name}") for value, name in entries])
        if os.path.lexists(stem):
            shutil.rmtree(stem)
        os.rename(unfinished, stem)
        os.replace(os.path.join(stem, LIST), path)
    except OSError as error:
        raise ResultsError(f"{path}: error: cannot write ({error})") from error
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return len(entries)


def find_format(path):
    """Whether a file is a run (else a superelement). ResultsError if it is neither."""
    try:
        open_hdf5(path, RESULTS, 1).close()
        return True
    except ResultsError as error:
        if f"format is '{SUPERELEMENT}'" not in str(error):
            raise
    return False


def check_arguments(arguments):
    """ResultsError for a value that makes no sense, or that the file's kind has no use for."""
    if not os.path.splitext(os.path.basename(arguments.output))[1] == ".pvd":
        raise ResultsError(f"{arguments.output}: error: the output's name must end in .pvd")
    if arguments.every is not None and not 0.0 < arguments.every < math.inf:
        raise ResultsError(f"--every: error: {arguments.every:g}, expected a time > 0 s")
    if not math.isfinite(arguments.magnify):
        raise ResultsError(f"--magnify: error: {arguments.magnify:g}, expected a finite factor")
    if arguments.is_run and arguments.modes:
        raise ResultsError(f"--modes: error: {arguments.file} is a run, of which instants are written")
    of_runs = {"--every": arguments.every, "--from": arguments.start, "--to": arguments.end}
    for name, value in of_runs.items():
        if not arguments.is_run and value is not None:
            raise ResultsError(f"{name}: error: {arguments.file} is a superelement, which has no time")


def main():
    parser = make_parser(
        __doc__,
        "tools/export_paraview chassis.h5 -o modes.pvd --modes 1 2 3\n"
        "  tools/export_paraview bump_2modes.h5 -o bump.pvd --every 0.01 --magnify 10",
    )
    parser.add_argument("file", metavar="FILE", help="superelement file or results file")
    parser.add_argument("-o", "--output", required=True, metavar="NAME.pvd", help="list to write; NAME holds the files")
    parser.add_argument("--modes", metavar="NUMBER", type=int, nargs="+", help="of a superelement (all, if not given)")
    parser.add_argument("--magnify", metavar="FACTOR", type=float, default=1.0, help="of the deflections of a run, or of the modes")
    parser.add_argument("--every", metavar="S", type=float, help="time between instants of a run, s (all samples)")
    parser.add_argument("--from", dest="start", type=float, metavar="S", help="begin at this time, s")
    parser.add_argument("--to", dest="end", type=float, metavar="S", help="end at this time, s")
    arguments = parser.parse_args()
    arguments.is_run = find_format(arguments.file)
    check_arguments(arguments)
    count = write_folder(arguments.output, arguments)
    print(f"{arguments.output}: {count} {'instants' if arguments.is_run else 'modes'}")
    return 0
