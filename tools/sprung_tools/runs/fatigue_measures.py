"""What the fatigue of a body is at a place, and at its worst one as measures of a run: tools/README.md, "Fatigue"."""

from functools import partial

from sprung_tools.files.results_file import ResultsFile
from sprung_tools.runs.fatigue import Fatigue, calc_fatigue, calc_life
from sprung_tools.runs.measures import Measures, Objects, combine
from sprung_tools.runs.section_stress import list_sources, list_stressed_bodies
from sprung_tools.signals.fatigue_damage import StrengthLine
from sprung_tools.signals.spans import Span

FATIGUE = "fatigue"  # the first part of the names of these measures
FATIGUE_UNITS = {"damage": "1", "x": "m", "y": "m", "element": "1", "highest": "Pa", "lowest": "Pa",
                 "largest_range": "Pa", "life": "s"}  # fmt: skip


def describe_place(fatigue: Fatigue, duration: float, station: int, side: int) -> dict[str, float | None]:
    """What the fatigue of a body is at a fibre, in the order of FATIGUE_UNITS. duration: of what is repeated [s]."""
    section, stress = fatigue.section, fatigue.section.stress[:, station, side]
    x, y = map(float, section.positions[station])
    damage = float(fatigue.damage[station, side])
    return {
        "damage": damage, "x": x, "y": y, "element": int(section.elements[station]), "highest": float(stress.max()),
        "lowest": float(stress.min()), "largest_range": float(fatigue.greatest_range[station, side]),
        "life": calc_life(damage, duration),
    }  # fmt: skip


def name_fatigue(body: str, source: str) -> str:
    """What the measures of a body begin with. source: what the loads of its sections are from."""
    return f"{FATIGUE}/{body}/from_{source}"


def pack_fatigue(body: str, source: str, fatigue: Fatigue, duration: float) -> Measures:
    """The measures of a body's worst fibre."""
    worst = describe_place(fatigue, duration, *fatigue.worst)
    return combine(name_fatigue(body, source), FATIGUE_UNITS, worst.values())


def measure_fatigue(
    results: ResultsFile, body: str, source: str, window: Span, line: StrengthLine, factor: float
) -> Measures:
    """The same of a run, over a span of time. Raises as calc_fatigue()."""
    fatigue = calc_fatigue(results, body, source, window, line, factor)
    return pack_fatigue(body, source, fatigue, window[1] - window[0])


def list_fatigue_objects(results: ResultsFile, window: Span, line: StrengthLine, factor: float) -> Objects:
    """The bodies of a run that have measures of fatigue."""
    return {
        name_fatigue(body, source): partial(measure_fatigue, results, body, source, window, line, factor)
        for body in list_stressed_bodies(results) for source in list_sources(results, body)
    }  # fmt: skip
