"""The walls between the rooms: which room may include what."""

import re
from pathlib import Path
from typing import NamedTuple

# What a room may include, by the beginning of its path; "reduce/superelement.h" is the door between the stages.
ALLOWED = {
    "tools/support": ("tools/support/",),
    "fem": ("fem/", "tools/support/"),
    "reduce": ("reduce/", "fem/", "tools/support/"),
    "dynamics": ("dynamics/", "tools/support/", "reduce/superelement.h"),
}
# The files of the target sprung_superelement, which stage two links: they do without the rest of reduce/.
DOOR_PARTS = ("", "_fault", "_hash", "_reader", "_writer")
DOOR = tuple(f"reduce/superelement{part}{suffix}" for part in DOOR_PARTS for suffix in (".h", ".cpp"))
# gmsh is under the GPL: one place, out of reach of dynamics/.
ONLY_IN = {"gmsh.h": "fem/"}
SOURCES = (".h", ".cpp")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


class Include(NamedTuple):
    """An include line: the file it stands in (from the root), the line's number, what it includes and how."""

    file: str
    line: int
    target: str
    quoted: bool


def read_includes(root, room):
    """All include lines of a room's sources under the folder `root`."""
    found = []
    for path in sorted((Path(root) / room).rglob("*")):
        if path.suffix not in SOURCES:
            continue
        for number, text in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            match = INCLUDE.match(text)
            if match:
                found.append(Include(path.relative_to(root).as_posix(), number, match[2], match[1] == '"'))
    return found


def find_crossings(root):
    """Every include that crosses a wall, as `file:line: error: …`."""
    problems = []
    for room, allowed in ALLOWED.items():
        for include in read_includes(root, room):
            where = f"{include.file}:{include.line}: error: "
            may = (*DOOR, "tools/support/") if include.file in DOOR else allowed
            ours = include.quoted or (Path(root) / include.target).exists()
            if ours and not include.target.startswith(may):
                problems.append(
                    f"{where}'{include.target}' is not for this file of {room}/, which may include {', '.join(may)}"
                )
            elif ours and not (Path(root) / include.target).exists():
                problems.append(
                    f"{where}'{include.target}' is not a file, counted from the repository's root"
                )
            elif not include.file.startswith(ONLY_IN.get(include.target, "")):
                problems.append(
                    f"{where}'{include.target}' may be included in {ONLY_IN[include.target]} only"
                )
    return problems
