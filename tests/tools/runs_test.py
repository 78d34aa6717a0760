"""runs/labelled_runs.py and runs/run_caption.py: labels, spans of time, captions."""

import unittest

import h5py
import numpy as np
from synthetic_results import write_results
from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.runs.run_caption import describe_road, make_caption
from sprung_tools.runs.labelled_runs import (
    Shown,
    describe,
    open_runs,
    runs_with,
    samples_between,
    shown_quantities,
    split_label,
)


class Labels(ToolTestCase):
    def open(self, *arguments):
        runs = open_runs(arguments)
        for run in runs:
            self.addCleanup(run.results.file.close)
        return runs

    def test_a_label_stands_before_the_first_equals_sign(self):
        self.assertEqual(split_label("two = 2=a.h5"), ("two ", " 2=a.h5"))
        self.assertEqual(split_label("a.h5"), ("", "a.h5"))

    def test_a_file_whose_name_has_an_equals_sign_is_a_file(self):
        path = write_results(self.folder / "modes=2.h5")
        self.assertEqual(split_label(path), ("", path))

    def test_runs_without_label_are_named_by_their_flexible_bodies(self):
        paths = [write_results(self.folder / f"{n}.h5", num_modes=n) for n in (0, 4)]
        self.assertEqual([run.label for run in self.open(*paths)], ["rigid", "chassis 4 modes"])

    def test_runs_of_equal_names_are_distinguished_by_file(self):
        paths = [write_results(self.folder / name) for name in ("a.h5", "b.h5")]
        self.assertEqual(
            [run.label for run in self.open(*paths)], ["chassis 2 modes (a.h5)", "chassis 2 modes (b.h5)"]
        )

    def test_the_same_file_twice_is_distinguished_by_number(self):
        path = write_results(self.folder / "a.h5")
        labels = [run.label for run in self.open(f"x={path}", f"x={path}")]
        self.assertEqual(labels, ["x (a.h5) (no. 1)", "x (a.h5) (no. 2)"])

    def test_a_quantity_is_its_own_label(self):
        self.assertEqual(shown_quantities(["time", "t=time"]), [Shown("time", "time"), Shown("t", "time")])

    def test_only_runs_that_have_a_quantity_show_it(self):
        rigid, flexible = self.open(*(write_results(self.folder / f"{n}.h5", num_modes=n) for n in (0, 2)))
        deflection = Shown("deflection", "points/chassis.front_end/deflection.y")
        self.assertEqual(runs_with([rigid, flexible], deflection), [flexible])
        with self.assertRaisesRegex(InputError, "no quantity 'points/chassis.front_end/deflection.y'"):
            runs_with([rigid], deflection)


class Spans(ToolTestCase):
    def test_both_ends_belong_to_the_span(self):
        with open_results(write_results(self.folder / "run.h5")) as results:
            time = results.time[samples_between(results, results.time[20], results.time[40])]
            self.assertEqual((time[0], time[-1]), (results.time[20], results.time[40]))
            self.assertTrue(samples_between(results, None, None).all())

    def test_a_span_without_samples_is_refused(self):
        with open_results(write_results(self.folder / "run.h5")) as results:
            with self.assertRaisesRegex(InputError, "no samples from 7 to 1 s"):
                samples_between(results, 7.0, None)


class Captions(ToolTestCase):
    def test_a_caption_tells_speed_road_integrator_and_sampling(self):
        with open_results(write_results(self.folder / "run.h5")) as results:
            caption = make_caption([results])
            self.assertEqual(describe(results), "chassis 2 modes")
        caption = " ".join(caption.split())
        self.assertIn("initial speed 3 m/s; road: half-sine, length 0.4 m, height 0.2 m", caption)
        self.assertIn("method adams", caption)
        self.assertIn("a sample every 5 ms", caption)

    def test_the_caption_is_of_the_model_as_run_not_of_the_files(self):
        told = {"settings": {"speed": 5.0}, "integrator": {"relative_tolerance": 1e-8}, "overrides": ("speed=5",)}
        with open_results(write_results(self.folder / "run.h5", **told)) as results:
            caption = make_caption([results])
        for expected in ("initial speed 5 m/s", "1e-08"):
            self.assertIn(expected, caption)

    def test_a_random_road_has_its_class_and_its_seed_from_the_run_file_and_from_set(self):
        text = 'speed = 3.0\n[road]\nclass = "C"\nlength = 500.0\nseed = 7\n'
        changes = ("speed=5", "vehicle.name=road", "road.class=E", "road.seed = 3")
        table = 'road={shape = "random", rms = 0.02, length = 90}'
        for number, (content, overrides, expected) in enumerate((
            (text, (), "road: random, ISO 8608 class C, length 500 m, seed 7"),
            (text, changes, "road: random, ISO 8608 class E, length 500 m, seed 3"),
            (text, (table,), "road: random, r.m.s. 0.02 m, length 90 m, seed 1"),
            ("[road", ("speed=5",), "road: random"),
            ("road = 1", (), "road: random"),
        )):  # fmt: skip
            with h5py.File(write_results(self.folder / f"{number}.h5", overrides=overrides), "a") as file:
                file["model/run_text"][:] = content.encode()
                file.create_group("model/road").attrs["shape"] = np.bytes_("random")
                file["model/resolved/road"].attrs["shape"] = np.bytes_("table")
                for name in list(file["model/resolved/road/parameters"].attrs):
                    del file["model/resolved/road/parameters"].attrs[name]
            with open_results(self.folder / f"{number}.h5") as results, self.subTest(expected):
                self.assertEqual(describe_road(results), expected)

    def test_a_file_of_version_1_tells_its_sampling_alone(self):
        with h5py.File(write_results(self.folder / "run.h5"), "a") as file:
            file.attrs["version"] = 1
            del file["model/resolved"]
        with open_results(self.folder / "run.h5") as results:
            self.assertEqual(make_caption([results]), "a sample every 5 ms")

    def test_the_caption_holds_only_what_all_runs_share(self):
        with open_results(write_results(self.folder / "slow.h5")) as slow:
            with open_results(write_results(self.folder / "fast.h5", settings={"speed": 5.0})) as fast:
                caption = make_caption([slow, fast])
        self.assertNotIn("speed", caption)
        self.assertIn("road: half-sine", caption)


if __name__ == "__main__":
    unittest.main()
