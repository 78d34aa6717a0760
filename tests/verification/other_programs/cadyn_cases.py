#!/usr/bin/python3
"""The swinging beam and the chassis on springs for CADyn. Prints the rows of the tables cadyn_CASE.txt.

    cadyn_cases.py BODY.SID_FEM cadyn_CASE.mac --cadyn FOLDER --pymbs FOLDER

CADyn has no reader of files: the one of PyMbs reads the file (target sid-by-mode), and its numbers are assigned to
CADyn's structure here. Maxima then runs the functions of CADyn's cagem(), whose last step is left out: it replaces
eps² by 0 where eps has the value 1, and so every equation by 0.
"""

import argparse
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

COMMANDS = """
load("{cadyn}/gen/cagem.mac")$
load("body.mac")$
relative: prepareKinematics(prepareInput("{case}"))$
system: composeMotion(relative)$
forces: computeForceBalance(system)$
appliedForcesZero(system)$
appliedForces()$
forces@R: forces@R + appliedF$
forces@MG: forces@MG + appliedM$
forces@Re: forces@Re + appliedFe$
residuals: generalizedBalance(system, forces)$
linel: 100000$
with_stdout("names", for name in system@states do printf(true, "~a~%", string(name)))$
with_stdout("equations", for value in append(
    flatten(args(subst(map(lambda([a], a = 0), system@states_dd), residuals))),
    flatten(args(jacobian(residuals, system@states_dd)))) do printf(true, "~a~%", string(float(value))))$
"""


def assign(name, series, place):
    """Lines that assign the numbers of a Taylor series of PyMbs; place(row, column): places in CADyn's matrix."""
    matrices = [("M0", series.M0)] + [(f"M1[{mode + 1}]", matrix) for mode, matrix in enumerate(series.M1)]
    return [f"body@{name}@{order}{where}: {float(matrix[row, column])!r}$"
            for order, matrix in matrices for row, column in zip(*np.nonzero(matrix)) for where in place(row, column)]


def write_body(path, pymbs):
    """CADyn's body from a file."""
    sys.path.insert(0, str(pymbs))
    from pymbs.common.sidfilereader import SID  # type: ignore[import-not-found]

    with open(path, encoding="utf-8") as file:
        sid = SID(file)
    modal = sid.modal

    def whole(row, column):
        return [f"[{row + 1},{column + 1}]"]

    def by_mode(row, column):
        return [f"[{column // 3 + 1}][{row + 1},{column % 3 + 1}]"]

    def tensor(row, _):
        i, j = [(1, 1), (2, 2), (3, 3), (1, 2), (1, 3), (2, 3)][row]
        return {f"[{i},{j}]", f"[{j},{i}]"}

    lines = [f"body: emptyElasticMode({sid.nModes}, {sid.nNodes})$", f"body@refmod@mass: {modal.refmod.mass!r}$"]
    for index, node in enumerate(modal.frame.Knoten, 1):
        lines += assign(f"frame[{index}]@origin", node.origin.originmatrix, whole)
        lines += assign(f"frame[{index}]@phi", node.phi.phimatrix, whole)
    for name, series, place in [
        ("md", modal.mdcm.mdcmmatrix, whole), ("I", modal.j.Jmatrix, tensor), ("Ct", modal.ct.ctmatrix, whole),
        ("Cr", modal.cr.crmatrix, whole), ("Me", modal.me.mematrix, whole), ("Gr", modal.gr.grmatrix, by_mode),
        ("Ge", modal.ge.gematrix, by_mode), ("Oe", modal.oe.oematrix, whole), ("K", modal.ke.kematrix, whole),
        ("D", modal.de.dematrix, whole),
    ]:  # fmt: skip
        lines += assign(name, series, place)
    return "\n".join(lines) + "\n"


def make_accelerations(options):
    """(number of coordinates, function of state and gravity that returns accelerations by CADyn's equations)"""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "body.mac").write_text(write_body(options.body, options.pymbs))
        commands = COMMANDS.format(cadyn=options.cadyn.resolve(), case=options.case.resolve())
        (Path(folder) / "commands.mac").write_text(commands)
        subprocess.run(["maxima", "--very-quiet", "--batch=commands.mac"], cwd=folder, check=True, stdout=sys.stderr)
        names = (Path(folder) / "names").read_text().split()
        lines = (Path(folder) / "equations").read_text().replace("^", "**").splitlines()
    n = len(names)
    assert len(lines) == n + n * n
    equations = compile("[" + ",".join(lines) + "]", "equations", "eval")
    functions = {"sin": math.sin, "cos": math.cos, "sqrt": math.sqrt}
    names += [name + "_d" for name in names]

    def accelerations(state, gravity):
        values = np.array(eval(equations, functions, dict(zip(names, state.tolist()), g=gravity)))
        return np.linalg.solve(values[n:].reshape(n, n), -values[:n])

    return n, accelerations


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("body", type=Path)
    parser.add_argument("case", type=Path)
    parser.add_argument("--cadyn", type=Path, required=True)
    parser.add_argument("--pymbs", type=Path, required=True)
    n, accelerations = make_accelerations(parser.parse_args())

    step = 1e-6
    columns = [accelerations(step * unit, 0.0) - accelerations(-step * unit, 0.0) for unit in np.eye(2 * n)]
    system = np.vstack([np.eye(n, 2 * n, n), np.array(columns).T / (2.0 * step)])
    omega = np.linalg.eigvals(system).imag
    print("frequencies", *(f"{value:.12g}" for value in np.sort(omega[omega > 1.0]) / (2.0 * math.pi)))

    times = 0.02 * np.arange(51)
    found = solve_ivp(lambda _, state: np.concatenate([state[n:], accelerations(state, 9.81)]), (0.0, times[-1]),
                      np.zeros(2 * n), "DOP853", times, rtol=1e-10, atol=1e-13)  # fmt: skip
    held = [0.0, 0.0] if n == 5 else []  # the hinge
    for time, state in zip(times, found.y[:n].T):
        print(f"{time:.2f}", *(f"{value:.10g}" for value in [*held, *state]))


if __name__ == "__main__":
    main()
