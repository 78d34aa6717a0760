"""The page of tools/report in headless Chromium: that it opens without an error or a network, that diagrams and
animation are drawn, that time moves the vehicle to where the results have it. Needs both programs (SPRUNG_REDUCE,
SPRUNG_DYNAMICS); pictures are kept in the folder SPRUNG_SCREENSHOTS."""

import re
import shutil
import unittest

import h5py
import numpy as np
from report_page_case import BLACK, BLUE, GROUND, OFF_ROAD, PICTURES, SIZES, PageTestCase, is_colour

from sprung_tools.files.results_file import open_results

BUMP_TIMES = (0.0, 0.45, 0.75, 1.2, 2.2, 4.0)  # s: before the bump, wheels in the air, second landing, at rest again


class ReportPage(PageTestCase):
    def test_it_opens_in_both_sizes_and_colour_schemes_and_fits_the_window(self):
        self.check_views("truck", 0.75)

    def test_the_time_axes_are_marked_and_both_runs_are_in_the_summary_on_the_smallest_telephone(self):
        page = self.browser.open(self.folder / "truck.html", 320, 568, touch=True)
        self.addCleanup(page.close)
        counts = page.evaluate(
            "[...document.querySelectorAll('#history-charts .plot')].map((one) =>"
            "one.querySelectorAll('.dygraph-axis-label-x').length)"
        )
        self.assertGreaterEqual(min(counts), 3, counts)
        table, last = page.box("#summary .scroll"), page.box("#summary-table thead th:last-child")
        self.assertLessEqual(last[0] + last[2], table[0] + table[2] + 0.5)
        page.picture(PICTURES / "smallest.png")
        self.assertEqual(page.problems(), [])

    def test_the_tables_of_both_runs_fit_the_telephone(self):
        page = self.open(size="phone")
        for table in ("summary-table", "ride-table", "load-table"):
            around, inside = page.box(f".scroll:has(#{table})"), page.box(f"#{table} thead th:last-child")
            self.assertLessEqual(inside[0] + inside[2], around[0] + around[2] + 0.5, table)

    def test_names_of_two_frames_with_their_modes_hide_no_number_on_the_telephone(self):
        label = "tractor_frame 17 modes, trailer_frame 17 modes"
        self.report("long.html", f"{label}=2 modes.h5", "--superelements", ".")
        page = self.open("long.html", size="phone")
        self.assertEqual(page.picture(PICTURES / "long_names.png").shape[1], SIZES["phone"][0])
        for table in ("summary-table", "ride-table", "load-table", "fact-table"):
            around, inside = page.box(f".scroll:has(#{table})"), page.box(f"#{table} thead th:last-child")
            self.assertLessEqual(inside[0] + inside[2], around[0] + around[2] + 0.5, table)
        outside = page.evaluate(
            "[...document.querySelectorAll('select, button, .legend .entry')].filter((one) =>"
            "one.getBoundingClientRect().right > one.closest('section').getBoundingClientRect().right)"
            ".map((one) => one.id || one.textContent)"
        )
        self.assertEqual(outside, [])

    def test_every_diagram_shows_both_runs(self):
        page = self.open()
        places = page.evaluate(
            "[...document.querySelectorAll('.plot')].map((one, k) => { one.id = `plot${k}`; return one.id; })"
        )
        self.assertEqual(len(places), 7)  # four histories, the bands, the spectra, the modes
        for place in places:
            picture = page.picture(PICTURES / f"{place}.png", f"#{place}")
            counts = [np.count_nonzero(np.any(is_colour(picture, colour, 0.25), axis=0)) for colour in (BLACK, BLUE)]
            deflection = "body frame" in page.evaluate(f"document.querySelector('#{place}').ariaLabel")
            # Columns with the curve's colour, of a thousand or so; the second run hides much of the first. A rigid
            # chassis has no deflection.
            self.assertGreater(counts[1], 300, place)
            self.assertEqual(counts[0] > 30, not deflection, (place, counts))

    def test_the_frequencies_are_marked_where_the_axis_has_them(self):
        page = self.open()
        marks = page.evaluate(
            "[...document.querySelectorAll('#spectrum-chart .dygraph-axis-label-x')].map((one) => {"
            "const r = one.getBoundingClientRect(); return [Number(one.textContent), r.x + r.width / 2]; })"
        )
        places = {value: x for value, x in marks}
        left = page.box("#spectrum-chart .plot")[0]
        for frequency in (1.94, 9.666, 35.02):  # the run with 2 modes; between two marks, the axis is logarithmic
            low, high = (limit for limit in ((1, 2), (5, 10), (20, 50)) if limit[0] < frequency < limit[1]).__next__()
            share = np.log(frequency / low) / np.log(high / low)
            expected = places[low] + share * (places[high] - places[low])
            self.assertAlmostEqual(page.evaluate(f"placeFrequency(spectrum, {frequency})") + left, expected, delta=1.5)

    def test_the_scrubber_moves_the_vehicle_to_where_the_results_have_it(self):
        page = self.open()
        with open_results(str(self.folder / "2 modes.h5")) as results:
            x, y, angle = (results.series(f"bodies/chassis/position.{one}")[0] for one in ("x", "y", "angle"))
            contact = results.series("forces/front_tyre/contact")[0]
        before = None
        for time in BUMP_TIMES:
            with self.subTest(time=time):
                self.set_time(page, time)
                sample = round(1e3 * time)
                self.assertEqual(page.evaluate("document.getElementById('clock').textContent"), f"{time:.3f} s")
                found = page.evaluate("sprungReport.mainBody()")
                for name, expected in (("x", x), ("y", y), ("angle", angle)):
                    self.assertAlmostEqual(found[name], expected[sample], delta=1e-6 * max(1.0, abs(expected[sample])))
                picture = page.picture(PICTURES / f"bump_{time:.2f}s.png", "#scene")
                # The chassis' middle is the middle of the picture, where the road is flat: its height there in pixels.
                column = picture[:, picture.shape[1] // 2 - 8][:, None]
                chassis = np.mean(np.flatnonzero(is_colour(column, BLUE, 0.1)))
                ground = np.flatnonzero(is_colour(column, GROUND))[0] - 1.0  # half of the line above it
                tilt = 8.0 * np.tan(angle[sample])
                height = y[sample] * page.evaluate("player.view.scale")
                self.assertAlmostEqual(ground - chassis + tilt, height, delta=2.0)
                self.assertEqual(np.any(is_colour(picture, OFF_ROAD)), contact[sample] < 0.5)
                if before is not None:
                    self.assertGreater(np.count_nonzero(np.any(np.abs(picture - before) > 0.1, axis=2)), 2000)
                before = picture

    def test_two_runs_lie_over_each_other_and_the_deflection_is_magnified(self):
        with open_results(str(self.folder / "2 modes.h5")) as results:
            deflection = results.series("points/chassis.front_end/deflection.y")[0]
            place = [results.series(f"points/chassis.front_end/position.{one}")[0] for one in "xy"]
        sample = int(np.argmax(np.abs(deflection)))
        page = self.open()
        self.set_time(page, 1e-3 * sample)
        front = page.evaluate("sprungReport.node('chassis', 'front_end')")
        np.testing.assert_allclose(
            page.evaluate(f"sprungReport.place('chassis', {front}, 1)"), [one[sample] for one in place], rtol=1e-6
        )
        rest, large = (
            np.array(page.evaluate(f"sprungReport.place('chassis', {front}, {factor})")) for factor in (0, 20)
        )
        self.assertAlmostEqual(np.hypot(*(large - rest)) / 20.0, abs(deflection[sample]), delta=1e-6)
        self.choose(page, "magnification", 20)
        both = page.picture(PICTURES / "magnified.png", "#scene")
        self.choose(page, "other-run", -1)
        alone = page.picture(PICTURES / "alone.png", "#scene")
        height = min(len(both), len(alone))  # both scenes are as high as what they show jumps
        both, alone = both[-height:], alone[-height:]
        grey = np.ptp(both, axis=2) < 0.05  # the rigid run's black, let through by 60 %
        dark = np.mean(both, axis=2) < 0.6
        self.assertGreater(np.count_nonzero(grey & dark & np.any(np.abs(both - alone) > 0.2, axis=2)), 1000)

    def test_dragging_in_one_diagram_zooms_all(self):
        page = self.open()
        page.evaluate("document.querySelector('#history-charts').scrollIntoView({behavior: 'instant'})")
        page.settle()
        first, second = "#history-charts figure:nth-child(1) .plot", "#history-charts figure:nth-child(2) .plot"
        before = page.picture(selector=second)
        x, y, width, height = page.box(first)
        y -= page.evaluate("scrollY")
        page.drag((x + 0.3 * width, y + 0.4 * height), (x + 0.5 * width, y + 0.4 * height))
        page.settle()
        spans = page.evaluate("linked.map((one) => one.graph.xAxisRange())")
        self.assertEqual(len(spans), 5)
        for span in spans:
            np.testing.assert_allclose(span, spans[0], atol=1e-9)
        self.assertTrue(0.8 < spans[0][1] - spans[0][0] < 1.3, spans[0])  # a fifth of 5 s, less the axis' width
        self.assertGreater(np.count_nonzero(np.any(np.abs(page.picture(selector=second) - before) > 0.2, axis=2)), 1000)
        page.evaluate("document.querySelector('[data-zoom=all]').click()")
        self.assertEqual(page.evaluate("linked[1].graph.xAxisRange()"), [0, 5])

    def test_keys_are_for_the_animation_after_a_click_into_it(self):
        page = self.open()
        page.click("#scene")
        page.wait_until("clock.time > 0")
        page.press(" ", "Space")
        self.assertEqual(page.evaluate("player.playing"), False)
        before = page.evaluate("clock.time")
        page.press("ArrowRight", "ArrowRight")
        self.assertGreater(page.evaluate("clock.time"), before)

    def test_keys_step_and_play_and_pause(self):
        page = self.open()
        page.evaluate("document.getElementById('scrubber').focus()")
        page.press("ArrowRight", "ArrowRight")
        self.assertAlmostEqual(page.evaluate("sprungReport.clock.time"), 1e-3)
        page.press(" ", "Space")
        page.evaluate(
            "new Promise((done) => {"
            "const look = () => (clock.time > 0.001 ? done() : requestAnimationFrame(look)); look(); })"
        )
        self.assertEqual(page.evaluate("document.getElementById('play').textContent"), "Pause")
        page.press(" ", "Space")
        stopped = page.evaluate("clock.time")
        page.settle()
        self.assertEqual(page.evaluate("clock.time"), stopped)

    def test_a_screen_reader_finds_a_name_for_everything(self):
        page = self.open()
        nameless = page.evaluate(
            "[...document.querySelectorAll('select, input, button, canvas, [role=img], [role=region], section')]"
            ".filter((one) => !(one.parentElement.closest('.plot') || one.ariaLabel || one.labels?.length ||"
            "one.getAttribute('aria-labelledby') || one.textContent.trim()))"
            ".map((one) => one.outerHTML.slice(0, 80))"
        )
        self.assertEqual(nameless, [])
        self.assertEqual(page.evaluate("document.documentElement.lang"), "en")

    def test_other_vehicles_drive_and_move(self):
        for name in ("quarter_car", "four_bar", "slider_crank", "andrews", "pendulum", "track"):
            with self.subTest(name):
                self.drive(f"examples/{name}_run.toml", name)
                self.report(f"{name}.html", f"{name}.h5")
                page = self.open(f"{name}.html")
                links = page.evaluate("[...document.querySelectorAll('nav a:not([hidden])')].map((one) => one.hash)")
                self.assertEqual({"#modes", "#checks", "#loads"} & set(links), set())  # nothing is flexible here
                last = page.evaluate("sprungReport.clock.last")
                pictures = []
                for share in (0.0, 0.4):
                    self.set_time(page, share * last)
                    pictures.append(page.picture(PICTURES / f"{name}_{share:.1f}.png", "#scene"))
                    drawn = np.flatnonzero(np.any(is_colour(pictures[-1], BLACK, 0.1), axis=1))
                    self.assertGreater(drawn.size, 10)
                    self.assertTrue(0 < drawn[0] and drawn[-1] < len(pictures[-1]) - 1, "cut off by the picture's edge")
                moved = np.any(np.abs(pictures[0] - pictures[1]) > 0.2, axis=2)
                self.assertGreater(np.count_nonzero(moved), 100)
        self.check_views("four_bar", 0.5)

    def test_modes_that_pause_are_shown_to_pause(self):
        shutil.copy(self.folder / "2 modes.h5", self.folder / "pausing.h5")
        with h5py.File(self.folder / "pausing.h5", "a") as file:
            active = file["bodies/chassis/modal/active"]
            values = active[:]
            values[1000:2000, 1] = 0.0  # from 1 to 2 s of 5 s
            active[:] = values
        self.report("pausing.html", "pausing.h5")
        page = self.open("pausing.html")
        strip = page.picture(PICTURES / "pausing.png", "#active-strip")
        rows = {
            name: np.flatnonzero(is_colour(strip[row], colour))
            for name, row, colour in (("first", 8, BLACK), ("second", 22, BLUE))
        }
        left, right = rows["first"][[0, -1]]
        self.assertEqual(rows["first"].size, right - left + 1)  # without a gap
        gap = np.flatnonzero(np.diff(rows["second"]) > 1)
        self.assertEqual(gap.size, 1)
        edges = (rows["second"][gap[0]], rows["second"][gap[0] + 1])
        np.testing.assert_allclose((np.array(edges) - left) / (right - left), (0.2, 0.4), atol=0.004)
        self.assertIn("when each mode takes part", page.evaluate("document.getElementById('mode-note').textContent"))

    def test_a_vehicle_thrown_high_stays_in_view(self):
        self.drive(
            "truck/bump.toml", "high", "--set", "road.height=0.9", "--set", "duration=3", "--set", "modes.chassis=0"
        )
        self.report("high.html", "high.h5")
        page = self.open("high.html")
        self.set_time(page, 1.5)
        self.assertGreater(page.evaluate("sprungReport.mainBody().y"), 8.0)  # m, where the window shows about 5
        picture = page.picture(PICTURES / "high.png", "#scene")
        drawn = np.flatnonzero(np.any(is_colour(picture, BLACK, 0.1), axis=1))
        self.assertGreater(drawn.size, 30)
        self.assertGreater(drawn[0], 5)

    def test_a_run_of_two_samples_is_shown(self):
        self.drive("truck/bump.toml", "short", "--set", "duration=0.001", "--set", "modes.chassis=2")
        self.report("short.html", "short.h5")
        page = self.open("short.html")
        self.set_time(page, 0.001)
        self.assertGreater(np.count_nonzero(is_colour(page.picture(selector="#scene"), BLACK)), 1000)

    def test_the_page_warns_of_what_the_program_warned_of(self):
        page = self.open()
        for index, (name, mode) in enumerate((("rigid", 1), ("2 modes", 3))):
            self.assertIn(f"modes are missing: chassis.mode {mode}", self.printed[name])
            for section in ("summary", "modes"):
                texts = page.evaluate(
                    f"[...document.querySelectorAll('[data-warnings={section}] li')].map((one) => one.textContent)"
                )
                self.assertTrue(texts[index].startswith(f"{name}: modes are missing: chassis.mode {mode}"), texts)
        marked = page.evaluate(
            "[...document.querySelectorAll('#summary-table th.group')].filter((one) =>"
            "one.textContent.includes('⚠')).map((one) => one.firstChild.textContent)"
        )
        expected = ["chassis.origin", "chassis.seat", "chassis", "chassis.rear_end", "chassis.front_end"]
        self.assertEqual(marked, expected)
        for section in ("spectra", "vehicle-modes"):  # both rest on modes about the equilibrium
            texts = page.evaluate(
                f"[...document.querySelectorAll('#{section} [data-warnings=equilibrium] li')]"
                ".filter((one) => one.checkVisibility()).map((one) => one.textContent)"
            )
            self.assertEqual(len(texts), 2, texts)
            for text in texts:
                self.assertTrue(text.endswith("here front_tyre, rear_tyre left the ground"), text)

    def test_the_lowest_value_stands_beside_the_highest(self):
        page = self.open()
        names = page.evaluate(
            "[...document.querySelectorAll('#summary-table tbody tr')].map((one) => one.textContent)"
        )
        for what in ("displacement", "acceleration"):
            for end in ("highest", "lowest"):
                self.assertEqual(sum(one.startswith(f"{what}, {end}") for one in names), 4, names)

    def test_the_scene_fits_the_vehicle(self):
        for size, least in (("desktop", 0.45), ("phone", 0.4)):
            with self.subTest(size):
                page = self.open(size=size)
                self.choose(page, "other-run", -1)
                drawn = is_colour(page.picture(selector="#scene"), BLUE, 0.1)
                height, width = (np.ptp(np.flatnonzero(np.any(drawn, axis=axis))) for axis in (1, 0))
                self.assertGreater(height, least * drawn.shape[0])
                self.assertGreater(width, 0.7 * drawn.shape[1])

    def test_the_distances_along_the_road_are_not_hidden_by_the_bars_of_the_tyres_forces(self):
        page = self.open()
        strip, green = slice(-20, None), (0x00, 0x7A, 0x55)
        # As if the greatest force were the one at the start, so that its bar is the longest that there may be.
        page.evaluate(
            "player.runs.forEach((one) => { one.largest = Math.max(...Object.values(one.tyres).map((tyre) =>"
            "tyre.force[0])); })"
        )
        self.set_time(page, 0.0)
        picture = page.picture(selector="#scene")
        self.assertFalse(np.any(is_colour(picture[strip], green)))
        self.assertGreater(np.count_nonzero(is_colour(picture, green)), 50)
        soft = np.array([int(one, 16) for one in re.findall("..", page.evaluate("style('--soft').slice(1)"))])
        seen = [np.count_nonzero(is_colour(page.picture(selector="#scene")[strip], soft, 0.05))]
        page.evaluate(
            "drawTyreForce = (context, view) => { context.fillStyle = style('--good');"
            "context.fillRect(0, view.height - 20, view.width, 20); }; drawScene()"
        )
        picture = page.picture(selector="#scene")[strip]
        seen.append(np.count_nonzero(is_colour(picture, soft, 0.05)))
        self.assertGreater(seen[0], 50)
        self.assertGreater(seen[1], 0.8 * seen[0])

    def test_values_under_the_mouse_have_their_unit_and_frequencies_that_crowd_are_not_all_named(self):
        page = self.open()
        place = page.find("#history-charts figure:nth-child(2) .plot")
        page.call("Input.dispatchMouseEvent", type="mouseMoved", x=place[0], y=place[1])
        page.settle()
        legend = page.evaluate("document.querySelector('#history-charts figure:nth-child(2) .legend').textContent")
        self.assertRegex(legend, r"^\d\.\d{3} srigid: \S+ m/s²2 modes: \S+ m/s²$")
        named, modes = page.evaluate("[spectrumNamed, data.runs.map((run) => run.vehicleModes.table.length)]")
        for some, count in zip(named, modes):  # two pairs of modes lie within 1 % of each other
            self.assertTrue(2 <= some <= count - 2, (named, modes))

    def test_two_vehicles_and_hostile_names_on_one_page(self):
        label = "</script><b onclick>\"'&Ü"
        self.drive("examples/quarter_car_run.toml", "car")
        self.report("odd.html", f"{label}=rigid.h5", "car=car.h5", "--title", label)
        page = self.open("odd.html")
        self.assertEqual(page.evaluate("[document.title, document.querySelector('h1').textContent]"), [label, label])
        self.assertEqual(page.evaluate("document.querySelectorAll('b').length"), 0)
        self.set_time(page, 0.5)
        picture = page.picture(PICTURES / "two_vehicles.png", "#scene")
        self.assertGreater(np.count_nonzero(is_colour(picture, BLUE, 0.1)), 100)


if __name__ == "__main__":
    unittest.main()
