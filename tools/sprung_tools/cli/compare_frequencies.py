"""Compares the lowest frequencies of a superelement with known ones: those of its free or clamped modes. Its other
vectors have no frequency of the body (reduce/basis, "Kinds of vectors"), and are left out."""

from collections import Counter

from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import SUPERELEMENT, open_hdf5, read_numbers, read_text, read_texts
from sprung_tools.model.reduced_vectors import OF_THE_BODY
from sprung_tools.terminal.program import make_parser
from sprung_tools.terminal.text_table import format_table

HEADINGS = ("body", "mode", "computed Hz", "printed Hz", "difference Hz", "difference %", "same digits")


def num_decimals(text: str) -> int:
    """The number of decimals in a text: "6.11" → 2."""
    return len(text.partition(".")[2])


def parse_frequency(number: int, text: str) -> float:
    """Reads a known frequency [Hz]. number: its position on the command line, from 1. InputError if it is not
    positive."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise InputError(f"--printed {number}: error: '{text}' is not a frequency > 0 Hz")
    return value


def main() -> int:
    parser = make_parser(__doc__, "tools/compare_frequencies chassis.h5 --printed 6.11 6.11 38.31 38.31")
    parser.add_argument("file", metavar="SUPERELEMENT", help="superelement file of sprung-reduce")
    parser.add_argument(
        "--printed", metavar="HZ", nargs="+", required=True, help="known frequencies from mode 1 on, Hz"
    )
    arguments = parser.parse_args()

    printed = [parse_frequency(number, text) for number, text in enumerate(arguments.printed, start=1)]
    with open_hdf5(arguments.file, SUPERELEMENT) as file:
        name = read_text(file, "", "name", "")
        frequencies, _ = read_numbers(file, "modes/frequency")
        kinds = read_texts(file, "modes/kind") if file.has_dataset("modes/kind") else ["clamped"] * frequencies.size
    modes = [k for k, kind in enumerate(kinds) if kind in OF_THE_BODY]
    others = Counter(kind for kind in kinds if kind not in OF_THE_BODY)
    counts = ", ".join(f"{count} {kind}" for kind, count in others.items())
    left_out = f"left out are vectors without a frequency of the body: {counts}"
    if len(modes) < len(printed):
        what = f"has {len(modes)} modes, {len(printed)} to compare were given"
        raise InputError(f"{arguments.file}: error: {what}" + (f"; {left_out}" if others else ""))

    rows = []
    for mode, known, text in zip(modes, printed, arguments.printed):
        computed = frequencies[mode]
        difference = computed - known
        digits = "yes" if f"{computed:.{num_decimals(text)}f}" == text else "NO"
        percent = f"{100.0 * difference / known:+.4f}"
        rows.append((name, str(mode + 1), f"{computed:.5f}", text, f"{difference:+.5f}", percent, digits))
    if others:
        print(f"remark: {left_out}\n")
    print(format_table(HEADINGS, rows))
    return 0
