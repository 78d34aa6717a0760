"""Every control of the report's page in headless Chromium: each menu, button, slider and key, and another colour scheme
while the page is open; the effect of each, and that no error was logged. A control without a case here fails the
test. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS)."""

import csv
import io
import unittest

import matplotlib.image
import numpy as np
from report_page_case import SPANS, PageTestCase


class Controls(PageTestCase):
    def test_every_control_has_its_effect(self):
        page = self.open()
        self.browser.save_downloads(self.folder)
        cases = self.list_cases()
        self.assertEqual(set(self.list_controls(page)), set(cases))
        for name, use in cases.items():
            with self.subTest(control=name):
                use(page)
                self.assertEqual(page.problems(), [])
        self.check_alive(page)

    def list_cases(self):
        """Each control's name with what uses it and says what must have happened."""
        cases = {f"history-{number}": self.choose_history(number) for number in (1, 2, 3, 4)}
        cases |= {f"zoom {action}": self.press_zoom(action) for action in ("in", "out", "left", "right", "all")}
        cases |= {f"#{section}": self.follow_link(section) for section in self.sections()}
        for chart in (*(f"history-{k}" for k in (1, 2, 3, 4)), "bands-diagram", "loads-diagram", "spectrum",
                      "mode-amplitudes"):  # fmt: skip
            cases |= {f"{chart}-csv": self.save_csv(chart), f"{chart}-png": self.save_png(f"{chart}-png")}
        cases |= {f"load-show-{number}": self.show_extreme(number) for number in range(1, 11)}
        cases |= {f"checks-of-{name}": self.unfold_checks(name) for name in ("chassis", "long_arm")}
        return cases | {
            "labels": self.use_labels,
            "scene-png": self.save_png("scene-png"),
            "mode-scene-png": self.save_png("mode-scene-png"),
            "scene-webm": self.save_webm,
            "bands-point": self.use_bands_point,
            "load-body": self.use_load_body,
            "vehicle-mode": self.use_vehicle_mode,
            "mode-amplitude": self.use_mode_amplitude,
            "mode-play": self.use_mode_play,
            "main-run": self.use_main_run,
            "other-run": self.use_other_run,
            "magnification": self.use_magnification,
            "speed": self.use_speed,
            "play": self.use_play,
            "scrubber": self.use_scrubber,
            "spectrum-point": self.use_spectrum_point,
            "mode-body": self.use_mode_body,
            "all-numbers": self.use_all_numbers,
        }

    def sections(self):
        return (
            "summary", "animation", "histories", "ride", "loads", "spectra", "vehicle-modes", "modes", "checks",
            "facts",
        )  # fmt: skip

    def choose_history(self, number):
        """Another quantity: its name, its unit, its values; the zoom stays, the other diagrams stay."""

        def use(page):
            page.click("[data-zoom=all]")
            page.click("[data-zoom=in]")
            span = page.evaluate("linked[0].graph.xAxisRange()")
            wanted = "Forces: rear_tyre, force"
            self.choose(page, f"history-{number}", wanted)
            chart = f"linked[{number - 1}]"
            self.assertIn("rear_tyre, force", page.evaluate(f"{chart}.plot.ariaLabel"))
            self.assertEqual(page.evaluate(f"document.querySelector('#history-{number}').value"), wanted)
            np.testing.assert_allclose(page.evaluate(f"{chart}.graph.xAxisRange()"), span, atol=1e-9)
            greatest = page.evaluate(f"Math.max(...{chart}.graph.file_.map((row) => row[2] ?? 0))")
            expected = page.evaluate("statisticOf(1, 'rear_tyre', 'force, largest')")
            self.assertAlmostEqual(greatest / (1e-3 * expected), 1.0, places=5)  # drawn in kN
            self.assertEqual(page.evaluate(f"{SPANS}.length"), 5)
            page.click("[data-zoom=all]")

        return use

    def press_zoom(self, action):
        expected = {"in": (1.25, 3.75), "out": (0.0, 5.0), "left": (0.0, 2.5), "right": (2.5, 5.0), "all": (0.0, 5.0)}

        def use(page):
            self.set_time(page, 2.5)
            page.click("[data-zoom=all]")
            if action != "in":
                page.click("[data-zoom=in]")
            page.click(f"[data-zoom={action}]")
            for span in page.evaluate(SPANS):
                np.testing.assert_allclose(span, expected[action], atol=1e-9)
            low, high = expected[action]
            self.assertEqual(
                page.evaluate("document.getElementById('zoom-value').textContent"), f"{low:.3f} s to {high:.3f} s"
            )

        return use

    def follow_link(self, section):
        def use(page):
            page.evaluate(f"document.querySelector('nav a[href=\"#{section}\"]').click()")
            page.settle()
            self.assertEqual(page.evaluate("location.hash"), f"#{section}")
            self.assertTrue(page.evaluate(f"document.getElementById('{section}') !== null"))

        return use

    def use_main_run(self, page):
        self.set_time(page, 0.75)
        self.choose(page, "other-run", -1)
        before = page.picture(selector="#scene")
        self.choose(page, "main-run", 0)
        self.assertEqual(page.evaluate("player.main"), 0)
        self.assert_changed(before, page.picture(selector="#scene"))
        self.choose(page, "main-run", 1)

    def use_other_run(self, page):
        self.set_time(page, 0.75)
        self.choose(page, "other-run", -1)
        before = page.picture(selector="#scene")
        self.choose(page, "other-run", 0)
        self.assertEqual(page.evaluate("player.other"), 0)
        self.assert_changed(before, page.picture(selector="#scene"))

    def use_magnification(self, page):
        # Ten times the largest deflection is less than 6 % of the vehicle's length.
        self.assertEqual(page.evaluate("[player.magnification, document.getElementById('magnification').value]"),
                         [10, "10"])  # fmt: skip
        self.set_time(page, 0.75)
        self.choose(page, "magnification", 1)
        before = page.picture(selector="#scene")
        self.choose(page, "magnification", 40)
        self.assertEqual(page.evaluate("document.getElementById('magnification-value').textContent"), "× 40")
        self.assert_changed(before, page.picture(selector="#scene"))

    def use_speed(self, page):
        self.choose(page, "speed", "0.25")
        self.assertEqual(page.evaluate("player.speed"), 0.25)
        self.choose(page, "speed", "1")

    def use_play(self, page):
        self.set_time(page, 1.0)
        page.click("#play")
        self.assertEqual(page.evaluate("document.getElementById('play').textContent"), "Pause")
        page.wait_until("clock.time > 1.0")
        page.click("#play")
        self.assertEqual(page.evaluate("document.getElementById('play').textContent"), "Play")
        stopped = page.evaluate("clock.time")
        page.settle()
        self.assertEqual(page.evaluate("clock.time"), stopped)
        page.click("#scene")  # plays, and pauses, too
        page.wait_until(f"clock.time > {stopped}")
        page.click("#scene")
        self.assertEqual(page.evaluate("player.playing"), False)

    def use_scrubber(self, page):
        self.set_time(page, 2.0)
        self.assertEqual(page.evaluate("document.getElementById('clock').textContent"), "2.000 s")
        page.evaluate("document.getElementById('scrubber').focus()")
        page.press("ArrowRight", "ArrowRight")
        self.assertAlmostEqual(page.evaluate("clock.time"), 2.001)
        page.press("ArrowLeft", "ArrowLeft")
        self.assertAlmostEqual(page.evaluate("clock.time"), 2.0)
        page.press(" ", "Space")
        page.wait_until("clock.time > 2.0")
        page.press(" ", "Space")
        self.assertEqual(page.evaluate("player.playing"), False)

    def use_spectrum_point(self, page):
        before = page.picture(selector="#spectrum-chart .plot")
        self.choose(page, "spectrum-point", "rear_axle.origin")
        self.assertIn("rear_axle.origin", page.evaluate("document.querySelector('#spectrum-chart .plot').ariaLabel"))
        self.assert_changed(before, page.picture(selector="#spectrum-chart .plot"))

    def use_mode_body(self, page):
        self.assertEqual(page.evaluate("[...document.getElementById('mode-body').options].length"), 1)
        self.choose(page, "mode-body", "1 0")
        self.assertIn("All of them take part", page.evaluate("document.getElementById('mode-note').textContent"))
        labels = page.evaluate("linked[4].graph.getLabels()")
        self.assertEqual(labels, ["time, s", "mode 1, 6.11 Hz", "mode 2, 6.11 Hz"])

    def use_all_numbers(self, page):
        page.click("#all-numbers")
        self.assertTrue(page.evaluate("document.querySelector('#summary details').open"))
        page.click("#all-numbers")
        self.assertFalse(page.evaluate("document.querySelector('#summary details').open"))

    def save(self, page, button, name):
        """Presses a button that saves a file. Returns its content."""
        (self.folder / name).unlink(missing_ok=True)
        page.click(f"#{button}")
        page.wait_for_download()
        return (self.folder / name).read_bytes()

    def save_csv(self, chart):
        """A heading with units, and the numbers that are drawn."""

        def use(page):
            heading, *rows = self.save(page, f"{chart}-csv", f"{chart}.csv").decode().splitlines()
            rows = list(csv.reader(rows))
            if chart == "loads-diagram":
                self.check_loads(page, next(csv.reader([heading])), rows)
                return
            numbers = np.array([[float(cell or "nan") for cell in row] for row in rows])
            self.assertEqual(numbers.shape[1], len(next(csv.reader([heading]))))
            self.assertGreater(numbers.shape[0], 20)
            self.assertTrue(np.all(np.diff(numbers[:, 0]) >= 0.0))
            if chart.startswith("history"):
                drawn = page.evaluate(f"linked[{int(chart[-1]) - 1}].graph.rawData_.map((row) => row[0])")
                np.testing.assert_allclose(numbers[:, 0], drawn, rtol=1e-8)
                self.assertRegex(heading, r'^"time, s","rigid, \S+","2 modes, \S+"$')

        return use

    def check_loads(self, page, heading, rows):
        """All quantities that are drawn: the line between the envelope's sides, which reach the extremes."""
        time = page.evaluate("document.getElementById('clock').textContent")
        self.assertEqual(heading, ["quantity", "x in the body frame, m", f"at {time}", "lowest", "highest"])
        quantities = page.evaluate("loads.shown.quantities.map((one) => [one.name, one.unit, one.extremes[0].value])")
        self.assertEqual([name for name, _, _ in quantities],
                         ["bending moment", "shear force", "stress, +y side", "stress, −y side"])  # fmt: skip
        for name, unit, highest in quantities:
            numbers = np.array([row[1:] for row in rows if row[0] == f"{name}, {unit}"], dtype=float)
            self.assertGreater(len(numbers), 20)
            _, now, low, high = numbers.T
            room = 1e-6 * np.max(np.abs(numbers))  # of single precision
            self.assertTrue(np.all((low <= now + room) & (now <= high + room)))
            self.assertAlmostEqual(np.max(high) / highest, 1.0, places=6)

    def save_png(self, button):
        """A picture that is not of one colour, as wide as what is saved."""

        def use(page):
            data = self.save(page, button, f"{button.removesuffix('-png')}.png")
            picture = matplotlib.image.imread(io.BytesIO(data))
            self.assertGreater(picture.shape[1], 900)
            self.assertGreater(np.ptp(picture[:, :, 0]), 0.5)

        return use

    def save_webm(self, page):
        """The whole run, from its beginning to its end; WebM begins with the signature of EBML."""
        self.choose(page, "speed", "2")
        self.set_time(page, 3.0)
        page.click("#scene-webm")
        page.wait_until("!document.getElementById('scene-file').hidden")
        data = self.save(page, "scene-file", "animation.webm")
        self.assertEqual(data[:4], b"\x1a\x45\xdf\xa3")
        self.assertIn(b"\x1f\x43\xb6\x75", data)  # a cluster, which holds frames; how many depends on the machine
        self.assertGreater(len(data), 2000)
        self.assertEqual(page.evaluate("[clock.time, player.playing]"), [5, False])
        self.assertEqual(page.evaluate("document.getElementById('scene-webm').disabled"), False)
        self.choose(page, "speed", "1")

    def show_extreme(self, number):
        """The time of the extreme, at which the line meets the envelope; or of the largest difference of both ways."""

        def use(page):
            self.set_time(page, 0.0)
            page.click(f"#load-show-{number}")
            # Moment and shear have three buttons each, the stresses of the two sides two.
            quantity, extreme = divmod(number - 1, 3) if number <= 6 else (2 + (number - 7) // 2, (number - 7) % 2)
            found = f"loads.shown.quantities[{quantity}]"
            if extreme == 2:
                self.assertEqual(page.evaluate("clock.time"), page.evaluate(f"{found}.difference.time"))
                return
            time, value = page.evaluate(f"[{found}.extremes[{extreme}].time, {found}.extremes[{extreme}].value]")
            self.assertEqual(page.evaluate("clock.time"), time)
            most = "Math.max" if extreme == 0 else "Math.min"
            now = page.evaluate(f"{most}(...loadAt(loads.shown, {found}, clock.time))")
            self.assertAlmostEqual(now / value, 1.0, delta=1e-5)

        return use

    def unfold_checks(self, name):
        def use(page):
            details = f"document.getElementById('checks-of-{name}')"
            self.assertEqual(page.evaluate(f"{details}.textContent"), "✓ All 14 checks passed")
            page.click(f"#checks-of-{name}")
            self.assertTrue(page.evaluate(f"{details}.parentElement.open"))
            self.assertEqual(page.evaluate(f"{details}.parentElement.querySelectorAll('td.good').length"), 14)
            page.click(f"#checks-of-{name}")

        return use

    def use_labels(self, page):
        self.set_time(page, 0.0)
        before = page.picture(selector="#scene")
        page.click("#labels")
        drawn = page.evaluate("player.labelled.map((one) => one.name)")
        self.assertLessEqual({"chassis", "chassis.seat", "front_tyre", "rear_tyre"}, set(drawn))
        self.assert_changed(before, page.picture(selector="#scene"))
        page.click("#labels")
        self.assertEqual(page.evaluate("player.labelled"), [])

    def use_bands_point(self, page):
        self.assertEqual(page.evaluate("[...document.getElementById('bands-point').options].length"), 1)
        self.choose(page, "bands-point", "chassis.seat")
        self.assertIn("chassis.seat", page.evaluate("document.querySelector('#bands-chart .plot').ariaLabel"))

    def use_load_body(self, page):
        options = page.evaluate("[...document.getElementById('load-body').options].map((one) => one.textContent)")
        bodies = ("chassis", "front_long_arm", "rear_long_arm")
        self.assertEqual(options, [f"{body}, {run}" for run in ("rigid", "2 modes") for body in bodies])
        self.choose(page, "load-body", "0")
        self.assertEqual(page.evaluate("loads.shown.label"), "chassis, rigid")
        self.choose(page, "load-body", "3")
        self.assertEqual(page.evaluate("loads.shown.label"), "chassis, 2 modes")
        page.call("Input.dispatchMouseEvent", type="mouseMoved", **dict(zip("xy", page.find("#load-1"))))
        page.settle()
        self.assertRegex(
            page.evaluate("document.getElementById('load-value').textContent"),
            r"^bending moment at \S+ m: \S+ kN m at \S+ s, \S+ to \S+ kN m over the run$",
        )

    def use_vehicle_mode(self, page):
        options = page.evaluate("[...document.getElementById('vehicle-mode').options].map((one) => one.textContent)")
        self.assertIn("9.67 Hz: chassis bending, 95 %", options)
        before = page.picture(selector="#mode-scene")
        self.choose(page, "vehicle-mode", "1 2")
        self.assertIn("chassis bending, 95 %", page.evaluate("document.getElementById('mode-words').textContent"))
        self.assertEqual(before.shape[1], page.picture(selector="#mode-scene").shape[1])
        self.assertEqual(page.evaluate("[modeShow.run, modeShow.mode]"), [1, 2])

    def use_mode_amplitude(self, page):
        self.choose(page, "vehicle-mode", "1 2")
        still = "unpackVehicleModes(1).equilibrium.chassis"
        for amplitude, moves in ((0, False), (2, True)):
            self.choose(page, "mode-amplitude", amplitude)
            apart = page.evaluate(
                "Math.max(...modeShow.nodes.chassis.map(([x, y], k) =>"
                f" Math.hypot(x - {still}[k][0], y - {still}[k][1])))"
            )
            self.assertEqual(apart > 0.1, moves)
        self.choose(page, "mode-amplitude", 1)

    def use_mode_play(self, page):
        before = page.evaluate("modeShow.phase")
        page.click("#mode-play")
        self.assertEqual(page.evaluate("document.getElementById('mode-play').textContent"), "Pause")
        page.wait_until(f"modeShow.phase > {before} + 0.5")
        page.click("#mode-play")
        stopped = page.evaluate("modeShow.phase")
        page.settle()
        self.assertEqual(page.evaluate("modeShow.phase"), stopped)

    def assert_changed(self, before, after):
        rows = min(len(before), len(after))  # the scene is as high as the run needs
        before, after = before[:rows], after[:rows]
        self.assertGreater(np.count_nonzero(np.any(np.abs(before - after) > 0.1, axis=2)), 100)


if __name__ == "__main__":
    unittest.main()
