"""Single runs of a vehicle over a road that is made for them, and what its driver feels."""

import math
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import ResultsFile, open_results
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.files.toml_text import split_key, strip_quotes
from sprung_tools.files.whole_file import write_whole
from sprung_tools.limits.root_finding import CallFailed
from sprung_tools.model.resolved_model import read_direction, read_elements, read_settings
from sprung_tools.programs.calls import BAD_INPUT, GOOD, format_overrides, make_command, name_override
from sprung_tools.programs.kept_process import call_kept
from sprung_tools.runs.ride_measures import sampling_step
from sprung_tools.runs.run_warnings import EQUILIBRIUM, list_warnings
from sprung_tools.signals.ride_weighting import HIGHEST, SAMPLES_PER_PERIOD

AHEAD = 2.0  # m of level road before what the vehicle meets
ALIKE = 0.05  # of their mean: radii that share an obstacle's outline, whose own radius is that of wheel and obstacle
COARSEST = 1.0 / (HIGHEST * SAMPLES_PER_PERIOD)  # s between outputs, as for the weightings of ISO 2631-1
PROBE = 1.0  # s, of the run that tells what the vehicle is: less than any other run takes
# Relative, of the mean speed. A car with contact = "point" kept it within 0.01 % over terrain and 1 % over obstacles;
# with contact = "distributed" it lost 4 % over terrain of the limit at 18 m/s, and 32 % at 9 m/s.
SPEED_TOLERANCE = 0.05
NOT_NEEDED = ("recovery", "joints", "wrenches", "forces")
# What a run stores, in place of the run file's own choice: the motion of the point at every output.
STORED = {
    "output.size": 1000.0, "output.step": {},
    "output.store": {"points": "reported", "bodies": "all"} | dict.fromkeys(NOT_NEEDED, "none"),
}  # fmt: skip
# What a run gets here, so that a change of it would have no effect: the first parts of keys, and why.
MADE_HERE: dict[tuple[str, ...], str] = {
    ("continue_from",): "each run begins anew",
    ("speed",): "each run has a speed of its own (--speeds, --speed-range)",
    ("duration",): "each run lasts as long as its way over the road takes",
    ("road",): "each run has a road of its own (--roughness, --heights, and the options of the terrain)",
    ("statistics",): "the span that is judged follows from the road",
    **{("output", key): "each run stores what its limit needs" for key in ("size", "step", "store")},
}


class Variant(NamedTuple):
    """A vehicle as `--set` makes it. overrides: as `--set` takes them."""

    label: str
    overrides: tuple[str, ...]


def check_override(option: str, override: str) -> None:
    """Throws InputError for what is no KEY=VALUE, and for a key without effect. option: of the command line."""
    key, separator, _ = override.partition("=")
    if not separator:
        raise InputError(f"{option}: error: '{override}' is not KEY=VALUE")
    parts = tuple(map(strip_quotes, split_key(key)))
    reason = MADE_HERE.get(parts[:1]) or MADE_HERE.get(parts[:2])
    if reason:
        raise InputError(f"{option}: error: '{override}' would have no effect: {reason}")


class Wheels(NamedTuple):
    """The wheels of a vehicle: from the first to the last one [m]; the radii [m] of those whose contact is a point,
    from the smallest on; whether there are others, which the road slows down."""

    base: float
    point_radii: tuple[float, ...]
    has_others: bool

    @property
    def point_radius(self) -> float | None:
        """The radius [m] of those whose contact is a point: the mean, if they differ by no more than ALIKE; None where
        there are none. InputError for radii that differ more, and where there are wheels of the other kind, too."""
        if not self.point_radii:
            return None
        if self.has_others:
            raise InputError(
                '--heights: error: some wheels have contact = "point" and others contact = "distributed", expected one '
                "of them: an obstacle has one outline for all, the way of a wheel's centre for the first and its own "
                'for the second; give all wheels contact = "distributed"'
            )
        mean = sum(self.point_radii) / len(self.point_radii)
        if self.point_radii[-1] - self.point_radii[0] > ALIKE * mean:
            radii = ", ".join(f"{one:g}" for one in sorted(set(self.point_radii)))
            raise InputError(
                f'--heights: error: the wheels with contact = "point" have the radii {radii} m, expected radii within '
                f'{100 * ALIKE:g} %: an obstacle has one outline for all; give the wheels contact = "distributed"'
            )
        return mean


class Felt(NamedTuple):
    """The vertical acceleration [n] m/s² of the point of the driver, its way forwards from the start [n] m, and the
    time between samples [s]."""

    acceleration: Floats
    way: Floats
    step: float

    def check_speed(self, speed: float, begin: float, end: float) -> None:
        """CallFailed where the mean speed is not the one asked for [m/s]. begin, end: places on the way [m], where the
        vehicle would be after begin / speed and end / speed."""
        first, last = (min(round(place / speed / self.step), self.way.size - 1) for place in (begin, end))
        found = float(self.way[last] - self.way[first]) / ((last - first) * self.step)
        if abs(found - speed) > SPEED_TOLERANCE * speed:
            raise CallFailed(f"at {speed:.4g} m/s asked for, the vehicle drove {found:.4g} m/s on average")


