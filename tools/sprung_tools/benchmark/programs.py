"""Running the benchmark programs: single evaluations, and the growth of the cost with the number of bodies."""

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sprung_tools.files.errors import InputError

Times = dict[tuple[str, int], float]  # kind ("fast" or "dense"), modes → s


def run_program(command: Sequence[str | Path | float]) -> str:
    """Runs a program. Returns its output. InputError, with the program's message, if it fails."""
    try:
        process = subprocess.run(list(map(str, command)), capture_output=True, encoding="utf-8", errors="replace")
    except OSError as error:
        raise InputError(f"{command[0]}: error: {error.strerror}; build it: tools/build") from error
    if process.returncode != 0:
        raise InputError(process.stderr.strip() or f"{command[0]}: error: exit code {process.returncode}")
    return process.stdout


def measure_evaluations(program: Path, repetitions: int, min_time: float) -> Times:
    """Measures single evaluations by evaluation_benchmark. Returns medians."""
    text = run_program(
        [program, "--benchmark_format=json", f"--benchmark_repetitions={repetitions}",
         f"--benchmark_min_time={min_time}", "--benchmark_enable_random_interleaving=true"]
    )  # fmt: skip
    times: dict[tuple[str, int], list[float]] = {}
    for entry in json.loads(text)["benchmarks"]:
        if entry["run_type"] != "iteration":
            continue
        name, modes = entry["run_name"].split("/")[:2]
        key = (name.removesuffix("_evaluation"), int(modes))
        times.setdefault(key, []).append(1e-6 * entry["cpu_time"])
    return {key: float(np.median(values)) for key, values in times.items()}


def measure_growth(program: Path, sizes: Sequence[int], num_steps: int) -> list[dict[str, Any]]:
    """Measures models of several sizes by growth_benchmark. Returns its lines."""
    text = run_program([program, *sizes, "--steps", num_steps])
    return [json.loads(line) for line in text.splitlines()]
