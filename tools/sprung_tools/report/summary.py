"""The data of the page's tables: statistics of all samples, what was run, the vehicle's modes, the reduction's
checks."""

import hashlib
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Flags
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import SUPERELEMENT, open_hdf5, read_numbers, read_real, read_text, read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.force_channels import (
    CONTACT,
    FORCE,
    describe_deflection,
    describe_load,
    find_force_channel,
    list_force_channels,
)
from sprung_tools.model.reduced_vectors import OF_THE_BODY, describe_vectors, read_vectors
from sprung_tools.model.resolved_model import read_element, read_settings
from sprung_tools.report.histories import IN_BODY_FRAME, LARGEST_AXIAL, LARGEST_MOMENT, Channel
from sprung_tools.report.packing import Packed
from sprung_tools.report.shown_motion import VERTICAL, ShownMotion, list_monitored, read_motion
from sprung_tools.runs.labelled_runs import Run, samples_between
from sprung_tools.runs.largest_loads import AXIAL, MOMENT, find_best_peak
from sprung_tools.runs.ride_measures import read_window
from sprung_tools.runs.rounding import calc_rounding, clear_each
from sprung_tools.runs.run_caption import describe_integrator, describe_road
from sprung_tools.runs.stored_histories import find_row_step, list_gaps
from sprung_tools.signals.spectra import calc_rms

MOST_FREQUENCIES = 12  # of a superelement that are shown
MOST_ALIKE = 6  # forces of one kind in the summary; if there are more, they are only in "All numbers"
PARTS = (("max", "highest"), ("min", "lowest"), ("rms", "r.m.s."))  # endings of attributes, words
COMPUTATION = {
    "steps": "steps", "evaluations": "evaluations", "switches": "switches located",
    "energy_closure": "energy balance, relative error", "constraint_violation": "joints, largest violation",
}  # fmt: skip


class Statistic(NamedTuple):
    """A row of the summary: what it is of, its name, unit and value; step: the time between the stored rows that it is
    of [s], 0 where it is of all outputs."""

    of: str
    name: str
    unit: str
    value: float
    step: float = 0.0


def calc_hash(path: str | Path) -> str:
    """SHA-256 of a file."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while part := file.read(1 << 20):
            digest.update(part)
    return digest.hexdigest()


def calc_statistics(results: ResultsFile, channels: Iterable[Channel], motion: ShownMotion) -> list[Packed]:
    """The rows of the summary, over the span of the run's statistics; those of the computation are of the whole run."""
    inside = samples_between(results, *read_window(results))
    rows = list_point_rows(results, motion)
    kinds = {force: results.force_kind(force) for force in results.names("forces")}
    many = {force for force, kind in kinds.items() if list(kinds.values()).count(kind) > MOST_ALIKE}
    for force in kinds:
        rows += calc_force_rows(results, force, inside)
    for channel in channels:
        point, _, what = channel.name.partition(", ")
        if channel.group == "Deflection" and what == IN_BODY_FRAME:
            step = find_row_step(results, f"points/{point}/deflection")
            largest = float(np.max(np.abs(channel.values[inside])))
            rows.append(Statistic(point, "deflection, largest", channel.unit, largest, step))
    for body in results.names("recovery"):
        rows += list_load_rows(results, body)
    there = results.file.attributes("summary") if results.file.has_group("summary") else {}
    rows += [
        Statistic("computation", name, "", read_real(results.file, "summary", key))
        for key, name in COMPUTATION.items()
        if key in there
    ]
    hidden = {"computation", *many}
    return [{**row._asdict(), "brief": row.of not in hidden} for row in rows]


def list_load_rows(results: ResultsFile, body: str) -> list[Statistic]:
    """The largest loads along a body: those that the run has found itself, else of the rows that the file holds."""
    rows = []
    for load, name, unit in ((MOMENT, LARGEST_MOMENT, "N m"), (AXIAL, LARGEST_AXIAL, "N")):
        peak = find_best_peak(results, body, load, read_window(results))
        if peak is not None:
            rows.append(Statistic(body, name, unit, abs(peak.value), peak.step))
    return rows


