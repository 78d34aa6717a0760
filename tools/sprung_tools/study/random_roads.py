"""Random roads of a study: each recipe with its seed becomes one road table, made as tools/make_road.py makes it."""

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import write_whole
from sprung_tools.signals.road_profile import (
    ISO_BAND,
    ISO_CLASSES,
    Recipe,
    calc_iso_density,
    format_profile,
    make_profile,
)
from sprung_tools.study.designs import hash_parts

ISO_EXPONENT = 2.0


class RandomRoad(NamedTuple):
    """A road: its recipe, and where along the way it starts [m]."""

    recipe: Recipe
    start: float


def read_road(settings: Mapping[str, Any]) -> RandomRoad:
    """Reads the settings of a road. InputError for what is no recipe."""
    values = dict(settings)
    start = take_number(values, "start", 0.0)
    seed = values.pop("seed", 1)
    if not isinstance(seed, int) or isinstance(seed, bool):
        raise InputError(f"random_road: error: 'seed', got {seed!r}, expected a whole number")
    iso_class = values.pop("class", None)
    if iso_class is not None and iso_class not in tuple(ISO_CLASSES):
        raise InputError(f"random_road: error: 'class', got {iso_class!r}, expected A to H")
    exponent = take_number(values, "exponent", ISO_EXPONENT)
    if iso_class is not None and exponent != ISO_EXPONENT:
        expected = f"expected {ISO_EXPONENT:g}, that of an ISO 8608 class"
        raise InputError(f"random_road: error: 'exponent', got {exponent:g}, {expected}")
    band = values.pop("band", list(ISO_BAND))
    if not isinstance(band, list) or len(band) != 2:
        raise InputError(f"random_road: error: 'band', got {band!r}, expected [lowest, highest] (1/m)")
    low, high = (take_number({"band": one}, "band") for one in band)
    levels = [key for key in ("rms", "density") if key in values] + (["class"] if iso_class else [])
    if len(levels) != 1:
        raise InputError(f"random_road: error: needs one of class, rms, density; got {', '.join(levels) or 'none'}")
    recipe = Recipe(
        length=take_number(values, "length"), spacing=take_number(values, "spacing"), band=(low, high),
        exponent=exponent, rms=take_number(values, "rms", 0.0),
        density=calc_iso_density(iso_class) if iso_class else take_number(values, "density", 0.0),
        ease=take_number(values, "ease", 0.0), seed=seed,
    )  # fmt: skip
    return RandomRoad(recipe, start)


def take_number(values: dict[str, Any], key: str, default: float | None = None) -> float:
    """Takes a number from settings. InputError if it is none, or is missing without a default."""
    value = values.pop(key, default)
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not abs(value) <= sys.float_info.max:
        raise InputError(f"random_road: error: '{key}', got {value!r}, expected a finite number")
    return float(value)


def write_road(settings: Mapping[str, Any], folder: Path) -> tuple[dict[str, Any], str]:
    """Writes the road table of some settings into a folder, unless it is there. Returns the table `road` of the run
    file, and the hash of the road. InputError for settings that make no road."""
    road = read_road(settings)
    try:
        text = format_profile(road.recipe, make_profile(road.recipe), "tools/study")
    except InputError as error:
        raise InputError(f"random_road: {str(error).replace('--', '')}") from error
    content = hash_parts([text.encode(), repr(road.start).encode()])
    path = folder / f"{content[:16]}.txt"
    if not path.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        write_whole(path, text)
    return {"shape": "table", "start": road.start, "file": str(path.resolve())}, content
