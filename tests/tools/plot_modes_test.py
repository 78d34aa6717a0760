"""tools/plot_modes: modes, curves and shares are in the picture, the history of modes is in that of --over-time, and
files without them are refused."""

import re
import unittest

import h5py
import numpy as np
from mode_runs import write_adaptive_run
from synthetic_results import NUM_SAMPLES, write_results, write_series
from tool_test_case import ToolTestCase

from sprung_tools.plots.mode_history_picture import make_mode_history_figure
from sprung_tools.runs.labelled_runs import Shown, open_runs

SHARES = (
    "displacement_rms",
    "displacement_peak",
    "acceleration_rms",
    "acceleration_peak",
    "force_rms",
    "force_peak",
    "static",
)


def write_choice(path, *, kind="sprung-mode-choice", with_forcing=True, with_choice=True):
    """A file in the layout of dynamics/output/results.md: three modes, the last left out."""
    with h5py.File(path, "w") as file:
        file.attrs.update(format=kind, version=1, title="synthetic", complete=1)
        file.create_group("model").attrs["speed"] = 7.5
        if not with_choice:
            return
        group = file.create_group("model/mode_choice")
        group.attrs["tolerance"] = 0.01
        group["mode_frequency"] = [5.0, 20.0, 60.0]
        group["kept"] = [1, 1, 0]
        group["remarks"] = np.array([b"all modes are kept, as nobody knows"])
        if not with_forcing:
            return
        for share in SHARES:
            group[f"share/{share}"] = [0.5, 0.02, 0.001]
        frequency = np.linspace(0.1, 50.0, 60)
        group["frequency"] = frequency
        group["road"] = 1.0 / frequency
        group["road"].attrs["unit"] = "m/Hz"
        group["transfer/chassis.seat"] = frequency**2
        group["transfer/chassis.seat"].attrs["unit"] = "m/s^2/m"


def read_texts(svg):
    """Matplotlib draws letters as paths and leaves each text in a comment."""
    return re.findall(r"<!-- (.*?) -->", svg)


