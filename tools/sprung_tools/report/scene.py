"""The data of the animation: how the vehicle looks, where it is at equally spaced times, and its road."""

from collections.abc import Sequence

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.hdf5_file import read_numbers, read_real
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.force_channels import CONTACT, FORCE, list_force_channels, read_force_channel
from sprung_tools.model.resolved_model import read_direction
from sprung_tools.model.vehicle_shape import DrawnBody, Samples, Wheel, calc_motion, read_links, read_road
from sprung_tools.report.histories import find_heavy
from sprung_tools.report.packing import Packed, encode, find_kept
from sprung_tools.report.shown_motion import list_monitored
from sprung_tools.report.vehicle_modes import calc_equilibrium
from sprung_tools.signals.spans import find_spans

UNMARKED = ("origin", "center_of_mass")  # points that every body has
MOST_SEEN = 400  # samples from which the view of a mechanism is chosen
MOST_ROAD_POINTS = 20000


def list_unknown(results: ResultsFile, bodies: Sequence[DrawnBody]) -> list[str]:
    """The bodies whose motion the file does not hold."""
    return [body.name for body in bodies if not results.has(f"bodies/{body.name}/position")]


def pack_frames(results: ResultsFile, bodies: Sequence[DrawnBody], wheels: Sequence[Wheel], most: int) -> Packed | None:
    """Each body's position and amplitudes, and each tyre's contact, at equally spaced times; None if the file does not
    hold the motion of all bodies."""
    if list_unknown(results, bodies):
        return None
    count = min(results.time.size, most)
    time = np.linspace(results.time[0], results.time[-1], count)

    def at(values: Floats) -> str:
        return encode(np.interp(time, results.time, values))

    places, amplitudes, tyres = {}, {}, {}
    for body in bodies:
        position, _ = read_numbers(results.file, f"bodies/{body.name}/position")
        places[body.name] = [at(column) for column in position.T]
        if body.shapes.shape[2]:
            values, _ = read_numbers(results.file, f"bodies/{body.name}/modal/amplitude")
            amplitudes[body.name] = [at(column) for column in values.T]
    nearest = np.clip(np.searchsorted(results.time, time), 0, results.time.size - 1)
    for wheel in wheels:
        if not list_force_channels(results, wheel.name):  # not stored: drawn as on the ground, without its force
            ones = np.ones_like(time)
            tyres[wheel.name] = {"contact": encode(ones), "force": encode(0.0 * ones), "off": encode(ones[:0])}
            continue
        contact, force = (read_force_channel(results, wheel.name, role)[0] for role in (CONTACT, FORCE))
        spans = find_spans(contact < 0.5, results.time)
        tyres[wheel.name] = {"contact": encode(contact[nearest]), "force": at(force), "off": encode(spans.ravel())}
    return {
        "first": float(time[0]), "last": float(time[-1]), "count": count, "places": places,
        "amplitudes": amplitudes, "tyres": tyres,
    }  # fmt: skip


def calc_places(results: ResultsFile, body: DrawnBody, samples: Samples) -> Floats:
    """The places of a body's nodes in some samples [n×N×2] m; in equilibrium where the file does not hold its motion,
    and in its own frame where there was none."""
    if results.has(f"bodies/{body.name}/position"):
        return calc_motion(results, body, samples).position
    kept = ("bodies", "modal") if body.shapes.shape[2] > 0 else ("bodies",)
    has_equilibrium = all(results.has(f"model/equilibrium/{one}/{body.name}") for one in kept)
    return (calc_equilibrium(results, body)[0] if has_equilibrium else body.places)[None]


def pack_vehicle(results: ResultsFile, bodies: Sequence[DrawnBody], wheels: Sequence[Wheel]) -> Packed:
    """How the vehicle looks, and the box [m] that it fills: at the start, or throughout the run if it has no wheels."""
    links = read_links(results, bodies)
    # The view follows a vehicle; of a mechanism without wheels it shows the whole motion.
    samples = [0] if wheels else np.unique(np.linspace(0, results.time.size - 1, MOST_SEEN).astype(int))
    boxes = [calc_places(results, body, samples) for body in bodies]
    on_ground = [end[1] for link in links for end in link.ends if end[0] is None]
    corners = np.concatenate([*(box.reshape(-1, 2) for box in boxes), np.reshape(on_ground, (-1, 2))])
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    for wheel in wheels:
        centre = boxes[[body.name for body in bodies].index(wheel.body)][0, wheel.node]
        low, high = np.minimum(low, centre - wheel.radius), np.maximum(high, centre + wheel.radius)
    heavy = find_heavy(results)
    monitored = {point for point in list_monitored(results) if point.partition(".")[2] not in UNMARKED}
    marks = [
        {"body": body.name, "node": node, "name": f"{body.name}.{point}"}
        for body in bodies for point, node in body.points.items() if f"{body.name}.{point}" in monitored
    ]  # fmt: skip
    return {
        "bodies": [
            {"name": body.name, "places": body.places.tolist(), "lines": body.lines.tolist(),
             "shapes": np.round(body.shapes, 9).tolist(), "elements": body.num_elements, "points": body.points}
            for body in bodies
        ],
        "wheels": [wheel._asdict() for wheel in wheels],
        "links": [link._asdict() for link in links],
        "marks": marks, "main": heavy[0] if heavy else bodies[0].name,
        "heading": "+x" if read_direction(results) > 0.0 else "-x",
        "box": [*low.tolist(), *high.tolist()],
    }  # fmt: skip


def pack_road(results: ResultsFile) -> Packed | None:
    """The road as (x, height), thinned like the histories, and the direction in which distance is counted; None without
    a road."""
    road = read_road(results)
    if road is None:
        return None
    x, height = road
    kept = find_kept(height, MOST_ROAD_POINTS)
    origin, direction = (read_real(results.file, "model/road", name) for name in ("origin", "direction"))
    return {"x": encode(x[kept]), "h": encode(height[kept]), "direction": direction, "origin": origin}
