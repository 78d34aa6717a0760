"""The page itself: the template, filled with styles, scripts and the data of the runs."""

import html
import os
from collections.abc import Sequence

from sprung_tools.files.errors import InputError
from sprung_tools.report.packing import Packed
from sprung_tools.report.ride import pack_boundaries
from sprung_tools.report.run_data import pack_run
from sprung_tools.report.shown_motion import ShownMotion
from sprung_tools.report.template import WEB, fill_template, pack_json, read_asset
from sprung_tools.runs.labelled_runs import Run, Shown
from sprung_tools.terminal.progress_bar import Progress

SCRIPTS = ("common.js", "clock.js", "save.js", "tables.js", "charts.js", "histories.js", "ride.js", "frame_loads.js",
           "spectra.js", "motion.js", "scene_view.js", "vehicle_drawing.js", "player.js", "vehicle_modes.js",
           "mode_amplitudes.js", "page.js")  # fmt: skip
DYGRAPHS = ("/usr/share/javascript/dygraphs", "/usr/share/nodejs/dygraphs/dist")
LARGEST = 15e6  # bytes of a page; a larger one is drawn with fewer samples
THINNINGS = ((4000, 6000), (2000, 3000), (1000, 1500), (500, 750))  # samples of a history, instants of the animation


def find_dygraphs() -> str:
    """Finds the folder of dygraphs' files. InputError if it is not installed."""
    for folder in DYGRAPHS:
        if os.path.exists(os.path.join(folder, "dygraph.min.js")):
            return folder
    raise InputError(f"{DYGRAPHS[0]}: error: dygraphs is not installed; run tools/setup (package libjs-dygraphs)")


def make_page(title: str, data: Packed) -> str:
    """The page's text: the template, filled with styles, scripts and data."""
    library = find_dygraphs()
    parts = {
        "TITLE": html.escape(title),
        "STYLE": read_asset(os.path.join(library, "dygraph.min.css")).partition("/*# sourceMappingURL")[0]
        + read_asset(os.path.join(WEB, "page.css")),
        "LIBRARY": read_asset(os.path.join(library, "dygraph.min.js")).partition("\n//# sourceMappingURL")[0],
        "DATA": pack_json(data),
        "SCRIPT": "\n".join(read_asset(os.path.join(WEB, name)) for name in SCRIPTS),
    }
    return fill_template(read_asset(os.path.join(WEB, "page.html")), parts)


def make_small_page(
    title: str, runs: Sequence[Run], extra: Sequence[Shown], checks: list[Packed], largest: float = LARGEST
) -> str:
    """Makes the page of some runs. The numbers of samples are the largest with which it stays below `largest` bytes, or
    the least ones.

    extra: further quantities; checks: as read_checks() gives them.
    """
    motion = ShownMotion(run.results for run in runs)
    for most, frames in THINNINGS:
        packed = []
        with Progress("reading runs", len(runs)) as progress:
            for run in runs:
                packed.append(pack_run(run, extra, motion, most, frames))
                progress.step()
        page = make_page(title, {"title": title, "runs": packed, "superelements": checks, "most": most,
                                 "boundaries": pack_boundaries()})
        if len(page.encode()) < largest:
            break
    return page
