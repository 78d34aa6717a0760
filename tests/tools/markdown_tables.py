"""Tables in a README: reading one, and where it differs from one that was made anew."""

import re

import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.paper_report.markdown import find_part

NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def parse_markdown(text):
    """Headings and rows of the first table in a text; ([], []) if there is none."""
    lines = [line.strip() for line in text.splitlines() if line.strip().startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return (cells[0], cells[2:]) if len(cells) > 2 else ([], [])


def read_part(text, name):
    """The text between a name's markers."""
    start, end = find_part(text, name)
    return text[start:end]


def find_differences(kept, made, relative, absolute_digits=1.5, points=0.0):
    """Where a table as kept differs from one as made: a list of sentences, empty if they agree.

    Rows of `made` are looked up in `kept` by their first cell. Words must be equal; numbers may differ by the share
    `relative`, by `absolute_digits` units of the last digit shown, and those in % by `points` of a per cent.
    """
    headings, rows = kept
    if list(headings) != list(made[0]):
        return [f"headings {headings}, expected {list(made[0])}"]
    found = {row[0]: row for row in rows}
    complaints = []
    for row in made[1]:
        if row[0] not in found:
            complaints.append(f"no row '{row[0]}'")
            continue
        for heading, old, new in zip(headings, found[row[0]], row):
            if not cells_agree(old, new, relative, absolute_digits, points):
                complaints.append(f"row '{row[0]}', column '{heading}': '{old}' is now '{new}'")
    return complaints


def cells_agree(old, new, relative, absolute_digits=1.5, points=0.0):
    """Whether two cells have the same words, and numbers that agree as in find_differences()."""
    if NUMBER.sub("#", old) != NUMBER.sub("#", new):
        return False
    for one, other in zip(NUMBER.finditer(old), NUMBER.findall(new)):
        first, second = (float(text.replace("−", "-")) for text in (one[0], other))
        digits = len(one[0].partition(".")[2].partition("e")[0])
        unit = 10.0**-digits * (10.0 ** int(one[0].partition("e")[2]) if "e" in one[0] else 1.0)
        share = points if old.startswith(" %", one.end()) else 0.0
        if abs(first - second) > max(relative * abs(first), absolute_digits * unit, share):
            return False
    return True
