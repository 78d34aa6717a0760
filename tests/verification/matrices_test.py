#!/usr/bin/python3
"""A vehicle with a body from matrices moves as the one with the body from beams whose matrices they are."""

import os
import unittest
from pathlib import Path

import numpy as np

from verification_case import ROOT, VerificationCase, run_program

BUMP = ROOT / "dynamics/models/truck/bump.toml"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]


class Matrices(VerificationCase):
    def reduce(self, *arguments):
        result = run_program([os.environ["SPRUNG_REDUCE"], *map(str, arguments)], cwd=self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)

    def build_from_matrices(self, design):
        """The superelement of a design of lines by its own matrices, beside those of the other bodies."""
        self.reduce("matrices", design, "-o", "frame")
        text = design.read_text(encoding="utf-8")
        points = text[text.index("[points]") : text.index("[[lines]]")]
        matrices = "".join(f'{key} = "frame_{key}.{end}"\n' for key, end in (
            ("stiffness", "mtx"), ("mass", "mtx"), ("freedoms", "csv"), ("nodes", "csv")))
        (self.folder / design.name).write_text(
            f'{points}[matrices]\nformat = "matrix-market"\n{matrices}{text[text.index("[reference]") :]}',
            encoding="utf-8")
        self.reduce("build", design.name, "--output-dir", "bodies")
        for other in Path(TRUCK_SUPERELEMENTS).glob("*.h5"):
            if other.name != design.stem + ".h5":
                os.symlink(other, self.folder / "bodies" / other.name)

    def test_the_truck_over_a_bump_on_a_chassis_from_matrices(self):
        self.build_from_matrices(ROOT / "meshes/truck/chassis.toml")
        short = ("--set", "duration=1.0")
        expected = self.run_to_results(BUMP, *short, superelements=TRUCK_SUPERELEMENTS)
        found = self.run_to_results(BUMP, *short, superelements=self.folder / "bodies")
        for name in ("bodies/chassis/acceleration", "bodies/chassis/modal/amplitude", "energy/strain"):
            values = expected.file[name][()]
            tolerance = 1e-9 * np.abs(values).max()
            np.testing.assert_allclose(found.file[name], values, rtol=0, atol=tolerance, err_msg=name)
        # Matrices have no beams along which there were loads.
        self.assertIn("chassis", expected.file["recovery"])
        self.assertNotIn("chassis", found.file["recovery"])

    def test_axial_forces_of_a_body_from_matrices_cannot_be_asked_for(self):
        self.build_from_matrices(ROOT / "meshes/truck/chassis.toml")
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "run", str(BUMP), "--superelements", str(self.folder / "bodies"), "-o",
             str(self.folder / "results.h5"), "--set", "stiffening.chassis=true", "--quiet"],
            cwd=self.folder,
        )  # fmt: skip
        self.assertEqual(process.returncode, 2)
        self.assertIn("superelement 'chassis' has geometric stiffness of its lowest 0 modes", process.stderr)


if __name__ == "__main__":
    unittest.main()
