"""A study in parts: as jobs of Snakemake, which runs them on one machine or hands them to a cluster.

Part K of N makes the runs K, K + N, K + 2N, … in a folder of its own, FOLDER/parts/K. Where all parts are done, one job
collects their rows, and writes the table and the page. A part that was ended on the way goes on where it was."""

import os
import re
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, TypeVar

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.programs.finding import Programs
from sprung_tools.study.description import Study
from sprung_tools.study.designs import hash_parts
from sprung_tools.study.kept_rows import ROWS, KeptRows, keep_row, parse_row
from sprung_tools.study.plan import calc_hash, list_texts

PARTS, SNAKEFILE = "parts", "Snakefile"
Item = TypeVar("Item")


class Part(NamedTuple):
    """Part `number`, from 1, of `total`."""

    number: int
    total: int

    def choose(self, items: Sequence[Item]) -> list[Item]:
        """The items of the part."""
        return list(items[self.number - 1 :: self.total])

    def folder(self, study: Path) -> Path:
        """Where the part keeps its rows. study: folder of the study."""
        return study / PARTS / str(self.number)


def parse_part(text: str) -> Part:
    """A part, `K/N`. InputError for anything else."""
    found = re.fullmatch(r"(\d+)/(\d+)", text)
    part = Part(*map(int, found.groups())) if found else Part(0, 0)
    if not 1 <= part.number <= part.total:
        raise InputError(f"--part: error: got '{text}', expected K/N with K from 1 to N")
    return part


def collect_rows(kept: KeptRows, study: Path) -> int:
    """Takes over the rows that the parts of a study have and the study has not, and the good ones where the study's own
    has failed. Of a part's rows of one run the last one counts. Returns their number."""
    number = 0
    for path in sorted((study / PARTS).glob(f"*/{ROWS}")):
        with open(path, encoding="utf-8", errors="replace") as lines:
            rows = {row.hash: row for row in map(parse_row, lines) if row is not None}
        for row in rows.values():
            own = kept.rows.get(row.hash)
            if own is None or (own.has_failed and not row.has_failed):
                keep_row(kept.path, row)
                kept.rows[row.hash] = row
                number += 1
    return number


def list_inputs(study: Study, programs: Programs) -> set[Path]:
    """The files that the runs of a study read, and the programs: the study, run and vehicle files, the designs, the
    superelements of its folder, and whatever else a text in one of these names."""
    run = TomlFile(study.run).data
    values = [one.settings(value).get("vehicle") for one in study.parameters for value in one.values]
    vehicles = {one for one in (run.get("vehicle"), study.overrides.get("vehicle"), *values) if isinstance(one, str)}
    waiting = [study.file.path.resolve(), study.run, *study.designs.values()]
    waiting += [study.run.parent / one for one in vehicles if os.path.isfile(study.run.parent / one)]
    found = {programs.dynamics, *waiting, *([programs.reduce] if study.designs else [])}
    if study.superelements is not None:
        found.update(study.superelements.glob("*.h5"))
    for file in waiting:
        names = list_texts(TomlFile(file).data)
        paths = (folder / name for name in names for folder in (study.run.parent, file.parent))
        found.update(path for path in paths if os.path.isfile(path))
    return found


def format_snakefile(command: Path, study: Study, folder: str | None, programs: Programs, parts: int) -> str:
    """The Snakefile of a study. command: of the tool; folder: of the programs, None: the default.

    Snakemake makes a part again where one of its inputs is newer than its outcome, or where the hash of them all is
    another one."""
    words = [str(command), str(study.file.path.resolve())]
    words += ["--programs", str(Path(folder).resolve())] if folder else []
    # Snakemake fills in what stands in braces; those of a path are doubled.
    call = shlex.join(words).replace("{", "{{").replace("}", "}}")
    inputs = sorted({os.path.abspath(path) for path in list_inputs(study, programs)})
    content = hash_parts([text.encode() for path in inputs for text in (path, calc_hash(path))])
    # Braces in the name of an input cannot be doubled; such a file counts by the hash alone.
    listed = "".join(f"    {path!r},\n" for path in inputs if "{" not in path)
    environment = {name: os.environ[name] for name in ("SPRUNG_REDUCE", "SPRUNG_DYNAMICS") if name in os.environ}
    settings = "".join(f"os.environ[{name!r}] = {value!r}\n" for name, value in environment.items())
    imports = f"import os\n\n{settings}" if settings else ""
    return f"""# A study in parts, written by tools/study --workflow. In this folder:
#     snakemake --cores all --rerun-incomplete
{imports}PARTS = {parts}
CALL = {call!r}
INPUTS = [
{listed}]


rule all:
    input:
        "table.csv",


rule part:
    input:
        INPUTS,
    output:
        touch("{PARTS}/{{part}}/done"),
    params:
        content="{content}",
    threads: 1
    shell:
        CALL + " --output . --part {{wildcards.part}}/{parts} --jobs {{threads}}"


rule table:
    input:
        expand("{PARTS}/{{part}}/done", part=range(1, PARTS + 1)),
    output:
        "table.csv",
        "table.h5",
        "study.html",
    params:
        content="{content}",
    threads: 1
    shell:  # with exit code 1 the table is written, too
        CALL + " --output . --collect --jobs {{threads}} || [ $? -eq 1 ]"
"""
