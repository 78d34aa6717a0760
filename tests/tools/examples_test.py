"""The examples in every tool's --help: each runs as it stands there, in a folder that holds the files it names.
The design in reduce/README.md. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS); run-truck's example is in
run_truck_test.py."""

import os
import shlex
import shutil
import unittest

from commands import COMMANDS
from tool_test_case import ROOT, TOOLS, ToolTestCase, make_class_folder, run_program

TRUCK = ROOT / "dynamics/models/truck"
# What the examples read, and what each leaves behind.
RUNS = {
    "bump_rigid": ("bump", 0),
    "bump_2modes": ("bump", 2),
    "terrain_rigid": ("terrain", 0),
    "terrain_2modes": ("terrain", 2),
}
ADAPTIVE = "bump_adaptive"  # from 2 modes over the bump
RESPONSES = {"rigid": 0, "modes": 4}
WRITTEN = {
    "plot_results": ("bump.png",), "report_peaks": (), "compare_frequencies": (), "ride": (),
    "convert_mesh": ("chassis.msh", "frame.msh"), "make_road.py": ("terrain.txt", "class_c.txt"),
    "export_csv": ("bump.csv",), "report": ("report.html",), "export_paraview": ("modes.pvd", "bump.pvd"),
    "plot_response": ("response.png",),
    "plot_modes": ("choice.png", "bump_modes.png"),
    "plot_sensitivity": ("first.png", "all.png"), "fatigue": ("fatigue.png",),
    "ride_limits": ("limits.png",),
    "study": ("quarter_car_study/table.csv", "quarter_car_study/table.h5", "quarter_car_study/study.html"),
}  # fmt: skip
SCRIPTS = ("setup", "build", "test")
BUILT, TESTED = ["cmake", "cmake"], ["cmake", "cmake", "ctest"]


def read_examples(text):
    """The commands under "Example:" at the end of a --help text, as lists of words."""
    _, _, examples = text.replace("Examples:", "Example:").rpartition("Example:\n")
    return [shlex.split(line, comments=True) for line in examples.replace("\\\n", " ").splitlines() if line.strip()]


class Examples(ToolTestCase):
    def examples_of(self, tool):
        examples = read_examples(self.run_tool(tool, "--help").stdout)
        self.assertGreater(len(examples), 0)
        for words in examples:
            self.assertEqual(words[0], f"tools/{tool}")
        return examples


