"""The look of all pictures of curves, and writing them."""

import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Tick
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.textpath import text_to_path
from numpy.typing import NDArray

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import write_whole

Panels = NDArray[np.object_]  # of Axes [panels]

# Okabe and Ito's colours, which colour-blind readers can distinguish. The first curve lies on top as the thinnest line,
# so that curves that coincide are all seen.
COLOURS = ("#000000", "#0072B2", "#E69F00", "#009E73", "#CC79A7")
THINNEST, THICKER = 1.0, 0.6  # points: the first line's width, and what each further one has more
WIDTH, PANEL_HEIGHT, MARGIN_HEIGHT = 8.0, 3.2, 1.4  # inches; at 100 pixels an inch the text is 11 points
DOTS_PER_INCH = 200
LONGEST_LINE, LONGEST_ENTRY, LONGEST_UPRIGHT = 7.6, 6.0, 2.7  # inches: of a title, in a legend, of an upright label
SHORT_ENTRY = 28  # letters of a legend's longest entry up to which it stands among the curves
SETTINGS = {"font.size": 11, "axes.titlesize": 12, "axes.spines.top": False, "axes.spines.right": False}


def make_figure(
    heights: Sequence[float], title: str, caption: str, one_axis: bool = True, columns: int = 1
) -> tuple[Figure, Panels]:  # fmt: skip
    """Makes a figure of rows of panels. Returns (figure, panels, row by row).

    heights: of the rows [inches]; caption: the small print under them; one_axis: whether they share what is drawn
    over; columns: panels in each row.
    """
    matplotlib.rcParams.update(SETTINGS)
    figure = Figure(figsize=(WIDTH, MARGIN_HEIGHT + sum(heights)), layout="constrained")
    panels = figure.subplots(len(heights), columns, sharex=one_axis, squeeze=False, height_ratios=heights).ravel()
    figure.suptitle(title)
    figure.supxlabel(caption, fontsize=8.5, color="0.25")
    return figure, panels


def line_style(place: int, number: int) -> dict[str, Any]:
    """The keywords of Axes.plot for one of `number` curves. place: of the curve among them, 0-based."""
    return {
        "color": COLOURS[place % len(COLOURS)],
        "linewidth": THINNEST + THICKER * place,
        "zorder": 3.0 - place / number,
    }


def label_unit(unit: str) -> str:
    """A unit as an axis shows it: with raised powers."""
    return unit.replace("^2", "²").replace("^3", "³").replace("^0.5", "^½")


def measure(line: str, font: FontProperties) -> float:
    """The width of a line [points]."""
    width: float = text_to_path.get_text_width_height_descent(line, font, ismath=False)[0]
    return width


def shorten(line: str, font: FontProperties, room: float) -> str:
    """A line that is at most so wide [points]. Its middle is left out if need be, because the end may be a unit."""
    shown, kept = line, len(line)
    widest = font.get_size_in_points()  # of one letter
    while kept * widest > room and measure(shown, font) > room:
        kept = int(0.9 * kept)
        shown = f"{line[: kept - kept // 2]}…{line[len(line) - kept // 2 :]}"
    return shown


def break_line(line: str, font: FontProperties, room: float) -> list[str]:
    """A line that is too wide [points] as two lines, of which the wider one is as narrow as may be. They are divided
    behind a blank, a stroke, a comma or a colon."""
    if len(line) * font.get_size_in_points() <= room or measure(line, font) <= room:
        return [line]
    places = [place for place in range(1, len(line)) if line[place - 1] in " /,:"]
    pairs = [(line[:place].rstrip(), line[place:].lstrip()) for place in places]
    return list(min(pairs, key=lambda pair: max(map(len, pair)), default=(line,)))


def add_legend(axes: Axes) -> None:
    """Adds the legend of a panel: among the curves where its entries are short, else above them."""
    entries = axes.get_legend_handles_labels()[1]
    if max(map(len, entries), default=0) <= SHORT_ENTRY:
        axes.legend(loc="best", frameon=False)
        return
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=1.4, borderpad=0.0, frameon=False,
                fontsize=9.5)  # fmt: skip


def make_plain(artist: Artist, longest: float = LONGEST_LINE) -> None:
    """Names in a picture may hold any letters: draws `$` as it is, and shortens texts that are too long [inches]. It
    leaves those at ticks, whose powers of ten are formulas."""
    for part in artist.get_children():
        if isinstance(part, Text):
            room = 72.0 * (longest if part.get_rotation() == 0.0 else LONGEST_UPRIGHT)
            lines = part.get_text().split("\n")
            if part.get_rotation() != 0.0:
                lines = [piece for line in lines for piece in break_line(line, part.get_fontproperties(), room)]
            part.set_text("\n".join(shorten(line, part.get_fontproperties(), room) for line in lines))
            part.set_parse_math(False)
        elif not isinstance(part, Tick):
            make_plain(part, LONGEST_ENTRY if isinstance(part, Legend) else longest)


def write_picture(figure: Figure, path: str | Path) -> None:
    """Writes a picture whole or not at all. InputError if it cannot be written."""
    make_plain(figure)
    drawn = io.BytesIO()
    try:
        figure.savefig(drawn, format=os.path.splitext(path)[1].lstrip(".") or None, dpi=DOTS_PER_INCH)
    except ValueError as error:
        raise InputError(f"{path}: error: cannot write the picture ({error})") from error
    write_whole(path, drawn.getvalue())
