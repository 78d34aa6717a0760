"""A study that is interrupted, killed or damaged keeps its rows and goes on where it was."""

import json
import os
import select
import signal
import subprocess
import unittest
from pathlib import Path

from study_case import DYNAMICS, HEIGHT, REDUCE, StudyCase
from tool_test_case import ROOT, TOOLS

from sprung_tools.programs.in_process import load_module


class Interruption(StudyCase):
    """With a stand-in that runs the program, writes down each call, and at the third height of the bump stays for ever
    while a file called hold is there."""

    def setUp(self):
        super().setUp()
        settings = 'measures = ["program/steps"]\nset.duration = 0.5\n'
        self.write_study(f"{settings}{HEIGHT}values = [0.01, 0.02, 0.03, 0.04]")
        os.mkfifo(self.folder / "arrived")
        stand_in = self.folder / "stand_in"
        stand_in.write_text(
            '#!/bin/bash\n[[ "$*" == *--dry-run* ]] && exit 0\n'
            f'echo "$*" >>"{self.folder}/calls"\n'
            f'if [[ "$*" == *height=0.03* && -e "{self.folder}/hold" ]]; then\n'
            f'  echo $$ >"{self.folder}/arrived"\n  exec sleep infinity\nfi\nexec "{DYNAMICS}" "$@"\n',
            encoding="utf-8",
        )
        stand_in.chmod(0o755)
        self.environment = {"SPRUNG_DYNAMICS": str(stand_in)}

    def start_and_wait(self):
        """Starts the study. Returns its process and a file descriptor of the program that holds it up."""
        (self.folder / "hold").touch()
        process = subprocess.Popen(
            [TOOLS / "study", "study.toml", "-o", "out", "--jobs", "1"], cwd=self.folder, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, encoding="utf-8", env={**os.environ, **self.environment},
            start_new_session=True,
        )  # fmt: skip
        held = int((self.folder / "arrived").read_text(encoding="utf-8"))  # waits for the program
        return process, os.pidfd_open(held)

    def wait_for_end(self, held):
        select.select([held], [], [])  # of a process that has ended
        os.close(held)

    def check_that_it_goes_on(self):
        calls = (self.folder / "calls").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(calls), 3)
        (self.folder / "hold").unlink()
        process = self.study(**self.environment)
        self.assert_succeeds(process)
        self.assertIn("4 runs: 2 made, 2 kept from before, 0 failed", process.stdout)
        more = (self.folder / "calls").read_text(encoding="utf-8").splitlines()[3:]
        self.assertEqual(sorted(line.split("road.height=")[1] for line in more), ["0.03", "0.04"])
        interrupted = (self.folder / "out/table.csv").read_bytes()
        self.assert_succeeds(self.run_tool("study", "study.toml", "-o", "whole", **self.environment))
        self.assertEqual(interrupted, (self.folder / "whole/table.csv").read_bytes())
        self.assertFalse((self.folder / "out/under_way").exists())

    def test_a_study_that_is_killed_keeps_its_rows_ends_its_programs_and_goes_on(self):
        process, held = self.start_and_wait()
        process.kill()
        process.communicate()
        self.wait_for_end(held)
        self.check_that_it_goes_on()

    def test_an_interrupted_study_says_so_and_goes_on(self):
        process, held = self.start_and_wait()
        for _ in range(5):  # as a terminal does, to all processes, for a user without patience
            os.killpg(process.pid, signal.SIGINT)
        _, complaints = process.communicate()
        self.assertEqual(process.returncode, 130)
        self.assertIn("out: the runs that have ended are kept; the same command goes on", complaints)
        self.assertTrue(complaints.endswith("interrupted\n"), complaints)
        self.assertNotIn("Traceback", complaints)
        self.wait_for_end(held)
        self.check_that_it_goes_on()

    def test_a_program_that_is_killed_is_a_failed_row(self):
        process, held = self.start_and_wait()
        signal.pidfd_send_signal(held, signal.SIGKILL)
        process.communicate()
        self.wait_for_end(held)
        self.assertEqual(process.returncode, 0)
        errors = [(row["exit_code"], row["error"]) for row in self.read_table()]
        self.assertEqual(errors, [("0", ""), ("0", ""), ("-9", "ended by SIGKILL"), ("0", "")])

    def test_a_row_that_was_cut_off_is_made_again(self):
        self.assert_succeeds(self.study("--jobs", "1", **self.environment))
        rows = self.folder / "out/rows.jsonl"
        whole = rows.read_bytes()
        rows.write_bytes(whole[:-20])
        self.assertIn("4 runs: 1 made, 3 kept from before", self.study(**self.environment).stdout)
        self.assertIn("4 runs: 0 made, 4 kept from before", self.study(**self.environment).stdout)

    def test_a_second_study_in_the_same_folder_is_refused_meanwhile(self):
        process, held = self.start_and_wait()
        self.assert_refuses(self.study(**self.environment), "out/rows.jsonl: error: another study is at work")
        process.kill()
        process.communicate()
        self.wait_for_end(held)


