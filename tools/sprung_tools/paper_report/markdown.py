"""Tables in Markdown, and the parts of a README that a program writes.

A part stands between `<!-- begin NAME -->` and `<!-- end NAME -->`.
"""

from collections.abc import Sequence

from sprung_tools.files.errors import InputError
from sprung_tools.terminal.text_table import Rows


def format_markdown(headings: Sequence[str], rows: Rows) -> str:
    """A table's text: a line for the headings, a rule, a line for each row."""
    lines = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def format_words(text: str) -> str:
    """A text as a quotation."""
    return "\n".join(f"> {line}" for line in text.splitlines())


def find_part(text: str, name: str) -> tuple[int, int]:
    """Finds the part of a name. Returns where it begins and ends. InputError unless each of its markers is there
    once."""
    begin, end = f"<!-- begin {name} -->\n", f"\n<!-- end {name} -->"
    if text.count(begin) != 1 or text.count(end) != 1 or text.index(begin) > text.index(end):
        raise InputError(f"error: no single part '{name}' between '{begin.strip()}' and '{end.strip()}'")
    return text.index(begin) + len(begin), text.index(end)


def replace_part(text: str, name: str, content: str) -> str:
    """Replaces the part of a name."""
    start, end = find_part(text, name)
    return text[:start] + content + text[end:]
