"""runs/run_warnings.py: what makes a run's numbers doubtful, and which numbers each warning concerns."""

import unittest

import h5py
import numpy as np
from commands import list_readers
from fatigue_test import write_loads
from mode_runs import write_adaptive_run
from synthetic_results import write_results, write_series, write_texts
from tool_test_case import ToolTestCase

from sprung_tools.files.results_file import open_results
from sprung_tools.runs.labelled_runs import Run
from sprung_tools.runs.run_warnings import list_doubts, list_warnings
from sprung_tools.runs.stored_histories import list_gaps


def thin(file, name, every):
    """Keeps every so-many-th row of a dataset, as [output.step] has it stored."""
    rows, attributes = file[name][::every], dict(file[name].attrs)
    del file[name]
    file[name] = rows
    file[name].attrs.update({**attributes, "every": every})


class RunWarnings(ToolTestCase):
    def list(self, path):
        with open_results(path) as results:
            return list_warnings(results)

    def write_neglected(self, path, late=0.0, early=0.0, **options):
        """A run with shares of mode 5: `early` at the first sample, `late` from the middle on."""
        write_results(path, num_modes=2, **options)
        with h5py.File(path, "a") as file:
            size = file["time"].shape[0]
            shares = np.zeros((size, 3))
            shares[:, 2] = 5.0
            shares[0, 1] = early
            shares[size // 2 :, 1] = late
            write_series(file, "bodies/chassis/modal/neglected", shares, "1")

    def test_a_good_run_has_none(self):
        self.write_neglected(self.folder / "a.h5", late=0.05)
        self.assertEqual(self.list(self.folder / "a.h5"), [])

    def test_modes_that_are_missing_are_named_with_their_share(self):
        self.write_neglected(self.folder / "a.h5", late=0.062)
        found = self.list(self.folder / "a.h5")
        self.assertEqual([one.section for one in found], ["summary", "modes"])
        self.assertIn("chassis.mode 5, which was left out, would have reached 0 % of the largest deflection and 6.2 %",
                      found[0].text)  # fmt: skip
        self.assertEqual(found[1].of, ("chassis",))

    def test_shares_of_small_values_at_the_start_do_not_count(self):
        self.write_neglected(self.folder / "a.h5", early=1.0)
        with h5py.File(self.folder / "a.h5", "a") as file:
            file.require_group("summary/points/chassis.seat")
        self.assertEqual(self.list(self.folder / "a.h5"), [])

    def test_where_modes_join_as_needed_none_is_missing(self):
        self.write_neglected(self.folder / "a.h5", late=0.062, adaptivity={"enabled": 1})
        self.assertEqual(self.list(self.folder / "a.h5"), [])

    def test_an_energy_balance_that_does_not_close_is_the_first_warning(self):
        self.write_neglected(self.folder / "a.h5", late=0.062)
        for closure, count in ((0.9e-3, 2), (1.2e-3, 3)):
            with h5py.File(self.folder / "a.h5", "a") as file:
                file.require_group("summary").attrs["energy_closure"] = closure
            self.assertEqual(len(self.list(self.folder / "a.h5")), count)
        self.assertIn("the energy balance does not close (relative 1.2e-03)", self.list(self.folder / "a.h5")[0].text)

    def test_a_file_of_version_1_which_lacks_the_model_as_run_has_those_of_its_summary(self):
        write_results(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            del file["model/resolved"]
            file.require_group("summary").attrs["energy_closure"] = 1.2e-3
        self.assertEqual([one.of for one in self.list(self.folder / "a.h5")], [("computation",)])

    def test_every_command_on_runs_repeats_them_and_says_what_is_thinned(self):
        write_adaptive_run(self.folder / "a.h5")
        write_loads(self.folder / "loads.h5")
        for name, thinned in (("a.h5", "forces/front_tyre/force"), ("loads.h5", "points/body.seat/acceleration")):
            with h5py.File(self.folder / name, "a") as file:
                file.require_group("summary").attrs["energy_closure"] = 1.2e-3
                thin(file, thinned, 10)
        show = ("--show", "bodies/chassis/position.y")
        calls = {
            "report_peaks": ("a.h5", *show),
            "plot_results": ("a.h5", "-o", "a.svg", *show),
            "plot_modes": ("a.h5", "-o", "a.svg", "--over-time"),
            "ride": ("a.h5",),
            "fatigue": ("loads.h5", "--category", "71"),
            "report": ("a.h5", "-o", "a.html"),
            "export_csv": ("a.h5", "-o", "a.csv", *show),
            "export_paraview": ("a.h5", "-o", "a.pvd", "--every", "0.5"),
        }
        self.assertEqual(set(calls), list_readers("runs"))
        for tool, arguments in calls.items():
            with self.subTest(tool):
                process = self.run_tool(tool, *arguments)
                self.assertEqual(process.returncode, 0, process.stderr)
                page = self.folder / "a.html"
                said = page.read_text(encoding="utf-8") if tool == "report" else process.stdout
                self.assertIn("the energy balance does not close", said)
                self.assertRegex(said, r"(forces|points) stored every \d+ ms")

    def test_histories_of_every_kind_that_are_not_stored_are_told(self):
        write_results(self.folder / "a.h5", num_modes=0)
        with h5py.File(self.folder / "a.h5", "a") as file:
            points = file.require_group("model/resolved/points")
            points.require_group("chassis.seat").attrs["body"] = "chassis"
            points.require_group("ground.post").attrs["body"] = "ground"
            for group in ("bodies", "points"):
                del file[group]
        with open_results(self.folder / "a.h5") as results:
            gaps = list_gaps(results)
        self.assertIn("motion of bodies not stored: all", gaps)
        self.assertIn("motion of points not stored: all", gaps)
        self.assertIn("loads of forces on their bodies not stored: all", gaps)

    def test_the_modes_about_the_equilibrium_do_not_hold_for_a_wheel_in_the_air(self):
        self.write_neglected(self.folder / "a.h5")
        with h5py.File(self.folder / "a.h5", "a") as file:
            write_series(file, "model/modes/undamped_frequency", np.array([2.0]), "Hz")
            file["forces/front_tyre/contact"][:] = 1.0
        self.assertEqual(self.list(self.folder / "a.h5"), [])
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["forces/front_tyre/contact"][3] = 0.0
        (found,) = self.list(self.folder / "a.h5")
        self.assertEqual((found.section, found.of), ("equilibrium", ("front_tyre",)))
        self.assertIn("front_tyre left the ground", found.text)
        with open_results(self.folder / "a.h5") as results:  # tables and pictures have none of these modes
            self.assertNotIn("left the ground", "".join(list_doubts([Run("a", results)])))
        with h5py.File(self.folder / "a.h5", "a") as file:  # what happened is stored where forces are not
            del file["forces/front_tyre/contact"]
            write_series(file, "events/time", np.array([0.1, 0.2]), "s")
            for part, texts in {"kind": ["force"] * 2, "object": ["spring", "front_tyre"],
                                "text": ["bends", "leaves the ground"]}.items():  # fmt: skip
                write_texts(file, f"events/{part}", texts)
        self.assertEqual(self.list(self.folder / "a.h5"), [found])


if __name__ == "__main__":
    unittest.main()
