"""All runs of the report on the truck.

Every run is one of the two run files under dynamics/models/truck with `--set`; nothing else is changed.
"""

import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.project import ROOT
from sprung_tools.signals.road_profile import Recipe, format_profile, make_profile

TRUCK = ROOT / "dynamics/models/truck"
DESIGNS = ("meshes/truck/chassis.toml", "meshes/truck/long_arm.toml")
ROADS = ("bump", "terrain")
MODE_COUNTS = (0, 2, 4, 6, 12, 24, 36)  # of the chassis
EXPENSIVE_MODES = 24  # with so many modes or more a run costs several times as much as the paper's
LINKS = ("modes.front_long_arm=2", "modes.rear_long_arm=2")
UNDAMPED = ("modal_damping.chassis=0",)
DISTRIBUTED = tuple(f"vehicle.forces.{axle}_tyre.contact=distributed" for axle in ("front", "rear"))
ADAMS = ("integrator.method=adams",)
# A fixed set without the indicator of the modes left out. The indicator costs as much as all modes, however few the run
# has.
NOT_WATCHED = ("adaptivity.indicator=false",)
FINER = ("integrator.relative_tolerance=1e-8",)
SEEDS = (1, 2, 3)
SPEEDS = (6.5, 7.0, 7.5, 8.0, 8.5)  # m/s over the terrain


class PaperRun(NamedTuple):
    """A run: its name, that of its run file, and what --set changes. The results file is NAME.h5."""

    name: str
    file: str
    overrides: tuple[str, ...]
    is_coarse_elsewhere: bool = False  # its outputs miss what the report does not take of it (COARSE_ELSEWHERE)


class Band(NamedTuple):
    """A band of wavenumbers of a terrain profile [1/m], and its points' spacing [m]: at least five points on the
    shortest wave."""

    name: str
    low: float
    high: float
    spacing: float


# The first band is that of terrain_road.txt.
BANDS = (
    Band("0.055 to 3.3", 0.0545, 3.33, 0.0508),
    Band("0.011 to 3.3", 0.0109, 3.33, 0.0508),
    Band("0.055 to 8.0", 0.0545, 8.0, 0.0127),
)
TERRAIN = Recipe(length=91.44, spacing=0.0508, band=(0.0545, 3.33), rms=0.0264, ease=3.0, seed=1)


def name_modes(count: int) -> str:
    """A number of chassis modes as a part of a run's name."""
    return f"{count}modes" if count else "rigid"


def chassis_modes(count: int) -> tuple[str, ...]:
    """What --set changes for a number of chassis modes."""
    return (f"modes.chassis={count}",)


def count_chassis_modes(run: PaperRun) -> int:
    """The number of chassis modes that a run sets; 0 if it sets none or leaves the choice to the program."""
    counts = [one.partition("=")[2] for one in run.overrides if one.startswith("modes.chassis=")]
    return int(counts[-1]) if counts and counts[-1].isdecimal() else 0


def list_main_runs() -> list[PaperRun]:
    """The paper's cases. Over the bump: rigid, 2 and 4 modes, 2 modes without damping; over terrain: rigid, 2 and 4
    modes, flexible links, 2 modes and flexible links."""
    return [
        *(PaperRun(f"bump_{name_modes(n)}", "bump.toml", chassis_modes(n)) for n in (0, 2, 4)),
        PaperRun("bump_2modes_undamped", "bump.toml", chassis_modes(2) + UNDAMPED),
        *(PaperRun(f"terrain_{name_modes(n)}", "terrain.toml", chassis_modes(n)) for n in (0, 2, 4)),
        PaperRun("terrain_links", "terrain.toml", chassis_modes(0) + LINKS),
        PaperRun("terrain_2modes_links", "terrain.toml", chassis_modes(2) + LINKS),
    ]


def list_convergence_runs() -> list[PaperRun]:
    """Runs over both roads with the numbers of modes that the paper's cases do not have."""
    return [
        PaperRun(f"{run}_{name_modes(n)}", f"{run}.toml", chassis_modes(n))
        for n in MODE_COUNTS
        if n not in (0, 2, 4)
        for run in ROADS
    ]


