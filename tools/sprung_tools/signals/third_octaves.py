"""Vibration by third-octave bands, and the boundary of reduced comfort for vertical vibration.

A band around f₀ from f₁ = f₀ 10^(−1/20) to f₂ = f₀ 10^(1/20) has the Butterworth filter of sixth order, as measuring
instruments have it (IEC 61260):

    H = 1/((1 + p)(1 + p + p²)),   p = j (f² − f₀²)/(f (f₂ − f₁))                                        (1)

The r.m.s. in a band is that of a span of n samples alone, before and after which the signal counts as 0. All that the
filter makes of it belongs to the band, also what fades after the span (Parseval's theorem; X: transform of the span and
of zeros up to N samples):

    r.m.s.² = Σ y²/n = Σ_k |H X_k|²/(n N)                                                                (2)

The boundary is that of ISO 2631:1978: the fatigue-decreased proficiency boundary, divided by 3.15. The latter is lowest
from 4 to 8 Hz, where it is given for each time of exposure; below it goes with f^-½, above with f. The edition of 1997
no longer has it: there a band counts by its weighting.
"""

import numpy as np

from sprung_tools.files.array_types import ComplexNumbers, Floats

BANDS = np.arange(-3, 20)  # 10^(n/10) Hz: the bands from 0.5 to 80 Hz
NOMINAL = (0.5, 0.63, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0,
           50.0, 63.0, 80.0)  # fmt: skip
BAND_EDGES = np.array([10.0**-0.05, 10.0**0.05])  # over the frequency of the middle
PROFICIENCY = {"1 min": 2.8, "25 min": 1.8, "1 h": 1.18, "4 h": 0.53, "8 h": 0.315, "24 h": 0.14}  # m/s², 4 to 8 Hz
COMFORT = 3.15  # by which the proficiency boundary is divided
FADING = 60.0  # s of rest appended to a span, in which the response of the narrowest band fades
ROUND = 4096  # a length of signals that is a multiple of this is transformed fast
BOUNDED = (1.0, 80.0)  # Hz, where there is a boundary


def calc_third_octaves(values: Floats, step: float) -> Floats:
    """The r.m.s. of the samples of a span [n] in the bands of NOMINAL by (2) [23]. step: between samples [s]."""
    size = ROUND * int(np.ceil((values.size + FADING / step) / ROUND))
    power: Floats = np.square(np.abs(np.fft.rfft(values, size)))
    power[1:-1] *= 2.0  # the size is even: only the first and the last line have no negative counterpart
    frequency = np.fft.rfftfreq(size, step)
    mean_squares = [
        np.sum(np.abs(calc_band(frequency, centre)) ** 2 * power) / (values.size * size)
        for centre in 10.0 ** (BANDS / 10.0)
    ]  # fmt: skip
    return np.sqrt(mean_squares)


def calc_band(frequency: Floats, centre: float) -> ComplexNumbers:
    """The response (1) of the band around a frequency [Hz]."""
    width = centre * (BAND_EDGES[1] - BAND_EDGES[0])
    p = 1j * (frequency**2 - centre**2) / np.maximum(frequency * width, 1e-12 * centre**2)
    return 1.0 / ((1.0 + p) * (1.0 + p + p**2))


def calc_comfort_boundary(exposure: str, frequency: Floats) -> Floats:
    """The vertical acceleration r.m.s. [m/s²] at which comfort is reduced after an exposure of PROFICIENCY, in bands
    around frequencies [Hz] from 1 to 80."""
    shape = np.where(frequency < 4.0, np.sqrt(4.0 / frequency), np.maximum(1.0, frequency / 8.0))
    return PROFICIENCY[exposure] / COMFORT * shape
