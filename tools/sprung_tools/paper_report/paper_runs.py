"""All runs that the report on the truck rests on, and running them.

Every run is one of the two run files under dynamics/models/truck with `--set`; nothing else is changed.
"""

import os
import statistics
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import NamedTuple

import tomllib

from sprung_tools.files.errors import InputError
from sprung_tools.signals.road_profile import Recipe, format_profile, make_profile

ROOT = Path(__file__).resolve().parents[3]
TRUCK = ROOT / "dynamics/models/truck"
DESIGNS = ("meshes/truck/chassis.toml", "meshes/truck/long_arm.toml")
ROADS = ("bump", "terrain")
MODE_COUNTS = (0, 2, 4, 6, 12, 24, 36)  # of the chassis
EXPENSIVE_MODES = 24  # from this many on a run costs several times as much as the paper's
LINKS = ("modes.front_long_arm=2", "modes.rear_long_arm=2")
UNDAMPED = ("modal_damping.chassis=0",)
DISTRIBUTED = tuple(f"vehicle.forces.{axle}_tyre.contact=distributed" for axle in ("front", "rear"))
ADAMS = ("integrator.method=adams",)
# Of a fixed set: not told what it misses. The work of that indicator is that of all modes, whatever the run has.
NOT_WATCHED = ("adaptivity.indicator=false",)
FINER = ("integrator.relative_tolerance=1e-8",)
SEEDS = (1, 2, 3)
SPEEDS = (6.5, 7.0, 7.5, 8.0, 8.5)  # m/s over the terrain
MODES_MISSING = "warning: modes are missing: "
REPEATS = 9  # timed runs of each model


class PaperRun(NamedTuple):
    """A run: the results file's name, its run file's, and what --set changes."""

    name: str
    file: str
    overrides: tuple


class Band(NamedTuple):
    """Wavenumbers of a terrain profile [1/m], and its points' spacing [m]: five points on the shortest wave or more."""

    name: str
    low: float
    high: float
    spacing: float


# The first is that of terrain_road.txt.
BANDS = (
    Band("0.055 to 3.3", 0.0545, 3.33, 0.0508),
    Band("0.011 to 3.3", 0.0109, 3.33, 0.0508),
    Band("0.055 to 8.0", 0.0545, 8.0, 0.0127),
)
TERRAIN = Recipe(length=91.44, spacing=0.0508, band=(0.0545, 3.33), rms=0.0264, ease=3.0, seed=1)


class Programs(NamedTuple):
    """Paths of the two programs."""

    reduce: Path
    dynamics: Path


def name_modes(count):
    return f"{count}modes" if count else "rigid"


def chassis_modes(count):
    return (f"modes.chassis={count}",)


def count_chassis_modes(run):
    """How many modes a run gives the chassis by --set, 0 if it says nothing of it or leaves it to the program."""
    counts = [one.partition("=")[2] for one in run.overrides if one.startswith("modes.chassis=")]
    return int(counts[-1]) if counts and counts[-1].isdecimal() else 0


def list_main_runs():
    """The paper's own cases: over the bump rigid, 2 and 4 modes, 2 without damping; over terrain rigid, 2 and 4 modes,
    flexible links, both."""
    return [
        *(PaperRun(f"bump_{name_modes(n)}", "bump.toml", chassis_modes(n)) for n in (0, 2, 4)),
        PaperRun("bump_2modes_undamped", "bump.toml", chassis_modes(2) + UNDAMPED),
        *(PaperRun(f"terrain_{name_modes(n)}", "terrain.toml", chassis_modes(n)) for n in (0, 2, 4)),
        PaperRun("terrain_links", "terrain.toml", chassis_modes(0) + LINKS),
        PaperRun("terrain_2modes_links", "terrain.toml", chassis_modes(2) + LINKS),
    ]


def list_convergence_runs(counts=MODE_COUNTS):
    """Both runs with each number of modes that the paper's cases do not have."""
    return [
        PaperRun(f"{run}_{name_modes(n)}", f"{run}.toml", chassis_modes(n))
        for n in counts
        if n not in (0, 2, 4)
        for run in ROADS
    ]


def list_finer_runs():
    """The paper's cases with 4 modes at a hundredth of the integrator's tolerance: how far its error reaches."""
    return [
        PaperRun(f"{run}_4modes_finer", f"{run}.toml", chassis_modes(4) + FINER)
        for run in ROADS
    ]


def list_adams_runs():
    """Rigid, 2 and 4 modes by an integrator that knows nothing of vibrations beforehand, as the paper's did not."""
    return [
        PaperRun(f"{run}_{name_modes(n)}_adams", f"{run}.toml", chassis_modes(n) + ADAMS)
        for run in ROADS
        for n in (0, 2, 4)
    ]


def list_tyre_runs():
    """Rigid, 2 and 4 modes over both roads on tyres that touch along a length of road instead of in a point."""
    return [
        PaperRun(f"{run}_{name_modes(n)}_distributed", f"{run}.toml", chassis_modes(n) + DISTRIBUTED)
        for run in ROADS
        for n in (0, 2, 4)
    ]


def name_road(band, seed):
    return f"road_{BANDS.index(band) + 1}_seed{seed}.txt"


