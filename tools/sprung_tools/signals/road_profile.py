"""Random road profiles: sums of cosines with a power-law spectrum, their files, and the spectrum estimated from them.

One-sided spectral density of the height over wavenumber n [1/m], with exponent w:

    G(n) = G(n₀) (n/n₀)^−w                                                                             (1)
    z(x) = Σ_k a_k cos(2π n_k x + ψ_k),   n_k = k/L,   a_k = √(2 G(n_k) Δn),   Δn = 1/L                  (2)

with phases ψ_k uniform in 0 … 2π. The mean of z over the points is removed; raised cosines ease both ends to zero
(without easing the whole is shifted so that its first point is at height 0). A profile of a wanted r.m.s. is then scaled to it over all of its points, an ISO 8608 profile is not scaled.

References: ISO 8608:2016, Mechanical vibration — Road surface profiles — Reporting of measured data, annexes A and C.
"""

import random
from typing import NamedTuple

import numpy as np

from sprung_tools.files.errors import InputError

REFERENCE_WAVENUMBER = 0.1  # 1/m, ISO 8608
ISO_CLASSES = "ABCDEFGH"
ISO_BAND = (0.011, 2.83)  # 1/m, the range that ISO 8608 reports spectra in
DECIMALS = 9  # of heights in a file: a nanometre
LEAST_HEIGHT = 1e-6  # m, of a profile's highest point: three digits in a file
GREATEST_HEIGHT = 1e6  # m
MOST_POINTS = 10_000_000  # of a profile; a road table of 200 MB
WHOLE = 1e-9  # a wavenumber this near a whole number of waves in the length counts as that number


class Recipe(NamedTuple):
    """What a profile is made from. Lengths in m, wavenumbers in 1/m; a height follows from `rms` or `density`."""

    length: float
    spacing: float
    band: tuple  # lowest and highest wavenumber
    exponent: float = 2.0
    rms: float = 0.0  # m, over all points; 0 if `density` is given
    density: float = 0.0  # G(n₀) [m³] at n₀ = 0.1 1/m
    ease: float = 0.0
    seed: int = 1


class Profile(NamedTuple):
    """distance, height: [n] m; density: G(0.1 1/m) of the components before easing [m³]; waves: their numbers k."""

    distance: np.ndarray
    height: np.ndarray
    density: float
    waves: np.ndarray


class Octave(NamedTuple):
    """Mean spectral density in a band of wavenumbers: wavenumbers in 1/m, densities in m³."""

    lowest: float
    highest: float
    wanted: float
    found: float


def calc_iso_density(name):
    """G(n₀) of an ISO 8608 class [m³]: the geometric mean, 16·4^k·1e-6 with k = 0 … 7 for A … H."""
    return 16e-6 * 4.0 ** ISO_CLASSES.index(name)


def check_recipe(recipe):
    """InputError for a recipe that makes no profile, naming the value and what is expected."""
    low, high = recipe.band
    for name in ("length", "spacing"):
        if not 0.0 < getattr(recipe, name) < np.inf:
            raise InputError(
                f"error: --{name} must be positive and finite (m), got {getattr(recipe, name):g}"
            )
    points = recipe.length / recipe.spacing
    if not points < MOST_POINTS:
        raise InputError(
            f"error: --length {recipe.length:g} m with --spacing {recipe.spacing:g} m makes {points:.3g} points, "
            f"more than {MOST_POINTS:g}"
        )
    if abs(points - round(points)) > 1e-6 or round(points) < 2:
        raise InputError(
            f"error: --spacing {recipe.spacing:g} m must divide --length {recipe.length:g} m into 2 parts or more"
        )
    if not 0.0 < low < high:
        raise InputError(
            f"error: --band must be two ascending positive wavenumbers (1/m), got {low:g} {high:g}"
        )
    if not high * recipe.spacing < 0.5:
        raise InputError(
            f"error: --band ends at {high:g} 1/m, which points every {recipe.spacing:g} m cannot show "
            f"(below {0.5 / recipe.spacing:g} 1/m)"
        )
    if not 0.0 <= 2.0 * recipe.ease < recipe.length:
        raise InputError(
            f"error: --ease must be at least 0 and below half of the length, got {recipe.ease:g} m"
        )
    if not np.isfinite(recipe.exponent):
        raise InputError(f"error: --exponent must be a finite number, got {recipe.exponent:g}")
    if not 0.0 < max(recipe.rms, recipe.density) < np.inf:
        raise InputError(f"error: --rms must be positive and finite (m), got {recipe.rms:g}")


def calc_waves(recipe):
    """The numbers k of waves in the length whose wavenumber k/L lies in the band. InputError if there are none."""
    low, high = (limit * recipe.length for limit in recipe.band)
    waves = np.arange(max(1, int(np.ceil(low - WHOLE))), int(np.floor(high + WHOLE)) + 1)
    if waves.size == 0:
        raise InputError(
            f"error: --band {recipe.band[0]:g} {recipe.band[1]:g} 1/m holds no multiple of 1/{recipe.length:g} m"
        )
    return waves


def calc_easing(distance, ease):
    """Raised cosines over the first and the last `ease` metres [n]: 0 at the ends, 1 between them."""
    if ease == 0.0:
        return np.ones_like(distance)
    from_end = np.minimum(distance, distance[-1] - distance)
    return np.where(from_end < ease, 0.5 - 0.5 * np.cos(np.pi * from_end / ease), 1.0)


