"""Runs of the truck with a certified basis of the chassis beside as many clamped modes: what a coordinate costs."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sprung_tools.benchmark.programs import run_program
from sprung_tools.files.project import ROOT
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.terminal.text_table import format_table

RUN = ROOT / "dynamics/models/truck/bump.toml"
CERTIFIED = ("vehicle.bodies.chassis.superelement=chassis_certified", 'modes.chassis="certified"')


class BasisCost(NamedTuple):
    """A run without outputs. seconds: processor time of its integration, the median."""

    basis: str
    freedoms: int
    evaluations: int
    seconds: float

    @property
    def per_freedom(self) -> float:
        """Of the run [s]."""
        return self.seconds / self.freedoms

    @property
    def per_evaluation(self) -> float:
        """Of an evaluation, per freedom [s]."""
        return self.per_freedom / self.evaluations


def measure_bases(program: Path, superelements: Path, repetitions: int, duration: float | None) -> list[BasisCost]:
    """Measures both bases in turns, so that a drift of the machine's speed meets both."""
    end = duration if duration is not None else float(TomlFile(RUN).data["duration"])
    settings = [f"duration={end}", f"output_step={end}", "adaptivity.indicator=false"]
    command: list[str | Path | float] = [program, "run", RUN, "--superelements", superelements, "--json", "--quiet"]
    found: dict[str, list[dict[str, Any]]] = {"certified": [], "clamped": []}
    numbers: list[int] = []  # of the vectors
    for _ in range(repetitions):
        for basis, runs in found.items():
            changes = [*settings, *(CERTIFIED if basis == "certified" else [f"modes.chassis={numbers}"])]
            words = [word for one in changes for word in ("--set", one)]
            said = json.loads(run_program([*command, *words]))
            numbers = said["parameters"]["modes"]["chassis"]
            runs.append(said)
    return [
        BasisCost(basis, runs[0]["freedoms"], runs[0]["evaluations"],
                  float(np.median([one["integration_cpu_time"] for one in runs])))
        for basis, runs in found.items()
    ]  # fmt: skip


def format_bases(costs: Sequence[BasisCost]) -> str:
    """A table of the costs, with ratios to the last row."""
    last = costs[-1]
    rows = [
        (one.basis, str(one.freedoms), str(one.evaluations), f"{1e3 * one.seconds:.1f}",
         f"{1e3 * one.per_freedom:.2f}", f"{one.per_freedom / last.per_freedom:.2f}",
         f"{1e9 * one.per_evaluation:.0f}", f"{one.per_evaluation / last.per_evaluation:.2f}")
        for one in costs
    ]  # fmt: skip
    headings = ("basis", "freedoms", "evaluations", "CPU ms", "ms per freedom", "to clamped",
                "ns per freedom and evaluation", "to clamped")  # fmt: skip
    return format_table(headings, rows)
