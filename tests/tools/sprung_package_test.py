"""`import sprung`: the functions give what the programs write, errors are exceptions with the program's text, and the
example in tools/README.md runs. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS)."""

import contextlib
import importlib.util
import io
import json
import os
import re
import sys
import unittest
from unittest import mock

import h5py
import numpy as np
from tool_test_case import ROOT, TOOLS, ToolTestCase, run_program

import sprung
from sprung_tools.files.errors import InputError
from sprung_tools.files.project import ROOT as PROJECT
from sprung_tools.programs.finding import find_programs

CAR = ROOT / "dynamics/models/examples/quarter_car_run.toml"
DYNAMICS = os.environ["SPRUNG_DYNAMICS"]
VERIFICATION = ROOT / "tests/verification/models"


class Functions(ToolTestCase):
    def test_a_run_gives_the_arrays_of_the_file_that_the_program_writes(self):
        output = self.folder / "single.h5"
        run = [DYNAMICS, "run", CAR, "-o", output, "--quiet", "--set", "road.height=0.03", "--set", "duration=1.5"]
        run_program(run, check=True)
        with sprung.run(CAR, overrides={"road.height": 0.03, "duration": 1.5}) as results, h5py.File(output) as file:
            self.assertEqual(results.title, "quarter car")
            np.testing.assert_array_equal(results.time, file["time"])
            for column, axis in enumerate("xy"):
                found = results[f"points/sprung.origin/acceleration.{axis}"]
                np.testing.assert_array_equal(found, file["points/sprung.origin/acceleration"][:, column])
            np.testing.assert_array_equal(
                results["joints/body_slide/reaction.3"], file["joints/body_slide/reaction"][:, 2]
            )
            self.assertEqual(results.unit("forces/suspension/force"), "N")
            measures = results.measures()
            expected = file["summary/points/sprung.origin"].attrs["acceleration_max"]
            self.assertEqual(measures["summary/points/sprung.origin/acceleration_max"], (expected, "m/s^2"))
            for name in ("suspensions/suspension/compression", "summary/steps",
                         "summary/points/sprung.origin/acceleration_max", "tyres/tyre/static_load"):  # fmt: skip
                self.assertEqual(results.measure(name), measures[name].value)
            self.assertEqual((results.converged, results.warnings), (True, []))
            self.assertEqual(repr(results), "<Results of 'quarter car': 1501 samples from 0 s to 1.5 s; 0 warnings>")
        self.assertIn("closed", repr(results))

    def test_measures_of_another_span_are_without_those_of_the_summary_and_have_remarks(self):
        """The summary's own span stood beside the one asked for, and a span too short for the MTVV was not told."""
        with sprung.run(CAR, overrides={"duration": 1.5}) as results:
            self.assertEqual(results.remarks(), [])
            found = results.measures(start=0.5, end=0.8)
            self.assertEqual([name for name in found if name.startswith("summary/points")], [])
            self.assertIn("summary/steps", found)
            (remark,) = results.remarks(start=0.5, end=0.8)
        self.assertIn("the MTVV is too low", remark)

    @unittest.skipUnless(importlib.util.find_spec("xarray"), "python3-xarray is not installed")
    def test_a_quantity_is_an_array_of_xarray_that_is_selected_by_time(self):
        with sprung.run(CAR, overrides={"duration": 0.5}) as results:
            found = results.array("forces/suspension/force")
            values = results["forces/suspension/force"]
        np.testing.assert_array_equal(found.values, values)
        self.assertEqual((found.dims, found.name, found.attrs), (("time",), "forces/suspension/force", {"units": "N"}))
        self.assertEqual(found.time.attrs, {"units": "s"})
        self.assertEqual(float(found.sel(time=0.2, method="nearest")), values[200])
        self.assertEqual(float(found.sel(time=slice(0.1, 0.3)).max()), np.max(values[100:301]))

    def test_what_xarray_is_given_and_that_it_may_be_missing(self):
        """By a stand-in that keeps what xarray.DataArray was given."""
        with sprung.run(CAR, overrides={"duration": 0.1}) as results:
            with mock.patch.dict(sys.modules, {"xarray": mock.Mock()}) as modules:
                found = results.array("forces/suspension/force")
                self.assertIs(found, modules["xarray"].DataArray.return_value)
                (values, coordinates, dimensions), settings = modules["xarray"].DataArray.call_args
            np.testing.assert_array_equal(values, results["forces/suspension/force"])
            ((name, time, units),) = coordinates.values()
            np.testing.assert_array_equal(time, results.time)
            self.assertEqual((list(coordinates), name, dimensions, units), (["time"], "time", ["time"], {"units": "s"}))
            self.assertEqual(settings, {"name": "forces/suspension/force", "attrs": {"units": "N"}})
            with mock.patch.dict(sys.modules, {"xarray": None}), self.assertRaisesRegex(InputError, "python3-xarray"):
                results.array("forces/suspension/force")

    def test_every_quantity_that_is_listed_can_be_read_and_all_histories_are_listed(self):
        with sprung.run(CAR, overrides={"duration": 0.1}) as results:
            names = results.names()
            for name in names:
                self.assertIn(name, results)
                self.assertEqual(results[name].shape, results.time.shape, name)
            component = r"\.(x|y|angle|torque|\d+)$"
            datasets = {name.rpartition(".")[0] if re.search(component, name) else name for name in names}
            histories = []
            with h5py.File(results.path) as file:
                file.visititems(lambda name, one: histories.append(name) if isinstance(one, h5py.Dataset) else None)
                expected = {one for one in histories if file[one].shape[:1] == results.time.shape} - {"time"}
            self.assertEqual(datasets, {one for one in expected if not one.startswith("model/")})

    def test_arrays_are_the_callers_own(self):
        """`t = results.time; t -= 1` moved the span of the statistics."""
        with sprung.run(CAR, overrides={"duration": 0.5}) as results:
            before = results.measures()
            for name in ("time", *results.names()):
                for array in (results[name], results.time):
                    array += 1.0
            self.assertEqual(results.measures(), before)
            self.assertEqual(results.time[0], 0.0)
        with sprung.response(CAR, overrides={"response": {"road": {"class": "C"}}}) as response:
            before = response.measures()
            for array in (response.frequency, response.magnitude("forces/tyre/force")):
                array *= 2.0
            self.assertEqual(response.measures(), before)

    def test_only_what_can_be_read_is_in_the_results_and_a_loop_gives_its_names(self):
        with sprung.run(CAR, overrides={"duration": 0.1}) as results:
            names = list(results)
            self.assertEqual(names, results.names())
            self.assertIn("joints/body_slide/reaction.torque", names)
            point = "points/sprung.origin"
            for name in ("time", f"{point}/acceleration.y", f"{point}/displacement.y", f"{point}/acceleration.2"):
                self.assertIn(name, results)
                self.assertEqual(results[name].shape, results.time.shape)
            for name in (point, f"{point}/acceleration", f"{point}/acceleration.q", "forces/tyre/force.x",
                         "model/resolved/gravity.x"):  # fmt: skip
                self.assertNotIn(name, results)
                with self.assertRaises(InputError):
                    results[name]
            self.assertNotIn(5, results)
            for read in (lambda: results[0], lambda: results.unit(0)):
                with self.assertRaisesRegex(TypeError, "a quantity is its name, such as 'points/.*', got int 0"):
                    read()

    def test_one_point_and_one_design_need_no_list(self):
        with sprung.run(CAR, overrides={"duration": 0.5}) as results:
            self.assertEqual(results.measures("sprung.origin"), results.measures(["sprung.origin"]))
            self.assertEqual(results.remarks("sprung.origin"), results.remarks(["sprung.origin"]))
        with sprung.response(CAR, overrides={"response": {"road": {"class": "C"}}}) as response:
            self.assertEqual(response.measures("sprung.origin"), response.measures(["sprung.origin"]))
        design = VERIFICATION / "beam_inside.toml"
        self.assertEqual(sprung.build(str(design), self.folder), [self.folder / "beam_inside.h5"])

    def test_a_file_without_a_name_goes_away_and_one_with_a_name_stays(self):
        with sprung.run(CAR, overrides={"duration": 0.1}) as results:
            self.assertTrue(results.path.exists())
        self.assertFalse(results.path.parent.exists())
        with sprung.run(CAR, overrides={"duration": 0.1}, output=self.folder / "kept.h5") as results:
            pass
        self.assertEqual(results.path, self.folder / "kept.h5")
        self.assertTrue(results.path.exists())

    def test_modes_and_equilibrium_are_those_of_the_program(self):
        def read(verb):
            return json.loads(run_program([DYNAMICS, verb, CAR, "--json", "--quiet"], check=True).stdout)

        self.assertEqual([one._asdict() for one in sprung.modes(CAR)], read("modes")["modes"])
        self.assertEqual(sprung.equilibrium(CAR), read("equilibrium"))

    def test_a_response_has_magnitudes_spectra_and_their_rms(self):
        road = {"class": "C"}
        with sprung.response(CAR, overrides={"response": {"from": 0.5, "to": 30.0, "road": road}}) as response:
            name = "forces/tyre/force"
            self.assertIn(name, response.names())
            self.assertEqual((response.frequency[0], response.frequency[-1]), (0.5, 30.0))
            self.assertIn("from 0.5 Hz to 30 Hz", repr(response))
            self.assertEqual(response.magnitude(name).shape, response.frequency.shape)
            with self.assertRaisesRegex(sprung.InputError, f"no output 'none'; there are: .*{name}"):
                response.rms("none")
            self.assertEqual(response.measures()[f"outputs/{name}/rms"], (response.rms(name), "N"))
            # The r.m.s. is the root of the integral of the spectrum.
            rms = np.sqrt(np.trapz(response.spectrum(name), response.frequency))
            self.assertAlmostEqual(response.rms(name) / rms, 1.0, delta=1e-3)

    def test_build_reduces_designs_which_a_run_then_reads(self):
        (file,) = sprung.build([VERIFICATION / "beam_inside.toml"], self.folder)
        self.assertEqual(file, self.folder / "beam_inside.h5")
        first = file.stat().st_mtime_ns
        sprung.build([VERIFICATION / "beam_inside.toml"], self.folder)
        self.assertEqual(file.stat().st_mtime_ns, first)  # it was up to date
        sprung.build([VERIFICATION / "beam_inside.toml"], self.folder, force=True)
        self.assertGreater(file.stat().st_mtime_ns, first)
        self.assertEqual(len(sprung.modes(VERIFICATION / "pinned_beam_run.toml", superelements=self.folder)), 21)


