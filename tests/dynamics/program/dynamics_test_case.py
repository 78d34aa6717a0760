"""What the tests of sprung-dynamics share: the truck's files in a folder of their own, in which a test makes one
fault."""

import os
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests"))

from programs import ProgramTestCase, run_program  # noqa: E402  after the path

TRUCK = ROOT / "dynamics/models/truck"
PROGRAM = os.environ["SPRUNG_DYNAMICS"]
SUPERELEMENTS = Path(os.environ["SPRUNG_SUPERELEMENTS"])

SHORT = ("--set", "duration=0.05", "--quiet")  # long enough to have run


class DynamicsTestCase(ProgramTestCase):
    """`self.folder` holds vehicle.toml, bump.toml and the superelements; results are asked for in results.h5."""

    def setUp(self):
        super().setUp()
        for path in (TRUCK / "vehicle.toml", TRUCK / "bump.toml", *SUPERELEMENTS.glob("*.h5")):
            shutil.copy(path, self.folder)
        self.results = self.folder / "results.h5"

    def make_earlier_result(self):
        """A whole results file in results.h5. Returns its bytes."""
        process = self.run_to_results("--set", "speed=1")
        self.assertEqual(process.returncode, 0, process.stderr)
        return self.results.read_bytes()

    def edit(self, name, old, new):
        """Replaces the first occurrence of `old`, which must be there."""
        path = self.folder / name
        text = path.read_text(encoding="utf-8")
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1), encoding="utf-8")

    def command(self, *arguments, verb="run"):
        return [PROGRAM, verb, "bump.toml", *arguments]

    def run_program(self, *arguments, verb="run", **options):
        return run_program(self.command(*arguments, verb=verb), cwd=self.folder, **options)

    def run_to_results(self, *arguments, **options):
        return self.run_program(*SHORT, *arguments, "-o", "results.h5", **options)

    def assert_refused(self, process, *fragments):
        """Exit code 2 and one message with all fragments."""
        self.assertEqual(process.returncode, 2, process.stdout + process.stderr)
        self.assertIn("error: ", process.stderr)
        for fragment in fragments:
            self.assertIn(fragment, process.stderr)

    def files(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}
