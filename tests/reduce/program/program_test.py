"""sprung-reduce as a user calls it: what it writes, leaves alone, prints and returns.

Usage: program_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import unittest
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from programs import ProgramTestCase, run_program  # noqa: E402  after the path

PROGRAM = ""
SOURCE = Path()


class ProgramTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        for name in ("chassis.toml", "chassis_certified.toml", "long_arm.toml"):
            shutil.copy(SOURCE / "meshes/truck" / name, self.folder / name)
        for name in ("ladder_frame.toml", "ladder_frame.geo"):
            shutil.copy(SOURCE / "meshes/examples" / name, self.folder / name)

    def run_program(self, *arguments, **options):
        return run_program([PROGRAM, *arguments], cwd=self.folder, **options)

    def build(self, *designs, code=0, **options):
        result = self.run_program("build", *designs, "--output-dir", "out", **options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def change(self, name, old, new):
        path = self.folder / name
        text = path.read_text(encoding="utf-8")
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1), encoding="utf-8")

    def files(self):
        return sorted(path.name for path in (self.folder / "out").iterdir())

    def read(self, name):
        return (self.folder / "out" / name).read_bytes()

    # What is built, and when

    def test_builds_several_designs_and_then_leaves_them_alone(self):
        result = self.build("chassis.toml", "long_arm.toml")
        self.assertIn("building from chassis.toml (new)", result.stdout)
        self.assertIn("36 freedoms, 36 modes from 6.1112", result.stdout)
        self.assertEqual(self.files(), ["chassis.h5", "long_arm.h5"])
        before = {name: (self.folder / "out" / name).stat().st_mtime_ns for name in self.files()}
        result = self.build("chassis.toml", "long_arm.toml")
        self.assertEqual(result.stdout.count("up to date"), 2)
        self.assertNotIn("building", result.stdout)
        after = {name: (self.folder / "out" / name).stat().st_mtime_ns for name in self.files()}
        self.assertEqual(before, after)

    # 9.7219 Hz is the free beam's first frequency: 22.373/2π √(EI/mL⁴).
    def test_a_certified_basis_is_told_with_its_bound_and_checked(self):
        result = self.build("chassis_certified.toml")
        self.assertIn("36 freedoms, 5 free modes from 9.7219 to 87.0238 Hz, 10 residual vectors", result.stdout)
        self.assertRegex(
            result.stdout, r"interface flexibility within 0\.77 % up to 60 Hz \(proved\); worst: \w+_pivot y at 60 Hz"
        )
        path = self.folder / "out/chassis_certified.h5"
        self.assertEqual(self.run_program("check", path).returncode, 0)
        info = self.run_program("info", path).stdout
        for text in ("residual", "no frequency of the body", "error in the band %", "front_spring rotation"):
            self.assertIn(text, info)
        certificate = json.loads(self.run_program("info", path, "--json").stdout)["certificate"]
        self.assertEqual(len(certificate["interface"]), 13)
        self.assertLess(certificate["error"], certificate["tolerance"])

    def test_a_clamped_basis_is_told_how_poor_it_is(self):
        self.change("chassis.toml", "all = true", "count = 8")
        result = self.build("chassis.toml")
        self.assertRegex(result.stdout, r"interface flexibility without a bound up to [\d.]+ Hz: the free mode at 9\.7")
        info = self.run_program("info", self.folder / "out/chassis.h5").stdout
        self.assertIn("What the damping of the clamped modes is on the free body", info)

    def test_same_input_gives_same_bytes_whatever_the_folder(self):
        self.build("chassis.toml", "ladder_frame.toml")
        other = self.folder / "elsewhere" / "deeper"
        other.mkdir(parents=True)
        for name in ("chassis.toml", "ladder_frame.toml", "ladder_frame.geo"):
            shutil.copy(self.folder / name, other / name)
        result = self.run_program("build", other / "chassis.toml", other / "ladder_frame.toml", "-o", other)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("chassis.h5", "ladder_frame.h5"):
            self.assertEqual(self.read(name), (other / name).read_bytes())
        before = self.read("chassis.h5")
        self.assertIn("(forced)", self.build("chassis.toml", "--force").stdout)
        self.assertEqual(self.read("chassis.h5"), before)

    def test_a_changed_design_is_rebuilt_and_says_what_moved(self):
        self.build("chassis.toml", "long_arm.toml")
        arm = self.read("long_arm.h5")
        self.change("chassis.toml", "second_moment = 1.9e-4", "second_moment = 2.09e-4")
        result = self.build("chassis.toml", "long_arm.toml")
        self.assertIn("(the design changed)", result.stdout)
        # ω ∝ √I in bending: √1.1 = 1.04881; the axial pair stays.
        rows = [line.split() for line in result.stdout.splitlines()]
        self.assertIn(["1–2", "6.1112", "1–2", "6.4095", "+4.881", "1.0000"], rows)
        self.assertIn(["5–6", "83.3623", "5–6", "83.3623", "0.000", "1.0000"], rows)
        self.assertEqual(self.read("long_arm.h5"), arm)
        self.assertIn("up to date", self.build("chassis.toml").stdout)

    def test_a_changed_mesh_file_or_algorithm_is_noticed(self):
        self.build("ladder_frame.toml")
        self.change("ladder_frame.geo", "height = 0.8", "height = 0.80 ")
        self.assertIn("(ladder_frame.geo changed)", self.build("ladder_frame.toml").stdout)
        self.assertIn("up to date", self.build("ladder_frame.toml").stdout)

    def test_a_damaged_file_is_made_again(self):
        self.build("long_arm.toml")
        whole = self.read("long_arm.h5")
        (self.folder / "out/long_arm.h5").write_bytes(whole[: len(whole) // 2])
        result = self.build("long_arm.toml")
        self.assertIn("the file there cannot be used", result.stdout)
        self.assertEqual(self.read("long_arm.h5"), whole)

    def test_every_design_of_the_project_builds_and_checks(self):
        designs = sorted((SOURCE / "meshes").glob("*/*.toml"))
        self.assertGreaterEqual(len(designs), 5)
        self.build(*designs)
        result = self.run_program("check", *(self.folder / "out" / (path.stem + ".h5") for path in designs))
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertEqual(result.stdout.count("all checks passed"), len(designs))

    # What goes wrong

    def test_a_bad_design_is_reported_and_spoils_nothing(self):
        self.build("chassis.toml", "long_arm.toml", "ladder_frame.toml")
        before = {name: self.read(name) for name in self.files()}
        self.change("long_arm.toml", "second_moment", "second_momnt")
        self.change("ladder_frame.toml", "highest_frequency = 150.0", "count = 3")
        result = self.build("chassis.toml", "long_arm.toml", "ladder_frame.toml", code=2)
        self.assertIn("long_arm.toml:10:1: error: unknown key 'second_momnt' in 'sections.arm' "
                      "(did you mean 'second_moment'?)", result.stderr)
        self.assertIn("chassis.h5: up to date", result.stdout)
        self.assertEqual(self.files(), sorted(before))
        self.assertEqual(self.read("chassis.h5"), before["chassis.h5"])
        self.assertEqual(self.read("long_arm.h5"), before["long_arm.h5"])
        self.assertNotEqual(self.read("ladder_frame.h5"), before["ladder_frame.h5"])

    def test_a_mesh_too_fine_is_a_numerical_error(self):
        self.change("chassis.toml", "elements = 1 ", "elements = 2000 ")
        self.change("chassis.toml", "all = true", "count = 2")
        result = self.build("chassis.toml", code=3)
        self.assertIn("chassis.toml: error: rounding spoils the lowest mode", result.stderr)
        self.assertEqual(self.files(), [])

    def test_a_write_that_fails_half_way_leaves_the_earlier_file(self):
        self.build("chassis.toml")
        before = self.read("chassis.h5")
        self.change("chassis.toml", "damping_ratio = 0.01", "damping_ratio = 0.02")
        for size in (100, 20000, len(before) - 1000):
            limit = lambda size=size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))  # noqa: E731
            result = self.build("chassis.toml", code=2, preexec_fn=limit)
            self.assertIn("out/chassis.h5", result.stderr)
            self.assertIn("error: ", result.stderr)
            self.assertEqual(self.files(), ["chassis.h5"])
            self.assertEqual(self.read("chassis.h5"), before)
        self.build("chassis.toml")
        self.assertNotEqual(self.read("chassis.h5"), before)

    def test_a_folder_that_cannot_be_one_is_refused(self):
        (self.folder / "out").write_text("in the way", encoding="utf-8")
        result = self.build("chassis.toml", code=2)
        self.assertIn("out: error: cannot be used as a folder", result.stderr)
        self.assertEqual((self.folder / "out").read_text(encoding="utf-8"), "in the way")

    def test_an_output_blocked_by_a_folder_is_refused(self):
        (self.folder / "out/chassis.h5").mkdir(parents=True)
        result = self.build("chassis.toml", code=2)
        self.assertIn("out/chassis.h5", result.stderr)
        self.assertEqual(self.files(), ["chassis.h5"])

    def test_files_of_others_are_replaced_by_force_only(self):
        (self.folder / "out").mkdir()
        with h5py.File(self.folder / "out/chassis.h5", "w") as file:
            file["measured"] = [1.0, 2.0]
        measured = self.read("chassis.h5")
        result = self.build("chassis.toml", code=2)
        self.assertIn("out/chassis.h5: error: is in the way and is left alone", result.stderr)
        self.assertEqual(self.read("chassis.h5"), measured)
        self.build("chassis.toml", "--force")
        with h5py.File(self.folder / "out/chassis.h5", "r+") as file:
            file.attrs["version"] = file.attrs["version"] + 1
        newer = self.read("chassis.h5")
        result = self.build("chassis.toml", code=2)
        self.assertIn("use a newer sprung", result.stderr)
        self.assertEqual(self.read("chassis.h5"), newer)

    def test_two_designs_for_one_file_are_refused(self):
        (self.folder / "other").mkdir()
        shutil.copy(self.folder / "chassis.toml", self.folder / "other/chassis.toml")
        result = self.build("chassis.toml", "other/chassis.toml", code=2)
        self.assertIn("would be written to 'out/chassis.h5', as would 'chassis.toml'", result.stderr)

    def test_a_missing_design_is_named(self):
        self.assertIn("none.toml: error: ", self.build("none.toml", code=2).stderr)

    def test_an_interrupt_leaves_whole_files(self):
        design = (self.folder / "chassis.toml").read_bytes()
        names = [f"frame{number}.toml" for number in range(5)]
        for name in names:
            (self.folder / name).write_bytes(design)
        # One design is a pipe: the program waits there until the test has sent the signal and written the design.
        (self.folder / names[2]).unlink()
        os.mkfifo(self.folder / names[2])
        with subprocess.Popen([PROGRAM, "build", *names, "-o", "out"], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8") as process:  # fmt: skip
            with open(self.folder / names[2], "wb") as pipe:  # returns when the program has opened it
                process.send_signal(signal.SIGINT)
                pipe.write(design)
            _, errors = process.communicate()
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("interrupted: while frame2.toml was built; the files made so far are whole", errors)
        made = ["frame0.h5", "frame1.h5"]
        self.assertEqual(self.files(), made)
        self.assertEqual(self.run_program("check", *(self.folder / "out" / name for name in made)).returncode, 0)

    def test_a_file_that_another_program_changed_is_judged_as_the_specification_says(self):
        self.build("ladder_frame.toml")
        whole = self.folder / "out/ladder_frame.h5"

        def store_again(file, name, values, **options):
            attributes = dict(file[name].attrs)
            del file[name]
            dataset = file.create_dataset(name, data=values, **options)
            for key, value in attributes.items():
                dataset.attrs[key] = value

        def check(kind, name, change, code):
            changed = self.folder / "changed.h5"
            shutil.copy(whole, changed)
            with h5py.File(changed, "r+") as file:
                change(file, name, file[name][()])
            result = self.run_program("check", "changed.h5")
            self.assertEqual(result.returncode, code, f"{kind} of {name}: {result.stdout}{result.stderr}")
            if code == 2:
                self.assertIn("changed.h5: error: ", result.stderr)

        def set_attribute(key, value):
            return lambda file, name, _: file[name].attrs.__setitem__(key, value)

        def retype(dtype):
            return lambda file, name, values: store_again(file, name, values.astype(dtype))

        def to_integers(file, name, values):
            store_again(file, name, (values * 0).astype("i8"))

        def compress(file, name, values):
            store_again(file, name, values, compression=9)

        def lengthen(file, name, values):
            store_again(file, name, values.astype(f"S{values.dtype.itemsize + 9}"))

        def vary(file, name, values):
            store_again(file, name, values.astype(object), dtype=h5py.string_dtype())

        names = []
        with h5py.File(whole) as file:
            file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
            kinds = {name: file[name].dtype.kind for name in names}
        self.assertGreater(len(names), 35)
        for name in names:
            kind = kinds[name]
            check("another attribute", name, set_attribute("scale", 1000.0), 0)
            check("a wrong unit", name, set_attribute("unit", "furlong"), 2)
            check("one more rank", name, lambda file, name, values: store_again(file, name, values[..., None]), 2)
            check("no filter", name, lambda file, name, values: store_again(file, name, values), 0)
            if kind == "f":
                check("another byte order", name, retype(">f8"), 0)
                check("complex numbers", name, retype("c16"), 2)
                check("integers", name, to_integers, 2)
                check("compression", name, compress, 2)
            elif kind == "i":
                check("narrower integers", name, retype("i2"), 0)
                check("unsigned integers of 64 bits", name, retype("u8"), 2)
                check("reals", name, retype("f8"), 2)
            else:
                check("longer texts", name, lengthen, 0)
                check("variable texts", name, vary, 2)

    def test_what_a_killed_build_left_is_cleaned_up_by_the_next(self):
        self.build("chassis.toml")
        (self.folder / "out/chassis.h5.tmp").write_bytes(b"half a file")
        self.assertIn("up to date", self.build("chassis.toml").stdout)
        self.assertEqual(self.files(), ["chassis.h5"])

    # What is printed

    def test_info_shows_modes_mass_points_checks_and_origin(self):
        self.build("chassis.toml")
        text = self.run_program("info", "out/chassis.h5").stdout
        for part in ("mass                              11950 kg", "centre of mass                    (0, 0) m",
                     "front_short_pivot", "38.3104", "axial", "algorithm revision", "passed"):
            self.assertIn(part, text)
        self.assertNotIn("FAILED", text)

    def test_json_says_the_same_with_all_digits(self):
        self.build("chassis.toml")
        data = json.loads(self.run_program("info", "out/chassis.h5", "--json").stdout)
        with h5py.File(self.folder / "out/chassis.h5") as file:
            self.assertEqual([mode["frequency_hz"] for mode in data["modes"]], list(file["modes/frequency"]))
            self.assertEqual(data["mass_kg"], file["inertia/mass"][0])
            self.assertEqual(data["content_sha256"], file.attrs["content_hash"].decode()
                             if isinstance(file.attrs["content_hash"], bytes) else file.attrs["content_hash"])
        self.assertEqual(len(data["points"]), 13)
        self.assertTrue(all(check["passed"] for check in data["checks"]))
        checks = json.loads(self.run_program("check", "out/chassis.h5", "--json").stdout)
        self.assertEqual(checks["checks"], data["checks"])
        diff = json.loads(self.run_program("diff", "out/chassis.h5", "out/chassis.h5", "--json").stdout)
        self.assertEqual(diff["modes"][0]["old_modes"], [1, 2])
        self.assertAlmostEqual(diff["modes"][0]["mac"], 1.0)

    def test_diff_of_two_files(self):
        self.build("chassis.toml")
        shutil.copy(self.folder / "out/chassis.h5", self.folder / "old.h5")
        self.change("chassis.toml", "mass_per_length = 1561.8057", "mass_per_length = 1700.0")
        self.build("chassis.toml")
        result = self.run_program("diff", "old.h5", "out/chassis.h5")
        self.assertEqual(result.returncode, 0)
        self.assertIn("-4.151", result.stdout)  # √(1561.8057/1700) − 1

    def test_quiet_prints_nothing_and_errors_still(self):
        result = self.build("chassis.toml", "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        self.change("chassis.toml", "1.9e-4", "1.8e-4")
        self.assertEqual(self.build("chassis.toml", "--quiet").stdout, "")
        self.change("chassis.toml", "1.8e-4", "-1.8e-4")
        self.assertIn("must be > 0 m⁴", self.build("chassis.toml", "--quiet", code=2).stderr)

    def test_files_that_cannot_be_read_end_with_exit_code_2(self):
        (self.folder / "empty.h5").write_bytes(b"")
        for command in (("info", "none.h5"), ("check", "empty.h5"), ("diff", "empty.h5", "none.h5")):
            result = self.run_program(*command)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"{command[1]}: error: ", result.stderr)

    def test_a_wrong_command_line_ends_with_exit_code_2_and_help_with_0(self):
        for arguments in ((), ("bild",), ("build",), ("build", "--no-such-option", "chassis.toml")):
            self.assertEqual(self.run_program(*arguments).returncode, 2, arguments)
        for arguments in (("--help",), ("build", "--help"), ("--version",)):
            result = self.run_program(*arguments)
            self.assertEqual(result.returncode, 0)
            self.assertIn("sprung-reduce", result.stdout)


if __name__ == "__main__":
    PROGRAM = str(Path(sys.argv[1]).resolve())
    SOURCE = Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
