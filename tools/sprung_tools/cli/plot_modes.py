"""Draws how modes were chosen: the road's spectrum, the vehicle's transfer functions, the frequencies of the modes kept
and left out, and below the share of each mode.

With --over-time it draws the modes of a run over time: which were active, the contribution of those left out, and below
quantities of this run, and of other runs if they are given."""

import argparse
from collections.abc import Sequence

from matplotlib.figure import Figure

from sprung_tools.cli.arguments import add_span_arguments
from sprung_tools.plots.mode_choice_picture import make_choice_figure, open_choice
from sprung_tools.plots.mode_history_picture import make_mode_history_figure
from sprung_tools.plots.picture_file import write_picture
from sprung_tools.runs.labelled_runs import Run, Shown, check_labelled_output, open_runs, shown_quantities
from sprung_tools.runs.mode_history import read_mode_histories
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.terminal.program import make_parser


def parse_arguments() -> argparse.Namespace:
    parser = make_parser(
        __doc__,
        "tools/plot_modes -o choice.png choice.h5\n"
        "  tools/plot_modes -o bump_modes.png --over-time adaptive=bump_adaptive.h5 '2 modes=bump_2modes.h5'",
    )
    parser.add_argument(
        "files", metavar="[LABEL=]FILE", nargs="+",
        help='file of select-modes, or results of a run with modes "auto"; with --over-time results of any run, and of '
        "others to compare with it",
    )  # fmt: skip
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE", help="file to write (.png, .svg, .pdf)")
    parser.add_argument("--over-time", action="store_true", help="draw the modes of a run over time")
    parser.add_argument(
        "--show", metavar="[LABEL=]QUANTITY", action="append",
        help="with --over-time: a quantity to draw below, and its name; may be given several times (default: the first "
        "body's vertical acceleration)",
    )  # fmt: skip
    add_span_arguments(parser)
    parser.add_argument("--title", default="", help="heading (default: the vehicle's name)")
    arguments = parser.parse_args()
    over_time_only = (arguments.show, arguments.start, arguments.end)
    if not arguments.over_time and (len(arguments.files) > 1 or any(one is not None for one in over_time_only)):
        parser.error("several files, --show, --from and --to go with --over-time")
    return arguments


def draw_histories(arguments: argparse.Namespace, runs: Sequence[Run]) -> Figure:
    """Draws the picture of --over-time."""
    quantities = shown_quantities(arguments.show or [])
    if not quantities:
        body = read_mode_histories(runs[0].results)[0].body
        quantities = [Shown(f"acceleration of {body}", f"bodies/{body}/acceleration.y")]
    return make_mode_history_figure(runs, quantities, (arguments.start, arguments.end), arguments.title)


def main() -> int:
    arguments = parse_arguments()
    check_labelled_output(arguments.output, arguments.files)
    runs = open_runs(arguments.files) if arguments.over_time else []
    if arguments.over_time:
        figure = draw_histories(arguments, runs)
    else:
        figure = make_choice_figure(open_choice(arguments.files[0]), arguments.title)
    write_picture(figure, arguments.output)
    print("\n".join([*list_doubts(runs), arguments.output]))
    return 0
