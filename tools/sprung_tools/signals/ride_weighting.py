"""How sitting people feel vibration: the weightings Wk (vertical), Wd (fore-aft) and We (rotation), and what is made of
the weighted acceleration a_w.

    H(s) = Hh Hl Ht Hs,   s = j 2π f                                                                   (1)
    Hh = s²/(s² + √2 ω₁ s + ω₁²),  Hl = ω₂²/(s² + √2 ω₂ s + ω₂²)            band limits, f₁ = 0.4, f₂ = 100 Hz
    Ht = (1 + s/ω₃)/(1 + s/(Q₄ ω₄) + (s/ω₄)²)                               f₃ = f₄, Q₄ = 0.63
    Hs = (1 + s/(Q₅ω₅) + (s/ω₅)²)/(1 + s/(Q₆ω₆) + (s/ω₆)²) (ω₅/ω₆)²         of Wk, else 1

    f₃ = 12.5 Hz for Wk, 2 Hz for Wd, 1 Hz for We;   f₅ = 2.37, f₆ = 3.35 Hz, Q₅ = Q₆ = 0.91

    a_w,rms = √(1/T ∫ a_w² dt)  [m/s²],   VDV = (∫ a_w⁴ dt)^¼  [m/s^1.75]                               (2)
    a_w(t₀) = √(1/τ ∫ a_w² dt from t₀ − τ to t₀), τ = 1 s,   MTVV = max a_w(t₀)                         (3)

[ISO 2631-1:1997, 6.1 to 6.3 and annex A, with the parameters of ISO 8041:2005, table 3]

After a shock the poles of Hh are the last to decay, as exp(−ω₁ t/√2). So what is left of vibration before a time falls
to a thousandth within

    t = √2 ln 1000/ω₁ = 3.9 s                                                                          (4)

The Fourier transform of the samples is multiplied by the formula itself. A digital filter in its place would be warped
towards half the sampling frequency.
"""

import functools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import ComplexNumbers, Floats

SETTLING = 20.0  # s of rest appended to a signal, so that the end of its response does not reach its start again
HIGHEST = 80.0  # Hz, where the standard's table ends
SAMPLES_PER_PERIOD = 4.0  # needed in a period of the highest frequency
ROUNDING = 1e-9  # relative, of times and their differences
RUNNING = 1.0  # s, τ of (3)
LOWEST = 0.4  # Hz, f₁
LEFT = 1e-3  # share of earlier vibration
MEMORY = float(np.sqrt(2.0) * np.log(1.0 / LEFT) / (2.0 * np.pi * LOWEST))  # s, by (4)

Response = Callable[[Floats], ComplexNumbers]  # frequencies [Hz] → complex response


class Weighting(NamedTuple):
    """The parameters of (1) in which the weightings differ [Hz]; step: whether Hs is there."""

    name: str
    transition: float
    has_step: bool


WK, WD, WE = Weighting("Wk", 12.5, True), Weighting("Wd", 2.0, False), Weighting("We", 1.0, False)


def calc_weighting(weighting: Weighting, frequency: Floats) -> ComplexNumbers:
    """The complex response H of (1) at frequencies f ≥ 0 [Hz]."""
    s = 2j * np.pi * np.asarray(frequency, dtype=float)
    w1, w2, w3, w5, w6 = 2.0 * np.pi * np.array([LOWEST, 100.0, weighting.transition, 2.37, 3.35])
    q4, q5, q6 = 0.63, 0.91, 0.91
    high_pass = s**2 / (s**2 + np.sqrt(2.0) * w1 * s + w1**2)
    low_pass = w2**2 / (s**2 + np.sqrt(2.0) * w2 * s + w2**2)
    response = high_pass * low_pass * (1.0 + s / w3) / (1.0 + s / (q4 * w3) + (s / w3) ** 2)
    if weighting.has_step:
        step = (1.0 + s / (q5 * w5) + (s / w5) ** 2) / (1.0 + s / (q6 * w6) + (s / w6) ** 2)
        response = response * step * (w5 / w6) ** 2
    return response


def weight_acceleration(acceleration: Floats, step: float, weighting: Weighting = WK) -> Floats:
    """The weighted acceleration a_w [n], m/s² or rad/s², of an acceleration [n] that was 0 before the record began.

    step: between samples [s]. ValueError if the samples are too far apart for the frequencies up to 80 Hz.
    """
    fault = describe_fault(step)
    if fault:
        raise ValueError(fault)
    size = find_padded_size(acceleration.size, step)
    return multiply_transform(acceleration, size, keep_weighting(weighting, size, step))


def describe_fault(step: float) -> str:
    """Why samples are too far apart [s] for the weightings; empty if they are not."""
    if step * HIGHEST * SAMPLES_PER_PERIOD <= 1.0 + ROUNDING:
        return ""
    return (
        f"a sample every {1e3 * step:g} ms is too few: the weightings go to {HIGHEST:g} Hz and need one every "
        f"{1e3 / (HIGHEST * SAMPLES_PER_PERIOD):g} ms"
    )


@functools.lru_cache(maxsize=2 * len((WK, WD, WE)))
def keep_weighting(weighting: Weighting, size: int, step: float) -> ComplexNumbers:
    """The response at the frequencies of a transform, kept for the next signal of that size."""
    return calc_weighting(weighting, np.fft.rfftfreq(size, step))


def apply_response(values: Floats, step: float, response: Response) -> Floats:
    """What a linear filter at rest makes of a signal [n]."""
    size = find_padded_size(values.size, step)
    return multiply_transform(values, size, response(np.fft.rfftfreq(size, step)))


def multiply_transform(values: Floats, size: int, response: ComplexNumbers) -> Floats:
    """A signal [n] whose transform of some size has been multiplied by a response."""
    return np.fft.irfft(np.fft.rfft(values, size) * response, size)[: values.size]


def find_padded_size(count: int, step: float) -> int:
    """The size of the transform of so many samples with the time after them in which a filter settles."""
    return find_fast_size(count + int(np.ceil(SETTLING / step)))


def find_fast_size(least: int) -> int:
    """The least number from `least` on that has no prime factors but 2, 3 and 5, of which a Fourier transform is fast:
    that of a size with a large prime factor takes ten times as long."""
    sizes = []
    odd = [3**three * 5**five for three in range(least.bit_length()) for five in range(least.bit_length())]
    for factor in odd:
        size = factor
        while size < least:
            size *= 2
        sizes.append(size)
    return min(sizes)


def calc_dose(weighted: Floats, step: float) -> float:
    """The vibration dose value of a weighted acceleration [n]: (∫ a_w⁴ dt)^¼ in m/s^1.75, by the trapezoidal rule."""
    fourth = np.square(np.square(weighted))
    return float((step * (fourth.sum() - 0.5 * (fourth[0] + fourth[-1]))) ** 0.25)


def calc_running_rms(weighted: Floats, step: float) -> Floats:
    """The running r.m.s. of (3) at each sample [n], by the trapezoidal rule; before the record the signal is 0."""
    square = np.square(weighted)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * step * (square[1:] + square[:-1]))])
    begin = np.maximum(0, np.arange(weighted.size) - round(RUNNING / step))
    return np.sqrt((integral - integral[begin]) / RUNNING)
