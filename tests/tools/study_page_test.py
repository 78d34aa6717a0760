"""The page of a study in headless Chromium: each control and what it does, on a wide and on a narrow window, light and
dark, with no error logged and no network. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS); pictures are kept in
the folder SPRUNG_SCREENSHOTS."""

import csv
import io
import unittest

import matplotlib.image
import numpy as np
from browser import Browser
from report_page_case import ALL_CONTROLS, MODELS, PICTURES, SIZES
from tool_test_case import TOOLS, make_class_folder, run_program

from sprung_tools.runs.measures import Measure
from sprung_tools.study.execution import Finished
from sprung_tools.study.kept_rows import Row
from sprung_tools.study.one_run import Task
from sprung_tools.study.page import make_study_page
from sprung_tools.study.study_file import read_study
from sprung_tools.study.table import make_measure_columns

STUDY = f"""
run = "{MODELS}/examples/quarter_car_run.toml"
measures = ["suspensions/suspension/compression", "tyres/tyre/dynamic_load_rms", "program/steps"]
set.duration = 0.5
[[parameters]]
name = "damping"
key = "vehicle.forces.suspension.damper.coefficient"
values = [750, 1500, 3000]
[[parameters]]
name = "height"
key = "road.height"
values = [0.01, 0.02]
[[parameters]]
name = "method <script>"
key = "integrator.method"
values = ["exponential", "no </script> method"]
"""
# Parameters with many digits, whose names and values have little room.
CROWDED = f"""
run = "{MODELS}/examples/quarter_car_run.toml"
measures = ["tyres/tyre/dynamic_load_rms"]
set.duration = 0.05
[sampling]
method = "METHOD"
"""
RANGES = {
    "vehicle.forces.suspension.damper.coefficient": (750.0, 3000.0), "road.height": (0.01, 0.05), "speed": (1.0, 9.0),
    "road.start": (0.101, 0.203),
}  # fmt: skip
NAME = "one.id || one.getAttribute('href')"


class StudyPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = make_class_folder(cls)
        PICTURES.mkdir(parents=True, exist_ok=True)
        (cls.folder / "damper <b>.toml").write_text(STUDY, encoding="utf-8")
        run_program([TOOLS / "study", "damper <b>.toml", "-o", "out"], cwd=cls.folder, check=True)
        with open(cls.folder / "out/table.csv", encoding="utf-8", newline="") as file:
            cls.rows = list(csv.DictReader(file))
        ranges = [f'[[parameters]]\nkey = "{key}"\nfrom = {low}\nto = {high}\n' for key, (low, high) in RANGES.items()]
        grid = "".join(one + 'spacing = "logarithmic"\nnumber = 3\n' for one in ranges)
        for method, text in (("sobol", "number = 64\n" + "".join(ranges)), ("grid", grid)):
            (cls.folder / f"{method}.toml").write_text(CROWDED.replace("METHOD", method) + text, encoding="utf-8")
            run_program([TOOLS / "study", f"{method}.toml", "-o", method], cwd=cls.folder, check=True)
        cls.browser = cls.enterClassContext(Browser())

    def open(self, size="desktop", dark=False, folder="out"):
        page = self.browser.open(self.folder / folder / "study.html", *SIZES[size], dark=dark, touch=size == "phone")
        self.addCleanup(page.close)
        self.addCleanup(lambda: self.assertEqual(page.problems(), []))
        self.assertEqual(page.evaluate("document.documentElement.dataset.ready"), "true")
        return page

    def choose(self, page, element, label):
        """Chooses the entry of a menu that has a text."""
        page.evaluate(
            f"(() => {{ const s = document.getElementById('{element}');"
            f"s.value = [...s.options].find((one) => one.textContent.split(', ')[0] === '{label}').value;"
            "s.dispatchEvent(new Event('change', {bubbles: true})); })()"
        )
        page.settle()

    def column(self, name):
        """The numbers of a column of the table, of the runs that have not failed."""
        (key,) = (one for one in self.rows[0] if one.partition(" [")[0] == name)
        return [float(row[key]) for row in self.rows if row["exit_code"] == "0"]

    def test_every_control_has_a_case_here(self):
        page = self.open()
        cases = {f"#{name}" for name in ("best", "scatter", "heat-map", "parallel", "effects", "failures")}
        cases |= {"best-measure", "best-order", "scatter-x", "scatter-y", "scatter-colour", "heat-x", "heat-y"}
        cases |= {"heat-measure", "parallel-colour", "effect-measure"}
        cases |= {
            f"{name}-{kind}" for name in ("scatter", "heat-map", "parallel", "effects") for kind in ("csv", "png")
        }
        self.assertEqual(set(page.evaluate(f"{ALL_CONTROLS}.map((one) => {NAME})")), cases)

    def test_the_head_tells_what_was_run_and_names_are_texts_not_markup(self):
        page = self.open()
        self.assertEqual(page.evaluate("document.getElementById('title').textContent"), "damper <b>")
        self.assertEqual(page.evaluate("document.title"), "damper <b>")
        self.assertIn(
            "12 runs of quarter_car_run.toml", page.evaluate("document.getElementById('subtitle').textContent")
        )
        self.assertIn("6 failed", page.evaluate("document.getElementById('subtitle').textContent"))
        self.assertEqual(page.evaluate("parameterColumns[2].name"), "method <script>")

    def test_the_names_of_values_are_short_and_do_not_run_into_each_other(self):
        for folder in ("sobol", "grid"):
            for size in SIZES:
                with self.subTest(folder, size=size):
                    page = self.open(size, folder=folder)
                    marks = page.evaluate("effectMarks")
                    self.assertEqual(len(marks), 2 * len(RANGES))
                    for one in marks:
                        self.assertNotRegex(one["text"], "…|e[+−]|[0-9.]{7,}")
                    for row in (0, 1):
                        spans = sorted((one["from"], one["to"]) for one in marks if one["row"] == row)
                        for (_, end), (begin, _) in zip(spans, spans[1:]):
                            self.assertLess(end + 4.0, begin)
                    page.picture(PICTURES / f"effects_{folder}_{size}.png", "#effects")
                    page.evaluate("drawHeatMap()")
                    named = page.evaluate(
                        "(() => { const c = byId('heat-plot').getContext('2d'); c.font = '12px system-ui, sans-serif';"
                        "return diagrams.named.map((one) => c.measureText(one).width); })()"
                    )
                    width = page.box("#heat-plot")[2]
                    self.assertGreater(len(named), 1)
                    self.assertLess(sum(named) + 6.0 * (len(named) - 1), width - 84.0)

    def test_the_numbers_of_an_axis_up_are_whole(self):
        page = self.open("phone", folder="grid")
        widest = page.evaluate(
            "(() => { const c = byId('heat-plot').getContext('2d'); c.font = '12px system-ui, sans-serif';"
            "const up = [{place: 0.5, text: '0.022361'}], none = {title: '', marks: []};"
            "return [drawAxes(c, 338, 380, none, {title: '', marks: up}).left, c.measureText('0.022361').width]; })()"
        )
        self.assertGreaterEqual(widest[0], widest[1] + 30.0)

    def test_the_table_of_failures_fits_the_telephone(self):
        page = self.open("phone")
        inside, around = page.evaluate(
            "(() => { const one = document.querySelector('#failures .scroll');"
            "return [one.scrollWidth, one.clientWidth]; })()"
        )
        self.assertLessEqual(inside, around)

    def test_the_best_runs_are_in_order_of_the_measure_chosen(self):
        page = self.open()
        values = self.column("tyres/tyre/dynamic_load_rms")
        runs = [int(row["run"]) for row in self.rows if row["exit_code"] == "0"]
        self.choose(page, "best-measure", "tyres/tyre/dynamic_load_rms")
        for order, sign in (("the lowest", 1.0), ("the highest", -1.0)):
            self.choose(page, "best-order", order)
            shown = page.evaluate(
                "[...document.querySelectorAll('#best-table tbody tr')].map((one) => Number(one.dataset.run) + 1)"
            )
            self.assertEqual(shown, [run for _, run in sorted((sign * value, run) for value, run in zip(values, runs))])

    def test_a_click_on_a_row_chooses_the_run_everywhere(self):
        page = self.open()
        self.assertEqual(page.evaluate("document.getElementById('chosen').textContent"), "")
        before = [page.picture(selector=name) for name in ("#scatter-plot", "#parallel-plot")]
        page.click("#best-table tbody tr:nth-child(2)")
        run = page.evaluate("chosen.run")
        self.assertEqual(page.evaluate("document.querySelector('#best-table tr.chosen').dataset.run"), str(run))
        self.assertIn(f"Run {run + 1}. damping: ", page.evaluate("document.getElementById('chosen').textContent"))
        for old, name in zip(before, ("#scatter-plot", "#parallel-plot")):
            new = page.picture(selector=name)
            self.assertGreater(np.max(np.abs(new - old)), 0.2, name)

    def test_a_click_on_a_point_or_a_line_chooses_its_run(self):
        page = self.open()
        run, x, y = page.evaluate("scatter.places[3]")
        width, height = page.box("#scatter-plot")[2:]
        page.click("#scatter-plot", share=(x / width, y / height))
        self.assertEqual(page.evaluate("chosen.run"), run)
        page.click("#scatter-plot", share=(0.5, 0.999))  # far from all points
        self.assertIsNone(page.evaluate("chosen.run"))
        run, points = page.evaluate("parallel.lines[0]")
        width, height = page.box("#parallel-plot")[2:]
        page.click("#parallel-plot", share=(points[0][0] / width, points[0][1] / height))
        chosen = page.evaluate("chosen.run")  # one of those that begin at this place
        self.assertEqual(self.rows[chosen]["damping"], self.rows[run]["damping"])

    def test_the_scatter_places_a_run_by_its_two_columns(self):
        page = self.open()
        self.choose(page, "scatter-x", "tyres/tyre/dynamic_load_rms")
        self.choose(page, "scatter-y", "suspensions/suspension/compression")
        self.choose(page, "scatter-colour", "height")
        places = np.array(page.evaluate("scatter.places"))
        for column, name in ((1, "tyres/tyre/dynamic_load_rms"), (2, "suspensions/suspension/compression")):
            fit = np.polyfit(self.column(name), places[:, column], 1)
            np.testing.assert_allclose(np.polyval(fit, self.column(name)), places[:, column], atol=1e-3)
            self.assertGreater(fit[0] * (1 if column == 1 else -1), 0.0)  # to the right, and up
        self.assertIn("6 runs", page.evaluate("document.getElementById('scatter-plot').ariaLabel"))

    def test_the_heat_map_begins_with_parameters_that_have_several_values(self):
        text = CROWDED.replace("METHOD", "grid") + "".join(
            f'[[parameters]]\nkey = "{key}"\nvalues = {values}\n'
            for key, values in (("speed", [5.0]), ("road.height", [0.01, 0.02]), ("road.start", [0.1, 0.2]))
        )
        (self.folder / "constant.toml").write_text(text, encoding="utf-8")
        run_program([TOOLS / "study", "constant.toml", "-o", "constant"], cwd=self.folder, check=True)
        page = self.open(folder="constant")
        chosen = page.evaluate("['heat-x', 'heat-y'].map((name) => columnOf(byId(name)).name)")
        self.assertEqual(chosen, ["road.height", "road.start"])

    def test_values_that_are_lists_are_in_the_order_of_their_numbers(self):
        text = CROWDED.replace("METHOD", "grid") + (
            '[[parameters]]\nname = "rate"\nkey = "vehicle.forces.suspension.spring.polynomial"\n'
            'values = [[0, 2e4], [0, 3e4], [0, 1e4]]\n[[parameters]]\nkey = "road.height"\nvalues = [0.01, 0.02]\n'
        )
        (self.folder / "lists.toml").write_text(text, encoding="utf-8")
        run_program([TOOLS / "study", "lists.toml", "-o", "lists"], cwd=self.folder, check=True)
        page = self.open(folder="lists")
        in_order = ["[0, 10000.0]", "[0, 20000.0]", "[0, 30000.0]"]
        self.assertEqual(page.evaluate("fieldsOf(parameterColumns[0]).map((one) => one.name)"), in_order)
        self.assertEqual(page.evaluate("data.effects.find((one) => one.parameter === 'rate').groups"), in_order)

    def test_the_heat_map_shows_means_over_fields(self):
        page = self.open()
        self.choose(page, "heat-measure", "suspensions/suspension/compression")
        means = page.evaluate("calcFields(parameterColumns[0], parameterColumns[1], measureColumns[0]).means")
        np.testing.assert_allclose(
            np.array(means).T.ravel(), self.column("suspensions/suspension/compression"), rtol=1e-8
        )
        before = page.picture(selector="#heat-plot")
        for name, label in (("heat-x", "height"), ("heat-y", "damping"), ("heat-measure", "program/steps")):
            self.choose(page, name, label)
            after = page.picture(selector="#heat-plot")
            self.assertGreater(np.max(np.abs(after - before)), 0.2, name)
            before = after

    def test_the_main_effects_are_those_of_the_measure_chosen(self):
        page = self.open()
        first = page.evaluate("document.getElementById('effect-table').textContent")
        self.choose(page, "effect-measure", "tyres/tyre/dynamic_load_rms")
        shown = page.evaluate("document.getElementById('effect-table').textContent")
        self.assertNotEqual(shown, first)
        values = np.array(self.column("tyres/tyre/dynamic_load_rms")).reshape(3, 2)
        share = np.var(np.mean(values, axis=0)) / np.var(values)
        self.assertIn(f"height{100.0 * share:.0f} %", shown)

    def test_the_colour_of_the_lines_can_be_chosen(self):
        page = self.open()
        before = page.picture(selector="#parallel-plot")
        self.choose(page, "parallel-colour", "height")
        self.assertGreater(np.max(np.abs(page.picture(selector="#parallel-plot") - before)), 0.2)

    def test_failures_are_listed_once_with_all_runs_that_have_them(self):
        page = self.open()
        rows = page.evaluate("[...document.querySelectorAll('#failure-table tr')].map((one) => one.textContent)")
        (error,) = (row for row in rows if "</script>" in row)
        runs, _, text = error.partition("error")
        failed = [number for number, row in enumerate(self.rows, start=1) if row["error"]]
        self.assertEqual(runs, ", ".join(map(str, failed)))
        self.assertEqual({self.rows[number - 1]["error"] for number in failed}, {text})
        self.assertEqual(page.evaluate("nameRuns([...Array(10).keys()])"), "1, 2, 3, 4, 5, 6, 7, 8 … (10 runs)")

    def test_numbers_stand_beside_their_own_unit(self):
        page = self.open()
        self.choose(page, "best-measure", "tyres/tyre/dynamic_load_rms")
        heading = page.evaluate("document.querySelector('#best-table thead').textContent")
        self.assertIn("tyres/tyre/dynamic_load_rms, N", heading)
        chosen = page.evaluate(
            "(({options, selectedIndex}) => options[selectedIndex].text)(document.getElementById('best-measure'))"
        )
        self.assertEqual(chosen, "tyres/tyre/dynamic_load_rms, N")
        shown = page.evaluate("document.querySelector('#best-table tbody tr td:nth-child(5)').textContent")
        self.assertAlmostEqual(float(shown) / min(self.column("tyres/tyre/dynamic_load_rms")), 1.0, places=4)
        units = page.evaluate("['N', 'N m', 'Pa', 'rad', 'm', 'm/s^1.75'].map((unit) => titleOf({name: 'a', unit}))")
        self.assertEqual(units, ["a, N", "a, N m", "a, Pa", "a, rad", "a, m", "a, m/s¹·⁷⁵"])

    def test_a_page_of_very_many_runs_is_drawn(self):
        """More than a browser takes as arguments of one function."""
        study = read_study(self.folder / "damper <b>.toml")
        study = study._replace(parameters=study.parameters[1:2])
        shares = np.random.default_rng(1).random(200_000).tolist()
        rows = [Row(str(k), 0, "", True, (), {"program/steps": Measure(one, "")}, 0.1) for k, one in enumerate(shares)]
        finished = Finished(study, [(one,) for one in shares], [Task("", (), (), "")] * len(rows), rows, len(rows), 0)
        (self.folder / "many").mkdir()
        page = make_study_page(finished, make_measure_columns(finished), [])
        (self.folder / "many/study.html").write_text(page, encoding="utf-8")
        ends = self.open(folder="many").evaluate("columns.map((one) => [one.low, one.high])")
        np.testing.assert_allclose(ends, [[min(shares), max(shares)]] * 2, rtol=1e-8)

    def test_the_scatter_says_what_its_colours_mean(self):
        page = self.open()
        page.evaluate(
            "(() => { window.drawn = []; const real = CanvasRenderingContext2D.prototype.fillText;"
            "CanvasRenderingContext2D.prototype.fillText = function (text, x, y) { drawn.push(text);"
            "real.call(this, text, x, y); }; })()"
        )
        self.choose(page, "scatter-colour", "tyres/tyre/dynamic_load_rms")
        column = self.column("tyres/tyre/dynamic_load_rms")
        drawn = page.evaluate("drawn")
        for text in (f"tyres/tyre/dynamic_load_rms, N: {min(column):.5g}", f"{max(column):.5g}"):
            self.assertIn(text, drawn)

    def test_links_lead_to_their_sections(self):
        page = self.open()
        for name in ("best", "scatter", "heat-map", "parallel", "effects", "failures"):
            page.evaluate(f"document.querySelector('nav a[href=\"#{name}\"]').click()")
            self.assertEqual(page.evaluate("location.hash"), f"#{name}")

    def test_each_diagram_is_saved_as_numbers_and_as_a_picture(self):
        page = self.open()
        self.browser.save_downloads(self.folder)
        for name in ("scatter", "heat-map", "parallel", "effects"):
            with self.subTest(name):
                page.click(f"#{name}-csv")
                page.wait_for_download()
                table = list(csv.reader(io.StringIO((self.folder / f"{name}.csv").read_text(encoding="utf-8"))))
                self.assertGreater(len(table), 2)
                self.assertEqual({len(row) for row in table}, {len(table[0])})
                page.click(f"#{name}-png")
                page.wait_for_download()
                picture = matplotlib.image.imread(self.folder / f"{name}.png")
                self.assertGreater(np.std(picture[..., :3]), 0.02)
        saved = list(csv.DictReader(io.StringIO((self.folder / "parallel.csv").read_text(encoding="utf-8"))))
        self.assertEqual([row["damping"] for row in saved], [row["damping"] for row in self.rows])

    def test_it_fits_the_window_light_and_dark(self):
        for size in SIZES:
            for dark in (False, True):
                with self.subTest(size=size, dark=dark):
                    page = self.open(size, dark)
                    page.picture(keep=PICTURES / f"study_{size}_{'dark' if dark else 'light'}.png")
                    self.assertLessEqual(page.evaluate("document.documentElement.scrollWidth"), SIZES[size][0])
                    page.prefer(not dark)
                    page.click("#best-table tbody th")  # the row may be wider than the window
                    self.assertIsNotNone(page.evaluate("chosen.run"))


if __name__ == "__main__":
    unittest.main()
