"""The page that tools/report writes, and the data in it, without a browser."""

import base64
import json
import re

import numpy as np
from tool_test_case import ToolTestCase


def decode(text):
    return np.frombuffer(base64.b64decode(text), dtype="<f4")


def find_data(text):
    """The data in a page's text."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])


def read_page(path):
    """The page's text and its data."""
    text = path.read_text(encoding="utf-8")
    return text, find_data(text)


class ReportCase(ToolTestCase):
    def report(self, *arguments):
        process = self.run_tool("report", *arguments, "-o", "page.html")
        self.assert_succeeds(process)
        self.assertIn(f"Open it in a browser: {(self.folder / 'page.html').resolve().as_uri()}", process.stdout)
        return read_page(self.folder / "page.html")
