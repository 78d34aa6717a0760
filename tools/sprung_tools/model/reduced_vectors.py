"""What the vectors of a reduced body are (reduce/basis, "Kinds of vectors"): modes of the body, or others, whose
frequencies are none that the body has."""

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

from sprung_tools.files.hdf5_file import read_numbers, read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.terminal.number_ranges import format_ranges

OF_THE_BODY = ("free", "clamped")  # kinds of vectors whose frequency is one that the body has


class Vector(NamedTuple):
    """A vector of a body's basis: its number in the superelement, from 1; its kind, empty where an older file does not
    say it; its frequency [Hz], None unless the body has it."""

    number: int
    kind: str
    frequency: float | None

    def __str__(self) -> str:
        """`mode 3`, `residual vector 7`."""
        is_mode = self.kind in ("", *OF_THE_BODY)
        return f"mode {self.number}" if is_mode else f"{self.kind} vector {self.number}"


def read_vectors(results: ResultsFile, body: str) -> list[Vector]:
    """The vectors that a body has in a run; none of a rigid body."""
    numbers = results.mode_numbers(body)
    where = f"model/superelements/{results.superelement(body)}"
    if not results.file.has_dataset(f"{where}/kind"):
        return [Vector(int(number), "", None) for number in numbers]
    kinds = read_texts(results.file, f"{where}/kind")
    frequencies = read_numbers(results.file, f"{where}/frequency")[0].tolist()
    return [
        Vector(number, kinds[number - 1], frequencies[number - 1] if kinds[number - 1] in OF_THE_BODY else None)
        for number in numbers.tolist()
    ]


def count_vectors(vectors: Sequence[Vector]) -> str:
    """`6 modes`; `17 vectors` where some are no modes of the body."""
    is_modes = all(one.kind in ("", *OF_THE_BODY) for one in vectors)
    return f"{len(vectors)} {'mode' if is_modes else 'vector'}{'s' * (len(vectors) != 1)}"


def describe_vectors(vectors: Sequence[Vector]) -> str:
    """`free modes 1–6, residual vectors 7–17`."""
    parts = []
    for kind, some in groupby(vectors, key=lambda one: one.kind):
        numbers = [one.number for one in some]
        what = ("mode" if kind in ("", *OF_THE_BODY) else "vector") + "s" * (len(numbers) > 1)
        parts.append(f"{kind} {what} {format_ranges(numbers)}".lstrip())
    return ", ".join(parts)
