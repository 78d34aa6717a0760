"""Running programs in the tests as a user does, in one environment wherever the tests run.

The import of this module fixes the environment of the test itself, which the programs that it starts inherit: language,
terminal, time zone and home folder are the same everywhere, and no setting of Python or Matplotlib comes from outside.
"""

import atexit
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

# Variables that change what programs print or where they look; those that begin with a prefix, and single ones.
PREFIXES = ("LC_", "PYTHON", "MATPLOTLIB", "MPL")
SINGLE = ("LANG", "LANGUAGE", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR", "CLICOLOR_FORCE", "SOURCE_DATE_EPOCH")
# What a Python tool may print on stderr if it takes long: its progress, and Matplotlib's first look at the fonts.
SIGNS_OF_LIFE = re.compile(
    r"[\w ]+: \d+ %, \d+ s left(, \d+ failed)?|Matplotlib is building the font cache; this may take a moment\."
)


def fix_environment():
    """Gives this process, and all that it starts, the environment described above."""
    for name in list(os.environ):
        if name.startswith(PREFIXES) and name != "MPLCONFIGDIR" or name in SINGLE:
            del os.environ[name]
    home = tempfile.TemporaryDirectory(prefix="sprung-home-")
    atexit.register(home.cleanup)
    # One folder for all tests of a user, so that the fonts are looked through once.
    fonts = os.path.join(tempfile.gettempdir(), f"sprung-matplotlib-{os.getuid()}")
    os.environ.setdefault("MPLCONFIGDIR", fonts)
    os.environ.update(LC_ALL="C.UTF-8", TERM="dumb", TZ="UTC", HOME=home.name, PYTHONDONTWRITEBYTECODE="1")


fix_environment()


def run_program(command, *, check=False, **options):
    """Runs a program with an empty input. Returns the finished process with its output as text.

    check: an AssertionError with all output if the exit code is not 0; options: of subprocess.run().
    """
    process = subprocess.run(
        [str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        encoding="utf-8", check=False, **options,
    )  # fmt: skip
    if check and process.returncode != 0:
        raise AssertionError(f"{process.args}: exit code {process.returncode}\n{process.stdout}{process.stderr}")
    return process


def find_complaints(stderr):
    """The lines of a tool's stderr, without the signs of life that depend on how fast the machine is."""
    return [line for line in stderr.splitlines() if not SIGNS_OF_LIFE.fullmatch(line)]


def make_class_folder(test_class):
    """An empty folder that is removed after the last test of a class."""
    temporary = tempfile.TemporaryDirectory()
    test_class.addClassCleanup(temporary.cleanup)
    return Path(temporary.name).resolve()  # the folder of temporary files may be a link


class ProgramTestCase(unittest.TestCase):
    """A test with an empty folder `self.folder` that is removed afterwards."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name).resolve()

    def assert_succeeds(self, process):
        """Exit code 0, and nothing on stderr but signs of life."""
        self.assertEqual((process.returncode, find_complaints(process.stderr)), (0, []), process.stdout)
