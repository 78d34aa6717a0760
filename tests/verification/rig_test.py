#!/usr/bin/python3
"""Measured input: a car on a four-post rig against the linear response of the same car on the road, and the reading of
histories by a whole run."""

import math
import os
import struct
import unittest

import h5py
import numpy as np

from response_case import ResponseCase, overrides
from verification_case import EXAMPLES, ROOT, VerificationCase, run_program

RIG = EXAMPLES / "four_post_run.toml"
CAR = ROOT / "dynamics/models/templates/half_car_run.toml"
# Dampers of one rate, as on the rig.
LINEAR = overrides(
    vehicle__forces__front_suspension__damper="{ coefficient = 1700.0 }",
    vehicle__forces__rear_suspension__damper="{ coefficient = 1600.0 }",
)
STEP = 5e-3  # of the drive and of the output, s
COUNT = 4096  # 20.48 s
CHANNELS = {
    "points/body.seat/acceleration.y": ("points/body.seat/acceleration", 1),
    "points/body.origin/displacement.y": ("points/body.origin/position", 1),
    "points/front_axle.origin/acceleration.y": ("points/front_axle.origin/acceleration", 1),
    "forces/rear_suspension/force": ("forces/rear_suspension/force", None),
}


def make_drive(seed):
    """Random heights of 0.4 to 15 Hz [m], level in the first half second and the last eight seconds, in which the car
    comes to rest."""
    random = np.random.default_rng(seed)
    time = STEP * np.arange(COUNT)
    heights = np.zeros(COUNT)
    for frequency in np.arange(0.4, 15.0, 0.1):
        heights += 4e-4 / frequency * np.sin(2.0 * np.pi * (frequency * time + random.random()))
    inside = np.clip(np.minimum((time - 0.5) / 2.0, (12.0 - time) / 2.0), 0.0, 1.0)
    return heights * inside**3 * (10.0 - 15.0 * inside + 6.0 * inside**2)


class Rig(ResponseCase):
    def drive(self, *posts):
        """Writes the heights of front and rear post to a file; returns the run with it."""
        rows = np.column_stack([STEP * np.arange(COUNT), *(1e3 * post for post in posts)])
        path = self.folder / "drive.csv"
        np.savetxt(path, rows, fmt="%.12g", delimiter=";", header="time [s];front [mm];rear [mm]", comments="")
        changes = {f"vehicle__motions__{one}_drive__function__history__file": f'"{path}"' for one in ("front", "rear")}
        changes |= {"duration": STEP * (COUNT - 1), "output_step": STEP, "integrator__relative_tolerance": 1e-7}
        return self.run_to_results(RIG, *overrides(**changes))

    def test_the_spectra_of_a_run_are_those_of_the_posts_times_the_response_on_the_road(self):
        # The car starts and ends at rest, so the transform of a quantity y is that of the posts z_k times the
        # transfer of each wheel alone, Y = Σ H_k Z_k. Both wheels are driven independently.
        posts = make_drive(1), make_drive(2)
        results = self.drive(*posts)
        bins = np.arange(8, 300)  # 0.39 to 14.6 Hz
        span = STEP * COUNT
        self.program("response", CAR, *LINEAR, "-o", "response.h5", *overrides(
            response__from=bins[0] / span, response__to=bins[-1] / span, response__number=len(bins),
            response__spacing="linear", response__points='["body.seat", "body.origin", "front_axle.origin"]',
        ))  # fmt: skip
        inputs = [np.fft.rfft(post)[bins] for post in posts]
        with h5py.File(self.folder / "response.h5", "r") as response:
            names = [name.decode() for name in response["inputs/name"]]
            self.assertEqual(names, ["front_tyre", "rear_tyre"])
            np.testing.assert_allclose(response["frequency"], bins / span, rtol=1e-12)
            for name, (dataset, component) in CHANNELS.items():
                transfer = response[f"outputs/{name}/transfer"][:]
                expected = sum((transfer[:, k, 0] + 1j * transfer[:, k, 1]) * inputs[k] for k in range(2))
                history = results[dataset] if component is None else results[dataset][:, component]
                found = np.fft.rfft(history - history[0])[bins]
                # What separates the two is the car's pitch, which turns forces by some mrad, and the curve between
                # the samples of the drive, 5/384 (ω h)⁴ at 15 Hz.
                error = np.abs(found - expected) / np.max(np.abs(expected))
                self.assertLess(np.max(error), 1e-3, name)
                spectrum = np.sum(np.abs(found) ** 2) / np.sum(np.abs(expected) ** 2)
                self.assertAlmostEqual(spectrum, 1.0, delta=2e-4, msg=name)

    def test_the_posts_follow_the_file_at_its_samples(self):
        posts = make_drive(3), make_drive(4)
        results = self.drive(*posts)
        for name, heights in zip(("front", "rear"), posts):
            moved = results[f"bodies/{name}_post/position"][:, 1]
            self.assert_close(moved - moved[0], heights - heights[0], absolute=1e-9)

    def test_the_example_runs_and_its_results_name_what_was_run(self):
        results = self.run_to_results(RIG)
        self.assertLess(results.summary["energy_closure"], 1e-3)
        group = results.file["model/resolved/histories/motions.front_drive.function.history"]
        self.assertEqual((group.attrs["file"], group.attrs["channel"]), (b"four_post_drive.csv", b"front"))
        self.assertEqual(len(group.attrs["sha256"]), 64)
        self.assertEqual((group.attrs["from"], group.attrs["to"]), (0.0, 12.0))
        self.assertGreater(np.max(np.abs(results["points/body.seat/acceleration"][:, 1])), 0.1)


