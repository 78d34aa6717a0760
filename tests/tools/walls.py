"""The walls between the rooms. A room is a folder with a call of sprung_room in its CMakeLists.txt, which names the
rooms whose headers its files may include; a room may use only rooms that are declared before it."""

import re
from pathlib import Path
from typing import NamedTuple

# gmsh is under the GPL: one room, out of reach of dynamics/.
ONLY_IN = {"gmsh.h": "fem/gmsh"}
# The one room of stage one that stage two may use.
DOOR = "reduce/superelement"
FOLDERS = ("tools/support", "fem", "reduce", "dynamics")
SOURCES = (".h", ".cpp")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
ROOM_CALL = re.compile(r"^sprung_room\(([^)]*)\)", re.MULTILINE)
SUBDIRECTORY = re.compile(r"^add_subdirectory\(([^)]+)\)", re.MULTILINE)


class Room(NamedTuple):
    """A room as its CMakeLists.txt declares it: the source files it lists, the rooms it may use."""

    sources: tuple
    uses: tuple


class Include(NamedTuple):
    """An include line: the file it stands in (from the root), the line's number, what it includes and how."""

    file: str
    line: int
    target: str
    quoted: bool


def read_rooms(root):
    """All rooms under the folder `root`, by path, in the order in which CMake comes to them."""
    rooms = {}
    for folder in FOLDERS:
        _add_rooms(Path(root), folder, rooms)
    return rooms


def _add_rooms(root, folder, rooms):
    path = root / folder / "CMakeLists.txt"
    text = re.sub(r"#.*", "", path.read_text(encoding="utf-8"))
    call = ROOM_CALL.search(text)
    if call:
        sources, _, rest = call[1].partition("USES")
        rooms[folder] = Room(tuple(sources.split("LINKS")[0].split()), tuple(rest.split("LINKS")[0].split()))
    for name in SUBDIRECTORY.findall(text):
        _add_rooms(root, f"{folder}/{name}", rooms)


def read_includes(root, room):
    """All include lines of the sources in a room's own folder."""
    found = []
    for path in sorted((Path(root) / room).iterdir()):
        if path.suffix not in SOURCES:
            continue
        for number, text in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            match = INCLUDE.match(text)
            if match:
                found.append(Include(path.relative_to(root).as_posix(), number, match[2], match[1] == '"'))
    return found


def find_crossings(root):
    """Every include that crosses a wall and every arrow that runs up, as `file:line: error: …`."""
    rooms = read_rooms(root)
    return [
        *_find_homeless_files(Path(root), rooms),
        *_find_wrong_uses(rooms),
        *(problem for room in rooms for problem in _find_wrong_includes(Path(root), room, rooms[room])),
    ]


def _find_homeless_files(root, rooms):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            home = path.parent.relative_to(root).as_posix()
            if path.suffix in SOURCES and home not in rooms:
                yield f"{path.relative_to(root).as_posix()}:1: error: its folder is no room (sprung_room)"


def _find_wrong_uses(rooms):
    seen = set()
    for name, room in rooms.items():
        where = f"{name}/CMakeLists.txt:1: error: "
        for used in room.uses:
            if used not in rooms:
                yield f"{where}'{used}' is no room"
            elif used not in seen:
                yield f"{where}'{used}' is declared after {name}, which may use only rooms before it"
            elif name.startswith("dynamics/") and used.startswith(("fem", "reduce")) and used != DOOR:
                yield f"{where}of stage one, stage two may use {DOOR} alone, not '{used}'"
            elif name.startswith(("fem", "reduce")) and used.startswith("dynamics"):
                yield f"{where}stage one may not use stage two ('{used}')"
        seen.add(name)


def _find_wrong_includes(root, name, room):
    allowed = (name, *room.uses)
    includes = read_includes(root, name)
    for include in includes:
        where = f"{include.file}:{include.line}: error: "
        ours = include.quoted or (root / include.target).exists()
        if ours and Path(include.target).parent.as_posix() not in allowed:
            yield f"{where}'{include.target}' is not for {name}, which may include from {', '.join(allowed)}"
        elif ours and not (root / include.target).exists():
            yield f"{where}'{include.target}' is not a file, counted from the repository's root"
        elif ONLY_IN.get(include.target, name) != name:
            yield f"{where}'{include.target}' may be included in {ONLY_IN[include.target]} only"
    included = {Path(include.target).parent.as_posix() for include in includes}
    for used in room.uses:
        if used not in included:
            yield f"{name}/CMakeLists.txt:1: error: it may use '{used}', but no file includes from there"
