#!/usr/bin/python3
"""model/rigid_body_loads.py on runs of the truck with a rigid chassis."""

import os
import unittest

import numpy as np
from tool_test_case import ROOT, ToolTestCase, run_program

from sprung_tools.files.results_file import open_results
from sprung_tools.model.rigid_body_loads import calc_rigid_moments, read_superelement
from sprung_tools.runs.largest_loads import find_bending


class ThinnedLoads(ToolTestCase):
    EVERY = 20  # outputs of 1 ms

    def run_truck(self, name, *overrides):
        settings = ("modes.chassis=0", "duration=1.5", "statistics={from=0,to=1.5}", 'output.store={recovery="none"}')
        arguments = [part for one in (*settings, *overrides) for part in ("--set", one)]
        done = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "run", ROOT / "dynamics/models/truck/bump.toml", "--superelements", ".",
             "--quiet", "-o", name, *arguments], cwd=self.folder)  # fmt: skip
        self.assertEqual(done.returncode, 0, done.stderr)
        results = open_results(self.folder / name)
        self.addCleanup(results.file.close)
        return results

    def test_the_largest_moment_is_that_of_stored_rows(self):
        """Interpolated loads do not balance the motion: the moment was 130 kN·m where it is -57 kN·m."""
        designs = [ROOT / f"meshes/truck/{name}.toml" for name in ("chassis", "long_arm")]
        built = run_program([os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", "."], cwd=self.folder)
        self.assertEqual(built.returncode, 0, built.stderr)
        whole = self.run_truck("whole.h5")
        thin = self.run_truck("thin.h5", f"output.step={{wrenches={1e-3 * self.EVERY},joints={1e-3 * self.EVERY}}}")
        moments, _ = calc_rigid_moments(whole, "chassis", read_superelement(self.folder / "chassis.h5"))
        expected = np.max(np.abs(moments[:: self.EVERY]))
        found = find_bending(thin, "chassis", (0.0, 1.5), str(self.folder))
        self.assertAlmostEqual(abs(found.value) / expected, 1.0, delta=1e-5)
        self.assertAlmostEqual(found.step, 1e-3 * self.EVERY)
        interpolated, _ = calc_rigid_moments(thin, "chassis", read_superelement(self.folder / "chassis.h5"))
        self.assertGreater(np.max(np.abs(interpolated)), 1.2 * expected)


if __name__ == "__main__":
    unittest.main()
