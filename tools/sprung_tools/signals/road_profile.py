"""Random road profiles: sums of cosines with a power-law spectrum, their files, and the spectrum estimated from them.

One-sided spectral density of the height over wavenumber n [1/m], with exponent w:

    G(n) = G(n₀) (n/n₀)^−w                                                                             (1)
    z(x) = Σ_k a_k cos(2π n_k x + ψ_k),   n_k = k/L,   a_k = √(2 G(n_k) Δn),   Δn = 1/L                  (2)

with phases ψ_k uniform in 0 … 2π. The mean of z over the points is removed. Raised cosines ease both ends to zero;
without easing, the profile is shifted so that its first point is at height 0. If an r.m.s. is wanted, the profile is
then scaled so that all of its points have it: about their mean, or about the level of eased ends, so that the shift is
no roughness. An ISO 8608 profile is not scaled.

References: ISO 8608:2016, Mechanical vibration — Road surface profiles — Reporting of measured data, annexes A and C.
"""

import random
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats, Integers
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
    """The parameters of a profile. Lengths in m, wavenumbers in 1/m; either `rms` or `density` sets the heights."""

    length: float
    spacing: float
    band: tuple[float, float]  # lowest and highest wavenumber
    exponent: float = 2.0
    rms: float = 0.0  # m, as calc_rms has it; 0 if `density` is given
    density: float = 0.0  # G(n₀) [m³] at n₀ = 0.1 1/m
    ease: float = 0.0
    seed: int = 1


class Profile(NamedTuple):
    """distance, height: [n] m; density: G(0.1 1/m) of the components before easing [m³]; waves: their numbers k."""

    distance: Floats
    height: Floats
    density: float
    waves: Integers


class Octave(NamedTuple):
    """Mean spectral density in a band of wavenumbers: wavenumbers in 1/m, densities in m³."""

    lowest: float
    highest: float
    wanted: float
    found: float


def calc_iso_density(name: str) -> float:
    """G(n₀) of an ISO 8608 class [m³]: the geometric mean, 16·4^k·1e-6 with k = 0 … 7 for A … H."""
    return 16e-6 * 4.0 ** ISO_CLASSES.index(name)


def check_recipe(recipe: Recipe) -> None:
    """Throws InputError for a recipe that makes no profile; its text names the value and what is expected."""
    low, high = recipe.band
    for name in ("length", "spacing"):
        if not 0.0 < getattr(recipe, name) < np.inf:
            raise InputError(f"error: --{name} must be positive and finite (m), got {getattr(recipe, name):g}")
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
        raise InputError(f"error: --band must be two ascending positive wavenumbers (1/m), got {low:g} {high:g}")
    if not high * recipe.spacing < 0.5:
        raise InputError(
            f"error: --band ends at {high:g} 1/m, which points every {recipe.spacing:g} m cannot show "
            f"(below {0.5 / recipe.spacing:g} 1/m)"
        )
    if not 0.0 <= 2.0 * recipe.ease < recipe.length:
        raise InputError(f"error: --ease must be at least 0 and below half of the length, got {recipe.ease:g} m")
    if not np.isfinite(recipe.exponent):
        raise InputError(f"error: --exponent must be a finite number, got {recipe.exponent:g}")
    if not 0.0 < max(recipe.rms, recipe.density) < np.inf:
        raise InputError(f"error: --rms must be positive and finite (m), got {recipe.rms:g}")
    if recipe.seed < 0:
        raise InputError(f"error: --seed must be at least 0, got {recipe.seed}")


def calc_waves(recipe: Recipe) -> Integers:
    """The numbers k of waves in the length whose wavenumber k/L lies in the band. InputError if there are none."""
    low, high = (limit * recipe.length for limit in recipe.band)
    waves = np.arange(max(1, int(np.ceil(low - WHOLE))), int(np.floor(high + WHOLE)) + 1)
    if waves.size == 0:
        raise InputError(
            f"error: --band {recipe.band[0]:g} {recipe.band[1]:g} 1/m holds no multiple of 1/{recipe.length:g} m"
        )
    return waves


