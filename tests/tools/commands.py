"""The commands in tools/, for the tests that must not leave one out."""

import os
from typing import NamedTuple

from tool_test_case import TOOLS


class Command(NamedTuple):
    """reads: the kinds of files among "runs", "responses", "superelements" and "meshes"."""

    reads: tuple = ()
    is_bash: bool = False
    is_installed: bool = True


COMMANDS = {
    "setup": Command(is_bash=True, is_installed=False),
    "build": Command(is_bash=True, is_installed=False),
    "test": Command(is_bash=True, is_installed=False),
    "fuzz": Command(is_bash=True, is_installed=False),
    "run-truck": Command(is_bash=True, is_installed=False),
    "paper_figures": Command(is_installed=False),
    "benchmark": Command(is_installed=False),
    "plot_results": Command(("runs",)),
    "plot_response": Command(("responses",)),
    "plot_modes": Command(("runs",)),
    "plot_sensitivity": Command(),
    "report_peaks": Command(("runs",)),
    "compare_frequencies": Command(("superelements",)),
    "make_road.py": Command(),
    "ride": Command(("runs", "responses")),
    "fatigue": Command(("runs",)),
    "ride_limits": Command(),
    "study": Command(),
    "report": Command(("runs",)),
    "convert_mesh": Command(("meshes",)),
    "export_csv": Command(("runs",)),
    "export_paraview": Command(("runs", "superelements")),
}
BASH = tuple(name for name, command in COMMANDS.items() if command.is_bash)
PYTHON = tuple(name for name, command in COMMANDS.items() if not command.is_bash)


def list_programs():
    """The names of the programs in tools/."""
    return {path.name for path in TOOLS.iterdir() if path.is_file() and os.access(path, os.X_OK)}


def list_readers(kind=None):
    """The commands that read a kind of files, or any of them."""
    return {name for name, command in COMMANDS.items() if (kind in command.reads if kind else command.reads)}
