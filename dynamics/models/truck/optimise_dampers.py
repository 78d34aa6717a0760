"""Which damper rates give the truck's driver the least weighted acceleration over the terrain, with no more travel of
the suspensions than the truck has as it is?

    export PYTHONPATH=tools
    /usr/bin/python3 dynamics/models/truck/optimise_dampers.py --superelements build/truck -o dampers.png

The rates in compression and in rebound are the same on both axles. scipy's COBYLA needs no derivatives and keeps
constraints; its variables are the logarithms of the rates over those of vehicle.toml. It starts at half of these, so
that what it finds does not depend on them.
"""

import argparse
import math
import tomllib
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import NonlinearConstraint, minimize

import sprung

RUN = Path(__file__).resolve().parent / "terrain.toml"
AXLES = ("front", "rear")
START = math.log(0.5)
SLACK = 1e-3  # share by which the stroke may exceed that of the truck as it is
LIMITS = (math.log(0.25), math.log(4.0))  # of the logarithms of the factors
FIRST_STEP, LAST_STEP = 0.4, 0.02  # of the same


class Trial(NamedTuple):
    """A truck that was driven. rates [N s/m]; acceleration: weighted r.m.s. at the seat [m/s²]; stroke: the largest
    travel of a suspension between its extremes [m]."""

    rates: tuple[float, float]
    acceleration: float
    stroke: float


def read_rates() -> tuple[float, float]:
    """The rates in compression and rebound that vehicle.toml gives both axles [N s/m]."""
    forces = tomllib.loads(RUN.with_name("vehicle.toml").read_text(encoding="utf-8"))["forces"]
    dampers = [one["damper"] for one in forces if one["name"] in {f"{axle}_suspension" for axle in AXLES}]
    ((compression, rebound),) = {(one["compression"], one["rebound"]) for one in dampers}
    return compression, rebound


class Drive:
    """Drives trucks over the terrain, none twice."""

    def __init__(self, superelements: Path, duration: float | None) -> None:
        self.superelements = superelements
        self.rates = read_rates()
        self.settings = {} if duration is None else {"duration": duration, "statistics.to": duration}
        self.trials: dict[tuple[float, ...], Trial] = {}

    def __call__(self, logarithms: tuple[float, ...]) -> Trial:
        key = tuple(float(one) for one in logarithms)
        if key not in self.trials:
            compression, rebound = (rate * math.exp(one) for rate, one in zip(self.rates, key))
            dampers = {
                f"vehicle.forces.{axle}_suspension.damper": {"compression": compression, "rebound": rebound}
                for axle in AXLES
            }
            with sprung.run(RUN, superelements=self.superelements, overrides=self.settings | dampers) as results:
                deflections = [results[f"forces/{axle}_suspension/deflection"] for axle in AXLES]
                stroke = max(float(np.ptp(one)) for one in deflections)
                acceleration = results.measure("points/chassis.seat/wk_rms")
            self.trials[key] = Trial((compression, rebound), acceleration, stroke)
        return self.trials[key]


def optimise(drive: Drive, evaluations: int) -> tuple[Trial, Trial]:
    """The truck as it is, and the best one found with no more stroke."""
    start = drive((0.0, 0.0))
    constraints = [
        NonlinearConstraint(lambda x: 1.0 - drive(x).stroke / start.stroke, 0.0, np.inf),
        NonlinearConstraint(lambda x: x, *LIMITS),
    ]
    minimize(
        lambda x: drive(x).acceleration / start.acceleration, (START, START), method="COBYLA", constraints=constraints,
        tol=LAST_STEP, options={"rhobeg": FIRST_STEP, "maxiter": evaluations},
    )  # fmt: skip
    allowed = [one for one in drive.trials.values() if one.stroke <= (1.0 + SLACK) * start.stroke]
    return start, min(allowed, key=lambda one: one.acceleration)


def draw(path: Path, trials: list[Trial], start: Trial, best: Trial) -> None:
    """All trials: their rates, and acceleration against stroke."""
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    accelerations = [one.acceleration for one in trials]
    for axes, xs, ys in (
        (left, [1e-3 * one.rates[0] for one in trials], [1e-3 * one.rates[1] for one in trials]),
        (right, [1e3 * one.stroke for one in trials], accelerations),
    ):
        points = axes.scatter(xs, ys, c=accelerations, cmap="viridis_r", s=28)
        for name, one, marker in (("as it is", start, "s"), ("best", best, "*")):
            at = trials.index(one)
            label = f"{name}: {one.acceleration:.3f} m/s²"
            axes.plot(xs[at], ys[at], marker, mfc="none", mec="#c2410c", ms=13, label=label, ls="none")
        axes.legend()
        axes.grid(alpha=0.3)
    figure.colorbar(points, ax=right, label="weighted acceleration of the driver, m/s²")
    left.set(xlabel="damper rate in compression, kN s/m", ylabel="in rebound, kN s/m")
    right.axvline(1e3 * start.stroke, color="#888888", lw=1.0)
    right.set(xlabel="largest stroke of a suspension, mm", ylabel="weighted acceleration, m/s²")
    figure.savefig(path, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--superelements", type=Path, required=True, help="folder of chassis.h5 and long_arm.h5")
    parser.add_argument("-o", "--output", type=Path, required=True, help="picture to write")
    parser.add_argument("--evaluations", type=int, default=40, help="runs at most, about (default: 40)")
    parser.add_argument("--duration", type=float, help="of each run, s (default: that of terrain.toml)")
    arguments = parser.parse_args()
    drive = Drive(arguments.superelements, arguments.duration)
    start, best = optimise(drive, arguments.evaluations)
    draw(arguments.output, list(drive.trials.values()), start, best)
    for name, one in (("as it is", start), ("best", best)):
        print(
            f"{name}: compression {one.rates[0]:.0f} N s/m, rebound {one.rates[1]:.0f} N s/m, "
            f"weighted acceleration {one.acceleration:.3f} m/s², stroke {1e3 * one.stroke:.1f} mm"
        )
    print(f"{len(drive.trials)} runs; {arguments.output}")


if __name__ == "__main__":
    main()
