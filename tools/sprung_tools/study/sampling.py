"""The points of a study: which values the parameters have in each run.

Random points in the unit cube are those of scipy.stats.qmc, with the dimensions in the order of the parameters:
`LatinHypercube(d, seed=seed).random(n)`, and `Sobol(d, scramble=True, seed=seed).random(n)`. A share u of a range from
low to high stands for low + u (high - low), or low (high/low)^u with logarithmic spacing; of m values for the one of
number floor(u m), counted from 0.
"""

import itertools
import math
import warnings
from collections.abc import Sequence
from typing import Any

from sprung_tools.files.array_types import Floats
from sprung_tools.study.description import GRID, LIST, MOST_RUNS, SOBOL, Parameter, Sampling, Study
from sprung_tools.study.study_file import place_between

Point = tuple[Any, ...]  # a value for each parameter


def make_points(study: Study) -> list[Point]:
    """The points of a study in order. The values of crossed parameters are combined with every point of the others,
    those of the last parameter in the file fastest. InputError if there are too many."""
    sampled = [one for one in study.parameters if not one.crossed]
    crossed = [one for one in study.parameters if one.crossed]
    levels = [*sampled, *crossed] if study.sampling.method == GRID else crossed
    count = 1 if study.sampling.method in (GRID, LIST) else study.sampling.number
    for one in levels:
        count *= len(one.values)
    if count > MOST_RUNS:
        raise study.file.fail(("sampling",), f"the study has {count} runs, at most {MOST_RUNS} are possible")
    if study.sampling.method == GRID:
        return list(itertools.product(*(one.values for one in study.parameters)))
    points: Sequence[Point] = [()]
    if sampled:
        points = list(zip(*(one.values for one in sampled))) if study.sampling.method == LIST else (
            [place_point(sampled, shares) for shares in make_shares(study.sampling, len(sampled))]
        )  # fmt: skip
    order = {one.name: number for number, one in enumerate([*sampled, *crossed])}
    return [
        tuple((*point, *more)[order[one.name]] for one in study.parameters)
        for point in points for more in itertools.product(*(one.values for one in crossed))
    ]  # fmt: skip


def count_repeats(study: Study) -> int:
    """How many runs in a row are of the same point of the parameters that are not crossed; 1 over a grid."""
    if study.sampling.method == GRID:
        return 1
    return math.prod(len(one.values) for one in study.parameters if one.crossed)


def make_shares(sampling: Sampling, dimensions: int) -> Floats:
    """Points in the unit cube [number × dimensions]."""
    from scipy.stats import qmc  # here because it takes longer to load than all else

    engine: qmc.QMCEngine
    if sampling.method == SOBOL:
        engine = qmc.Sobol(dimensions, scramble=True, seed=sampling.seed)
    else:
        engine = qmc.LatinHypercube(dimensions, seed=sampling.seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a Sobol number is no power of 2, which is_balanced() tells
        shares: Floats = engine.random(sampling.number)
    return shares


def is_balanced(sampling: Sampling) -> bool:
    """Whether a Sobol sample has the balance for which it is made: that of 1, 2, 4, 8, … points."""
    return sampling.method != SOBOL or sampling.number & (sampling.number - 1) == 0


def place_point(parameters: Sequence[Parameter], shares: Floats) -> Point:
    """The values that a point of the unit cube stands for."""
    values: list[Any] = []
    for one, share in zip(parameters, shares):
        if one.values:
            values.append(one.values[min(int(share * len(one.values)), len(one.values) - 1)])
        else:
            values.append(place_between(one.low, one.high, one.spacing, float(share)))
    return tuple(values)
