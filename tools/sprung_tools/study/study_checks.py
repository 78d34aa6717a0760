"""Mistakes in the keys and names of a study, each told at its place in the file."""

from sprung_tools.files.toml_text import cut_key, flatten_settings, format_key, split_key, strip_quotes
from sprung_tools.runs.fatigue_measures import FATIGUE
from sprung_tools.study.description import (
    COLUMNS_BEFORE,
    COLUMNS_BEHIND,
    DESIGN,
    RANDOM_ROAD,
    ROAD,
    ROAD_KEYS,
    Study,
    fail_at_key,
)
from sprung_tools.study.same_keys import Parts, read_values, resolve_key

NO_KEY = "is no key: names with dots between, in quotes where they hold a dot"


def check_study(study: Study) -> None:
    """Throws InputError for the first mistake."""
    check_names(study)
    check_fatigue(study)
    check_keys(study)
    check_overlaps(study)
    if study.random_road:
        check_road(study)


def check_names(study: Study) -> None:
    """Throws InputError for a name that two columns of the table would have."""
    taken = {*COLUMNS_BEFORE, *COLUMNS_BEHIND}
    for parameter in study.parameters:
        if parameter.name in taken:
            raise fail_at_key(study, parameter.keys[0], f"'{parameter.name}' is a column of the table; give a 'name'")
        taken.add(parameter.name)
    for name, label in study.measures.items():
        if label in taken:
            what = f"'{label}' is a parameter or another column of the table, expected another label"
            raise study.file.fail(("measures",), what, fragment=f"{label}={name}")


def check_fatigue(study: Study) -> None:
    """Throws InputError for measures of fatigue without a strength, or of anything but runs; and for a strength without
    such measures."""
    wanted = [name for name in study.measures if name.startswith(f"{FATIGUE}/")]
    if wanted and study.command != "run":
        raise study.file.fail(("measures",), f"'{wanted[0]}' is a measure of runs alone", fragment=wanted[0])
    if wanted and study.strength is None:
        what = f"'{wanted[0]}' needs the table [{FATIGUE}] with a 'category'"
        raise study.file.fail(("measures",), what, fragment=wanted[0])
    if study.strength is not None and not wanted:
        raise study.file.fail((FATIGUE,), f"'{FATIGUE}' has no effect without a measure '{FATIGUE}/…'")


def check_keys(study: Study) -> None:
    """Throws InputError for what is no key, and for keys of designs and of the random road that lead nowhere."""
    for parameter in study.parameters:
        at = (*parameter.place, "key")
        if at not in study.file.places():
            at = (*parameter.place, "keys")
        for key in parameter.keys:
            parts = split_key(key)
            if not parts:
                raise study.file.fail(at, f"'{key}' {NO_KEY}", fragment=key)
            first = strip_quotes(parts[0])
            if first == DESIGN:
                if not any(cut_key(key, DESIGN, name) for name in study.designs):
                    there = ", ".join(map(format_key, study.designs)) or "none"
                    raise study.file.fail(at, f"'{key}' is no key of a design (designs: {there})", fragment=key)
            elif first == RANDOM_ROAD and len(parts) > 1:
                if cut_key(key, RANDOM_ROAD) not in ROAD_KEYS:
                    raise study.file.fail(at, f"'{key}' is unknown (keys of the random road: {', '.join(ROAD_KEYS)})",
                                          fragment=key)  # fmt: skip
                if not study.random_road:
                    raise study.file.fail(at, f"'{key}' needs a table [random_road]", fragment=key)


def check_overlaps(study: Study) -> None:
    """Throws InputError for a key that another one sets, or inside the table that another one sets: one of them would
    have no effect."""
    of_parameters, of_all = [key for one in study.parameters for key in one.keys], flatten_settings(study.overrides)
    for key in of_all:
        if not split_key(key):
            raise fail_at_key(study, key, f"'{key}' {NO_KEY}")
        if key in of_parameters:
            raise fail_at_key(study, key, f"'{key}' is set for all runs by 'set', too")
    values = read_values(study)
    parts = {key: resolve_key(key, values) for key in (*of_parameters, *of_all)}
    first: dict[Parts, str] = {}
    for key, own in parts.items():
        if first.setdefault(own, key) != key:
            raise fail_at_key(study, key, f"'{key}' means the same as '{first[own]}', which is set, too")
        if study.random_road and own[:1] == (ROAD,):
            raise fail_at_key(study, key, f"'{key}' has no effect: [random_road] makes the road")
        for other, whole in parts.items():
            if len(whole) < len(own) and own[: len(whole)] == whole:
                raise fail_at_key(study, key, f"'{key}' lies in '{other}', which is set as a whole, too")


def check_road(study: Study) -> None:
    """Throws InputError where neither the table of the random road, nor a parameter, nor 'set' has what it needs."""
    given = {cut_key(key, RANDOM_ROAD) for one in study.parameters for key in one.keys}
    given |= {cut_key(key, RANDOM_ROAD) for key in study.overrides}
    given |= set(study.random_road) | set(study.overrides.get(RANDOM_ROAD, {}))
    for key in ("length", "spacing"):
        if key not in given:
            raise study.file.fail(("random_road",), f"'{key}' is missing in 'random_road', expected a number in m")
    levels = [key for key in ("class", "rms", "density") if key in given]
    if len(levels) != 1:
        found = " and ".join(levels) or "none"
        raise study.file.fail(("random_road",), f"'random_road' needs one of 'class', 'rms', 'density', got {found}")
