"""What the report's page shows of a semitrailer, and of two vehicles, in headless Chromium: that scenes hold all that
moves in them, and that the tables of modes can be read on a telephone. Needs both programs (SPRUNG_REDUCE,
SPRUNG_DYNAMICS); pictures are kept in the folder SPRUNG_SCREENSHOTS."""

import os
import shutil
import unittest

import h5py
import numpy as np
from report_page_case import PICTURES, ROOT, SIZES, PageTestCase

ONLY_THE_SEAT = (
    'output.store={points=["body.seat"],bodies="none",joints="none",forces="none",recovery="none",wrenches="none"}'
)
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
        designs = sorted((ROOT / "meshes/templates").glob("*_frame.toml"))
        cls.call(os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", ".")
        rigid = ("--set", "modes.tractor_frame=0", "--set", "modes.trailer_frame=0")
        for name, changes in (("rigid_semi", rigid), ("semi", ())):
            cls.drive("templates/semitrailer_run.toml", name, "--set", "duration=0.5", *changes)
        cls.drive("templates/half_car_run.toml", "half_car", "--set", "duration=0.5")
        cls.drive("templates/half_car_run.toml", "seat", "--set", ONLY_THE_SEAT)
        cls.report("seat.html", "seat.h5")
        cls.report("semi.html", "rigid=rigid_semi.h5", "flexible=semi.h5")
        cls.report("mixed.html", "semi=semi.h5", "half car=half_car.h5")
        spans = ("--set", "duration=0.5", "--set", "statistics.to=0.25")
        cls.drive("templates/half_car_run.toml", "part", *spans)
        cls.report("spans.html", "whole=half_car.h5", "again=half_car.h5", "part=part.h5")
        shutil.copy(cls.folder / "semi.h5", cls.folder / "semi_on_a_rough_road.h5")
        cls.report("labels.html", "semi.h5", "semi_on_a_rough_road.h5", "rigid_semi.h5")

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

    def test_a_run_that_is_too_short_for_the_mtvv_says_so(self):
        ride = self.open("semi.html").evaluate("document.getElementById('ride-problem').textContent")
        self.assertIn("flexible: the MTVV is the largest r.m.s. over 1 s, and the span has only 0.5 s", ride)

    def test_runs_over_different_spans_are_not_compared_in_per_cent(self):
        page = self.open("spans.html")
        for table in ("summary-table", "ride-table"):
            cells = page.evaluate(
                f"[...document.querySelectorAll('#{table} td.number:nth-child(n+4)')].map((one) => one.innerText)"
            )
            self.assertTrue(any("%" in one for one in cells[0::2]), table)
            self.assertFalse(any("%" in one for one in cells[1::2]), table)
        spans = "spans that differ: whole 0 to 0.5 s; again 0 to 0.5 s; part 0 to 0.25 s."
        for note in ("summary-note", "ride-note"):
            self.assertIn(spans, page.evaluate(f"document.getElementById('{note}').textContent"))
        self.assertNotIn("differ:", self.open("mixed.html").evaluate("document.body.innerText"))

    def test_all_runs_with_long_labels_are_in_sight_beside_the_names_of_the_rows(self):
        page = self.open("labels.html")
        for table in ("summary-table", "ride-table"):
            inside, around = page.evaluate(
                f"((one) => [one.scrollWidth, one.clientWidth])(document.getElementById('{table}').parentElement)"
            )
            self.assertLessEqual(inside, around, table)
            lines = page.evaluate(f"document.querySelector('#{table} th[scope=row]').getBoundingClientRect().height")
            self.assertLess(lines, 40, table)  # px: one line
        page.picture(PICTURES / "long_labels.png", "#summary-table thead")

    def test_a_run_without_the_motion_of_its_bodies_is_judged_but_not_drawn(self):
        page = self.open("seat.html")
        self.assertEqual(page.evaluate("document.getElementById('player').hidden"), True)
        text = page.evaluate("document.getElementById('animation').innerText")
        self.assertIn("its file does not hold the motion of body, front_axle, rear_axle", text)
        ride = page.evaluate("document.getElementById('ride').innerText")
        self.assertIn("body.seat: without We and the total", ride)
        for measure in ("(Wk)", "(VDV)", "(MTVV)", "absorbed power"):
            self.assertIn(measure, ride)
        self.assertNotIn("(We)", ride.replace("Wk, Wd and We.", ""))
        self.assertNotIn("the MTVV is", ride)
        page.click("[data-zoom=in]")
        page.resize(700, 900)
        page.picture(PICTURES / "not_drawn.png")


if __name__ == "__main__":
    unittest.main()
