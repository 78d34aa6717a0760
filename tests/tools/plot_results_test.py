"""tools/plot_results: the picture holds what was asked for, and no other file is left."""

import os
import re
import unittest

import h5py
import matplotlib.image
import numpy as np
from synthetic_results import write_results
from tool_test_case import ToolTestCase

from sprung_tools.plots.picture_file import write_picture
from sprung_tools.plots.results_picture import make_results_figure
from sprung_tools.runs.labelled_runs import Shown, open_runs

DISPLACEMENT = "heave=bodies/chassis/displacement.y"


class PlotResults(ToolTestCase):
    def setUp(self):
        super().setUp()
        write_results(self.folder / "a.h5", num_modes=0)
        write_results(self.folder / "b.h5", scale=2.0)

    def draw_svg(self, *arguments):
        """The texts of the picture that these arguments give, and the colours of its curves."""
        process = self.run_tool("plot_results", "-o", "out.svg", *arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        svg = (self.folder / "out.svg").read_text(encoding="utf-8")
        # Matplotlib draws letters as paths and leaves each text in a comment; only what it plots is clipped.
        texts = re.findall(r"<!-- (.*?) -->", svg)
        return texts, re.findall(r'clip-path="[^"]*" style="fill: none; stroke: (#\w+)', svg)

    def test_title_legend_axes_and_caption_are_drawn(self):
        texts, _ = self.draw_svg("rigid=a.h5", "soft=b.h5", "--show", DISPLACEMENT, "--title", "A truck")
        for text in ("A truck", "rigid", "soft", "heave, mm", "time, s"):
            self.assertIn(text, texts)
        self.assertIn("initial speed 3 m/s", " ".join(texts))

    def test_names_that_are_too_long_for_the_picture_lose_their_middle(self):
        with h5py.File(self.folder / "a.h5", "a") as file:
            file.attrs["title"] = 5000 * "a long name "
            file["model/resolved/road"].attrs["file"] = 5000 * "folder/"
        quantity = f"{2000 * 'seat'} 1=bodies/chassis/displacement.y"
        texts, _ = self.draw_svg(f"{2000 * 'rigid'} one=a.h5", "soft=b.h5", "--show", quantity)
        for start, end, least, most in (
            ("a long name ", "long name , synthetic", 50, 100), ("rigid", "one", 50, 100), ("seat", "seat", 25, 60),
        ):  # fmt: skip
            (text,) = [text for text in texts if text.startswith(start)]
            self.assertRegex(text, f"…[^…]*{re.escape(end)}$")
            self.assertTrue(least <= len(text) <= most, text)
        self.assertIn("soft", texts)
        self.assertIn("1, mm", texts)
        self.assert_succeeds(self.run_tool("plot_results", "-o", "out.png", "a.h5", "--show", DISPLACEMENT))

    def test_a_legend_with_a_long_name_stands_above_the_curves(self):
        for label, is_above in (("rigid", False), ("a very long name of a run of the rigid truck", True)):
            runs = open_runs([f"{label}={self.folder}/a.h5"])
            shown = [Shown("heave", "bodies/chassis/displacement.y")]
            figure = make_results_figure(runs, shown, (None, None), "", with_road=True)
            write_picture(figure, self.folder / "out.png")
            figure.draw_without_rendering()
            (axes,) = figure.axes
            box = axes.get_legend().get_window_extent()
            self.assertEqual(box.y0 >= axes.get_window_extent().y1, is_above)
            self.assertLessEqual(box.y1, figure.bbox.y1)

    def test_each_run_has_a_curve_of_its_own_colour(self):
        _, colours = self.draw_svg("rigid=a.h5", "soft=b.h5", "--show", DISPLACEMENT)
        self.assertEqual((colours.count("#000000"), colours.count("#0072b2")), (1, 1))

    def test_a_run_keeps_its_colour_where_another_has_no_such_quantity(self):
        deflection = "points/chassis.front_end/deflection.y"
        texts, colours = self.draw_svg("rigid=a.h5", "soft=b.h5", "--show", deflection)
        self.assertEqual((colours.count("#000000"), colours.count("#0072b2")), (0, 1))
        self.assertNotIn("rigid", texts)

    def test_the_obstacle_is_marked_only_on_request(self):
        self.assertNotIn("front tyre", self.draw_svg("a.h5", "--show", DISPLACEMENT)[0])
        self.assertIn("front tyre", self.draw_svg("a.h5", "--show", DISPLACEMENT, "--mark-road")[0])

    def test_an_obstacle_outside_the_span_is_not_marked(self):
        with h5py.File(self.folder / "a.h5", "a") as file:
            height, time = file["forces/front_tyre/road_height"], file["time"][:]
            height[...] = 0.1 * (((time > 0.1 * time[-1]) & (time < 0.2 * time[-1])) | (time > 0.9 * time[-1]))
        middle = ("--from", str(0.3 * time[-1]), "--to", str(0.8 * time[-1]))
        texts, _ = self.draw_svg("a.h5", "--show", DISPLACEMENT, "--mark-road", *middle)
        self.assertNotIn("front tyre", texts)
        self.assertIn("no obstacle on a level road here", " ".join(texts))
        texts, _ = self.draw_svg("a.h5", "b.h5", "--show", DISPLACEMENT, "--mark-road")
        self.assertEqual(texts.count("front tyre"), 1)  # of two stretches
        self.assertIn("shaded: tyre over an obstacle in", " ".join(texts))

    def test_a_run_without_the_quantity_is_named(self):
        for tool, more in (("plot_results", ("-o", "out.png")), ("report_peaks", ())):
            quantity = "points/chassis.front_end/deflection.y"
            process = self.run_tool(tool, "stiff=a.h5", "b.h5", "--show", quantity, *more)
            self.assert_succeeds(process)
            self.assertIn(f"remark: stiff: has no '{quantity}'\n", process.stdout)

    def test_a_png_is_fit_for_a_page_and_not_blank(self):
        process = self.run_tool("plot_results", "-o", "out.png", "a.h5", "b.h5", "--show", DISPLACEMENT)
        self.assertEqual(process.returncode, 0, process.stderr)
        picture = matplotlib.image.imread(self.folder / "out.png")
        self.assertEqual(picture.shape[1], 1600)
        blue = np.array([0x00, 0x72, 0xB2]) / 255.0
        self.assertGreater(np.count_nonzero(np.all(np.abs(picture[:, :, :3] - blue) < 0.01, axis=2)), 1000)

    def test_the_same_runs_give_the_same_bytes(self):
        pictures = []
        for name in ("one.png", "two.png"):
            self.run_tool("plot_results", "-o", name, "a.h5", "--show", DISPLACEMENT)
            pictures.append((self.folder / name).read_bytes())
        self.assertEqual(*pictures)

    def test_bad_input_is_refused_and_leaves_no_picture(self):
        self.assert_refuses(
            self.run_tool("plot_results", "-o", "out.png", "c.h5", "--show", DISPLACEMENT),
            "c.h5: error: no such file",
        )
        self.assert_refuses(
            self.run_tool("plot_results", "-o", "out.png", "a.h5", "--show", "bodies/chassis/jerk.y"),
            "no quantity",
        )
        self.assert_refuses(
            self.run_tool("plot_results", "-o", "none/out.png", "a.h5", "--show", DISPLACEMENT),
            "none/out.png: error: cannot write the file",
        )
        self.assert_refuses(
            self.run_tool("plot_results", "-o", "out.xyz", "a.h5", "--show", DISPLACEMENT),
            "out.xyz: error: cannot write the picture",
        )
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.h5", "b.h5"])


if __name__ == "__main__":
    unittest.main()