class Vehicle:
    """A run file with the point of the driver, of which single runs are made. scratch: a folder for their files; None:
    the system's."""

    def __init__(
        self, program: Path, run: Path, superelements: Path | None, point: str, variant: Variant,
        scratch: Path | None = None,
    ) -> None:  # fmt: skip
        self.program, self.run, self.superelements, self.variant = program, run, superelements, variant
        self.scratch = scratch
        self.quantity, self.along = f"points/{point}/acceleration.y", f"points/{point}/position.x"
        self.point = point
        self.warnings: list[str] = []  # of all runs but the first
        self.num_doubtful = 0  # runs that warned of what concerns the point
        self.settings: dict[str, Any] = {}  # of all runs but the first
        self.title, self.wheels = self.probe()

    def probe(self) -> tuple[str, Wheels]:
        """Asks a short run for the vehicle's name and its wheels. InputError where the vehicle, its point or its
        wheels cannot be used, or where the run file continues another run."""
        file = TomlFile(self.run)
        if "continue_from" in file.data:
            raise file.fail(("continue_from",), "ride_limits begins each of its runs anew: take a file without it")
        with tempfile.TemporaryDirectory(dir=self.scratch) as name:
            try:
                self.start({"duration": PROBE, "road": {"shape": "flat"}}, Path(name) / "probe.h5")
            except CallFailed as failure:
                raise InputError(str(failure)) from failure
            try:
                with open_results(Path(name) / "probe.h5") as results:
                    results.series(self.quantity)  # throws where there is no such point
                    self.settings = self.choose_outputs(results)
                    return results.title, find_wheels(results)
            except InputError as error:
                raise InputError(str(error).replace(str(Path(name) / "probe.h5"), str(self.run))) from error

    def choose_outputs(self, results: ResultsFile) -> dict[str, Any]:
        """The settings by which the outputs of a run are close enough for the measures, and judged at the point: the
        run's own step, or a whole part of it."""
        step = read_settings(results)["output_step"]
        settings: dict[str, Any] = {"output_step": step / max(1, math.ceil(step / COARSEST - 1e-9))}
        reported = results.names("summary/points")
        if self.point not in reported:
            settings["output.points"] = [*reported, self.point]
        return settings

    def drive(self, speed: float, road: str, duration: float) -> Felt:
        """Drives over a road, the text of a road table. CallFailed for a run that fails, or of which a check
        failed."""
        with tempfile.TemporaryDirectory(dir=self.scratch) as name:
            folder = Path(name)
            write_whole(folder / "road.txt", road)
            table = {"shape": "table", "start": AHEAD, "file": str(folder / "road.txt")}
            step = self.settings["output_step"]
            duration = math.ceil(duration / step) * step  # so that the end is an output
            settings = {**self.settings, "speed": speed, "duration": duration, "road": table}
            self.start(settings, folder / "run.h5")
            with open_results(folder / "run.h5") as results:
                acceleration, _ = results.series(self.quantity)
                along, _ = results.series(self.along)
                found = [one for one in list_warnings(results) if one.section != EQUILIBRIUM]
                self.warnings += dict.fromkeys(one.text for one in found)
                self.num_doubtful += any(self.point in one.of for one in found)
                return Felt(acceleration, read_direction(results) * (along - along[0]), sampling_step(results))

    def start(self, settings: Mapping[str, Any], output: Path) -> None:
        """Makes a run. InputError for an error of the input; CallFailed for a run that does not come
        to its end, or of which a check failed."""
        # What makes this run comes last: it counts before what a variant changes.
        settings = {**STORED, **settings, "statistics.from": 0.0, "statistics.to": settings["duration"]}
        overrides = [*self.variant.overrides, *format_overrides(settings)]
        outcome = call_kept(make_command(self.program, "run", self.run, self.superelements, overrides, output))
        if outcome.exit_code == BAD_INPUT:
            error = name_override(outcome.error, overrides)
            reason = f" (in a run of {settings['duration']:.3g} s that ride_limits made)"
            raise InputError(error + reason if self.is_good_by_itself() else error)
        if outcome.exit_code != GOOD:
            speed = settings.get("speed")
            before = f"at {speed:.4g} m/s " if speed is not None else ""
            raise CallFailed(f"{before}the run failed: {outcome.error.splitlines()[0]}")

    def is_good_by_itself(self) -> bool:
        """Whether the run file has no error without what this module changes: its times, speed and road."""
        command = make_command(self.program, "run", self.run, self.superelements, self.variant.overrides)
        return call_kept([*command, "--dry-run"]).exit_code != BAD_INPUT


def find_wheels(results: ResultsFile) -> Wheels:
    """The wheels of the vehicle of a run. InputError for none."""
    wheels = [force for force in read_elements(results, "forces").values() if force.drawing == "wheel"]
    if not wheels:
        raise InputError(f"{results.path}: error: the vehicle has no wheels on the road")
    places = [results.series(f"points/{wheel.points['wheel']}/position.x")[0][0] for wheel in wheels]
    on_points = [wheel for wheel in wheels if wheel.parameters.get("contact", "point") == "point"]
    radii = sorted(float(wheel.parameters["radius"]) for wheel in on_points)
    return Wheels(float(np.ptp(places)), tuple(radii), len(on_points) < len(wheels))
