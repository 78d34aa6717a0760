"""Reading a mesh file by meshio in a process of its own, with limits of memory and processor time.

The many readers of meshio trust the numbers in a file: a damaged one may ask for any amount of memory, or for no end.
"""

import contextlib
import io
import multiprocessing
import os
import resource
from multiprocessing.connection import Connection
from typing import Any

import meshio
from meshio.gmsh import _gmsh41

from sprung_tools.files.errors import InputError

# What reading may take beyond what the process has at its start, and for each byte of the file.
MEMORY, MEMORY_PER_BYTE = 1 << 30, 200  # bytes
SECONDS, SECONDS_PER_BYTE = 20.0, 1e-6


def run_meshio(path: str, file_format: str | None) -> meshio.Mesh:
    """Reads a mesh file. InputError if meshio cannot, or takes more than the limits."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=read_and_send, args=(path, file_format, sender))
    process.start()
    sender.close()
    try:
        answer = receiver.recv()
    except EOFError:
        answer = "it took more memory or time than a whole file of this size needs"
    finally:
        receiver.close()
        process.join()
    if isinstance(answer, str):
        raise InputError(f"{path}: error: meshio {meshio.__version__} cannot read it: {answer}")
    return answer


def read_and_send(path: str, file_format: str | None, sender: Connection) -> None:
    """Sends the mesh, or the text of the error. Runs in the child process."""
    size = os.path.getsize(path)
    with open("/proc/self/statm", encoding="ascii") as file:
        now = int(file.read().split()[0]) * resource.getpagesize()
    limit(resource.RLIMIT_AS, now + MEMORY + MEMORY_PER_BYTE * size)
    limit(resource.RLIMIT_CPU, round(SECONDS + SECONDS_PER_BYTE * size))
    said = io.StringIO()
    answer: meshio.Mesh | str
    give_every_entity_a_group()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            answer = meshio.read(path, file_format=file_format)
    except SystemExit:  # meshio prints its errors and ends the program
        answer = " ".join(said.getvalue().split()).split("] ")[-1] or "SystemExit"
    except Exception as error:  # whatever its readers raise for a damaged file
        text = " ".join(said.getvalue().split()) or str(error) or type(error).__name__
        answer = f"{type(error).__name__}: {text}"
    with contextlib.suppress(MemoryError):
        sender.send(answer)


def give_every_entity_a_group() -> None:
    """Lets meshio read gmsh 4.1 files in which some entities are in no group: these get the group 0.

    It takes no group from an entity without one, and then refuses the file, because groups and elements differ in
    number. https://github.com/nschloe/meshio/blob/v5.0.0/src/meshio/gmsh/_gmsh41.py, `_read_elements`
    """
    read_entities = _gmsh41._read_entities

    def read_with_groups(*arguments: Any) -> tuple[Any, Any]:
        groups_of, bounding_entities = read_entities(*arguments)
        return [{tag: groups or [0] for tag, groups in one.items()} for one in groups_of], bounding_entities

    _gmsh41._read_entities = read_with_groups


def limit(what: int, most: int) -> None:
    """Sets a limit of this process, unless a lower one is already set."""
    hard = resource.getrlimit(what)[1]
    if hard == resource.RLIM_INFINITY or most < hard:
        resource.setrlimit(what, (most, most))