class Errors(ToolTestCase):
    def test_bad_input_is_an_error_with_the_programs_text(self):
        with self.assertRaisesRegex(sprung.InputError, "--set 1: error: unknown key 'sped'"):
            sprung.run(CAR, overrides={"sped": 1.0})
        with self.assertRaisesRegex(sprung.InputError, "none.toml"):
            sprung.modes(self.folder / "none.toml")
        with self.assertRaisesRegex(sprung.InputError, "none.toml"):
            sprung.build([self.folder / "none.toml"], self.folder)
        with sprung.run(CAR, overrides={"duration": 0.1}) as results:
            with self.assertRaisesRegex(sprung.InputError, "no quantity 'points/none/velocity.x'"):
                results["points/none/velocity.x"]

    def test_a_nul_character_in_a_path_or_a_key_is_told(self):
        """What is behind it was cut off: results got another name."""
        calls = (
            lambda: sprung.run("a\0b"), lambda: sprung.run(CAR, overrides={"a\0b": 1}),
            lambda: sprung.run(CAR, output=self.folder / "a\0b"), lambda: sprung.build(["a\0b"], self.folder),
        )  # fmt: skip
        for start in calls:
            with self.assertRaisesRegex(sprung.InputError, r"a\\x00b.*: error: holds a NUL character"):
                start()
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_names_that_begin_with_a_dash_are_names(self):
        for name in ("--help", "-r.toml"):
            for call in (sprung.run, sprung.modes, lambda one: sprung.build([one], "bodies")):
                with self.assertRaisesRegex(sprung.InputError, rf"^\./{name}: error: cannot be read: No such file"):
                    call(name)

    def test_closed_results_say_that_they_are_closed(self):
        with sprung.run(CAR, overrides={"duration": 0.1}) as results:
            pass
        with sprung.response(CAR) as response:
            name = response.names()[0]
        reads = (
            lambda: results["forces/suspension/force"], lambda: results.unit("forces/suspension/force"),
            lambda: "time" in results, lambda: results.warnings, lambda: results.converged, results.names,
            results.measures, lambda: results.measure("summary/steps"), response.names, response.measures,
            lambda: response.magnitude(name),
        )  # fmt: skip
        for read in reads:
            with self.assertRaisesRegex(sprung.InputError, r"\.h5: error: the file is closed; read "):
                read()

    def test_a_measure_that_a_run_does_not_have_is_an_error_that_names_the_objects(self):
        with sprung.run(CAR, overrides={"duration": 0.5}) as results:
            for name in ("tyres/none/static_load", "none"):
                with self.assertRaisesRegex(sprung.InputError, f"no measure '{name}'; .*: summary, .*, tyres/tyre"):
                    results.measure(name)
            with self.assertRaisesRegex(sprung.InputError, "no measure 'tyres/tyre/none'; there are: tyres/tyre/st"):
                results.measure("tyres/tyre/none")
            with self.assertRaisesRegex(sprung.InputError, "suspension/way_to_stop: the run has no such value"):
                results.measure("suspensions/suspension/way_to_stop")

    def test_a_band_that_the_samples_do_not_hold_is_an_error(self):
        with sprung.run(CAR, overrides={"duration": 0.5, "output_step": 0.01}) as results:
            self.assertGreater(results.measure("bands/sprung.origin/5"), 0.0)
            with self.assertRaisesRegex(sprung.InputError, "bands/sprung.origin/80: the run has no such value"):
                results.measure("bands/sprung.origin/80")

    def test_a_computation_that_does_not_come_to_its_end_is_a_numerical_error(self):
        with self.assertRaisesRegex(sprung.NumericalError, "no static equilibrium"):  # nothing bears the car
            sprung.equilibrium(CAR, overrides={"vehicle.forces.suspension.spring": {"polynomial": [0.0, 0.0]}})

    def test_a_program_that_is_not_there_is_named(self):
        with mock.patch.dict(os.environ, SPRUNG_DYNAMICS=str(self.folder / "none")):
            with self.assertRaisesRegex(sprung.InputError, "none: error: no program sprung-dynamics here"):
                sprung.run(CAR)