def list_finer_runs() -> list[PaperRun]:
    """The paper's cases with 4 modes at a hundredth of the integrator's tolerance, which show its error."""
    return [PaperRun(f"{run}_4modes_finer", f"{run}.toml", chassis_modes(4) + FINER) for run in ROADS]


def list_adams_runs() -> list[PaperRun]:
    """Rigid, 2 and 4 modes by Adams' method, which like the paper's does not solve the vibrations exactly."""
    return [
        PaperRun(f"{run}_{name_modes(n)}_adams", f"{run}.toml", chassis_modes(n) + ADAMS)
        for run in ROADS
        for n in (0, 2, 4)
    ]


def list_tyre_runs() -> list[PaperRun]:
    """Rigid, 2 and 4 modes over both roads; the tyres touch a length of road instead of a point."""
    return [
        PaperRun(f"{run}_{name_modes(n)}_distributed", f"{run}.toml", chassis_modes(n) + DISTRIBUTED)
        for run in ROADS
        for n in (0, 2, 4)
    ]


def name_road(band: Band, seed: int) -> str:
    """The file name of a terrain profile."""
    return f"road_{BANDS.index(band) + 1}_seed{seed}.txt"


def read_terrain_file() -> dict[str, Any]:
    """terrain.toml as a dict."""
    return tomllib.loads((TRUCK / "terrain.toml").read_text(encoding="utf-8"))


def name_speed(speed: float) -> str:
    """The suffix of a run's name for its speed; empty for the speed of terrain.toml."""
    return "" if speed == read_terrain_file()["speed"] else f"_speed{speed:g}"


def list_speed_runs() -> list[PaperRun]:
    """Rigid, 2 and 4 modes over the same part of the terrain at other speeds; times are proportional to 1/speed."""
    file = read_terrain_file()
    times = {
        "statistics.from": file["statistics"]["from"],
        "statistics.to": file["statistics"]["to"],
        "duration": file["duration"],
    }
    return [
        PaperRun(
            f"terrain_{name_modes(n)}{name_speed(speed)}",
            "terrain.toml",
            chassis_modes(n)
            + (f"speed={speed:g}", *(f"{key}={time * file['speed'] / speed:.3f}" for key, time in times.items())),
        )
        for speed in SPEEDS
        if speed != file["speed"]
        for n in (0, 2, 4)
    ]


def list_sensitivity_runs(folder: Path) -> list[PaperRun]:
    """Rigid, 2 and 4 modes over each band and seed except the profile of terrain.toml itself. folder: that of the
    roads."""
    return [
        PaperRun(
            f"terrain_{name_modes(n)}_{name_road(band, seed)[:-4]}",
            "terrain.toml",
            chassis_modes(n) + (f"road.file={(folder / name_road(band, seed)).resolve()}",),
        )
        for band in BANDS
        for seed in SEEDS
        if (band, seed) != (BANDS[0], TERRAIN.seed)
        for n in (0, 2, 4)
    ]


def write_roads(folder: Path) -> None:
    """Writes the profiles of list_sensitivity_runs(): the recipe of terrain_road.txt with each band and seed."""
    for band in BANDS:
        for seed in SEEDS:
            recipe = TERRAIN._replace(band=(band.low, band.high), spacing=band.spacing, seed=seed)
            text = format_profile(recipe, make_profile(recipe), "tools/paper_figures")
            (folder / name_road(band, seed)).write_text(text, encoding="utf-8")


def list_timed_main_runs() -> list[PaperRun]:
    """Rigid, 2 and 4 modes over both roads, without the indicator of the modes left out."""
    runs = [run for run in list_main_runs() if "links" not in run.name and "undamped" not in run.name]
    return [run._replace(overrides=run.overrides + NOT_WATCHED) for run in runs]


def name_start(run_name: str) -> str:
    """The name under which the time before a run's first step is kept."""
    return f"{run_name}, start"
