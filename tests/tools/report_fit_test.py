"""What the report's page shows of a semitrailer, and of two vehicles, in headless Chromium: that scenes hold all that
moves in them, and that the tables of modes can be read on a telephone. Needs both programs (SPRUNG_REDUCE,
SPRUNG_DYNAMICS); pictures are kept in the folder SPRUNG_SCREENSHOTS."""

import itertools
import json
import unittest

import h5py
import matplotlib.path
import numpy as np
from report_page_case import ALL_CONTROLS, BLUE, NAME, PICTURES, SIZES, SPANS, PageTestCase, is_colour

EDGE = 7  # px: the radius of the sign of a mass, the largest one
# The furthest places of a vehicle's nodes and wheels in a view, px: left, top, right, bottom.
EXTENT = """((vehicle, nodes, view) => {
  const places = [...Object.values(nodes).flat().map(([x, y]) => [view.X(x), view.Y(y), 0]),
    ...vehicle.wheels.map((one) => {
      const [x, y] = nodes[one.body][one.node];
      return [view.X(x), view.Y(y), view.scale * one.radius];
    })];
  return [Math.min(...places.map(([x, , r]) => x - r)), Math.min(...places.map(([, y, r]) => y - r)),
    Math.max(...places.map(([x, , r]) => x + r)), Math.max(...places.map(([, y, r]) => y + r))];
})"""
STANDING = (
    "Object.fromEntries(one.vehicle.bodies.map((body) =>"
    "[body.name, nodesOf(one, body, frameAt(one, clock.time), 1)]))"
)


