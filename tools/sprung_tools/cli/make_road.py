"""Makes a random road profile from a band of wavenumbers, an exponent, and an r.m.s. or an ISO 8608 class, writes it as
a road table, and prints the spectrum and the r.m.s. of the file that it wrote."""

import argparse
import shlex
import sys
from collections.abc import Sequence

import numpy as np

from sprung_tools.files.whole_file import write_whole
from sprung_tools.signals.road_profile import (
    ISO_BAND,
    ISO_CLASSES,
    Recipe,
    calc_iso_density,
    calc_rms,
    estimate_octaves,
    fit_exponent,
    format_profile,
    make_profile,
    read_profile,
)
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

FINE = 5.0  # points on the shortest wave; with fewer a spline through them misses its height by more than 3 %


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(
        __doc__,
        "tools/make_road.py -o terrain.txt --length 91.44 --spacing 0.0508 --band 0.0545 3.33 --rms 0.0264 \\\n"
        "    --ease 3 --seed 1\n"
        "  tools/make_road.py -o class_c.txt --iso-class C --length 500 --spacing 0.05 --ease 5 --seed 7",
    )
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="road table to write")
    parser.add_argument("--length", type=float, required=True, metavar="M", help="length of the profile, m")
    parser.add_argument(
        "--spacing",
        type=float,
        required=True,
        metavar="M",
        help="distance between its points, m; must divide the length",
    )
    parser.add_argument(
        "--band", type=float, nargs=2, metavar=("LOW", "HIGH"),
        help=f"lowest and highest wavenumber, 1/m (default for an ISO class: {ISO_BAND[0]:g} {ISO_BAND[1]:g})",
    )  # fmt: skip
    parser.add_argument(
        "--exponent", type=float, default=2.0, metavar="W", help="spectral density falls as n^-W (default: 2)"
    )
    level = parser.add_mutually_exclusive_group(required=True)
    level.add_argument(
        "--rms", type=float, default=0.0, metavar="M", help="r.m.s. height over all points, about their mean, m"
    )
    level.add_argument("--iso-class", choices=ISO_CLASSES, help="ISO 8608 class: its geometric mean, exponent 2")
    parser.add_argument(
        "--ease",
        type=float,
        default=0.0,
        metavar="M",
        help="raised-cosine easing at both ends, m (default: 0)",
    )
    parser.add_argument("--seed", type=int, default=1, help="seed of the random phases (default: 1)")
    arguments = parser.parse_args()
    if arguments.iso_class and arguments.exponent != 2.0:
        parser.error("an ISO 8608 class has the exponent 2")
    if not arguments.iso_class and not arguments.band:
        parser.error("--rms needs --band")
    return arguments


def make_recipe(arguments: argparse.Namespace) -> Recipe:
    low, high = arguments.band or ISO_BAND
    return Recipe(
        length=arguments.length,
        spacing=arguments.spacing,
        band=(low, high),
        exponent=arguments.exponent,
        rms=arguments.rms,
        density=calc_iso_density(arguments.iso_class) if arguments.iso_class else 0.0,
        ease=arguments.ease,
        seed=arguments.seed,
    )


def describe_command(arguments: Sequence[str]) -> str:
    """The command line that makes the same file, without the file's name."""
    words = ["tools/make_road.py"]
    skip = False
    for word in arguments:
        if skip or word.startswith("--output=") or (word.startswith("-o") and word != "-o"):
            skip = False
        elif word in ("-o", "--output"):
            skip = True
        else:
            words.append(word)
    return shlex.join(words)


def format_report(path: str, recipe: Recipe, density: float) -> str:
    """The report on the file: r.m.s., steepest slope between points, the spectrum in octaves and the wanted one."""
    distance, height = read_profile(path)
    octaves = estimate_octaves(distance, height, recipe, density)
    rows = [
        (
            f"{one.lowest:.4f}",
            f"{one.highest:.4f}",
            f"{one.wanted:.4e}",
            f"{one.found:.4e}",
            f"{one.found / one.wanted:.3f}",
        )
        for one in octaves
    ]
    lines = [
        f"{path}: {distance.size} points, r.m.s. {calc_rms(height, recipe.ease):.6f} m, least {height.min():.4f} m, "
        f"greatest {height.max():.4f} m, steepest slope {np.max(np.abs(np.diff(height) / np.diff(distance))):.3f}",
        format_table(("from 1/m", "to 1/m", "wanted m^3", "found m^3", "ratio"), rows),
    ]
    if len(octaves) > 1:
        lines.append(f"exponent wanted {recipe.exponent:g}, found {fit_exponent(octaves, recipe.exponent):.3f}")
    points = 1.0 / (octaves[-1].highest * recipe.spacing)
    if points < FINE:
        lines.append(
            f"remark: only {points:.2f} points on the shortest wave; a smooth curve through them needs {FINE:g}"
        )
    return "\n".join(lines)


def main() -> int:
    arguments = parse_arguments()
    recipe = make_recipe(arguments)
    profile = make_profile(recipe)
    write_whole(arguments.output, format_profile(recipe, profile, describe_command(sys.argv[1:])))
    print(format_report(arguments.output, recipe, profile.density))
    return 0
