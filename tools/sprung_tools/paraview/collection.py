"""A PVD file, which lists VTU files, and the folder beside it that holds them; written whole or not at all."""

import os
import re
import shutil
from collections.abc import Callable, Sequence
from urllib.parse import quote

from sprung_tools.files.errors import InputError

LIST = "list.pvd"
OURS = re.compile(r"(mode|instant)_\d+\.vtu")  # the names of the files in the folder


def write_collection(path: str, entries: Sequence[tuple[float, str]]) -> None:
    """Writes the PVD file. entries: (time or mode number, name of the VTU file)."""
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">',
        "<Collection>",
    ]
    lines += [f'<DataSet timestep="{value:.9g}" part="0" file="{name}"/>' for value, name in entries]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([*lines, "</Collection>", "</VTKFile>", ""]))


def check_target(path: str, stem: str) -> None:
    """Throws InputError if there is no folder to write in, or if the folder of the files is there and is a link, or
    holds other files than this tool writes: the tool would remove them."""
    around = os.path.dirname(path)
    if around and not os.path.isdir(around):
        raise InputError(f"{path}: error: there is no folder '{around}'")
    if os.path.islink(stem):
        raise InputError(f"{path}: error: '{stem}' is a link, which the tool does not replace; choose another name")
    if not os.path.lexists(stem):
        return
    strange = [stem] if not os.path.isdir(stem) else [name for name in os.listdir(stem) if not OURS.fullmatch(name)]
    if strange:
        raise InputError(
            f"{path}: error: '{stem}' is there and is not of this tool (it holds {strange[0]}); choose another name"
        )


def write_folder(path: str, write_files: Callable[[str], list[tuple[float, str]]]) -> int:
    """Writes NAME.pvd and the folder NAME beside it, whole or not at all. InputError if they cannot be written.

    write_files: writes the VTU files into the folder that it is given, and returns what NAME.pvd lists, as
    write_collection() takes it. Returns the number of files.
    """
    stem = path.removesuffix(".pvd")
    check_target(path, stem)
    unfinished = os.path.join(os.path.dirname(stem), f".unfinished-{os.getpid()}-{os.path.basename(stem)}")
    try:
        os.mkdir(unfinished)
        entries = write_files(unfinished)
        folder = quote(os.path.basename(stem))
        write_collection(os.path.join(unfinished, LIST), [(value, f"{folder}/{name}") for value, name in entries])
        if os.path.lexists(stem):
            shutil.rmtree(stem)
        os.rename(unfinished, stem)
        os.replace(os.path.join(stem, LIST), path)
    except OSError as error:
        raise InputError(f"{path}: error: cannot write the files ({error.strerror or error})") from error
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return len(entries)
