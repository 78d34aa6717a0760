"""tools/plot_modes: that modes, curves and shares are in the picture, and that what holds no choice is refused."""

import re
import unittest

import h5py
import numpy as np
from tool_test_case import ToolTestCase

SHARES = ("displacement_rms", "displacement_peak", "acceleration_rms", "acceleration_peak", "force_rms", "force_peak", "static")


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


class PlotModes(ToolTestCase):
    def test_forcing_transfer_modes_and_shares(self):
        for kind in ("sprung-mode-choice", "sprung-results"):
            write_choice(self.folder / "choice.h5", kind=kind)
            process = self.run_tool("plot_modes", "-o", "out.svg", "choice.h5", "--title", "A truck")
            self.assertEqual((process.returncode, process.stderr), (0, ""))
            svg = (self.folder / "out.svg").read_text(encoding="utf-8")
            texts = re.findall(r"<!-- (.*?) -->", svg)
            for text in ("A truck", "chassis.seat", "mode kept", "mode left out", "frequency, Hz", "acceleration",
                         "road under the front wheel, m/Hz", "acceleration per road, m/s²/m"):  # fmt: skip
                self.assertIn(text, texts)
            self.assertIn("2 of 3 modes kept (filled); speed 7.5 m/s", " ".join(texts))
            # Two whole and one dotted line in each of the upper panels; points left out are hollow.
            lines = re.findall(r'style="fill: none;( stroke-dasharray: [^;]*; stroke-dashoffset: 0;)? stroke: #737373', svg)
            self.assertEqual((sum(not line for line in lines), sum(bool(line) for line in lines)), (6, 4))
            self.assertEqual(len(re.findall(r'<use [^>]*style="fill: #ffffff; stroke', svg)), 4)

    def test_what_holds_no_choice_is_refused(self):
        write_choice(self.folder / "fixed.h5", kind="sprung-results", with_choice=False)
        write_choice(self.folder / "blind.h5", with_forcing=False)
        write_choice(self.folder / "foreign.h5", kind="something")
        for name, fragment in (
            ("fixed.h5", 'no modes were chosen in this run: its [modes] has none "auto"'),
            ("blind.h5", "the forcing was not looked at: all modes are kept, as nobody knows"),
            ("foreign.h5", "format is 'something'"),
            ("missing.h5", "missing.h5: error: no such file"),
        ):
            self.assert_refuses(self.run_tool("plot_modes", "-o", "out.png", name), fragment)
        self.assertFalse((self.folder / "out.png").exists())


if __name__ == "__main__":
    unittest.main()
