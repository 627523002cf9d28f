"""Draw random mutants of the code, and count those that the tests notice: ``make mutants``.

A mutant is the code with one small change. It is tested in a copy of the project, with the tests
that import its module, those of its package and those of commands, until the first failure. For a
mutant that no test notices, write the test that fails, unless the mutant means the same.
"""

import argparse
import ast
import os
import queue
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from operator import setitem
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = Path("compiler", "sysmlc")
SECONDS = 900
"""Time after which a mutant counts as noticed: it probably does not terminate."""
WITH_COMMANDS = ("tests/cli", "tests/examples")
"""Folders of tests that run all packages."""
FOLDERS = {
    "analyses": "passes",
    "api": "driver",
    "controllers": "synthesis",
    "diagnostics": "basics",
    "support": "basics",
}
"""Folders of tests of packages that have another name; modules beside packages have ``driver``."""
PAIRS = (
    *((ast.Eq, ast.NotEq), (ast.Is, ast.IsNot), (ast.In, ast.NotIn)),
    *((ast.Lt, ast.LtE), (ast.Gt, ast.GtE)),
)
OPPOSITES = {operator: other for pair in PAIRS for operator, other in (pair, pair[::-1])}
NOT_MUTATED = frozenset({"annotation", "returns", "decorator_list", "keywords", "bases"})
"""Fields of functions and classes that have no meaning at run time, or are options of classes."""


class Mutation(NamedTuple):
    """A change of a syntax tree, in words, and the calls that make it."""

    line: int
    text: str
    calls: Sequence[Callable[[], object]]


class Mutant(NamedTuple):
    """A mutated module: its path in the project, what was changed where, and its text."""

    path: Path
    place: str
    text: str


def iter_mutations(node: ast.AST) -> Iterator[Mutation]:
    """Yield the mutations of a tree in the order of the text."""
    for field, value in ast.iter_fields(node):
        if field in NOT_MUTATED and not isinstance(node, ast.Call):
            continue
        for index, child in enumerate(value if isinstance(value, list) else [value]):
            if isinstance(child, ast.AST):
                yield from _iter_replacements(node, field, index, child)
                yield from iter_mutations(child)
    if isinstance(node, ast.Dict):
        for index, (key, value) in enumerate(zip(node.keys, node.values, strict=True)):
            text = f"without the entry {'**' if key is None else _print(key)}"
            pops = (partial(node.keys.pop, index), partial(node.values.pop, index))
            yield Mutation(value.lineno, text, pops)


def _iter_replacements(
    parent: ast.AST, field: str, index: int, node: ast.AST
) -> Iterator[Mutation]:
    """Yield the mutations that replace *node* in a field of its parent by another node."""
    value = getattr(parent, field)
    is_list = isinstance(value, list)
    replace = partial(setitem, value, index) if is_list else partial(setattr, parent, field)
    for substitute in _iter_substitutes(node):
        text = f"{_print(node)}  ->  {_print(substitute)}"
        yield Mutation(getattr(node, "lineno", 0), text, [partial(replace, substitute)])


def _iter_substitutes(node: ast.AST) -> Iterator[ast.AST]:
    match node:
        case ast.Compare(ops=[operator, *_]):
            operators = [OPPOSITES[type(operator)](), *node.ops[1:]]
            yield ast.Compare(node.left, operators, node.comparators)
        case ast.BoolOp():
            yield ast.BoolOp(ast.And() if isinstance(node.op, ast.Or) else ast.Or(), node.values)
        case ast.UnaryOp(op=ast.Not()):
            yield node.operand
        case ast.Constant(value=int(value)):
            yield ast.Constant(not value if isinstance(value, bool) else value + 1)
        case ast.Return(value=ast.expr() as value) if not isinstance(value, ast.Constant):
            yield ast.Return(ast.Constant(None))
        case ast.Expr(value=ast.Call()) | ast.AugAssign():
            yield ast.Pass()
        case ast.If() | ast.IfExp():
            yield type(node)(ast.UnaryOp(ast.Not(), node.test), node.body, node.orelse)
        case ast.Slice(lower=ast.expr()):
            yield ast.Slice(None, node.upper, node.step)


def _print(node: ast.AST) -> str:
    """Return the first line of the text of a node."""
    return ast.unparse(ast.fix_missing_locations(node)).split("\n")[0]


