"""Imports in the Python package go only downward, and what its pyproject.toml and README say of it is so."""

import os
import re
import tomllib
import unittest

from layers import PACKAGE, find_empty_layers, find_upward_imports, read_imports, read_layers
from tool_test_case import ROOT, TOOLS, ToolTestCase


class ThePackage(unittest.TestCase):
    def test_no_import_goes_upward(self):
        self.assertEqual(find_upward_imports(TOOLS), [])

    def test_every_layer_is_there(self):
        self.assertEqual(find_empty_layers(TOOLS), [])
        self.assertEqual((read_layers(TOOLS)[0], read_layers(TOOLS)[-1]), ("cli", "files"))

    def test_the_readme_lists_the_subpackages_in_their_order(self):
        text = (TOOLS / "README.md").read_text(encoding="utf-8")
        self.assertEqual(re.findall(r"^\| `(\w+)/` \|", text, re.MULTILINE), read_layers(TOOLS))

    def test_its_version_is_the_projects(self):
        settings = tomllib.loads((TOOLS / "pyproject.toml").read_text(encoding="utf-8"))
        project = re.search(r"project\(sprung\s+VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
        self.assertEqual(settings["project"]["version"], project[1])

    def test_every_command_starts_the_module_of_its_name_by_debians_python(self):
        launchers = {}
        for path in TOOLS.iterdir():
            if path.is_file() and os.access(path, os.X_OK) and path.read_bytes().startswith(b"#!/usr/bin/python3\n"):
                launchers[path.name.removesuffix(".py")] = path
        modules = {path.stem for path in (TOOLS / PACKAGE / "cli").glob("*.py")} - {"__init__", "arguments"}
        self.assertEqual(set(launchers), modules)
        for name, path in launchers.items():
            imported = [what for _, what in read_imports(path)]
            self.assertEqual(imported, [f"{PACKAGE}.terminal.command.run_command"], path)
            self.assertIn(f'run_command("{name}")', path.read_text(encoding="utf-8"), path)


class TheCheck(ToolTestCase):
    """On a small package of two layers."""

    def setUp(self):
        super().setUp()
        self.write("pyproject.toml", '[tool.sprung]\nlayers = ["cli", "files"]\n')
        for name in ("__init__", "cli/__init__", "cli/tool", "files/__init__", "files/table"):
            self.write(f"{PACKAGE}/{name}.py", "")

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def assert_found(self, name, text, *fragments):
        self.write(f"{PACKAGE}/{name}.py", text)
        found = find_upward_imports(self.folder)
        self.assertEqual(len(found), 1, found)
        for fragment in fragments:
            self.assertIn(fragment, found[0])

    def test_imports_downward_and_within_a_layer_pass(self):
        self.write(
            f"{PACKAGE}/cli/tool.py", f"import os\nfrom {PACKAGE}.files.table import a\nimport {PACKAGE}.cli.other\n"
        )
        self.write(f"{PACKAGE}/files/table.py", f"from {PACKAGE}.files import lines\n")
        self.assertEqual(find_upward_imports(self.folder), [])

    def test_an_import_upward_is_found_at_its_line_in_every_form(self):
        for text in (
            f"import os\nfrom {PACKAGE}.cli.tool import main\n",
            f"import os\nfrom {PACKAGE}.cli import tool\n",
            f"import os\nfrom {PACKAGE} import cli\n",
            f"import os\nimport {PACKAGE}.cli.tool\n",
            f"def call():\n    from {PACKAGE}.cli import tool\n",
        ):
            with self.subTest(text):
                self.assert_found("files/table", text, f"{PACKAGE}/files/table.py:2: error: ", "which may import files")

    def test_the_package_itself_imports_nothing_of_its_own(self):
        self.assert_found("__init__", f"from {PACKAGE}.files import table\n", "which may import nothing")

    def test_a_relative_import_is_found(self):
        self.assert_found("cli/tool", "from ..files import table\n", "'..files.table' is a relative import")

    def test_a_subpackage_that_is_not_listed_is_found(self):
        self.assert_found("plots/__init__", "", "'plots' is not among the layers")

    def test_a_layer_that_is_not_there_is_found(self):
        self.write("pyproject.toml", '[tool.sprung]\nlayers = ["cli", "plots", "files"]\n')
        self.assertEqual(find_empty_layers(self.folder), ["plots"])


if __name__ == "__main__":
    unittest.main()
