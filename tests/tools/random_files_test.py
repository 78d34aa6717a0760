"""Files of random content (Hypothesis): a reader gives back the values that were written, or raises an InputError that
names the file, never another exception. The examples follow from a fixed seed, and no example has a deadline."""

import json
import math
import re
import unittest

import h5py
import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.configuration import set_hypothesis_home_dir
from synthetic_results import write_results
from tool_test_case import ToolTestCase, make_class_folder

from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.files.toml_text import format_document
from sprung_tools.mesh_import.mesh_file import read_mesh
from sprung_tools.plots.sensitivity_picture import read_elements
from sprung_tools.runs.measures import Measure
from sprung_tools.signals.road_profile import read_profile
from sprung_tools.study.kept_rows import Row, keep_row, parse_row
from sprung_tools.study.study_file import read_study

settings.register_profile(
    "files", derandomize=True, max_examples=100, deadline=None, database=None, suppress_health_check=list(HealthCheck)
)
settings.load_profile("files")

TEXTS = st.text(st.characters(blacklist_categories=("Cs",)), max_size=12)
NUMBERS = st.floats(allow_nan=False) | st.integers(-(2**63), 2**63 - 1)
COORDINATES = st.floats(-1e3, 1e3).map(lambda value: round(value, 4))
VALUES = st.recursive(
    st.none() | st.booleans() | NUMBERS | st.just(math.nan) | TEXTS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(TEXTS, inner, max_size=4),
    max_leaves=12,
)
TOML_VALUES = st.recursive(
    st.booleans() | NUMBERS | TEXTS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(TEXTS, inner, max_size=4),
    max_leaves=12,
)
STUDY = {
    "run": "run.toml", "command": "run", "designs": ["frame.toml"], "set": {"speed": 3.0}, "measures": {"peak": "p"},
    "sampling": {"method": "sobol", "number": 8, "seed": 1}, "random_road": {"class": "C", "length": 50.0},
    "parameters": [{"name": "v", "key": "speed", "from": 1.0, "to": 5.0}],
}  # fmt: skip
LINES = st.lists(
    st.sampled_from((
        "*NODE", "1, 0., 0., 0.", "2, 1., 0., 0.", "*ELEMENT, TYPE=B21, ELSET=A", "1, 1, 2", "*NSET, NSET=B, GENERATE",
        "1, 9, 0", "*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION=RECT", "*MATERIAL, NAME=M", "*ELASTIC", "2e11, 0.3",
        "*PART, NAME=P", "*END PART", "*INSTANCE, NAME=I, PART=P", "*ASSEMBLY", "*END ASSEMBLY", "GRID,1,,0.,0.,0.",
        "GRID,2,,1.,0.,0.", "CBAR,1,1,1,2,0.,1.,0.", "PBARL,1,1,,BAR", ",1.,2.", "MAT1,1,2e11", "BEGIN BULK", "ENDDATA",
        "SET1,4,1,THRU,2", "CORD2R,1,,0.,0.,0.,0.,0.,1.", ",1.,0.,0.", "CONM2,1,2,,5.", "", ",", "*", "$", "**",
    )) | TEXTS,
    max_size=14,
)  # fmt: skip
ARRAYS = st.tuples(
    st.lists(st.integers(0, 4), max_size=3),
    st.sampled_from(("f8", "f4", "i4", "u1", "S3", "?", "c16")),
    st.integers(0, 9),
)
STUDY_PATHS = [
    *((key,) for key in STUDY), ("sampling", "number"), ("sampling", "method"), ("random_road", "length"),
    ("random_road", "class"), *(("parameters", 0, key) for key in ("name", "key", "from", "to", "values")),
]  # fmt: skip
SENSITIVITY_PATHS = (
    (), ("name",), ("elements",), ("elements", 0), ("value",), ("elements", 0, "from_m"),
    ("value", "free_frequency_hz"), ("elements", 0, "strain_energy_share"),
)  # fmt: skip


