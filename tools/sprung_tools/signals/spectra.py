"""The content of a sampled signal by frequency: r.m.s. of bands, amplitude spectra, the frequency of the highest peak.

Signals are [n] values at equal time steps [s]; frequencies in Hz. Reference: [Welch 1967] P. D. Welch, The use of fast
Fourier transform for the estimation of power spectra, IEEE Transactions on Audio and Electroacoustics 15, 70–73.
"""

from collections.abc import Sequence

import numpy as np

from sprung_tools.files.array_types import Floats


def calc_rms(values: Floats) -> float:
    """The root mean square of the values."""
    return float(np.sqrt(np.mean(np.square(values))))


def calc_band_rms(values: Floats, step: float, limits: Sequence[float]) -> Floats:
    """The r.m.s. in each band of frequencies [len(limits) + 1]: below the first limit, between limits, above the last.

    Their squares add up to the signal's mean square; the signal's mean belongs to the first band. The signal is
    continued by its mirror image (a cosine series over its length), so that a difference between its ends does not leak
    into the high bands.
    """
    mirrored = np.concatenate([values, values[::-1]])
    transform = np.fft.rfft(mirrored) / mirrored.size
    power = np.abs(transform) ** 2
    power[1:-1] *= 2.0  # the length is even: only the first and the last have no negative counterpart
    frequency = np.fft.rfftfreq(mirrored.size, step)
    band = np.searchsorted(limits, frequency, side="right")
    return np.sqrt(np.bincount(band, weights=power, minlength=len(limits) + 1))


def calc_amplitude_spectrum(values: Floats, step: float) -> tuple[Floats, Floats]:
    """The amplitudes of the cosines that a signal consists of. Returns (frequency [m], amplitude [m])."""
    amplitude = 2.0 * np.abs(np.fft.rfft(values)) / values.size
    amplitude[0] /= 2.0
    return np.fft.rfftfreq(values.size, step), amplitude


def calc_power_spectrum(values: Floats, step: float, segment_duration: float) -> tuple[Floats, Floats]:
    """One-sided power spectral density by averaged periodograms: segments half overlapping, Hann windows, each less its
    mean [Welch 1967]. Returns (frequency [m], density [m] in unit²/Hz). ValueError if a segment is longer than the
    signal.
    """
    size = round(segment_duration / step)
    if not 8 <= size <= values.size:
        raise ValueError(f"segments of {size} samples do not fit a signal of {values.size}")
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(size) / size)
    starts = range(0, values.size - size + 1, size // 2)
    density = np.zeros(size // 2 + 1)
    for start in starts:
        segment = values[start : start + size]
        density += np.abs(np.fft.rfft(window * (segment - segment.mean()))) ** 2
    density *= 2.0 * step / (np.sum(window**2) * len(starts))
    return np.fft.rfftfreq(size, step), density


def calc_whole_spectrum(values: Floats, step: float, segment_duration: float) -> tuple[Floats, Floats]:
    """One-sided power spectral density whose sum times the distance of its lines is the signal's mean square, wherever
    in the signal its power lies. Returns (frequency [m], density [m] in unit²/Hz).

    Periodograms of segments with Hann windows are averaged. The segments overlap by three quarters and reach beyond
    both ends, where the signal counts as 0, so that the squares of the windows that cover a sample have the same sum
    for each sample. A segment is not longer than the signal; it has a multiple of four samples, at least eight.
    """
    size = 4 * max(2, round(min(segment_duration, step * values.size) / (4.0 * step)))
    hop = size // 4
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(size) / size)
    padded = np.concatenate([np.zeros(size - hop), values, np.zeros(size)])
    density = np.zeros(size // 2 + 1)
    for start in range(0, size - hop + values.size, hop):
        density += np.abs(np.fft.rfft(window * padded[start : start + size])) ** 2
    density[1:-1] *= 2.0  # the size is even: only the first and the last line have no negative counterpart
    density *= step / (1.5 * values.size)  # 1.5: sum of the squares of the windows at a sample
    return np.fft.rfftfreq(size, step), density


def find_dominant_frequency(values: Floats, step: float, segment_duration: float) -> float:
    """The frequency where the power spectral density is highest, by a parabola through its highest three values'
    logs."""
    frequency, density = calc_power_spectrum(values, step, segment_duration)
    top = int(np.argmax(density[1:-1])) + 1
    below, here, above = np.log(density[top - 1 : top + 2])
    return float(frequency[top] + 0.5 * (below - above) / (below - 2.0 * here + above) * frequency[1])


def count_upward_crossings(values: Floats) -> int:
    """How often a signal crosses its mean upwards."""
    above = values > values.mean()
    return int(np.count_nonzero(above[1:] & ~above[:-1]))