def make_profile(recipe):
    """The profile of a recipe; equal recipes give equal profiles. InputError for a recipe that makes none, also where
    its heights vanish in the file's decimals or its spectrum leaves the range of numbers.

    The phases come from Python's `random.Random(seed).random()`, whose sequence Python guarantees to keep.
    """
    check_recipe(recipe)
    waves = calc_waves(recipe)
    distance = np.arange(round(recipe.length / recipe.spacing) + 1) * recipe.spacing
    generator = random.Random(recipe.seed)
    phases = np.array([2.0 * np.pi * generator.random() for _ in waves])
    wavenumbers = waves / recipe.length
    density = recipe.density or 1.0
    with np.errstate(over="ignore", under="ignore"):
        spectrum = density * (wavenumbers / REFERENCE_WAVENUMBER) ** -recipe.exponent
    if not (np.all(np.isfinite(spectrum)) and np.all(spectrum > 0.0)):
        raise InputError(
            f"error: --exponent {recipe.exponent:g} makes a spectrum beyond the range of numbers in this band"
        )
    amplitudes = np.sqrt(2.0 * spectrum / recipe.length)
    height = np.zeros_like(distance)
    for amplitude, wavenumber, phase in zip(amplitudes, wavenumbers, phases):
        height += amplitude * np.cos(2.0 * np.pi * wavenumber * distance + phase)
    height = (height - height.mean()) * calc_easing(distance, recipe.ease)
    height -= height[0]  # a road table begins at height 0; nothing changes where the ends are eased
    if recipe.rms > 0.0:
        factor = recipe.rms / np.sqrt(np.mean(height**2))
        height = factor * height
        check_heights(height)
        density *= factor**2
    return Profile(distance, height, density, waves)


def check_heights(height):
    """InputError if a file's decimals cannot hold heights [n], or if they are not heights of a road."""
    highest = np.max(np.abs(height))
    if not LEAST_HEIGHT <= highest <= GREATEST_HEIGHT:
        raise InputError(
            f"error: the heights reach {highest:.3g} m, expected {LEAST_HEIGHT:g} to {GREATEST_HEIGHT:g} m; change --rms"
        )


def describe_recipe(recipe, profile, command):
    """The lines of a file's header: how to make the file again, and what is in it."""
    first, last = profile.waves[0], profile.waves[-1]
    easing = (
        f"raised-cosine easing over the first and last {recipe.ease:g} m"
        if recipe.ease
        else "no easing, shifted to begin at 0"
    )
    level = f"r.m.s. over all points {recipe.rms:g} m" if recipe.rms > 0.0 else "not scaled to an r.m.s."
    return (
        f"Random road profile, made by: {command}",
        f"{profile.distance.size} points every {recipe.spacing:g} m over {recipe.length:g} m; {level}.",
        f"Sum of cosines of wavenumbers k/{recipe.length:g} 1/m, k = {first} ... {last}: wavelengths "
        f"{recipe.length / first:.4g} to {recipe.length / last:.4g} m,",
        f"amplitudes from the spectral density {profile.density:.6g} m^3 (n / 0.1 1/m)^-{recipe.exponent:g}, "
        f"phases uniform, seed {recipe.seed};",
        f"mean removed; {easing}.",
        "distance m, height m",
    )


def format_profile(recipe, profile, command):
    """The text of a road file (dynamics/models/README.md, shape = "table")."""
    header = "".join(f"# {line}\n" for line in describe_recipe(recipe, profile, command))
    rows = (f"{s:.10g} {h + 0.0:.{DECIMALS}f}\n" for s, h in zip(profile.distance, profile.height))
    return header + "".join(rows)


def read_profile(path):
    """distance, height [n] of a road file with equal spacing. InputError if it cannot be used."""
    try:
        table = np.loadtxt(path, ndmin=2)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: error: not a table of distances and heights ({error})") from error
    if table.shape[0] < 3 or table.shape[1] != 2:
        raise InputError(
            f"{path}: error: expected 3 rows or more of a distance and a height, got {table.shape}"
        )
    steps = np.diff(table[:, 0])
    if not np.allclose(steps, steps[0], rtol=1e-4, atol=0.0):
        raise InputError(f"{path}: error: the distances are not equally spaced")
    return table[:, 0], table[:, 1]


def estimate_octaves(distance, height, recipe, density):
    """Mean spectral density in octaves of the recipe's band, wanted and as found in a profile [list of Octave].

    Periodogram over the whole length, |Z(n)|² 2/L, divided by the mean square of the easing; `density` is the
    wanted G(0.1 1/m). Octaves count down from the highest wavenumber.
    """
    waves = calc_waves(recipe)
    length = recipe.length
    values = height[:-1] - height[:-1].mean()  # the last point is the first of the next period
    transform = np.fft.rfft(values) / values.size
    window = np.mean(calc_easing(distance, recipe.ease) ** 2)
    found = 2.0 * np.abs(transform) ** 2 * length / window
    octaves = []
    high = waves[-1]
    while high >= waves[0]:
        low = max(waves[0], high // 2 + 1)
        inside = np.arange(low, high + 1)
        wanted = density * (inside / length / REFERENCE_WAVENUMBER) ** -recipe.exponent
        octaves.append(Octave(low / length, high / length, wanted.mean(), found[inside].mean()))
        high = low - 1
    return octaves[::-1]


def fit_exponent(octaves, wanted_exponent):
    """The exponent w of the spectrum found: the wanted one, corrected by a straight line through the logarithms of
    found over wanted density, against the logarithms of the octaves' middle wavenumbers. Two octaves or more.
    """
    middle = np.log([np.sqrt(octave.lowest * octave.highest) for octave in octaves])
    ratio = np.log([octave.found / octave.wanted for octave in octaves])
    return wanted_exponent - np.polyfit(middle, ratio, 1)[0]
