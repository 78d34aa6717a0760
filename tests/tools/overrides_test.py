"""What `import sprung` makes of overrides: tables, values of Python and numpy, and what it refuses. Needs
sprung-dynamics (SPRUNG_DYNAMICS)."""

import unittest
from pathlib import Path

import h5py
import numpy as np
from tool_test_case import ROOT, ToolTestCase

import sprung
from sprung_tools.programs.calls import format_overrides

CAR = ROOT / "dynamics/models/examples/quarter_car_run.toml"


class Overrides(ToolTestCase):
    def test_a_table_of_overrides_stands_for_its_keys(self):
        """{"statistics": {"to": 2.0}} set `from` back to 0, without a word."""
        vehicle = CAR.parent / "quarter_car.toml"
        text = CAR.read_text(encoding="utf-8").replace('"quarter_car.toml"', f'"{vehicle}"')
        run = self.folder / "run.toml"
        run.write_text(f"{text}\n[statistics]\nfrom = 0.1\n", encoding="utf-8")
        values = {"duration": 0.4, "statistics": {"to": 0.3}, "road": {"height": 0.05}}
        with sprung.run(run, overrides=values) as results, h5py.File(results.path) as file:
            settings = file["model/resolved/settings"].attrs
            self.assertEqual((settings["statistics_from"], settings["statistics_to"]), (0.1, 0.3))
            self.assertEqual(file["model/resolved/road/parameters"].attrs["length"], 2.0)

    def test_a_table_that_is_a_value_replaces_what_was_there(self):
        spring = {"table": [[-1.0, -2e4], [1.0, 2e4]]}
        for values, expected in (
            ({"vehicle.forces.suspension.spring": spring}, ["vehicle.forces.suspension.spring={ table = [[-1.0,"]),
            ({"vehicle": {"forces": {"suspension": {"spring": spring}}}}, ["vehicle.forces.suspension.spring={ tab"]),
            ({"road": {"shape": "flat"}, "output.step": {}}, ['road={ shape = "flat" }', "output.step={  }"]),
        ):
            with sprung.run(CAR, overrides={"duration": 0.1, **values}) as results, h5py.File(results.path) as file:
                told = [one.decode() for one in file["model/overrides"][1:]]
            self.assertEqual([one[: len(two)] for one, two in zip(told, expected, strict=True)], expected)

    def test_overrides_that_are_no_mapping_are_a_type_error(self):
        for values in (["speed=4"], "speed=4", 4):
            with self.assertRaisesRegex(TypeError, "overrides is .*, expected a mapping such as {'road.height': 0.1}"):
                sprung.modes(CAR, overrides=values)

    def test_values_of_numpy_are_taken_and_others_are_refused_with_their_key(self):
        values = {"speed": np.int64(3), "road.height": np.float32(0.25), "duration": np.float64(0.1),
                  "adaptivity.indicator": np.bool_(False), "vehicle.gravity": np.array([0.0, -9.5]),
                  "road.file": Path("roads/a.txt")}  # fmt: skip
        self.assertEqual(
            format_overrides(values),
            ["speed=3", "road.height=0.25", "duration=0.1", "adaptivity.indicator=false",
             "vehicle.gravity=[0.0, -9.5]", 'road.file="roads/a.txt"'],
        )  # fmt: skip
        for value in (3j, np.complex128(3j), None, [1.0, {1.0}]):
            with self.assertRaisesRegex(sprung.InputError, "^road.height: error: .* is no value of a parameter, expec"):
                sprung.run(CAR, overrides={"road.height": value})


if __name__ == "__main__":
    unittest.main()
