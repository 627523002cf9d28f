"""Each layer of the compiler imports only lower layers; the imports are read from the code."""

import ast
from functools import cache
from pathlib import Path

import sysmlc

ROOT = Path(sysmlc.__file__).parent
LAYERS = [
    {"support"},
    {"documents", "sources"},
    {"diagnostics"},
    {"ir", "config"},
    {"logic", "overlay", "language"},
    {"controllers", "recipe"},
    {"synthesis", "simulation"},
    {"robots"},
    {"frontends", "passes"},
    {"analyses"},
    {"backends"},
    {"driver"},
    {"api"},
    {"cli"},
    {"__main__"},
]
"""Packages and modules of sysmlc. Those of one layer do not import one another."""

SUBLAYERS = {
    "logic": [
        # values
        {"formula", "contract", "regions", "inequalities", "identifiers", "domains", "evaluate"},
        # languages of formulas: texts to values and back
        {"syntax", "infix", "printing", "simplification", "classification", "violations", "cells"},
        {"expressions"},
        {
            "property_patterns",
            "structured_sentences",
            "sentences",
            "formal_texts",
            "basis",
            "quantities",
        },
        {"formats", "reduction", "region_formulas"},
        # behaviours
        {"feature_writes", "activities", "machines"},
        {"composition", "services"},
        {"components"},
        {"requirements"},
    ],
    "synthesis": [
        {"rules", "bdd"},
        {"games"},
        {"unrealizable", "algebra"},
        {"decision", "strategies"},
        {"lints"},
        {"certain_runs", "witnesses"},
        {"controller_synthesis", "counterstrategy"},
        {"composition_check", "requirement_verdicts"},
        {"contract_checks", "controller_files", "run_acceptance"},
    ],
}
"""Packages and modules of two packages; those of one layer may import one another."""


@cache
def list_imports(path: Path) -> set[str]:
    """Return the modules and names of sysmlc that a file imports, also inside functions."""
    modules: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            modules.update(f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Import):
            modules.update(alias.name for alias in node.names)
    return {module for module in modules if module.startswith("sysmlc")}


def list_entries(folder: Path) -> set[str]:
    """Return the packages and modules directly in a folder."""
    names = {path.stem for path in folder.glob("*.py")} - {"__init__"}
    return names | {path.parent.name for path in folder.glob("*/__init__.py")}


def list_upward_imports(package: str, layers: list[set[str]], *, within_layer: bool) -> list[str]:
    """Return the imports of the modules of a package that lead to a higher layer of it.

    Without *within_layer*, imports between packages of one layer are returned, too.
    """
    levels = {name: level for level, names in enumerate(layers) for name in names}
    folder = ROOT.joinpath(*package.split(".")[1:])
    wrong = []
    for path in sorted(folder.rglob("*.py")):
        importer = path.relative_to(folder).parts[0].removesuffix(".py")
        if importer == "__init__":  # the face of the package
            continue
        for module in sorted(list_imports(path)):
            imported = module.removeprefix(f"{package}.").partition(".")[0]
            if imported in levels.keys() - {importer} and module.startswith(f"{package}."):
                distance = levels[importer] - levels[imported]
                if distance < 0 or (distance == 0 and not within_layer):
                    wrong.append(f"{path.relative_to(ROOT)} imports {module}")
    return wrong


def test_every_package_has_a_layer_and_every_layer_exists():
    assert list_entries(ROOT) == set().union(*LAYERS)
    for package, layers in SUBLAYERS.items():
        assert list_entries(ROOT / package) == set().union(*layers)


def test_lower_layers_never_import_higher_ones():
    assert list_upward_imports("sysmlc", LAYERS, within_layer=False) == []


def test_layers_of_a_package_never_import_higher_ones():
    for package, layers in SUBLAYERS.items():
        assert list_upward_imports(f"sysmlc.{package}", layers, within_layer=True) == []


def test_front_ends_never_import_one_another():
    names = {p.name for p in (ROOT / "frontends").iterdir() if p.is_dir()} - {"__pycache__"}
    for name in names:
        foreign = tuple(f"sysmlc.frontends.{folder}" for folder in names - {name})
        for path in (ROOT / "frontends" / name).rglob("*.py"):
            assert not [module for module in list_imports(path) if module.startswith(foreign)], path


def test_a_forbidden_import_would_be_noticed():
    upside_down = list_upward_imports("sysmlc", LAYERS[::-1], within_layer=False)
    assert "ir/graph.py imports sysmlc.diagnostics.Place" in upside_down
    layers = SUBLAYERS["logic"][::-1]
    upside_down = list_upward_imports("sysmlc.logic", layers, within_layer=True)
    assert "logic/printing.py imports sysmlc.logic.formula.Apply" in upside_down