class PythonTools(Examples):
    @classmethod
    def setUpClass(cls):
        cls.made = make_class_folder(cls)
        superelements = cls.made / "build/truck"
        designs = sorted((ROOT / "meshes/truck").glob("*.toml"))
        run_program([os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", superelements], check=True)
        for name, (run, modes) in {**RUNS, ADAPTIVE: ("bump", 2)}.items():
            settings = (f"modes.chassis={modes}", f"adaptivity.enabled={str(name == ADAPTIVE).lower()}")
            cls.drive("run", run, name, *settings)
        for name, modes in RESPONSES.items():
            cls.drive("response", "terrain", name, f"modes.chassis={modes}")
        cls.drive("select-modes", "terrain", "choice", 'modes.chassis="auto"')
        command = [os.environ["SPRUNG_REDUCE"], "sensitivity", ROOT / "meshes/truck/chassis.toml", "--json"]
        (cls.made / "chassis.json").write_text(run_program(command, check=True).stdout, encoding="utf-8")
        shutil.copy(superelements / "chassis.h5", cls.made)
        shutil.copy(ROOT / "meshes/truck/chassis.inp", cls.made)
        for models in ("examples", "truck"):
            shutil.copytree(ROOT / "dynamics/models" / models, cls.made / "dynamics/models" / models)
        shutil.copy(ROOT / "tests/tools/data/portal.bdf", cls.made / "frame.bdf")

    @classmethod
    def drive(cls, verb, run, name, *settings):
        """Has sprung-dynamics do something with a run file; what it writes is NAME.h5."""
        command = [os.environ["SPRUNG_DYNAMICS"], verb, TRUCK / f"{run}.toml", "-o", cls.made / f"{name}.h5", "--quiet"]
        command += ["--superelements", cls.made / "build/truck"]
        run_program(command + [word for one in settings for word in ("--set", one)], check=True)

    def test_each_runs_and_leaves_its_files(self):
        for tool, files in WRITTEN.items():
            with self.subTest(tool):
                folder = self.folder / tool
                folder.mkdir()
                for path in self.made.iterdir():
                    (folder / path.name).symlink_to(path)
                for words in self.examples_of(tool):
                    process = run_program([TOOLS / tool, *words[1:]], cwd=folder)
                    self.assert_succeeds(process)
                for name in files:
                    self.assertGreater((folder / name).stat().st_size, 100)

    def test_the_report_of_the_paper_is_asked_for_as_its_example_says(self):
        """Its runs take minutes: here with a program that fails, so that the arguments alone are taken."""
        (words,) = self.examples_of("paper_figures")
        stand_in = self.folder / "programs"
        for name in ("reduce/sprung-reduce", "dynamics/sprung-dynamics"):
            (stand_in / name).parent.mkdir(parents=True, exist_ok=True)
            (stand_in / name).write_text("#!/bin/sh\necho told to stop >&2\nexit 3\n", encoding="utf-8")
            (stand_in / name).chmod(0o755)
        arguments = [str(self.folder / "paper") if word == "/tmp/paper" else word for word in words[1:]]
        process = self.run_tool("paper_figures", *arguments, "--programs", stand_in)
        self.assertEqual(process.returncode, 2)
        self.assertIn("told to stop", process.stderr)


class BashTools(Examples):
    """With stand-ins for the package manager, cmake and ctest, which write down how they were called."""

    def test_each_runs(self):
        shutil.copytree(TOOLS, self.folder / "tools", ignore=shutil.ignore_patterns("__pycache__", "support"))
        programs, log = self.folder / "bin", self.folder / "log"
        programs.mkdir()
        answers = {
            "dpkg-query": "echo -n installed",
            "apt-get": "exit 1",
            "chromium": "true",
            "cmake": "true",
            "ctest": "true",
        }
        for name, answer in answers.items():
            call = "" if name == "dpkg-query" else f'echo "{name} $*" >>"{log}"\n'
            (programs / name).write_text(f"#!/bin/bash\n{call}{answer}\n", encoding="utf-8")
            (programs / name).chmod(0o755)
        environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
        for tool in SCRIPTS:
            for words in self.examples_of(tool):
                with self.subTest(" ".join(words)):
                    log.write_text("", encoding="utf-8")
                    process = run_program(words, cwd=self.folder, env=environment)
                    self.assertEqual((process.returncode, process.stderr), (0, ""))
                    calls = log.read_text(encoding="utf-8").splitlines()
                    expected = {"setup": [], "build": BUILT, "test": TESTED}[tool]
                    if words == ["tools/test"]:  # the debug build first
                        expected = TESTED + TESTED
                        self.assertIn("--preset debug", calls[0])
                        self.assertIn("-R ^(fem_test|dynamics_measured_test)$", calls[2])
                    self.assertEqual([call.split()[0] for call in calls], expected)
                    if tool != "setup":
                        given = [word for word in words[1:] if word != "--sanitize"]
                        self.assertTrue(calls[-1].endswith(" ".join(given)), calls[-1])
                        self.assertEqual("--preset asan" in calls[-1], "--sanitize" in words, calls[-1])


class Design(ToolTestCase):
    def test_the_design_in_the_readme_gives_the_frame_that_it_says(self):
        text = (ROOT / "reduce/README.md").read_text(encoding="utf-8")
        said, _, rest = text.partition("```toml\n")
        (self.folder / "frame.toml").write_text(rest.partition("```\n")[0], encoding="utf-8")
        printed = run_program([os.environ["SPRUNG_REDUCE"], "build", "frame.toml"], cwd=self.folder, check=True).stdout
        self.assertIn("1 free mode from 34.3", printed)
        self.assertIn("5 residual vectors", printed)
        self.assertIn("interface flexibility within 0.14 % up to 60 Hz (proved, of this mesh)", printed)
        self.assertRegex(said, r"one\s+free\s+mode \(34\.3 Hz\) and\s+five\s+residual vectors,[^.]*0\.14 %")


class Completeness(ToolTestCase):
    def test_every_command_is_here(self):
        self.assertEqual(set(COMMANDS), {*WRITTEN, *SCRIPTS, "paper_figures", "run-truck", "benchmark", "fuzz"})


if __name__ == "__main__":
    unittest.main()
