"""The histories that the page shows, their spectra, and the amplitudes of modes."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.hdf5_file import read_numbers, read_real
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.force_channels import (
    EXTENT,
    GIVEN,
    TORQUE,
    ForceChannel,
    describe_deflection,
    describe_load,
    list_force_channels,
)
from sprung_tools.model.reduced_vectors import OF_THE_BODY, describe_vectors, read_vectors
from sprung_tools.model.resolved_model import Element, read_element
from sprung_tools.model.vehicle_shape import DrawnBody
from sprung_tools.report.packing import Packed, encode, find_kept
from sprung_tools.report.shown_motion import ShownMotion, list_monitored, read_motion
from sprung_tools.runs.labelled_runs import Shown
from sprung_tools.runs.rounding import ROUNDING, clear_rounding
from sprung_tools.runs.section_stress import ENDINGS, list_sources
from sprung_tools.signals.spectra import calc_whole_spectrum

MOST_MODES = 8  # modes of a body whose amplitudes are drawn: the largest ones, as many as the page has colours
SEGMENT = 4.0  # s, the longest segment of the averaged spectra: lines 0.25 Hz apart; a shorter run is one segment long
HIGHEST_FREQUENCY = 200.0  # Hz drawn
MOTION = "motion"  # kind of a prescribed motion
IN_BODY_FRAME = "deflection in the body frame"
LARGEST_MOMENT, LARGEST_AXIAL = "largest bending moment along it", "largest axial force along it"


class Channel(NamedTuple):
    """A history: its group and its name in the page's menus, its values [n] and their unit."""

    group: str
    name: str
    values: Floats
    unit: str


def list_channels(
    results: ResultsFile, bodies: Sequence[DrawnBody], extra: Sequence[Shown], motion: ShownMotion
) -> list[Channel]:
    """All histories that the page shows. extra: the quantities asked for."""
    channels = []

    def add(group: str, name: str, quantity: str, unless_zero: bool = False, size: float = 0.0) -> None:
        """size: of which the values may be nothing but rounding."""
        if results.has(quantity):
            values, unit = results.series(quantity)
            values = clear_rounding(values, ROUNDING * size)
            if unless_zero and not np.any(values):
                return
            channels.append(Channel(group, name, values, unit))

    for shown in extra:
        add("Asked for", shown.label, shown.quantity)
    for point in list_monitored(results):
        channels.extend(list_motion_channels(results, point, motion))
    for drawn in bodies:
        for point in find_most_bent(results, drawn):
            add("Deflection", f"{point}, {IN_BODY_FRAME}", f"points/{point}/deflection.y")
        channels.extend(calc_moment_envelope(results, drawn))
    for force in results.names("forces"):
        for channel in list_force_channels(results, force):
            name = describe_history(channel, read_element(results, "forces", force))
            if name:  # an applied force may have only one of its components
                unless_zero = channel.role in (GIVEN, TORQUE)
                add("Forces", f"{force}, {name}", channel.quantity, unless_zero=unless_zero)
    for name in results.names("joints"):
        joint = read_element(results, "joints", name)
        if joint.kind != MOTION:
            body = joint.points["a"].partition(".")[0]
            for axis in ("x", "y"):
                add("Joints", f"{name}, force along {axis} on {body}", f"joints/{name}/reaction.{axis}")
            add("Joints", f"{name}, torque on {body}", f"joints/{name}/reaction.torque", unless_zero=True)
        add("Joints", f"{name}, drive", f"joints/{name}/drive")
    for body in find_heavy(results):
        add("Whole vehicle", f"{body}, angle", f"bodies/{body}/position.angle", size=1.0)  # rad
        add("Whole vehicle", f"{body}, horizontal velocity", f"bodies/{body}/velocity.x")
    energies = [f"energy/{name}" for name in results.names("energy")]
    largest = max((float(np.max(np.abs(results.series(one)[0]))) for one in energies), default=0.0)
    for one in energies:
        add("Energy", f"{one.partition('/')[2]} energy", one, size=largest)
    return channels


def list_motion_channels(results: ResultsFile, point: str, motion: ShownMotion) -> list[Channel]:
    """Displacement, or position where no equilibrium was sought, and acceleration of a monitored point."""
    group = motion.name_group(point)
    return [
        Channel(group, f"{point}, {what}{motion.name_axis(point, axis)}", *read_motion(results, point, what, axis))
        for axis in motion.choose_axes(results, point)
        for what in ("displacement" if results.is_from_balance else "position", "acceleration")
        if results.has(f"points/{point}/{what}.{axis}")
    ]


