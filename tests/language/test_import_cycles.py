"""Modules of the language packages import each other without cycles, also for type checking."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import sysmlc

LANGUAGE = Path(sysmlc.__file__).parent / "language"


def read_imports(folder):
    """Return which modules of a folder each module of that folder imports."""
    files = {file.stem: file for file in folder.glob("*.py") if file.stem != "__init__"}
    package = f"sysmlc.{folder.relative_to(LANGUAGE.parent).as_posix().replace('/', '.')}"
    return {name: list_imports(file, package) & files.keys() for name, file in files.items()}


def list_imports(file, package):
    """Return the modules of *package* that a file imports."""
    names = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module == package:
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"{package}."):
            names.add(node.module.removeprefix(f"{package}.").partition(".")[0])
    return names


@pytest.mark.parametrize("folder", ["names", "checks", "interchange", "formatter", "text"])
def test_no_modules_of_a_package_import_each_other(folder):
    list(TopologicalSorter(read_imports(LANGUAGE / folder)).static_order())


def test_a_cycle_and_an_import_are_found():
    with pytest.raises(CycleError):
        list(TopologicalSorter({"a": {"b"}, "b": {"c"}, "c": {"a"}}).static_order())
    assert "queries" in read_imports(LANGUAGE / "names")["expression_results"]
