"""What a format says of its datasets and attributes, as tables that stored_file checks each of them against.

A *pattern* is a path in which `*` stands for one name, and `**` for one or more: `bodies/*/position`. A *size* of a
dataset along one of its axes is a number; None if any will do; or a dataset that is as long: its pattern, in which each
`*` stands for the same name as in the dataset's own, or (pattern, axis) where not the first axis counts.
"""

import re
from collections.abc import Collection, Mapping
from typing import NamedTuple

Size = int | str | tuple[str, int] | None


class Numbers(NamedTuple):
    """A dataset of finite numbers.

    within: of a dataset of indices from 0 the dataset that they point into, as a size; else None.
    """

    shape: tuple[Size, ...]
    within: Size = None


class Texts(NamedTuple):
    """A dataset of strings; one string may also stand alone, without an axis."""

    size: Size = None


Rule = Numbers | Texts


class Found(NamedTuple):
    """The rule for a dataset, and the names that the wildcards of its pattern stand for."""

    rule: Rule
    names: tuple[str, ...]


class Layout:
    """The rules of a format. attributes: pattern of a group → the attributes that it must have, and their types;
    chosen: keys of [output.store], with which a run file chooses the datasets that are there."""

    def __init__(
        self, datasets: Mapping[str, Rule], attributes: Mapping[str, Mapping[str, type]] | None = None,
        chosen: Collection[str] = (),
    ) -> None:  # fmt: skip
        self.chosen = frozenset(chosen)
        self._datasets = [(compile_pattern(pattern), rule) for pattern, rule in datasets.items()]
        self._attributes = [(compile_pattern(pattern), rule) for pattern, rule in (attributes or {}).items()]

    def find(self, name: str) -> Found | None:
        """The first rule whose pattern fits a dataset's path; None if there is none."""
        for pattern, rule in self._datasets:
            fit = pattern.fullmatch(name)
            if fit:
                return Found(rule, fit.groups())
        return None

    def list_attributes(self, group: str) -> Mapping[str, type]:
        """The attributes that a group must have, and their types."""
        for pattern, rule in self._attributes:
            if pattern.fullmatch(group):
                return rule
        return {}


def compile_pattern(pattern: str) -> re.Pattern[str]:
    """A pattern as a regular expression, with a group for each wildcard."""
    parts = re.split(r"(\*\*|\*)", pattern)
    return re.compile("".join({"*": "([^/]+)", "**": "(.+)"}.get(part) or re.escape(part) for part in parts))


def fill_pattern(pattern: str, names: tuple[str, ...]) -> str:
    """A pattern with names in place of its wildcards."""
    waiting = iter(names)
    return re.sub(r"\*\*|\*", lambda _: next(waiting), pattern)