SLED = """
name = "sled"
gravity = [0.0, 0.0]
[bodies.sled]
mass = 2.0
inertia = 1.0
position = [0.0, 0.0]
[[joints]]
name = "rail"
type = "translational"
a = "ground.origin"
b = "sled.origin"
axis = [1.0, 0.0]
[[forces]]
name = "push"
type = "applied"
point = "sled.origin"
force = [{}, 0.0]
"""
SAMPLES = ((0.0, 0.0), (0.11, 5.0), (0.13, 5.5), (0.4, -3.0), (0.45, 2.0), (1.0, 0.0))


def write_rpc3(path, step, channels):
    """A time history of 32-bit numbers in one group, big-endian."""
    count = len(channels[0])
    records = {
        "FORMAT": "BINARY_IEEE_BIG_END", "NUM_HEADER_BLOCKS": "4", "NUM_PARAMS": "13", "FILE_TYPE": "TIME_HISTORY",
        "DATA_TYPE": "FLOATING_POINT", "DELTA_T": str(step), "CHANNELS": str(len(channels)), "FRAMES": "1",
        "PTS_PER_FRAME": str(count), "PTS_PER_GROUP": str(count), "DESC.CHAN_1": "push", "UNITS.CHAN_1": "kN",
        "DESC.CHAN_2": "other",
    }  # fmt: skip
    header = b"".join(struct.pack(">32s96s", key.encode(), value.encode()) for key, value in records.items())
    samples = b"".join(struct.pack(f">{count}f", *channel) for channel in channels)
    path.write_bytes(header.ljust(4 * 512, b"\0") + samples)


