"""The loads of sections on the page of tools/report: the largest ones are those of all outputs, and where they are not,
the page says so. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS) and Chromium."""

import re
import unittest

import h5py
import numpy as np
from report_page_case import PageTestCase

from sprung_tools.files.results_file import open_results


class ReportLoads(PageTestCase):
    def test_the_summary_and_the_loads_have_the_same_largest_moment_also_of_a_rigid_chassis(self):
        page = self.open()
        for run, label in enumerate(("rigid", "2 modes")):
            with self.subTest(label):
                named = f"loads.all.find((one) => one.label === 'chassis, {label}').quantities[0].extremes"
                extremes = page.evaluate(f"{named}.map((one) => one.value)")
                with open_results(str(self.folder / f"{label}.h5")) as results:
                    moment = results.file.numbers("recovery/chassis/moment_from_loads")[0]
                np.testing.assert_allclose(extremes, [np.max(moment), np.min(moment)], rtol=1e-9)
                largest = page.evaluate(f"statisticOf({run}, 'chassis', 'largest bending moment along it')")
                self.assertAlmostEqual(largest / np.max(np.abs(moment)), 1.0, places=9)
        # What the modes miss, in the warnings, is not this difference (section_loads, eq. 3).
        self.assertIn("modes miss is another number", page.evaluate("document.getElementById('loads').innerText"))

    def test_what_the_modes_miss_is_said_at_the_moments_and_at_the_rows_of_the_summary_that_it_concerns(self):
        missed = r"chassis: its modes miss .* of the largest deflection .* of the largest bending moment"
        self.assertRegex(self.printed["2 modes"], missed)
        page = self.open()
        listed = "[...document.querySelectorAll('#loads [data-warnings] li')]"
        texts = page.evaluate(f"{listed}.filter((one) => one.checkVisibility()).map((one) => one.textContent)")
        self.assertEqual(len([text for text in texts if re.match("2 modes: " + missed, text)]), 1, texts)
        below = page.evaluate(f"{listed}.at(-1).getBoundingClientRect().bottom") - page.box("#load-1")[1]
        self.assertLess(below, 0.0)
        marked = page.evaluate(
            "[...document.querySelectorAll('#summary-table tbody')].map((one) => one.innerText)"
            ".filter((one) => one.includes('⚠ see the warnings above'))"
        )
        for body, row in (("chassis", "largest bending moment along it"), ("chassis.front_end", "deflection, largest")):
            (found,) = (one for one in marked if one.startswith(f"{body} "))
            self.assertIn(row, found)

    def test_where_a_file_holds_loads_rarely_the_largest_ones_are_those_that_the_run_has_found(self):
        thin = ("--set", "output.step.recovery=0.05", "--set", "output.step.forces=0.05")
        self.drive("truck/bump.toml", "thin", "--set", "modes.chassis=2", *thin)
        self.report("thin.html", "2 modes=2 modes.h5", "all outputs=thin.h5")
        with h5py.File(self.folder / "thin.h5", "a") as file:  # of a program that did not store where and when
            for name in [one for one in file["summary/sections/chassis"].attrs if one.endswith("_station")]:
                del file["summary/sections/chassis"].attrs[name]
        self.report("rows.html", "rows=thin.h5")
        with open_results(str(self.folder / "2 modes.h5")) as results:
            loads, modes = (results.file.numbers(f"recovery/chassis/moment{one}")[0] for one in ("_from_loads", ""))
            stations, time = results.file.numbers("recovery/chassis/station")[0], results.time
        cases = ((loads, "bending moment, largest of all outputs"),
                 (loads - modes,
                  "bending moment, largest difference from that of the modes, of all outputs"))  # fmt: skip
        page = self.open("thin.html")
        self.choose(page, "load-body", page.evaluate("String(loads.all.findIndex((one) => one.index === 1))"))
        for values, name in cases:
            row, column = np.unravel_index(np.argmax(np.abs(values)), values.shape)
            cells = page.evaluate(
                "[...document.querySelectorAll('#load-table tr')]"
                ".map((row) => [...row.cells].map((one) => one.innerText))"
                f".find((row) => row[0] === '{name}')"
            )
            value, place, when = (float(one.partition(" ")[0].replace("−", "-")) for one in cells[1:])
            factor = 1e3 if "kN" in cells[1] else 1.0
            self.assertAlmostEqual(factor * value / values[row, column], 1.0, places=3)
            self.assertAlmostEqual(place, stations[column, 0], delta=5e-3)
            self.assertAlmostEqual(when, time[row], delta=6e-4)
        every = round(0.05 / (time[1] - time[0]))
        rows = np.max(np.abs(loads[::every]))
        self.assertLess(rows, 0.99 * np.max(np.abs(loads)))  # so the rows alone do not have it
        name = "largest bending moment along it"
        for run in (0, 1):
            largest = page.evaluate(f"statisticOf({run}, 'chassis', '{name}')")
            self.assertAlmostEqual(largest / np.max(np.abs(loads)), 1.0, places=9)
        self.assertIn("every 50 ms: line, area, dots and extremes are of these rows", self.read(page, "rows-note"))
        force = page.evaluate("document.querySelector('#statistics-table').textContent")
        self.assertIn("of rows every 50 ms", force)
        self.choose(page, "load-body", page.evaluate("String(loads.all.findIndex((one) => one.index === 0))"))
        self.assertTrue(page.evaluate("document.getElementById('rows-note').hidden"))
        page = self.open("rows.html")
        self.assertAlmostEqual(page.evaluate(f"statisticOf(0, 'chassis', '{name}')") / rows, 1.0, places=9)
        self.assertIn("did not store the largest of all its outputs", self.read(page, "rows-note"))
        moment = page.evaluate(
            "[...document.querySelectorAll('#summary-table tr')]"
            f".find((row) => row.innerText.startsWith('{name}')).innerText"
        )
        self.assertIn("of rows every 50 ms", moment)

    def read(self, page, element):
        return page.evaluate(f"document.getElementById('{element}').textContent")


if __name__ == "__main__":
    unittest.main()
