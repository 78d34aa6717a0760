"""What the tests of the tools share: a folder of their own, and running a tool as a user does."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools"
sys.path.insert(0, str(TOOLS))


class ToolTestCase(unittest.TestCase):
    """A test with an empty folder `self.folder` that is removed afterwards."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def run_tool(self, tool, *arguments, **options):
        """Runs tools/TOOL in self.folder. Returns the finished process with its output as text."""
        command = [str(TOOLS / tool), *map(str, arguments)]
        environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", **options}
        return subprocess.run(
            command,
            cwd=self.folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )

    def assert_refuses(self, process, *fragments):
        """Exit code 2, one line on stderr with all fragments, no Python traceback."""
        self.assertEqual(process.returncode, 2, process.stderr)
        self.assertEqual(len(process.stderr.strip().splitlines()), 1, process.stderr)
        for fragment in fragments:
            self.assertIn(fragment, process.stderr)