class Programs(ToolTestCase):
    def make(self, *names):
        for name in names:
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch(mode=0o755)

    def find(self, *arguments, **environment):
        clean = {name: value for name, value in os.environ.items() if not name.startswith("SPRUNG_")}
        with mock.patch.dict(os.environ, {**clean, **environment}, clear=True):
            return [path.relative_to(self.folder).as_posix() for path in find_programs(*arguments)]

    def test_they_are_found_in_a_build_folder_and_in_an_installation(self):
        self.make("build/reduce/sprung-reduce", "build/dynamics/sprung-dynamics", "usr/bin/sprung-reduce",
                  "usr/bin/sprung-dynamics")  # fmt: skip
        self.assertEqual(self.find(self.folder / "build"),
                         ["build/reduce/sprung-reduce", "build/dynamics/sprung-dynamics"])  # fmt: skip
        self.assertEqual(self.find(self.folder / "usr"), ["usr/bin/sprung-reduce", "usr/bin/sprung-dynamics"])

    def test_the_environment_comes_before_the_installation_and_that_before_the_path(self):
        self.make("path/sprung-reduce", "path/sprung-dynamics", "usr/bin/sprung-dynamics", "mine")
        module = "sprung_tools.programs.finding.ROOT"
        self.assertNotEqual(self.folder, PROJECT)
        with mock.patch(module, self.folder / "usr/share/sprung"):
            path = {"PATH": str(self.folder / "path")}
            self.assertEqual(self.find(**path), ["path/sprung-reduce", "usr/bin/sprung-dynamics"])
            self.assertEqual(
                self.find(**path, SPRUNG_DYNAMICS=str(self.folder / "mine")), ["path/sprung-reduce", "mine"]
            )


