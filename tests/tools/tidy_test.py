"""clang-tidy on the C++ of all rooms, with the checks of .clang-tidy; each finding is an error.

The sources of a room are read as the one unit that the usual build compiles: one by one they would take several times
as long, since each reads Eigen's headers anew. The checks are those of clang-tidy 14, the version of Debian 12. Other
versions find other things, so the check is skipped with them, and where rooms are not built as units."""

import json
import os
import re
import shlex
import shutil
import unittest
from pathlib import Path

from tool_test_case import ROOT, run_program

TIDY_VERSION = 14


def find_units(build):
    """The commands, as CMake lists them, that compile a room's unit."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if "/Unity/" in entry["file"] and not entry["file"].startswith(f"{build}/tests/"):
            yield entry


def options_for_clang(command):
    """Of gcc's arguments those that say what is compiled: definitions, folders of headers and the standard."""
    arguments = shlex.split(command)
    kept = [argument for argument in arguments if re.match(r"-D|-I|-std=", argument)]
    folders = [folder for flag, folder in zip(arguments, arguments[1:]) if flag == "-isystem"]
    return kept + [part for folder in folders for part in ("-isystem", folder)]


class Tidy(unittest.TestCase):
    def test_clang_tidy_finds_nothing(self):
        program = shutil.which("clang-tidy")
        self.assertIsNotNone(program, "clang-tidy is not installed: install the Debian package clang-tidy")
        version = int(re.search(r"version (\d+)", run_program([program, "--version"]).stdout)[1])
        if version != TIDY_VERSION:
            self.skipTest(f"clang-tidy {version} finds other things than version {TIDY_VERSION}")
        build = Path(os.environ["SPRUNG_BUILD"])
        units = list(find_units(build))
        if not units:
            self.skipTest("the rooms are not built as units")
        for unit in units:
            with self.subTest(unit=unit["file"]):
                command = [program, "--quiet", f"--config-file={ROOT / '.clang-tidy'}", unit["file"]]
                found = run_program([*command, "--", *options_for_clang(unit["command"])], cwd=unit["directory"])
                self.assertEqual(found.returncode, 0, f"{found.stdout}\n{found.stderr}")


if __name__ == "__main__":
    unittest.main()
