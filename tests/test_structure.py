"""The structure of the code: function names, sizes of modules, import cycles, nested imports."""

import ast
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

import networkx
import pytest

import sysmlc

sys.path.append(str(Path(__file__).parents[1] / "docs"))
import count_module_changes
import draw_packages

ROOT = Path(sysmlc.__file__).parent
PATHS = sorted(ROOT.rglob("*.py"))
LONG = 600
"""Lines of a module: a longer one probably has a second subject."""
LONG_MODULES: dict[str, str] = {}
"""Modules with more lines, and why they have one subject."""
MAX_FIELDS = 12
"""Fields of an object that modules pass to one another."""
MODULE_CHANGES = {"guard": 102, "requirement": 100, "recipe": 70}
"""Calls that hand a value to another module, from the file to the result; they may only shrink."""
WIDE_OBJECTS = {
    # The columns of a file, and the nodes of a tree: each field is a fact about the same thing.
    "sysmlc.backends.sysml.plan.Member": 13,
    "sysmlc.frontends.caex.component.Component": 15,
    "sysmlc.frontends.caex.document.Document": 15,
    "sysmlc.frontends.xmi.document.Document": 18,
    "sysmlc.language.tree.Node": 13,
    # State that functions share.
    "sysmlc.backends.aml.context.Context": 13,
    "sysmlc.backends.sysml.writer.Writer": 14,
    "sysmlc.language.names.model.Model": 16,
    "sysmlc.logic.components.component.Component": 17,
    "sysmlc.logic.components.performances.Performances": 17,
    "sysmlc.robots.world.World": 14,
    "sysmlc.synthesis.bdd.manager.Manager": 18,
}
"""Fields of the objects that have more, frozen values aside. The numbers only fall."""

PARTICLES = set(
    """told said made kept found known given done seen held left meant written taken drawn shown
    spoken put apart together of beside between within among below above again whole others own
    """.split()  # noqa: SIM905 - a list of words
)
CLEAR_NAMES = {"derived", "inherited", "listed", "owned", "passed", "put", "shown"}
"""Properties, and names of the public API (``Graph.owned``) that read as nouns."""
VERBS_IN_ED = {"need", "feed", "embed", "seed", "speed", "exceed", "proceed", "succeed", "shed"}

SLOW_TO_IMPORT = {
    "dd",
    "jinja2",
    "jsonschema",
    "lark",
    "networkx",
    "pyecore",
    "ruamel",
    "watchfiles",
}
"""Third-party packages that may be imported inside a function: each takes over 20 ms."""

CYCLES = [
    [f"sysmlc.logic.components.{name}" for name in ("component", "names", "signals")],
]
"""Modules whose functions take an object whose class imports them, for the type checker only."""

REGISTRIES = {"sysmlc", "sysmlc.driver.registry", "sysmlc.ir", "sysmlc.frontends.ir"}
"""Modules that load front ends, passes, back ends or a reader when they are used."""

PLATFORM_MODULES = {"fcntl", "resource"}
"""Modules of the standard library that exist on POSIX systems only."""


def name_module(path: Path) -> str:
    """Return the dotted name of a module of sysmlc."""
    parts = path.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


TREES = {name_module(path): ast.parse(path.read_text(encoding="utf-8")) for path in PATHS}


def iter_imports(module: str, node: ast.AST) -> Iterator[str]:
    """Yield the modules, or names of modules, that an import statement names."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        for alias in node.names:
            name = f"{node.module}.{alias.name}"
            yield name if name in TREES else str(node.module)


def is_type_checking(node: ast.AST) -> bool:
    """Whether a statement is ``if TYPE_CHECKING:``."""
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)


def iter_runtime_nodes(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes below *node* that exist when the program runs."""
    for child in ast.iter_child_nodes(node):
        if not is_type_checking(child):
            yield child
            yield from iter_runtime_nodes(child)


def list_imports(module: str) -> set[str]:
    """Return what a module imports when it runs, at its top or inside a function."""
    return {
        name for node in iter_runtime_nodes(TREES[module]) for name in iter_imports(module, node)
    }


def is_lazy_by_design(module: str) -> bool:
    """Whether a module may import modules of sysmlc inside functions."""
    is_command = module.startswith("sysmlc.cli") or module == "sysmlc.__main__"
    # A front end detects files without its reader, which is imported for the first file.
    is_front_end = module.rpartition(".")[0] == "sysmlc.frontends"
    return is_command or module in REGISTRIES or is_front_end


