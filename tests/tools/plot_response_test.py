"""tools/plot_response: the picture holds what was asked for, and missing outputs are refused."""

import re
import unittest

import h5py
import numpy as np
from tool_test_case import ToolTestCase

from sprung_tools.plots.picture_file import write_picture
from sprung_tools.plots.response_picture import SPECTRUM, make_response_figure
from sprung_tools.runs.labelled_responses import open_responses
from sprung_tools.runs.labelled_runs import Shown

SEAT = "points/chassis.seat/acceleration.y"


def write_response(path, *, gain=1.0, with_road=True):
    """A response file in the layout of dynamics/output/response.md: |H| = gain · f."""
    frequency = np.linspace(0.1, 20.0, 60)
    with h5py.File(path, "w") as file:
        file.attrs.update(format="sprung-response", version=1, title="synthetic", speed=7.5)
        file["frequency"] = frequency
        group = file.create_group(f"outputs/{SEAT}")
        group.attrs["unit"] = "m/s^2"
        group["response"] = gain * np.column_stack([0.6 * frequency, -0.8 * frequency])
        group["response"].attrs["unit"] = "m/s^2/m"
        if with_road:
            group["spectrum"] = (gain * frequency) ** 2
            group["spectrum"].attrs["unit"] = "(m/s^2)^2/Hz"
            group.attrs["rms"] = 0.125