class RandomFiles(ToolTestCase):
    @classmethod
    def setUpClass(cls):
        set_hypothesis_home_dir(make_class_folder(cls))  # its tables of letters are not left where the tests run

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def read(self, reader, path):
        """What a reader returns; None if it refuses the file by an error that names it."""
        try:
            with np.errstate(all="ignore"):
                return reader(path)
        except InputError as error:
            self.assertRegex(str(error), rf"^{re.escape(str(path))}(:\d+)*: error: .")
            return None

    @given(table=st.dictionaries(TEXTS, TOML_VALUES, max_size=5))
    def test_toml_that_is_written_is_read_with_the_same_values(self, table):
        file = TomlFile(self.write("a.toml", format_document(table)))
        self.assertEqual(file.data, table)
        for place in file.places():
            self.assertRegex(str(file.fail(place, "x")), r"a\.toml:\d+:\d+: error: x$")

    @given(content=st.binary(max_size=60) | st.lists(st.sampled_from(("a", "=", "[", "]", "{", "}", '"', "'", "\n", ".",
           "1", "e", "#", ",", "\r", "\\u", "nan", "-", "0x", "_", "é")), max_size=40).map("".join))  # fmt: skip
    def test_text_that_is_perhaps_toml(self, content):
        self.read(TomlFile, self.write("a.toml", content))

    @given(path=st.sampled_from(STUDY_PATHS), value=TOML_VALUES)
    def test_a_study_with_another_value(self, path, value):
        study = json.loads(json.dumps(STUDY))
        inner = study
        for key in path[:-1]:
            inner = inner[key]
        inner[path[-1]] = value
        for name in ("run.toml", "frame.toml"):
            self.write(name, "")
        self.read(read_study, self.write("study.toml", format_document(study)))

    @given(first=st.floats(-100, 100), step=st.floats(0.001, 10.0), heights=st.lists(st.floats(-5, 5), min_size=3))
    def test_a_road_that_is_written_is_read_with_the_same_heights(self, first, step, heights):
        rows = (f"{first + k * step!r} {height!r}\n" for k, height in enumerate(heights))
        found = self.read(read_profile, self.write("road.txt", "# a road\n" + "".join(rows)))
        self.assertIsNotNone(found)
        self.assertEqual(found[1].tolist(), heights)

    @given(content=st.binary(max_size=60) | st.lists(st.sampled_from(("1 2\n", "2 3\n", "3 ", "nan\n", "inf\n", "-",
           "#", "e9", ",", "4 1e999\n", "4 0.5\n", "\t", "\n", "é")), max_size=20).map("".join))  # fmt: skip
    def test_text_that_is_perhaps_a_road(self, content):
        found = self.read(read_profile, self.write("road.txt", content))
        if found is not None:
            self.assertTrue(np.all(np.isfinite(found)))

    @given(value=VALUES, path=st.sampled_from(SENSITIVITY_PATHS))
    def test_sensitivities_with_another_value(self, value, path):
        element = {"strain_energy_share": [0.5], "kinetic_energy_share": [0.2], "from_m": [0.0, 0.0], "to_m": [1.0, 0]}
        data = {"name": "frame", "elements": [element], "value": {"free_frequency_hz": [9.0]}}
        inner = data
        for key in path[:-1]:
            inner = inner[key]
        if path:
            inner[path[-1]] = value
        found = self.read(read_elements, self.write("a.json", json.dumps(data if path else value)))
        if found is not None:
            for values in found[1:]:
                self.assertTrue(np.all(np.isfinite(values)))

    @given(error=TEXTS, warnings=st.lists(TEXTS, max_size=3), measures=st.dictionaries(TEXTS, st.tuples(
           st.none() | st.floats(allow_nan=False, allow_infinity=False), TEXTS)))  # fmt: skip
    def test_a_row_of_a_study_that_is_kept_is_read_again(self, error, warnings, measures):
        path = self.write("rows.jsonl", "cut off")
        row = Row("h", 0, error, True, tuple(warnings), {name: Measure(*one) for name, one in measures.items()}, 0.5)
        keep_row(path, row)
        lines = path.read_text(encoding="utf-8").split("\n")
        self.assertEqual([parse_row(line) for line in lines if line], [None, row])

    @given(value=VALUES, key=st.sampled_from(Row._fields + ("other",)))
    def test_a_row_of_a_study_with_another_value(self, value, key):
        row = Row("h", 0, "", True, (), {}, 1.0)
        found = parse_row(json.dumps({**row._asdict(), key: value}))
        if found is not None:
            self.assertIsInstance(found.exit_code, int)
            self.assertTrue(all(isinstance(text, str) for text in (found.hash, found.error, *found.warnings)))
            for measure in found.measures.values():
                self.assertIsInstance(measure.value, (int, float, type(None)))
                self.assertIsInstance(measure.unit, str)
        self.assertIsNone(parse_row(json.dumps(value)))

    @given(places=st.lists(st.tuples(COORDINATES, COORDINATES), min_size=2, max_size=6, unique=True), data=st.data())
    def test_a_deck_that_is_written_is_read_with_the_same_nodes_and_lines(self, places, data):
        count = len(places)
        ids = data.draw(st.lists(st.integers(1, 10**6), min_size=count, max_size=count, unique=True))
        ends = [(ids[k], ids[k + 1]) for k in range(count - 1)]
        abaqus = "*NODE\n" + "".join(f"{one}, {x}, {y}, 0.\n" for one, (x, y) in zip(ids, places))
        abaqus += "*ELEMENT, TYPE=B21, ELSET=A\n" + "".join(f"{k + 1}, {a}, {b}\n" for k, (a, b) in enumerate(ends))
        nastran = "BEGIN BULK\n" + "".join(f"GRID,{one},,{x},{y},0.\n" for one, (x, y) in zip(ids, places))
        nastran += "".join(f"CBAR,{k + 1},1,{a},{b},0.,0.,1.\n" for k, (a, b) in enumerate(ends)) + "ENDDATA\n"
        for name, text in (("a.inp", abaqus), ("a.bdf", nastran)):
            mesh = read_mesh(str(self.write(name, text)))
            found = {int(one): tuple(place) for one, place in zip(mesh.node_ids, mesh.positions)}
            self.assertEqual(found, {one: (x, y, 0.0) for one, (x, y) in zip(ids, places)})
            self.assertEqual([tuple(mesh.node_ids[line]) for line in mesh.lines], ends)

    @given(lines=LINES, name=st.sampled_from(("a.inp", "a.bdf", "a.mail")))
    def test_a_deck_of_random_lines(self, lines, name):
        self.read(lambda path: read_mesh(str(path)), self.write(name, "\n".join(lines)))

    @given(name=st.sampled_from(("time", "bodies/chassis/position", "bodies/chassis/modal/amplitude",
           "bodies/chassis/modal/mode_number", "points/chassis.seat/acceleration", "joints/new/angle")),
           array=ARRAYS, every=st.none() | st.integers(-2, 300))  # fmt: skip
    def test_a_results_file_with_another_dataset(self, name, array, every):
        shape, kind, value = array
        path = self.folder / "run.h5"
        write_results(path)
        with h5py.File(path, "a") as file:
            if name in file:
                del file[name]
            file[name] = np.full(shape, value).astype(kind)
            if every is not None:
                file[name].attrs["every"] = every

        def read(path):
            with open_results(path) as results:
                component = "" if name in ("time", "joints/new/angle") else ".1" if "modal" in name else ".x"
                return results.series(name + component)[0]

        found = self.read(read, path)
        if found is not None:
            self.assertEqual(found.ndim, 1)
            self.assertEqual(set(found.tolist()) - {float(value)}, set())


if __name__ == "__main__":
    unittest.main()
