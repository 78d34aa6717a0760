"""Single runs of a vehicle over a road that is made for them, and what its driver feels."""

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import ResultsFile, open_results
from sprung_tools.files.whole_file import write_whole
from sprung_tools.limits.root_finding import CallFailed
from sprung_tools.model.resolved_model import read_elements
from sprung_tools.programs.calls import BAD_INPUT, GOOD, format_overrides, make_command
from sprung_tools.programs.kept_process import call_kept
from sprung_tools.runs.ride_measures import sampling_step

AHEAD = 2.0  # m of level road before what the vehicle meets
PROBE = 0.01  # s, of the run that tells what the vehicle is
STORED = {"output.store.points": "reported"} | {
    f"output.store.{one}": "none" for one in ("recovery", "joints", "wrenches")
}


class Variant(NamedTuple):
    """A vehicle as `--set` makes it. overrides: as `--set` takes them."""

    label: str
    overrides: tuple[str, ...]


class Wheels(NamedTuple):
    """The wheels of a vehicle: from the first to the last one [m]; the radius [m] that all have whose contact is a
    point, None where none has."""

    base: float
    point_radius: float | None


class Felt(NamedTuple):
    """The vertical acceleration [n] m/s² of the point of the driver, and the time between samples [s]."""

    acceleration: Floats
    step: float


class Vehicle:
    """A run file with the point of the driver, of which single runs are made. scratch: a folder for their files; None:
    the system's."""

    def __init__(
        self, program: Path, run: Path, superelements: Path | None, point: str, variant: Variant,
        scratch: Path | None = None,
    ) -> None:  # fmt: skip
        self.program, self.run, self.superelements, self.variant = program, run, superelements, variant
        self.scratch = scratch
        self.quantity = f"points/{point}/acceleration.y"
        self.title, self.wheels = self.probe()

    def probe(self) -> tuple[str, Wheels]:
        """Asks a very short run for the vehicle's name and its wheels. InputError where the vehicle, its point or its
        wheels cannot be used."""
        with tempfile.TemporaryDirectory(dir=self.scratch) as name:
            try:
                self.start({"duration": PROBE, "road": {"shape": "flat"}}, Path(name) / "probe.h5")
            except CallFailed as failure:
                raise InputError(str(failure)) from failure
            try:
                with open_results(Path(name) / "probe.h5") as results:
                    results.series(self.quantity)  # throws where there is no such point
                    return results.title, find_wheels(results)
            except InputError as error:
                raise InputError(str(error).replace(str(Path(name) / "probe.h5"), str(self.run))) from error

    def drive(self, speed: float, road: str, duration: float) -> Felt:
        """Drives over a road, the text of a road table. CallFailed for a run that fails, or whose energy balance does
        not close."""
        with tempfile.TemporaryDirectory(dir=self.scratch) as name:
            folder = Path(name)
            write_whole(folder / "road.txt", road)
            table = {"shape": "table", "start": AHEAD, "file": str(folder / "road.txt")}
            settings = {"speed": speed, "duration": duration, "road": table}
            self.start(settings, folder / "run.h5")
            with open_results(folder / "run.h5") as results:
                results.check_every_output(self.quantity)
                acceleration, _ = results.series(self.quantity)
                return Felt(acceleration, sampling_step(results))

    def start(self, settings: Mapping[str, Any], output: Path) -> None:
        """Makes a run. InputError for an error of the input; CallFailed for a run that does not come
        to its end, or whose energy balance does not close."""
        # What makes this run comes last: it counts before what a variant changes.
        settings = {**settings, "statistics.from": 0.0, "statistics.to": settings["duration"]}
        overrides = [*format_overrides(STORED), *self.variant.overrides, *format_overrides(settings)]
        outcome = call_kept(make_command(self.program, "run", self.run, self.superelements, overrides, output))
        if outcome.exit_code == BAD_INPUT:
            raise InputError(outcome.error)
        if outcome.exit_code != GOOD:
            speed = settings.get("speed")
            before = f"at {speed:.4g} m/s " if speed is not None else ""
            raise CallFailed(f"{before}the run failed: {outcome.error.splitlines()[0]}")


def find_wheels(results: ResultsFile) -> Wheels:
    """The wheels of the vehicle of a run. InputError for none, and for wheels with point contact of several radii."""
    wheels = [force for force in read_elements(results, "forces").values() if force.drawing == "wheel"]
    if not wheels:
        raise InputError(f"{results.path}: error: the vehicle has no wheels on the road")
    places = [results.series(f"points/{wheel.points['wheel']}/position.x")[0][0] for wheel in wheels]
    radii = {
        float(wheel.parameters["radius"]) for wheel in wheels if wheel.parameters.get("contact", "point") == "point"
    }
    if len(radii) > 1:
        raise InputError(
            f'{results.path}: error: the wheels with contact = "point" have different radii, '
            f"{', '.join(f'{one:g}' for one in sorted(radii))} m: an obstacle's outline for all of them is not known"
        )
    return Wheels(float(np.ptp(places)), radii.pop() if radii else None)
