"""The files of sprung-reduce on bad days: blocked, damaged, of other programs, interrupted, killed."""

import os
import resource
import shutil
import signal
import subprocess

import h5py

from reduce_case import PROGRAM, ReduceTestCase, run_tests


class Files(ReduceTestCase):
    def test_a_damaged_file_is_made_again(self):
        self.build("long_arm.toml")
        whole = self.read("long_arm.h5")
        (self.folder / "out/long_arm.h5").write_bytes(whole[: len(whole) // 2])
        result = self.build("long_arm.toml")
        self.assertIn("the file there cannot be used", result.stdout)
        self.assertEqual(self.read("long_arm.h5"), whole)

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
            file.attrs["version"] = file.attrs["version"] + 99
        newer = self.read("chassis.h5")
        result = self.build("chassis.toml", code=2)
        self.assertIn("use a newer sprung", result.stderr)
        self.assertEqual(self.read("chassis.h5"), newer)

    def test_an_interrupt_leaves_whole_files(self):
        design = (self.folder / "chassis.toml").read_bytes()
        names = [f"frame{number}.toml" for number in range(5)]
        for name in names:
            (self.folder / name).write_bytes(design)
        # One design is a pipe, where the program waits.
        (self.folder / names[2]).unlink()
        os.mkfifo(self.folder / names[2])
        with subprocess.Popen([PROGRAM, "build", *names, "-o", "out"], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8") as process:  # fmt: skip
            with open(self.folder / names[2], "wb"):  # returns when the program has opened it
                process.send_signal(signal.SIGINT)
                process.wait()
            _, errors = process.communicate()
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("sprung-reduce: interrupted: the files made before are whole", errors)
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

    def test_files_that_cannot_be_read_end_with_exit_code_2(self):
        (self.folder / "empty.h5").write_bytes(b"")
        for command in (("info", "none.h5"), ("check", "empty.h5"), ("diff", "empty.h5", "none.h5")):
            result = self.run_program(*command)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"{command[1]}: error: ", result.stderr)


if __name__ == "__main__":
    run_tests()