def calc_easing(distance: Floats, ease: float) -> Floats:
    """Raised cosines over the first and the last `ease` metres [n]: 0 at the ends, 1 between them."""
    if ease == 0.0:
        return np.ones_like(distance)
    from_end = np.minimum(distance, distance[-1] - distance)
    return np.where(from_end < ease, 0.5 - 0.5 * np.cos(np.pi * from_end / ease), 1.0)


def calc_rms(height: Floats, ease: float) -> float:
    """The r.m.s. of heights [n] in m over all points: about the level of the ends where these are eased, else about the
    mean, which is that of the waves before the shift.
    """
    return float(np.sqrt(np.mean(height**2)) if ease > 0.0 else np.std(height))


def make_profile(recipe: Recipe) -> Profile:
    """Makes the profile of a recipe; equal recipes give equal profiles.

    InputError for a recipe that makes none, also if its heights vanish in the file's decimals or its spectrum leaves
    the range of numbers.

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
        factor = recipe.rms / calc_rms(height, recipe.ease)
        height = factor * height
        check_heights(height)
        density *= factor**2
    return Profile(distance, height, density, waves)


def check_heights(height: Floats) -> None:
    """Throws InputError if a file's decimals cannot hold heights [n], or if no road can have them."""
    highest = np.max(np.abs(height))
    if not LEAST_HEIGHT <= highest <= GREATEST_HEIGHT:
        raise InputError(
            f"error: the heights reach {highest:.3g} m, expected {LEAST_HEIGHT:g} to {GREATEST_HEIGHT:g} m; "
            "change --rms"
        )


def describe_recipe(recipe: Recipe, profile: Profile, command: str) -> tuple[str, ...]:
    """The lines of a file's header: the command that makes the file again, and what is in it."""
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


def format_profile(recipe: Recipe, profile: Profile, command: str) -> str:
    """The text of a road file (dynamics/models/README.md, shape = "table")."""
    header = "".join(f"# {line}\n" for line in describe_recipe(recipe, profile, command))
    rows = (f"{s:.10g} {h + 0.0:.{DECIMALS}f}\n" for s, h in zip(profile.distance, profile.height))
    return header + "".join(rows)


def read_profile(path: str | Path) -> tuple[Floats, Floats]:
    """Reads distance [n] and height [n] of a road file with equal spacing. InputError if it cannot be used."""
    try:
        with warnings.catch_warnings(action="ignore"):  # of an empty file, which is an error below
            table = np.loadtxt(path, ndmin=2)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: error: not a table of distances and heights ({error})") from error
    if table.shape[0] < 3 or table.shape[1] != 2:
        raise InputError(f"{path}: error: expected 3 rows or more of a distance and a height, got {table.shape}")
    if not np.all(np.isfinite(table)):
        raise InputError(f"{path}: error: a distance or a height is not finite")
    steps = np.diff(table[:, 0])
    if not np.allclose(steps, steps[0], rtol=1e-4, atol=0.0):
        raise InputError(f"{path}: error: the distances are not equally spaced")
    return table[:, 0], table[:, 1]


def estimate_octaves(distance: Floats, height: Floats, recipe: Recipe, density: float) -> list[Octave]:
    """The mean spectral density in octaves of the recipe's band, as wanted and as found in a profile.

    The spectrum found is the periodogram over the whole length, |Z(n)|² 2/L, divided by the mean square of the easing.
    Octaves are counted down from the highest wavenumber. density: the wanted G(0.1 1/m).
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


def fit_exponent(octaves: Sequence[Octave], wanted_exponent: float) -> float:
    """The exponent w of the spectrum found. A straight line is fitted to the logarithm of found over wanted density,
    against the logarithm of the octaves' middle wavenumbers; its slope corrects the wanted exponent. Two octaves or
    more.
    """
    middle = np.log([np.sqrt(octave.lowest * octave.highest) for octave in octaves])
    ratio = np.log([octave.found / octave.wanted for octave in octaves])
    return float(wanted_exponent - np.polyfit(middle, ratio, 1)[0])
