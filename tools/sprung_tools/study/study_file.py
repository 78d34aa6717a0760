"""Reading a study file: what is run, which parameters change, what is measured. Its keys stand in tools/README.md,
"Studies"."""

import math
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_file import Place, TomlFile
from sprung_tools.runs.measures import HISTORIES, OF_HISTORIES
from sprung_tools.signals.fatigue_damage import LARGEST_STRESS, StrengthLine
from sprung_tools.study.description import (
    COMMANDS,
    FATIGUE_KEYS,
    GRID,
    LINEAR,
    LIST,
    LOGARITHMIC,
    METHODS,
    MOST_RUNS,
    PARAMETER_KEYS,
    ROAD_KEYS,
    ROOT_KEYS,
    SAMPLING_KEYS,
    Parameter,
    Sampling,
    Strength,
    Study,
)
from sprung_tools.study.study_checks import check_study

MPA = 1e6  # Pa


class Reader:
    """A table of the file, whose values are taken with their types checked. Unknown keys are errors."""

    def __init__(self, file: TomlFile, place: Place, table: Any, known: Iterable[str]) -> None:
        self.file, self.place = file, place
        if not isinstance(table, dict):
            raise file.fail(place, f"'{place[-1]}' must be a table")
        self.table: dict[str, Any] = table
        for key in table:
            if key not in known:
                raise file.fail((*place, key), f"unknown key '{key}' (known keys: {', '.join(known)})")

    def fail(self, key: str, expected: str) -> InputError:
        """The error about a value."""
        got = f", got {self.table[key]!r}" if key in self.table else " is missing"
        return self.file.fail((*self.place, key), f"'{key}'{got}, expected {expected}")

    def take(self, key: str, test: Callable[[Any], bool], expected: str, default: Any = None) -> Any:
        """The value of a key; without a default it is required."""
        if key not in self.table and default is not None:
            return default
        if key not in self.table or not test(self.table[key]):
            raise self.fail(key, expected)
        return self.table[key]

    def text(self, key: str, default: str | None = None) -> str:
        """A text."""
        value: str = self.take(key, lambda one: isinstance(one, str) and one != "", "a text", default)
        return value

    def choice(self, key: str, choices: tuple[str, ...], default: str) -> str:
        """One of some texts."""
        value: str = self.take(key, lambda one: one in choices, " or ".join(f'"{one}"' for one in choices), default)
        return value

    def real(self, key: str, default: float | None = None) -> float:
        """A finite number."""
        return float(self.take(key, is_number, "a number", default))

    def positive(self, key: str, default: float | None = None) -> float:
        """A finite number above 0."""
        return float(self.take(key, lambda one: is_number(one) and one > 0, "a number above 0", default))

    def whole(self, key: str, least: int, default: int | None = None) -> int:
        """A whole number."""

        def test(one: Any) -> bool:
            return isinstance(one, int) and not isinstance(one, bool) and one >= least

        value: int = self.take(key, test, f"a whole number of at least {least}", default)
        return value

    def flag(self, key: str) -> bool:
        """true or false, which is the default."""
        value: bool = self.take(key, lambda one: isinstance(one, bool), "true or false", False)
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of one or more different texts; empty without the key."""

        def test(one: Any) -> bool:
            return isinstance(one, list) and bool(one) and all(isinstance(part, str) and part for part in one)

        values: tuple[str, ...] = tuple(self.take(key, test, "a list of texts", ()))
        for number, value in enumerate(values):
            if value in values[:number]:
                raise self.file.fail((*self.place, key), f"'{value}' stands twice in '{key}'", fragment=value)
        return values


def is_number(value: Any) -> bool:
    """Whether a value is a finite number, which a whole one beyond the range of floating point is not."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def is_finite(value: Any) -> bool:
    """Whether all numbers in a value, a list or a table are finite."""
    if isinstance(value, (dict, list)):
        return all(map(is_finite, value.values() if isinstance(value, dict) else value))
    return not isinstance(value, (int, float)) or isinstance(value, bool) or is_number(value)


