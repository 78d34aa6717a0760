"""Every link from one Markdown file of the project to another file or section leads there."""

import re
import unittest
from pathlib import Path
from urllib.parse import unquote

from equations import find_files
from tool_test_case import ROOT, ToolTestCase

LINK = re.compile(r"\]\(([^()\s]+)\)")
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def make_anchor(heading):
    """The anchor of a section as GitHub makes it from the heading."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def find_broken_links(root):
    """Every link to a missing file or section, as `file: target`. Links to the web are left out."""
    broken = []
    for file in find_files(root):
        if not file.endswith(".md"):
            continue
        text = FENCE.sub("", (Path(root) / file).read_text(encoding="utf-8"))
        for target in LINK.findall(text):
            if re.match(r"\w+:", target):
                continue
            name, _, section = unquote(target).partition("#")
            path = (Path(root) / file).parent / name if name else Path(root) / file
            if not path.exists() or (section and section not in read_anchors(path)):
                broken.append(f"{file}: {target}")
    return broken


def read_anchors(path):
    return set(map(make_anchor, HEADING.findall(FENCE.sub("", path.read_text(encoding="utf-8")))))


class Links(ToolTestCase):
    def test_every_link_of_the_project_leads_somewhere(self):
        self.assertEqual(find_broken_links(ROOT), [])

    def test_missing_files_and_sections_are_found(self):
        (self.folder / "tools").mkdir()
        (self.folder / "README.md").write_text(
            "# A b: `c`\n[1](tools/README.md) [2](#a-b-c) [3](tools/none.md) [4](#none) [5](https://a.b/c)\n",
            encoding="utf-8",
        )
        (self.folder / "tools" / "README.md").write_text("[6](../README.md#a-b-c) [7](../README.md#x)\n")
        self.assertEqual(
            find_broken_links(self.folder),
            ["README.md: tools/none.md", "README.md: #none", "tools/README.md: ../README.md#x"],
        )


if __name__ == "__main__":
    unittest.main()
