"""Every tool: bash can read it, --help explains it with an example, arguments it does not know are refused."""

import os
import re
import sys
import unittest

from commands import BASH, COMMANDS, PYTHON, list_programs
from synthetic_results import write_results, write_superelement
from tool_test_case import ROOT, TOOLS, ToolTestCase, run_program


class Scripts(ToolTestCase):
    def test_every_program_in_the_folder_is_in_the_list_of_commands(self):
        self.assertEqual(list_programs(), set(COMMANDS))

    def test_every_command_is_in_the_readme_and_installed_unless_it_serves_the_sources(self):
        readme = (TOOLS / "README.md").read_text(encoding="utf-8")
        cells = [line.split(" | ")[0] for line in readme.partition("| command |")[2].partition("\n\n")[0].splitlines()]
        self.assertEqual({name for cell in cells for name in re.findall(r"`([\w.-]+)", cell)}, set(COMMANDS))
        install = (TOOLS / "cmake/sprung_install.cmake").read_text(encoding="utf-8")
        installed = re.search(r"foreach\(tool ([^)]*)\)", install)[1].split()
        self.assertEqual(set(installed), {name for name, one in COMMANDS.items() if one.is_installed})

    def test_bash_can_read_the_scripts(self):
        for path in (*(TOOLS / name for name in BASH), ROOT / ".ci/run"):
            with self.subTest(path.name):
                self.assert_succeeds(run_program(["bash", "-n", path]))
                self.assertTrue(os.access(path, os.X_OK))

    def test_help_shows_the_usage_and_an_example_that_calls_the_tool(self):
        for name in (*BASH, *PYTHON):
            with self.subTest(name):
                process = self.run_tool(name, "--help")
                self.assert_succeeds(process)
                self.assertRegex(process.stdout, r"(?i)\Ausage: ")
                self.assertRegex(process.stdout, rf"(?s)Examples?:\n.*  tools/{name}\b")

    def test_a_character_set_without_the_lines_of_a_table_gives_question_marks(self):
        write_superelement(self.folder / "a.h5", "arm", [6.112])
        process = self.run_tool("compare_frequencies", "a.h5", "--printed", "6.11", PYTHONIOENCODING="latin-1:strict")
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        self.assertRegex(process.stdout, r"(?m)^\?{4}  \?{4}  .*\narm +1 +6\.11200 +6\.11 ")

    def test_unknown_arguments_are_refused_with_exit_code_2(self):
        for name in ("setup", "run-truck", *PYTHON):
            with self.subTest(name):
                process = self.run_tool(name, "--nonsense")
                self.assertEqual(process.returncode, 2)
                self.assertIn("error: ", process.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_no_file_that_is_read_is_replaced(self):
        write_results(self.folder / "run.png", num_modes=2)
        write_superelement(self.folder / "arm.pvd", "arm", [6.112])
        (self.folder / "link").symlink_to("run.png")
        for name in ("sums.json", "run.toml"):
            (self.folder / name).touch()
        show = ("--show", "bodies/chassis/position.y")
        for name, output, *arguments in (
            ("plot_results", "run.png", "a=run.png", *show),
            ("plot_results", "link", "run.png", *show),
            ("plot_response", "run.png", "run.png", *show),
            ("plot_modes", "run.png", "run.png"),
            ("plot_modes", "run.png", "--over-time", "run.png"),
            ("plot_sensitivity", "sums.json", "sums.json"),
            ("export_paraview", "arm.pvd", "arm.pvd"),
            ("export_csv", "run.png", "run.png", *show),
            ("fatigue", "run.png", "run.png", "--category", "71"),
            ("ride_limits", "run.toml", "run.toml", "--point", "a.b"),
            ("report", "run.png", "run.png"),
        ):
            with self.subTest(name):
                before = (self.folder / output).read_bytes()
                process = self.run_tool(name, *arguments, "-o", output)
                self.assert_refuses(process, f"{output}: error: is one of the input files, which the output would")
                self.assertEqual((self.folder / output).read_bytes(), before)
        process = self.run_tool("fatigue", "run.png", "--category", "71", "-o", "f.png", "--histories", "f.png")
        self.assert_refuses(process, "f.png: error: is the name of the picture, too")

    def test_a_closed_output_is_refused_in_one_line(self):
        for name in PYTHON:
            with self.subTest(name):
                process = run_program(["sh", "-c", f"'{TOOLS / name}' --help >&-"], cwd=self.folder)
                self.assert_refuses(process, f"tools/{name}: error: standard output is closed")
                process = run_program(["sh", "-c", f"'{TOOLS / name}' --help >&- 2>&-"], cwd=self.folder)
                self.assertEqual(process.returncode, 2)

    def test_a_module_that_is_missing_is_named_with_its_package(self):
        # A module in this folder comes before the system's one; a stand-in for matplotlib needs a second one.
        (self.folder / "frame.vtk").touch()
        for module, needed, tool, arguments in (
            ("h5py", "h5py", "report_peaks", ("--help",)),
            ("matplotlib", "matplotlib.pyplot", "plot_results", ("--help",)),
            ("meshio", "meshio", "convert_mesh", ("frame.vtk", "frame.msh")),
            ("numpy", "numpy", "make_road.py", ("--help",)),
            ("scipy", "scipy.optimize", "ride_limits", ("--help",)),
        ):
            with self.subTest(module):
                blocked = self.folder / module
                blocked.mkdir()
                text = f"raise ModuleNotFoundError('not here', name={needed!r})\n"
                (blocked / f"{module}.py").write_text(text, encoding="utf-8")
                process = self.run_tool(tool, *arguments, PYTHONPATH=str(blocked))
                self.assert_refuses(
                    process, f"tools/{tool}: error: Python's module {module} is not", f"python3-{module}"
                )

    def test_what_takes_long_to_load_is_loaded_where_it_is_needed(self):
        for tool, module in (("study", "scipy"), ("ride_limits", "scipy.signal")):
            code = f"import sys, sprung_tools.cli.{tool}; sys.exit('{module}' in sys.modules)"
            environment = {**os.environ, "PYTHONPATH": str(TOOLS)}
            self.assert_succeeds(run_program([sys.executable, "-c", code], env=environment))

    def test_another_python_earlier_in_the_path_is_not_taken(self):
        other = self.folder / "python3"
        other.write_text("#!/bin/sh\nexit 99\n", encoding="utf-8")
        other.chmod(0o755)
        for name in PYTHON:
            with self.subTest(name):
                process = self.run_tool(name, "--help", PATH=f"{self.folder}:{os.environ['PATH']}")
                self.assertEqual((process.returncode, process.stderr), (0, ""))

    def test_a_folder_that_cannot_be_made_is_named(self):
        (self.folder / "programs").mkdir()
        for program in ("reduce/sprung-reduce", "dynamics/sprung-dynamics"):
            path = self.folder / "programs" / program
            path.parent.mkdir()
            path.write_text("#!/bin/sh\nexit 1\n", encoding="utf-8")
            path.chmod(0o755)
        (self.folder / "taken").write_text("a file", encoding="utf-8")
        process = self.run_tool("paper_figures", "--programs", "programs", "--output-dir", "taken")
        self.assert_refuses(process, "taken: error: File exists")

    def test_an_interrupted_tool_says_so_in_a_line(self):
        code = (
            "from sprung_tools.terminal.program import run_tool\n"
            "def main():\n    raise KeyboardInterrupt\n"
            "run_tool(main)"
        )
        process = run_program([sys.executable, "-c", code], cwd=TOOLS)
        self.assertEqual((process.returncode, process.stdout, process.stderr), (130, "", "interrupted\n"))


if __name__ == "__main__":
    unittest.main()
