"""tools/run-truck, in a copy of tools/ with stand-ins for the build and both programs: what it calls and shows."""

import os
import shutil
import sys
import unittest

from tool_test_case import ROOT, TOOLS, ToolTestCase, run_program

REDUCE = """
import pathlib, sys
from synthetic_results import write_superelement
folder = pathlib.Path(sys.argv[sys.argv.index("--output-dir") + 1])
write_superelement(folder / "chassis.h5", "chassis", [6.112, 6.112, 38.306, 38.306, 83.36, 83.36])
write_superelement(folder / "long_arm.h5", "long_arm", [88.92, 88.9304])
"""
# The more modes, the larger the motion, so that the three runs' rows can be told apart: 50, 100 and 150 mm.
DYNAMICS = """
import sys
from synthetic_results import write_results
modes = int(sys.argv[-1].split("=")[1])
write_results(sys.argv[sys.argv.index("-o") + 1], num_modes=modes, scale=1.0 + modes / 2.0)
"""


class RunTruck(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.root = self.folder / "a project"  # a blank, as in many a home folder
        shutil.copytree(TOOLS, self.root / "tools", ignore=shutil.ignore_patterns("support", "cmake", "__pycache__"))
        for folder in ("meshes/truck", "dynamics/models/truck", "elsewhere"):
            (self.root / folder).mkdir(parents=True)
        for name in (
            "meshes/truck/chassis.toml",
            "meshes/truck/long_arm.toml",
            "dynamics/models/truck/bump.toml",
        ):
            (self.root / name).touch()
        self.calls = self.folder / "calls"
        self.program("tools/setup", "pass")
        self.program("tools/build", "pass")
        self.program("build/release/reduce/sprung-reduce", REDUCE)
        self.program("build/release/dynamics/sprung-dynamics", DYNAMICS)

    def program(self, name, body):
        """A stand-in that writes down its arguments and then does what the Python in `body` says."""
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        record = f"import sys\nopen({str(self.calls)!r}, 'a').write(' '.join([{path.name!r}, *sys.argv[1:]]) + '\\n')\n"
        path.write_text(f"#!{sys.executable}\n{record}{body}", encoding="utf-8")
        path.chmod(0o755)

    def run_truck(self, *arguments):
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "tests/tools")}
        command = [self.root / "tools/run-truck", *arguments]
        return run_program(command, cwd=self.root / "elsewhere", env=environment)

    def test_it_reduces_runs_the_bump_three_times_and_leaves_tables_pictures_and_a_page(self):
        process = self.run_truck("--output-dir", "my results")
        self.assert_succeeds(process)
        out = self.root / "elsewhere/my results"
        truck = "dynamics/models/truck/bump.toml"
        self.assertEqual(
            self.calls.read_text(encoding="utf-8").splitlines(),
            [
                "setup",
                "build sprung-reduce sprung-dynamics",
                f"sprung-reduce build meshes/truck/chassis.toml meshes/truck/long_arm.toml --output-dir {out}",
                *(
                    f"sprung-dynamics run {truck} --superelements {out} -o {out}/bump_{name}.h5 --set modes.chassis={n}"
                    for name, n in (("rigid", 0), ("2modes", 2), ("4modes", 4))
                ),
            ],
        )
        for name in ("bump_displacement.png", "bump_acceleration.png", "bump_front_end.png"):
            self.assertGreater((out / name).stat().st_size, 10000)
            self.assertIn(str(out / name), process.stdout)
        page = (out / "report.html").read_text(encoding="utf-8")
        for label in ("rigid", "2 modes", "4 modes"):
            self.assertIn(f'"label":"{label}"', page)
        self.assertIn("residual of the modes", page)  # the superelements' checks
        last = process.stdout.strip().splitlines()[-1]
        self.assertEqual(last, f"Open it in a browser: {(out / 'report.html').as_uri()}")
        rows = [line.split() for line in process.stdout.splitlines()]
        self.assertIn(["chassis", "1", "6.11200", "6.11", "+0.00200", "+0.0327", "yes"], rows)
        self.assertIn(["2", "88.93040", "88.92", "+0.01040", "+0.0117", "NO"], rows)
        for label, peak in (("rigid", "0.05"), ("2 modes", "0.1"), ("4 modes", "0.15")):
            self.assertRegex(process.stdout, rf"(?m)\b{label} +-{peak} .* {peak} .* m$")

    def test_the_example_of_its_help_runs(self):
        words = self.run_truck("--help").stdout.splitlines()[-1].split()
        self.assertEqual(words[:2], ["tools/run-truck", "--output-dir"])
        process = self.run_truck(words[1], str(self.folder / "given"))
        self.assert_succeeds(process)
        self.assertTrue((self.folder / "given/report.html").exists())

    def test_it_can_be_run_again_and_writes_into_the_build_folder_by_default(self):
        for _ in range(2):
            self.assertEqual(self.run_truck().returncode, 0)
        self.assertTrue((self.root / "build/truck/bump_displacement.png").exists())

    def test_it_stops_at_the_first_failure_and_names_the_step(self):
        self.program("build/release/dynamics/sprung-dynamics", "sys.exit(3 if sys.argv[-1].endswith('=2') else 0)")
        process = self.run_truck()
        self.assertEqual(process.returncode, 3)
        self.assertIn("tools/run-truck: stopped (exit 3): bump, chassis with 2 modes failed", process.stderr)
        self.assertNotIn("chassis with 4 modes", process.stdout)

    def test_an_output_folder_that_is_blocked_by_a_file_is_refused_before_anything_is_built(self):
        (self.root / "elsewhere/blocked").touch()
        process = self.run_truck("--output-dir", "blocked/truck")
        self.assertEqual(process.returncode, 2)
        self.assertIn("tools/run-truck: error: cannot make the folder blocked/truck", process.stderr)
        self.assertFalse(self.calls.exists())


if __name__ == "__main__":
    unittest.main()
