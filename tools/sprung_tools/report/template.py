"""A page as one file: a template of HTML whose marks @NAME@ are replaced by styles, scripts and data."""

import json
import os
from collections.abc import Mapping
from typing import Any

from sprung_tools.files.errors import InputError

WEB = os.path.join(os.path.dirname(os.path.realpath(__file__)), "web")  # what pages of all kinds share


def read_asset(path: str) -> str:
    """Reads a file of the page. InputError if it cannot be read."""
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except OSError as error:
        raise InputError(f"{path}: error: cannot read it ({error.strerror}); tools/setup installs dygraphs") from error


def pack_json(data: Any) -> str:
    """Data as JSON for a script element. It contains no "<" at all, because "<!--" and "<script" in a script element
    change where it ends."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def fill_template(page: str, parts: Mapping[str, str]) -> str:
    """A template with texts in place of its marks. LIBRARY and SCRIPT stand in script elements."""
    for name in parts:
        before, _, after = page.partition(f"@{name}@")
        page = f"{before}\0{name}\0{after}"
    for name, text in parts.items():  # in a second pass, so that a name within an inserted text is left alone
        if name in ("LIBRARY", "SCRIPT"):
            # "</script" would end a script element; "</" alone may be part of a regular expression.
            text = text.replace("</script", "<\\/script")
        page = page.replace(f"\0{name}\0", text, 1)
    return page
