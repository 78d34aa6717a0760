"""Bending moment, shear and stresses along each flexible body, from the loads on it where the file has them, else from
its modes: at each time of the animation, their envelope over the run, where and when the extremes are, and where the
two ways differ most. Where the file does not hold all outputs, also the extremes that the run itself has found."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.vehicle_shape import DrawnBody
from sprung_tools.report.packing import Packed, encode
from sprung_tools.runs.largest_loads import find_signs, read_own
from sprung_tools.runs.run_warnings import SUMMARY, RunWarning
from sprung_tools.runs.section_stress import ENDINGS, SIDES, calc_section_stress, find_gap, list_sources
from sprung_tools.runs.stations import ALONG_X, place_stations, read_stations
from sprung_tools.runs.stored_histories import find_row_step

LOADS = "loads"  # the numbers that list_load_warnings() is about
QUANTITIES = (("moment", "bending moment"), ("shear", "shear force"))
LARGEST_DIFFERENCE = "largest difference from that of the modes"
MOST_STATIONS = 160  # drawn along a body: those of every k-th element, and of the elements with an extreme


class Places(NamedTuple):
    """Where loads are: their places in a diagram [stations] m, and what a table calls these."""

    along: Floats
    names: list[str]


def pack_frame_loads(results: ResultsFile, bodies: Sequence[DrawnBody], most: int) -> list[Packed]:
    """The loads along all bodies of which the file has them, at `most` times at most."""
    even = np.linspace(0, results.time.size - 1, min(results.time.size, most)).round().astype(int)
    packed = []
    for body in bodies:
        where = f"recovery/{body.name}"
        sources = list_sources(results, body.name)
        sources = [one for one in sources if has_stations(results, f"{where}/moment{ENDINGS[one]}")]
        if not sources:
            continue
        stations = read_stations(results, body.name)
        layout = place_stations(stations)
        order, places = layout.order, name_places(layout.along, stations[layout.order], layout.axis)
        read, *other = [
            [read_load(results, f"{where}/{dataset}{ENDINGS[source]}", find_signs(dataset, stations))
             for dataset, _ in QUANTITIES]
            for source in sources
        ]  # fmt: skip
        stresses = list_stresses(results, body.name)
        shown = [*(values for values, _ in read), *(values for _, values, _ in stresses)]
        samples = np.unique(np.concatenate([even, *(find_extremes(values)[:, 0] for values in shown)]))
        quantities = [
            pack_quantity(values[:, order], places, results.time, samples, label, unit)
            for (values, unit), (_, label) in zip(read, QUANTITIES)
        ]
        quantities += [
            pack_quantity(values, one, results.time, samples, label, "Pa") for label, values, one in stresses
        ]
        dataset = f"{where}/moment{ENDINGS[sources[0]]}"
        step = find_row_step(results, dataset)
        if step > 0.0:
            for quantity, (load, _) in zip(quantities, QUANTITIES):
                quantity["own"] = pack_own(results, body.name, load, sources, order, places)
        for from_modes in other:
            for quantity, (values, _), (modal, _) in zip(quantities, read, from_modes):
                quantity["difference"] = pack_difference(values[:, order], modal[:, order], places, results.time)
        packed.append({
            "body": body.name, "axis": layout.axis, "t": encode(results.time[samples]), "quantities": quantities,
            "step": step,
        })  # fmt: skip
    return packed


def list_load_warnings(warnings: Sequence[RunWarning], bodies: Sequence[str]) -> list[RunWarning]:
    """The warnings of the summary that concern the loads along these bodies, too: those of a body, and those of the
    motion of its points, from which its loads follow. All if they do not say of what they are."""
    found = []
    for one in warnings:
        of = {name.partition(".")[0] for name in one.of}
        concerned = tuple(body for body in bodies if body in of)
        if one.section == SUMMARY and (concerned or not of):
            found.append(RunWarning(LOADS, concerned, one.text))
    return found


def pack_own(
    results: ResultsFile, body: str, load: str, sources: Sequence[str], order: Integers, places: Places
) -> list[Packed]:
    """The extremes of a load that the run itself has found; those that older files do not hold are left out. order: of
    the stations that the places are of."""
    names = [(f"{load}{ENDINGS[sources[0]]}", "largest of all outputs")]
    if len(sources) > 1:
        names.append((f"{load}_difference", f"{LARGEST_DIFFERENCE}, of all outputs"))
    found = [(what, read_own(results, body, name)) for name, what in names]
    return [
        pack_extreme(what, own.value, places, int(np.flatnonzero(order == own.station)[0]), own.time)
        for what, own in found if own is not None
    ]  # fmt: skip


def name_places(along: Floats, positions: Floats, axis: str) -> Places:
    """The places of stations: over x their x names them, else their positions [stations×2] m."""
    if axis == ALONG_X:
        return Places(along, [f"{x + 0.0:.4g} m" for x in along])
    return Places(along, [f"({x + 0.0:.4g}, {y + 0.0:.4g}) m" for x, y in positions])


def pack_extreme(what: str, value: float, places: Places, column: int, time: float) -> Packed:
    """A value of a load, where and when it is."""
    return {"what": what, "value": float(value), "place": float(places.along[column]), "where": places.names[column],
            "time": float(time)}  # fmt: skip


def read_load(results: ResultsFile, dataset: str, signs: Floats) -> tuple[Floats, str]:
    """A load along a body [n×stations] with these signs, and its unit."""
    values, unit = read_numbers(results.file, dataset)
    return values * signs, unit


def has_stations(results: ResultsFile, dataset: str) -> bool:
    """Whether loads [n×stations] have stations: those of the modes of a body without any have none."""
    return (results.file.shape(dataset) or (0, 0))[1] > 0


def pack_quantity(values: Floats, places: Places, time: Floats, samples: Integers, label: str, unit: str) -> Packed:
    """A load along a body [n×stations]. The envelope and the extremes are of all samples and stations."""
    found = find_extremes(values)
    extremes = [
        pack_extreme(what, values[row, column], places, column, time[row])
        for what, (row, column) in zip(("highest", "lowest"), found)
    ]
    kept = choose_stations(values.shape[1], found[:, 1])
    return {
        "name": label, "unit": unit, "s": encode(places.along[kept]), "v": encode(values[np.ix_(samples, kept)]),
        "low": encode(np.min(values, axis=0)[kept]), "high": encode(np.max(values, axis=0)[kept]),
        "extremes": extremes,
    }  # fmt: skip


def list_stresses(results: ResultsFile, body: str) -> list[tuple[str, Floats, Places]]:
    """The stresses of the extreme fibres along a body, one side after the other: label, values [n×stations] Pa,
    places; none where the file lacks the sizes of its sections."""
    if find_gap(results, body):
        return []
    section = calc_section_stress(results, body, list_sources(results, body)[0])
    every = np.arange(len(section.sides))
    places = name_places(section.along, section.positions, section.axis)
    names = sorted({side for pair in section.sides for side in pair})
    if len(names) == 2:  # all elements have the same two sides
        columns = [np.array([pair.index(name) for pair in section.sides]) for name in names]
    else:
        names, columns = list(SIDES), [np.full(every.size, column) for column in (0, 1)]
    return [
        (f"stress, {name.replace('-', '−')} side", section.stress[:, every, column], places)
        for name, column in zip(names, columns)
    ]


def pack_difference(from_loads: Floats, from_modes: Floats, places: Places, time: Floats) -> Packed:
    """Where and when the values from the loads and from the modes [n×stations] differ most."""
    difference = from_loads - from_modes
    row, column = np.unravel_index(int(np.argmax(np.abs(difference))), difference.shape)
    return pack_extreme(LARGEST_DIFFERENCE, difference[row, column], places, int(column), time[row])


def find_extremes(values: Floats) -> Integers:
    """Where the highest and the lowest of values [n×stations] are: [2×2] row and column."""
    return np.array([np.unravel_index(int(find(values)), values.shape) for find in (np.argmax, np.argmin)])


def choose_stations(count: int, needed: Integers) -> Integers:
    """The stations that are drawn: both ends of all elements, or of some, with the needed ones among them."""
    elements = np.arange(count // 2)
    every = max(1, int(np.ceil(count / MOST_STATIONS)))
    chosen = np.unique(np.concatenate([elements[::every], elements[-1:], needed // 2]))
    return np.stack([2 * chosen, 2 * chosen + 1], axis=1).ravel()
