"""Draws where more steel moves a frequency of a body: the frame, coloured by what 1 % more cross section of each
element changes. It takes what `sprung-reduce sensitivity DESIGN.toml --json` prints."""

import argparse

from sprung_tools.files.whole_file import check_output
from sprung_tools.plots.picture_file import write_picture
from sprung_tools.plots.sensitivity_picture import make_sensitivity_figure, read_elements
from sprung_tools.terminal.program import make_parser


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(
        __doc__,
        "tools/plot_sensitivity -o first.png chassis.json\n"
        "  tools/plot_sensitivity -o all.png chassis.json --modes 1 2 3",
    )
    parser.add_argument("file", metavar="FILE", help="what sprung-reduce sensitivity --json printed")
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE", help="file to write (.png, .svg, .pdf)")
    parser.add_argument("--modes", type=int, nargs="+", default=[1], metavar="N", help="free modes (default: 1)")
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    check_output(arguments.output, [arguments.file])
    elements = read_elements(arguments.file)
    write_picture(make_sensitivity_figure(elements, arguments.modes), arguments.output)
    return 0
