"""Error against cost of all rungs that were measured: the data and the picture."""

import io

from matplotlib.figure import Figure

from sprung_tools.benchmark.whole_runs import Key, Rung
from sprung_tools.plots.picture_file import COLOURS

MORE_COLOURS = (*COLOURS, "#56B4E9")
MARKERS = ("o", "s", "^", "D", "v", "P")


def work_precision_csv(ladders: dict[Key, list[Rung]]) -> str:
    """Formats a line for each rung, with commas between the values."""
    lines = ["run,modes,method,tolerance,evaluations,steps,cpu_s,height_error_m,peak_error,rms_error,deflection_error"]
    for (run, modes, method), rungs in ladders.items():
        for rung in rungs:
            errors = ",".join(f"{error:.4e}" for error in rung.errors)
            lines.append(
                f"{run},{modes},{method},{rung.tolerance:g},{rung.evaluations},{rung.steps},{rung.seconds:.4e},{errors}"
            )
    return "\n".join(lines) + "\n"


def draw_work_precision(ladders: dict[Key, list[Rung]]) -> bytes:
    """Draws the error of the chassis height against CPU time, a panel for each run and number of modes. Returns a
    PNG."""
    panels = list(dict.fromkeys((run, modes) for run, modes, _ in ladders))
    methods = list(dict.fromkeys(method for *_, method in ladders))
    figure = Figure(figsize=(4.2 * len(panels), 4.2), layout="constrained")
    for axes, (run, modes) in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels):
        for (name, count, method), rungs in ladders.items():
            if (name, count) != (run, modes) or not rungs:
                continue
            place = methods.index(method)
            axes.loglog(
                [1e3 * rung.seconds for rung in rungs],
                [max(rung.errors.height, 1e-12) for rung in rungs],
                color=MORE_COLOURS[place % len(MORE_COLOURS)],
                marker=MARKERS[place % len(MARKERS)],
                markersize=4,
                label=method,
            )
        axes.set_title(f"{run}, {modes} modes")
        axes.set_xlabel("CPU time, ms")
        axes.set_ylabel("largest error of the chassis height, m")
        axes.grid(color="0.9", linewidth=0.6)
        axes.legend(frameon=False)
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=150)
    return picture.getvalue()
