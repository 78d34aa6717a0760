"""How pictures of curves look, and how they come to the disk."""

import io
import os

import matplotlib
from matplotlib.figure import Figure

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import write_whole

# Okabe and Ito's colours, which stay apart for colour-blind readers. The first curve lies on top as the thinnest line, so
# that curves that coincide are all seen.
COLOURS = ("#000000", "#0072B2", "#E69F00", "#009E73", "#CC79A7")
THINNEST, THICKER = 1.0, 0.6  # points, the first line's width and what each further one has more
WIDTH, PANEL_HEIGHT, MARGIN_HEIGHT = 8.0, 3.2, 1.4  # inches; at 100 pixels an inch the text is 11 points
DOTS_PER_INCH = 200
SETTINGS = {"font.size": 11, "axes.titlesize": 12, "axes.spines.top": False, "axes.spines.right": False}


def make_figure(heights, title, caption):
    """A figure of panels one above the other over one axis. Returns (figure, axes [panels]).

    heights: of each panel [inches]; caption: the small print under the panels.
    """
    matplotlib.rcParams.update(SETTINGS)
    figure = Figure(figsize=(WIDTH, MARGIN_HEIGHT + sum(heights)), layout="constrained")
    panels = figure.subplots(len(heights), sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    figure.suptitle(title)
    figure.supxlabel(caption, fontsize=8.5, color="0.25")
    return figure, panels


def line_style(place, number):
    """How the curve of one of `number` files is drawn, by its place among them (0-based): keywords of Axes.plot."""
    return {
        "color": COLOURS[place % len(COLOURS)],
        "linewidth": THINNEST + THICKER * place,
        "zorder": 3.0 - place / number,
    }


def label_unit(unit):
    """A unit as it stands on an axis: powers raised."""
    return unit.replace("^2", "²").replace("^3", "³").replace("^0.5", "^½")


def write_picture(figure, path):
    """Writes a picture whole or not at all. InputError if it cannot be written."""
    drawn = io.BytesIO()
    try:
        figure.savefig(drawn, format=os.path.splitext(path)[1].lstrip(".") or None, dpi=DOTS_PER_INCH)
    except ValueError as error:
        raise InputError(f"{path}: error: cannot write the picture ({error})") from error
    write_whole(path, drawn.getvalue())
