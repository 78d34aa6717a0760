"""The channels of force elements by their roles (dynamics/output/results.md), whatever their names."""

from typing import NamedTuple

import h5py

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import text_of
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


def list_force_channels(results, force):
    """All channels of a force element that have a role, in the order of ROLES. InputError for a file of version 1,
    which tells no roles."""
    open_group(results)
    found = []
    for name, dataset in results.file[f"forces/{force}"].items():
        role = text_of(dataset.attrs.get("role", ""))
        if isinstance(dataset, h5py.Dataset) and role in ROLES:
            unit = text_of(dataset.attrs.get("unit", ""))
            found.append(ForceChannel(f"forces/{force}/{name}", name, role, unit))
    return sorted(found, key=lambda channel: (ROLES.index(channel.role), channel.name))


def find_force_channel(results, force, role):
    """The quantity of the first channel of a role; None if the element has none."""
    return next((one.quantity for one in list_force_channels(results, force) if one.role == role), None)


def read_force_channel(results, force, role):
    """The history of a force element's channel of a role: (values [n], unit). InputError if it has none."""
    quantity = find_force_channel(results, force, role)
    if quantity is None:
        raise InputError(f"{results.path}: error: 'forces/{force}' has no channel of role '{role}'")
    return results.series(quantity)


def describe_load(channel):
    """What a channel that tells a force or torque is called: `force`, `force along x`, `torque`; "" for others."""
    names = {FORCE: "force", LONGITUDINAL: "force along x", TORQUE: "torque"}
    if channel.role == GIVEN:
        return channel.name.replace("_", " along ")
    return names.get(channel.role, "")
