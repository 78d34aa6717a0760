"""Arguments that several commands have."""

import argparse


def add_run_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments of a command on runs: files, quantities, the span of time."""
    parser.add_argument("runs", metavar="[LABEL=]FILE", nargs="+", help="results file, and its name in the legend")
    parser.add_argument(
        "--show", metavar="[LABEL=]QUANTITY", action="append", required=True,
        help="a quantity such as bodies/chassis/displacement.y, and its name; may be given several times",
    )  # fmt: skip
    add_span_arguments(parser)


def add_span_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments of a span of time."""
    parser.add_argument("--from", dest="start", type=float, metavar="S", help="begin at this time, s")
    parser.add_argument("--to", dest="end", type=float, metavar="S", help="end at this time, s")
