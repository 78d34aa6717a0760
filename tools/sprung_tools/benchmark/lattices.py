"""Whole builds of large lattices: what stage one takes of processor time and memory."""

import json
import os
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.io import mmread
from scipy.sparse.linalg import eigsh

from sprung_tools.files.whole_file import write_whole

SPACING = 0.5  # m between crossings
NUM_MODES = 20
COLUMNS = 3 * NUM_MODES  # solutions that as many modes need at least
MOST_SCIPY = 400_000  # freedoms; beyond, its factors need more memory than whole builds
DESIGN = """mesh = "lattice.msh"
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.bar]
material = "steel"
shape = "box"
width = 0.05
height = 0.05
wall = 0.003
[reference]
point = "middle"
[modes]
damping_ratio = 0.01
[reduction]
highest_frequency = {highest:.6g}
"""


class Lattice(NamedTuple):
    """A square lattice of cells × cells, with named points where loads act."""

    cells: int
    points: int

    @property
    def freedoms(self) -> int:
        return 3 * (self.cells + 1) ** 2 - 3

    @property
    def middle(self) -> int:
        """The number of the reference node, from 1."""
        return (self.cells // 2) * (self.cells + 1) + self.cells // 2 + 1


class Limit(NamedTuple):
    """Processor times that no build can do without [s]: analysis and factors of the stiffness, solutions in blocks for
    COLUMNS right-hand sides, and one count of the modes."""

    factor: float
    solutions: float
    counting: float

    @property
    def total(self) -> float:
        return self.factor + self.solutions + self.counting


class BuildCost(NamedTuple):
    lattice: Lattice
    seconds: float  # of processor time, system included
    megabytes: float  # at most in use
    outcome: str  # what the program said
    limit: Limit
    scipy: float | None  # processor time of scipy's shift-invert Lanczos for NUM_MODES clamped modes, from its matrices


LATTICES = (Lattice(49, 1000), Lattice(182, 8), Lattice(316, 8), Lattice(577, 8))
QUICK_LATTICES = (Lattice(20, 4), Lattice(8, 2))


def make_mesh(lattice: Lattice) -> str:
    """A .msh file of version 2.2. The named points lie at equal steps through the numbers of the nodes."""
    row = lattice.cells + 1
    nodes = row * row
    middle = lattice.middle
    step = max(1, nodes // (lattice.points + 1))
    places = [number for number in range(step, nodes + 1, step) if number != middle][: lattice.points]
    names = [("middle", middle), *((f"p{index}", number) for index, number in enumerate(places))]
    bars = [(n, n + 1) for n in range(1, nodes + 1) if n % row] + [(n, n + row) for n in range(1, nodes - row + 1)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(1 + len(names)), '1 1 "bar"']
    lines += [f'0 {tag} "{name}"' for tag, (name, _) in enumerate(names, 2)]
    lines += ["$EndPhysicalNames", "$Nodes", str(nodes)]
    lines += [f"{n} {(n - 1) % row * SPACING} {(n - 1) // row * SPACING} 0" for n in range(1, nodes + 1)]
    lines += ["$EndNodes", "$Elements", str(len(names) + len(bars))]
    lines += [f"{tag - 1} 15 2 {tag} {tag} {number}" for tag, (_, number) in enumerate(names, 2)]
    lines += [f"{tag} 1 2 1 1 {first} {second}" for tag, (first, second) in enumerate(bars, len(names) + 1)]
    return "\n".join([*lines, "$EndElements", ""])


def choose_band(lattice: Lattice) -> float:
    """A band with some 20 free modes below 1.5 times its end: a lattice of bars is a plate that shears softly, whose
    frequencies fall with its width [Hz]."""
    return 1950.0 / lattice.cells


def measure_limit(program: str | Path, lattice: Lattice, folder: Path) -> Limit:
    """Measures the steps of a lattice in a folder by tests/benchmark/factor_benchmark."""
    command = [program, "lattice.toml", "--columns", f"{COLUMNS}", "--count-below", f"{1.5 * choose_band(lattice):.6g}"]
    said = json.loads(subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE).stdout)
    return Limit(said["factor"], said["solutions"], said["count"])


def measure_scipy(program: str | Path, lattice: Lattice, folder: Path) -> float:
    """The processor time of scipy's Lanczos iteration on K⁻¹M for the lattice in a folder, held at its reference, once
    its matrices are read [s]."""
    prefix = folder / "frame"
    command = [program, "matrices", "lattice.toml", "-o", prefix]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    stiffness, mass = (mmread(f"{prefix}_{name}.mtx").tocsc() for name in ("stiffness", "mass"))
    free = np.setdiff1d(np.arange(stiffness.shape[0]), 3 * (lattice.middle - 1) + np.arange(3))
    stiffness, mass = (matrix[free][:, free] for matrix in (stiffness, mass))
    start = time.process_time()
    eigsh(stiffness, k=min(NUM_MODES, free.size - 1), M=mass, sigma=0.0)
    return time.process_time() - start


def measure_build(programs: Path, lattice: Lattice, folder: Path) -> BuildCost:
    """Builds a lattice in a process of its own, and measures that; beside it its limit, and scipy. programs: the build
    folder."""
    program = programs / "reduce/sprung-reduce"
    os.makedirs(folder, exist_ok=True)
    write_whole(folder / "lattice.msh", make_mesh(lattice).encode())
    write_whole(folder / "lattice.toml", DESIGN.format(highest=choose_band(lattice)).encode())
    process = subprocess.Popen(
        [program, "build", "lattice.toml", "--force", "-o", "."], cwd=folder,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    text = process.stdout.read()
    usage = os.wait4(process.pid, 0)[2]
    process.stdout.close()
    said = [line for line in text.splitlines() if ": building" not in line]
    outcome = said[0].split(": ", 1)[-1] if said else ""
    limit = measure_limit(programs / "tests/benchmark/factor_benchmark", lattice, folder)
    scipy = measure_scipy(program, lattice, folder) if lattice.freedoms <= MOST_SCIPY else None
    return BuildCost(lattice, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0, outcome, limit, scipy)


def format_builds(costs: Sequence[BuildCost]) -> str:
    """A table of builds, one line each."""
    names = ("limit s", "factor", "solve", "count", "scipy s")
    heading = f"{'freedoms':>9}  {'points':>6}  {'CPU s':>8}  {'memory MB':>9}"
    rows = [heading + "".join(f"  {name:>8}" for name in names) + "  outcome"]
    for cost in costs:
        size = f"{cost.lattice.freedoms:>9}  {cost.lattice.points:>6}"
        times = [cost.limit.total, *cost.limit, cost.scipy]
        cells = "".join(f"  {'–' if one is None else f'{one:.2f}':>8}" for one in times)
        rows.append(f"{size}  {cost.seconds:>8.2f}  {cost.megabytes:>9.0f}{cells}  {cost.outcome}")
    return "\n".join(rows)
