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

    An InputError, or a file or folder that the system refuses, becomes a line on stderr and code 2; an interruption
    becomes code 130.
    """
    for stream in (sys.stdout, sys.stderr):
        # Where the terminal's character set lacks a letter, a question mark stands for it.
        if isinstance(stream, io.TextIOWrapper) and stream.encoding.lower() not in ("utf-8", "utf8"):
            stream.reconfigure(errors="replace")
    try:
        code = main()
        sys.stdout.flush()
    except InputError as error:
        print(error, file=sys.stderr)
        code = 2
    except BrokenPipeError:  # whoever read our output (head, less) has left
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 0
    except OSError as error:
        if error.filename is None:
            raise
        print(f"{error.filename}: error: {error.strerror}", file=sys.stderr)
        code = 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        code = 130
    sys.exit(code)
