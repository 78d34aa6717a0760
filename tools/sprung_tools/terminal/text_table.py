"""Tables for a terminal."""


def is_number(cell):
    """Whether a cell reads as one number."""
    try:
        float(cell)
    except ValueError:
        return False
    return True


def format_table(headings, rows):
    """Columns two blanks apart, numbers to the right, a rule under the headings; a first cell equal to the one
    above is left blank.

    headings: strings; rows: sequences of as many strings. Returns the table's text without a last line end.
    """
    columns = list(zip(headings, *rows))
    widths = [max(map(len, column)) for column in columns]
    to_right = [all(is_number(cell) for cell in column[1:] if cell) for column in columns]

    def line(cells):
        padded = (
            cell.rjust(width) if right else cell.ljust(width)
            for cell, width, right in zip(cells, widths, to_right)
        )
        return "  ".join(padded).rstrip()

    lines = [line(headings), "  ".join("─" * width for width in widths)]
    above = None
    for row in rows:
        lines.append(line(("", *row[1:]) if row[0] == above else row))
        above = row[0]
    return "\n".join(lines)