def read_terrain_file():
    """terrain.toml as a dict."""
    return tomllib.loads((TRUCK / "terrain.toml").read_text(encoding="utf-8"))


def name_speed(speed):
    """What a run's name has at its end for its speed; nothing for that of terrain.toml."""
    return "" if speed == read_terrain_file()["speed"] else f"_speed{speed:g}"


def list_speed_runs():
    """Rigid, 2 and 4 modes over the terrain at other speeds, over the same metres of it: times go with 1/speed."""
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


def list_sensitivity_runs(folder):
    """Rigid, 2 and 4 modes over each band and seed, but for the profile of terrain.toml itself. folder: of the roads."""
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


def write_roads(folder):
    """Makes the profiles of list_sensitivity_runs(), each by the recipe of terrain_road.txt with its own band and seed."""
    for band in BANDS:
        for seed in SEEDS:
            recipe = TERRAIN._replace(band=(band.low, band.high), spacing=band.spacing, seed=seed)
            text = format_profile(recipe, make_profile(recipe), "tools/paper_figures")
            (folder / name_road(band, seed)).write_text(text, encoding="utf-8")


def find_programs(folder):
    """The programs of a build folder. InputError if they are not there."""
    programs = Programs(folder / "reduce/sprung-reduce", folder / "dynamics/sprung-dynamics")
    for path in programs:
        if not os.access(path, os.X_OK):
            raise InputError(f"{path}: error: no such program; tools/build makes build/release")
    return programs


def call(command):
    """Runs a program in the project's folder. Returns its standard output; InputError with its complaint."""
    done = subprocess.run(
        command, cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise InputError(
            f"{' '.join(map(str, command))}: error: exit code {done.returncode}: {done.stderr.strip()}"
        )
    return done.stdout


def build_superelements(programs, folder):
    """Reduces chassis and long arm into a folder; what is up to date stays."""
    folder.mkdir(parents=True, exist_ok=True)
    call([programs.reduce, "build", *DESIGNS, "--output-dir", folder.resolve()])


def make_command(programs, run, folder, output=None):
    """The command line of a run whose superelements are in `folder`."""
    command = [
        programs.dynamics,
        "run",
        TRUCK / run.file,
        "--superelements",
        folder.resolve(),
        "--quiet",
    ]
    for override in run.overrides:
        command += ["--set", override]
    return command + (["-o", output.resolve()] if output else [])


def list_warnings(said):
    """Of what a program says at the end of a run, the lines that warn."""
    return [line for line in said.splitlines() if line.startswith("warning: ")]


def run_all(programs, runs, folder, report=print):
    """Runs all into FOLDER/NAME.h5, and what each says at its end into FOLDER/NAME.txt; as many at a time as there are
    processors; report(text) is called as each ends.

    InputError at the first that fails, or that the program itself warns of, unless for modes that are missing, which is
    what some of these runs are there to show; what has begun is waited for.
    """
    began = time.monotonic()
    # The longest first, so that none of them is left alone at the end.
    ordered = sorted(runs, key=count_chassis_modes, reverse=True)

    def run_one(run):
        said = call(make_command(programs, run, folder, folder / f"{run.name}.h5"))
        (folder / f"{run.name}.txt").write_text(said, encoding="utf-8")
        for warning in list_warnings(said):
            if not warning.startswith(MODES_MISSING):
                raise InputError(f"{folder / run.name}.h5: error: no run for a report: {warning}")
        return run.name

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        waiting = [pool.submit(run_one, run) for run in ordered]
        try:
            for count, done in enumerate(as_completed(waiting), start=1):
                report(f"[{count:3d}/{len(runs)}] {done.result():<32} {time.monotonic() - began:6.1f} s")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def measure_processor_time(command):
    """Processor time of a program [s], the system's share included."""
    process = subprocess.Popen(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise InputError(f"{' '.join(map(str, command))}: error: exit code {process.returncode}")
    return usage.ru_utime + usage.ru_stime


def list_timed_main_runs():
    """Rigid, 2 and 4 modes over both roads, without the indicator of modes left out."""
    runs = [run for run in list_main_runs() if "links" not in run.name and "undamped" not in run.name]
    return [run._replace(overrides=run.overrides + NOT_WATCHED) for run in runs]


def name_start(run_name):
    """Of the part of a run before its first step."""
    return f"{run_name}, start"


def measure_costs(programs, folder, runs, repeats=REPEATS, report=print):
    """Processor time of runs [s]: dict of run name → median. Of those of one name the first is measured.

    No results are written. The runs take turns, so that whatever else the machine does hits all of them alike. Under
    name_start(run name) stands what goes by before the first step: that of a dry run.
    """
    named = {run.name: run for run in reversed(runs)}
    times = {name: [] for run_name in named for name in (run_name, name_start(run_name))}
    for turn in range(repeats):
        report(f"timing, round {turn + 1} of {repeats}")
        for name, run in named.items():
            command = make_command(programs, run, folder)
            times[name].append(measure_processor_time(command))
            times[name_start(name)].append(measure_processor_time([*command, "--dry-run"]))
    return {name: statistics.median(values) for name, values in times.items()}


def print_progress(text):
    print(text, file=sys.stderr, flush=True)
