"""The page of a study: scatter of any two columns, heat map, parallel coordinates, best runs, main effects. It is one
file, which a browser opens without a network."""

import html
import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.report.template import WEB, fill_template, pack_json, read_asset
from sprung_tools.study.effects import Effect
from sprung_tools.study.execution import Finished
from sprung_tools.study.table import Column, are_numbers, format_cell, list_distinct

STUDY_WEB = os.path.join(os.path.dirname(os.path.realpath(__file__)), "web")
SHARED_SCRIPTS = ("common.js", "save.js")  # of the report's page
SCRIPTS = ("columns.js", "best.js", "scatter.js", "heat_map.js", "parallel.js", "effects.js", "study.js")


def make_study_page(finished: Finished, columns: Sequence[Column], effects: Sequence[Effect]) -> str:
    """The page's text."""
    title = finished.study.file.path.stem
    scripts = [os.path.join(WEB, name) for name in SHARED_SCRIPTS] + [os.path.join(STUDY_WEB, name) for name in SCRIPTS]
    parts = {
        "TITLE": html.escape(title),
        "STYLE": read_asset(os.path.join(WEB, "page.css")) + read_asset(os.path.join(STUDY_WEB, "study.css")),
        "DATA": pack_json(pack_study(title, finished, columns, effects)),
        "SCRIPT": "\n".join(read_asset(path) for path in scripts),
    }
    return fill_template(read_asset(os.path.join(STUDY_WEB, "study.html")), parts)


def pack_study(
    title: str, finished: Finished, columns: Sequence[Column], effects: Sequence[Effect]
) -> dict[str, Any]:  # fmt: skip
    """The data of the page."""
    parameters = [
        {"name": one.name, **pack_values([point[number] for point in finished.points])}
        for number, one in enumerate(finished.study.parameters)
    ]
    measures = [{"name": one.name, "unit": one.unit, "values": pack_numbers(one.values)} for one in columns]
    texts: dict[str, int] = {}  # each text once, however many runs say it
    rows = [
        {"exit": row.exit_code, "isError": bool(row.error),
         "texts": [texts.setdefault(text, len(texts)) for text in ([row.error] if row.error else row.warnings)]}
        for row in finished.rows
    ]  # fmt: skip
    packed_effects = [
        {**one._asdict(), "means": pack_numbers(one.means), "counts": one.counts.tolist()} for one in effects
    ]
    study = finished.study
    return {
        "title": title, "run": study.run.name, "command": study.command, "method": study.sampling.method,
        "parameters": parameters, "measures": measures, "rows": rows, "texts": list(texts),
        "effects": packed_effects,
    }  # fmt: skip


def pack_values(values: Sequence[Any]) -> dict[str, Any]:
    """The values of a parameter: numbers, or texts and what there are of these in the order of the scales."""
    if are_numbers(values):
        return {"values": [float(one) for one in values]}
    return {"values": [format_cell(one) for one in values], "categories": list_distinct(values)}


def pack_numbers(values: Floats) -> list[float | None]:
    """Numbers with nine digits, which are enough to draw and compare them; None where there is none."""
    return [None if np.isnan(one) else float(f"{one:.9g}") for one in values]
