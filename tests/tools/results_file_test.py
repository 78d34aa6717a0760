"""files/results_file.py: the values that it reads, and each of its errors."""

import unittest

import h5py
import numpy as np
from synthetic_results import CIRCULAR, HEAVE, STATIC_HEIGHT, write_results
from tool_test_case import ROOT, ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results, parse_quantity
from sprung_tools.files.hdf5_file import NEWEST_VERSIONS, SUPERELEMENT, open_hdf5, read_real, read_text, read_texts


class Reading(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.path = write_results(self.folder / "run.h5")
        self.results = open_results(self.path)
        self.addCleanup(self.results.file.close)
        self.heave = HEAVE * np.sin(CIRCULAR * self.results.time)

    def test_a_component_is_a_column_with_its_own_unit(self):
        height, unit = self.results.series("bodies/chassis/position.y")
        np.testing.assert_allclose(height, STATIC_HEIGHT + self.heave, rtol=1e-15)
        self.assertEqual(unit, "m")
        self.assertEqual(self.results.series("bodies/chassis/acceleration.angle")[1], "rad/s^2")

    def test_displacement_of_a_body_is_measured_from_the_equilibrium(self):
        displacement, _ = self.results.series("bodies/chassis/displacement.y")
        np.testing.assert_allclose(displacement, self.heave, atol=1e-15)

    def test_displacement_of_a_body_that_starts_out_of_balance_shows_the_offset(self):
        with open_results(write_results(self.folder / "above.h5", start_offset=0.02)) as results:
            np.testing.assert_allclose(
                results.series("bodies/chassis/displacement.y")[0], 0.02 + self.heave, atol=1e-15
            )

    def test_displacement_of_points_and_centres_of_mass_is_measured_from_their_own_equilibrium(self):
        with open_results(write_results(self.folder / "above.h5", start_offset=0.02)) as results:
            for quantity in (
                "points/chassis.seat/displacement.y",
                "bodies/chassis/center_of_mass/displacement.y",
            ):
                np.testing.assert_allclose(results.series(quantity)[0], 0.02 + self.heave, atol=1e-15)

    def test_a_motion_that_is_not_stored_is_told_with_the_key_that_chooses_it(self):
        path = write_results(self.folder / "less.h5")
        with h5py.File(path, "a") as file:
            file.require_group("model/resolved/bodies/chassis")
            del file["bodies/chassis/acceleration"]  # the modes and the centre of mass stay
        with open_results(path) as results:
            said = "'bodies/chassis/acceleration' is not stored; 'bodies' in .output.store. of the run file chooses"
            with self.assertRaisesRegex(InputError, said):
                results.series("bodies/chassis/acceleration.y")
            with self.assertRaisesRegex(InputError, "no quantity 'bodies/chassis/speed.y'"):
                results.series("bodies/chassis/speed.y")

    def test_it_is_told_of_one_element_and_beside_what_is_always_stored(self):
        path = write_results(self.folder / "less.h5")
        with h5py.File(path, "a") as file:
            for name in ("resolved/bodies/chassis", "resolved/forces/rear_tyre"):
                file.require_group(f"model/{name}")
            for name in ("area", "section_modulus", "station"):  # which are no histories
                file[f"recovery/chassis/{name}"] = np.ones(2)
            file["forces/rear_tyre/on_wheel"] = np.zeros((len(file["time"]), 3))
        with open_results(path) as results:
            for quantity, key in (("recovery/chassis/moment.1", "recovery"), ("forces/rear_tyre/force", "forces"),
                                  ("forces/front_tyre/on_wheel.y", "wrenches")):  # fmt: skip
                with self.assertRaisesRegex(InputError, f"is not stored; '{key}' in .output.store. of the run file"):
                    results.series(quantity)
            with self.assertRaisesRegex(InputError, "no quantity 'forces/rear_tyre/on_b.y'.*holds on_wheel"):
                results.series("forces/rear_tyre/on_b.y")

    def test_modes_are_columns_by_number(self):
        self.assertEqual(self.results.num_modes("chassis"), 2)
        np.testing.assert_allclose(
            self.results.series("bodies/chassis/modal/amplitude.2")[0], 2.0 * self.heave
        )

    def test_a_quantity_with_one_value_per_sample_has_no_component(self):
        self.assertEqual(self.results.series("forces/front_tyre/road_height")[0].max(), 0.1)

    def test_names_are_taken_apart_at_the_last_dot_after_the_last_slash(self):
        self.assertEqual(
            parse_quantity("points/chassis.seat/velocity.x"), ("points/chassis.seat/velocity", "x", False)
        )

    def test_missing_quantities_and_components_are_errors_that_name_what_there_is(self):
        for quantity, expected in {
            "bodies/chasis/position.y": "'/bodies' holds chassis",
            "bodies/chassis/speed.y": "'/bodies/chassis' holds acceleration, center_of_mass, modal, position",
            "points/chassis.seat": "'/points/chassis.seat' holds acceleration, position",
            "bodies/chassis/position.z": "component 'z', expected x, y, angle",
            "bodies/chassis/position": "component '', expected x, y, angle",
            "points/chassis.seat/position.angle": "component 'angle', expected x, y",
            "forces/front_tyre/road_height.x": "component 'x', expected none",
            "bodies/chassis/modal/amplitude.3": "component '3', expected 1 to 2",
            "bodies/chassis/modal/amplitude.x": "component 'x', expected 1 to 2",
        }.items():
            with self.subTest(quantity), self.assertRaises(InputError) as caught:
                self.results.series(quantity)
            self.assertTrue(str(caught.exception).startswith(f"{self.path}: error: "))
            self.assertIn(expected, str(caught.exception))


class Refusing(ToolTestCase):
    def changed(self, change):
        path = write_results(self.folder / "run.h5")
        with h5py.File(path, "r+") as file:
            change(file)
        return path

    def assert_error(self, path, expected, quantity="bodies/chassis/position.y"):
        with self.assertRaises(InputError) as caught, open_results(path) as results:
            results.series(quantity)
        self.assertTrue(str(caught.exception).startswith(f"{path}: error: "), caught.exception)
        self.assertIn(expected, str(caught.exception))

    def test_a_missing_file(self):
        self.assert_error(str(self.folder / "none.h5"), "no such file")

    def test_a_folder(self):
        self.assert_error(str(self.folder), "is a folder")

    def test_an_empty_file(self):
        path = self.folder / "empty.h5"
        path.touch()
        self.assert_error(str(path), "the file is empty")

    def test_a_file_that_is_not_hdf5(self):
        path = self.folder / "text.h5"
        path.write_text("time,height\n0,0\n", encoding="utf-8")
        self.assert_error(str(path), "not a readable HDF5 file")

    def test_a_truncated_file(self):
        path = write_results(self.folder / "run.h5")
        with open(path, "r+b") as file:
            file.truncate(5000)
        self.assert_error(path, "not a readable HDF5 file")

    def test_hdf5_of_another_program(self):
        path = self.folder / "foreign.h5"
        with h5py.File(path, "w") as file:
            file["time"] = [0.0, 1.0]
        self.assert_error(str(path), "no attribute 'format', expected 'sprung-results'")

    def test_another_file_of_ours(self):
        path = self.changed(lambda file: file.attrs.__setitem__("format", np.bytes_("sprung-superelement")))
        self.assert_error(path, "format is 'sprung-superelement', expected 'sprung-results'")

    def test_a_newer_version(self):
        self.assert_error(
            self.changed(lambda file: file.attrs.modify("version", 3)),
            "version 3 of sprung-results; this tool",
        )

    def test_the_tools_read_superelements_of_every_stored_version(self):
        stored = sorted((ROOT / "tests/reduce/data").glob("version_*.h5"))
        self.assertEqual(len(stored), NEWEST_VERSIONS[SUPERELEMENT], "raise NEWEST_VERSIONS in hdf5_file.py")
        for path in stored:
            open_hdf5(path, SUPERELEMENT).close()

    def test_a_run_that_did_not_finish(self):
        self.assert_error(
            self.changed(lambda file: file.attrs.modify("complete", 0)), "did not finish (complete = 0)"
        )
        self.assert_error(
            self.changed(lambda file: file.attrs.pop("complete")), "did not finish (complete = 0)"
        )

    def test_time_that_does_not_increase(self):
        def turn_back(file):
            file["time"][5] = 0.0

        self.assert_error(self.changed(turn_back), "dataset 'time' must be two or more increasing values")

    def test_a_missing_time(self):
        self.assert_error(self.changed(lambda file: file.pop("time")), "no dataset 'time'")

    def test_values_that_are_not_finite(self):
        def spoil(file):
            file["bodies/chassis/position"][7, 1] = np.nan

        self.assert_error(
            self.changed(spoil), "dataset 'bodies/chassis/position' holds values that are not finite"
        )

    def test_values_whose_squares_are_not_finite(self):
        def spoil(file):
            file["bodies/chassis/position"][7, 1] = -1e300

        self.assert_error(self.changed(spoil), "dataset 'bodies/chassis/position' holds values as large as 1e+300")

    def test_a_dataset_of_the_wrong_length(self):
        def shorten(file):
            del file["bodies/chassis/position"]
            file["bodies/chassis/position"] = np.ones((7, 3))

        self.assert_error(self.changed(shorten), "has shape (7, 3), expected 201 × 3")

    def test_a_dataset_of_text(self):
        def overwrite(file):
            del file["bodies/chassis/position"]
            file["bodies/chassis/position"] = np.bytes_("none")

        self.assert_error(self.changed(overwrite), "dataset 'bodies/chassis/position' does not hold numbers")

    def test_displacement_where_no_static_balance_was_sought(self):
        path = self.changed(lambda file: file["model/equilibrium"].attrs.modify("is_static_equilibrium", 0))
        expected = "no displacement in 'bodies/chassis/position': static equilibrium was not sought"
        self.assert_error(path, expected, "bodies/chassis/displacement.y")

    def test_a_damaged_dataset(self):
        values = np.arange(603.0).reshape(201, 3)

        def rewrite(file):
            del file["bodies/chassis/position"]
            file.create_dataset("bodies/chassis/position", data=values, chunks=(201, 3), fletcher32=True)

        path = self.changed(rewrite)
        content = bytearray((self.folder / "run.h5").read_bytes())
        content[content.index(values.tobytes()) + 100] ^= 1
        (self.folder / "run.h5").write_bytes(content)
        self.assert_error(path, "dataset 'bodies/chassis/position' is damaged")


class Parts(ToolTestCase):
    """Texts and attributes, and how a tool ends."""

    def test_texts_and_attributes_are_read_and_their_lack_is_named(self):
        path = write_results(self.folder / "run.h5", overrides=("speed=5", "Ü=1"))
        with open_results(path) as results:
            self.assertEqual(read_texts(results.file, "model/overrides"), ["speed=5", "Ü=1"])
            self.assertEqual(read_real(results.file, "model/bodies/chassis", "mass"), 1e4)
            for name in ("model/none", "model", "time"):
                with self.assertRaisesRegex(InputError, f"run.h5: error: no dataset '{name}' of strings"):
                    read_texts(results.file, name)
            with self.assertRaisesRegex(InputError, "run.h5: error: no group 'model/bodies/cab'"):
                read_real(results.file, "model/bodies/cab", "mass")
            with self.assertRaisesRegex(InputError, "run.h5: error: no attribute 'colour' of 'model/bodies/chassis'"):
                read_real(results.file, "model/bodies/chassis", "colour")

    def test_a_text_that_is_not_utf_8_is_damaged(self):
        path = write_results(self.folder / "run.h5")
        with h5py.File(path, "a") as file:
            file["model/bodies/chassis"].attrs["superelement"] = np.bytes_(b"\xff")
            file["model"].attrs["note"] = b"\xff"  # of variable length
        with open_results(path) as results:
            for group, name in (("model/bodies/chassis", "superelement"), ("model", "note")):
                expected = f"run.h5: error: attribute '{name}' of '{group}' is damaged"
                with self.assertRaisesRegex(InputError, expected):
                    read_text(results.file, group, name)


if __name__ == "__main__":
    unittest.main()
