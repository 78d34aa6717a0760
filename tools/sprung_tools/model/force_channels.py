"""The channels of force elements by their roles (dynamics/output/results.md); their names do not matter."""

from typing import NamedTuple

import h5py

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import text_of
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.resolved_model import open_group

FORCE, LONGITUDINAL, GIVEN, TORQUE, DEFLECTION = "force", "longitudinal-force", "given", "torque", "deflection"
EXTENT, RATE, CONTACT, ROAD_HEIGHT = "extent", "rate", "contact", "road-height"
ROLES = (FORCE, LONGITUDINAL, GIVEN, TORQUE, DEFLECTION, EXTENT, RATE, CONTACT, ROAD_HEIGHT)


class ForceChannel(NamedTuple):
    """A dataset of a force element."""

    quantity: str  # as ResultsFile.series() takes it
    name: str
    role: str
    unit: str


def list_force_channels(results: ResultsFile, force: str) -> list[ForceChannel]:
    """All channels of a force element that have a role, in the order of ROLES. InputError for a file of version 1,
    which has no roles."""
    open_group(results)
    found = []
    for name, dataset in results.file[f"forces/{force}"].items():
        role = text_of(dataset.attrs.get("role", ""))
        if isinstance(dataset, h5py.Dataset) and role in ROLES:
            unit = text_of(dataset.attrs.get("unit", ""))
            found.append(ForceChannel(f"forces/{force}/{name}", name, role, unit))
    return sorted(found, key=lambda channel: (ROLES.index(channel.role), channel.name))


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
    """The name of a channel that is a force or a torque: `force`, `force along x`, `torque`; empty for other
    channels."""
    names = {FORCE: "force", LONGITUDINAL: "force along x", TORQUE: "torque"}
    if channel.role == GIVEN:
        return channel.name.replace("_", " along ")
    return names.get(channel.role, "")
