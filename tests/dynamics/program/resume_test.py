#!/usr/bin/python3
"""Runs that were interrupted or killed and are resumed: the results are those of a run without interruption, and a
partial file from which the run cannot be resumed is refused and left alone."""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests"))

from programs import ProgramTestCase, make_class_folder, run_program  # noqa: E402  after the path

PROGRAM = os.environ["SPRUNG_DYNAMICS"]
# One checkpoint, behind the middle of the run.
SETTINGS = ("--set", "duration=0.5", "--set", "integrator.relative_tolerance=1e-9")


def read_all(path):
    """Every dataset and attribute of an HDF5 file, by its path, as bytes."""
    found = {}

    def add(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = np.asarray(item[()]).tobytes()
        for key, value in item.attrs.items():
            found[f"{name}@{key}"] = np.asarray(value).tobytes()

    with h5py.File(path) as file:
        file.visititems(add)
        found["@complete"] = np.asarray(file.attrs["complete"]).tobytes()
    return found


def copy_model(folder):
    for name in ("andrews.toml", "andrews_run.toml"):
        shutil.copy(ROOT / "dynamics/models/examples" / name, folder / name)


def make_command(*arguments):
    return [PROGRAM, "run", "andrews_run.toml", *SETTINGS, *arguments]


ATTEMPTS = 20  # on a busy machine a run may be at its end before the signal


def signal_when(folder, number, has_come, *arguments):
    """Runs to cut.h5 and sends a signal as soon as `has_come`. Returns exit code and stderr."""
    with subprocess.Popen(
        make_command("--quiet", "-o", "cut.h5", *arguments), cwd=folder, encoding="utf-8", stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
    ) as process:  # fmt: skip
        while process.poll() is None and not has_come():
            time.sleep(0.001)
        process.send_signal(number)
        _, errors = process.communicate()
        return process.returncode, errors


def stop_after_checkpoint(folder, number):
    """Runs to cut.h5 and sends a signal as soon as there is a checkpoint. Returns exit code and stderr."""
    partial = folder / "cut.partial.h5"
    for _ in range(ATTEMPTS):
        partial.unlink(missing_ok=True)
        code, errors = signal_when(folder, number, partial.exists)
        if code != 0 and partial.exists():
            break
    return code, errors


class ResumeTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        """A whole run, and the partial file of one that was killed."""
        cls.made = make_class_folder(cls)
        copy_model(cls.made)
        run_program(make_command("--quiet", "-o", "whole.h5"), cwd=cls.made, check=True)
        cls.code, _ = stop_after_checkpoint(cls.made, signal.SIGKILL)

    def setUp(self):
        super().setUp()
        copy_model(self.folder)
        self.partial = self.folder / "cut.partial.h5"
        shutil.copy(self.made / "cut.partial.h5", self.partial)

    def resume(self, *arguments):
        return run_program(make_command("-o", "cut.h5", "--resume", *arguments), cwd=self.folder)

    def assert_resumes(self, process):
        self.assertEqual(process.returncode, 0, process.stderr)
        whole, found = read_all(self.made / "whole.h5"), read_all(self.folder / "cut.h5")
        self.assertEqual(sorted(whole), sorted(found))
        self.assertEqual([name for name in whole if whole[name] != found[name]], [])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["andrews.toml", "andrews_run.toml", "cut.h5"])  # fmt: skip

    def assert_refused(self, process, message):
        self.assertEqual(process.returncode, 2, process.stdout)
        self.assertIn(message, process.stderr)

    def test_a_killed_run_is_resumed_and_ends_with_the_results_of_an_uninterrupted_one(self):
        self.assertEqual(self.code, -signal.SIGKILL)
        process = self.resume()
        self.assertIn("Resumes from the checkpoint at t = 0.", process.stdout)
        self.assert_resumes(process)

    def test_an_interrupted_run_is_resumed_from_its_last_checkpoint(self):
        self.partial.unlink()
        code, errors = stop_after_checkpoint(self.folder, signal.SIGTERM)
        self.assertEqual(code, 130)
        self.assertTrue(errors.startswith("interrupted; completing cut.partial.h5\n"), errors)
        self.assertIn("partial results: cut.partial.h5; to continue, run again with --resume", errors)
        self.assert_resumes(self.resume())

    def test_a_run_that_is_resumed_and_killed_again_can_be_resumed(self):
        first = self.partial.read_bytes()
        temporary = self.folder / "cut.h5.tmp"

        def has_taken_over():
            """Whether the new file is as large as the partial one, which holds more than the checkpoint."""
            return temporary.exists() and temporary.stat().st_size >= 0.9 * len(first)

        for _ in range(ATTEMPTS):
            self.partial.write_bytes(first)
            code, _ = signal_when(self.folder, signal.SIGKILL, has_taken_over, "--resume")
            if code != 0:
                break
        self.assertEqual(code, -signal.SIGKILL)
        self.assertEqual(self.partial.read_bytes(), first)  # until there is another checkpoint
        self.assert_resumes(self.resume())

    def test_a_run_whose_disk_becomes_full_behind_a_checkpoint_is_resumed(self):
        self.partial.unlink()
        limit = int(0.9 * (self.made / "whole.h5").stat().st_size)
        process = run_program(
            make_command("--quiet", "-o", "cut.h5"), cwd=self.folder,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        )  # fmt: skip
        self.assert_refused(process, "cannot be written: File too large")
        self.assertIn("partial results: cut.partial.h5; to continue, run again with --resume", process.stderr)
        self.assertFalse((self.folder / "cut.h5.tmp").exists())
        self.assert_resumes(self.resume())

    def test_a_file_of_another_program_at_the_partial_name_is_left_alone(self):
        self.partial.write_text("notes")
        message = "cut.partial.h5: error: exists and is no results file, so it is not overwritten"
        self.assert_refused(run_program(make_command("-o", "cut.h5"), cwd=self.folder), message)
        self.assertEqual(self.partial.read_text(), "notes")
        message = "a.partial.h5: error: is a name of results that are not complete"
        self.assert_refused(run_program(make_command("-o", "a.partial.h5"), cwd=self.folder), message)

    def test_a_killed_run_whose_histories_are_compressed_and_chosen_is_resumed(self):
        chosen = ("--set", "output.precision=single", "--set", "output.step.joints=1e-3",
                  "--set", "output.store.points=none")  # fmt: skip
        run_program(make_command("--quiet", "-o", "whole.h5", *chosen), cwd=self.folder, check=True)
        self.partial.unlink()
        for _ in range(ATTEMPTS):
            self.partial.unlink(missing_ok=True)
            code, _ = signal_when(self.folder, signal.SIGKILL, self.partial.exists, *chosen)
            if code != 0 and self.partial.exists():
                break
        self.assertEqual(code, -signal.SIGKILL)
        process = self.resume(*chosen)
        self.assertEqual(process.returncode, 0, process.stderr)
        whole, found = read_all(self.folder / "whole.h5"), read_all(self.folder / "cut.h5")
        self.assertEqual(sorted(whole), sorted(found))
        self.assertEqual([name for name in whole if whole[name] != found[name]], [])
        with h5py.File(self.folder / "cut.h5") as file:
            reaction = file[f"joints/{next(iter(file['joints']))}/reaction"]
            self.assertEqual((reaction.dtype, reaction.attrs["every"]), (np.float32, 10))
            self.assertEqual(len(reaction), -(-len(file["time"]) // 10))
            self.assertNotIn("points", file)

    def test_a_partial_file_shows_events_and_summary_up_to_its_checkpoint(self):
        with h5py.File(self.partial) as file, h5py.File(self.made / "whole.h5") as whole:
            rows = file["time"].shape[0]
            np.testing.assert_array_equal(file["time"], whole["time"][:rows])
            events = file["events/time"].shape[0]
            for name in ("time", "kind", "object", "text"):
                np.testing.assert_array_equal(file["events"][name], whole["events"][name][:events])
            self.assertEqual(file["summary"].attrs["num_samples"], rows)
            self.assertGreater(whole["summary"].attrs["steps"], file["summary"].attrs["steps"])
            self.assertNotIn("checkpoint", whole)

    def test_without_a_partial_file_nothing_is_resumed(self):
        self.partial.unlink()
        self.assert_refused(self.resume(), "cut.partial.h5: error: there is no such file, so there is no run to resume")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["andrews.toml", "andrews_run.toml"])

    def test_a_run_needs_the_name_of_its_results_to_be_resumed(self):
        process = run_program(make_command("--resume"), cwd=self.folder)
        self.assert_refused(process, "--resume: error: needs -o, the name of the results")

    def test_the_partial_file_of_another_run_is_refused_and_stays(self):
        before = self.partial.read_bytes()
        self.assert_refused(self.resume("--set", "output_step=2e-4"), "the assignments of --set have changed since")
        for name, what in (("andrews_run.toml", "the run file"), ("andrews.toml", "the vehicle file")):
            path = self.folder / name
            text = path.read_text(encoding="utf-8")
            path.write_text(text + "# changed\n", encoding="utf-8")
            self.assert_refused(self.resume(), f"cut.partial.h5: error: is of another run: {what} has changed since")
            path.write_text(text, encoding="utf-8")
        self.assertEqual(self.partial.read_bytes(), before)
        self.assert_resumes(self.resume())

    def test_the_partial_file_of_another_version_is_refused(self):
        with h5py.File(self.partial, "r+") as file:
            file.attrs["program_version"] = np.bytes_("0.0.1")
        self.assert_refused(self.resume(), "cut.partial.h5: error: is of another run: the program's version has")

    def test_the_state_of_a_program_with_another_layout_is_refused_and_stays(self):
        # A program of the same version number that packed its state otherwise: without the number of the layout, as
        # the first ones did, and with another one.
        with h5py.File(self.partial) as file:
            state = file["checkpoint"][()]
        for other in (state[8:], np.append(state[:1] + 1, state[1:])):
            with h5py.File(self.partial, "r+") as file:
                del file["checkpoint"]
                file["checkpoint"] = other
            before = self.partial.read_bytes()
            self.assert_refused(
                self.resume(),
                "cut.partial.h5: error: dataset '/checkpoint' was written by another version of the program, whose",
            )
            self.assertEqual(self.partial.read_bytes(), before)

    def test_a_damaged_partial_file_is_refused_and_stays(self):
        def shorten(file):
            state = file["checkpoint"][()]
            del file["checkpoint"]
            file.create_dataset("checkpoint", data=state[:-1], chunks=state[:-1].shape, fletcher32=True)

        def lengthen(file):
            state = file["checkpoint"][()]
            del file["checkpoint"]
            file["checkpoint"] = np.append(state, state[:1])

        def lose_rows(file):
            file["energy/kinetic"].resize((5,))

        def lose_a_history(file):
            del file["energy/kinetic"]

        def lose_events(file):
            del file["events/kind"]

        whole = self.partial.read_bytes()
        for damage in (shorten, lengthen, lose_rows, lose_a_history, lose_events):
            with self.subTest(damage.__name__):
                self.partial.write_bytes(whole)
                with h5py.File(self.partial, "r+") as file:
                    damage(file)
                damaged = self.partial.read_bytes()
                self.assert_refused(self.resume(), "cut.partial.h5: error: dataset '/")
                self.assertEqual(self.partial.read_bytes(), damaged)
        for size in (0, 100, len(whole) // 2, len(whole) - 1):
            self.partial.write_bytes(whole[:size])
            self.assert_refused(self.resume(), "cut.partial.h5: error: ")

    def test_a_state_of_another_size_is_refused_and_stays(self):
        # The last state loses a position. Behind the number of the layout follow the start and this state, each of the
        # time, positions and velocities, and branches, with their numbers.
        with h5py.File(self.partial, "r+") as file:
            state = file["checkpoint"][()].tobytes()
            count = int.from_bytes(state[16:24], "little")
            num_branches = int.from_bytes(state[32 + 16 * count : 40 + 16 * count], "little")
            place = 8 + (8 + 2 * (8 + 8 * count) + 8 + 4 * num_branches) + 8
            self.assertEqual(int.from_bytes(state[place : place + 8], "little"), count)
            state = state[:place] + (count - 1).to_bytes(8, "little") + state[place + 16 :]
            del file["checkpoint"]
            file["checkpoint"] = np.frombuffer(state, np.uint8)
        damaged = self.partial.read_bytes()
        process = self.resume()
        self.assert_refused(process, "cut.partial.h5: error: dataset '/checkpoint' is damaged; run without --resume")
        self.assertNotIn("run again with --resume", process.stderr)
        self.assertEqual(self.partial.read_bytes(), damaged)
        self.assertFalse((self.folder / "cut.h5.tmp").exists())

    def test_a_run_that_was_interrupted_before_its_first_checkpoint_is_resumed_from_its_start(self):
        with h5py.File(self.partial, "r+") as file:
            del file["checkpoint"]
        process = self.resume()
        self.assertIn("Resumes from the start: the run was interrupted before its first checkpoint", process.stdout)
        self.assert_resumes(process)


if __name__ == "__main__":
    unittest.main()
