"""Common parts of all commands: the form of their help, their outputs, and their exit codes."""

import argparse
import io
import os
import signal
import sys
from collections.abc import Callable
from typing import NoReturn, TextIO

from sprung_tools.files.errors import InputError


class Parser(argparse.ArgumentParser):
    """A parser that says which option has taken the files for values of its own."""

    def error(self, message: str) -> NoReturn:
        greedy = [one for action in self._actions if action.nargs in ("+", "*") for one in action.option_strings]
        taken = [one for one in greedy if one in sys.argv[1:]]
        if "required" in message and taken:
            message += f"; {', '.join(taken)} takes all values behind it: put the files first, or -- before them"
        super().error(message)


def make_parser(description: str | None, example: str) -> argparse.ArgumentParser:
    """Makes a parser whose help ends in an example."""
    return Parser(
        description=description,
        epilog=f"Example:\n  {example}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )


def open_outputs() -> None:
    """Puts /dev/null in place of stdin, stdout and stderr where they are closed, so that no file takes their numbers.
    Exits with code 2 if stdout is one of them."""
    closed = set()
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
        closed.add(number)
    os.close(number)
    if 2 in closed:
        sys.stderr = open(2, "w", encoding="utf-8", closefd=False)
    if 1 in closed:
        complain(f"{sys.argv[0]}: error: standard output is closed")
        sys.exit(2)


def complain(text: object) -> None:
    """Prints a line on stderr. Where stderr is full or nobody reads it, the exit code has to tell."""
    try:
        print(text, file=sys.stderr, flush=True)
    except OSError:
        discard_output(sys.stderr)


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
        complain(error)
        code = 2
    except BrokenPipeError:  # whoever read our output (head, less) has left
        discard_output(sys.stdout)
        code = 0
    except OSError as error:
        if error.strerror is None:
            raise
        if error.filename is None:  # a full disk, where our output goes
            discard_output(sys.stdout)
        complain(f"{error.filename or sys.argv[0]}: error: {error.strerror}")
        code = 2
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # the shell and a parent may both send it
        complain("interrupted")
        code = 130
    finally:
        flush_errors()
    sys.exit(code)


def flush_errors() -> None:
    """Writes what argparse has printed on stderr. Where that is full, Python would end with a code of its own."""
    try:
        sys.stderr.flush()
    except OSError:
        discard_output(sys.stderr)


def discard_output(stream: TextIO) -> None:
    """Leaves out the output that is not yet written, so that Python does not try again at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
