"""The channels of force elements, found by their roles and not by their names (dynamics/output/results.md)."""

from typing import NamedTuple

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_text
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import find_group

FORCE, LONGITUDINAL, GIVEN, TORQUE, DEFLECTION = "force", "longitudinal-force", "given", "torque", "deflection"
EXTENT, RATE, CONTACT, ROAD_HEIGHT = "extent", "rate", "contact", "road-height"
PRESSURE, MASS, MASS_FLOW = "pressure", "mass", "mass-flow"
ROLES = (FORCE, LONGITUDINAL, GIVEN, TORQUE, DEFLECTION, EXTENT, RATE, CONTACT, ROAD_HEIGHT, PRESSURE, MASS, MASS_FLOW)


class ForceChannel(NamedTuple):
    """A dataset of a force element."""

    quantity: str  # as ResultsFile.series() takes it
    name: str
    role: str
    unit: str


def list_force_channels(results: ResultsFile, force: str) -> list[ForceChannel]:
    """All channels of a force element that have a role, in the order of ROLES. InputError for a file of version 1,
    which has no roles."""
    find_group(results)
    if f"forces/{force}" in results.kept:
        channels: list[ForceChannel] = results.kept[f"forces/{force}"]
        return channels
    found = []
    for name in results.names(f"forces/{force}"):
        quantity = f"forces/{force}/{name}"
        role = read_text(results.file, quantity, "role", "")
        if results.file.has_dataset(quantity) and role in ROLES:
            found.append(ForceChannel(quantity, name, role, read_text(results.file, quantity, "unit", "")))
    found.sort(key=lambda channel: (ROLES.index(channel.role), channel.name))
    results.kept[f"forces/{force}"] = found
    return found


def find_force_channel(results: ResultsFile, force: str, role: str) -> str | None:
    """Finds the quantity of the first channel of a role; None if the element has none."""
    return next((one.quantity for one in list_force_channels(results, force) if one.role == role), None)


def read_force_channel(results: ResultsFile, force: str, role: str) -> tuple[Floats, str]:
    """Reads the history of a force element's channel of a role. Returns (values [n], unit). InputError if it has
    none."""
    quantity = find_force_channel(results, force, role)
    if quantity is None:
        raise InputError(f"{results.path}: error: 'forces/{force}' has no channel of role '{role}'")
    return results.series(quantity)


def describe_load(channel: ForceChannel) -> str:
    """The name of a channel that is a force or a torque, unlike those of the element's other channels: `force`,
    `force along x`, `friction`, `partner force`, `torque`; empty for other channels."""
    if channel.role == LONGITUDINAL:
        return "force along x"
    return describe_axis(channel.name) if channel.role in (FORCE, GIVEN, TORQUE) else ""


def describe_deflection(channel: ForceChannel, on_road: bool, kind: str) -> str:
    """The name of a deflection of an element of some kind: `compression from the free length` of a spring, `partner
    compression from the design height` of coupled air springs, `penetration` of a tyre, `deflection along x` of a
    bushing, `turn`; empty for other channels."""
    if channel.role != DEFLECTION:
        return ""
    if on_road:
        return "penetration"
    if channel.unit == "rad":
        return "turn"
    name = describe_axis(channel.name)
    if not name.endswith("deflection"):
        return name
    reference = "design height" if kind == "air-spring" else "free length"
    return f"{name.replace('deflection', 'compression')} from the {reference}"


def describe_axis(name: str) -> str:
    """The name of a channel in words: `force_x` → `force along x`, `partner_force` → `partner force`."""
    stem, _, axis = name.rpartition("_")
    return f"{stem} along {axis}" if axis in ("x", "y") and stem else name.replace("_", " ")
