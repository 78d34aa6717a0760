"""What the browser tests of the report's page share: a folder with two runs of the truck over its bump and their page,
the browser, and what a hand does on the page. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS); pictures are kept
in the folder SPRUNG_SCREENSHOTS."""

import itertools
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np
from browser import Browser
from tool_test_case import ROOT, TOOLS, make_class_folder, run_program

MODELS = ROOT / "dynamics/models"
PICTURES = Path(os.environ.get("SPRUNG_SCREENSHOTS", tempfile.gettempdir()))
BLACK, BLUE = (0x11, 0x11, 0x11), (0x00, 0x72, 0xB2)  # of the first and the second run on light paper
OFF_ROAD, GROUND = (0xC2, 0x41, 0x0C), (0xE7, 0xE2, 0xD8)
ALL_CONTROLS = (
    "[...document.querySelectorAll('select, input, button, summary, a[href]')]"
    ".filter((one) => !one.matches('.skip, .dygraph-roller'))"
)
SPANS = "linked.map((one) => one.graph.xAxisRange())"
NAME = "one.id || (one.dataset.zoom && `zoom ${one.dataset.zoom}`) || one.getAttribute('href') || one.outerHTML"
SIZES = {"desktop": (1400, 900), "phone": (390, 844)}


def is_colour(picture, colour, tolerance=0.02):
    """Which pixels of a picture […×3] have a colour (0 to 255)."""
    return np.all(np.abs(picture - np.array(colour) / 255.0) < tolerance, axis=-1)


class PageTestCase(unittest.TestCase):
    printed: dict[str, str]  # what sprung-dynamics printed of each run

    @classmethod
    def setUpClass(cls):
        cls.folder = make_class_folder(cls)
        cls.printed = {}
        PICTURES.mkdir(parents=True, exist_ok=True)
        cls.call(
            os.environ["SPRUNG_REDUCE"], "build", *sorted((ROOT / "meshes/truck").glob("*.toml")), "--output-dir", "."
        )
        for name, modes in (("rigid", 0), ("2 modes", 2)):
            cls.drive("truck/bump.toml", name, "--set", f"modes.chassis={modes}")
        cls.report("truck.html", "rigid.h5", "2 modes=2 modes.h5", "--superelements", ".")
        cls.browser = cls.enterClassContext(Browser())

    @classmethod
    def call(cls, *command):
        return run_program(command, cwd=cls.folder, check=True)

    @classmethod
    def drive(cls, run, name, *arguments):
        target = ("--superelements", ".", "-o", f"{name}.h5", "--quiet")
        process = cls.call(os.environ["SPRUNG_DYNAMICS"], "run", MODELS / run, *target, *arguments)
        cls.printed[name] = process.stdout + process.stderr

    @classmethod
    def drive_semitrailer(cls):
        """rigid_semi.h5 and semi.h5: the template's semitrailer for half a second."""
        designs = sorted((ROOT / "meshes/templates").glob("*_frame.toml"))
        cls.call(os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", ".")
        rigid = ("--set", "modes.tractor_frame=0", "--set", "modes.trailer_frame=0")
        for name, changes in (("rigid_semi", rigid), ("semi", ())):
            cls.drive("templates/semitrailer_run.toml", name, "--set", "duration=0.5", *changes)

    @classmethod
    def report(cls, page, *arguments):
        cls.call(TOOLS / "report", "-o", page, *arguments)

    def open(self, name="truck.html", size="desktop", dark=False):
        page = self.browser.open(self.folder / name, *SIZES[size], dark=dark, touch=size == "phone")
        self.addCleanup(page.close)
        self.assertEqual(page.problems(), [])
        self.addCleanup(lambda: self.assertEqual(page.problems(), []))
        return page

    def check_views(self, name, time):
        """Opens a page in both sizes and colour schemes, and keeps its pictures: nothing has to be scrolled sideways,
        and nothing hidden takes space."""
        for size, dark in itertools.product(SIZES, (False, True)):
            with self.subTest(page=name, size=size, dark=dark):
                page = self.open(f"{name}.html", size=size, dark=dark)
                self.set_time(page, time)
                picture = page.picture(PICTURES / f"{name}_{size}_{'dark' if dark else 'light'}.png")
                self.assertEqual(picture.shape[1], SIZES[size][0])
                self.assertEqual(np.mean(picture) < 0.5, dark)
                hidden = (
                    "[...document.querySelectorAll('[hidden]')]"
                    ".filter((one) => one.getBoundingClientRect().height > 0).length"
                )
                self.assertEqual(page.evaluate(hidden), 0)

    def set_time(self, page, time):
        """By the scrubber, as a hand does."""
        page.evaluate(
            f"(() => {{ const s = document.getElementById('scrubber'); s.value = {time};"
            "s.dispatchEvent(new Event('input', {bubbles: true})); })()"
        )
        page.settle()

    def choose(self, page, element, value):
        page.evaluate(
            f"(() => {{ const s = document.getElementById('{element}'); s.value = '{value}';"
            "for (const kind of ['input', 'change']) s.dispatchEvent(new Event(kind, {bubbles: true})); })()"
        )
        page.settle()

    def list_controls(self, page):
        """The names of all controls."""
        return page.evaluate(f"{ALL_CONTROLS}.map((one) => {NAME})")

    def check_alive(self, page):
        """Checks that diagrams zoom and time runs."""
        page.click("[data-zoom=all]")
        page.click("[data-zoom=in]")
        spans = page.evaluate(SPANS)
        for span in spans:
            np.testing.assert_allclose(span, spans[0], atol=1e-9)
        self.assertAlmostEqual(spans[0][1] - spans[0][0], 2.5, places=6)
        page.click("[data-zoom=all]")
        before = page.evaluate("clock.time")
        page.click("#play")
        page.wait_until(f"clock.time !== {before}")
        page.click("#play")
        self.assertEqual(page.evaluate("player.playing"), False)
        self.assertEqual(page.problems(), [])
