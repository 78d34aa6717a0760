"""Draws the frequency response of one or more vehicles to the road, or the spectral densities or third-octave bands
on a random road, a panel for each output."""

from sprung_tools.plots.picture_file import write_picture
from sprung_tools.plots.response_picture import BANDS, MAGNITUDE, SPECTRUM, make_response_figure
from sprung_tools.runs.labelled_responses import open_responses
from sprung_tools.runs.labelled_runs import check_labelled_output, shown_quantities
from sprung_tools.terminal.program import make_parser


def main() -> int:
    parser = make_parser(
        __doc__,
        "tools/plot_response -o response.png rigid=rigid.h5 '4 modes=modes.h5' \\\n"
        "    --show 'seat=points/chassis.seat/acceleration.y' --show forces/front_tyre/force",
    )
    parser.add_argument("files", metavar="[LABEL=]FILE", nargs="+", help="response file, and its name in the legend")
    parser.add_argument(
        "--show", metavar="[LABEL=]OUTPUT", action="append", required=True,
        help="an output such as points/chassis.seat/acceleration.y, and its name; may be given several times",
    )  # fmt: skip
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE", help="file to write (.png, .svg, .pdf)")
    parser.add_argument("--title", default="", help="heading (default: the names of the vehicles)")
    drawing = parser.add_mutually_exclusive_group()
    drawing.set_defaults(drawing=MAGNITUDE)
    drawing.add_argument(
        "--spectrum", dest="drawing", action="store_const", const=SPECTRUM,
        help="draw spectral densities, with the r.m.s.",
    )  # fmt: skip
    drawing.add_argument(
        "--bands", dest="drawing", action="store_const", const=BANDS,
        help="draw the r.m.s. in third-octave bands, of vertical accelerations with the boundaries of reduced comfort",
    )  # fmt: skip
    arguments = parser.parse_args()

    check_labelled_output(arguments.output, arguments.files)
    responses = open_responses(arguments.files)
    figure = make_response_figure(responses, shown_quantities(arguments.show), arguments.title, arguments.drawing)
    write_picture(figure, arguments.output)
    print(arguments.output)
    return 0