class PlotResponse(ToolTestCase):
    def setUp(self):
        super().setUp()
        write_response(self.folder / "a.h5")
        write_response(self.folder / "b.h5", gain=3.0, with_road=False)

    def draw_svg(self, *arguments):
        """Texts and curves (lists of points, y downwards) of the picture that these arguments give."""
        process = self.run_tool("plot_response", "-o", "out.svg", *arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        svg = (self.folder / "out.svg").read_text(encoding="utf-8")
        curves = {}
        for path, colour in re.findall(r'<path d="([^"]*)" clip-path="[^"]*" style="fill: none; stroke: (#\w+)', svg):
            points = np.array(re.findall(r"[ML] (\S+) (\S+)", path), dtype=float)
            if len(points) == 60:
                curves[colour] = points
        return re.findall(r"<!-- (.*?) -->", svg), curves

    def test_all_vehicles_are_in_the_heading_and_their_speeds_in_the_order_of_the_files(self):
        with h5py.File(self.folder / "a.h5", "a") as file:
            file.attrs.update(title="bus", speed=9.0)
        texts, _ = self.draw_svg("a.h5", "b.h5", "--show", SEAT)
        self.assertIn("bus, synthetic", texts)
        self.assertIn("speed 9, 7.5 m/s", " ".join(texts))
        texts, _ = self.draw_svg("a.h5", "--show", SEAT, "--bands")
        self.assertIn("boundaries of ISO 2631:1978", " ".join(texts))  # whole, and not shortened in its middle

    def test_magnitudes_of_all_files_over_frequency(self):
        texts, curves = self.draw_svg("soft=a.h5", "stiff=b.h5", "--show", f"seat={SEAT}", "--title", "A truck")
        for text in ("A truck", "soft", "stiff", "seat, m/s²/m", "frequency, Hz"):
            self.assertIn(text, texts)
        self.assertIn("speed 7.5 m/s", " ".join(texts))
        soft, stiff = curves["#000000"], curves["#0072b2"]
        # Both axes logarithmic: straight lines, the stiffer one higher by the same everywhere.
        np.testing.assert_allclose(soft[:, 1] - stiff[:, 1], (soft - stiff)[0, 1], atol=1e-3)
        self.assertGreater(soft[0, 1] - stiff[0, 1], 10.0)
        slope = np.diff(soft[:, 1]) / np.diff(soft[:, 0])
        np.testing.assert_allclose(slope, slope[0], rtol=1e-3)

    def test_spectra_with_their_rms(self):
        texts, curves = self.draw_svg("a.h5", "--show", SEAT, "--spectrum")
        self.assertIn("a.h5: r.m.s. 0.125 m/s²", texts)
        self.assertEqual(["points/chassis.seat/", "acceleration.y, (m/s²)²/Hz"],
                         [text for text in texts if text in "points/chassis.seat/acceleration.y, (m/s²)²/Hz"])
        self.assertEqual(len(curves), 1)

    def test_third_octave_bands_beside_the_boundaries_of_reduced_comfort(self):
        texts, _ = self.draw_svg("a.h5", "--show", f"seat={SEAT}", "--bands")
        for text in ("a.h5", "seat: r.m.s., m/s²", "reduced comfort after …", "8 h"):
            self.assertIn(text, texts)
        self.assert_refuses(self.run_tool("plot_response", "-o", "out.png", "b.h5", "--show", SEAT, "--bands"),
                            "has no spectra")  # fmt: skip
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["frequency"][:] *= 20.0  # too coarse a grid
        self.assert_refuses(self.run_tool("plot_response", "-o", "out.png", "a.h5", "--show", SEAT, "--bands"),
                            "a.h5: error: no third-octave band from 0.5 to 80 Hz has 8 frequencies")  # fmt: skip

    def test_labels_of_panels_do_not_meet_and_axes_have_several_numbers(self):
        with h5py.File(self.folder / "a.h5", "a") as file:
            file[f"outputs/{SEAT}/spectrum"][:] = np.geomspace(3.0, 60.0, 60)  # 10 is the only power of ten in it
        responses = open_responses([f"{self.folder}/a.h5"])
        long = "a name of some seat that goes on and on and on, and on, without an end"
        figure = make_response_figure(responses, [Shown(long, SEAT)] * 4, "", SPECTRUM)
        write_picture(figure, self.folder / "out.png")
        figure.draw_without_rendering()
        labels = [axes.yaxis.label.get_window_extent() for axes in figure.axes]
        for upper, lower in zip(labels, labels[1:]):
            self.assertGreater(upper.y0 - lower.y1, 10.0)  # pixels
        for axes in figure.axes:
            numbers = [one for one in axes.get_yticklabels(which="both") if one.get_text()]
            low, high = axes.get_ylim()
            self.assertGreaterEqual(sum(low <= one.get_position()[1] <= high for one in numbers), 2)

    def test_commands_that_take_runs_say_which_draw_a_response(self):
        for tool in ("report", "plot_results"):
            words = ("--show", SEAT) if tool == "plot_results" else ()
            self.assert_refuses(self.run_tool(tool, "a.h5", "-o", "out.html", *words), "a.h5: error: format is "
                                "'sprung-response', expected 'sprung-results'; plot_response draws a response, ride "
                                "prints its measures")  # fmt: skip

    def test_missing_outputs_and_files_are_refused(self):
        for arguments, fragment in (
            (
                ("a.h5", "--show", "points/nobody/velocity.y"),
                f"no output 'points/nobody/velocity.y'; there are: {SEAT}",
            ),
            (("b.h5", "--show", SEAT, "--spectrum"), "has no spectra"),
            (("c.h5", "--show", SEAT), "c.h5: error: no such file"),
        ):
            self.assert_refuses(self.run_tool("plot_response", "-o", "out.png", *arguments), fragment)
        self.assertFalse((self.folder / "out.png").exists())

    def test_spectra_below_0_and_frequencies_out_of_order_are_refused(self):
        for name, fragment in ((f"outputs/{SEAT}/spectrum", f"dataset 'outputs/{SEAT}/spectrum' holds values below 0"),
                               ("frequency", "dataset 'frequency' must hold increasing values")):  # fmt: skip
            write_response(self.folder / "a.h5")
            with h5py.File(self.folder / "a.h5", "a") as file:
                file[name][5] = -1.0
            process = self.run_tool("plot_response", "-o", "out.png", "a.h5", "--show", SEAT, "--spectrum")
            self.assert_refuses(process, f"a.h5: error: {fragment}")


if __name__ == "__main__":
    unittest.main()
