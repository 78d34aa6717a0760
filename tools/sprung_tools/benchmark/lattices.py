"""Whole builds of large lattices: what stage one takes of processor time and memory, and what others take of it;
builds of a lattice that hangs on a thin rod; and the methods between which the number of freedoms chooses."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from sprung_tools.benchmark.calculix_lattice import make_deck
from sprung_tools.files.whole_file import write_whole

SPACING = 0.5  # m between crossings
NUM_MODES = 20
COLUMNS = 3 * NUM_MODES  # solutions that as many modes need at least
CALCULIX_BYTES = 40_000  # of memory for each freedom, by version 2.20 with 100 000 and 300 000
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
{more}[reference]
point = "{reference}"
[modes]
{count}damping_ratio = 0.01
[reduction]
basis = "{basis}"
highest_frequency = {highest:.6g}
[interface]
"""
MOST_LOADED = 8  # named points in the interface
ROD = """[sections.rod]
material = "steel"
shape = "rectangle"
width = 0.005
height = 0.005
"""


class Lattice(NamedTuple):
    """A square lattice of cells × cells with named points. Loads act at MOST_LOADED of them, at equal steps."""

    cells: int
    points: int

    @property
    def freedoms(self) -> int:
        return 3 * (self.cells + 1) ** 2 - 3

    @property
    def middle(self) -> int:
        """The number of the reference node, from 1."""
        return (self.cells // 2) * (self.cells + 1) + self.cells // 2 + 1


class Cost(NamedTuple):
    """What a process took."""

    seconds: float  # of processor time, system included
    megabytes: float  # at most in use


class Limit(NamedTuple):
    """Processor times that no build can do without [s]: analysis and factors of the stiffness, solutions in blocks for
    COLUMNS right-hand sides, and one count of the modes."""

    analysis: float
    factor: float
    solutions: float
    counting: float
    megabytes: float  # at most in use

    @property
    def total(self) -> float:
        return self.analysis + self.factor + self.solutions + self.counting


class BuildCost(NamedTuple):
    lattice: Lattice
    build: Cost
    outcome: str  # what the program said
    limit: Limit
    cholmod: Limit | None  # with CHOLMOD's factors and solutions in place of ours
    scipy: Cost  # shift-invert Lanczos for NUM_MODES clamped modes
    calculix: Cost | None  # a whole run of ccx for as many modes


class HangingBuild(NamedTuple):
    """The build of a lattice whose reference node hangs on a rod."""

    lattice: Lattice
    basis: str
    build: Cost
    outcome: str


class MethodCosts(NamedTuple):
    """Processor times of both methods for factors with COLUMNS solutions, and for NUM_MODES modes [s]."""

    freedoms: int
    simplicial: float
    supernodal: float | None  # None without CHOLMOD
    restarts: float
    blocks: float


LATTICES = (Lattice(49, 1000), Lattice(100, 8), Lattice(182, 8), Lattice(316, 8), Lattice(577, 8))
QUICK_LATTICES = (Lattice(20, 4), Lattice(8, 2))
HANGING = Lattice(20, 4)
METHOD_LATTICES = (Lattice(25, 8), Lattice(40, 8), Lattice(81, 8), Lattice(182, 8))


def make_mesh(lattice: Lattice, hanging: bool = False) -> str:
    """A .msh file of version 2.2. The named points lie at equal steps through the numbers of the nodes. hanging: with a
    rod from the first node to a point "hook"."""
    row = lattice.cells + 1
    nodes = row * row
    middle = lattice.middle
    step = max(1, nodes // (lattice.points + 1))
    places = [number for number in range(step, nodes + 1, step) if number != middle][: lattice.points]
    names = [("middle", middle), *((f"p{index}", number) for index, number in enumerate(places))]
    bars = [(n, n + 1) for n in range(1, nodes + 1) if n % row] + [(n, n + row) for n in range(1, nodes - row + 1)]
    if hanging:
        names.append(("hook", nodes + 1))
    rod = len(names) + 2  # its tag
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(1 + len(names) + hanging), '1 1 "bar"']
    lines += [f'1 {rod} "rod"'] * hanging
    lines += [f'0 {tag} "{name}"' for tag, (name, _) in enumerate(names, 2)]
    lines += ["$EndPhysicalNames", "$Nodes", str(nodes + hanging)]
    lines += [f"{n} {(n - 1) % row * SPACING} {(n - 1) // row * SPACING} 0" for n in range(1, nodes + 1)]
    lines += [f"{nodes + 1} 0 {-SPACING} 0"] * hanging
    lines += ["$EndNodes", "$Elements", str(len(names) + len(bars) + hanging)]
    lines += [f"{tag - 1} 15 2 {tag} {tag} {number}" for tag, (_, number) in enumerate(names, 2)]
    lines += [f"{tag} 1 2 1 1 {first} {second}" for tag, (first, second) in enumerate(bars, len(names) + 1)]
    lines += [f"{len(names) + len(bars) + 1} 1 2 {rod} {rod} 1 {nodes + 1}"] * hanging
    return "\n".join([*lines, "$EndElements", ""])


def choose_band(lattice: Lattice) -> float:
    """A band with some 20 free modes below 1.5 times its end: a lattice of bars is a plate that shears softly, whose
    frequencies fall with its width [Hz]."""
    return 1950.0 / lattice.cells


def run_measured(command: Sequence[str | Path], folder: Path) -> tuple[str, Cost]:
    """Runs a program in a folder. Returns what it printed, and what it took."""
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert process.stdout is not None
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    process.stdout.close()
    return text, Cost(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0)


def measure_limit(program: str | Path, lattice: Lattice, folder: Path, *flags: str) -> Limit | None:
    """Measures the steps of a lattice in a folder by tests/benchmark/factor_benchmark. flags: its further options.
    Returns None if they ask for CHOLMOD, and it was built without."""
    band = f"{1.5 * choose_band(lattice):.6g}"
    command = [program, "lattice.toml", "--columns", f"{COLUMNS}", "--count-below", band, *flags]
    text, cost = run_measured(command, folder)
    if "built without CHOLMOD" in text:
        return None
    said = json.loads(text)
    return Limit(said["analysis"], said["factor"], said["solutions"], said["count"], cost.megabytes)


def measure_scipy(program: str | Path, lattice: Lattice, folder: Path) -> Cost:
    """Runs scipy on the matrices that sprung-reduce writes. The time is without reading them, the memory is that of the
    whole process."""
    prefix = folder / "frame"
    command = [program, "matrices", "lattice.toml", "-o", prefix]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    module = "sprung_tools.benchmark.scipy_lattice"
    command = [sys.executable, "-m", module, prefix, f"{lattice.middle}", f"{NUM_MODES}"]
    text, cost = run_measured(command, Path(__file__).resolve().parents[2])
    return Cost(float(text), cost.megabytes)


def measure_calculix(program: str, lattice: Lattice, folder: Path) -> Cost | None:
    """A whole run of CalculiX; None if it does not reach its end."""
    deck = make_deck(lattice.cells, SPACING, lattice.middle, NUM_MODES)
    write_whole(folder / "lattice.inp", deck.encode())
    text, cost = run_measured([program, "lattice"], folder)
    return cost if "Job finished" in text else None


def write_lattice(lattice: Lattice, folder: Path, basis: str = "free", hanging: bool = False) -> None:
    """Writes lattice.msh and lattice.toml."""
    os.makedirs(folder, exist_ok=True)
    write_whole(folder / "lattice.msh", make_mesh(lattice, hanging).encode())
    loaded = range(0, lattice.points, -(-lattice.points // MOST_LOADED))
    design = DESIGN.format(
        highest=choose_band(lattice), more=ROD if hanging else "", reference="hook" if hanging else "middle",
        count=f"count = {NUM_MODES}\n" if basis == "clamped" else "", basis=basis,
    )  # fmt: skip
    design += "".join(f'p{index} = "xyr"\n' for index in loaded)
    write_whole(folder / "lattice.toml", design.encode())


def build_lattice(programs: Path, folder: Path) -> tuple[Cost, str]:
    """Builds the lattice of a folder in a process of its own. Returns what that took, and what the program said."""
    command: list[str | Path] = [programs / "reduce/sprung-reduce", "build", "lattice.toml", "--force", "-o", "."]
    text, cost = run_measured(command, folder)
    said = [line for line in text.splitlines() if ": building" not in line and ": remark" not in line]
    return cost, said[0].split(": ", 1)[-1] if said else ""


def measure_hanging(programs: Path, lattice: Lattice, folder: Path) -> list[HangingBuild]:
    """Builds a lattice that is held at the end of a rod, by a basis of modes of the held body and by a free one."""
    costs = []
    for basis in ("clamped", "free"):
        write_lattice(lattice, folder, basis, hanging=True)
        costs.append(HangingBuild(lattice, basis, *build_lattice(programs, folder)))
    return costs


def measure_methods(programs: Path, lattice: Lattice, folder: Path) -> MethodCosts:
    """Measures the methods for small and for large frames on one lattice, by tests/benchmark/factor_benchmark."""
    write_lattice(lattice, folder)
    steps = programs / "tests/benchmark/factor_benchmark"
    command: list[str | Path] = [steps, "lattice.toml", "--columns", f"{COLUMNS}", "--methods", f"{NUM_MODES}"]
    said = json.loads(run_measured(command, folder)[0])
    return MethodCosts(said["freedoms"], said["simplicial"], said["supernodal"], said["restarts"], said["blocks"])


def measure_build(programs: Path, lattice: Lattice, folder: Path) -> BuildCost:
    """Builds a lattice in a process of its own, and measures that; beside it its limit, scipy, and CalculiX where it is
    installed. programs: the build folder."""
    program = programs / "reduce/sprung-reduce"
    write_lattice(lattice, folder)
    build, outcome = build_lattice(programs, folder)
    steps = programs / "tests/benchmark/factor_benchmark"
    limit = measure_limit(steps, lattice, folder)
    assert limit is not None
    cholmod = measure_limit(steps, lattice, folder, "--cholmod")
    scipy = measure_scipy(program, lattice, folder)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    ccx = shutil.which("ccx") if CALCULIX_BYTES * lattice.freedoms < memory else None
    calculix = measure_calculix(ccx, lattice, folder) if ccx else None
    return BuildCost(lattice, build, outcome, limit, cholmod, scipy, calculix)


def format_cost(cost: Cost | None) -> str:
    """Seconds and megabytes of another program."""
    return f"  {'–':>8}  {'–':>6}" if cost is None else f"  {cost.seconds:>8.2f}  {cost.megabytes:>6.0f}"


def format_builds(costs: Sequence[BuildCost]) -> str:
    """A table of builds, one line each. Without CalculiX its column is left out, and a line says so."""
    has_calculix = shutil.which("ccx") is not None
    names = ("limit s", "analysis", "factor", "solve", "count")
    heading = f"{'freedoms':>9}  {'points':>6}  {'CPU s':>8}  {'MB':>6}" + "".join(f"  {name:>8}" for name in names)
    heading += f"  {'MB':>6}  {'CHOLMOD s':>9}  {'scipy s':>8}  {'MB':>6}" + f"  {'ccx s':>8}  {'MB':>6}" * has_calculix
    rows = [heading + "  outcome"]
    for cost in costs:
        limit = cost.limit
        cells = f"{cost.lattice.freedoms:>9}  {cost.lattice.points:>6}  {cost.build.seconds:>8.2f}"
        cells += f"  {cost.build.megabytes:>6.0f}"
        parts = (limit.total, limit.analysis, limit.factor, limit.solutions, limit.counting)
        cells += "".join(f"  {one:>8.2f}" for one in parts)
        cells += f"  {limit.megabytes:>6.0f}"
        cells += f"  {cost.cholmod.total:>9.2f}" if cost.cholmod else f"  {'–':>9}"
        cells += format_cost(cost.scipy)
        rows.append(cells + (format_cost(cost.calculix) if has_calculix else "") + f"  {cost.outcome}")
    if not has_calculix:
        rows.append("no column of CalculiX: ccx (Debian: calculix-ccx) is not in PATH")
    return "\n".join(rows)


def format_hanging(costs: Sequence[HangingBuild]) -> str:
    """A table of builds of a lattice that hangs on a thin rod."""
    rows = [f"{'freedoms':>9}  {'basis':>8}  {'CPU s':>8}  {'MB':>6}  outcome"]
    for one in costs:
        cost = f"{one.build.seconds:>8.2f}  {one.build.megabytes:>6.0f}"
        rows.append(f"{one.lattice.freedoms + 3:>9}  {one.basis:>8}  {cost}  {one.outcome}")
    return "\n".join(rows)


def format_methods(costs: Sequence[MethodCosts]) -> str:
    """A table of the methods for small and for large frames."""
    rows = [f"{'freedoms':>9}  {'simplicial':>10}  {'supernodal':>10}  {'restarts':>9}  {'blocks':>9}"]
    for one in costs:
        supernodal = f"{'–':>10}" if one.supernodal is None else f"{one.supernodal:>10.3f}"
        rows.append(
            f"{one.freedoms:>9}  {one.simplicial:>10.3f}  {supernodal}  {one.restarts:>9.3f}  {one.blocks:>9.3f}"
        )
    return "\n".join(rows)
