"""How the programs in tools/ start: by the name of a command, whose modules may need packages that are not
installed."""

import importlib
import sys

from sprung_tools.terminal.program import run_tool

# The Debian package of each module that is not Python's own.
PACKAGES = {
    "h5py": "python3-h5py",
    "matplotlib": "python3-matplotlib",
    "meshio": "python3-meshio",
    "numpy": "python3-numpy",
}


def run_command(name: str) -> None:
    """Runs main() of sprung_tools/cli/NAME.py, and exits; where a module is missing, with a line on stderr and code
    2."""
    try:
        run_tool(importlib.import_module(f"sprung_tools.cli.{name}").main)
    except ModuleNotFoundError as error:
        module = (error.name or "").partition(".")[0]
        if module not in PACKAGES:
            raise
        print(
            f"{sys.argv[0]}: error: Python's module {module} is not installed: install the Debian package "
            f"{PACKAGES[module]}, or run tools/setup",
            file=sys.stderr,
        )
        sys.exit(2)
