"""A picture of a frame, coloured by what more steel in each element changes of a frequency."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from sprung_tools.files.array_types import Flags, Floats
from sprung_tools.files.errors import InputError
from sprung_tools.plots.picture_file import make_figure

PANEL_HEIGHT, UPRIGHT_HEIGHT = 2.6, 3.6  # inches, of frames that lie and that stand
UPRIGHT = 2.0  # height over width from which on a frame stands; then panels are side by side
MOST_UPRIGHT = 2  # panels in a row
BAR = (1.1, 0.0, 0.1, 1.0)  # place of the colour bar beside an upright frame, in its panel's size
LINE_WIDTH, SPRING_WIDTH = 5.0, 1.0  # points
MARGIN = 0.05  # of the frame's extent, on each side
FLATTEST = 0.4  # height of what a panel shows over its width, about as that of the panel, or width over height


class Elements(NamedTuple):
    """The elements of a body, and what they do in its free modes."""

    name: str
    frequency: Floats  # [modes] Hz
    ends: Floats  # [elements, 2, 2] m
    effect: Floats  # [elements, modes]: relative change of the frequency by that of the cross section
    is_spring: Flags  # [elements]: it is one of the design's springs, which have no cross section

    def is_upright(self) -> bool:
        """Whether the frame stands."""
        width, height = np.ptp(self.ends, axis=(0, 1))
        return bool(height > UPRIGHT * width)


def read_elements(path: str | Path) -> Elements:
    """Reads what sprung-reduce sensitivity --json printed. InputError for anything else.

    A frequency changes by (U − T)/2 of the change of a cross section, U and T the element's shares of the strain and
    kinetic energy.
    """
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8"))
        elements = data["elements"]
        effect = np.array([one["strain_energy_share"] for one in elements], dtype=float)
        kinetic = np.array([one["kinetic_energy_share"] for one in elements], dtype=float)
        effect = 0.5 * (effect - kinetic)
        named = np.array([str(one["section"]).startswith("springs.") for one in elements])
        ends = np.array([[one["from_m"], one["to_m"]] for one in elements], dtype=float)
        frequency = np.array(data["value"]["free_frequency_hz"], dtype=float)
        found = Elements(str(data["name"]), frequency, ends, effect, named & ~np.any(kinetic, axis=1))
    except OSError as error:
        raise InputError(f"{path}: error: cannot be read ({error.strerror})") from error
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise InputError(f"{path}: error: is not what sprung-reduce sensitivity --json prints") from error
    is_finite = all(np.all(np.isfinite(values)) for values in (found.frequency, found.ends, found.effect))
    shapes = found.frequency.shape, found.effect.shape, found.ends.shape
    if not is_finite or shapes != ((frequency.size,), (len(elements), frequency.size), (len(elements), 2, 2)):
        raise InputError(f"{path}: error: is not what sprung-reduce sensitivity --json prints")
    return found


def draw_mode(axes: Axes, elements: Elements, mode: int) -> LineCollection:
    """Draws the frame for one mode, 0-based: per metre of element, so that long and short ones compare. Springs have no
    colour."""
    is_beam = ~elements.is_spring
    ends = elements.ends[is_beam]
    density = elements.effect[is_beam, mode] / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    largest = float(np.max(np.abs(density), initial=0.0))
    lines = LineCollection(list(ends), array=density, cmap="RdBu_r", linewidths=LINE_WIDTH)
    lines.set_clim(-largest, largest)
    axes.add_collection(lines)
    axes.add_collection(LineCollection(list(elements.ends[elements.is_spring]), colors="0.6", linewidths=SPRING_WIDTH))
    # An aspect that changed the limits would do so after the layout, which would not leave room for other tick labels.
    lowest, highest = elements.ends.min(axis=(0, 1)), elements.ends.max(axis=(0, 1))
    middle, half = 0.5 * (lowest + highest), (0.5 + MARGIN) * (highest - lowest)
    half = np.maximum(half, FLATTEST * half.max())
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    axes.set_aspect("equal", adjustable="box")
    axes.set_ylabel("y in m")
    axes.set_title(f"free mode {mode + 1}, {elements.frequency[mode]:.4g} Hz")
    return lines


def make_sensitivity_figure(elements: Elements, modes: Sequence[int]) -> Figure:
    """Draws a panel for each mode, numbered from 1. InputError for a mode that is not there."""
    for mode in modes:
        if not 1 <= mode <= len(elements.frequency):
            raise InputError(f"--modes: error: {mode} is no mode of the file, expected 1 … {len(elements.frequency)}")
    caption = "colour: change of the frequency in %, by 1 % more cross section of one metre of beam there;  x in m"
    if np.any(elements.is_spring):
        caption += ";\nthin grey: springs, which have no cross section"
    is_upright = elements.is_upright()
    columns = min(len(modes), MOST_UPRIGHT) if is_upright else 1
    heights = [UPRIGHT_HEIGHT if is_upright else PANEL_HEIGHT] * -(-len(modes) // columns)
    figure, panels = make_figure(heights, f"Where steel moves {elements.name}", caption, columns=columns)
    for axes, mode in zip(panels, modes):
        lines = draw_mode(axes, elements, mode - 1)
        if is_upright:  # a bar of the figure would stand at the end of the row, away from a narrow panel
            figure.colorbar(lines, cax=axes.inset_axes(BAR), label="% per m")
        else:
            figure.colorbar(lines, ax=axes, label="% per m")
    for axes in panels[len(modes) :]:
        figure.delaxes(axes)
    return figure
