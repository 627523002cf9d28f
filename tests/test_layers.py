"""Layers point down only (design, section 2); the imports are read from the code."""

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
ROOMS = ["bdd", "games", "unrealizable", "algebra", "controllers"]


def part(module: str) -> str:
    """First name below the package: ``sysmlc.ir.graph`` -> ``ir``."""
    return module.partition("sysmlc.")[2].partition(".")[0]


def imports(path: Path) -> set[str]:
    """Modules of sysmlc that a file imports, anywhere in it."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            found.update(names if node.module == "sysmlc" else [node.module])
        elif isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
    return {name for name in found if name.startswith("sysmlc")}


def test_every_part_has_a_layer():
    parts = {p.stem if p.is_file() else p.name for p in ROOT.iterdir()}
    parts -= {"__pycache__", "py", "__init__", "grammars", "metamodels", "templates"}
    assert parts <= LEVEL.keys()


def test_lower_layers_never_import_higher_ones():
    wrong = [
        f"{path.relative_to(ROOT)} imports {module}"
        for path in sorted(ROOT.rglob("*.py"))
        if path != ROOT / "__init__.py"  # the face of the Python API, imported when it is used
        for module in sorted(imports(path))
        if not allowed(
            part(f"sysmlc.{path.relative_to(ROOT).with_suffix('')}".replace("/", ".")), part(module)
        )
    ]
    assert wrong == []


def test_rooms_of_the_synthesis_import_only_rooms_below():
    wrong = [
        f"{path.relative_to(ROOT)} imports {module}"
        for level, room in enumerate(ROOMS)
        for path in sorted((ROOT / "synthesis" / room).glob("*.py"))
        for module in sorted(imports(path))
        if module.startswith("sysmlc.synthesis") and module.split(".")[2] not in ROOMS[: level + 1]
    ]
    assert wrong == []


def allowed(importer: str, imported: str) -> bool:
    """Whether one part may import the other."""
    if importer == imported or imported in {"", "__version__"}:
        return True
    if any({importer, imported} <= together for together in INDEPENDENT):
        return False
    return LEVEL.get(imported, 0) <= LEVEL.get(importer, 0)


def test_front_ends_never_import_one_another():
    names = {p.name for p in (ROOT / "frontends").iterdir() if p.is_dir()} - {"__pycache__"}
    for name in names:
        others = {f"sysmlc.frontends.{other}" for other in names - {name}}
        for path in (ROOT / "frontends" / name).rglob("*.py"):
            assert not {m for m in imports(path) if any(m.startswith(o) for o in others)}, path


def test_the_layer_test_itself_would_notice():
    assert not allowed("ir", "passes")
    assert not allowed("passes", "backends")
    assert allowed("passes", "ir")
