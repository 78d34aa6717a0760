"""The histories that the page offers, their spectra and the amplitudes of modes."""

from typing import NamedTuple

import numpy as np

from sprung_tools.files.hdf5_file import read_attribute, read_numbers
from sprung_tools.model.force_channels import DEFLECTION, EXTENT, GIVEN, TORQUE, describe_load, list_force_channels
from sprung_tools.model.resolved_model import read_elements
from sprung_tools.report.packing import encode, find_kept
from sprung_tools.signals.spectra import calc_power_spectrum

MOST_MODES = 12  # of a body whose amplitudes are drawn: the largest
SEGMENT = 4.0  # s, of the averaged spectra at most: lines 0.25 Hz apart
HIGHEST_FREQUENCY = 200.0  # Hz, of the spectra drawn


class Channel(NamedTuple):
    """A history: its group in the page's menus, its name there, values [n] and their unit."""

    group: str
    name: str
    values: np.ndarray
    unit: str


def list_monitored(results):
    """The points that the run's summary is about; all bodies' origins if it is about none."""
    points = results.names("summary/points")
    return points or [f"{body}.origin" for body in results.names("bodies")]


def list_channels(results, bodies, extra):
    """All histories that the page offers. extra: list of Shown."""
    channels = []

    def add(group, name, quantity, unless_zero=False):
        if results.has(quantity):
            values, unit = results.series(quantity)
            if unless_zero and not np.any(values):
                return
            channels.append(Channel(group, name, values, unit))

    for shown in extra:
        add("Asked for", shown.label, shown.quantity)
    balanced = results.is_from_balance
    for point in list_monitored(results):
        add("Vertical motion", f"{point}, {'displacement' if balanced else 'position'}",
            f"points/{point}/{'displacement' if balanced else 'position'}.y")  # fmt: skip
        add("Vertical motion", f"{point}, acceleration", f"points/{point}/acceleration.y")
    for body in bodies:
        for point in find_most_bent(results, body):
            add("Deflection", f"{point}, in the body frame", f"points/{point}/deflection.y")
        channels.extend(calc_moment_envelope(results, body))
    forces = read_elements(results, "forces")
    for force in results.names("forces"):
        for channel in list_force_channels(results, force):
            name = describe_history(channel, on_road=forces[force].on_road)
            if name:  # an applied force may have one of its components alone
                unless_zero = channel.role in (GIVEN, TORQUE)
                add("Forces", f"{force}, {name}", channel.quantity, unless_zero=unless_zero)
    for body in find_heavy(results):
        add("Whole vehicle", f"{body}, angle", f"bodies/{body}/position.angle")
        add("Whole vehicle", f"{body}, horizontal velocity", f"bodies/{body}/velocity.x")
    for name in results.names("energy"):
        add("Energy", name, f"energy/{name}")
    return channels


def describe_history(channel, on_road):
    """What the page calls a channel of a force element; "" for one that it does not show."""
    if channel.role == DEFLECTION:
        return "penetration" if on_road else "compression"
    if channel.role == EXTENT and channel.unit == "rad":
        return "angle"
    return describe_load(channel)


def find_heavy(results):
    """The heaviest body's name, in a list."""
    bodies = results.names("model/bodies")
    return sorted(bodies, key=lambda name: -float(read_attribute(results.file, f"model/bodies/{name}", "mass")))[:1]


def find_most_bent(results, body):
    """The two named points of a body whose vertical deflection varies most; none on a rigid body."""
    found = []
    for point in body.points:
        quantity = f"points/{body.name}.{point}/deflection.y"
        if body.shapes.shape[2] > 0 and results.has(quantity):
            found.append((-float(np.ptp(results.series(quantity)[0])), f"{body.name}.{point}"))
    return [point for size, point in sorted(found)[:2] if size < 0.0]


def calc_moment_envelope(results, body):
    """The largest bending moment along a body at each time, and the largest axial force."""
    channels = []
    for what, name in (("moment", "largest bending moment along it"), ("axial", "largest axial force along it")):
        dataset = f"recovery/{body.name}/{what}"
        if dataset in results.file and results.file[dataset].shape[1] > 0:
            values, unit = read_numbers(results.file, dataset)
            channels.append(Channel("Deflection", f"{body.name}, {name}", np.max(np.abs(values), axis=1), unit))
    return channels


def pack_channel(channel, time, most):
    kept = find_kept(channel.values, most)
    return {
        "group": channel.group, "name": channel.name, "unit": channel.unit, "t": encode(time[kept]),
        "v": encode(channel.values[kept]),
    }  # fmt: skip


def calc_spectra(results):
    """Power spectral densities of the monitored points' vertical accelerations; drawn up to HIGHEST_FREQUENCY."""
    step = float(np.median(np.diff(results.time)))
    even = np.arange(results.time[0], results.time[-1], step)
    spectra = []
    for point in list_monitored(results):
        if not results.has(f"points/{point}/acceleration.y"):
            continue
        values = np.interp(even, results.time, results.series(f"points/{point}/acceleration.y")[0])
        duration = min(SEGMENT, step * (values.size // 2) if step * values.size > 2.0 * SEGMENT else step * values.size)
        if round(duration / step) < 8:
            continue
        frequency, density = calc_power_spectrum(values, step, duration)
        shown = (frequency > 0.0) & (frequency <= HIGHEST_FREQUENCY)
        spectra.append({"name": point, "f": encode(frequency[shown]), "p": encode(density[shown])})
    return spectra


def pack_modes(results, bodies, most):
    """For each flexible body its largest modes' contributions, as the largest displacement along the body [m], and
    when they take part."""
    packed = []
    for body in bodies:
        if body.shapes.shape[2] == 0:
            continue
        where = f"bodies/{body.name}/modal"
        numbers = read_numbers(results.file, f"{where}/mode_number")[0].astype(int)
        amplitude, _ = read_numbers(results.file, f"{where}/amplitude")
        active = np.ones_like(amplitude)
        if f"{where}/active" in results.file:
            active, _ = read_numbers(results.file, f"{where}/active")
        size = np.max(np.linalg.norm(body.shapes, axis=1), axis=0)  # m per unit amplitude
        largest = np.argsort(-np.max(np.abs(amplitude * size), axis=0), kind="stable")[:MOST_MODES]
        modes = []
        for place in np.sort(largest):
            values = amplitude[:, place] * size[place]
            kept = find_kept(values, most)
            changes = np.flatnonzero(np.diff(active[:, place] > 0.5)) + 1
            modes.append({
                "number": int(numbers[place]), "t": encode(results.time[kept]), "v": encode(values[kept]),
                "active": bool(active[0, place] > 0.5), "switches": encode(results.time[changes]),
            })  # fmt: skip
        packed.append({"body": body.name, "total": int(numbers.size), "modes": modes})
    return packed
