"""Finding where a measure of runs reaches its limit: bracketing, then Brent's method on as few runs as possible."""

from collections.abc import Callable
from typing import NamedTuple

from scipy.optimize import brentq

BELOW, ABOVE = "below", "above"  # the limit is reached below, above all that was allowed


class Root(NamedTuple):
    """Where a function is 0. value: None where it is not known; side: BELOW or ABOVE where the root is beyond a bound,
    else empty; problem: why a call failed, else empty; calls: how many there were."""

    value: float | None
    side: str
    problem: str
    calls: int


class CallFailed(Exception):
    """The function has no value that one may use."""


def find_root(
    function: Callable[[float], float], start: float, bounds: tuple[float, float],
    step: Callable[[float, float], float], tolerance: float,
) -> Root:  # fmt: skip
    """Finds where a function goes from less than 0 to more than 0.

    start: the first argument; bounds: of the argument; step: how far to go next from (argument, value), positive; it is
    taken up from values below 0 and down from others, until the sign changes. Of several roots it is the first one on
    this way. tolerance: of the argument. A call that throws CallFailed ends the search: its value would be needed.
    """
    known: dict[float, float] = {}

    def evaluate(x: float) -> float:
        if x not in known:
            known[x] = function(x)
        return known[x]

    try:
        x = start
        while True:
            is_below = evaluate(x) < 0.0
            bound = bounds[1] if is_below else bounds[0]
            if x == bound:
                return Root(None, ABOVE if is_below else BELOW, "", len(known))
            width = abs(step(x, known[x]))
            following = min(x + width, bound) if is_below else max(x - width, bound)
            if (evaluate(following) < 0.0) != is_below:
                root = brentq(evaluate, min(x, following), max(x, following), xtol=tolerance, rtol=1e-12)
                return Root(float(root), "", "", len(known))
            x = following
    except CallFailed as failure:
        return Root(None, "", str(failure), len(known) + 1)
