"""What the report's page does when it is drawn anew in headless Chromium: the mouse on a diagram, another colour scheme
while the page is open, another body, the pages of other vehicles; and that zoom and time go on after it. Needs both
programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS)."""

import unittest

import numpy as np
from report_page_case import ALL_CONTROLS, PICTURES, SPANS, PageTestCase


class Redrawing(PageTestCase):
    def test_the_mouse_on_a_diagram_sets_the_time_zooms_moves_and_shows_the_whole_run(self):
        page = self.open()
        plot = "#history-charts figure:nth-child(2) .plot"
        page.click(plot, (0.5, 0.5))
        self.assertAlmostEqual(page.evaluate("clock.time"), 2.5, delta=0.3)
        page.drag(page.find(plot, (0.4, 0.5)), page.find(plot, (0.6, 0.5)))
        page.settle()
        zoomed = page.evaluate(SPANS)
        self.assertLess(zoomed[0][1] - zoomed[0][0], 1.5)
        page.drag(page.find(plot, (0.5, 0.5)), page.find(plot, (0.3, 0.5)), shift=True)
        page.settle()
        moved = page.evaluate(SPANS)
        for before, after in zip(zoomed, moved):
            self.assertAlmostEqual(after[1] - after[0], before[1] - before[0], places=6)
            self.assertGreater(after[0], before[0])
        page.click(plot, times=2)
        self.assertEqual(page.evaluate(SPANS), [[0, 5]] * 5)
        self.check_alive(page)

    def test_a_flexible_body_without_elements_is_drawn_by_its_nodes(self):
        # As one from matrices: what it looks like between its nodes is not known.
        page = self.open()
        drawn = page.evaluate("""(() => {
          const body = data.runs[1].vehicle.bodies.find((one) => one.elements), calls = [];
          const context = new Proxy({}, {get: (_, name) => () => calls.push(name), set: () => true});
          const view = {X: (x) => x, Y: (y) => y};
          const bare = {...data.runs[1].vehicle, links: [], marks: [], bodies: [{...body, elements: 0, lines: []}]};
          drawBodies(context, view, bare, {[body.name]: body.places}, "#000000");
          return [calls, body.places.length];
        })()""")
        self.assertEqual(drawn[0], ["fillRect"] * drawn[1])

    def test_another_colour_scheme_while_open_keeps_time_zoom_and_choices(self):
        page = self.open()
        self.choose(page, "history-2", "Forces: front_tyre, force")
        self.set_time(page, 0.75)
        page.click("[data-zoom=in]")
        span = page.evaluate("linked[0].graph.xAxisRange()")
        for dark in (True, False, True):
            page.prefer(dark)
            self.assertEqual(page.problems(), [])
            self.assertEqual(page.evaluate("clock.time"), 0.75)
            self.assertEqual(page.evaluate("document.getElementById('history-2').value"), "Forces: front_tyre, force")
            for found in page.evaluate(SPANS):
                np.testing.assert_allclose(found, span, atol=1e-9)
            colours = page.evaluate("linked[1].graph.getColors()")
            self.assertEqual(colours, ["#f2f2f2", "#56b4e9"] if dark else ["#111111", "#0072b2"])
        picture = page.picture(PICTURES / "switched_to_dark.png")
        self.assertLess(np.mean(picture), 0.5)
        self.check_alive(page)

    def test_all_menus_and_buttons_work_on_the_pages_of_other_vehicles(self):
        for name in ("quarter_car", "four_bar"):  # one with a road and without a flexible body, one without either
            self.drive(f"examples/{name}_run.toml", name)
            self.report(f"{name}.html", f"{name}.h5")
            for size in ("desktop", "phone"):
                with self.subTest(name, size=size):
                    self.use_everything(self.open(f"{name}.html", size=size))

    def use_everything(self, page):
        """Chooses every option of every menu that is there, presses every button, moves every slider."""
        self.browser.save_downloads(self.folder)
        shown = f"{ALL_CONTROLS}.filter((one) => one.getClientRects().length && one.id)"
        for name in page.evaluate(f"{shown}.filter((one) => one.tagName === 'SELECT').map((one) => one.id)"):
            for value in page.evaluate(f"[...document.getElementById('{name}').options].map((one) => one.value)"):
                self.choose(page, name, value)
                self.assertEqual(page.evaluate(f"document.getElementById('{name}').value"), value)
        saving = f"{shown}.filter((one) => one.matches('.save') && one.id !== 'scene-webm')"
        for name in page.evaluate(f"{saving}.map((one) => one.id)"):
            page.click(f"#{name}")
            page.wait_for_download()
        for name in page.evaluate(f"{shown}.filter((one) => one.type === 'range').map((one) => one.id)"):
            highest = page.evaluate(f"document.getElementById('{name}').max")
            self.choose(page, name, highest)
        page.prefer(True)
        self.assertEqual(page.problems(), [])
        last = page.evaluate("clock.last")
        self.assertEqual(page.evaluate("clock.time"), last)
        page.click("#play")  # from the beginning again
        page.wait_until(f"clock.time < {last} && clock.time > 0")
        page.click("#play")
        dead = "(one) => !one.hidden && document.querySelector(one.hash).hidden"
        self.assertEqual(page.evaluate(f"[...document.querySelectorAll('nav a')].filter({dead}).length"), 0)

    def test_the_note_of_the_modes_is_that_of_the_body_chosen(self):
        self.drive("truck/bump.toml", "long arms", "--set", "modes.chassis=2", "--set", "modes.front_long_arm=2")
        self.drive("truck/bump.toml", "adaptive", "--set", "modes.chassis=4", "--set", "adaptivity.enabled=true",
                   "--set", "adaptivity.drop=0.05")  # fmt: skip
        self.report("two.html", "long arms=long arms.h5", "adaptive=adaptive.h5")
        page = self.open("two.html")
        options = page.evaluate("[...document.getElementById('mode-body').options].map((one) => one.textContent)")
        self.assertIn("chassis, long arms: clamped modes 1–2", options)
        self.assertIn("front_long_arm, long arms: clamped modes 1–2", options)
        note = "document.getElementById('mode-note').textContent"
        for place, option in enumerate(options):
            with self.subTest(option):
                value = page.evaluate(f"document.getElementById('mode-body').options[{place}].value")
                self.choose(page, "mode-body", value)
                always = "adaptive" not in option
                self.assertEqual("All of them take part throughout the run" in page.evaluate(note), always)
                self.assertEqual(page.evaluate("document.getElementById('active-strip').hidden"), always)
                self.assertEqual(page.problems(), [])
        self.check_alive(page)


if __name__ == "__main__":
    unittest.main()
