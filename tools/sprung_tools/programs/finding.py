"""Where the two programs are: beside an installed package, in the build folder of the sources, or in the PATH."""

import os
import shutil
from pathlib import Path
from typing import NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.project import ROOT

REDUCE, DYNAMICS = "sprung-reduce", "sprung-dynamics"
# Where a program may lie below a folder: in a build folder, and where it is installed.
PLACES = {
    REDUCE: (f"reduce/{REDUCE}", f"bin/{REDUCE}", REDUCE),
    DYNAMICS: (f"dynamics/{DYNAMICS}", f"bin/{DYNAMICS}", DYNAMICS),
}
VARIABLES = {REDUCE: "SPRUNG_REDUCE", DYNAMICS: "SPRUNG_DYNAMICS"}  # name a program in the environment


class Programs(NamedTuple):
    """The paths of the two programs."""

    reduce: Path
    dynamics: Path


def find_programs(folder: str | Path | None = None) -> Programs:
    """Finds the programs: in a folder (a build folder or an installation) if one is given; else those that the
    environment names, those of the installation or of build/release, those in the PATH. InputError if they are not
    there."""
    return Programs(find_program(REDUCE, folder), find_program(DYNAMICS, folder))


def find_program(name: str, folder: str | Path | None = None) -> Path:
    """Finds one program as find_programs() does."""
    if folder is not None:
        candidates = [Path(folder) / place for place in PLACES[name]]
    else:
        named = os.environ.get(VARIABLES[name])
        folders = (ROOT.parents[1], ROOT / "build/release")  # ROOT of an installation is share/sprung
        candidates = [Path(named)] if named else [below / place for below in folders for place in PLACES[name][:2]]
        found = shutil.which(name)
        candidates += [Path(found)] if found and not named else []
    for path in candidates:
        if path.is_file() and os.access(path, os.X_OK):
            return path.resolve()
    where = folder if folder is not None else os.environ.get(VARIABLES[name], name)
    raise InputError(f"{where}: error: no program {name} here; tools/build makes it in build/release")
