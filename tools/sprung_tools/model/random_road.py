"""What was asked for of a random road: its points stand in the model as run, its class and seed only in the texts of
the run file and of `--set`."""

import tomllib
from typing import Any

from sprung_tools.files.hdf5_file import read_text, read_texts
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.files.toml_text import split_key, strip_quotes

WHERE = "model/road"
SEED = 1  # the default


def read_random_road(results: ResultsFile) -> dict[str, Any]:
    """The keys of [road] of a run on a random road, with its shape and its seed; empty for another road. Only the shape
    where the texts do not tell the others."""
    file = results.file
    if not file.has_group(WHERE) or read_text(file, WHERE, "shape", "") != "random":
        return {}
    texts, overrides = (
        read_texts(file, name) if file.has_dataset(name) else [] for name in ("model/run_text", "model/overrides")
    )
    try:
        road = tomllib.loads("\n".join(texts).removeprefix("\ufeff")).get("road", {})
    except tomllib.TOMLDecodeError:
        road = {}
    for one in overrides:
        key, _, value = one.partition("=")
        first, *behind = [strip_quotes(part) for part in split_key(key)] or [""]
        if first == "road" and not behind:
            road = parse_value(value)
        elif first == "road" and isinstance(road, dict):
            road = road | {behind[0]: parse_value(value)}
    return {"seed": SEED, **road, "shape": "random"} if isinstance(road, dict) and road else {"shape": "random"}


def parse_value(text: str) -> Any:
    """A value as `--set` takes it: in TOML, or a bare word."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text.strip()
