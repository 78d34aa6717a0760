"""Style checks: flake8 and mypy on the Python package, flake8 on the tests, shellcheck on the scripts, clang-format on
the C++ sources.

A checker that is not installed fails the test. The sources are formatted by clang-format 14, the version of Debian 12.
Other versions format some lines differently, so the check is skipped with them. Mypy is skipped with numpy 2, whose
types are others."""

import importlib.metadata
import importlib.util
import os
import re
import shutil
import sys
import unittest

from tool_test_case import ROOT, TOOLS, list_git_files, run_program

FORMAT_VERSION = 14


def find_files(test):
    """The files of the project for whose path from the root test(path) holds: those that git knows or would add. In a
    copy without git they are all files outside build/."""
    files = set(list_git_files("--cached", "--others", "--exclude-standard"))
    if not files:
        files = {path.relative_to(ROOT) for path in ROOT.rglob("*") if path.relative_to(ROOT).parts[0] != "build"}
    return [ROOT / file for file in sorted(files) if (ROOT / file).is_file() and test(file)]


def find_scripts(shebang):
    """All executable files of the project that begin with a line."""

    def begins_with_it(file):
        with open(ROOT / file, "rb") as content:
            return os.access(ROOT / file, os.X_OK) and content.readline() == shebang

    return find_files(begins_with_it)


class Style(unittest.TestCase):
    def check(self, command, files):
        """Runs a checker on files, of which there must be some; what it finds fails the test."""
        self.assertGreater(len(files), 0)
        process = run_program([*command, *files], cwd=ROOT)
        self.assertEqual(process.returncode, 0, f"{process.stdout}\n{process.stderr}")

    def require_module(self, name, package):
        """The command of a checker in Python, whatever `flake8` or `mypy` stands first in PATH."""
        if importlib.util.find_spec(name) is None:
            self.fail(f"{name} is not installed for {sys.executable}: install the Debian package {package}")
        return [sys.executable, "-m", name]

    def require_program(self, name, package):
        path = shutil.which(name)
        if path is None:
            self.fail(f"{name} is not installed: install the Debian package {package}")
        return path

    @staticmethod
    def find_python_of_tools():
        launchers = [path for path in find_scripts(b"#!/usr/bin/python3\n") if path.parent == TOOLS]
        examples = sorted((ROOT / "dynamics/models").rglob("*.py"))
        return [TOOLS / "sprung_tools", TOOLS / "sprung", *launchers, *examples]

    def test_flake8_finds_nothing_in_the_tools(self):
        command = [*self.require_module("flake8", "flake8"), "--config", TOOLS / ".flake8"]
        self.check(command, self.find_python_of_tools())

    def test_flake8_finds_nothing_in_the_tests(self):
        command = [*self.require_module("flake8", "flake8"), "--config", TOOLS / ".flake8"]
        self.check(command, [ROOT / "tests"])

    def test_mypy_finds_nothing_in_the_tools(self):
        if int(importlib.metadata.version("numpy").split(".")[0]) > 1:
            self.skipTest("the tools are typed for numpy 1")
        command = self.require_module("mypy", "mypy")
        cache = os.environ.get("SPRUNG_MYPY_CACHE", os.devnull)
        options = ["--config-file", TOOLS / "pyproject.toml", "--cache-dir", cache, "--no-error-summary"]
        self.check([*command, *options], self.find_python_of_tools())

    def test_shellcheck_finds_nothing_in_the_scripts(self):
        scripts = find_scripts(b"#!/bin/bash\n")
        names = {path.relative_to(ROOT).as_posix() for path in scripts}
        self.assertLessEqual({"tools/setup", "tools/build", "tools/test", "tools/run-truck", ".ci/run"}, names)
        self.check([self.require_program("shellcheck", "shellcheck")], scripts)

    def test_the_cpp_sources_are_formatted(self):
        program = self.require_program("clang-format", "clang-format")
        said = run_program([program, "--version"]).stdout
        version = int(re.search(r"version (\d+)", said)[1])
        if version != FORMAT_VERSION:
            self.skipTest(f"clang-format {version} formats differently from version {FORMAT_VERSION}")
        sources = find_files(lambda path: path.suffix in (".h", ".cpp"))
        self.check([program, "--dry-run", "-Werror"], sources)


if __name__ == "__main__":
    unittest.main()