def list_point_rows(results: ResultsFile, motion: ShownMotion) -> list[Statistic]:
    """The statistics of the monitored points along the axis that is shown."""
    rows: list[Statistic] = []
    there_are = results.names("summary/points")
    for point in (one for one in list_monitored(results) if one in there_are):
        axis = motion.choose_axes(results, point)[0]
        for what, unit in (("displacement", "m"), ("acceleration", "m/s^2")):
            is_known = axis == VERTICAL
            found = read_extremes(results, point, what) if is_known else calc_extremes(results, point, what, axis)
            rows += [
                Statistic(point, f"{what}{motion.name_axis(point, axis)}, {name}", unit, value)
                for name, value in found.items()
            ]
    return rows


def read_extremes(results: ResultsFile, point: str, what: str) -> dict[str, float]:
    """Highest, lowest and r.m.s. value of a point's vertical motion, which sprung-dynamics itself computed."""
    group = f"summary/points/{point}"
    there = results.file.attributes(group)
    keys = {name: f"{what}_{part}" for part, name in PARTS if f"{what}_{part}" in there}
    if not keys:
        return {}
    values = np.array([read_real(results.file, group, key) for key in keys.values()])
    cleared = clear_each(values, calc_rounding(results, f"points/{point}", what))
    if np.any(cleared):  # an r.m.s. value is smaller than the extremes: it is rounding where they all are
        is_rms = np.array([name == "r.m.s." for name in keys])
        cleared[is_rms] = values[is_rms]
    return dict(zip(keys, cleared.tolist()))


def calc_extremes(results: ResultsFile, point: str, what: str, axis: str) -> dict[str, float]:
    """The same of the motion along another axis, over the run's own statistics window. A displacement is from the
    equilibrium, or from the start where none was sought."""
    is_from_start = what == "displacement" and not results.is_from_balance
    stored = "position" if is_from_start else what
    if not results.has(f"points/{point}/{stored}.{axis}"):
        return {}
    values, _ = read_motion(results, point, stored, axis)
    every = results.every(f"points/{point}/{stored}")
    values = (values - values[0] if is_from_start else values)[samples_between(results, *read_window(results), every)]
    return {"highest": float(values.max()), "lowest": float(values.min()), "r.m.s.": calc_rms(values)}


def calc_force_rows(results: ResultsFile, force: str, inside: Flags) -> list[Statistic]:
    """The greatest loads of a force among some samples, and its time off the road (tyre) or its travel."""
    rows: list[Statistic] = []
    for channel in list_force_channels(results, force):
        name = describe_load(channel)
        if not name:
            continue
        largest = float(np.max(np.abs(results.series(channel.quantity)[0][inside])))
        if largest > 0.0 or channel.role == FORCE:  # an applied torque has forces that are 0
            step = find_row_step(results, channel.quantity)
            rows.append(Statistic(force, f"{name}, largest", channel.unit, largest, step))
    contact = find_force_channel(results, force, CONTACT)
    if contact:
        on_road = results.series(contact)[0][inside] > 0.5
        step = float(np.median(np.diff(results.time)))
        off = step * float(np.count_nonzero(~on_road))
        rows.append(Statistic(force, "time off the road", "s", off, find_row_step(results, contact)))
        return rows
    kind = read_element(results, "forces", force).kind
    for channel in list_force_channels(results, force):
        name = describe_deflection(channel, on_road=False, kind=kind)
        if name:
            values, unit = results.series(channel.quantity)
            values = values[inside]
            both_ways = name == "turn" or " along " in name  # a stop that never touches has a negative overlap
            largest = float(np.max(np.abs(values) if both_ways else values))
            step = find_row_step(results, channel.quantity)
            rows.append(Statistic(force, f"{name}, largest", unit, largest, step))
    return rows


