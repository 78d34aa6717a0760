"""Which keys of a study mean the same value: in other quotes, by the number and by the name of an entry of a list."""

from typing import Any

from sprung_tools.files.toml_file import TomlFile
from sprung_tools.files.toml_text import split_key, strip_quotes
from sprung_tools.study.description import DESIGN, Study

Parts = tuple[str | int, ...]


def read_values(study: Study) -> dict[str, Any]:
    """What the keys of a study lead into: the run file, with the tables of the vehicle and of the designs in it."""
    values = dict(TomlFile(study.run).data)
    vehicle = study.run.parent / str(values.get("vehicle", ""))
    values["vehicle"] = TomlFile(vehicle).data if vehicle.is_file() else {}
    values[DESIGN] = {name: TomlFile(path).data for name, path in study.designs.items()}
    return values


def resolve_key(key: str, values: dict[str, Any]) -> Parts:
    """The names of a key without quotes; of an entry of a list its number from 0, whether the key has number or
    name."""
    parts: list[str | int] = []
    inside: Any = values
    for part in split_key(key):
        name: str | int = strip_quotes(part)
        if isinstance(inside, list):
            name = find_number(inside, part)
            inside = inside[name] if isinstance(name, int) else None
        else:
            inside = inside.get(name) if isinstance(inside, dict) else None
        parts.append(name)
    return tuple(parts)


def find_number(entries: list[Any], part: str) -> str | int:
    """The number of the entry of a list that a part of a key means; the part where there is none. A number in quotes is
    a name."""
    if part.isdecimal():
        return int(part) if int(part) < len(entries) else part
    name = strip_quotes(part)
    numbers = [number for number, one in enumerate(entries) if isinstance(one, dict) and one.get("name") == name]
    return numbers[0] if numbers else name
