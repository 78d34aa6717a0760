"""A study as its file describes it."""

from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_file import Place, TomlFile
from sprung_tools.signals.fatigue_damage import StrengthLine

GRID, LIST, LATIN, SOBOL = "grid", "list", "latin-hypercube", "sobol"
METHODS = (GRID, LIST, LATIN, SOBOL)
COMMANDS = ("run", "response", "modes", "equilibrium")
LINEAR, LOGARITHMIC = "linear", "logarithmic"
DESIGN, RANDOM_ROAD = "design", "random_road"  # first parts of the keys of designs and of the random road
ROAD = "road"  # the table that a random road replaces
ROOT_KEYS = ("run", "command", "superelements", "designs", "set", "measures", "sampling", "random_road", "fatigue",
             "parameters")  # fmt: skip
SAMPLING_KEYS = ("method", "number", "seed")
PARAMETER_KEYS = ("name", "key", "keys", "values", "from", "to", "number", "spacing", "crossed")
ROAD_KEYS = ("class", "rms", "density", "band", "exponent", "length", "spacing", "ease", "start", "seed")
FATIGUE_KEYS = ("category", "slopes", "knee", "endurance", "strength", "factor")
COLUMNS_BEFORE = ("run",)  # columns of the table beside parameters and measures
COLUMNS_BEHIND = ("exit_code", "converged", "warnings", "error", "set", "hash")
MOST_RUNS = 1_000_000


class Parameter(NamedTuple):
    """A parameter of a study. Either it has values, or it lies from low to high."""

    name: str
    keys: tuple[str, ...]
    values: tuple[Any, ...]
    low: float
    high: float
    spacing: str
    crossed: bool
    place: Place

    def settings(self, value: Any) -> dict[str, Any]:
        """What a value gives to the parameter's keys: a list with one for each of several keys, else the same to
        all."""
        if len(self.keys) > 1 and isinstance(value, list):
            return dict(zip(self.keys, value, strict=True))
        return {key: value for key in self.keys}


class Sampling(NamedTuple):
    """How the points of a study are chosen. number, seed: of random points."""

    method: str
    number: int
    seed: int


class Strength(NamedTuple):
    """How stresses become damage: the line, and what multiplies all stresses."""

    line: StrengthLine
    factor: float


class Study(NamedTuple):
    """A study file. Paths are absolute."""

    file: TomlFile
    run: Path
    command: str
    superelements: Path | None
    designs: dict[str, Path]  # name → design file
    overrides: dict[str, Any]  # for all runs
    measures: dict[str, str]  # name → label, which is the name itself where none is given
    sampling: Sampling
    random_road: dict[str, Any]
    strength: Strength | None  # for the measures of fatigue
    parameters: tuple[Parameter, ...]

    @property
    def has_one_vehicle(self) -> bool:
        """Whether all runs are of one vehicle file."""
        return all("vehicle" not in parameter.keys for parameter in self.parameters)


def fail_at_key(study: Study, key: str, what: str) -> InputError:
    """The error of a key that a parameter has, else that is set for all runs."""
    for parameter in study.parameters:
        if key in parameter.keys:
            name = "key" if len(parameter.keys) == 1 else "keys"
            return study.file.fail((*parameter.place, name), what, fragment=key)
    whole = ("set", key)  # a key with dots that stands in quotes
    return study.file.fail(whole if whole in study.file.places() else ("set", *key.split(".")), what)
