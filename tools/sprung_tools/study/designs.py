"""Stage one of a study: each design with the values of some of its parameters becomes one superelement, however many
runs use it."""

import hashlib
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.files.toml_text import format_document, split_key, strip_quotes
from sprung_tools.files.whole_file import write_whole
from sprung_tools.programs.calls import GOOD, call
from sprung_tools.study.machine_faults import is_of_machine

Table = dict[str, Any]

FILE_KEYS = ("mesh", "matrices.stiffness", "matrices.mass", "matrices.freedoms", "matrices.nodes")


class Variant(NamedTuple):
    """A design as some runs use it. folder: holds NAME.toml and, once it is reduced, NAME.h5."""

    name: str
    folder: Path
    text: str
    files: dict[str, Path]  # those that the design reads, by their names relative to it

    @property
    def superelement(self) -> Path:
        """The file that sprung-reduce writes."""
        return self.folder / f"{self.name}.h5"


def make_variant(design: Path, changes: Mapping[str, Any], folder: Path) -> Variant:
    """A design with some keys changed. folder: that of all variants. InputError if a key leads nowhere."""
    file = TomlFile(design)
    text = design.read_text(encoding="utf-8-sig")
    for key, value in changes.items():
        set_value(file.data, key, value, design)
    files, is_moved = take_files(file.data, design)
    if changes or is_moved:
        text = f"# Made by tools/study from {design.name}.\n{format_document(file.data)}"
    parts = [text.encode(), *([one.read_bytes() for one in files.values()] or [b""])]
    return Variant(design.stem, folder / f"{design.stem}-{hash_parts(parts)[:16]}", text, files)


def take_files(data: Table, design: Path) -> tuple[dict[str, Path], bool]:
    """The files that a design reads and that are there, by their names in it; whether a name was changed.

    A name that leads out of the design's folder becomes an absolute one, because a variant lies elsewhere.
    """
    files: dict[str, Path] = {}
    is_moved = False
    for key in FILE_KEYS:
        group, _, last = key.rpartition(".")
        table = data.get(group) if group else data
        if not isinstance(table, dict):
            continue
        name = table.get(last)
        if not isinstance(name, str) or not (design.parent / name).is_file():
            continue
        path = design.parent / name
        if ".." in Path(name).parts:
            name = table[last] = str(path.resolve())
            is_moved = True
        files[name] = path
    return files, is_moved


def set_value(table: Table, path: str, value: Any, design: Path) -> None:
    """Changes a value of a design. path: keys with dots between, in quotes where they hold dots; an entry of a list
    goes by its number from 0.

    Tables on the way that are not there are made. InputError if the path leads through something else."""
    *way, last = map(strip_quotes, split_key(path))
    inside: Any = table
    for key in way:
        inside = inside.setdefault(key, {}) if isinstance(inside, dict) else find_entry(inside, key, path, design)
    if isinstance(inside, dict):
        inside[last] = value
    else:
        find_entry(inside, last, path, design)
        inside[int(last)] = value


def find_entry(entries: Any, key: str, path: str, design: Path) -> Any:
    """The entry of a list. InputError if it is no list, or has no such entry."""
    if not isinstance(entries, list):
        raise InputError(f"{design}: error: '{path}' leads through a value at '{key}', expected a table")
    if not key.isdecimal() or int(key) >= len(entries):
        raise InputError(f"{design}: error: '{path}': '{key}' is no number of an entry, 0 to {len(entries) - 1}")
    return entries[int(key)]


def reduce_variant(program: Path, variant: Variant) -> str:
    """Has sprung-reduce make the superelement of a variant, unless it is up to date. Returns the error, empty if all is
    well. InputError for a failure that says nothing about the variant."""
    variant.folder.mkdir(parents=True, exist_ok=True)
    design = variant.folder / f"{variant.name}.toml"
    write_whole(design, variant.text)
    for name, path in variant.files.items():
        if not Path(name).is_absolute():
            (variant.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, variant.folder / name)
    outcome = call([program, "build", design, "--output-dir", variant.folder, "--quiet"], is_tied=True)
    if is_of_machine(outcome.error):
        raise InputError(outcome.error)
    return outcome.error if outcome.exit_code != GOOD else ""


def hash_parts(parts: list[bytes]) -> str:
    """The SHA-256 of texts, each with its length before it."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(len(part).to_bytes(8, "little"))
        digest.update(part)
    return digest.hexdigest()
