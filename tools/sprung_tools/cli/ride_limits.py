"""Finds ride-limiting speeds: over rough terrain, and over half-round obstacles.

At each of --speeds it finds the r.m.s. roughness of random terrain at which the driver absorbs 6 W, and for each of
--heights the lowest speed at which the obstacle gives the driver 2.5 g. It makes the runs that the root finding needs,
for a limit about 4 over terrain, and 5 to 15 over an obstacle. A run that fails, or of which a check failed, is
never used: the limit that needs it is unknown.

Terrain is made as tools/make_road.py makes it, always with the same phases, so that only its height changes. Its
lowest wavenumber of 0.0547 1/m is that of 60 ft, beyond which NRMM takes off the trend of a profile. A wheel whose
contact is a point meets the way that the centre of a rigid wheel would take over the obstacle. RUN.toml gives the
vehicle, its modes and the step of the outputs, of which a whole part is taken where it is longer than the 3.125 ms that
the measures need; each --variant is a vehicle of its own."""

import argparse
import json
import math
import re
import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import check_output
from sprung_tools.limits.ride_limits import GRAVITY, Obstacles, Terrain, find_roughness, find_speed
from sprung_tools.limits.root_finding import ABOVE, BELOW, Root
from sprung_tools.limits.trials import Variant, Vehicle, check_override
from sprung_tools.plots.limits_picture import Curve, make_limits_figure, make_obstacle_panel, make_terrain_panel
from sprung_tools.plots.picture_file import write_picture
from sprung_tools.programs.finding import DYNAMICS, find_program
from sprung_tools.programs.process_pool import count_processors, open_pool
from sprung_tools.signals.absorbed_power import LIMIT
from sprung_tools.signals.road_profile import Recipe
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.progress_bar import Progress
from sprung_tools.terminal.text_table import format_table

JSON_FORMAT, JSON_VERSION = "sprung-ride-limits", 2  # tools/README.md, "Ride limits"
BAND = (0.0547, 3.3)  # 1/m
Task = tuple[Callable[..., Root], Vehicle, Terrain | Obstacles, float]
KMH = 3.6
POINT_NOTE = (
    'remark: wheels with contact = "point" feel no force along the road: the vehicle keeps its speed over obstacles, '
    'which would slow it down; contact = "distributed" has this force'
)


class Found(NamedTuple):
    """A limit of a vehicle: over terrain at a speed [m/s], or over an obstacle of a height [m]; what its runs said, and
    how many of them warned of what concerns the point of the driver."""

    vehicle: Vehicle
    given: float
    root: Root
    warnings: tuple[str, ...]
    num_doubtful: int


class Search(NamedTuple):
    """What is looked for: at speeds [m/s] and heights [m]."""

    speeds: Sequence[float]
    terrain: Terrain
    heights: Sequence[float]
    obstacles: Obstacles


def find_limit(task: Task) -> tuple[Root, tuple[str, ...], int]:
    """The last members of Found; in a process of its own, to which the vehicle comes without warnings."""
    find, vehicle, searched, given = task
    root = find(vehicle, searched, given)
    return root, tuple(vehicle.warnings), vehicle.num_doubtful


def find_limits(
    vehicles: Sequence[Vehicle], search: Search, pool: ProcessPoolExecutor
) -> tuple[list[Found], list[Found]]:
    """All limits of all vehicles, over terrain and over obstacles."""
    tasks: list[Task] = [
        *((find_roughness, one, search.terrain, speed) for one in vehicles for speed in search.speeds),
        *((find_speed, one, search.obstacles, height) for one in vehicles for height in search.heights),
    ]
    limits = [pool.submit(find_limit, task) for task in tasks]
    with Progress("limits", len(tasks)) as progress:
        for limit in as_completed(limits):
            limit.result()  # throws an error of the input at once
            progress.step()
    all_found = [Found(vehicle, given, *limit.result()) for (_, vehicle, _, given), limit in zip(tasks, limits)]
    over_terrain = len(vehicles) * len(search.speeds)
    return all_found[:over_terrain], all_found[over_terrain:]


def describe_root(root: Root, low: float, high: float, unit: str) -> str:
    """Why there is no root, in words; empty if there is one."""
    if root.problem:
        return root.problem
    return {"": "", BELOW: f"already at {low:g} {unit}", ABOVE: f"not up to {high:g} {unit}"}[root.side]


