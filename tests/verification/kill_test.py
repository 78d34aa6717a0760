#!/usr/bin/python3
"""Builds and runs that are ended at any moment: an earlier result stays whole, what is left can be read, and the next
command cleans up.

SPRUNG_KILLS is the number of signals, half of them to each program. The moments are parts of the time that the whole
command takes, from fixed seeds; whatever the machine has done by then, what is checked has to hold. Loading the program
is most of a build: there every second group of four signals waits for the program to handle them.
"""

import os
import random
import re
import shutil
import signal
import subprocess
import time
import unittest
from collections import Counter
from pathlib import Path

import h5py
import numpy as np

from verification_case import ROOT, ProgramTestCase, run_program

DYNAMICS, REDUCE = os.environ["SPRUNG_DYNAMICS"], os.environ["SPRUNG_REDUCE"]
KILLS = int(os.environ.get("SPRUNG_KILLS", "12")) // 2
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
RUN = [
    DYNAMICS, "run", "andrews_run.toml", "--quiet", "--set", "duration=0.4",
    "--set", "integrator.relative_tolerance=1e-9", "-o", "run.h5",
]  # fmt: skip
BUILD = [REDUCE, "build", "chassis.toml", "--output-dir", "."]


class KillTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        for path in ("dynamics/models/examples/andrews.toml", "dynamics/models/examples/andrews_run.toml",
                     "meshes/truck/chassis.toml"):  # fmt: skip
            shutil.copy(ROOT / path, self.folder)

    def read_files(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir()}

    def run_whole(self, command, once_loaded=False):
        """Runs to the end. Returns how long it took [s]; once_loaded: from when the program handles signals."""
        start = time.monotonic()
        with subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as process:
            if once_loaded:
                wait_until_handled(process)
                start = time.monotonic()
        self.assertEqual(process.returncode, 0)
        return time.monotonic() - start

    def end_after(self, command, seconds, number, once_loaded=False):
        """Starts a program and sends it a signal, unless it has ended before. Returns exit code and stderr.

        once_loaded: the seconds begin when the program handles signals."""
        with subprocess.Popen(
            command, cwd=self.folder, encoding="utf-8", stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        ) as process:  # fmt: skip
            if once_loaded:
                wait_until_handled(process)
            try:
                _, errors = process.communicate(timeout=seconds)
            except subprocess.TimeoutExpired:
                process.send_signal(number)
                _, errors = process.communicate()
            return process.returncode, errors

    def check_end(self, number, code, errors, before):
        """Exit code and message after a signal. A program that is not loaded yet ends by the signal itself."""
        self.assertIn(code, (0, 130, -number), errors)
        if code == 130:
            self.assertIn(": interrupted: ", errors)
        elif code == 0:
            self.assertEqual(errors, "")
        elif number != signal.SIGKILL:
            self.assertEqual(self.read_files(), before)

    def check_partial(self, whole):
        """What a partial file holds is the beginning of what the whole run gives. Returns whether there is one."""
        path = self.folder / "run.partial.h5"
        if not path.exists():
            return False
        with h5py.File(path) as file:
            self.assertEqual(file.attrs["complete"], 0)
            self.check_beginning(file, whole, len(file["time"]), len(file["events/time"]))
            self.assertIn("steps", file["summary"].attrs)
        return True

    def check_beginning(self, file, whole, rows, events):
        """The first rows and events of a file are those of the whole run, and there are no more."""
        for name in ("time", "bodies/K3/position", "energy/kinetic"):
            np.testing.assert_array_equal(file[name], whole[name][:rows])
        for name in ("time", "kind", "object", "text"):
            np.testing.assert_array_equal(file["events"][name], whole["events"][name][:events])

    def test_a_run_can_be_ended_at_any_moment(self):
        length = self.run_whole(RUN)
        earlier = (self.folder / "run.h5").read_bytes()
        moments, outcomes = random.Random(7), Counter()
        with h5py.File(self.folder / "run.h5") as file:
            whole = {name: file[name][()] for name in ("time", "bodies/K3/position", "energy/kinetic")}
            whole["events"] = {name: item[()] for name, item in file["events"].items()}
        for i in range(KILLS):
            number = SIGNALS[i % len(SIGNALS)]
            has_partial = (self.folder / "run.partial.h5").exists()
            resume = ["--resume"] if has_partial and moments.random() < 0.5 else []
            before = self.read_files()
            code, errors = self.end_after(RUN + resume, 1.1 * length * moments.random(), number)
            self.check_end(number, code, errors, before)
            # A run that came to its end gives the same bytes, unless it was resumed: then the same values.
            if code != 0 or not resume:
                self.assertEqual((self.folder / "run.h5").read_bytes(), earlier)
            else:
                with h5py.File(self.folder / "run.h5") as file:
                    self.assertEqual(file.attrs["complete"], 1)
                    self.check_beginning(file, whole, len(whole["time"]), len(whole["events"]["time"]))
            (self.folder / "run.h5").write_bytes(earlier)
            has_partial = self.check_partial(whole)
            outcomes[signal.Signals(number).name, code, "partial" if has_partial else "none"] += 1
        run_program(RUN, cwd=self.folder, check=True)
        self.assertEqual((self.folder / "run.h5").read_bytes(), earlier)
        self.assert_no_litter({"run.h5"})
        show(outcomes)

    def test_a_build_can_be_ended_at_any_moment(self):
        lengths = self.run_whole(BUILD), self.run_whole([*BUILD, "--force"], once_loaded=True)
        earlier = (self.folder / "chassis.h5").read_bytes()
        moments, outcomes = random.Random(8), Counter()
        for i in range(KILLS):
            number = SIGNALS[i % len(SIGNALS)]
            before, once_loaded = self.read_files(), i // len(SIGNALS) % 2 == 1
            seconds = 1.1 * lengths[once_loaded] * moments.random()
            code, errors = self.end_after([*BUILD, "--force", "--quiet"], seconds, number, once_loaded)
            self.check_end(number, code, errors, before)
            self.assertEqual((self.folder / "chassis.h5").read_bytes(), earlier)
            outcomes[signal.Signals(number).name, code, ""] += 1
        run_program(BUILD, cwd=self.folder, check=True)
        self.assertEqual((self.folder / "chassis.h5").read_bytes(), earlier)
        self.assert_no_litter({"chassis.h5"})
        show(outcomes)

    def assert_no_litter(self, results):
        self.assertEqual(set(self.read_files()), {"andrews.toml", "andrews_run.toml", "chassis.toml"} | results)


def wait_until_handled(process):
    """Waits until a process handles SIGTERM, or has ended."""
    while process.poll() is None:
        status = Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
        handled = re.search(r"^SigCgt:\s*(\w+)", status, re.MULTILINE)
        if handled and int(handled[1], 16) >> (signal.SIGTERM - 1) & 1:
            return
        time.sleep(1e-4)


def show(outcomes):
    """Counts of signal, exit code and partial file, where more than the usual number of signals is asked for."""
    if "SPRUNG_KILLS" in os.environ:
        for (name, code, partial), count in sorted(outcomes.items()):
            print(f"{name:8} exit {code:4} {partial:8} {count}")


if __name__ == "__main__":
    unittest.main()