def read_study(path: str | Path) -> Study:
    """Reads a study file. InputError `path:line:column: error: …` for everything wrong in it."""
    file = TomlFile(path)
    root = Reader(file, (), file.data, ROOT_KEYS)
    folder = file.path.resolve().parent
    run = find_file(root, folder, "run", root.text("run"))
    designs: dict[str, Path] = {}
    for name in root.texts("designs"):
        design = find_file(root, folder, "designs", name)
        if design.stem in designs:
            raise file.fail(("designs",), f"two designs are called '{design.stem}'", fragment=name)
        designs[design.stem] = design
    superelements = folder / root.text("superelements") if "superelements" in root.table else None
    if superelements is not None and not superelements.is_dir():
        raise root.fail("superelements", f"a folder; there is no {superelements}")
    measures = read_measures(root)
    sampling = read_sampling(file)
    parameters = read_parameters(file, sampling)
    road = Reader(file, ("random_road",), file.data.get("random_road", {}), ROAD_KEYS).table
    overrides = root.take("set", lambda one: isinstance(one, dict), "a table of keys and values", {})
    study = Study(file, run, root.choice("command", COMMANDS, "run"), superelements, designs, overrides, measures,
                  sampling, road, read_strength(file), parameters)  # fmt: skip
    check_study(study)
    return study


def find_file(reader: Reader, folder: Path, key: str, name: str) -> Path:
    """A file beside the study file. InputError if there is none."""
    path = folder / name
    if not path.is_file():
        raise reader.file.fail((*reader.place, key), f"there is no file {path}", fragment=name)
    return path


def read_measures(root: Reader) -> dict[str, str]:
    """Reads the measures `[LABEL=]NAME`."""
    measures: dict[str, str] = {}
    for entry in root.texts("measures"):
        label, separator, name = entry.partition("=") if "=" in entry else (entry, "", entry)
        problem = ""
        if "/" not in name:
            problem = "is no measure, expected OBJECT/MEASURE"
        elif separator and (not label or "*" in name):
            problem = "has a label, which one measure needs, and no pattern" if label else "has an empty label"
        elif name in measures or label in measures.values():
            problem = "has a name or a label that stands twice in 'measures'"
        elif name.startswith(HISTORIES):
            problem = find_problem_of_history(name)
        if problem:
            raise root.file.fail(("measures",), f"'{entry}' {problem}", fragment=entry)
        measures[name] = label
    return measures


def find_problem_of_history(name: str) -> str:
    """What is wrong with a measure `histories/QUANTITY/MEASURE`; empty if nothing is."""
    quantity, _, measure = name.rpartition("/")
    if "*" in quantity:
        return "has a pattern in its quantity, of which only the whole name is taken"
    if "*" not in measure and measure not in OF_HISTORIES:
        return f"has the measure '{measure}' of a quantity, expected one of {', '.join(OF_HISTORIES)}"
    return ""


def read_strength(file: TomlFile) -> Strength | None:
    """Reads the table `fatigue`, if there is one."""
    if "fatigue" not in file.data:
        return None
    reader = Reader(file, ("fatigue",), file.data["fatigue"], FATIGUE_KEYS)

    def are_slopes(one: Any) -> bool:
        return isinstance(one, list) and len(one) == 2 and all(is_number(part) and part > 0 for part in one)

    def number(key: str, unit: float) -> float | None:
        return unit * reader.positive(key) if key in reader.table else None

    first, second = reader.take("slopes", are_slopes, "two numbers above 0", [3.0, 5.0])
    for key in ("category", "strength"):
        if key in reader.table and MPA * reader.positive(key) > LARGEST_STRESS:
            raise reader.fail(key, f"at most {LARGEST_STRESS / MPA:g} MPa")
    line = StrengthLine(MPA * reader.positive("category"), (float(first), float(second)), reader.positive("knee", 5e6),
                        number("endurance", 1.0), number("strength", MPA))  # fmt: skip
    return Strength(line, reader.positive("factor", 1.0))


def read_sampling(file: TomlFile) -> Sampling:
    """Reads the table `sampling`."""
    reader = Reader(file, ("sampling",), file.data.get("sampling", {}), SAMPLING_KEYS)
    method = reader.choice("method", METHODS, GRID)
    if method in (GRID, LIST):
        for key in ("number", "seed"):
            if key in reader.table:
                raise reader.file.fail(("sampling", key), f"'{key}' has no effect with method \"{method}\"")
        return Sampling(method, 0, 0)
    return Sampling(method, reader.whole("number", 1), reader.whole("seed", 0, 1))