class Examples(ToolTestCase):
    def test_dampers_are_optimised_without_more_stroke(self):
        designs = [ROOT / f"meshes/truck/{name}.toml" for name in ("chassis", "long_arm")]
        sprung.build(designs, self.folder)
        script = ROOT / "dynamics/models/truck/optimise_dampers.py"
        options = [
            "--superelements",
            self.folder,
            "-o",
            self.folder / "a.png",
            "--evaluations",
            "6",
            "--duration",
            "1.5",
        ]
        process = run_program([sys.executable, script, *options], check=True, env={**os.environ, "PYTHONPATH": TOOLS})
        number = r"(\d+\.\d+)"
        lines = process.stdout.splitlines()
        (start, best) = (
            [float(one) for one in re.search(rf"acceleration {number} m/s², stroke {number} mm", line).groups()]
            for line in lines[:2]
        )
        self.assertEqual(lines[0].partition(", weighted")[0], "as it is: compression 5480 N s/m, rebound 17575 N s/m")
        self.assertLessEqual(best[0], start[0])
        self.assertLessEqual(best[1], 1.002 * start[1])  # a thousandth, and rounding
        self.assertEqual((self.folder / "a.png").read_bytes()[:4], b"\x89PNG")


class Documentation(ToolTestCase):
    def test_the_example_in_the_readme_runs(self):
        text = (TOOLS / "README.md").read_text(encoding="utf-8")
        code = re.search(r"^## From Python\n\n```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[1]
        for name in ("meshes", "dynamics"):
            (self.folder / name).symlink_to(ROOT / name)
        said = io.StringIO()
        with contextlib.chdir(self.folder), contextlib.redirect_stdout(said):
            exec(compile(code, "README.md", "exec"), {})
        self.assertRegex(said.getvalue(), r"(?s)\A0\.00 Hz, chassis .*\n\S+ m/s\^2 True \[.*\]\n\d+\.\d+\n\Z")


if __name__ == "__main__":
    unittest.main()
