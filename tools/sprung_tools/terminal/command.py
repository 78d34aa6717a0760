"""Starting a command by its name, also where a package that it needs is not installed."""

import importlib
import os
import signal
import sys
from functools import partial
from types import FrameType, ModuleType
from typing import NoReturn

from sprung_tools.terminal.guarded_process import run_guarded
from sprung_tools.terminal.program import complain, open_outputs, run_tool

# The Debian package of each module that is not Python's own.
PACKAGES = {
    "h5py": "python3-h5py",
    "matplotlib": "python3-matplotlib",
    "meshio": "python3-meshio",
    "numpy": "python3-numpy",
    "scipy": "python3-scipy",
}


def run_command(name: str) -> NoReturn:
    """Runs main() of sprung_tools/cli/NAME.py in a process of its own, and exits."""
    open_outputs()
    run_guarded(partial(load_and_run, name))


def load_and_run(name: str) -> NoReturn:
    """Runs main() of sprung_tools/cli/NAME.py, and exits. If a module is missing, it prints a line on stderr and exits
    with code 2."""
    try:
        run_tool(import_interruptibly(f"sprung_tools.cli.{name}").main)
    except ModuleNotFoundError as error:
        module = (error.name or "").partition(".")[0]
        if module not in PACKAGES:
            raise
        complain(
            f"{sys.argv[0]}: error: Python's module {module} is not installed: install the Debian package "
            f"{PACKAGES[module]}, or run tools/setup"
        )
        sys.exit(2)


def import_interruptibly(name: str) -> ModuleType:
    """Imports a module. Ctrl-C meanwhile ends the process: raised within an import, it would become other errors."""
    previous = signal.getsignal(signal.SIGINT)
    if previous is signal.default_int_handler:
        signal.signal(signal.SIGINT, end_interrupted)
    module = importlib.import_module(name)
    signal.signal(signal.SIGINT, previous)
    return module


def end_interrupted(_number: int, _frame: FrameType | None) -> NoReturn:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    complain("interrupted")
    os._exit(130)
