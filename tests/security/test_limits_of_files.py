"""Every file of a repository or a user is read with a limit on its size."""

import ast
import os
from pathlib import Path

import pytest

import sysmlc
from sysmlc.sources.source import DOCUMENT_LIMITS

ROOT = Path(sysmlc.__file__).parent
SHIPPED = {
    "backends/templates/files.py": "shipped templates",
    "diagnostics/rule.py": "shipped pages of rules",
    "frontends/caex/libraries.py": "shipped libraries",
    "language/text/lalr.py": "shipped tables",
    "support/resources.py": "shipped files",
}
OUTPUTS = {"driver/publishing.py", "support/atomic_files.py", "support/cache.py"}
"""Modules that read files of earlier runs."""
MODEL = """package P { part def Gate { attribute open : ScalarValues::Boolean; exhibit state s {
    entry; then a; state a; } } }"""


def list_unlimited_readers() -> set[str]:
    """Return the modules that call ``read_text`` or ``read_bytes`` of a path.

    Both read a file of any size. ``resources.read_text`` reads shipped files only.
    """
    readers = {"read_text", "read_bytes"}
    modules = set()
    for path in ROOT.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            is_read = isinstance(node, ast.Attribute) and node.attr in readers
            if is_read and ast.unparse(node.value) != "resources":
                modules.add(path.relative_to(ROOT).as_posix())
    return modules


def test_only_shipped_files_and_outputs_are_read_without_limit():
    assert list_unlimited_readers() <= SHIPPED.keys() | OUTPUTS


DOCUMENTS = {
    "sysmlc.toml": ("check", "plant.sysml"),
    "plant.overlay.yaml": ("check", "plant.sysml"),
    "run.yaml": ("simulate", "plant.sysml", "--scenario", "run.yaml"),
    "gate.contract.json": ("synth", "gate.contract.json", "--realizable"),
    "gate.tlsf": ("synth", "gate.tlsf", "--realizable"),
    "gate.spectra": ("contracts", "check", "gate.spectra"),
}


@pytest.mark.parametrize("name", DOCUMENTS)
def test_a_huge_document_is_refused(project, name):
    project.write("plant.sysml", MODEL)
    with (project.folder / name).open("wb") as file:
        file.truncate(DOCUMENT_LIMITS.file_size + 1)
    result = project.run(*DOCUMENTS[name])
    assert result.exit_code == 2
    assert f"larger than {DOCUMENT_LIMITS.file_size} bytes" in result.output


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
@pytest.mark.parametrize("name", [name for name in DOCUMENTS if name != "sysmlc.toml"])
def test_a_pipe_is_refused_without_waiting_for_it(project, name):
    project.write("plant.sysml", MODEL)
    os.mkfifo(project.folder / name)
    result = project.run(*DOCUMENTS[name])
    assert result.exit_code == 2
    assert "is not a regular file" in result.output
