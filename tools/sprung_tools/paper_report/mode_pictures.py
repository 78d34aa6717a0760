"""The report's figures of modes that are chosen from the forcing, or join and leave during the run."""

from matplotlib.figure import Figure

from sprung_tools.paper_report.mode_runs import ALL, TOLERANCES, name_chosen
from sprung_tools.paper_report.paper_runs import name_modes
from sprung_tools.paper_report.run_numbers import MIDDLE, SEAT, Numbers
from sprung_tools.plots.mode_choice_picture import make_choice_figure, open_choice
from sprung_tools.plots.mode_history_picture import make_mode_history_figure
from sprung_tools.runs.labelled_runs import Run, Shown

TITLES = {"bump": "the bump", "terrain": "the terrain"}
SHOWN = [Shown(f"{name}'s acceleration", f"{p}/acceleration.y") for name, p in (("middle", MIDDLE), ("seat", SEAT))]


def draw_choice(numbers: Numbers) -> Figure:
    """Draws how the modes for the terrain were chosen."""
    choice = open_choice(numbers.run(name_chosen("terrain", TOLERANCES[0])).path)
    return make_choice_figure(
        choice, "The choice of modes for the terrain: road, linearised truck, shares of the modes"
    )


def draw_modes_over_time(numbers: Numbers, road: str) -> Figure:
    """Draws which modes took part in an adaptive run, above its acceleration and that with all modes."""
    names = {"adaptive": f"{road}_adaptive", f"all {ALL} modes": f"{road}_{name_modes(ALL)}"}
    runs = [Run(label, numbers.run(name).results) for label, name in names.items()]
    return make_mode_history_figure(
        runs, SHOWN, (None, None), f"Modes that take part over {TITLES[road]}, from 2 with {ALL} available"
    )


def draw_mode_pictures(numbers: Numbers) -> dict[str, Figure]:
    """Draws all of them: file name → figure. There are none if the runs with all modes were not made."""
    if not all(numbers.has(f"{road}_{name_modes(ALL)}") for road in TITLES):
        return {}
    return {
        "terrain_choice.png": draw_choice(numbers),
        "bump_modes.png": draw_modes_over_time(numbers, "bump"),
        "terrain_modes.png": draw_modes_over_time(numbers, "terrain"),
    }
