"""The report's figures: the paper's Figures 9 to 14, the spectra of the chassis' acceleration, and the terrain."""

import io
from collections.abc import Iterable, Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

from sprung_tools.files.array_types import Floats
from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.whole_file import write_whole
from sprung_tools.model.resolved_model import read_settings
from sprung_tools.paper_report.mode_pictures import draw_mode_pictures
from sprung_tools.paper_report.run_numbers import CENTRE, FRONT_END, MIDDLE, Numbers, RunNumbers, chassis_frequencies
from sprung_tools.plots.picture_file import Panels
from sprung_tools.runs.run_caption import make_caption
from sprung_tools.signals.spectra import calc_amplitude_spectrum, calc_power_spectrum

Curves = dict[str, RunNumbers]  # label → run

# Okabe and Ito's colours, which colour-blind readers can distinguish; the first run is drawn on top as the thinnest
# line.
COLOURS = {"rigid": "#000000", "2 modes": "#0072B2", "4 modes": "#E69F00", "2 modes, flexible arms": "#CC79A7",
           "2 modes, no modal damping": "#D55E00"}  # fmt: skip
THINNEST, THICKER = 0.9, 0.7  # points: the first line's width, and what each further one has more
WIDTH = 8.0  # inches
DOTS_PER_INCH = 120  # 960 pixels: a README's column
PALETTE = 256  # colours in a picture, so that its file is small
LABELS = {"displacement": ("vertical displacement, mm", 1e3), "acceleration": ("vertical acceleration, m/s²", 1.0)}
POINTS = {"middle of the chassis": MIDDLE, "centre of mass": CENTRE}
SEGMENT = 4.0  # s, a segment of the averaged spectra
HIGHEST = 60.0  # Hz drawn


def make_report_figure(
    panels: int, height: float, title: str, runs: Iterable[RunNumbers], remarks: Sequence[str] = ()
) -> tuple[Figure, Panels]:
    """Makes an empty figure with panels one above the other. Returns (figure, panels)."""
    matplotlib.rcParams.update(
        {"font.size": 11, "axes.titlesize": 11, "axes.spines.top": False, "axes.spines.right": False}
    )
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    axes = figure.subplots(panels, squeeze=False)[:, 0]
    figure.suptitle(title, fontsize=12)
    figure.supxlabel(make_caption([run.results for run in runs], remarks), fontsize=8.5, color="0.25")
    for panel in axes:
        panel.grid(color="0.9", linewidth=0.6)
    return figure, axes


def draw_histories(
    axes: Axes, curves: Curves, quantity: str, factor: float = 1.0, span: tuple[float, float] | None = None
) -> None:
    """Draws curves over time. span: what is shown [s], the statistics window if None."""
    for place, (label, run) in enumerate(curves.items()):
        start, end = span or run.window
        inside = (run.results.time >= start) & (run.results.time <= end)
        values, _ = run.results.series(quantity)
        axes.plot(
            run.results.time[inside], factor * values[inside], label=label, color=COLOURS[label],
            linewidth=THINNEST + THICKER * place, zorder=3.0 - 0.1 * place,
        )  # fmt: skip
        axes.set_xlim(start, end)
    axes.axhline(0.0, color="0.6", linewidth=0.8, zorder=0)


def label_panels(figure: Figure, axes: Panels, label: str, legend: bool = True) -> Figure:
    """Labels the axes of all panels, and draws the legend in the first one."""
    axes[-1].set_xlabel("time, s")
    for panel in axes:
        panel.set_ylabel(label)
    if legend:
        axes[0].legend(loc="best", frameon=False)
    return figure


def pick_models(numbers: Numbers, road: str, counts: Iterable[int]) -> Curves:
    """The runs over a road with some numbers of chassis modes."""
    return {("rigid" if count == 0 else f"{count} modes"): numbers.modes(road, count) for count in counts}


def draw_bump_displacement(numbers: Numbers) -> Figure:
    """Figure 9: displacement over the bump of the chassis' middle and of its centre of mass; the difference from
    rigid."""
    label, factor = LABELS["displacement"]
    curves = pick_models(numbers, "bump", (0, 2, 4))
    figure, axes = make_report_figure(3, 8.0, "Fig. 9: chassis over the bump, vertical displacement", curves.values())
    for panel, (name, point) in zip(axes, POINTS.items()):
        draw_histories(panel, curves, f"{point}/displacement.y", factor)
        panel.set_title(name, loc="left")
    rigid = curves["rigid"]
    for model in ("2 modes", "4 modes"):
        difference = curves[model].displacement(MIDDLE) - rigid.displacement(MIDDLE)
        time = rigid.results.time[rigid.inside]
        axes[2].plot(time, factor * difference, color=COLOURS[model], linewidth=THINNEST + THICKER)
    axes[2].set_title("middle of the chassis: difference from rigid", loc="left")
    axes[2].set_xlim(axes[0].get_xlim())
    axes[1].set_ylim(axes[0].get_ylim())
    return label_panels(figure, axes, label)


