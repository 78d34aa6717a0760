"""Draws quantities of one or more runs over time into a picture, a panel for each quantity."""

from sprung_tools.cli.arguments import add_run_arguments
from sprung_tools.plots.picture_file import write_picture
from sprung_tools.plots.results_picture import make_results_figure
from sprung_tools.runs.labelled_runs import (
    check_labelled_output,
    join_titles,
    list_lacking,
    open_runs,
    shown_quantities,
)
from sprung_tools.runs.run_warnings import list_doubts
from sprung_tools.terminal.program import make_parser


def main() -> int:
    parser = make_parser(
        __doc__,
        "tools/plot_results -o bump.png rigid=bump_rigid.h5 '2 modes=bump_2modes.h5' \\\n"
        "    --show 'heave=bodies/chassis/displacement.y' --show points/chassis.seat/acceleration.y",
    )
    add_run_arguments(parser)
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE", help="file to write (.png, .svg, .pdf)")
    parser.add_argument("--title", default="", help="heading (default: the names of the vehicles)")
    parser.add_argument("--mark-road", action="store_true", help="shade the times in which a tyre is on an obstacle")
    arguments = parser.parse_args()

    check_labelled_output(arguments.output, arguments.runs)
    runs = open_runs(arguments.runs)
    title = arguments.title or join_titles(run.results.title for run in runs)
    span = (arguments.start, arguments.end)
    quantities = shown_quantities(arguments.show)
    figure = make_results_figure(runs, quantities, span, title, arguments.mark_road)
    write_picture(figure, arguments.output)
    print("\n".join([*list_doubts(runs), *list_lacking(runs, quantities), arguments.output]))
    return 0
