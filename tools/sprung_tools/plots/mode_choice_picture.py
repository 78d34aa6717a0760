"""A picture of how modes were chosen: the road's spectrum, the vehicle's transfer functions, each mode's share."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.files.array_types import Flags, Floats
from sprung_tools.files.errors import InputError, WrongFormatError
from sprung_tools.files.hdf5_file import (
    MODE_CHOICE,
    RESULTS,
    open_hdf5,
    read_numbers,
    read_real,
    read_text,
    read_texts,
)
from sprung_tools.files.stored_file import StoredFile
from sprung_tools.plots.picture_file import COLOURS, PANEL_HEIGHT, add_legend, label_unit, line_style, make_figure

GROUP = "model/mode_choice"
SHARES = {
    "displacement": ("share/displacement_rms", "share/displacement_peak"),
    "acceleration": ("share/acceleration_rms", "share/acceleration_peak"),
    "forces": ("share/force_rms", "share/force_peak"),
    "static": ("share/static",),
}
LEAST_SHARE = 1e-6  # where those of less are drawn


class Choice(NamedTuple):
    """An open file that holds a choice among n modes."""

    file: StoredFile
    tolerance: float
    mode_frequency: Floats  # [n] Hz
    is_kept: Flags  # [n]

    def values(self, name: str) -> tuple[Floats, str]:
        """Reads a dataset of the choice. Returns (values, unit)."""
        return read_numbers(self.file, f"{GROUP}/{name}")

    def points(self) -> list[str]:
        """The points for which the file holds transfer functions."""
        return self.file.names(f"{GROUP}/transfer")

    def share(self, datasets: Iterable[str]) -> Floats:
        """For each mode the largest of several shares [n]."""
        return np.max(np.array([self.values(name)[0] for name in datasets]), axis=0)


def open_choice(path: str | Path) -> Choice:
    """Opens a file of select-modes, or a results file of a run with modes "auto". InputError for any other."""
    try:
        file = open_hdf5(path, RESULTS)
    except WrongFormatError as error:
        if error.found != MODE_CHOICE:
            raise
        file = open_hdf5(path, MODE_CHOICE)
    if not file.has_group(GROUP):
        raise InputError(
            f'{path}: error: no modes were chosen in this run: its [modes] has none "auto"; what they did over time: '
            "--over-time"
        )
    if not file.has_dataset(f"{GROUP}/frequency"):
        remarks = "; ".join(read_texts(file, f"{GROUP}/remarks"))
        raise InputError(f"{path}: error: the modes were not judged: {remarks}")
    return Choice(
        file,
        read_real(file, GROUP, "tolerance"),
        read_numbers(file, f"{GROUP}/mode_frequency")[0],
        read_numbers(file, f"{GROUP}/kept")[0] != 0.0,
    )


def mark_modes(axes: Axes, choice: Choice) -> None:
    """Draws a line at each mode's frequency: solid for the modes kept, dotted for those left out."""
    for kept, style, label in ((True, "-", "mode kept"), (False, ":", "mode left out")):
        for place, frequency in enumerate(np.unique(choice.mode_frequency[choice.is_kept == kept])):
            axes.axvline(frequency, color="0.45", linewidth=0.9, linestyle=style, zorder=0.5,
                         label=label if place == 0 else None)  # fmt: skip


def draw_curves(axes: Axes, choice: Choice, names: Mapping[str, str], label: str) -> None:
    """Draws curves over the frequency. names: name in the legend → dataset."""
    frequency = choice.values("frequency")[0]
    unit = ""
    with np.errstate(divide="ignore"):
        for place, (name, dataset) in enumerate(names.items()):
            values, unit = choice.values(dataset)
            axes.loglog(frequency, np.where(values > 0.0, values, np.nan), label=name, **line_style(place, len(names)))
    mark_modes(axes, choice)
    axes.set_ylabel(f"{label}, {label_unit(unit)}")
    add_legend(axes)


def draw_shares(axes: Axes, choice: Choice) -> None:
    """Draws each mode's share in each kind of quantity."""
    for place, (name, datasets) in enumerate(SHARES.items()):
        share = np.maximum(choice.share(datasets), LEAST_SHARE)
        colour = COLOURS[place % len(COLOURS)]
        for kept in (True, False):
            these = choice.is_kept == kept
            axes.loglog(
                choice.mode_frequency[these], share[these], linestyle="none", marker="o", markersize=6,
                color=colour, markerfacecolor=colour if kept else "white", label=name if kept else None,
            )  # fmt: skip
    if choice.tolerance > 0.0:
        axes.axhline(choice.tolerance, color="0.3", linewidth=0.9, linestyle="--", label="tolerance, of all left out")
    axes.set_ylabel("share of a mode alone")
    add_legend(axes)


def make_choice_figure(choice: Choice, title: str = "") -> Figure:
    """Draws forcing, transfer functions and shares over one axis of frequencies."""
    points = choice.points()
    caption = (
        f"{np.count_nonzero(choice.is_kept)} of {len(choice.is_kept)} modes kept (filled); speed "
        f"{read_real(choice.file, 'model', 'speed'):g} m/s; linearised about static equilibrium"
    )
    if any(np.any(choice.share(datasets) < LEAST_SHARE) for datasets in SHARES.values()):
        caption += f";\nshares below {LEAST_SHARE:g} are drawn as {LEAST_SHARE:g}"
    title = title or read_text(choice.file, "", "title")
    figure, panels = make_figure([PANEL_HEIGHT] * (3 if points else 2), title, caption)
    draw_curves(panels[0], choice, {"road": "road"}, "road under the front wheel")
    if points:
        draw_curves(panels[1], choice, {point: f"transfer/{point}" for point in points}, "acceleration per road")
    draw_shares(panels[-1], choice)
    panels[-1].set_xlabel("frequency, Hz")
    return figure
