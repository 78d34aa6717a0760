"""The power that a sitting person absorbs from vertical vibration, the measure of the ride-limiting speed (6 W).

    H(s) = 14.5 s (s + 44) / ((s + 63)(s² + 24 s + 750)),   s = j 2π f,   [√W per ft/s²]                 (1)
    P(t) = (H a)²,   P = 1/T ∫ (H a)² dt   [W],   a in ft/s²                                             (2)

[1] R. A. Lee, F. Pradko, Analytical analysis of human vibration, SAE paper 680091 (1968): the power at each frequency.
(1) is the filter of third order that ride programs use for it, the one of Project Chrono (`ChAbsorbed_Power_Vertical`,
as a bilinear transform of (1)). How near it comes to [1] is told in tools/README.md, "Measures"; absorbed_power_test.py
compares them.
"""

import numpy as np

from sprung_tools.files.array_types import ComplexNumbers, Floats
from sprung_tools.signals.ride_weighting import apply_response

FEET_PER_METRE = 1.0 / 0.3048
LIMIT = 6.0  # W, which drivers bear for long


def calc_response(frequency: Floats) -> ComplexNumbers:
    """H of (1) at frequencies [Hz], √W per ft/s²."""
    s = np.multiply(2j * np.pi, frequency)
    return np.divide(14.5 * s * (s + 44.0), (s + 63.0) * (s**2 + 24.0 * s + 750.0))


def calc_absorbed_power(acceleration: Floats, step: float) -> Floats:
    """The power P(t) [n], W, that a vertical acceleration [n], m/s², of a seat at rest before has a person absorb; its
    mean is the measure. step: between samples [s]."""
    return np.square(apply_response(FEET_PER_METRE * acceleration, step, calc_response))
