"""What the tests of `sprung-dynamics response` share."""

import os
import sys

import numpy as np

from verification_case import ROOT, VerificationCase, run_program


def overrides(**keys):
    """--set arguments; `__` stands for the dot of a key."""
    arguments = []
    for key, value in keys.items():
        arguments += ["--set", f"{key.replace('__', '.')}={value}"]
    return arguments


class ResponseCase(VerificationCase):
    def response(self, run_file, *arguments, **options):
        return Response(self.program("response", run_file, *arguments, **options))

    def response_text(self, vehicle, run, *arguments):
        """The same for a vehicle and a run written down in the test."""
        return self.response(self.write_model(vehicle, run), *arguments)

    def attempt(self, run_file, *arguments):
        """The finished process of a command that may fail."""
        return run_program([os.environ["SPRUNG_DYNAMICS"], "response", run_file, *arguments], cwd=self.folder)

    def make_road(self, *arguments):
        """A road file made by the tool; returns its path."""
        path = self.folder / "road.txt"
        run_program([sys.executable, ROOT / "tools/make_road.py", "-o", path, *arguments], check=True)
        return path


class Response:
    def __init__(self, report):
        self.report = report
        self.frequency = np.array(report["frequency"])
        self.omega = 2.0 * np.pi * self.frequency

    def __getitem__(self, name):
        output = self.report["outputs"][name]
        return np.array(output["real"]) + 1j * np.array(output["imaginary"])

    def rms(self, name):
        return self.report["outputs"][name]["rms"]

    def spectrum(self, name):
        return np.array(self.report["outputs"][name]["spectrum"])