def describe_history(channel: ForceChannel, element: Element) -> str:
    """The page's name for a channel of a force element; empty for a channel that the page does not show."""
    if channel.role == EXTENT and channel.unit == "rad":
        return "angle"
    return describe_load(channel) or describe_deflection(channel, element.on_road, element.kind)


def find_heavy(results: ResultsFile) -> list[str]:
    """The heaviest body's name in a list; an empty list if there is no body."""
    bodies = results.names("model/bodies")
    return sorted(bodies, key=lambda name: -read_real(results.file, f"model/bodies/{name}", "mass"))[:1]


def find_most_bent(results: ResultsFile, body: DrawnBody) -> list[str]:
    """The two named points of a body whose vertical deflection varies most; none of a rigid body."""
    found = []
    for point in body.points:
        quantity = f"points/{body.name}.{point}/deflection.y"
        if body.shapes.shape[2] > 0 and results.has(quantity):
            found.append((-float(np.ptp(results.series(quantity)[0])), f"{body.name}.{point}"))
    return [point for size, point in sorted(found)[:2] if size < 0.0]


def calc_moment_envelope(results: ResultsFile, body: DrawnBody) -> list[Channel]:
    """The largest bending moment along a body at each time, and the largest axial force: from the loads on the body
    where the file has them, else from its modes."""
    channels = []
    for source in list_sources(results, body.name)[:1]:
        for what, name in (("moment", LARGEST_MOMENT), ("axial", LARGEST_AXIAL)):
            values, unit = read_numbers(results.file, f"recovery/{body.name}/{what}{ENDINGS[source]}")
            if values.size > 0:
                channels.append(Channel("Deflection", f"{body.name}, {name}", np.max(np.abs(values), axis=1), unit))
    return channels


def pack_channel(channel: Channel, time: Floats, most: int) -> Packed:
    """A history for the page, thinned to `most` samples."""
    kept = find_kept(channel.values, most)
    return {
        "group": channel.group, "name": channel.name, "unit": channel.unit, "t": encode(time[kept]),
        "v": encode(channel.values[kept]),
    }  # fmt: skip


def calc_spectra(results: ResultsFile, motion: ShownMotion) -> list[Packed]:
    """The power spectral densities of the monitored points' accelerations less their means, up to HIGHEST_FREQUENCY;
    none of a point that does not move, or of less than eight samples."""
    step = float(np.median(np.diff(results.time)))
    even = np.arange(results.time[0], results.time[-1] + 0.5 * step, step)
    spectra = []
    for point in list_monitored(results):
        axis = motion.choose_axes(results, point)[0]
        if even.size < 8 or not results.has(f"points/{point}/acceleration.{axis}"):
            continue
        values = np.interp(even, results.time, read_motion(results, point, "acceleration", axis)[0])
        if not np.any(values):
            continue
        frequency, density = calc_whole_spectrum(values - values.mean(), step, SEGMENT)
        shown = (frequency > 0.0) & (frequency <= HIGHEST_FREQUENCY)
        name = f"{point}{motion.name_axis(point, axis)}"
        spectra.append({"name": name, "f": encode(frequency[shown]), "p": encode(density[shown])})
    return spectra


def pack_modes(results: ResultsFile, bodies: Sequence[DrawnBody], most: int) -> list[Packed]:
    """For each flexible body the contributions of its largest modes, and when these take part. A contribution is the
    largest displacement along the body [m]."""
    packed = []
    for body in bodies:
        where = f"bodies/{body.name}/modal"
        if body.shapes.shape[2] == 0 or not results.has(f"{where}/amplitude"):
            continue
        vectors = read_vectors(results, body.name)
        amplitude, _ = read_numbers(results.file, f"{where}/amplitude")
        active = np.ones_like(amplitude)
        if results.has(f"{where}/active"):
            active, _ = read_numbers(results.file, f"{where}/active")
        size = np.max(np.linalg.norm(body.shapes, axis=1), axis=0)  # m per unit amplitude
        largest = np.argsort(-np.max(np.abs(amplitude * size), axis=0), kind="stable")[:MOST_MODES]
        modes = []
        for place in np.sort(largest):
            values = amplitude[:, place] * size[place]
            kept = find_kept(values, most)
            changes = np.flatnonzero(np.diff(active[:, place] > 0.5)) + 1
            modes.append({
                "name": str(vectors[place]), "frequency": vectors[place].frequency,
                "t": encode(results.time[kept]), "v": encode(values[kept]),
                "active": bool(active[0, place] > 0.5), "switches": encode(results.time[changes]),
            })  # fmt: skip
        packed.append({
            "body": body.name, "total": describe_vectors(vectors), "left": len(vectors) - len(modes),
            "others": any(one.kind not in ("", *OF_THE_BODY) for one in vectors), "modes": modes,
        })  # fmt: skip
    return packed
