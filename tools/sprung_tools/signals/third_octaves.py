"""Vibration by third-octave bands, and the boundary of reduced comfort for vertical vibration.

A band around f₀ from f₁ = f₀ 10^(−1/20) to f₂ = f₀ 10^(1/20) has the Butterworth filter of sixth order, as measuring
instruments have it (IEC 61260):

    H = 1/((1 + p)(1 + p + p²)),   p = j (f² − f₀²)/(f (f₂ − f₁))                                        (1)

Here the filters have no phase, |H| in place of H, so that they hold as much of what comes as of what was: of the
energy that a shock gives to the band at f, 99 % lies within 3/f seconds before and after it. They get a record of
length T with its mirror images at both ends, which is a series of cosines cos(π k t/T). Of these they let pass the
share

    G_k² = 2T ∫ |H|² df,   f from (k − ½)/2T to (k + ½)/2T                                              (2)

of the mean square, so that a band between two frequencies of a short record gets what lies around it. As the mirrored
record comes out mirrored, nothing is lost at the ends: the mean squares of all bands over the whole record add up to
π/3, the mean of Σ|H|², of that of the vibration in their range, wherever in the record it is. Over a span within the
record, a shock at an end of the span gives half of its energy.

Where the record cuts a swing of frequency f₀ and amplitude a, its mirror image has a kink. Over the whole record it
leaves in the band at f, far above f₀, a r.m.s. of up to

    √(0.2308/2) 2/π · a f₀/√(f³ T) = 0.22 a f₀/√(f³ T)                                                  (3)

The boundary is that of ISO 2631:1978: the fatigue-decreased proficiency boundary, divided by 3.15. The latter is lowest
from 4 to 8 Hz, where it is given for each time of exposure; below it goes with f^-½, above with f. The edition of 1997
no longer has it: there a band counts by its weighting.
"""

import functools

import numpy as np

from sprung_tools.files.array_types import ComplexNumbers, Flags, Floats
from sprung_tools.signals.spectra import calc_rms

BANDS = np.arange(-3, 20)  # 10^(n/10) Hz: the bands from 0.5 to 80 Hz
NOMINAL = (0.5, 0.63, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0,
           50.0, 63.0, 80.0)  # fmt: skip
BAND_EDGES = np.array([10.0**-0.05, 10.0**0.05])  # over the frequency of the middle
PROFICIENCY = {"1 min": 2.8, "25 min": 1.8, "1 h": 1.18, "4 h": 0.53, "8 h": 0.315, "24 h": 0.14}  # m/s², 4 to 8 Hz
COMFORT = 3.15  # by which the proficiency boundary is divided
BOUNDED = (1.0, 80.0)  # Hz, where there is a boundary


def calc_third_octaves(values: Floats, step: float, inside: Flags | slice = slice(None)) -> Floats:
    """The r.m.s. of a record [n] in the bands of NOMINAL [23] over a span of it. step: between samples [s]; inside: the
    samples of the span (default: all)."""
    size, changes = 2 * values.size, values - values[0]
    transform = np.fft.rfft(np.concatenate([changes, changes[::-1]]))
    frequency = np.fft.rfftfreq(size, step)
    gains = (calc_gains(frequency, centre) for centre in 10.0 ** (BANDS / 10.0))
    return np.array([calc_rms(np.fft.irfft(transform * gain, size)[: values.size][inside]) for gain in gains])


def calc_gains(frequency: Floats, centre: float) -> Floats:
    """G of (2) for cosines of evenly spaced frequencies from 0 on [m]; 0 of the mean."""
    spacing = frequency[1] / centre
    edges = spacing * (np.arange(1, frequency.size + 1) - 0.5)
    return np.concatenate([[0.0], np.sqrt(np.diff(np.interp(edges, *integrate_band())) / spacing)])


@functools.cache
def integrate_band() -> tuple[Floats, Floats]:
    """Frequencies over that of the middle [m], beyond which |H|² is below 1e-15, and ∫|H|² up to these [m]."""
    relative = np.geomspace(0.01, 100.0, 20001)
    passed = np.square(np.abs(calc_band(relative, 1.0)))
    steps = 0.5 * np.diff(relative) * (passed[1:] + passed[:-1])
    return relative, np.concatenate([[0.0], np.cumsum(steps)])


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