def describe_height(one: Found) -> str:
    """What makes an obstacle doubtful; empty if nothing does."""
    radii = one.vehicle.wheels.point_radii
    if not radii or one.given <= radii[0]:
        return ""
    return f"higher than the wheel's hub at {1e3 * radii[0]:.0f} mm: a vehicle would hardly get over"


def describe_doubt(one: Found) -> str:
    """What makes a limit doubtful because of its runs; empty if nothing does."""
    if one.root.value is None or not one.num_doubtful:
        return ""
    return f"doubtful: {one.num_doubtful} of its runs warned of {one.vehicle.point}, see below"


def describe_obstacle(one: Found) -> str:
    """All that makes the limit over an obstacle doubtful."""
    return "; ".join(filter(None, (describe_height(one), describe_doubt(one))))


def list_warnings(found: Sequence[Found]) -> list[str]:
    """What the runs of each vehicle warned of, once where only the numbers differ, and in how many runs."""
    first: dict[tuple[str, str], str] = {}
    counts: Counter[tuple[str, str]] = Counter()
    for one in found:
        for text in one.warnings:
            key = (one.vehicle.variant.label, re.sub(r"\d[\d.e+-]*", "#", text))
            first.setdefault(key, text)
            counts[key] += 1
    runs: Counter[str] = Counter()
    for one in found:
        runs[one.vehicle.variant.label] += one.root.calls
    return [f"{key[0]}: in {counts[key]} of {runs[key[0]]} runs: {text}" for key, text in first.items()]


def make_tables(search: Search, terrain: Sequence[Found], obstacles: Sequence[Found]) -> str:
    """The tables of both kinds of limits."""
    text = []
    bounds = (1e3 * search.terrain.roughness[0], 1e3 * search.terrain.roughness[1], "mm")
    rows = [
        (one.vehicle.variant.label, f"{one.given:g}", f"{KMH * one.given:.1f}",
         "–" if one.root.value is None else f"{1e3 * one.root.value:.1f}", str(one.root.calls),
         "; ".join(filter(None, (describe_root(one.root, *bounds), describe_doubt(one)))))
        for one in terrain
    ]  # fmt: skip
    if rows:
        heading = f"r.m.s. mm at {search.terrain.power:g} W"
        text.append(format_table(("vehicle", "m/s", "km/h", heading, "runs", "remark"), rows))
    rows = [
        (one.vehicle.variant.label, f"{1e3 * one.given:g}", *format_speed(one.root.value), str(one.root.calls),
         "; ".join(filter(None, (describe_root(one.root, *search.obstacles.speeds, "m/s"), describe_obstacle(one)))))
        for one in obstacles
    ]  # fmt: skip
    if rows:
        heading = f"km/h at {search.obstacles.acceleration / GRAVITY:g} g"
        text.append(format_table(("vehicle", "obstacle mm", "m/s", heading, "runs", "remark"), rows))
    if any(one.vehicle.wheels.point_radii for one in obstacles):
        text.append(POINT_NOTE)
    warnings = list_warnings([*terrain, *obstacles])
    if warnings:
        text.append("\n".join(f"warning: {one}" for one in warnings))
    return "\n\n".join(text)


def format_speed(speed: float | None) -> tuple[str, str]:
    """A speed in m/s and km/h."""
    return ("–", "–") if speed is None else (f"{speed:.2f}", f"{KMH * speed:.1f}")


def pack_found(one: Found, given: str, value: str) -> dict[str, Any]:
    """A limit for JSON."""
    return {
        given: one.given, value: one.root.value, "beyond": one.root.side, "problem": one.root.problem,
        "runs": one.root.calls,
    }  # fmt: skip


def make_json(
    run: Path, point: str, vehicles: Sequence[Vehicle], search: Search, terrain: Sequence[Found],
    obstacles: Sequence[Found],
) -> str:  # fmt: skip
    """Everything as JSON, in SI units."""
    packed = [
        {"label": one.variant.label, "set": one.variant.overrides,
         "terrain": [{**pack_found(found, "speed", "roughness"), "remark": describe_doubt(found)} for found in terrain
                     if found.vehicle is one],
         "obstacles": [{**pack_found(found, "height", "speed"), "remark": describe_obstacle(found)} for found in
                       obstacles if found.vehicle is one],
         "warnings": list_warnings([found for found in (*terrain, *obstacles) if found.vehicle is one])}
        for one in vehicles
    ]  # fmt: skip
    recipe = search.terrain.recipe._asdict()
    whole = {
        "format": JSON_FORMAT, "version": JSON_VERSION, "run": str(run), "point": point,
        "power": search.terrain.power, "acceleration": search.obstacles.acceleration,
        "low_pass": search.obstacles.low_pass,
        "terrain": {key: recipe[key] for key in ("length", "spacing", "band", "exponent", "ease", "seed")},
        "vehicles": packed,
    }  # fmt: skip
    return json.dumps(whole, indent=1, ensure_ascii=False, allow_nan=False)


