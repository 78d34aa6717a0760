"""What tests of sprung-reduce as a user calls it share.

Usage of a test: NAME_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import shutil
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from programs import ProgramTestCase, run_program  # noqa: E402  after the path

PROGRAM, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])


class ReduceTestCase(ProgramTestCase):
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


def run_tests():
    unittest.main("__main__", argv=[sys.argv[0], *sys.argv[3:]])
