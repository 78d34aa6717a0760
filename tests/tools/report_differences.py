"""By how much the tables of the truck's report may differ where another compiler, processor or library made the
runs."""

import re

from markdown_tables import find_differences

# The report states these.
RELATIVE = 0.01
RELATIVE_EVALUATIONS = 0.15
# Of how often modes joined and left, how many took part, and how often a run with such modes was evaluated: share, or
# units.
RELATIVE_CHANGES, CHANGES = 0.25, 3.0
# By how many per cent of the full run's value the differences from it may move where modes come and go; horizontal
# peaks are single samples of what rings at hundreds of Hz.
POINTS, POINTS_HORIZONTAL = 3.0, 10.0
EVALUATIONS = ("evaluations", "effort", "effort of Adams")
COUNTS = ("modes active", "instants of change")  # how columns of the tables on modes begin


def rows_of_evaluations(name, row):
    """Whether a row's numbers count evaluations, which another step of the integrator changes more than results."""
    return name in EVALUATIONS or any(cell.startswith(EVALUATIONS) for cell in row)


def is_adaptive(name, row):
    """Whether a row of a table on modes is of runs in which they come and go."""
    return name == "recall" or any(word in cell for cell in row[:2] for word in ("from 2,", "adaptive"))


def find_mode_differences(name, kept, made):
    """Differences of a table on modes.

    Where modes come and go it hangs on rounding errors whether one joins a moment earlier, so counts and what is off
    may differ more; which of two modes misses most may, too. A verdict there follows from a number beside it that may
    be as near to its limit; and how well the energy book closes is rounding errors alone: run_all() refuses runs in
    which it does not.
    """
    headings, rows = made
    every = [one for one in headings[1:] if one != "energy closure"]
    effort = [one for one in every if one.startswith(EVALUATIONS)]
    changes = [one for one in every if one.startswith(COUNTS)]
    told = [one for one in every if one.startswith("told")]
    numbers = [one for one in every if one not in (*effort, *changes, *told)]
    changing = [row for row in rows if is_adaptive(name, row)]
    sideways = [row for row in changing if any("horizontal" in cell for cell in row[:3])]
    changing = [row for row in changing if row not in sideways]
    fixed = [row for row in rows if row not in (*changing, *sideways)]
    unjudged = [one for one in numbers if one != "holds?"]
    found = []
    for some, columns, relative, digits, points in (
        (fixed, effort, RELATIVE_EVALUATIONS, 1.5, 0.0),
        (changing, effort, RELATIVE_CHANGES, 1.5, 0.0),
        (rows, changes, RELATIVE_CHANGES, CHANGES, 0.0),
        (fixed, numbers, RELATIVE, 1.5, 0.0),
        (changing, unjudged, POINTS / 100.0, 1.5, POINTS),
        (sideways, unjudged, POINTS / 100.0, 1.5, POINTS_HORIZONTAL),
    ):
        columns = [headings[0], *columns]
        found += find_differences(
            keep_columns(kept, columns), keep_columns((headings, some), columns), relative, digits, points
        )
    for column in told:
        columns = [headings[0], column]
        old, new = (keep_largest_shares(keep_columns(table, columns)) for table in (kept, (headings, rows)))
        found += find_differences(old, new, RELATIVE, points=POINTS)
    return found


def keep_largest_shares(table):
    """A table of two columns, in whose second of several numbers in % the largest alone is kept."""
    cells = [(first, re.findall(r"([0-9.]+) %", second), second) for first, second in table[1]]
    return table[0], [
        [first, f"{max(map(float, shares)):.1f} %" if shares else words] for first, shares, words in cells
    ]


def keep_columns(table, headings):
    """A table's columns of these headings; its first row is kept as parse_markdown() gives it."""
    columns = [table[0].index(heading) for heading in headings if heading in table[0]]
    return [table[0][place] for place in columns], [[row[place] for place in columns] for row in table[1]]