def draw_bump_acceleration(numbers: Numbers) -> Figure:
    """Figure 10: acceleration over the bump of the chassis' middle and of its centre of mass."""
    curves = pick_models(numbers, "bump", (0, 2, 4))
    figure, axes = make_report_figure(2, 6.4, "Fig. 10: chassis over the bump, vertical acceleration", curves.values())
    for panel, (name, point) in zip(axes, POINTS.items()):
        draw_histories(panel, curves, f"{point}/acceleration.y", span=(0.2, 3.2))
        panel.set_title(name, loc="left")
    axes[1].set_ylim(axes[0].get_ylim())
    return label_panels(figure, axes, LABELS["acceleration"][0])


def draw_damping(numbers: Numbers) -> Figure:
    """Figure 11: the same with and without modal damping."""
    curves = {
        "2 modes": numbers.run("bump_2modes"),
        "2 modes, no modal damping": numbers.run("bump_2modes_undamped"),
    }
    title = "Fig. 11: middle of the chassis over the bump, 2 modes, 1 % or no modal damping"
    figure, axes = make_report_figure(1, 4.2, title, curves.values())
    draw_histories(axes[0], curves, f"{MIDDLE}/acceleration.y", span=(0.0, 5.0))
    return label_panels(figure, axes, LABELS["acceleration"][0])


def draw_terrain_displacement(numbers: Numbers) -> Figure:
    """Figure 12: displacement of all models over the terrain."""
    curves = pick_models(numbers, "terrain", (0, 2, 4)) | {
        "2 modes, flexible arms": numbers.run("terrain_2modes_links")
    }
    label, factor = LABELS["displacement"]
    title = "Fig. 12: middle of the chassis over terrain, vertical displacement"
    figure, axes = make_report_figure(2, 6.0, title, curves.values())
    draw_histories(axes[0], curves, f"{MIDDLE}/displacement.y", factor)
    draw_histories(axes[1], curves, f"{MIDDLE}/displacement.y", factor, (5.0, 7.0))
    axes[1].set_title("two seconds of it", loc="left")
    label_panels(figure, axes, label)
    axes[0].get_legend().remove()
    axes[1].legend(loc="lower right", frameon=False, fontsize=9)
    return figure


def draw_terrain_acceleration(numbers: Numbers) -> Figure:
    """Figure 13: acceleration over the terrain, rigid and 2 modes one above the other; then two seconds of all
    models."""
    curves = pick_models(numbers, "terrain", (0, 2, 4)) | {
        "2 modes, flexible arms": numbers.run("terrain_2modes_links")
    }
    title = "Fig. 13: middle of the chassis over terrain, vertical acceleration"
    figure, axes = make_report_figure(3, 8.4, title, curves.values())
    for panel, label in zip(axes, ("rigid", "2 modes")):
        draw_histories(panel, {label: curves[label]}, f"{MIDDLE}/acceleration.y")
        panel.set_title(label, loc="left")
    limit = 1.05 * max(run.peak_acceleration(MIDDLE) for run in curves.values())
    draw_histories(axes[2], curves, f"{MIDDLE}/acceleration.y", span=(5.0, 7.0))
    axes[2].set_title("two seconds of all models", loc="left")
    for panel in axes:
        panel.set_ylim(-limit, limit)
    label_panels(figure, axes, LABELS["acceleration"][0], legend=False)
    axes[2].legend(loc="lower right", frameon=False, ncols=4, fontsize=9)
    return figure


def draw_front_end(numbers: Numbers) -> Figure:
    """Figure 14: the front end's deflection over terrain with 2 modes, and with 2 and 4 modes."""
    curves = pick_models(numbers, "terrain", (2, 4))
    title = "Fig. 14: deflection of the chassis' front end over terrain, in the body frame"
    figure, axes = make_report_figure(2, 6.0, title, curves.values())
    draw_histories(axes[0], {"2 modes": curves["2 modes"]}, FRONT_END, 1e3)
    draw_histories(axes[1], curves, FRONT_END, 1e3, (5.0, 7.0))
    axes[1].set_title("two seconds of it, with 2 and with 4 modes", loc="left")
    static = 1e3 * curves["2 modes"].front_end.static
    axes[0].axhline(static, color="0.3", linestyle=":", linewidth=1.2)
    axes[0].set_title(f"2 modes; dotted: static deflection, {static:.2f} mm", loc="left")
    label_panels(figure, axes, "vertical deflection, mm", legend=False)
    axes[1].set_ylim(bottom=-9.0)
    axes[1].legend(loc="lower left", frameon=False, ncols=2)
    return figure


