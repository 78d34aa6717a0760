"""The layers of the Python package: tools/pyproject.toml lists its subpackages, the highest first, and each may import
from itself and from those after it."""

import ast
import tomllib
from pathlib import Path

PACKAGE = "sprung_tools"


def read_layers(tools):
    """The subpackages as pyproject.toml in the folder `tools` lists them, the highest first."""
    settings = tomllib.loads((Path(tools) / "pyproject.toml").read_text(encoding="utf-8"))
    return settings["tool"]["sprung"]["layers"]


def read_imports(path):
    """(line, name) of everything that a file imports, at any place in it. A relative import begins with a dot."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
            # `from package import module` may import a module or something that the package defines.
            found += [(node.lineno, f"{module}.{alias.name}") for alias in node.names]
    return found


def find_upward_imports(tools):
    """Every import in the package that does not go downward, as `file:line: error: …`."""
    tools = Path(tools)
    layers = read_layers(tools)
    problems = []
    for path in sorted((tools / PACKAGE).rglob("*.py")):
        file = path.relative_to(tools)
        layer = file.parts[1] if len(file.parts) > 2 else None
        if layer is not None and layer not in layers:
            problems.append(f"{file}:1: error: '{layer}' is not among the layers in pyproject.toml")
            continue
        allowed = layers[layers.index(layer) :] if layer else []
        for line, name in read_imports(path):
            parts = name.split(".")
            if name.startswith("."):
                problems.append(f"{file}:{line}: error: '{name}' is a relative import, expected one from {PACKAGE}")
            elif parts[0] == PACKAGE and parts[1] not in allowed:
                there = ", ".join(allowed) or "nothing"
                problems.append(
                    f"{file}:{line}: error: '{name}' is not for {layer or PACKAGE}, which may import {there}"
                )
    return problems


def find_empty_layers(tools):
    """Layers in pyproject.toml of which there is no subpackage."""
    tools = Path(tools)
    return [layer for layer in read_layers(tools) if not (tools / PACKAGE / layer / "__init__.py").exists()]
