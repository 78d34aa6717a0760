"""tools/export_paraview, read back with meshio: modes against the superelement, a run against the results that
sprung-dynamics wrote for named points. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS)."""

import os
import shutil
import unittest
from types import SimpleNamespace
from urllib.parse import unquote
from xml.etree import ElementTree

import h5py
import meshio
import numpy as np
from synthetic_results import write_results
from tool_test_case import ROOT, ToolTestCase, make_class_folder, run_program

from sprung_tools.files.hdf5_file import read_numbers
from sprung_tools.files.results_file import open_results
from sprung_tools.paraview.run import choose_samples

STORED = ROOT / "tests/reduce/data/version_7.h5"
RUN = ROOT / "dynamics/models/truck/bump.toml"
CELLS = ("axial_force", "shear_force", "bending_moment")
RECOVERED = ("axial", "shear", "moment")


def read_collection(path):
    """The PVD file: [(timestep, mesh)]."""
    entries = ElementTree.parse(path).getroot().iter("DataSet")
    return [(float(one.get("timestep")), meshio.read(path.parent / unquote(one.get("file")))) for one in entries]


class OfTheTruck(ToolTestCase):
    """The truck's chassis and half a second of its bump run, made once."""

    @classmethod
    def setUpClass(cls):
        cls.made = make_class_folder(cls)
        designs = sorted((ROOT / "meshes/truck").glob("*.toml"))
        settings = ("--set", "modes.chassis=2", "--set", "duration=0.5")
        for command in (
            (os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", "."),
            (os.environ["SPRUNG_DYNAMICS"], "run", RUN, "--superelements", ".", "-o", "run.h5", "--quiet", *settings),
        ):
            run_program(command, cwd=cls.made, check=True)

    def setUp(self):
        super().setUp()
        for name in ("chassis.h5", "run.h5"):
            (self.folder / name).symlink_to(self.made / name)

    def export(self, *arguments):
        process = self.run_tool("export_paraview", *arguments)
        self.assert_succeeds(process)
        return process.stdout

    def test_each_mode_is_a_file_with_its_shape_scaled_to_a_tenth_of_the_frame(self):
        self.export("chassis.h5", "-o", "modes.pvd", "--modes", "1", "2", "5")
        entries = read_collection(self.folder / "modes.pvd")
        self.assertEqual([number for number, _ in entries], [1, 2, 5])
        with h5py.File(self.folder / "chassis.h5") as file:
            places, elements, shapes = (file[name][:] for name in ("nodes/position", "elements/node", "modes/shape"))
            resultants = file["resultants"][:]
        for number, (_, mesh) in zip((1, 2, 5), entries):
            shape = shapes[:, :, number - 1]
            scale = 0.1 * np.linalg.norm(np.ptp(places, axis=0)) / np.abs(shape[:, :2]).max()
            bent, turned = mesh.point_data["displacement"], mesh.point_data["rotation"]
            np.testing.assert_allclose(bent[:, :2], scale * shape[:, :2], rtol=1e-13)
            np.testing.assert_allclose(turned[:, 2], scale * shape[:, 2], rtol=1e-13)
            np.testing.assert_allclose(mesh.points[:, :2], places + bent[:, :2], rtol=1e-13)
            self.assertFalse(np.any(bent[:, 2]) or np.any(turned[:, :2]) or np.any(mesh.points[:, 2]))
            np.testing.assert_array_equal(mesh.cells_dict["line"], elements)
            ends = scale * resultants[:, :, number - 1].reshape(len(elements), 2, 3)
            for column, name in enumerate(CELLS):
                np.testing.assert_allclose(mesh.cell_data[name][0], ends[:, :, column], rtol=1e-13)

    def test_modes_are_magnified_with_their_resultants_and_a_mode_named_twice_is_written_once(self):
        self.export("chassis.h5", "-o", "plain.pvd", "--modes", "2")
        told = self.export("chassis.h5", "-o", "large.pvd", "--modes", "2", "2", "--magnify", "3")
        self.assertIn("sections: 1 frame\n", told)
        ((_, plain),), ((_, large),) = (read_collection(self.folder / f"{name}.pvd") for name in ("plain", "large"))
        for name in ("displacement", "rotation"):
            np.testing.assert_allclose(large.point_data[name], 3.0 * plain.point_data[name], rtol=1e-13)
        moment = plain.cell_data["bending_moment"][0]
        self.assertGreater(np.abs(moment).max(), 0.0)
        np.testing.assert_allclose(large.cell_data["bending_moment"][0], 3.0 * moment, rtol=1e-13)

    def test_all_modes_are_written_unless_some_are_asked_for(self):
        self.export("chassis.h5", "-o", "modes.pvd")
        with h5py.File(self.folder / "chassis.h5") as file:
            count = file["modes/frequency"].size
        self.assertEqual(
            [number for number, _ in read_collection(self.folder / "modes.pvd")], list(range(1, count + 1))
        )

    def test_a_run_has_every_named_point_where_the_results_have_it_moving_as_they_say(self):
        self.export("run.h5", "-o", "run.pvd", "--every", "0.05", "--from", "0.1")
        entries = read_collection(self.folder / "run.pvd")
        with open_results(str(self.folder / "run.h5")) as results:
            samples = np.searchsorted(results.time, 0.1 + 0.05 * np.arange(9) - 1e-9)
            np.testing.assert_allclose([time for time, _ in entries], results.time[samples], atol=1e-9)
            points = [name for name in results.names("points") if not name.endswith(".center_of_mass")]
            self.assertGreater(len(points), 20)
            for name in points:
                for sample, (_, mesh) in zip(samples, entries):
                    place, speed, change = (
                        read_numbers(results.file, f"points/{name}/{what}")[0][sample]
                        for what in ("position", "velocity", "acceleration")
                    )
                    # Several bodies may have a node there, in a joint; of these the point's own is one.
                    away = np.linalg.norm(mesh.points[:, :2] - place, axis=1)
                    near = np.flatnonzero(away < 1e-9)
                    self.assertGreater(near.size, 0, (name, sample, away.min()))
                    for field, expected, floor in (("velocity", speed, 1e-8), ("acceleration", change, 1e-6)):
                        found = mesh.point_data[field][near, :2]
                        error = np.linalg.norm(found - expected, axis=1).min()
                        self.assertLess(error, floor * max(1.0, np.linalg.norm(expected)), (name, field, sample))

    def test_instants_are_those_asked_for_however_many_samples_lie_between_them(self):
        for every in (1e-3, 0.1, 0.5):
            with self.subTest(every=every), open_results(str(self.folder / "run.h5")) as results:
                time = results.time[choose_samples(results, (None, None), every)]
                np.testing.assert_allclose(time, every * np.arange(round(results.time[-1] / every) + 1), atol=1e-9)
            fine = SimpleNamespace(path="fine", time=1e-3 * np.arange(5001))
            np.testing.assert_allclose(fine.time[choose_samples(fine, (None, None), 2.0)], [0.0, 2.0, 4.0])

    def test_beam_resultants_and_deflections_are_those_of_the_results(self):
        self.export("run.h5", "-o", "run.pvd", "--every", "0.1")
        with open_results(str(self.folder / "run.h5")) as results:
            bodies = results.names("model/bodies")
            number = bodies.index("chassis") + 1
            recovered = {name: read_numbers(results.file, f"recovery/chassis/{name}")[0] for name in RECOVERED}
            tip = read_numbers(results.file, "points/chassis.front_end/deflection")[0]
        for time, mesh in read_collection(self.folder / "run.pvd"):
            sample = round(1e3 * time)
            own = np.flatnonzero(mesh.cell_data["body"][0] == number)
            for cell, name in zip(CELLS, RECOVERED):
                found = mesh.cell_data[cell][0][own]
                ends = recovered[name][sample].reshape(-1, 2)
                np.testing.assert_allclose(found[: len(ends)], ends, rtol=1e-13)
                self.assertTrue(np.all(np.isnan(found[len(ends) :])))  # the seat's offset is no beam
                self.assertTrue(np.all(np.isnan(np.delete(mesh.cell_data[cell][0], own, axis=0))))
            nodes = np.unique(mesh.cells_dict["line"][own])
            sizes = np.linalg.norm(mesh.point_data["deflection"][nodes], axis=1)
            self.assertLess(np.abs(sizes - np.linalg.norm(tip[sample])).min(), 1e-12)

    def test_magnification_moves_nodes_by_more_of_their_deflection_and_changes_no_data(self):
        for name, factor in (("plain", 1), ("rest", 0), ("large", 50)):
            self.export("run.h5", "-o", f"{name}.pvd", "--from", "0.42", "--to", "0.42", "--magnify", factor)
        plain, rest, large = (read_collection(self.folder / f"{name}.pvd")[0][1] for name in ("plain", "rest", "large"))
        deflection = plain.point_data["deflection"]
        self.assertGreater(np.abs(deflection).max(), 1e-3)
        np.testing.assert_allclose(plain.points - rest.points, deflection, atol=1e-12)
        np.testing.assert_allclose(large.points - rest.points, 50.0 * deflection, atol=1e-11)
        for name in ("velocity", "acceleration", "deflection"):
            np.testing.assert_array_equal(large.point_data[name], plain.point_data[name])

    def test_it_may_be_written_again_and_removes_no_other_file(self):
        for _ in range(2):
            self.export("chassis.h5", "-o", "modes.pvd", "--modes", "1")
        self.assertEqual(os.listdir(self.folder / "modes"), ["mode_001.vtu"])
        (self.folder / "modes/notes.txt").touch()
        refused = self.run_tool("export_paraview", "chassis.h5", "-o", "modes.pvd")
        self.assert_refuses(refused, "modes.pvd: error: 'modes' is there and is not of this tool (it holds notes.txt)")
        self.assertEqual(sorted(os.listdir(self.folder / "modes")), ["mode_001.vtu", "notes.txt"])
        (self.folder / "file").touch()
        self.assert_refuses(self.run_tool("export_paraview", "chassis.h5", "-o", "file.pvd"), "'file' is there")
        (self.folder / "real").mkdir()
        (self.folder / "link").symlink_to("real")
        refused = self.run_tool("export_paraview", "chassis.h5", "-o", "link.pvd")
        self.assert_refuses(refused, "link.pvd: error: 'link' is a link, which the tool does not replace")
        self.assertEqual(os.listdir(self.folder / "real"), [])

    def test_errors_are_reported_and_leave_no_file(self):
        before = sorted(os.listdir(self.folder))
        for fragment, *arguments in (
            (
                "chassis.h5: error: no mode 99; the file has modes 1 to 36",
                "chassis.h5",
                "-o",
                "a.pvd",
                "--modes",
                "1",
                "99",
            ),
            ("no mode 0", "chassis.h5", "-o", "a.pvd", "--modes", "0"),
            ("must end in .pvd", "chassis.h5", "-o", "a.vtu"),
            ("must end in .pvd", "chassis.h5", "-o", ".pvd"),
            ("--every: error: -1, expected a time > 0 s", "run.h5", "-o", "a.pvd", "--every", "-1"),
            ("--magnify: error: nan", "run.h5", "-o", "a.pvd", "--magnify", "nan"),
            ("--modes: error: run.h5 is a run", "run.h5", "-o", "a.pvd", "--modes", "1"),
            ("--every: error: chassis.h5 is a superelement", "chassis.h5", "-o", "a.pvd", "--every", "1"),
            ("no samples from 9 to 0.5 s; the run has those from 0 to 0.5 s", "run.h5", "-o", "a.pvd", "--from", "9"),
            ("none/a.pvd: error: there is no folder 'none'", "chassis.h5", "-o", "none/a.pvd"),
            ("none.h5: error: no such file", "none.h5", "-o", "a.pvd"),
        ):
            with self.subTest(fragment):
                self.assert_refuses(self.run_tool("export_paraview", *arguments), fragment)
                self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_names_with_blanks_and_quotes(self):
        name = "mine & 'yours' <ä>"
        self.export("chassis.h5", "-o", f"{name}.pvd", "--modes", "1")
        self.assertEqual(len(read_collection(self.folder / f"{name}.pvd")), 1)


class OfIncompleteFiles(ToolTestCase):
    def test_a_run_without_flexible_bodies_is_drawn(self):
        write_results(self.folder / "rigid.h5", num_modes=0)
        self.assertEqual(self.run_tool("export_paraview", "rigid.h5", "-o", "a.pvd", "--every", "0.5").returncode, 0)
        (_, mesh), *_ = read_collection(self.folder / "a.pvd")
        self.assertFalse(np.any(mesh.point_data["deflection"]))

    def test_what_a_file_lacks_is_named(self):
        for lacking in ("bodies/chassis/velocity", "model/bodies", "model/resolved/points",
                        "model/superelements/chassis/shapes"):  # fmt: skip
            with self.subTest(lacking):
                write_results(self.folder / "run.h5")
                with h5py.File(self.folder / "run.h5", "a") as file:
                    del file[lacking]
                self.assert_refuses(
                    self.run_tool("export_paraview", "run.h5", "-o", "a.pvd"), "run.h5: error: ", lacking
                )
                self.assertEqual(os.listdir(self.folder), ["run.h5"])

    def test_a_superelement_whose_modes_cannot_be_drawn_is_refused(self):
        def turn_only(file):
            file["modes/shape"][:, :2, 1] = 0.0

        def forget_a_shape(file):
            file["modes/shape"][:, :, 1] = 0.0

        def shorten(sections):
            def change(file):
                del file["elements/section"]
                file["elements/section"] = sections

            return change

        for change, fragment in (
            (turn_only, "a.h5: error: mode 2 displaces no node: there is nothing to draw"),
            (forget_a_shape, "a.h5: error: mode 2 displaces no node: there is nothing to draw"),
            (shorten(np.bytes_("frame")), "a.h5: error: dataset 'elements/section' has shape (), expected "),
            (shorten(np.array([b"frame"])), "a.h5: error: dataset 'elements/section' has shape (1,), expected "),
        ):
            with self.subTest(fragment):
                shutil.copy(STORED, self.folder / "a.h5")
                with h5py.File(self.folder / "a.h5", "a") as file:
                    change(file)
                self.assert_refuses(self.run_tool("export_paraview", "a.h5", "-o", "a.pvd"), fragment)
                self.assertEqual(os.listdir(self.folder), ["a.h5"])


if __name__ == "__main__":
    unittest.main()