def draw_mutants(count: int, seed: int) -> list[Mutant]:
    """Return mutants of random modules; a module of twice the size is drawn twice as often."""
    dice, mutants = random.Random(seed), list[Mutant]()
    texts = {path: path.read_text("utf-8") for path in sorted((ROOT / PACKAGE).rglob("*.py"))}
    while len(mutants) < count:
        (path,) = dice.choices(list(texts), [len(text) for text in texts.values()])
        tree = ast.parse(texts[path])
        mutations = list(iter_mutations(tree))
        if mutations:
            mutation = dice.choice(mutations)
            for call in mutation.calls:
                call()
            module = path.relative_to(ROOT)
            place = f"{module.as_posix()}:{mutation.line}: {mutation.text}"
            mutants.append(Mutant(module, place, ast.unparse(ast.fix_missing_locations(tree))))
    return mutants


def list_tests(module: Path) -> list[str]:
    """Return the files that import a module, and the folders of its package and of commands."""
    parts = module.relative_to(PACKAGE).with_suffix("").parts
    name = ".".join(("sysmlc", *parts)).removesuffix(".__init__")
    package, _, last = name.rpartition(".")
    imports = (f"from {name} import", f"import {name}", f"from {package} import {last}")
    files = [
        path.relative_to(ROOT).as_posix()
        for path in sorted((ROOT / "tests").rglob("test_*.py"))
        if any(text in path.read_text("utf-8") for text in imports)
    ]
    folder = Path("tests", FOLDERS.get(parts[0], parts[0]) if len(parts) > 1 else "driver")
    if len(parts) > 2 and (ROOT / folder / parts[1]).is_dir():
        folder /= parts[1]
    return list(dict.fromkeys([*files, folder.as_posix(), *WITH_COMMANDS]))


def try_mutant(mutant: Mutant, copies: "queue.Queue[Path]") -> str:
    """Return the first test that a mutant fails, or an empty text."""
    project = copies.get()
    file = project / mutant.path
    original = file.read_text("utf-8")
    try:
        file.write_text(mutant.text, "utf-8")
        failure = _find_failure(project, list_tests(mutant.path))
        file.write_text(original, "utf-8")
        if "::" in failure and _find_failure(project, [failure]):
            raise RuntimeError(f"the tests must succeed without mutants: {failure}")
    finally:
        copies.put(project)
    return failure


def _find_failure(project: Path, tests: list[str]) -> str:
    """Return the first of the tests that fails, another reason to fail, or an empty text."""
    options = ("-x", "-q", "-p", "no:cacheprovider", "-m", "not long and not slow")
    command = [sys.executable, "-m", "pytest", *options, *tests]
    environment = os.environ | {"PYTHONPATH": str(project / "compiler"), "CI": "true"}
    try:
        run = subprocess.run(
            command, cwd=project, env=environment, capture_output=True, text=True, timeout=SECONDS
        )
    except subprocess.TimeoutExpired:
        return f"not ended after {SECONDS} seconds"
    if run.returncode == pytest.ExitCode.USAGE_ERROR:
        raise RuntimeError(f"pytest cannot run {' '.join(tests)}: {run.stderr}")
    failed = re.search(r"^(?:FAILED|ERROR) (.*?)(?: - .*)?$", run.stdout, re.MULTILINE)
    return failed[1] if failed else f"exit code {run.returncode}" if run.returncode else ""


def main() -> None:
    """Test the mutants of a seed, two at a time, and print what notices them, and the score."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=random.randrange(1_000_000))
    options = parser.parse_args()
    print(f"{options.count} mutants of seed {options.seed}", flush=True)
    mutants, noticed = draw_mutants(options.count, options.seed), 0
    copies: queue.Queue[Path] = queue.Queue()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        for name in "ab":
            ignored = shutil.ignore_patterns(".venv*", ".git", ".demo", ".*_cache", "__pycache__")
            copies.put(Path(shutil.copytree(ROOT, Path(folder, name), ignore=ignored)))
        failures = pool.map(lambda mutant: try_mutant(mutant, copies), mutants)
        for mutant, failure in zip(mutants, failures, strict=True):
            noticed += bool(failure)
            print(f"{mutant.place}  ({failure or 'NOT NOTICED'})", flush=True)
    print(f"noticed: {noticed} of {options.count}")


if __name__ == "__main__":
    main()
