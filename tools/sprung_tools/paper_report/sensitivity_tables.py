"""The report's tables on how its terrain results depend on the profile and on the speed.

Like those of tables.py they leave out the rows of runs that were not made.
"""

from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.paper_report.paper_runs import BANDS, SEEDS, SPEEDS, TERRAIN, name_modes, name_road, name_speed
from sprung_tools.paper_report.run_numbers import CENTRE, MIDDLE, Numbers, chassis_frequencies
from sprung_tools.signals.spectra import calc_rms
from sprung_tools.terminal.text_table import Table


def make_sensitivity_table(numbers: Numbers) -> Table:
    """Terrain results for each band and seed."""
    rows = []
    for band in BANDS:
        for seed in SEEDS:
            suffix = "" if (band, seed) == (BANDS[0], TERRAIN.seed) else f"_{name_road(band, seed)[:-4]}"
            names = [f"terrain_{name_modes(count)}{suffix}" for count in (0, 2, 4)]
            if not all(map(numbers.has, names)):
                continue
            runs = [numbers.run(name) for name in names]
            middle, centre = ([run.rms_acceleration(point) for run in runs] for point in (MIDDLE, CENTRE))
            rows.append(
                (
                    f"{band.name} 1/m, seed {seed}",
                    f"{1e3 * calc_rms(runs[0].displacement(MIDDLE)):.1f}",
                    *(f"{value:.2f}" for value in middle),
                    f"{100 * (middle[1] / middle[0] - 1):+.0f} %, {100 * (middle[2] / middle[0] - 1):+.0f} %",
                    *(f"{value:.2f}" for value in centre),
                    f"{runs[1].front_end.ratio:.1f}, {runs[2].front_end.ratio:.1f}",
                    f"{runs[2].front_end.frequency:.2f}",
                )
            )
    headings = (
        "terrain", "displacement rigid mm", "middle rigid m/s²", "2 modes", "4 modes", "2, 4 modes over rigid",
        "centre of mass rigid m/s²", "2 modes", "4 modes", "front end peak/static 2, 4 modes",
        "its frequency, 4 modes Hz",
    )  # fmt: skip
    return headings, rows


def make_speed_table(numbers: Numbers) -> Table:
    """Terrain results at several speeds, with the time between both axles in periods of the first bending."""
    rows = []
    for speed in SPEEDS:
        names = [f"terrain_{name_modes(count)}{name_speed(speed)}" for count in (0, 2, 4)]
        if not all(map(numbers.has, names)):
            continue
        runs = [numbers.run(name) for name in names]
        middle = [run.rms_acceleration(MIDDLE) for run in runs]
        periods = calc_wheelbase(runs[2].results) / speed * chassis_frequencies(runs[2], 1)[0]
        rows.append(
            (
                f"{speed:g} m/s",
                f"{periods:.2f}",
                *(f"{value:.2f}" for value in middle),
                f"{100 * (middle[1] / middle[0] - 1):+.0f} %, {100 * (middle[2] / middle[0] - 1):+.0f} %",
                f"{runs[1].front_end.ratio:.1f}, {runs[2].front_end.ratio:.1f}",
                f"{runs[2].front_end.frequency:.2f}",
            )
        )
    headings = (
        "speed", "periods of the first bending from axle to axle", "middle rigid m/s²", "2 modes", "4 modes",
        "2, 4 modes over rigid", "front end peak/static 2, 4 modes", "its frequency, 4 modes Hz",
    )  # fmt: skip
    return headings, rows


def calc_wheelbase(results: ResultsFile) -> float:
    """The distance from the front to the rear axle in static equilibrium [m]."""
    places = [f"model/equilibrium/bodies/{axle}_axle" for axle in ("front", "rear")]
    front, rear = (read_numbers(results.file, place)[0] for place in places)
    return float(abs(rear[0] - front[0]))
