"""A picture of the frequency response of vehicles to the road, or of their spectral densities or third-octave bands on
a random road."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import read_real, read_text
from sprung_tools.plots.picture_file import PANEL_HEIGHT, add_legend, label_unit, line_style, make_figure
from sprung_tools.runs.labelled_responses import Response
from sprung_tools.runs.labelled_runs import Shown, join_titles
from sprung_tools.runs.ride_of_response import LEAST_IN_BAND, calc_linear_bands
from sprung_tools.signals.third_octaves import BOUNDED, NOMINAL, PROFICIENCY, calc_comfort_boundary

LABELLED_DECADES = (2.0, 0.5)  # of an axis, below which some and all of the ticks between powers of ten have numbers


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
    add_legend(axes)


def draw_bands_panel(axes: Axes, responses: Sequence[Response], shown: Shown) -> None:
    """Draws an output of all files by third-octave bands, with the boundaries of reduced comfort where it is the
    vertical acceleration of a point."""
    unit = ""
    for place, response in enumerate(responses):
        density, _ = response.values(shown.quantity, is_spectrum=True)
        unit = read_text(response.file, f"outputs/{shown.quantity}", "unit")
        found = calc_linear_bands(response.frequency, density)
        if all(value is None for value in found):
            raise InputError(
                f"{response.file.filename}: error: no third-octave band from {NOMINAL[0]:g} to {NOMINAL[-1]:g} Hz has "
                f"{LEAST_IN_BAND} frequencies of the response; take a larger 'number' in [response]"
            )
        values = [np.nan if value is None else value for value in found]
        axes.loglog(NOMINAL, values, marker=".", label=response.label, **line_style(place, len(responses)))
    if shown.quantity.startswith("points/") and shown.quantity.endswith("/acceleration.y"):
        bounded = np.array([one for one in NOMINAL if BOUNDED[0] <= one <= BOUNDED[1]])
        for exposure in PROFICIENCY:
            boundary = calc_comfort_boundary(exposure, bounded)
            axes.loglog(bounded, boundary, color="0.6", linewidth=0.8, linestyle="--")
            axes.annotate(exposure, (bounded[-1], boundary[-1]), color="0.4", fontsize=8.5, va="center")
        axes.plot([], [], color="0.6", linewidth=0.8, linestyle="--", label="reduced comfort after …")
    axes.set_ylabel(f"{shown.label}: r.m.s., {label_unit(unit)}")
    axes.grid(which="both", color="0.9", linewidth=0.6)
    add_legend(axes)


class Drawing(NamedTuple):
    """What a picture shows of the outputs: words for it, and what draws a panel."""

    what: str
    draw_panel: Callable[[Axes, Sequence[Response], Shown], None]


MAGNITUDE = Drawing("response to the road", partial(draw_response_panel, is_spectrum=False))
SPECTRUM = Drawing("spectral density on a random road", partial(draw_response_panel, is_spectrum=True))
BANDS = Drawing("r.m.s. in third-octave bands on a random road, boundaries of ISO 2631:1978", draw_bands_panel)


def make_response_figure(
    responses: Sequence[Response], outputs: Sequence[Shown], title: str, drawing: Drawing
) -> Figure:
    """Draws a panel for each output. title: the heading, the names of the vehicles if empty."""
    speeds = dict.fromkeys(read_real(response.file, "", "speed") for response in responses)
    driven = ", ".join(f"{speed:g}" for speed in speeds)
    caption = f"{drawing.what},\nlinearised about static equilibrium; speed {driven} m/s"
    title = title or join_titles(read_text(response.file, "", "title") for response in responses)
    figure, panels = make_figure([PANEL_HEIGHT] * len(outputs), title, caption)
    for axes, shown in zip(panels, outputs):
        drawing.draw_panel(axes, responses, shown)
        axes.yaxis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=LABELLED_DECADES))
    panels[-1].set_xlabel("frequency, Hz")
    return figure
