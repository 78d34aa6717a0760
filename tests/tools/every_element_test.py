"""Every kind of joint and of force element in a results file: ride and report accept them, and the moments in a frame
that is taken as rigid contain the loads of all of them. Needs sprung-dynamics and the truck's superelements."""

import os
import shutil
import unittest
from pathlib import Path

import numpy as np
from tool_test_case import ROOT, ToolTestCase, make_class_folder, run_program

from sprung_tools.files.results_file import open_results
from sprung_tools.model.resolved_model import read_elements
from sprung_tools.model.rigid_body_loads import calc_rigid_moments, read_superelement

PROGRAM, SUPERELEMENTS = os.environ["SPRUNG_DYNAMICS"], os.environ["SPRUNG_SUPERELEMENTS"]
JOINTS = {"revolute", "translational", "fixed", "distance", "pin-in-slot", "motion"}
FORCES = {"spring-damper", "rotational-spring-damper", "applied", "tyre"}


class EveryElement(ToolTestCase):
    @classmethod
    def setUpClass(cls):
        """Runs with the frame rigid, and with all of its modes."""
        cls.made = make_class_folder(cls)
        shutil.copy(ROOT / "tests/tools/data/every_element.toml", cls.made / "vehicle.toml")
        (cls.made / "run.toml").write_text('vehicle = "vehicle.toml"\nduration = 0.5\n', encoding="utf-8")
        for name, modes in (("rigid", "0"), ("flexible", '"all"')):
            run_program([PROGRAM, "run", "run.toml", "--superelements", SUPERELEMENTS, "--quiet", "-o", f"{name}.h5",
                         "--set", f"modes.frame={modes}"], cwd=cls.made, check=True)  # fmt: skip

    def setUp(self):
        super().setUp()
        for path in self.made.glob("*.h5"):
            shutil.copy(path, self.folder)

    def open(self, name):
        results = open_results(self.folder / name)
        self.addCleanup(results.file.close)
        return results

    def test_ride_and_report_accept_all_of_them(self):
        results = self.open("rigid.h5")
        for group, kinds in (("joints", JOINTS), ("forces", FORCES)):
            self.assertEqual({one.kind for one in read_elements(results, group).values()}, kinds)
        ride = self.run_tool("ride", "rigid.h5", "--superelements", SUPERELEMENTS)
        self.assert_succeeds(ride)
        for name in ("front_suspension", "rear_tyre", "largest moment"):
            self.assertIn(name, ride.stdout)
        self.assert_succeeds(self.run_tool("report", "rigid.h5", "-o", "page.html"))

    def test_the_moments_of_a_rigid_frame_are_those_of_the_flexible_one_in_balance(self):
        # The flexible frame has the moments of its own modes. Its deflection of some millimetres changes the loads a
        # little.
        rigid, flexible = self.open("rigid.h5"), self.open("flexible.h5")
        moments, stations = calc_rigid_moments(rigid, "frame", read_superelement(Path(SUPERELEMENTS) / "chassis.h5"))
        expected, _ = flexible.history("recovery/frame/moment")
        np.testing.assert_array_equal(stations, flexible.history("recovery/frame/station")[0])
        largest = np.abs(expected[0]).max()
        self.assertGreater(largest, 1e4)  # N·m
        np.testing.assert_allclose(moments[0], expected[0], rtol=0, atol=0.01 * largest)


if __name__ == "__main__":
    unittest.main()
