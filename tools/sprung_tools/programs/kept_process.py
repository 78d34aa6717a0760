"""A process that is kept for many commands of sprung-dynamics. A command that ends the process costs only itself: the
next one gets a new process."""

import functools
import multiprocessing
import os
import signal
from collections.abc import Sequence
from multiprocessing.connection import Connection
from pathlib import Path

from sprung_tools.programs.calls import NO_CONVERGENCE, Outcome, call, end_with_parent
from sprung_tools.programs.in_process import call_here, load_module

_fork = multiprocessing.get_context("fork")


class KeptProcess:
    """The process, which ends with this one; this one must have one thread only."""

    def __init__(self) -> None:
        self._commands, theirs = _fork.Pipe()
        self._process = _fork.Process(target=serve, args=(theirs, self._commands), daemon=True)
        self._process.start()
        theirs.close()

    def call(self, command: Sequence[str | Path]) -> Outcome | None:
        """How a command ended; None if the process had ended before."""
        try:
            self._commands.send(command)
        except BrokenPipeError:
            return None
        try:
            return Outcome(*self._commands.recv())
        except (EOFError, ConnectionResetError):
            self._process.join()
            code = self._process.exitcode or 0
            return Outcome(code if code < 0 else NO_CONVERGENCE, "", f"its process ended with exit code {code}")

    def is_alive(self) -> bool:
        """Whether it can take a command."""
        return self._process.is_alive()


def serve(commands: Connection, others: Connection) -> None:
    """Does commands, one after the other, as long as there are any."""
    end_with_parent()
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    others.close()
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):  # what libraries say when they end the process
        os.dup2(nowhere, stream)
    while True:
        try:
            command = commands.recv()
        except EOFError:
            os._exit(0)
        commands.send(tuple(call_here(command)))


@functools.cache
def processes() -> list[KeptProcess]:
    """The kept process of this process, if it has one."""
    return []


def call_kept(command: Sequence[str | Path]) -> Outcome:
    """Does what a command line of sprung-dynamics says: in the kept process if there is a module, else in its own.

    Both end with this process, which must have one thread only."""
    if load_module(Path(command[0])).call is None:
        return call(command, is_tied=True)
    kept = processes()
    while True:
        if not kept:
            kept.append(KeptProcess())
        outcome = kept[0].call(command)
        if outcome is None or not kept[0].is_alive():
            kept.clear()
        if outcome is not None:
            return outcome
