"""Vibration by third-octave bands, and the boundary of reduced comfort for vertical vibration.

A band around f₀ from f₁ = f₀ 10^(−1/20) to f₂ = f₀ 10^(1/20) has the Butterworth filter of sixth order, as measuring
instruments have it (IEC 61260):

    H = 1/((1 + p)(1 + p + p²)),   p = j (f² − f₀²)/(f (f₂ − f₁))                                        (1)

The filters begin at the first sample of a record, in the state of one that had its value all the time before: a
constant has no response. The r.m.s. in a band is that of what comes out of the filter over a span of the record. So it
holds what vibration before the span leaves in the filter, and not what fades after the span. The slowest pole of (1)
decays as exp(−0.326 f₀ t): what is left of vibration before a time falls to a thousandth within

    t = 21.3/f₀                                                                                          (2)

The boundary is that of ISO 2631:1978: the fatigue-decreased proficiency boundary, divided by 3.15. The latter is lowest
from 4 to 8 Hz, where it is given for each time of exposure; below it goes with f^-½, above with f. The edition of 1997
no longer has it: there a band counts by its weighting.
"""

import numpy as np

from sprung_tools.files.array_types import ComplexNumbers, Flags, Floats
from sprung_tools.signals.ride_weighting import find_fast_size
from sprung_tools.signals.spectra import calc_rms

BANDS = np.arange(-3, 20)  # 10^(n/10) Hz: the bands from 0.5 to 80 Hz
NOMINAL = (0.5, 0.63, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0,
           50.0, 63.0, 80.0)  # fmt: skip
BAND_EDGES = np.array([10.0**-0.05, 10.0**0.05])  # over the frequency of the middle
PROFICIENCY = {"1 min": 2.8, "25 min": 1.8, "1 h": 1.18, "4 h": 0.53, "8 h": 0.315, "24 h": 0.14}  # m/s², 4 to 8 Hz
COMFORT = 3.15  # by which the proficiency boundary is divided
FADING = 60.0  # s of rest appended to a record, so that the end of a response does not reach its start again
MEMORY_PERIODS = 21.3  # by (2)
BOUNDED = (1.0, 80.0)  # Hz, where there is a boundary


def calc_third_octaves(values: Floats, step: float, inside: Flags | slice = slice(None)) -> Floats:
    """The r.m.s. of a record [n] in the bands of NOMINAL [23] over a span of it. step: between samples [s]; inside: the
    samples of the span (default: all)."""
    size = find_fast_size(values.size + int(np.ceil(FADING / step)))
    transform = np.fft.rfft(values - values[0], size)
    frequency = np.fft.rfftfreq(size, step)
    responses = (transform * calc_band(frequency, centre) for centre in 10.0 ** (BANDS / 10.0))
    return np.array([calc_rms(np.fft.irfft(one, size)[: values.size][inside]) for one in responses])


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
