"""Modules of the languages import one another in one direction, for types too."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import sysmlc

LANGUAGE = Path(sysmlc.__file__).parent / "language"


def imports(folder):
    """What each module of a folder imports of the same folder."""
    names = {file.stem: file for file in folder.glob("*.py") if file.stem != "__init__"}
    package = f"sysmlc.{folder.relative_to(LANGUAGE.parent).as_posix().replace('/', '.')}"
    return {name: imported(file, package) & names.keys() for name, file in names.items()}


def imported(file, package):
    found = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module == package:
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"{package}."):
            found.add(node.module.removeprefix(f"{package}.").partition(".")[0])
    return found


@pytest.mark.parametrize("folder", ["names", "checks", "interchange", "formatter", "text"])
def test_no_module_imports_what_imports_it(folder):
    list(TopologicalSorter(imports(LANGUAGE / folder)).static_order())


def test_a_circle_is_found():
    with pytest.raises(CycleError):
        list(TopologicalSorter({"a": {"b"}, "b": {"c"}, "c": {"a"}}).static_order())
    assert "queries" in imports(LANGUAGE / "names")["expression_results"]
