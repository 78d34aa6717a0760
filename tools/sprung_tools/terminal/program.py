"""Common parts of all commands: the form of their help, and their exit codes."""

import argparse
import io
import os
import sys
from collections.abc import Callable
from typing import NoReturn

from sprung_tools.files.errors import InputError


def make_parser(description: str | None, example: str) -> argparse.ArgumentParser:
    """Makes a parser whose help ends in an example."""
    return argparse.ArgumentParser(
        description=description,
        epilog=f"Example:\n  {example}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )


def run_tool(main: Callable[[], int]) -> NoReturn:
    """Runs a command's main(), and exits with the code that it returns.

    An InputError, or a file, a folder or an output that the system refuses, becomes a line on stderr and code 2; an
    interruption becomes code 130.
    """
    for stream in (sys.stdout, sys.stderr):
        # Where the terminal's character set lacks a letter, a question mark stands for it.
        if isinstance(stream, io.TextIOWrapper) and stream.encoding.lower() not in ("utf-8", "utf8"):
            stream.reconfigure(errors="replace")
    try:
        try:
            code = main()
        finally:  # also after the help
            sys.stdout.flush()
    except InputError as error:
        print(error, file=sys.stderr)
        code = 2
    except BrokenPipeError:  # whoever read our output (head, less) has left
        discard_output()
        code = 0
    except OSError as error:
        if error.strerror is None:
            raise
        if error.filename is None:  # a full disk, where our output goes
            discard_output()
        print(f"{error.filename or sys.argv[0]}: error: {error.strerror}", file=sys.stderr)
        code = 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        code = 130
    sys.exit(code)


def discard_output() -> None:
    """Leaves out the output that is not yet written, so that Python does not try again at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
