"""Tables for a terminal."""

from collections.abc import Sequence

Rows = Sequence[Sequence[str]]
Table = tuple[Sequence[str], Rows]  # headings, rows
MISSING = "–"  # in a cell


def is_number(cell: str) -> bool:
    """Whether a cell reads as one number."""
    try:
        float(cell)
    except ValueError:
        return False
    return True


def format_cell(value: float | None, digits: int, factor: float = 1.0) -> str:
    """A number times a factor with so many digits after the point, 0 without a sign; MISSING for None."""
    return MISSING if value is None else f"{round(factor * value, digits) + 0.0:.{digits}f}"


def format_table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Formats a table: columns two blanks apart, numbers right-aligned, a rule under the headings. A first cell that is
    equal to the one above is left blank.

    rows: as many cells in each as there are headings. Returns the text without a last line end.
    """
    columns = list(zip(headings, *rows))
    widths = [max(map(len, column)) for column in columns]
    to_right = [all(is_number(cell) for cell in column[1:] if cell) for column in columns]

    def line(cells: Sequence[str]) -> str:
        padded = (
            cell.rjust(width) if right else cell.ljust(width) for cell, width, right in zip(cells, widths, to_right)
        )
        return "  ".join(padded).rstrip()

    lines = [line(headings), "  ".join("─" * width for width in widths)]
    above = None
    for row in rows:
        lines.append(line(("", *row[1:]) if row[0] == above else row))
        above = row[0]
    return "\n".join(lines)