class FullDisk(StudyCase):
    """With a stand-in for a program that reports a full disk while a file called full is there."""

    FAULT = "results.h5: error: dataset '/time' cannot be written: No space left on device"

    def write_stand_in(self, program, case):
        stand_in = self.folder / "stand_in"
        stand_in.write_text(
            f'#!/bin/bash\nif [[ "$*" == {case} && -e "{self.folder}/full" ]]; then\n'
            f'  echo "{self.FAULT}" >&2\n  exit 2\nfi\nexec "{program}" "$@"\n',
            encoding="utf-8",
        )
        stand_in.chmod(0o755)
        (self.folder / "full").touch()
        return str(stand_in)

    def test_a_run_for_which_the_disk_has_no_space_ends_the_study_and_is_no_row(self):
        environment = {"SPRUNG_DYNAMICS": self.write_stand_in(DYNAMICS, "*height=0.02*")}
        settings = 'measures = ["program/steps"]\nset.duration = 0.5\n'
        self.write_study(f"{settings}{HEIGHT}values = [0.01, 0.02]")
        process = self.study("--jobs", "1", **environment)
        self.assert_refuses(process, f"out/rows.jsonl: error: a run could not be made; then the same command goes on "
                                     f"({self.FAULT})")  # fmt: skip
        rows = self.folder / "out/rows.jsonl"
        self.assertEqual(len(rows.read_text(encoding="utf-8").splitlines()), 1)
        (self.folder / "full").unlink()
        self.assertIn("2 runs: 1 made, 1 kept from before, 0 failed", self.study(**environment).stdout)
        # A row of such a failure, as earlier versions kept it, does not count.
        kept = [json.loads(line) for line in rows.read_text(encoding="utf-8").splitlines()]
        lines = (json.dumps({**row, "exit_code": 2, "error": self.FAULT, "measures": {}}) + "\n" for row in kept)
        rows.write_text("".join(lines), encoding="utf-8")
        self.assertIn("2 runs: 2 made, 0 kept from before, 0 failed", self.study(**environment).stdout)

    def test_a_design_for_which_the_disk_has_no_space_ends_the_study(self):
        models = ROOT / "tests/verification/models"
        environment = {"SPRUNG_REDUCE": self.write_stand_in(REDUCE, "build*")}
        self.write_study(
            f'command = "modes"\ndesigns = ["{models / "beam_inside.toml"}"]\n'
            'measures = ["program/modes/2/undamped_frequency"]\n[[parameters]]\nname = "modulus"\n'
            'key = "design.beam_inside.materials.steel.youngs_modulus"\nvalues = [1e11, 2e11]\n',
            run=models / "pinned_beam_run.toml",
        )
        self.assert_refuses(self.study(**environment), self.FAULT)
        self.assertEqual((self.folder / "out/rows.jsonl").read_text(encoding="utf-8"), "")
        (self.folder / "full").unlink()
        self.assert_succeeds(self.study(**environment))


@unittest.skipUnless(load_module(Path(DYNAMICS)).call, "the module for Python is not built")
class InterruptionInOneProcess(Interruption):
    """The same where the runs are made in a kept process, by a stand-in for the module."""

    def setUp(self):
        super().setUp()
        (self.folder / "sprung_dynamics.py").write_text(
            f"""import os, signal
from pathlib import Path
from sprung_tools.programs.in_process import load_module

def call(arguments):
    words = b" ".join(arguments).decode()
    with open("{self.folder}/calls", "a") as calls:
        calls.write(words + "\\n")
    if "height=0.03" in words and os.path.exists("{self.folder}/hold"):
        with open("{self.folder}/arrived", "w") as arrived:
            arrived.write(str(os.getpid()))
        while True:
            signal.pause()
    return load_module(Path("{DYNAMICS}")).call(arguments)
""",
            encoding="utf-8",
        )

    def test_the_rows_are_those_of_the_program(self):
        settings = 'measures = ["program/steps", "points/sprung.origin/wk_rms", "summary/energy_closure"]\n'
        self.write_study(f"{settings}set.duration = 1.0\n{HEIGHT}values = [0.01, 0.02, -1e3, 0.04]")
        self.assert_succeeds(self.run_tool("study", "study.toml", "-o", "here", "--keep-results"))
        self.assert_succeeds(
            self.run_tool("study", "study.toml", "-o", "program", "--keep-results", SPRUNG_PROCESSES="1")
        )
        for name in ("table.csv", "table.h5", "study.html"):
            self.assertEqual((self.folder / "here" / name).read_bytes(), (self.folder / "program" / name).read_bytes())
        files = sorted(path.name for path in (self.folder / "here/results").iterdir())
        self.assertEqual(files, sorted(path.name for path in (self.folder / "program/results").iterdir()))
        self.assertGreater(len(files), 2)
        for name in files:
            self.assertEqual(*((self.folder / one / "results" / name).read_bytes() for one in ("here", "program")))


if __name__ == "__main__":
    unittest.main()