def make_curves(
    vehicles: Sequence[Vehicle], found: Sequence[Found], is_terrain: bool, bounds: tuple[float, float]
) -> list[Curve]:
    """The curves of a picture: of terrain the roughness is what was found, of obstacles the speed. bounds: of it."""
    at_bounds = dict(zip((BELOW, ABOVE), bounds))
    curves = []
    for vehicle in vehicles:
        points: dict[str, list[tuple[float, float]]] = {"": [], BELOW: [], ABOVE: []}
        for one in (one for one in found if one.vehicle is vehicle):
            value = at_bounds.get(one.root.side, one.root.value)
            if value is not None:
                points[one.root.side].append((value, one.given) if is_terrain else (one.given, value))
        curves.append(Curve(vehicle.variant.label, points[""], points[BELOW], points[ABOVE]))
    return curves


def read_variants(given: Sequence[Sequence[str]], common: Sequence[str]) -> list[Variant]:
    """The vehicles of the command line. InputError for a change without a value or without effect, and for a label
    given twice."""
    for change in common:
        check_override("--set", change)
    for label, *changes in given:
        for change in changes:
            check_override(f"--variant {label}", change)
    variants = [Variant(label, (*common, *changes)) for label, *changes in given] or [Variant("vehicle", tuple(common))]
    labels = [one.label for one in variants]
    for label in labels:
        if labels.count(label) > 1:
            raise InputError(f"--variant: error: the label '{label}' stands twice")
    return variants


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(
        __doc__,
        "tools/ride_limits dynamics/models/truck/terrain.toml --superelements build/truck --point chassis.seat \\\n"
        "    --variant rigid modes.chassis=0 --variant '2 modes' modes.chassis=2 --speeds 6 9 --heights 0.2 \\\n"
        "    -o limits.png",
    )
    parser.add_argument("run", type=Path, metavar="RUN.toml", help="run file of the vehicle")
    parser.add_argument("--superelements", type=Path, metavar="FOLDER", help="folder of the superelement files")
    parser.add_argument("--point", required=True, metavar="BODY.POINT", help="the point of the driver")
    parser.add_argument("--variant", nargs="+", action="append", default=[], metavar=("LABEL", "KEY=VALUE"),
                        help="a vehicle: its name, and what it changes; may be given several times")  # fmt: skip
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a change of all vehicles")
    parser.add_argument("--speeds", type=float, nargs="*", default=(4.0, 6.0, 9.0, 13.0, 18.0), metavar="M/S",
                        help="speeds over terrain (default: 4 6 9 13 18)")  # fmt: skip
    parser.add_argument("--heights", type=float, nargs="*", default=(0.1, 0.15, 0.2, 0.25, 0.3, 0.4), metavar="M",
                        help="heights of obstacles (default: 0.1 0.15 0.2 0.25 0.3 0.4)")  # fmt: skip
    parser.add_argument("--power", type=float, default=LIMIT, metavar="W", help=f"limit of absorbed power ({LIMIT:g})")
    parser.add_argument("--peak", type=float, default=2.5, metavar="G", help="limit of the acceleration (2.5)")
    parser.add_argument("--low-pass", type=float, metavar="HZ", help="filter the acceleration over obstacles")
    parser.add_argument("--roughness", type=float, nargs=2, default=(0.002, 0.15), metavar=("LEAST", "GREATEST"),
                        help="r.m.s. that is tried, m (0.002 0.15)")  # fmt: skip
    parser.add_argument("--speed-range", type=float, nargs=2, default=(1.0, 25.0), metavar=("LEAST", "GREATEST"),
                        help="speeds that are tried over obstacles, m/s (1 25)")  # fmt: skip
    parser.add_argument("--length", type=float, default=200.0, metavar="M", help="of the terrain (200)")
    parser.add_argument("--spacing", type=float, default=0.05, metavar="M", help="of its points (0.05)")
    parser.add_argument("--band", type=float, nargs=2, default=BAND, metavar=("LOW", "HIGH"),
                        help="its wavenumbers, 1/m (0.0547 3.3)")  # fmt: skip
    parser.add_argument("--exponent", type=float, default=2.0, metavar="W", help="of its spectrum (2)")
    parser.add_argument("--ease", type=float, default=10.0, metavar="M", help="length of the easing at its ends (10)")
    parser.add_argument("--seed", type=int, default=1, help="of its phases (1)")
    parser.add_argument("--jobs", type=int, default=count_processors(), metavar="N",
                        help="runs at the same time (default: as many as there are processors)")  # fmt: skip
    parser.add_argument("-o", "--output", metavar="PICTURE", help="picture to write (.png, .svg, .pdf)")
    parser.add_argument("--json", action="store_true", help="print one JSON object with all numbers in SI units")
    return parser.parse_args()


