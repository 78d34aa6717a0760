"""What the tests of the tools share: the package on the path, and running a tool as a user does."""

import os
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools"
sys.path[:0] = [str(TOOLS), str(ROOT / "tests")]

# After the path is set; the tests take them from here.
from programs import ProgramTestCase, find_complaints, make_class_folder, run_program  # noqa: E402, F401


def list_git_files(*options):
    """The paths from the root of the files that `git ls-files` lists; none in a copy without git."""
    if not shutil.which("git"):
        return []
    listed = run_program(["git", "-c", "safe.directory=*", "ls-files", "-z", *options], cwd=ROOT).stdout
    return [Path(name) for name in listed.split("\0") if name]


class ToolTestCase(ProgramTestCase):
    """A test with an empty folder `self.folder`."""

    def run_tool(self, tool, *arguments, **environment):
        """Runs tools/TOOL in self.folder. Returns the finished process with its output as text."""
        return run_program([TOOLS / tool, *arguments], cwd=self.folder, env={**os.environ, **environment})

    def assert_refuses(self, process, *fragments):
        """Exit code 2, one line on stderr with all fragments, no Python traceback."""
        self.assertEqual(process.returncode, 2, process.stderr)
        complaints = find_complaints(process.stderr)
        self.assertEqual(len(complaints), 1, process.stderr)
        for fragment in fragments:
            self.assertIn(fragment, complaints[0])