def list_facts(results: ResultsFile, has_tyres: bool, sha256: str) -> list[tuple[str, str]]:
    """What was run, as (name, text) in order. Road and speed of a mechanism without tyres are left out."""
    settings = read_settings(results)
    facts = [("vehicle", results.title)]
    if has_tyres:
        facts.append(("road", describe_road(results).removeprefix("road: ")))
    if has_tyres or settings["speed"] != 0.0:
        facts.append(("initial speed", f"{settings['speed']:g} m/s"))
    step = float(np.median(np.diff(results.time)))
    facts.append(("duration", f"{results.time[-1] - results.time[0]:g} s, a sample every {1e3 * step:g} ms"))
    gaps = list_gaps(results)
    if gaps:
        facts.append(("results file", "; ".join(gaps)))
    flexible = []
    for body in results.names("bodies"):
        if results.num_modes(body):
            flexible.append(f"{body}: {describe_vectors(read_vectors(results, body))}")
    facts.append(("flexible bodies", "; ".join(flexible) or "none"))
    facts.append(("integrator", describe_integrator(settings["integrator"])))
    changed = read_texts(results.file, "model/overrides") if results.file.has_dataset("model/overrides") else []
    facts.append(("changed by --set", ", ".join(changed) or "nothing"))
    origin = "static equilibrium" if results.is_from_balance else "the positions given"
    facts.append(("starts from", "the end of another run" if results.is_continued else origin))
    for name in results.names("model/superelements"):
        version, content = (
            read_text(results.file, f"model/superelements/{name}", attribute)
            for attribute in ("program_version", "content_hash")
        )
        facts.append((f"superelement {name}", f"sprung-reduce {version}, content {content}"))
    version = read_text(results.file, "", "program_version", "")
    if version:
        facts.append(("sprung-dynamics", version))
    for name, dataset in (("vehicle file", "vehicle_text"), ("run file", "run_text")):
        if results.file.has_dataset(f"model/{dataset}"):
            (text,) = read_texts(results.file, f"model/{dataset}")
            facts.append((f"{name}, SHA-256", hashlib.sha256(text.encode()).hexdigest()))
    facts.append(("results file, SHA-256", sha256))
    return facts


def read_checks(folder: str | None, runs: Sequence[Run]) -> list[Packed]:
    """Reads the checks that stage one made of each superelement that the runs used, from the files in a folder, if one
    is given.

    A file is used only if its content hash is the one that the run names. InputError if the folder is not there.
    """
    if folder and not os.path.isdir(folder):
        raise InputError(f"{folder}: error: no such folder")
    users: dict[tuple[str, str], list[str]] = {}
    for run in runs:
        for name in run.results.names("model/superelements"):
            content = read_text(run.results.file, f"model/superelements/{name}", "content_hash")
            users.setdefault((name, content), []).append(run.label)
    return [
        {"name": name, "hash": content, "runs": labels, "problem": "", "checks": [], "frequencies": [], "more": False}
        | read_checks_of(folder, name, content)
        for (name, content), labels in users.items()
    ]


def read_checks_of(folder: str | None, name: str, content_hash: str) -> Packed:
    """The checks in a superelement's file; or as `problem` the reason why they cannot be shown."""
    if not folder:
        return {"problem": "Not shown: give the folder of the superelement files with --superelements."}
    path = os.path.join(folder, f"{name}.h5")
    if not os.path.exists(path):
        return {"problem": f"Not shown: there is no {path}."}
    with open_hdf5(path, SUPERELEMENT) as file:
        if read_text(file, "", "content_hash", "") != content_hash:
            return {"problem": f"Not shown: {path} is another superelement than the one that was run."}
        values, _ = read_numbers(file, "checks/value")
        tolerances, _ = read_numbers(file, "checks/tolerance")
        frequencies, _ = read_numbers(file, "modes/frequency")
        names = read_texts(file, "checks/name")
        kinds = read_texts(file, "modes/kind") if file.has_dataset("modes/kind") else ["clamped"] * frequencies.size
    checks = [
        {"name": check, "value": float(value), "tolerance": float(tolerance)}
        for check, value, tolerance in zip(names, values, tolerances)
    ]
    of_the_body = [(kind, float(frequency)) for kind, frequency in zip(kinds, frequencies) if kind in OF_THE_BODY]
    return {"checks": checks, "frequencies": [frequency for _, frequency in of_the_body[:MOST_FREQUENCIES]],
            "more": len(of_the_body) > MOST_FREQUENCIES, "kind": of_the_body[0][0] if of_the_body else "",
            "others": len(kinds) - len(of_the_body)}  # fmt: skip
