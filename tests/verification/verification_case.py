"""What the verification tests share: running the programs as a user does, and reading their files."""

import json
import math
import os
import sys
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from programs import ProgramTestCase, run_program  # noqa: E402, F401  after the path

EXAMPLES = ROOT / "dynamics/models/examples"
MODELS = Path(__file__).resolve().parent / "models"
SUPERELEMENTS = os.environ["SPRUNG_SUPERELEMENTS"]


class VerificationCase(ProgramTestCase):
    def program(self, verb, run_file, *arguments, superelements=SUPERELEMENTS, exit_code=0):
        """What the program prints with --json."""
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], verb, str(run_file), "--superelements", str(superelements), "--json",
             "--quiet", *arguments],
            cwd=self.folder,
        )  # fmt: skip
        self.assertEqual(process.returncode, exit_code, process.stderr)
        return json.loads(process.stdout)

    def run_to_results(self, run_file, *arguments, violation=1e-10, **options):
        """Runs; returns the open results file, with the printed summary as `.summary`."""
        path = self.folder / "results.h5"
        summary = self.program("run", run_file, *arguments, "-o", str(path), **options)
        self.assertLess(summary["constraint_violation"], violation)
        results = Results(path, summary)
        self.addCleanup(results.file.close)
        return results

    def write_model(self, vehicle, run):
        """Writes vehicle.toml, and run.toml that names it. Returns the run file."""
        (self.folder / "vehicle.toml").write_text(vehicle, encoding="utf-8")
        (self.folder / "run.toml").write_text('vehicle = "vehicle.toml"\n' + run, encoding="utf-8")
        return self.folder / "run.toml"

    def run_text(self, vehicle, run, *arguments):
        """run_to_results() for a vehicle and a run written down in the test."""
        return self.run_to_results(self.write_model(vehicle, run), *arguments)

    def refuse_text(self, vehicle, run, verb="run"):
        """Has the program refuse such a vehicle and run as bad input; returns what it says."""
        self.write_model(vehicle, run)
        process = run_program([os.environ["SPRUNG_DYNAMICS"], verb, "run.toml", "--quiet"], cwd=self.folder)
        self.assertEqual(process.returncode, 2, process.stderr)
        return process.stderr

    def modes(self, run_file, *arguments, **options):
        """Undamped angular frequencies [rad/s] without rigid-body modes, and the number of rigid-body modes."""
        modes = self.program("modes", run_file, *arguments, **options)["modes"]
        elastic = [2.0 * math.pi * mode["undamped_frequency"] for mode in modes if not mode["rigid_body"]]
        return np.array(elastic), sum(mode["rigid_body"] for mode in modes)

    def assert_close(self, values, expected, *, relative=0.0, absolute=0.0):
        np.testing.assert_allclose(values, expected, rtol=relative, atol=absolute)


class Results:
    def __init__(self, path, summary):
        self.file = h5py.File(path, "r")
        self.summary = summary
        self.time = self.file["time"][:]

    def __getitem__(self, name):
        return self.file[name][:]

    def energy(self):
        """Stored energy [J] at each output."""
        return sum(self[f"energy/{name}"] for name in ("kinetic", "strain", "gravity", "spring"))

    def row(self, time):
        row = int(np.argmin(np.abs(self.time - time)))
        assert abs(self.time[row] - time) < 1e-9
        return row