class Fit(PageTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.drive_semitrailer()
        cls.drive("templates/half_car_run.toml", "half_car", "--set", "duration=0.5")
        cls.report("semi.html", "rigid=rigid_semi.h5", "flexible=semi.h5")
        cls.report("mixed.html", "semi=semi.h5", "half car=half_car.h5")
        cls.report("half_car.html", "half_car.h5")

    def list_texts(self, page):
        """What is written into the scene when it is drawn anew."""
        return page.evaluate(
            "(() => { const kind = CanvasRenderingContext2D.prototype, write = kind.fillText, texts = [];"
            "kind.fillText = function (text, ...place) { texts.push(text); return write.call(this, text, ...place); };"
            "try { drawScene(); } finally { kind.fillText = write; } return texts; })()"
        )

    def test_captions_say_which_way_it_travels_and_by_how_much_deflections_are_magnified(self):
        page = self.open("semi.html")
        self.choose(page, "magnification", 25)
        self.assertLessEqual({"travel", "deflections × 25"}, set(self.list_texts(page)))
        page = self.open("half_car.html")  # of rigid bodies
        texts = self.list_texts(page)
        self.assertIn("travel", texts)
        self.assertFalse(any("deflections" in text for text in texts), texts)
        self.assertTrue(page.evaluate("document.getElementById('magnify').hidden"))

    def test_deflections_are_drawn_as_many_times_as_large_as_they_are_magnified(self):
        page = self.open("semi.html")
        self.choose(page, "other-run", -1)
        self.set_time(page, 0.4)
        drawn = {}
        for factor in (1, 2, 21):
            page.evaluate(
                "(() => { const draw = drawBodies; drawBodies = (...all) => { window.drawn = all[3]; draw(...all); };"
                f"setMagnification({factor}); try {{ drawScene(); }} finally {{ drawBodies = draw; }} }})()"
            )
            drawn[factor] = np.array(page.evaluate("window.drawn.trailer_frame"))
        once = drawn[2] - drawn[1]
        self.assertGreater(np.max(np.hypot(*once.T)), 1e-4)  # m
        np.testing.assert_allclose(drawn[21] - drawn[1], 20.0 * once, atol=1e-6)

    def test_a_rigid_body_is_drawn_as_its_filled_hull(self):
        page = self.open("semi.html")
        self.choose(page, "other-run", -1)
        body = "player.runs[1].vehicle.bodies.find((one) => one.name === 'cab')"
        places = np.array(page.evaluate(f"{body}.places"))
        hull = page.evaluate(f"hullOf({body})")
        corners = places[hull]
        self.assertGreater(len(hull), 2)
        sides = np.roll(corners, -1, axis=0) - corners
        for place in places:  # on the left of every side, or on it
            apart = place - corners
            self.assertTrue(np.all(sides[:, 0] * apart[:, 1] - sides[:, 1] * apart[:, 0] > -1e-9), place)
        picture = page.picture(PICTURES / "cab.png", "#scene")
        nodes = page.evaluate(
            f"nodesOf(player.runs[1], {body}, frameAt(player.runs[1], clock.time), 1)"
            ".map(([x, y]) => [player.view.X(x), player.view.Y(y)])"
        )
        rows, columns = np.indices(picture.shape[:2])
        outline = matplotlib.path.Path(np.array(nodes)[hull])
        inside = outline.contains_points(np.column_stack([columns.ravel(), rows.ravel()])).reshape(rows.shape)
        sky = picture[40, picture.shape[1] // 2]
        filled = 0.8 * sky + 0.2 * np.array(BLUE) / 255.0  # the run's colour lets 80 % of the sky through
        is_filled = is_colour(picture, 255.0 * filled)
        self.assertGreater(np.mean(is_filled[inside]), 0.5)  # the rest: its outline, and the driver in it
        apart = np.zeros_like(inside)
        apart[: int(np.min(np.array(nodes)[:, 1])) - 4] = True
        self.assertLess(np.count_nonzero(is_filled[apart]), 20)  # of a letter's edge

    def test_all_names_are_there_and_hide_nothing_of_the_vehicle(self):
        for size, name in itertools.product(SIZES, ("semi.html", "half_car.html")):
            with self.subTest(size=size, page=name):
                page = self.open(name, size=size)
                page.click("#labels")
                one = "player.runs[player.main]"
                top = page.evaluate(f"((one) => {EXTENT}(one.vehicle, {STANDING}, player.view))({one})")[1]
                names = page.evaluate("player.labelled")
                self.assertGreater(len(names), 4)
                wanted = f"[...{one}.vehicle.marks, ...{one}.vehicle.wheels, ...{one}.vehicle.bodies]"
                wanted = page.evaluate(f"{wanted}.map((mark) => mark.name)")
                self.assertCountEqual(wanted, [label["name"] for label in names])
                for label in names:
                    self.assertLess(label["y"] + 7, top - 6, label)  # px: half a row, and the sign of a point
                    self.assertGreater(label["y"] - 7, 24, label)  # below the captions
                    self.assertGreaterEqual(label["x"], 0)
                    self.assertLessEqual(label["x"] + label["width"], page.evaluate("player.view.width"))
                for a, b in itertools.combinations(names, 2):
                    apart = a["x"] + a["width"] <= b["x"] or b["x"] + b["width"] <= a["x"]
                    self.assertTrue(apart or abs(a["y"] - b["y"]) >= 14, (a, b))
                page.picture(PICTURES / f"names_{name}_{size}.png", "#scene")

    def test_histories_that_are_stored_less_often_are_named_beside_the_number_of_samples(self):
        self.drive("templates/half_car_run.toml", "thin", "--set", "duration=0.5", "--set", "output.step.joints=0.01")
        self.report("thin.html", "thin.h5")
        note = self.open("thin.html").evaluate("document.getElementById('history-note').textContent")
        self.assertIn("of all samples that the files hold, which are fewer of some histories (rigid: ", note)
        self.assertIn("joints stored every 10 ms)", note)
        note = self.open("half_car.html").evaluate("document.getElementById('history-note').textContent")
        self.assertIn("of all samples that the files hold. CSV", note)

    def test_warnings_are_seen_above_the_numbers_that_they_concern(self):
        page = self.open("semi.html")
        seen = page.evaluate(
            "[...document.querySelectorAll('[data-warnings=summary] li')]"
            ".filter((one) => one.checkVisibility()).map((one) => one.innerText)"
        )
        self.assertTrue(seen[0].startswith("rigid: modes are missing: tractor_frame.mode 1"), seen)
        below = page.evaluate(
            "document.querySelector('[data-warnings=summary]').getBoundingClientRect().bottom"
            " <= document.getElementById('summary-table').getBoundingClientRect().top"
        )
        self.assertTrue(below)

    def test_the_semitrailer_opens_in_both_sizes_and_colour_schemes_and_fits_the_window(self):
        self.check_views("semi", 0.3)

    def test_every_control_of_the_semitrailer_works_in_the_dark(self):
        page = self.open("semi.html", dark=True)
        self.browser.save_downloads(self.folder)
        for name in self.list_controls(page):
            with self.subTest(control=name):
                self.use_control(page, name)
                self.assertEqual(page.problems(), [])
        page.picture(PICTURES / "semi_desktop_dark_used.png")

    def use_control(self, page, name):
        """Uses a control and puts it back; what it says or saves has changed meanwhile."""
        kind = f"{ALL_CONTROLS}.find((one) => ({NAME}) === {json.dumps(name)})"
        tag, value = page.evaluate(f"((one) => [one.type || one.tagName.toLowerCase(), one.value])({kind})")
        if tag == "select-one":
            values = page.evaluate(f"[...{kind}.options].map((one) => one.value)")
            self.choose(page, name, values[-1])
            self.assertEqual(page.evaluate(f"{kind}.value"), values[-1])
            self.choose(page, name, value)
        elif tag == "range":
            end = "max" if page.evaluate(f"{kind}.max") != value else "min"
            self.choose(page, name, page.evaluate(f"{kind}.{end}"))
            self.assertNotEqual(page.evaluate(f"{kind}.value"), value)
            self.choose(page, name, value)
        elif tag == "checkbox":
            before = page.evaluate(f"{kind}.checked")
            page.click(f"#{name}")
            self.assertNotEqual(page.evaluate(f"{kind}.checked"), before)
            page.click(f"#{name}")
        elif tag == "summary":
            before = page.evaluate(f"{kind}.parentElement.open")
            page.evaluate(f"{kind}.click()")
            self.assertNotEqual(page.evaluate(f"{kind}.parentElement.open"), before)
            page.evaluate(f"{kind}.click()")
        elif tag == "a":
            page.evaluate(f"{kind}.click()")
            self.assertEqual(page.evaluate("location.hash"), name)
        elif name.endswith(("-csv", "-png")):
            page.evaluate(f"{kind}.click()")
            page.wait_for_download()
        elif name == "scene-webm":
            page.click(f"#{name}")
            page.wait_until("!document.getElementById('scene-file').hidden")
        elif name in ("play", "mode-play"):
            page.click(f"#{name}")
            self.assertEqual(page.evaluate(f"{kind}.textContent"), "Pause")
            page.wait_until(f"{kind}.textContent === 'Play'" if name == "play" else "modeShow.phase > 0")
            if name == "mode-play":
                page.click(f"#{name}")
        elif name.startswith("load-show-"):
            self.set_time(page, 0.123)
            page.evaluate(f"{kind}.click()")
            self.assertNotEqual(page.evaluate("clock.time"), 0.123)
        else:
            self.assertRegex(name, r"^zoom (in|out|left|right|all)$")
            page.evaluate(f"{kind}.click()")
            spans = page.evaluate(SPANS)
            np.testing.assert_allclose(spans, [spans[0]] * len(spans), atol=1e-9)

    def assert_inside(self, extent, view, edge):
        left, top, right, bottom = extent
        self.assertGreaterEqual(min(left, top), edge, (extent, view))
        self.assertLessEqual(right, view[0] - edge, (extent, view))
        self.assertLessEqual(bottom, view[1] - edge, (extent, view))

    def test_every_mode_stays_in_its_picture_and_fills_it(self):
        for size in SIZES:
            page = self.open("semi.html", size=size)
            count = page.evaluate("data.runs[1].vehicleModes.shapes.length")
            self.assertGreater(count, 20)
            for mode in range(count):
                self.choose(page, "vehicle-mode", f"1 {mode}")
                extents = []
                for phase in ("0.5 * Math.PI", "1.5 * Math.PI"):
                    page.evaluate(f"modeShow.phase = {phase}; drawVehicleMode();")
                    extents.append(page.evaluate(f"{EXTENT}(data.runs[1].vehicle, modeShow.nodes, modeShow.view)"))
                    self.assert_inside(extents[-1], page.evaluate("[modeShow.view.width, modeShow.view.height]"), EDGE)
                low, high = np.min(extents, axis=0), np.max(extents, axis=0)
                width, height = page.evaluate("[modeShow.view.width, modeShow.view.height]")
                filled = max((high[2] - low[0]) / width, (high[3] - low[1]) / height)
                self.assertGreater(filled, 0.85, (size, mode))
            page.picture(PICTURES / f"mode_{size}.png", "#mode-scene")

    def test_twice_the_amplitude_stays_in_the_picture_too(self):
        page = self.open("semi.html")
        self.choose(page, "mode-amplitude", "2")
        extent = page.evaluate(f"{EXTENT}(data.runs[1].vehicle, modeShow.nodes, modeShow.view)")
        self.assert_inside(extent, page.evaluate("[modeShow.view.width, modeShow.view.height]"), EDGE)

    def test_a_warning_with_a_long_word_does_not_make_the_page_wider_than_the_telephone(self):
        # Results of earlier versions have paths in their warnings.
        place = f"/home/{'somebody_' * 20}/terrain.toml:16:8"
        with h5py.File(self.folder / "half_car.h5") as file, h5py.File(self.folder / "warned.h5", "w") as copy:
            for name in file:
                file.copy(name, copy)
            for key, value in file.attrs.items():
                copy.attrs[key] = value
            for key, text in (("concerns", "summary"), ("of", "computation"), ("text", f"{place}: the road ends")):
                del copy[f"warnings/{key}"]
                copy[f"warnings/{key}"] = [text]
        self.report("warned.html", "warned.h5")
        page = self.open("warned.html", size="phone")
        self.assertIn(place, page.evaluate("document.querySelector('.warnings').textContent"))
        self.assertLessEqual(page.evaluate("document.documentElement.scrollWidth"), SIZES["phone"][0])

    def test_the_modes_of_each_run_are_a_table_that_fits_the_telephone_without_empty_rows(self):
        page = self.open("semi.html", size="phone")
        captions = page.evaluate(
            "[...document.querySelectorAll('#frequency-tables caption')].map((one) => one.textContent)"
        )
        count = page.evaluate("data.runs[1].vehicleModes.table.length")
        self.assertEqual(captions, ["rigid", f"flexible, the lowest 24 of {count}"])
        sizes = page.evaluate(
            "[...document.querySelectorAll('#frequency-tables .scroll')]"
            ".map((one) => [one.scrollWidth, one.clientWidth])"
        )
        for inside, around in sizes:
            self.assertLessEqual(inside, around)
        rows = "[...document.querySelectorAll('#frequency-tables tbody')].map((one) => one.rows.length)"
        self.assertEqual(page.evaluate(rows), [page.evaluate("data.runs[0].vehicleModes.table.length"), 24])
        empty = "[...document.querySelectorAll('#frequency-tables td')].filter((one) => !one.textContent).length"
        self.assertEqual(page.evaluate(empty), 0)
        page.picture(PICTURES / "mode_tables.png", "#vehicle-modes")

    def test_both_of_two_vehicles_are_in_view_whichever_is_followed(self):
        for size, (main, other) in ((size, pair) for size in SIZES for pair in ((1, 0), (0, 1))):
            with self.subTest(size=size, main=main):
                page = self.open("mixed.html", size=size)
                self.choose(page, "main-run", main)
                self.choose(page, "other-run", other)
                for run in range(2):
                    one = f"((one) => {EXTENT}(one.vehicle, {STANDING}, player.view))(player.runs[{run}])"
                    self.assert_inside(page.evaluate(one), page.evaluate("[player.view.width, player.view.height]"), 1)

    def test_a_vehicle_that_has_left_the_view_is_named_at_the_edge(self):
        page = self.open("mixed.html")  # the semitrailer drives to the left, the half car to the right
        self.assertEqual(page.evaluate("player.beyond"), "")
        page.evaluate("player.runs[0].places[player.runs[0].vehicle.main][0].fill(-40); drawScene();")
        self.assertEqual(page.evaluate("player.beyond"), "← semi")

    def test_places_along_a_body_can_be_read_at_any_width(self):
        # On a telephone a frame of 8 m had the single mark 0.
        for size in SIZES:
            page = self.open("semi.html", size=size)
            marks = page.evaluate(
                "(() => { const kind = CanvasRenderingContext2D.prototype, write = kind.fillText; let marks = 0;"
                "kind.fillText = function (text, x, y) { marks += y === LOADS_HEIGHT - LOADS_BOTTOM + 10;"
                "return write.call(this, text, x, y); };"
                "try { drawLoads(); } finally { kind.fillText = write; } return marks; })()"
            )
            self.assertGreaterEqual(marks, 3 * page.evaluate("loads.shown.quantities.length"), size)
        for low, high in ((-3.6, 4.4), (0.0, 9.9), (-6.1, 7.4), (-0.45, 0.55), (0.0, 1.0), (-11.0, 0.0)):
            for pixels in (230, 266, 300, 700, 1300):
                marks = page.evaluate(f"markEvenly({low}, {high}, {pixels / 70})")
                self.assertGreaterEqual(len(marks), 3)
                self.assertTrue(low <= marks[0] and marks[-1] <= high)
                self.assertGreater((marks[1] - marks[0]) * pixels / (high - low), 38)  # px: wider than −12.5

    def test_names_of_boundaries_and_the_time_cursor_hide_nothing(self):
        for size in SIZES:
            page = self.open("semi.html", size=size)
            names = page.evaluate(
                "[...document.querySelectorAll('#bands .boundary')].map((one) => one.getBoundingClientRect())"
                ".map((box) => [box.left, box.right, box.top, box.bottom])"
            )
            self.assertEqual(len(names), 6)
            place = "document.querySelector('#bands .plot').getBoundingClientRect()"
            left, right = page.evaluate(f"[{place}.left, {place}.right]")
            for name in names:  # right of the curves, whose axis ends 44 px before the plot
                self.assertGreaterEqual(name[0], right - 44.0)
                self.assertLessEqual(name[1], right)
            for above, below in itertools.pairwise(names):
                self.assertGreaterEqual(below[2] - above[3], -1.0)  # px
            cursor, labels = page.evaluate(
                "((box) => [box.querySelector('.cursor').getBoundingClientRect().bottom,"
                "[...box.querySelectorAll('.dygraph-axis-label-x')].map((one) => one.getBoundingClientRect().top)])"
                "(document.querySelector('#history-charts .plot-box'))"
            )
            self.assertLessEqual(cursor, min(labels) + 3.0)  # px: the digits begin below the edge of their box


if __name__ == "__main__":
    unittest.main()
