#!/usr/bin/python3
"""A swinging beam and the truck's chassis on springs, as other programs computed them from exported bodies.

The tables in other_programs/ say which version ran with which input. The programs here and equations made of the
exported files have to give the same.
"""

import itertools
import os
import unittest

import numpy as np

from exported_bodies import PlaneSystem, read_exudyn, read_mbdyn, read_mbsim, read_sid
from verification_case import ROOT, VerificationCase, run_program

CASES = ROOT / "tests/verification/other_programs"
DESIGNS = {"pendulum": CASES / "swinging_beam.toml", "hung_chassis": ROOT / "meshes/truck/chassis.toml"}
BODIES = {"pendulum": "beam", "hung_chassis": "chassis"}
SPRINGS = [(np.array([-2.175, 0.0]), np.array([-2.175, 1.0]), 1.0, 8e5),
           (np.array([2.175, 0.0]), np.array([2.175, 1.0]), 1.0, 1.2e6)]  # fmt: skip
TARGETS = {"mbdyn": "mbdyn", "mbsim": "mbsim", "exudyn": "exudyn", "cadyn": "sid-by-mode"}
STIFFENED = {"cadyn"}  # its file alone contains the geometric stiffness


def read_table(program, case):
    """(frequencies [Hz], times [s], coordinates)"""
    lines = [line for line in (CASES / f"{program}_{case}.txt").read_text().splitlines() if not line.startswith("#")]
    words = lines[0].split()
    assert words[0] == "frequencies" and lines[1].startswith("time x y angle mode1")
    rows = np.array([line.split() for line in lines[2:]], float)
    return np.array(words[1:], float), rows[:, 0], rows[:, 1:]


class OtherPrograms(VerificationCase):
    def reduce(self, *arguments):
        result = run_program([os.environ["SPRUNG_REDUCE"], *map(str, arguments)], cwd=self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)

    def build(self, case):
        self.reduce("build", DESIGNS[case], "--output-dir", "bodies")
        return self.folder / "bodies" / f"{DESIGNS[case].stem}.h5"

    def assert_same_motion(self, found, expected, message, *, relative=1e-4, together=1):
        """Relative to the largest value of a coordinate, of the first coordinates together, of the modes."""
        scale = np.abs(expected).max(axis=0)
        scale[:together] = scale[:together].max()
        scale[3:] = scale[3:].max()
        np.testing.assert_array_less(np.abs(found - expected).max(axis=0), relative * scale + 1e-12, err_msg=message)

    def test_the_vehicle_program_gives_what_the_others_gave(self):
        for case in DESIGNS:
            self.build(case)
            run_file, folder = CASES / f"{case}_run.toml", self.folder / "bodies"
            printed = self.program("modes", run_file, "--set", "vehicle.gravity=[0.0, 0.0]", superelements=folder)
            # Without gravity nothing holds the chassis along x; the tables leave out its frequency of 0.
            frequencies = sorted(mode["damped_frequency"] for mode in printed["modes"])
            frequencies = [frequency for frequency in frequencies if frequency > 1e-3]
            motion = {stiffened: self.move(case, stiffened) for stiffened in (False, True)}
            for program in TARGETS:
                expected_frequencies, times, expected = read_table(program, case)
                self.assert_close(frequencies, expected_frequencies, relative=1e-6)
                found = motion[program in STIFFENED]
                self.assertEqual(len(found), len(times))
                # Standard input data are of first order, and lack terms that move the stiffened chassis along x.
                together = 2 if program in STIFFENED else 1
                self.assert_same_motion(found, expected, f"{program} {case}", together=together)

    def move(self, case, stiffened):
        """Coordinates in the vehicle program's run."""
        run_file, body = CASES / f"{case}_run.toml", BODIES[case]
        setting = f"stiffening.{body}={str(stiffened).lower()}"
        results = self.run_to_results(run_file, "--set", setting, superelements=self.folder / "bodies")
        # The place of the reference node, which is not quite that of a stiffened body (bodies, eq. 9).
        return np.hstack([results[f"points/{body}.origin/position"], results[f"bodies/{body}/position"][:, 2:],
                          results[f"bodies/{body}/modal/amplitude"]])  # fmt: skip

    def read_exported(self, program, case):
        self.reduce("export", self.build(case), "--to", TARGETS[program], "-o", "body")
        readers = {"mbdyn": lambda: read_mbdyn(self.folder / "body.fem"),
                   "exudyn": lambda: read_exudyn(self.folder / "body.hdf5", 0.01),
                   "mbsim": lambda: read_mbsim(self.folder / "body_mbsim.h5"),
                   "cadyn": lambda: read_sid(self.folder / "body.SID_FEM")}  # fmt: skip
        return readers[program]()

    def make_system(self, body, case, gravity):
        if case == "pendulum":
            return PlaneSystem(body, held=(0, 1), gravity=gravity)
        return PlaneSystem(body, SPRINGS, gravity=gravity)

    def test_exported_files_give_what_the_others_gave(self):
        for program, case in itertools.product(TARGETS, DESIGNS):
            expected_frequencies, times, expected = read_table(program, case)
            body = self.read_exported(program, case).take(expected.shape[1] - 3)
            self.assert_close(self.make_system(body, case, 0.0).frequencies(), expected_frequencies, relative=1e-6)
            rows = slice(0, 16)  # 0.3 s
            found = self.make_system(body, case, 9.81).move(times[rows])
            relative = 1e-4 if program == "mbdyn" else 1e-6  # MBDyn's motion is extrapolated
            self.assert_same_motion(found, expected[rows], f"{program} {case}", relative=relative)


if __name__ == "__main__":
    unittest.main()
