"""The page itself: the template with its styles, scripts and the runs' data put in."""

import html
import json
import os

from sprung_tools.files.errors import InputError
from sprung_tools.report.run_data import pack_run
from sprung_tools.terminal.progress_bar import Progress

WEB = os.path.join(os.path.dirname(os.path.realpath(__file__)), "web")
SCRIPTS = ("common.js", "tables.js", "charts.js", "spectra.js", "animation.js", "page.js")
DYGRAPHS = ("/usr/share/javascript/dygraphs", "/usr/share/nodejs/dygraphs/dist")
LARGEST = 15e6  # bytes of a page; above, it is drawn by fewer samples
THINNINGS = ((4000, 6000), (2000, 3000), (1000, 1500), (500, 750))  # samples of a history, instants of the animation


def read_asset(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except OSError as error:
        raise InputError(
            f"{path}: error: cannot read it ({error.strerror}); tools/setup installs dygraphs"
        ) from error


def find_dygraphs():
    """The folder of the library's files. InputError if it is not installed."""
    for folder in DYGRAPHS:
        if os.path.exists(os.path.join(folder, "dygraph.min.js")):
            return folder
    raise InputError(f"{DYGRAPHS[0]}: error: dygraphs is not installed; run tools/setup (package libjs-dygraphs)")


def make_page(title, data):
    """The page's text: the template with styles, scripts and data put in."""
    library = find_dygraphs()
    script = read_asset(os.path.join(library, "dygraph.min.js")).partition("\n//# sourceMappingURL")[0]
    # "</script" would end a script element; "</" alone may stand in a regular expression. In the data no "<" stands at
    # all, because "<!--" and "<script" in a script element change what ends it.
    parts = {
        "TITLE": html.escape(title),
        "STYLE": read_asset(os.path.join(library, "dygraph.min.css")).partition("/*# sourceMappingURL")[0]
        + read_asset(os.path.join(WEB, "page.css")),
        "LIBRARY": script.replace("</script", "<\\/script"),
        "DATA": json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        "SCRIPT": "\n".join(read_asset(os.path.join(WEB, name)) for name in SCRIPTS).replace("</script", "<\\/script"),
    }
    page = read_asset(os.path.join(WEB, "page.html"))
    for name, text in parts.items():
        before, _, after = page.partition(f"@{name}@")
        page = f"{before}\0{name}\0{after}"
    for name, text in parts.items():  # in a second pass, so that nothing is looked for in what was put in
        page = page.replace(f"\0{name}\0", text, 1)
    return page


def make_small_page(title, runs, extra, checks, largest=LARGEST):
    """The page of some runs (runs.Run), drawn by as many samples as leave it smaller than `largest` bytes, if any do.

    extra: further quantities (runs.Shown); checks: of summary.read_checks().
    """
    for most, frames in THINNINGS:
        packed = []
        with Progress("reading runs", len(runs)) as progress:
            for run in runs:
                packed.append(pack_run(run, extra, most, frames))
                progress.step()
        page = make_page(title, {"title": title, "runs": packed, "superelements": checks, "most": most})
        if len(page.encode()) < largest:
            break
    return page
