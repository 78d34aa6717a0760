"""tools/plot_sensitivity: the frame of a sensitivity, coloured by element, and files that hold none."""

import json
import os
import unittest

import numpy as np
from tool_test_case import ROOT, ToolTestCase, run_program

from sprung_tools.plots.sensitivity_picture import make_sensitivity_figure, read_elements


class PlotSensitivity(ToolTestCase):
    def setUp(self):
        super().setUp()
        process = run_program(
            [os.environ["SPRUNG_REDUCE"], "sensitivity", ROOT / "meshes/truck/chassis.toml", "--json"], check=True
        )
        self.data = json.loads(process.stdout)
        (self.folder / "chassis.json").write_text(process.stdout, encoding="utf-8")

    def test_the_elements_have_places_and_effects(self):
        elements = read_elements(self.folder / "chassis.json")
        self.assertEqual(elements.ends.shape, (12, 2, 2))
        # More of all steel, stiffness and mass alike, moves no frequency.
        np.testing.assert_allclose(elements.effect.sum(axis=0), 0.0, atol=1e-8)
        # In the first bending of a free beam the middle is bent most, and the ends move most.
        first = elements.effect[:, 0]
        self.assertGreater(first[5], 0.0)
        self.assertLess(first[0], 0.0)

    def test_a_panel_for_each_mode(self):
        self.assert_succeeds(self.run_tool("plot_sensitivity", "-o", "out.svg", "chassis.json", "--modes", "1", "3"))
        text = (self.folder / "out.svg").read_text(encoding="utf-8")
        for part in ("free mode 1, 9.722 Hz", "free mode 3, 52.57 Hz", "Where steel moves chassis"):
            self.assertIn(part, text)

    def test_all_words_are_in_the_picture(self):
        # A frame of such a height that an aspect of the panels that changes their limits gives them wider tick labels.
        elements = read_elements(self.folder / "chassis.json")
        for height in (0.0, 0.5, 1.1, 4.0, 8.9, 9.1, 30.0):
            points = np.linspace([0.0, 0.0], [4.5, 0.0], 13)
            points[:, 1] = height * np.sin(np.linspace(0.0, np.pi, 13))
            frame = elements._replace(ends=np.stack([points[:-1], points[1:]], axis=1))
            for modes in ([1], [1, 2], [1, 2, 3]):
                figure = make_sensitivity_figure(frame, modes)
                figure.savefig(self.folder / "out.png")
                box = figure.get_tightbbox()
                self.assertGreaterEqual(min(box.x0, box.y0), 0.0)
                self.assertLessEqual(box.x1, figure.get_figwidth())
                self.assertLessEqual(box.y1, figure.get_figheight())

    def test_springs_have_no_colour(self):
        # Of a spring, which has no cross section, the effect of 1 % more of it would be the largest of all.
        design = (
            '[materials.s]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n[sections.r]\nmaterial = "s"\narea = 1e-2\n'
            "second_moment = 1e-5\n[points]\na = [0.0, 0.0]\nb = [3.0, 0.0]\nc = [0.0, 0.6]\nd = [3.0, 0.6]\n"
            '[[lines]]\nfrom = "a"\nto = "b"\nsection = "r"\nelements = 6\n'
            '[[lines]]\nfrom = "c"\nto = "d"\nsection = "r"\nelements = 6\n'
            + "".join(f'[[springs]]\nfrom = "{one}"\nto = "{other}"\naxial_stiffness = 2e6\n'
                      "rotational_stiffness = 3e4\n" for one, other in ("ac", "bd"))
            + '[reference]\npoint = "a"\n[modes]\ncount = 3\ndamping_ratio = 0.01\n'
        )  # fmt: skip
        (self.folder / "two.toml").write_text(design, encoding="utf-8")
        command = [os.environ["SPRUNG_REDUCE"], "sensitivity", "two.toml", "--json"]
        printed = run_program(command, cwd=self.folder, check=True).stdout
        (self.folder / "two.json").write_text(printed, encoding="utf-8")
        elements = read_elements(self.folder / "two.json")
        self.assertEqual(elements.is_spring.tolist(), [False] * 12 + [True] * 2)
        figure = make_sensitivity_figure(elements, [1])
        coloured, grey = figure.axes[0].collections
        self.assertEqual(len(coloured.get_segments()), 12)
        self.assertEqual(len(grey.get_segments()), 2)
        density = elements.effect[:12, 0] / 0.5  # m, of each element
        np.testing.assert_allclose(coloured.get_clim()[1], np.max(np.abs(density)))
        self.assertTrue(any("springs, which have no cross section" in text.get_text() for text in figure.texts))

    def test_a_frame_that_stands_fills_the_picture(self):
        elements = read_elements(self.folder / "chassis.json")
        mast = elements._replace(ends=elements.ends[:, :, ::-1].copy())
        figure = make_sensitivity_figure(mast, [1, 2, 3])
        figure.savefig(self.folder / "out.png")
        boxes = [axes.get_tightbbox() for axes in figure.axes]
        self.assertLess(min(box.x0 for box in boxes), 0.2 * figure.bbox.width)
        self.assertGreater(max(box.x1 for box in boxes), 0.8 * figure.bbox.width)

    def test_other_files_and_modes_are_refused(self):
        process = self.run_tool("plot_sensitivity", "-o", "out.svg", "chassis.json", "--modes", "7")
        self.assert_refuses(process, "--modes: error: 7 is no mode of the file, expected 1 … 6")
        self.assert_refuses(self.run_tool("plot_sensitivity", "-o", "out.svg", "none.json"), "none.json: error: ")
        for name, text in (("a.json", "{"), ("b.json", "{}"), ("c.json", json.dumps({**self.data, "elements": []}))):
            (self.folder / name).write_text(text, encoding="utf-8")
            process = self.run_tool("plot_sensitivity", "-o", "out.svg", name)
            self.assert_refuses(process, f"{name}: error: is not what sprung-reduce sensitivity --json prints")


if __name__ == "__main__":
    unittest.main()
