"""What the tables of the report's page show, in headless Chromium: units, spans, long labels, and runs that lack
something. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS); pictures are kept in the folder SPRUNG_SCREENSHOTS."""

import json
import shutil
import unittest

from report_page_case import PICTURES, PageTestCase

ONLY_THE_SEAT = (
    'output.store={points=["body.seat"],bodies="none",joints="none",forces="none",recovery="none",wrenches="none"}'
)


class Tables(PageTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.drive_semitrailer()
        cls.drive("templates/half_car_run.toml", "half_car", "--set", "duration=0.5")
        cls.drive("templates/half_car_run.toml", "seat", "--set", ONLY_THE_SEAT)
        spans = ("--set", "duration=0.5", "--set", "statistics.to=0.25")
        cls.drive("templates/half_car_run.toml", "part", *spans)
        shutil.copy(cls.folder / "semi.h5", cls.folder / "semi_on_a_rough_road.h5")
        cls.report("semi.html", "rigid=rigid_semi.h5", "flexible=semi.h5")
        cls.report("mixed.html", "semi=semi.h5", "half car=half_car.h5")
        cls.report("seat.html", "seat.h5")
        cls.report("part.html", "part.h5")
        cls.report("spans.html", "whole=half_car.h5", "again=half_car.h5", "part=part.h5")
        cls.report("labels.html", "semi.h5", "semi_on_a_rough_road.h5", "rigid_semi.h5")

    def test_extremes_of_a_load_have_one_unit_and_each_time_one_line(self):
        page = self.open("semi.html", size="phone")
        rows = page.evaluate(
            "[...document.querySelectorAll('#load-table tbody tr')]"
            ".map((row) => [...row.cells].map((one) => one.innerText))"
        )
        for load in ("bending moment", "shear force"):
            units = {row[1].partition(" ")[2] for row in rows if row[0].startswith(load)}
            self.assertEqual(len(units), 1, rows)
        self.assertNotIn("-", "".join(row[2] for row in rows))  # a minus, as in the other columns
        heights = page.evaluate("[...document.querySelectorAll('#load-table button')].map((one) => one.offsetHeight)")
        self.assertLess(max(heights), 34)

    def test_the_rows_of_one_point_have_one_unit(self):
        page = self.open("part.html")
        rows = [{"of": of, "name": name, "unit": unit, "values": [value]} for of, name, unit, value in (
            ("rider.seat", "displacement, highest", "m", 1.7), ("rider.seat", "displacement, lowest", "m", -0.0407),
            ("rider.seat", "acceleration, highest", "m/s^2", 3.0), ("body.seat", "displacement, lowest", "m", -0.0407),
            ("tyre", "greatest load", "N", 1200.0), ("tyre", "load variation", "N", 900.0))]  # fmt: skip
        page.evaluate(f"fillStatistics(document.getElementById('summary-table'), {json.dumps(rows)})")
        found = page.evaluate(
            "[...document.querySelectorAll('#summary-table td')].filter((one) => one.innerText)"
            ".map((one) => one.innerText)"
        )
        expected = ["m", "1.700", "m", "−0.04070", "m/s²", "3", "mm", "−40.70", "kN", "1.200", "kN", "0.9000"]
        self.assertEqual(found, expected)

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

    def test_a_run_that_is_too_short_for_the_mtvv_says_so(self):
        ride = self.open("semi.html").evaluate("document.getElementById('ride-problem').textContent")
        self.assertIn("flexible: the MTVV is the largest r.m.s. over 1 s, and the span has only 0.5 s", ride)

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
