"""The commands of sprung-dynamics inside a Python process do what the program does. Needs both programs (SPRUNG_REDUCE,
SPRUNG_DYNAMICS), and beside sprung-dynamics its module for Python."""

import json
import os
import re
import signal
import subprocess
import sys
import unittest
from pathlib import Path

from tool_test_case import ROOT, TOOLS, ToolTestCase, run_program

import sprung
from sprung_tools.programs.calls import call
from sprung_tools.programs.in_process import call_here, load_module
from sprung_tools.programs.kept_process import call_kept, processes

EXAMPLES = ROOT / "dynamics/models/examples"
CAR = EXAMPLES / "quarter_car_run.toml"
BEAM = ROOT / "tests/verification/models"
DYNAMICS = Path(os.environ["SPRUNG_DYNAMICS"])
TIMES = re.compile(r'"(elapsed|cpu_time|integration_cpu_time|real_time_factor)":[^,}]*')


def drop_times(outcome):
    """An outcome without what a clock said."""
    return outcome._replace(printed=TIMES.sub("", outcome.printed))


class Commands(ToolTestCase):
    def assert_same(self, *arguments):
        """The command does the same by the program, in this process and in a kept one. Returns its outcome."""
        command = [DYNAMICS, *arguments]
        outcome = drop_times(call(command))
        self.assertEqual(drop_times(call_here(command)), outcome)
        self.assertEqual(drop_times(call_kept(command)), outcome)
        return outcome

    def test_the_module_is_used(self):
        self.assertTrue(load_module(DYNAMICS).call, load_module(DYNAMICS).what)
        self.assertIn("in this process, by ", sprung.explain_calls())

    def test_each_command_prints_the_same_bytes_and_has_the_same_exit_code(self):
        self.assertEqual(self.assert_same("run", CAR, "--json", "--quiet").exit_code, 0)
        self.assertIn("freedoms", self.assert_same("run", CAR, "--dry-run").printed)
        for verb in ("equilibrium", "modes"):
            self.assertGreater(len(self.assert_same(verb, CAR).printed), 100)
            json.loads(self.assert_same(verb, CAR, "--json").printed)
        self.assertEqual(self.assert_same("response", CAR, "--json", "--set", "response.road.class=C").exit_code, 0)

    def test_remarks_go_to_the_same_stream(self):
        outcome = self.assert_same("run", CAR, "--dry-run", "--set", "vehicle.bodies.sprung.inertia=1e9")
        self.assertIn("remark: ", outcome.complaints)

    def test_help_version_and_wrong_command_lines_are_the_same(self):
        self.assertIn("Exit codes", self.assert_same("--help").printed)
        self.assertRegex(self.assert_same("--version").printed, r"^sprung-dynamics \d+\.\d+")
        for arguments in ((), ("fly",), ("run",), ("run", CAR, "--fast"), ("run", CAR, "-o", "")):
            outcome = self.assert_same(*arguments)
            self.assertEqual(outcome.exit_code, 2)
            self.assertNotEqual(outcome.complaints, "")

    def test_failures_are_the_same(self):
        self.assertEqual(self.assert_same("run", self.folder / "none.toml").exit_code, 2)
        self.assertEqual(self.assert_same("run", CAR, "--set", "sped=1.0").exit_code, 2)
        nothing = "vehicle.forces.suspension.spring={polynomial=[0.0, 0.0]}"  # bears the car
        self.assertEqual(self.assert_same("equilibrium", CAR, "--set", nothing).exit_code, 3)
        self.assertEqual(self.assert_same("run", CAR, "--json", "--quiet", "--set", "integrator.relative_tolerance=0.1",
                                          "--set", "integrator.method=generalized-alpha").exit_code, 1)  # fmt: skip

    def test_a_results_file_has_the_same_bytes(self):
        files = [self.folder / f"{name}.h5" for name in ("program", "here", "kept")]
        for file, do in zip(files, (call, call_here, call_kept)):
            command = [DYNAMICS, "run", CAR, "--json", "--quiet", "--set", "duration=1.0", "-o", file]
            self.assertEqual(do(command).exit_code, 0)
        self.assertEqual(files[0].read_bytes(), files[1].read_bytes())
        self.assertEqual(files[0].read_bytes(), files[2].read_bytes())

    def test_a_relative_path_is_that_of_the_folder_of_this_process(self):
        before = Path.cwd()
        os.chdir(CAR.parent)
        try:
            self.assertEqual(call_here([DYNAMICS, "modes", CAR.name, "--json"]).exit_code, 0)
        finally:
            os.chdir(before)

    def test_a_run_continues_from_a_file_that_is_open_and_may_replace_it(self):
        path = self.folder / "first.h5"
        with sprung.run(CAR, overrides={"duration": 0.5}, output=path) as first:
            settings = {"duration": 1.0, "continue_from": str(path)}
            with sprung.run(CAR, overrides=settings) as second:
                self.assertEqual((second.time[0], second.time[-1]), (0.5, 1.0))
            with sprung.run(CAR, overrides={"duration": 0.25}, output=path) as third:
                self.assertEqual(third.time[-1], 0.25)
            self.assertEqual(len(first["points/sprung.origin/acceleration.y"]), 501)  # of the file as it was

    def test_a_superelement_that_is_reduced_again_is_read_again(self):
        run = BEAM / "pinned_beam_run.toml"
        text = (BEAM / "beam_inside.toml").read_text(encoding="utf-8")
        softer = re.sub(r"youngs_modulus = [0-9.e]+", "youngs_modulus = 1.0e11", text)
        self.assertNotEqual(text, softer)
        design = self.folder / "beam_inside.toml"
        found = []
        for one in (text, softer, text):
            design.write_text(one, encoding="utf-8")
            sprung.build([design], self.folder)
            found.append([self.assert_same("modes", run, "--superelements", self.folder, "--json") for _ in range(2)])
        self.assertEqual(found[0][0], found[0][1])
        self.assertEqual(found[0], found[2])
        self.assertNotEqual(found[0][0].printed, found[1][0].printed)

    def test_the_memory_of_a_process_does_not_grow_with_the_number_of_runs(self):
        # After the first runs have filled the library's caches: less than one kilobyte for each run.
        code = (
            "import resource, sys\nfrom pathlib import Path\nfrom sprung_tools.programs.in_process import call_here\n"
            "run = [Path(sys.argv[1]), 'run', sys.argv[2], '--json', '--set', 'duration=0.02', '-o', 'r.h5']\n"
            "for number in range(1100):\n"
            "    assert call_here(run).exit_code == 0\n"
            "    if number in (99, 1099):\n"
            "        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)\n"
        )
        early, late = map(int, self.run_python(code, DYNAMICS, CAR).stdout.split())
        self.assertLess(late - early, 1000)

    def run_python(self, code, *arguments, **options):
        """Runs Python in self.folder with the package on its path."""
        environment = {**os.environ, "PYTHONPATH": str(TOOLS), **options}
        return run_program([sys.executable, "-c", code, *arguments], cwd=self.folder, env=environment, check=True)

    def test_without_its_module_the_program_is_started_and_the_package_says_why(self):
        code = "import sprung, sys\nprint(len(sprung.modes(sys.argv[1])), sprung.explain_calls())\n"
        found = self.run_python(code, CAR, SPRUNG_PROCESSES="1").stdout
        self.assertRegex(found, "^2 by processes of .*sprung-dynamics: SPRUNG_PROCESSES is set\n$")
        copy = self.folder / "bin/program"
        copy.parent.mkdir()
        copy.write_text(f'#!/bin/bash\nexec "{DYNAMICS}" "$@"\n', encoding="utf-8")
        copy.chmod(0o755)
        found = self.run_python(code, CAR, SPRUNG_DYNAMICS=str(copy)).stdout
        self.assertRegex(found, "^2 by processes of .*/bin/program: no module sprung_dynamics for this Python in ")
        (self.folder / "bin/sprung_dynamics.py").write_text("import nothing_of_this_name\n", encoding="utf-8")
        found = self.run_python(code, CAR, SPRUNG_DYNAMICS=str(copy)).stdout
        self.assertIn("sprung_dynamics.py: No module named 'nothing_of_this_name'", found)