def is_participle(name: str) -> bool:
    """Whether a function name is a past participle or a particle (``joined``, ``beside``)."""
    core = name.strip("_")
    return core not in VERBS_IN_ED | CLEAR_NAMES and (
        core in PARTICLES or bool(re.fullmatch(r"[a-z]{3,}ed", core))
    )


def test_no_function_is_named_by_a_participle_or_a_particle():
    names = [
        f"{module}.{node.name}"
        for module, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and is_participle(node.name)
    ]
    assert names == []


def test_modules_have_at_most_600_lines_or_a_reason():
    lengths = {name_module(path): path.read_text(encoding="utf-8").count("\n") for path in PATHS}
    assert {module for module, length in lengths.items() if length > LONG} == LONG_MODULES.keys()


def list_fields(node: ast.ClassDef) -> set[str]:
    """Return the fields that a class declares or that its constructor assigns to ``self``."""
    fields = {
        item.target.id
        for item in node.body
        if isinstance(item, ast.AnnAssign)
        and isinstance(item.target, ast.Name)
        and "ClassVar" not in ast.dump(item.annotation)
    }
    constructors = [
        item
        for item in node.body
        if isinstance(item, ast.FunctionDef) and item.name in ("__init__", "__post_init__")
    ]
    return fields | {
        child.attr
        for constructor in constructors
        for child in ast.walk(constructor)
        if isinstance(child, ast.Attribute)
        and isinstance(child.ctx, ast.Store)
        and isinstance(child.value, ast.Name)
        and child.value.id == "self"
    }


def is_frozen_value(node: ast.ClassDef) -> bool:
    """Whether a class is a frozen value without private fields: it has as many as its subject."""
    declarations = [*node.keywords, *node.decorator_list]
    is_frozen = any("frozen=True" in ast.unparse(declaration) for declaration in declarations)
    return is_frozen and not any(name.startswith("_") for name in list_fields(node))


def list_parameter_types(module: str) -> set[str]:
    """Return the names in the annotations of the parameters of all functions of a module."""
    arguments = [node for node in ast.walk(TREES[module]) if isinstance(node, ast.arg)]
    annotations = [ast.unparse(node.annotation) for node in arguments if node.annotation]
    return {name for text in annotations for name in re.findall(r"\w+", text)}


def test_objects_that_modules_pass_around_are_small():
    importers: dict[str, set[str]] = {}
    for module, tree in TREES.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                for alias in node.names:
                    importers.setdefault(alias.name, set()).add(module)
    parameter_types = {module: list_parameter_types(module) for module in TREES}
    widths = {
        f"{module}.{node.name}": len(list_fields(node))
        for module, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
        and not is_frozen_value(node)
        and any(
            node.name in parameter_types[importer]
            for importer in importers.get(node.name, set()) - {module}
        )
    }
    assert {name: width for name, width in widths.items() if width > MAX_FIELDS} == WIDE_OBJECTS


def find_cycles(edges: Iterable[tuple[str, str]]) -> list[list[str]]:
    """Return the modules or packages that import one another, sorted."""
    parts = networkx.strongly_connected_components(networkx.DiGraph(edges))
    return sorted(sorted(part) for part in parts if len(part) > 1)


def iter_import_pairs() -> Iterator[tuple[str, str]]:
    """Yield each module with each module that it imports, also for the type checker.

    Imports inside functions count too: they only hide a cycle. Registries load by name.
    """
    for module, tree in TREES.items():
        if not is_lazy_by_design(module):
            names = {name for node in ast.walk(tree) for name in iter_imports(module, node)}
            yield from ((module, name) for name in names if name in TREES)


IMPORT_PAIRS = sorted(iter_import_pairs())


def test_no_modules_import_one_another():
    """An import of a module also runs the faces of its packages."""
    edges = [
        (module, imported)
        for module, name in IMPORT_PAIRS
        for imported in (name, *list_packages(name))
        if imported not in (module, *list_packages(module))
    ]
    assert find_cycles(edges) == CYCLES


def list_packages(module: str) -> list[str]:
    """Return the packages below sysmlc that contain a module."""
    parts = module.split(".")
    return [".".join(parts[:length]) for length in range(2, len(parts))]


def test_no_packages_import_one_another():
    """The parts of one package, which may be packages, do not import one another."""
    pairs = [find_siblings(module, name) for module, name in IMPORT_PAIRS]
    assert find_cycles(pair for pair in pairs if pair) == CYCLES


