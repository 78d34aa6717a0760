"""Draws the frequency response of one or more vehicles to the road, or the spectral densities on a random road, a panel
for each output."""

import os
from typing import NamedTuple

import h5py
import matplotlib
import numpy as np
from matplotlib.figure import Figure

from sprung_tools.files.results_file import ResultsError, open_hdf5, read_numbers, text_of
from sprung_tools.plots.picture_file import (
    MARGIN_HEIGHT,
    PANEL_HEIGHT,
    SETTINGS,
    WIDTH,
    label_unit,
    line_style,
    write_picture,
)
from sprung_tools.runs.labelled_runs import shown_quantities, split_label
from sprung_tools.terminal.program import make_parser

FORMAT = "sprung-response"
VERSION = 1  # newest version of the format that is understood here


class Response(NamedTuple):
    """An open response file with its name in the legend; frequency: [m] Hz."""

    label: str
    file: h5py.File
    frequency: np.ndarray

    def values(self, output, *, is_spectrum):
        """Magnitude of an output's response, or its spectral density [m], and its unit. ResultsError if there is none."""
        group = self.file.get(f"outputs/{output}")
        if not isinstance(group, h5py.Group) or "response" not in group:
            raise ResultsError(f"{self.file.filename}: error: no output '{output}'; there are: {', '.join(self.names())}")
        if not is_spectrum:
            pairs, unit = read_numbers(self.file, f"outputs/{output}/response")
            return np.hypot(pairs[:, 0], pairs[:, 1]), unit
        if "spectrum" not in group:
            raise ResultsError(f"{self.file.filename}: error: has no spectra: its run file has no [response.road]")
        return read_numbers(self.file, f"outputs/{output}/spectrum")

    def rms(self, output):
        """Root mean square of an output, of a file with spectra."""
        return float(self.file[f"outputs/{output}"].attrs["rms"])

    def names(self):
        """The outputs in the file."""
        found = []
        self.file["outputs"].visititems(
            lambda name, item: found.append(name) if isinstance(item, h5py.Group) and "response" in item else None
        )
        return found


def open_responses(arguments):
    """Opens files `[LABEL=]FILE`."""
    responses = []
    for argument in arguments:
        label, path = split_label(argument)
        file = open_hdf5(path, FORMAT, VERSION)
        responses.append(Response(label or os.path.basename(path), file, read_numbers(file, "frequency")[0]))
    return responses


def draw_panel(axes, responses, shown, is_spectrum):
    """One output of all files."""
    for place, response in enumerate(responses):
        values, unit = response.values(shown.quantity, is_spectrum=is_spectrum)
        label = response.label
        if is_spectrum:
            plain = text_of(response.file[f"outputs/{shown.quantity}"].attrs["unit"])
            label += f": r.m.s. {response.rms(shown.quantity):.3g} {label_unit(plain)}"
        with np.errstate(divide="ignore"):
            axes.loglog(response.frequency, values, label=label, **line_style(place, len(responses)))
    axes.set_ylabel(f"{shown.label}, {label_unit(unit)}" if unit else shown.label)
    axes.grid(which="both", color="0.9", linewidth=0.6)
    axes.legend(loc="best", frameon=False)


def make_figure(responses, outputs, title, is_spectrum):
    """A panel for each output."""
    matplotlib.rcParams.update(SETTINGS)
    figure = Figure(figsize=(WIDTH, MARGIN_HEIGHT + PANEL_HEIGHT * len(outputs)), layout="constrained")
    panels = figure.subplots(len(outputs), sharex=True, squeeze=False)[:, 0]
    for axes, shown in zip(panels, outputs):
        draw_panel(axes, responses, shown, is_spectrum)
    panels[-1].set_xlabel("frequency, Hz")
    speeds = sorted({float(response.file.attrs["speed"]) for response in responses})
    what = "spectral density on a random road" if is_spectrum else "response to the road"
    figure.suptitle(title or text_of(responses[0].file.attrs["title"]))
    caption = f"{what}, linearised about static balance; speed {', '.join(f'{speed:g}' for speed in speeds)} m/s"
    figure.supxlabel(caption, fontsize=8.5, color="0.25")
    return figure


def main():
    parser = make_parser(
        __doc__,
        "tools/plot_response -o response.png rigid=rigid.h5 '4 modes=modes.h5' \\\n"
        "    --show 'seat=points/chassis.seat/acceleration.y' --show forces/front_tyre/force",
    )
    parser.add_argument("files", metavar="[LABEL=]FILE", nargs="+", help="response file, and its name in the legend")
    parser.add_argument(
        "--show", metavar="[LABEL=]OUTPUT", action="append", required=True,
        help="an output such as points/chassis.seat/acceleration.y, and its name; may be given several times",
    )  # fmt: skip
    parser.add_argument(
        "-o", "--output", required=True, metavar="PICTURE", help="file to write (.png, .svg, .pdf)"
    )
    parser.add_argument("--title", default="", help="heading; the vehicle's name if not given")
    parser.add_argument("--spectrum", action="store_true", help="spectral densities, with the r.m.s.")
    arguments = parser.parse_args()

    responses = open_responses(arguments.files)
    figure = make_figure(responses, shown_quantities(arguments.show), arguments.title, arguments.spectrum)
    write_picture(figure, arguments.output)
    print(arguments.output)
    return 0
