"""A picture of the frequency response of vehicles to the road, or of their spectral densities on a random road."""

import os
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import RESPONSE, open_hdf5, read_numbers, read_real, read_text
from sprung_tools.files.stored_file import StoredFile
from sprung_tools.plots.picture_file import PANEL_HEIGHT, label_unit, line_style, make_figure
from sprung_tools.runs.labelled_runs import Shown, split_label

DEEPEST = 5  # parts of an output's name, at most


class Response(NamedTuple):
    """An open response file with its name in the legend. frequency: [m] Hz."""

    label: str
    file: StoredFile
    frequency: Floats

    def values(self, output: str, *, is_spectrum: bool) -> tuple[Floats, str]:
        """Reads the magnitude of an output's response, or its spectral density [m]. Returns (values, unit). InputError
        if the file has none."""
        group = f"outputs/{output}"
        if not self.file.has_dataset(f"{group}/response"):
            raise InputError(f"{self.file.filename}: error: no output '{output}'; there are: {', '.join(self.names())}")
        if not is_spectrum:
            pairs, unit = read_numbers(self.file, f"{group}/response")
            return np.hypot(pairs[:, 0], pairs[:, 1]), unit
        if not self.file.has_dataset(f"{group}/spectrum"):
            raise InputError(f"{self.file.filename}: error: has no spectra: its run file has no [response.road]")
        return read_numbers(self.file, f"{group}/spectrum")

    def rms(self, output: str) -> float:
        """The r.m.s. of an output, from a file with spectra."""
        return read_real(self.file, f"outputs/{output}", "rms")

    def names(self) -> list[str]:
        """The outputs in the file."""
        found: list[str] = []
        waiting = [""]
        while waiting:
            place = waiting.pop()
            if self.file.has_dataset(f"outputs/{place}/response"):
                found.append(place)
            else:
                inside = (f"{place}/{name}".lstrip("/") for name in reversed(self.file.names(f"outputs/{place}")))
                waiting += inside if place.count("/") < DEEPEST else ()
        return found


def open_responses(arguments: Sequence[str]) -> list[Response]:
    """Opens files `[LABEL=]FILE`."""
    responses = []
    for argument in arguments:
        label, path = split_label(argument)
        file = open_hdf5(path, RESPONSE)
        responses.append(Response(label or os.path.basename(path), file, read_numbers(file, "frequency")[0]))
    return responses


def draw_response_panel(axes: Axes, responses: Sequence[Response], shown: Shown, is_spectrum: bool) -> None:
    """Draws one output of all files."""
    for place, response in enumerate(responses):
        values, unit = response.values(shown.quantity, is_spectrum=is_spectrum)
        label = response.label
        if is_spectrum:
            plain = read_text(response.file, f"outputs/{shown.quantity}", "unit")
            label += f": r.m.s. {response.rms(shown.quantity):.3g} {label_unit(plain)}"
        with np.errstate(divide="ignore"):
            axes.loglog(response.frequency, values, label=label, **line_style(place, len(responses)))
    axes.set_ylabel(f"{shown.label}, {label_unit(unit)}" if unit else shown.label)
    axes.grid(which="both", color="0.9", linewidth=0.6)
    axes.legend(loc="best", frameon=False)


def make_response_figure(
    responses: Sequence[Response], outputs: Sequence[Shown], title: str, is_spectrum: bool
) -> Figure:
    """Draws a panel for each output. title: the heading, the vehicle's name if empty."""
    speeds = sorted({read_real(response.file, "", "speed") for response in responses})
    what = "spectral density on a random road" if is_spectrum else "response to the road"
    caption = f"{what}, linearised about static equilibrium; speed {', '.join(f'{speed:g}' for speed in speeds)} m/s"
    title = title or read_text(responses[0].file, "", "title")
    figure, panels = make_figure([PANEL_HEIGHT] * len(outputs), title, caption)
    for axes, shown in zip(panels, outputs):
        draw_response_panel(axes, responses, shown, is_spectrum)
    panels[-1].set_xlabel("frequency, Hz")
    return figure