class Histories(VerificationCase):
    def run_sled(self, force, method="exponential", duration=1.0):
        return self.run_text(
            SLED.format(force), f'duration = {duration}\nstart = "as-given"\n[integrator]\nmethod = "{method}"\n'
        )

    def write_samples(self, samples=SAMPLES):
        text = "time,push\n" + "".join(f"{time},{value}\n" for time, value in samples)
        (self.folder / "push.csv").write_text(text, encoding="utf-8")

    def refuse_sled(self, force, duration=1.0):
        return self.refuse_text(SLED.format(force), f'duration = {duration}\nstart = "as-given"\n')

    def test_a_history_gives_the_numbers_of_the_same_table_by_every_method(self):
        self.write_samples()
        table = "{ table = [" + ", ".join(f"[{time}, {value}]" for time, value in SAMPLES) + "] }"
        history = '{ history = { file = "push.csv", channel = "push" } }'
        for method in ("exponential", "adams", "bdf", "generalized-alpha"):
            with self.subTest(method):
                by_table = self.run_sled(table, method)["bodies/sled/position"]
                np.testing.assert_array_equal(self.run_sled(history, method)["bodies/sled/position"], by_table)

    def drive_sled(self, times, method, duration):
        """The sled on a rail that a smooth history drives: 0.2 m at 1 Hz, in mm with six digits as measured."""
        samples = [(time, f"{100.0 * (1.0 - math.cos(2.0 * math.pi * time)):.6g}") for time in times]
        text = "time [s],place [mm]\n" + "".join(f"{time:.9f},{place}\n" for time, place in samples)
        (self.folder / "drive.csv").write_text(text, encoding="utf-8")
        motion = '[[motions]]\nname = "drive"\njoint = "rail"\n'
        motion += 'function = { history = { file = "drive.csv", channel = "place" } }\n'
        return self.run_text(
            SLED.format(0.0) + motion, f'duration = {duration}\nstart = "as-given"\n[integrator]\nmethod = "{method}"\n'
        )

    def test_a_sled_without_freedoms_follows_a_measured_history_by_every_method(self):
        # Its place is that of the history: six digits of at most 200 mm.
        times = np.arange(1001) / 1000.0
        for method in ("exponential", "bdf", "generalized-alpha"):
            with self.subTest(method):
                results = self.drive_sled(times, method, 1.0)
                expected = 0.1 * (1.0 - np.cos(2.0 * np.pi * results.time))
                self.assert_close(results["bodies/sled/position"][:, 0], expected, absolute=1e-6)

    def test_two_close_samples_shorten_only_the_steps_near_them(self):
        # 201 samples, and one more 1 microsecond before the middle: steps of that length everywhere would be 1e6.
        times = np.sort(np.append(np.arange(201) / 200.0, 0.5 - 1e-6))
        with_both = self.drive_sled(times, "exponential", 1.0).summary["steps"]
        without = self.drive_sled(np.arange(201) / 200.0, "exponential", 1.0).summary["steps"]
        self.assertLess(with_both, without + 200)

    def test_a_history_in_rpc3_pushes_as_its_samples_say(self):
        # Straight lines between forces of 1000 sin(3t) N, 2 ms apart: velocity 1000 (1 − cos 3t)/(3 · 2 kg) to
        # h²/12 of the force's second derivative, and rounding of 32 bits.
        time = 2e-3 * np.arange(512)
        write_rpc3(self.folder / "push.rsp", 2e-3, (np.sin(3.0 * time), time))
        results = self.run_sled('{ history = { file = "push.rsp", channel = "push" } }')
        expected = 1000.0 * (1.0 - np.cos(3.0 * results.time)) / 6.0
        self.assert_close(results["bodies/sled/velocity"][:, 0], expected, absolute=1e-3)

    def test_a_run_beyond_its_history_is_refused_or_remarked_on(self):
        self.write_samples()
        history = '{{ history = {{ file = "push.csv", channel = "push"{} }} }}'
        message = self.refuse_sled(history.format(""), duration=1.5)
        self.assertIn("vehicle.toml:18:22: error: 'forces.push.force.0.history' is known from 0 s to 1 s, but is "
                      "needed until 1.5 s; say by 'after' what holds there", message)  # fmt: skip
        self.write_model(SLED.format(history.format(', after = "hold"')), 'duration = 1.5\nstart = "as-given"\n')
        process = run_program([os.environ["SPRUNG_DYNAMICS"], "run", "run.toml"], cwd=self.folder)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("remark: vehicle.toml:18:22: 'forces.push.force.0.history' ends at 1 s, the run at 1.5 s; from "
                      "then on its last value holds", process.stderr)  # fmt: skip

    def test_a_run_is_not_resumed_with_another_history(self):
        self.write_samples()
        self.run_sled('{ history = { file = "push.csv", channel = "push" } }')
        (self.folder / "results.h5").rename(self.folder / "results.partial.h5")
        self.write_samples((*SAMPLES[:-1], (1.0, 0.5)))
        command = [os.environ["SPRUNG_DYNAMICS"], "run", "run.toml", "--quiet", "-o", "results.h5", "--resume"]
        process = run_program(command, cwd=self.folder)
        self.assertEqual(process.returncode, 2, process.stdout)
        self.assertIn("is of another run: the file 'push.csv' has changed since", process.stderr)

    def test_a_bad_file_is_located(self):
        self.write_samples(((0.0, 0.0), (0.1, "nan"), (0.2, 1.0)))
        history = '{ history = { file = "push.csv", channel = "push" } }'
        self.assertIn("push.csv:3:5: error: 'push' must be a finite number", self.refuse_sled(history, 0.1))
        self.write_samples(((0.0, 0.0), (0.1, 1.0), (0.1, 2.0)))
        self.assertIn("push.csv:4:1: error: 'time' must ascend", self.refuse_sled(history, 0.1))
        self.assertIn("it has 'time', 'push'", self.refuse_sled(history.replace('"push" }', '"pull" }'), 0.1))
        write_rpc3(self.folder / "push.csv", 1e-3, ((0.0, 1.0), (2.0, 3.0)))
        whole = (self.folder / "push.csv").read_bytes()
        (self.folder / "push.csv").write_bytes(whole[:-3])
        message = self.refuse_sled(history, 1e-3)
        self.assertIn("push.csv: error: byte 2061: the file ends here; its header says 2064", message)


if __name__ == "__main__":
    unittest.main()