def check_positive(name: str, values: Sequence[float]) -> None:
    """Throws InputError for a value that is not positive and finite."""
    for value in values:
        if not 0.0 < value < math.inf:
            raise InputError(f"{name}: error: is {value:g}, expected a finite value > 0")


def read_search(arguments: argparse.Namespace) -> Search:
    """What is looked for by the command line. InputError for values that cannot be."""
    for name in ("speeds", "heights", "roughness", "speed_range"):
        check_positive(f"--{name.replace('_', '-')}", getattr(arguments, name))
    check_positive("--power", [arguments.power])
    check_positive("--peak", [arguments.peak])
    check_positive("--low-pass", [] if arguments.low_pass is None else [arguments.low_pass])
    for name in ("roughness", "speed_range"):
        low, high = getattr(arguments, name)
        if not low < high:
            raise InputError(f"--{name.replace('_', '-')}: error: got {low:g} {high:g}, expected two ascending values")
    if not arguments.speeds and not arguments.heights:
        raise InputError("--speeds: error: there are neither speeds nor --heights")
    low, high = arguments.band
    recipe = Recipe(arguments.length, arguments.spacing, (low, high), arguments.exponent, ease=arguments.ease,
                    seed=arguments.seed)  # fmt: skip
    roughness, speeds = arguments.roughness, arguments.speed_range
    terrain = Terrain(recipe, (roughness[0], roughness[1]), arguments.power)
    obstacles = Obstacles((speeds[0], speeds[1]), arguments.peak * GRAVITY, arguments.low_pass)
    return Search(arguments.speeds, terrain, arguments.heights, obstacles)


def main() -> int:
    arguments = parse_arguments()
    if arguments.output:
        check_output(arguments.output, [arguments.run])
    search = read_search(arguments)
    variants = read_variants(arguments.variant, arguments.set)
    if arguments.jobs < 1:
        raise InputError(f"--jobs: error: must be at least 1, got {arguments.jobs}")
    program = find_program(DYNAMICS)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch, open_pool(arguments.jobs) as pool:
        make_vehicle = partial(Vehicle, program, arguments.run, arguments.superelements, arguments.point,
                               scratch=Path(scratch))  # fmt: skip
        try:
            vehicles = list(pool.map(make_vehicle, variants))
            if search.heights:
                for one in vehicles:
                    _ = one.wheels.point_radius  # throws before the first run where there is none
            terrain, obstacles = find_limits(vehicles, search, pool)
        except BrokenProcessPool as error:
            raise InputError("ride_limits: error: one of its processes was ended from outside") from error
    if arguments.output:
        roughness, speeds = search.terrain.roughness, search.obstacles.speeds
        over_terrain = make_curves(vehicles, terrain, True, roughness)
        over_obstacles = make_curves(vehicles, obstacles, False, speeds)
        panels = (make_terrain_panel(over_terrain, search.terrain.power, roughness),
                  make_obstacle_panel(over_obstacles, f"{arguments.peak:g} g", speeds))  # fmt: skip
        write_picture(make_limits_figure(vehicles[0].title, panels), arguments.output)
    if arguments.json:
        print(make_json(arguments.run, arguments.point, vehicles, search, terrain, obstacles))
    else:
        print(make_tables(search, terrain, obstacles))
    return 0