class PlotModes(ToolTestCase):
    def draw_svg(self, *arguments):
        process = self.run_tool("plot_modes", "-o", "out.svg", *arguments)
        self.assert_succeeds(process)
        return (self.folder / "out.svg").read_text(encoding="utf-8")

    def test_forcing_transfer_modes_and_shares(self):
        for kind in ("sprung-mode-choice", "sprung-results"):
            write_choice(self.folder / "choice.h5", kind=kind)
            svg = self.draw_svg("choice.h5", "--title", "A truck")
            texts = read_texts(svg)
            for text in ("A truck", "chassis.seat", "mode kept", "mode left out", "frequency, Hz", "acceleration",
                         "road under the front wheel, m/Hz", "acceleration per road, m/s²/m"):  # fmt: skip
                self.assertIn(text, texts)
            self.assertIn("2 of 3 modes kept (filled); speed 7.5 m/s", " ".join(texts))
            # Two whole and one dotted line in each of the upper panels; points left out are hollow.
            lines = re.findall(
                r'style="fill: none;( stroke-dasharray: [^;]*; stroke-dashoffset: 0;)? stroke: #737373', svg
            )
            self.assertEqual((sum(not line for line in lines), sum(bool(line) for line in lines)), (6, 4))
            self.assertEqual(len(re.findall(r'<use [^>]*style="fill: #ffffff; stroke', svg)), 4)

    def test_names_are_plain_text_and_powers_of_ten_stay_formulas(self):
        write_choice(self.folder / "choice.h5")
        texts = read_texts(self.draw_svg("choice.h5", "--title", r"$\frac$ for 5 $ or 6 \$"))
        self.assertIn(r"$\frac$ for 5 $ or 6 \$", texts)
        self.assertIn(r"$\mathdefault{10^{1}}$", texts)

    def test_a_file_without_a_choice_is_refused(self):
        write_choice(self.folder / "fixed.h5", kind="sprung-results", with_choice=False)
        write_choice(self.folder / "blind.h5", with_forcing=False)
        write_choice(self.folder / "foreign.h5", kind="something")
        for name, fragment in (
            (
                "fixed.h5",
                'no modes were chosen in this run: its [modes] has none "auto"; what they did over time: --over-time',
            ),
            ("blind.h5", "the modes were not judged: all modes are kept, as nobody knows"),
            ("foreign.h5", "format is 'something'"),
            ("missing.h5", "missing.h5: error: no such file"),
        ):
            self.assert_refuses(self.run_tool("plot_modes", "-o", "out.png", name), fragment)
        self.assertFalse((self.folder / "out.png").exists())

    def test_modes_over_time_are_drawn_above_quantities_of_the_run(self):
        write_adaptive_run(self.folder / "adaptive.h5")
        write_results(self.folder / "rigid.h5", num_modes=0)
        svg = self.draw_svg("--over-time", "adaptive=adaptive.h5", "rigid chassis=rigid.h5")
        texts = read_texts(svg)
        for text in (
            "chassis: 1.5 of 3 vectors take part on the run's average, 2 at most; changes at 2 instants",
            "of the largest deflection so far: 3 % at most, chassis mode 3 at 0.5 s",
            "of the largest acceleration so far: 0.8 % at most, chassis mode 2 at 0.2 s",
            "recall, 1 %", "left out, %", "vector", "acceleration of chassis, m/s²", "time, s", "adaptive",
            "rigid chassis", "6.11", "38.3", "residual", "frequency, Hz",
        ):  # fmt: skip
            self.assertIn(text, texts)
        # The first mode takes part throughout, the second in two spans, the third never.
        self.assertEqual(svg.count('style="fill: #0072b2"'), 3)

    def test_over_time_other_quantities_and_a_part_of_the_run(self):
        write_adaptive_run(self.folder / "adaptive.h5")
        shown = ("--show", "driver=points/chassis.seat/acceleration.y", "--show", "heave=bodies/chassis/displacement.y")
        texts = read_texts(self.draw_svg("adaptive.h5", "--over-time", *shown, "--from", "0.25", "--to", "0.5"))
        self.assertIn("driver, m/s²", texts)
        self.assertIn("heave, mm", texts)
        self.assertIn("0.50", texts)
        self.assertNotIn("1.0", texts)

    def test_over_time_a_fixed_set_that_was_not_watched(self):
        write_adaptive_run(self.folder / "fixed.h5", is_adaptive=False)
        texts = read_texts(self.draw_svg("fixed.h5", "--over-time"))
        self.assertIn("chassis: all 3 vectors of the run take part throughout", texts)
        self.assertNotIn("left out, %", texts)

    def test_over_time_a_constant_share_lies_below_the_upper_edge(self):
        path = write_adaptive_run(self.folder / "constant.h5", numbers=(1,), is_adaptive=False)
        with h5py.File(path, "a") as file:
            write_series(file, "bodies/chassis/modal/neglected", np.tile((0.352, 2e-12, 3.0), (NUM_SAMPLES, 1)), "1")
        (run,) = open_runs([path])
        figure = make_mode_history_figure([run], [Shown("a", "bodies/chassis/acceleration.y")], (None, None))
        self.assertGreaterEqual(figure.axes[1].get_ylim()[1], 1.5 * 35.2)  # %
        heading = "chassis: the only mode of the run takes part throughout"
        self.assertEqual(figure.axes[0].get_title(loc="left"), heading)
        self.assertEqual(run.label, "chassis 1 mode")

    def test_shares_that_are_too_small_to_be_drawn_are_told(self):
        write_choice(self.folder / "choice.h5")
        told = "shares below 1e-06 are drawn as 1e-06"
        self.assertNotIn(told, read_texts(self.draw_svg("choice.h5")))
        with h5py.File(self.folder / "choice.h5", "a") as file:
            file["model/mode_choice/share/static"][1] = 1e-8
        self.assertIn(told, read_texts(self.draw_svg("choice.h5")))

    def test_over_time_a_run_without_modes_is_refused(self):
        write_results(self.folder / "rigid.h5", num_modes=0)
        self.assert_refuses(
            self.run_tool("plot_modes", "-o", "out.png", "--over-time", "rigid.h5"),
            "rigid.h5: error: no body of this run has modes",
        )

    def test_options_of_over_time_are_refused_without_it(self):
        write_choice(self.folder / "choice.h5")
        for arguments in (
            ("two.h5",),
            ("--show", "heave=bodies/chassis/displacement.y"),
            ("--from", "0"),
            ("--to", "1"),
        ):
            process = self.run_tool("plot_modes", "-o", "out.png", "choice.h5", *arguments)
            self.assertEqual(process.returncode, 2)
            self.assertIn("several files, --show, --from and --to go with --over-time", process.stderr)


if __name__ == "__main__":
    unittest.main()
