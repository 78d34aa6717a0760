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
from sprung_tools.study.kept_rows import ROWS, KeptRows, keep_row, parse_row

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
    """Takes over the rows that the parts of a study have and the study has not. Returns their number."""
    number = 0
    for path in sorted((study / PARTS).glob(f"*/{ROWS}")):
        with open(path, encoding="utf-8", errors="replace") as lines:
            rows = [row for row in map(parse_row, lines) if row is not None]
        for row in rows:
            if row.hash not in kept.rows:
                keep_row(kept.path, row)
                kept.rows[row.hash] = row
                number += 1
    return number


def format_snakefile(command: Path, study: Path, programs: str | None, parts: int) -> str:
    """The Snakefile of a study. command: of the tool; programs: folder of the programs, None: the default."""
    words = [str(command), str(study), *(["--programs", str(Path(programs).resolve())] if programs else [])]
    # Snakemake fills in what stands in braces; those of a path are doubled.
    call = shlex.join(words).replace("{", "{{").replace("}", "}}")
    environment = {name: os.environ[name] for name in ("SPRUNG_REDUCE", "SPRUNG_DYNAMICS") if name in os.environ}
    settings = "".join(f"os.environ[{name!r}] = {value!r}\n" for name, value in environment.items())
    imports = f"import os\n\n{settings}" if settings else ""
    return f"""# A study in parts, written by tools/study --workflow. In this folder:
#     snakemake --cores all --rerun-incomplete
{imports}PARTS = {parts}
CALL = {call!r}


rule all:
    input:
        "table.csv",


rule part:
    output:
        touch("{PARTS}/{{part}}/done"),
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
    threads: 1
    shell:
        CALL + " --output . --collect --jobs {{threads}}"
"""
