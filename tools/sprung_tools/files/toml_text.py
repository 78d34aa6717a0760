"""Values as TOML text, for `--set` and for files that are made from others."""

import json
import re
from collections.abc import Callable, Mapping
from pathlib import PurePath
from typing import Any

import numpy as np

from sprung_tools.files.errors import InputError

# A part of a key as `--set` takes it: in quotes it may hold dots.
KEY_PART = r"""\s*(?:"[^"]*"|'[^']*'|[^"'.=\s](?:[^"'.=]*[^"'.=\s])?)\s*"""


def split_key(key: str) -> list[str]:
    """The parts of a key between its dots, as they are written; none if it is no key."""
    if not re.fullmatch(rf"{KEY_PART}(?:\.{KEY_PART})*", key):
        return []
    return [part.strip() for part in re.findall(KEY_PART, key)]


def strip_quotes(part: str) -> str:
    """The name that a part of a key stands for."""
    return part[1:-1] if part[0] in "\"'" else part


def cut_key(key: str, *names: str) -> str:
    """What is behind the first parts of a key; empty if these have other names, or nothing is behind them."""
    parts = split_key(key)
    return ".".join(parts[len(names) :]) if tuple(map(strip_quotes, parts[: len(names)])) == names else ""


def never(_key: str, _table: Mapping[str, Any]) -> bool:
    """Takes no table as a value."""
    return False


def flatten_settings(
    table: Mapping[str, Any], prefix: str = "", is_value: Callable[[str, Mapping[str, Any]], bool] = never
) -> dict[str, Any]:
    """Tables in tables as keys with dots: {"road": {"height": 0.1}} → {"road.height": 0.1}.
    is_value: whether the table of a key is a value as a whole. InputError for a key that is given twice."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        path = f"{prefix}{key}"
        is_table = isinstance(value, Mapping) and not is_value(path, value)
        found = flatten_settings(value, f"{path}.", is_value) if is_table else {path: value}
        for one in found:
            if one in flat:
                raise InputError(f"{one}: error: is given twice")
        flat |= found
    return flat


def format_value(value: Any) -> str:
    """A value on one line; of numpy numbers and arrays, too; a path as its text. InputError for what TOML does not
    hold."""
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, PurePath):
        value = str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(format_value, value))}]"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{format_key(key)} = {format_value(one)}" for key, one in value.items()) + " }"
    raise InputError(f"error: {type(value).__name__} '{value}' is no value of a parameter, expected a number, true or "
                     "false, a text, a list or a table")


def format_key(key: str) -> str:
    """A key, in quotes where it needs them."""
    bare = key and all(letter.isascii() and (letter.isalnum() or letter in "_-") for letter in key)
    return key if bare else format_value(key)


def format_document(table: dict[str, Any]) -> str:
    """A whole file: one line for each key of the root table."""
    return "".join(f"{format_key(key)} = {format_value(value)}\n" for key, value in table.items())
