"""A picture of the frequency response of vehicles to the road, or of their spectral densities on a random road."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sprung_tools.files.hdf5_file import read_real, read_text
from sprung_tools.plots.picture_file import PANEL_HEIGHT, label_unit, line_style, make_figure
from sprung_tools.runs.labelled_responses import Response
from sprung_tools.runs.labelled_runs import Shown


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
