#!/usr/bin/python3
"""The files that a run leaves: complete ones, equal bytes for equal input, or a readable partial file."""

import json
import resource
import signal
import subprocess
import time
import unittest

import h5py

from dynamics_test_case import PROGRAM, SHORT, DynamicsTestCase, run_program


class Results(DynamicsTestCase):
    def test_equal_runs_are_equal_bytes(self):
        self.assertEqual(self.run_to_results().returncode, 0)
        first = self.results.read_bytes()
        self.assertEqual(self.run_to_results().returncode, 0)
        self.assertEqual(self.results.read_bytes(), first)

    def test_file_is_complete_and_agrees_with_the_printed_summary(self):
        process = self.run_to_results("--json")
        self.assertEqual(process.returncode, 0, process.stderr)
        summary = json.loads(process.stdout)
        self.assertEqual(summary["freedoms"], 7)
        with h5py.File(self.results, "r") as file:
            self.assertEqual(file.attrs["complete"], 1)
            self.assertEqual(file.attrs["format"], b"sprung-results")
            version = run_program([PROGRAM, "--version"], check=True).stdout.split()[1]
            self.assertEqual(file.attrs["program_version"].decode(), version)
            n = file["time"].shape[0]
            self.assertEqual(n, 51)  # 0 to 0.05 s, every millisecond
            self.assertEqual(file["bodies/chassis/modal/amplitude"].shape, (n, 2))
            self.assertEqual(file["recovery/chassis/moment"].shape, (n, 24))  # both ends of 12 elements
            moments = file["recovery/chassis/moment_from_loads"][:]
            self.assertEqual(moments.shape, (n, 24))
            # The design's area and section modulus at every station.
            self.assertEqual(set(file["recovery/chassis/area"]), {1.2004e-2})
            self.assertEqual(list(file["recovery/chassis/section_modulus"]), [1.267e-3] * 24)
            self.assertEqual(file["recovery/chassis/section_modulus"].attrs["unit"].decode(), "m^3")
            largest = summary["sections"]["chassis"]["moment"]["from_loads"]
            self.assertEqual(abs(largest["value"]), abs(moments).max())
            own = file["summary/sections/chassis"].attrs
            self.assertEqual(own["moment_from_loads"], largest["value"])
            row = list(file["time"]).index(own["moment_from_loads_time"])
            self.assertEqual(moments[row, own["moment_from_loads_station"]], largest["value"])
            bending = file["summary/bending/chassis"].attrs
            self.assertEqual(bending["deflection"], summary["bending"]["chassis"]["deflection"])
            height = file["bodies/chassis/position"][:, 1] - file["model/equilibrium/bodies/chassis"][1]
            written = file["summary/points/chassis.origin"].attrs
            self.assertEqual(written["displacement_max"], height.max())
            self.assertEqual(written["displacement_max"], summary["points"]["chassis.origin"]["displacement"]["max"])
            for name, dataset in numeric_datasets(file):
                self.assertIn("unit", dataset.attrs, name)
                self.assertTrue(dataset.fletcher32, name)

    def test_forces_in_equilibrium_are_those_of_the_command(self):
        """Also where the run starts on an obstacle, and moves already."""
        process = self.run_to_results("--set", 'road={shape="ramp",start=0.0,length=5.0,height=1.0}')
        self.assertEqual(process.returncode, 0, process.stderr)
        process = self.run_program("--json", verb="equilibrium")
        expected = json.loads(process.stdout)["forces"]
        with h5py.File(self.results, "r") as file:
            found = {name: dict(group.attrs) for name, group in file["model/equilibrium/forces"].items()}
            self.assertNotEqual(file["forces/front_tyre/force"][0], found["front_tyre"]["force"])
        self.assertEqual(found, expected)

    def test_the_kinds_of_vectors_are_those_of_the_superelement(self):
        modes = ("--set", "vehicle.bodies.chassis.superelement=chassis_certified", "--set", "modes.chassis=all")
        self.assertEqual(self.run_to_results(*modes).returncode, 0)
        with h5py.File(self.results) as results, h5py.File(self.folder / "chassis_certified.h5") as reduced:
            kinds = [one.decode() for one in results["model/superelements/chassis_certified/kind"][:]]
            self.assertEqual(kinds, [one.decode() for one in reduced["modes/kind"][:]])
            frequencies = reduced["modes/frequency"][:]
        self.assertEqual(set(kinds), {"free", "residual"})
        # The dry run gives the frequencies of modes alone.
        printed = self.run_program(*modes, "--dry-run").stdout
        for number, (kind, frequency) in enumerate(zip(kinds, frequencies), start=1):
            words = f"{number} ({frequency:.2f} Hz)" if kind == "free" else f"{number} (residual)"
            self.assertIn(words, printed)

    def test_reactions_carry_the_weight(self):
        # At rest the four arms and two springs hold the chassis: joint reactions, taken on the chassis, and spring
        # forces add up to its weight, 11950 kg · 9.80665 m/s².
        self.assertEqual(self.run_to_results("--set", "speed=0").returncode, 0)
        with h5py.File(self.results, "r") as file:
            lift = sum(
                file[f"joints/{end}_{arm}_chassis/reaction"][0, 1]
                for end in ("front", "rear")
                for arm in ("long", "short")
            )
            lift += sum(file[f"forces/{end}_suspension/force"][0] for end in ("front", "rear"))
        self.assertAlmostEqual(lift / (11950.0 * 9.80665), 1.0, places=6)

    def test_a_model_near_the_dead_bands_of_switches_is_warned_of(self):
        (self.folder / "tiny.toml").write_text(
            'vehicle = "pendulum.toml"\nstart = "as-given"\nduration = 1e-3\noutput_step = 1e-4\n', encoding="utf-8"
        )
        for length, is_warned in ((1e-6, True), (1e-3, False)):
            (self.folder / "pendulum.toml").write_text(
                'name = "pendulum"\n[bodies.rod]\nmass = 1e-9\ninertia = 1e-21\nposition = [0.0, 0.0]\n'
                f"[bodies.rod.points]\nend = [{length}, 0.0]\n"
                '[[joints]]\nname = "pin"\ntype = "revolute"\na = "ground.pin"\nb = "rod.end"\n'
                f"[ground.points]\npin = [{length}, 0.0]\n",
                encoding="utf-8",
            )
            process = run_program([PROGRAM, "run", "tiny.toml", "--quiet"], cwd=self.folder)
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertEqual("smaller units" in process.stderr, is_warned, process.stderr)

    def test_blocked_by_a_plain_file(self):
        (self.folder / "blocked").write_text("not a folder", encoding="utf-8")
        process = self.run_program("--quiet", "-o", "blocked/results.h5")
        self.assert_refused(process, "blocked")
        self.assertEqual((self.folder / "blocked").read_text(encoding="utf-8"), "not a folder")

    def test_files_that_are_no_results_are_left_alone(self):
        before = self.files()
        for target in ("bump.toml", "vehicle.toml", "chassis.h5"):
            with self.subTest(target):
                self.assert_refused(self.run_program(*SHORT, "-o", target), target, "no results file")
                self.assertEqual(self.files(), before)

    def test_a_statistics_window_without_output_is_refused(self):
        process = self.run_to_results("--set", "statistics.from=0.00051", "--set", "statistics.to=0.0009")
        self.assert_refused(process, "statistics", "there is none")

    def test_an_empty_name_is_no_name(self):
        for verb in ("run", "response", "select-modes"):
            process = self.run_program(*SHORT, "-o", "", verb=verb)
            self.assertEqual(process.returncode, 2, process.stderr)
            self.assertIn("must name a file", process.stderr)

    def test_disk_full_leaves_the_earlier_result(self):
        self.make_earlier_result()
        before = self.files()
        limit = 300_000  # bytes a process may write to a file: stands for a full disk, which root would not see
        process = self.run_program(
            "--quiet", "--set", "duration=0.5", "-o", "results.h5",
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        )
        self.assert_refused(process, "results", "File too large")
        self.assertEqual(self.files(), before)


class Interrupt(DynamicsTestCase):
    def test_interrupted_run_leaves_a_readable_partial_file(self):
        earlier = self.make_earlier_result()
        partial = self.folder / "results.partial.h5"
        # A run that would take minutes; it is interrupted once it has begun to write.
        process = subprocess.Popen(
            self.command(
                "--set", "duration=3600", "--set", "output_step=0.01", "--set", "modes.chassis=36", "-o", "results.h5"
            ),
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
        )
        while not partial.exists() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("results.partial.h5", errors)
        self.assertEqual(self.results.read_bytes(), earlier)
        with h5py.File(partial, "r") as file:
            self.assertEqual(file.attrs["complete"], 0)
            self.assertGreaterEqual(file["time"].shape[0], 1)
            self.assertEqual(file["bodies/chassis/position"].shape[0], file["time"].shape[0])


def numeric_datasets(file):
    found = []
    file.visititems(
        lambda name, item: found.append((name, item))
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" else None
    )
    return found


if __name__ == "__main__":
    unittest.main()
