"""Each layer of the compiler imports only lower layers; the imports are read from the code."""

import ast
from pathlib import Path

import sysmlc

ROOT = Path(sysmlc.__file__).parent
LAYERS = [
    {"", "support"},
    {"sources"},
    {"diagnostics"},
    {"ir"},
    {"logic", "recipe", "overlay", "language"},
    {"synthesis", "simulation"},
    {"robots"},
    {"frontends", "passes", "backends"},
    {"driver", "config"},
    {"api"},
    {"lsp"},
    {"cli", "__main__"},
]
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
INDEPENDENT = [{"frontends", "passes", "backends"}]
SYNTHESIS_LAYERS = ["bdd", "games", "unrealizable", "algebra", "controllers"]


def name_layer(module: str) -> str:
    """Return the first name below the package: ``sysmlc.ir.graph`` -> ``ir``."""
    return module.partition("sysmlc.")[2].partition(".")[0]


def list_imports(path: Path) -> set[str]:
    """Return the modules of sysmlc that a file imports, at its top or inside a function."""
    modules: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            modules.update(names if node.module == "sysmlc" else [node.module])
        elif isinstance(node, ast.Import):
            modules.update(alias.name for alias in node.names)
    return {module for module in modules if module.startswith("sysmlc")}


def test_every_package_has_a_layer():
    names = {p.stem if p.is_file() else p.name for p in ROOT.iterdir()}
    names -= {"__pycache__", "py", "__init__", "grammars", "metamodels", "templates"}
    assert names <= LEVEL.keys()


def test_lower_layers_never_import_higher_ones():
    wrong = [
        f"{path.relative_to(ROOT)} imports {module}"
        for path in sorted(ROOT.rglob("*.py"))
        if path != ROOT / "__init__.py"  # the face of the Python API, imported when it is used
        for module in sorted(list_imports(path))
        if not may_import(
            name_layer(f"sysmlc.{path.relative_to(ROOT).with_suffix('')}".replace("/", ".")),
            name_layer(module),
        )
    ]
    assert wrong == []


def test_layers_of_the_synthesis_import_only_lower_layers():
    wrong = [
        f"{path.relative_to(ROOT)} imports {module}"
        for level, layer in enumerate(SYNTHESIS_LAYERS)
        for path in sorted((ROOT / "synthesis" / layer).glob("*.py"))
        for module in sorted(list_imports(path))
        if module.startswith("sysmlc.synthesis")
        and module.split(".")[2] not in SYNTHESIS_LAYERS[: level + 1]
    ]
    assert wrong == []


def may_import(importer: str, imported: str) -> bool:
    """Whether the layer *importer* may import the layer *imported*."""
    if importer == imported or imported in {"", "__version__"}:
        return True
    if any({importer, imported} <= layers for layers in INDEPENDENT):
        return False
    return LEVEL.get(imported, 0) <= LEVEL.get(importer, 0)


def test_front_ends_never_import_one_another():
    names = {p.name for p in (ROOT / "frontends").iterdir() if p.is_dir()} - {"__pycache__"}
    for name in names:
        foreign = tuple(f"sysmlc.frontends.{folder}" for folder in names - {name})
        for path in (ROOT / "frontends" / name).rglob("*.py"):
            assert not [module for module in list_imports(path) if module.startswith(foreign)], path


def test_a_forbidden_import_would_be_noticed():
    assert not may_import("ir", "passes")
    assert not may_import("passes", "backends")
    assert may_import("passes", "ir")