def find_siblings(module: str, imported: str) -> tuple[str, str] | None:
    """Return the parts, of the package that contains both modules, to which they belong."""
    importer_parts, imported_parts = module.split("."), imported.split(".")
    for length, (left, right) in enumerate(zip(importer_parts, imported_parts, strict=False), 1):
        if left != right:
            return ".".join(importer_parts[:length]), ".".join(imported_parts[:length])
    return None


def list_misplaced_imports(module: str) -> set[str]:
    """Return the imports inside functions of a module that could stand at its top."""
    nested = {
        name
        for function in iter_runtime_nodes(TREES[module])
        if isinstance(function, ast.FunctionDef)
        for node in iter_runtime_nodes(function)
        for name in iter_imports(module, node)
    }
    internal = {name for name in nested if name.startswith("sysmlc")}
    external = {name.partition(".")[0] for name in nested - internal}
    return internal | (external - SLOW_TO_IMPORT - PLATFORM_MODULES)


def test_imports_stand_at_the_top():
    modules = [module for module in TREES if not is_lazy_by_design(module)]
    misplaced = {module: names for module in modules if (names := list_misplaced_imports(module))}
    assert misplaced == {}


def test_participles_are_told_from_verbs():
    assert is_participle("_joined")
    assert is_participle("beside")
    assert not is_participle("embed")
    assert not is_participle("find_needed")


@pytest.mark.parametrize(("value", "bound"), MODULE_CHANGES.items())
def test_a_reader_who_follows_a_value_seldom_changes_the_module(value: str, bound: int):
    changes = count_module_changes.list_changes(count_module_changes.WALKS[value])
    assert len(changes) <= bound
    assert len(changes) > 50, "the walk ends before the result"


def test_the_architecture_page_shows_the_packages_and_modules_that_exist():
    page = draw_packages.PAGE.read_text(encoding="utf-8")
    drawing = draw_packages.draw(draw_packages.read_package_imports())
    assert draw_packages.insert(page, drawing) == page, "run python docs/draw_packages.py"
    names = re.findall(r"`([\w/]+\.py)`", page.split("## How a port")[1])
    paths = {path.relative_to(ROOT).as_posix() for path in PATHS}
    missing = [
        name
        for name in names
        if not any(path == name or path.endswith(f"/{name}") for path in paths)
    ]
    assert names
    assert missing == []


def test_the_pages_name_modules_that_exist():
    root = ROOT.parents[1]
    folders = ("compiler", "tests", "benchmarks", "docs")
    modules = {path.as_posix() for folder in folders for path in (root / folder).rglob("*.py")}
    # A repository may contain a module that is named like the package (untrusted-repositories.md).
    example_names = {"sysmlc.py"}
    missing = {
        (page.name, name)
        for page in (root / "docs").rglob("*.md")
        for name in re.findall(r"`([\w/]+\.py)`", page.read_text(encoding="utf-8"))
        if name not in example_names and not any(path.endswith(f"/{name}") for path in modules)
    }
    assert missing == set()


def list_names_in_scope(node: ast.FunctionDef | ast.ClassDef) -> set[str]:
    """Return the parameters of a function, or the fields and parameters of a class."""
    if isinstance(node, ast.ClassDef):
        constructors = [item for item in node.body if isinstance(item, ast.FunctionDef)]
        fields = {
            item.target.id
            for item in node.body
            if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
        }
        return fields.union(
            *(list_names_in_scope(item) for item in constructors if item.name == "__init__")
        )
    arguments = node.args
    optional = [argument for argument in (arguments.vararg, arguments.kwarg) if argument]
    named = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    return {argument.arg for argument in (*named, *optional)}


def iter_unknown_parameters(node: ast.AST, parameters: set[str]) -> Iterator[str]:
    """Yield the names in ``*asterisks*`` in docstrings that are no parameters in scope."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.FunctionDef | ast.ClassDef):
            yield from iter_unknown_parameters(child, parameters)
            continue
        in_scope = parameters | list_names_in_scope(child)
        if isinstance(child, ast.FunctionDef):
            named = re.findall(r"(?<!\*)\*([a-z_]+)\*(?!\*)", ast.get_docstring(child) or "")
            yield from (f"{child.name}: *{name}*" for name in named if name not in in_scope)
        yield from iter_unknown_parameters(child, in_scope)


def test_docstrings_name_parameters_that_exist():
    unknown = {
        module: names
        for module, tree in TREES.items()
        if (names := [*iter_unknown_parameters(tree, set())])
    }
    assert unknown == {}