def read_parameters(file: TomlFile, sampling: Sampling) -> tuple[Parameter, ...]:
    """Reads the tables `parameters`."""
    tables = file.data.get("parameters")
    if not isinstance(tables, list) or not tables:
        raise file.fail(("parameters",), "the study has no parameters: [[parameters]] is required")
    parameters: list[Parameter] = []
    for number, table in enumerate(tables):
        one = read_parameter(Reader(file, ("parameters", number), table, PARAMETER_KEYS), sampling)
        names, keys = ({other.name for other in parameters}, {key for other in parameters for key in other.keys})
        if one.name in names or keys.intersection(one.keys):
            what = f"two parameters are called '{one.name}'" if one.name in names else "another parameter sets it, too"
            raise file.fail((*one.place, "name" if "name" in table else "key" if "key" in table else "keys"), what)
        parameters.append(one)
    if sampling.method == LIST:
        lengths = [len(one.values) for one in parameters if not one.crossed]
        for one in parameters:
            if not one.crossed and len(one.values) != lengths[0]:
                what = f"'{one.name}' has {len(one.values)} values, the first parameter has {lengths[0]}"
                raise file.fail((*one.place, "values"), f'{what}: with method "list" they must be as many')
    return tuple(parameters)


def read_parameter(reader: Reader, sampling: Sampling) -> Parameter:
    """Reads one of the tables `parameters`."""
    if ("key" in reader.table) == ("keys" in reader.table):
        raise reader.file.fail(reader.place, "a parameter needs one of 'key' and 'keys'")
    keys = (reader.text("key"),) if "key" in reader.table else reader.texts("keys")
    name, crossed = reader.text("name", keys[0]), reader.flag("crossed")
    if "/" in name or not name.strip("."):
        raise reader.fail("name", "a name that is not of dots alone, and without a slash")
    if "values" in reader.table:
        for key in ("from", "to", "number", "spacing"):
            if key in reader.table:
                raise reader.file.fail((*reader.place, key), f"'{key}' has no effect beside 'values'")
        values = reader.take("values", lambda one: isinstance(one, list) and bool(one), "a list of one value or more")
        for value in values:
            if not is_finite(value):
                raise reader.fail("values", "finite numbers")
            if len(keys) > 1 and isinstance(value, list) and len(value) != len(keys):
                raise reader.fail("values", f"lists of {len(keys)} values, one for each of 'keys'")
        return Parameter(name, keys, tuple(values), 0.0, 0.0, LINEAR, crossed, reader.place)
    low, high = reader.real("from"), reader.real("to")
    spacing = reader.choice("spacing", (LINEAR, LOGARITHMIC), LINEAR)
    if not low < high:
        raise reader.fail("to", f"more than 'from' = {low:g}")
    if spacing == LOGARITHMIC and not low > 0.0:
        raise reader.fail("from", "a number above 0 for logarithmic spacing")
    if sampling.method in (GRID, LIST) or crossed:
        number = reader.whole("number", 2)
        if number > MOST_RUNS:
            raise reader.fail("number", f"at most {MOST_RUNS}")
        values = make_range(reader.table["from"], reader.table["to"], number, spacing)
        return Parameter(name, keys, tuple(values), low, high, spacing, crossed, reader.place)
    if "number" in reader.table:
        what = f"'number' has no effect with method \"{sampling.method}\": the number of points stands in [sampling]"
        raise reader.file.fail((*reader.place, "number"), what)
    return Parameter(name, keys, (), low, high, spacing, crossed, reader.place)


def make_range(low: float, high: float, number: int, spacing: str) -> list[float]:
    """The values of a range. Whole steps between whole numbers stay whole, as keys for numbers of things need them."""
    if spacing == LINEAR and isinstance(low, int) and isinstance(high, int) and (high - low) % (number - 1) == 0:
        return list(range(low, high + 1, (high - low) // (number - 1)))
    return [place_between(float(low), float(high), spacing, k / (number - 1)) for k in range(number)]


def place_between(low: float, high: float, spacing: str, share: float) -> float:
    """The value at a share (0 to 1) of the way from low to high."""
    if share in (0.0, 1.0):
        return high if share else low
    if spacing == LOGARITHMIC:
        return low * math.exp(share * math.log(high / low))
    return low + share * (high - low)
