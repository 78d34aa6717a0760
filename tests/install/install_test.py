"""What `cmake --install` puts into an empty folder is enough to reduce the truck's bodies, to drive it over the
bump, to draw that, and to build a program that reads superelements. Needs the folder of the build (SPRUNG_BUILD), cmake
(SPRUNG_CMAKE) and the compiler flags of the build (SPRUNG_CXX_FLAGS)."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def run(*command, **options):
    return subprocess.run(
        [str(word) for word in command],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        **options,
    )


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.installed = cls.folder / "a prefix"  # a blank, as in many a home folder
        cls.share = cls.installed / "share/sprung"
        cls.must_run(os.environ["SPRUNG_CMAKE"], "--install", os.environ["SPRUNG_BUILD"], "--prefix", cls.installed)
        designs = sorted((cls.share / "meshes/truck").glob("*.toml"))
        cls.reduced = cls.must_run(
            cls.installed / "bin/sprung-reduce", "build", *designs, "--output-dir", cls.folder / "bodies"
        )

    @classmethod
    def must_run(cls, *command):
        process = run(*command, cwd=cls.folder)
        if process.returncode != 0:
            raise AssertionError(f"{command} ended with exit code {process.returncode}:\n{process.stdout}")
        return process.stdout

    def test_the_truck_drives_over_the_bump_and_is_drawn(self):
        run_file, results = self.share / "dynamics/models/truck/bump.toml", self.folder / "bump.h5"
        self.must_run(
            self.installed / "bin/sprung-dynamics", "run", run_file, "--superelements", self.folder / "bodies",
            "-o", results, "--set", "duration=1", "--set", "statistics.to=1",
        )  # fmt: skip
        picture, page = self.folder / "bump.png", self.folder / "bump.html"
        self.must_run(
            self.share / "tools/plot_results", results, "-o", picture, "--show", "bodies/chassis/acceleration.y"
        )
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.must_run(self.share / "tools/report", results, "-o", page, "--superelements", self.folder / "bodies")
        self.assertIn("dygraphs", page.read_text(encoding="utf-8"))

    def test_the_example_study_finds_the_installed_programs(self):
        study = self.share / "dynamics/models/examples/quarter_car_study.toml"
        environment = {name: value for name, value in os.environ.items() if not name.startswith("SPRUNG_")}
        process = run(self.share / "tools/study", study, "-o", self.folder / "study", cwd=self.folder, env=environment)
        self.assertEqual(process.returncode, 0, process.stdout)
        self.assertIn("6 runs: 6 made, 0 kept from before, 0 failed", process.stdout)

    def test_the_package_for_python_finds_the_installed_programs(self):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("SPRUNG_")}
        environment["PYTHONPATH"] = str(self.share / "tools")
        code = (
            "import sprung, sys\n"
            "with sprung.run(sys.argv[1], superelements=sys.argv[2], overrides={'duration': 0.2}) as results:\n"
            "    print(results.time[-1], results.unit('bodies/chassis/acceleration.y'))\n"
            "print(sprung.explain_calls())\n"
        )
        run_file = self.share / "dynamics/models/truck/bump.toml"
        process = run(sys.executable, "-c", code, run_file, self.folder / "bodies", cwd=self.folder, env=environment)
        self.assertEqual(process.returncode, 0, process.stdout)
        number, how = process.stdout.splitlines()
        self.assertEqual(number, "0.2 m/s^2")
        if list(Path(os.environ["SPRUNG_BUILD"]).glob("dynamics/sprung_dynamics.*.so")):
            self.assertIn(f"in this process, by {self.installed}/lib/sprung/sprung_dynamics.", how)
        else:
            self.assertIn(f"by processes of {self.installed}/bin/sprung-dynamics: no module", how)

    def test_every_tool_explains_itself(self):
        tools = sorted(path for path in (self.share / "tools").iterdir() if os.access(path, os.X_OK) and path.is_file())
        self.assertGreater(len(tools), 5)
        for tool in tools:
            with self.subTest(tool.name):
                self.assertIn("usage: ", self.must_run(tool, "--help"))

    def test_a_program_reads_a_superelement_by_find_package(self):
        # The sources are out of reach: only what is installed can be found.
        source, build = self.folder / "consumer", self.folder / "consumer_build"
        shutil.copytree(HERE / "consumer", source)
        flags = os.environ["SPRUNG_CXX_FLAGS"]
        self.must_run(
            os.environ["SPRUNG_CMAKE"], "-S", source, "-B", build, "-G", "Ninja",
            f"-DCMAKE_PREFIX_PATH={self.installed}", f"-DCMAKE_CXX_FLAGS={flags}",
        )  # fmt: skip
        self.must_run(os.environ["SPRUNG_CMAKE"], "--build", build)
        printed = self.must_run(build / "consumer", self.folder / "bodies/chassis.h5")
        # The first clamped frequency of the truck's chassis: 6.11 Hz by [Kim, Shabana & Haug 1983], section 4, twice.
        name, first, second, *_ = printed.split()
        self.assertEqual(name, "chassis")
        self.assertAlmostEqual(float(first), 6.11, delta=0.01)
        self.assertAlmostEqual(float(second), 6.11, delta=0.01)

    def test_the_texts_that_installed_ones_refer_to_are_installed(self):
        links = [
            (text, link)
            for text in self.share.rglob("*.md")
            for link in re.findall(r"\]\(([^():\s]+\.md)[)#]", text.read_text(encoding="utf-8"))
            if "tests/" not in link
        ]
        self.assertGreater(len(links), 100)
        missing = [f"{text}: {link}" for text, link in links if not (text.parent / link).exists()]
        self.assertEqual(missing, [])

    def test_nothing_installed_names_the_folders_of_the_build(self):
        for path in (self.installed / "lib").rglob("*.cmake"):
            self.assertNotIn(str(ROOT), path.read_text(encoding="utf-8"), path)


if __name__ == "__main__":
    unittest.main()
