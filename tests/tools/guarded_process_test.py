"""The process that a command runs in: its exit code gets through, and a fault in a library becomes a message."""

import signal
import subprocess
import sys
import unittest

from ride_results import write_ride_results
from tool_test_case import TOOLS, ToolTestCase, run_program

BEGIN = (
    "import os, signal, sys, time\nsys.path.insert(0, {tools!r})\n"
    "from sprung_tools.files.last_read import note_file\n"
)
END = "from sprung_tools.terminal.guarded_process import run_guarded\nrun_guarded(run)\n"


class Guarded(ToolTestCase):
    """Small programs in place of a command."""

    def start(self, body):
        """Starts a program whose run() has the body."""
        text = BEGIN.format(tools=str(TOOLS)) + "def run():\n" + "".join(f"    {line}\n" for line in body) + END
        command = [sys.executable, "-c", text]
        pipe = subprocess.PIPE
        return subprocess.Popen(command, cwd=self.folder, stdout=pipe, stderr=pipe, encoding="utf-8")

    def finish(self, process):
        """(exit code, stdout, stderr)"""
        out, error = process.communicate(timeout=60)
        return process.returncode, out, error

    def test_the_exit_code_and_the_output_get_through(self):
        self.assertEqual(self.finish(self.start(["print('done')", "sys.exit(3)"])), (3, "done\n", ""))

    def test_a_fault_while_a_file_is_read_names_the_file(self):
        for name in ("SIGSEGV", "SIGABRT"):
            with self.subTest(name):
                body = ["note_file('a.h5')", f"os.kill(os.getpid(), signal.{name})"]
                expected = f"a.h5: error: the file is damaged: HDF5 ended with {name}\n"
                self.assertEqual(self.finish(self.start(body)), (2, "", expected))

    def test_another_end_by_a_signal_stays_what_it_is(self):
        code, _, error = self.finish(self.start(["os.kill(os.getpid(), signal.SIGSEGV)"]))
        self.assertEqual((code, error), (-signal.SIGSEGV, ""))

    def test_an_interruption_from_outside_reaches_the_command(self):
        # Short sleeps: one that begins just after the signal's handler has run is not interrupted.
        body = ["try:", "    print('ready', flush=True)", "    for _ in range(2000):", "        time.sleep(0.05)"]
        body += ["except KeyboardInterrupt:"]
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, -signal.SIGTERM)):
            with self.subTest(number.name):
                process = self.start([*body, "    sys.exit(130)"])
                self.assertEqual(process.stdout.readline(), "ready\n")
                process.send_signal(number)
                self.assertEqual(self.finish(process)[0], code)

    def test_an_interruption_while_a_command_is_imported_ends_it_in_one_line(self):
        # As numpy does, it makes another error of one that is raised within it.
        lines = ("import os, signal", "try:", "    os.kill(os.getpid(), signal.SIGINT)")
        text = "\n".join([*lines, "except BaseException:", "    raise ImportError", ""])
        (self.folder / "interrupted_module.py").write_text(text)
        body = ["from sprung_tools.terminal.command import import_interruptibly", "sys.path.insert(0, '.')"]
        process = self.start([*body, "import_interruptibly('interrupted_module')"])
        self.assertEqual(self.finish(process), (130, "", "interrupted\n"))

    def test_a_full_disk_for_the_output_is_an_error_in_one_line(self):
        write_ride_results(self.folder / "a.h5")
        for arguments in (("ride", "--help"), ("ride", "a.h5")):
            with self.subTest(arguments), open("/dev/full", "w", encoding="utf-8") as full:
                process = subprocess.run([TOOLS / arguments[0], *arguments[1:]], cwd=self.folder, stdout=full,
                                         stderr=subprocess.PIPE, encoding="utf-8", check=False)  # fmt: skip
                self.assert_refuses(process, "ride: error: No space left on device")

    def test_errors_that_nobody_can_read_still_give_their_exit_code(self):
        write_ride_results(self.folder / "a.h5")
        for arguments, code in (("a.h5", 0), ("none.h5", 2), ("--nonsense", 2)):
            for closed in ("2>&-", "<&- 2>&-", "2>/dev/full"):
                with self.subTest(arguments, closed=closed):
                    process = run_program(["sh", "-c", f"'{TOOLS / 'ride'}' {arguments} {closed}"], cwd=self.folder)
                    self.assertEqual((process.returncode, bool(process.stdout)), (code, code == 0))


if __name__ == "__main__":
    unittest.main()
