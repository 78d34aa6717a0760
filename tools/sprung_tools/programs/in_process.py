"""The commands of sprung-dynamics inside this process, by the module for Python that is built and installed with the
program. Where there is none, each command is a process of its own, with the same results."""

import functools
import os
from collections.abc import Callable, Sequence
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from pathlib import Path
from typing import NamedTuple

import h5py  # noqa: F401  # before the module, so that HDF5 closes h5py's files at exit

from sprung_tools.programs.calls import Outcome, call, list_words

MODULE = "sprung_dynamics"
PROCESSES = "SPRUNG_PROCESSES"  # in the environment, not empty: each command is a process all the same


class Module(NamedTuple):
    """The module of a program, or why it is not used. call: takes arguments, gives exit code, output and complaints;
    what: its file, or the reason."""

    call: Callable[[list[bytes]], tuple[int, bytes, bytes]] | None
    what: str


@functools.cache
def load_module(program: Path) -> Module:
    """Loads the module that belongs to a program: beside it, or in lib/sprung below the same prefix."""
    if os.environ.get(PROCESSES):
        return Module(None, f"{PROCESSES} is set")
    folders = [program.parent, program.parents[1] / "lib/sprung"]
    spec = PathFinder.find_spec(MODULE, [str(folder) for folder in folders])
    if spec is None or spec.loader is None or spec.origin is None:
        return Module(None, f"no module {MODULE} for this Python in {' or '.join(map(str, folders))}")
    try:
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
    except ImportError as error:
        return Module(None, f"{spec.origin}: {error}")
    return Module(module.call, spec.origin)


def call_here(command: Sequence[str | Path]) -> Outcome:
    """Does what a command line of sprung-dynamics says: in this process if its module is there, else in another."""
    program, *arguments = list_words(command)
    module = load_module(Path(program))
    if module.call is None:
        return call(command)
    code, printed, complaints = module.call([os.fsencode(word) for word in arguments])
    return Outcome(code, printed.decode(errors="replace"), complaints.decode(errors="replace"))