def mark_frequencies(axes: Axes, run: RunNumbers, label: str) -> None:
    """Draws the assembled vehicle's undamped frequencies as lines; those of bending are labelled."""
    for frequency in run.frequencies[run.frequencies < HIGHEST]:
        axes.axvline(frequency, color=COLOURS[label], linestyle=":", linewidth=1.1, zorder=1)
    for frequency in chassis_frequencies(run, run.frequencies.size):
        if frequency < HIGHEST:
            shift = 3 if label == "2 modes" else -11
            axes.annotate(
                f"{frequency:.2f}", (frequency, 0.97), xycoords=("data", "axes fraction"), xytext=(shift, 0),
                textcoords="offset points", rotation=90, va="top", fontsize=8.5, color=COLOURS[label],
            )  # fmt: skip


def draw_spectra(numbers: Numbers) -> Figure:
    """Spectra of the middle's acceleration over both roads, with the assembled truck's frequencies."""
    bump, terrain = (pick_models(numbers, road, (0, 2, 4)) for road in ("bump", "terrain"))
    title = "Spectra of the middle of the chassis' vertical acceleration"
    remark = "dotted: undamped frequencies of the assembled truck, in the model's colour"
    figure, axes = make_report_figure(2, 6.6, title, [*bump.values(), *terrain.values()], (remark,))
    for place, (label, run) in enumerate(bump.items()):
        frequency, amplitude = calc_amplitude_spectrum(run.acceleration(MIDDLE), run.step)
        draw_spectrum(axes[0], frequency, amplitude, label, place)
        mark_frequencies(axes[0], run, label)
    for place, (label, run) in enumerate(terrain.items()):
        frequency, density = calc_power_spectrum(run.acceleration(MIDDLE), run.step, SEGMENT)
        draw_spectrum(axes[1], frequency, np.sqrt(density), label, place)
        mark_frequencies(axes[1], run, label)
    axes[0].set_title(f"bump at {format_speed(bump)}: amplitudes over the whole run", loc="left")
    axes[1].set_title(f"terrain at {format_speed(terrain)}: averaged over spans of {SEGMENT:g} s", loc="left")
    axes[0].set_ylabel("amplitude, m/s²")
    axes[1].set_ylabel("√(power density), m/s²/√Hz")
    axes[1].set_xlabel("frequency, Hz")
    for panel in axes:
        panel.set_xlim(0.0, HIGHEST)
        panel.set_ylim(bottom=0.0)
    axes[0].legend(loc="upper center", bbox_to_anchor=(0.75, 1.0), frameon=False)
    return figure


def format_speed(curves: Curves) -> str:
    """The speed of some runs."""
    return f"{read_settings(curves['rigid'].results)['speed']:g} m/s"


def draw_spectrum(axes: Axes, frequency: Floats, values: Floats, label: str, place: int) -> None:
    """Draws one spectrum up to HIGHEST. place: of the curve among those in the panel."""
    shown = (frequency > 0.0) & (frequency <= HIGHEST)
    axes.plot(frequency[shown], values[shown], label=label, color=COLOURS[label],
              linewidth=THINNEST + THICKER * place, zorder=3.0 - 0.1 * place)  # fmt: skip


def draw_terrain(numbers: Numbers) -> Figure:
    """The terrain's heights."""
    run = numbers.run("terrain_rigid")
    distance, _ = read_numbers(run.results.file, "model/road/distance")
    height, _ = read_numbers(run.results.file, "model/road/height")
    figure, axes = make_report_figure(1, 3.2, "The terrain: heights along the way", [run])
    axes[0].plot(distance, 1e3 * height, color="0.25", linewidth=0.9)
    axes[0].set_xlim(0.0, 94.0)
    axes[0].set_ylabel("height, mm")
    axes[0].set_xlabel("distance from under the front axle at the start, m")
    return figure


def draw_all(numbers: Numbers) -> dict[str, Figure]:
    """Draws all figures: file name → figure."""
    return {
        "bump_displacement.png": draw_bump_displacement(numbers),
        "bump_acceleration.png": draw_bump_acceleration(numbers),
        "bump_damping.png": draw_damping(numbers),
        "terrain_displacement.png": draw_terrain_displacement(numbers),
        "terrain_acceleration.png": draw_terrain_acceleration(numbers),
        "terrain_front_end.png": draw_front_end(numbers),
        "spectra.png": draw_spectra(numbers),
        "terrain_profile.png": draw_terrain(numbers),
        **draw_mode_pictures(numbers),
    }


def write_picture(figure: Figure, path: Path) -> None:
    """Writes a figure as a small PNG, whole or not at all. InputError if it cannot be written."""
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=DOTS_PER_INCH)
    picture = Image.open(drawn).convert("RGB").quantize(PALETTE, dither=Image.Dither.NONE)
    packed = io.BytesIO()
    picture.save(packed, format="PNG", optimize=True)
    write_whole(path, packed.getvalue())