class Interruption(ToolTestCase):
    """A run that waits for its run file, a pipe, until it has been interrupted."""

    CODE = (
        "import sprung, sys\n"
        "try:\n"
        "    sprung.run(sys.argv[1], overrides={'duration': 1e4, 'start': 'as-given'}, output='long.h5')\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted')\n"
        "print(len(sprung.modes(sys.argv[2])))\n"
    )

    def test_control_c_ends_the_run_with_its_partial_results_and_the_process_goes_on(self):
        text = CAR.read_text(encoding="utf-8").replace('"quarter_car.toml"', f'"{EXAMPLES}/quarter_car.toml"')
        run = self.folder / "run.toml"
        os.mkfifo(run)
        process = subprocess.Popen(
            [sys.executable, "-c", self.CODE, run, CAR], cwd=self.folder, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, encoding="utf-8", env={**os.environ, "PYTHONPATH": str(TOOLS)},
        )  # fmt: skip
        with open(run, "w", encoding="utf-8") as writer:  # waits until the run reads it
            process.send_signal(signal.SIGINT)
            writer.write(text)
        printed, complaints = process.communicate()
        self.assertEqual((printed, complaints, process.returncode), ("interrupted\n2\n", "", 0))
        self.assertTrue((self.folder / "long.partial.h5").exists())


class KeptProcess(ToolTestCase):
    def test_a_command_that_ends_its_process_costs_only_itself(self):
        stand_in = self.folder / "sprung-dynamics"
        stand_in.touch(mode=0o755)
        (self.folder / "sprung_dynamics.py").write_text(
            "import os, signal\n"
            "def call(arguments):\n"
            "    if arguments == [b'crash']:\n"
            "        os.kill(os.getpid(), signal.SIGSEGV)\n"
            "    if arguments == [b'leave']:\n"
            "        os._exit(5)\n"
            "    return 0, str(os.getpid()).encode(), b''\n",
            encoding="utf-8",
        )
        first, second = (call_kept([stand_in, "run"]) for _ in range(2))
        self.assertEqual(first, second)  # the same process
        crashed = call_kept([stand_in, "crash"])
        self.assertEqual((crashed.exit_code, crashed.error), (-signal.SIGSEGV, "ended by SIGSEGV"))
        third = call_kept([stand_in, "run"])
        self.assertEqual(third.exit_code, 0)
        self.assertNotEqual(third.printed, first.printed)
        left = call_kept([stand_in, "leave"])
        self.assertEqual((left.exit_code, left.error), (3, "its process ended with exit code 5"))
        self.assertEqual(call_kept([stand_in, "run"]).exit_code, 0)

    def test_a_process_that_was_killed_between_two_commands_is_replaced(self):
        command = [DYNAMICS, "modes", CAR, "--json"]
        before = call_kept(command)
        killed = processes()[0]
        os.kill(killed._process.pid, signal.SIGKILL)
        killed._process.join()
        self.assertEqual(call_kept(command), before)


if __name__ == "__main__":
    unittest.main()
