"""A folder for each test, with the command line in it and one small pass instead of all."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import pytest
from click.testing import CliRunner

from sysmlc.analyses import analysis
from sysmlc.cli import group
from sysmlc.diagnostics import Severity, rule
from sysmlc.driver import registry
from sysmlc.ir import Kind

NAMELESS_PAGE = """\
# SM942 test-nameless-port

## Why

Connectors are drawn to names.

## Wrong

```ir
Class gate "Gate"
  Port gate.in
```

## Right

```ir
Class gate "Gate"
  Port gate.in "in"
```
"""
NAMELESS = rule(
    "SM942",
    "test-nameless-port",
    Severity.ERROR,
    "a port of '{owner}' has no name",
    help="name the port",
    page=NAMELESS_PAGE,
)
UNTYPED = rule("SM943", "test-untyped-port", Severity.WARNING, "port '{port}' has no type")
PLANT = """\
Package pkg "Plant"
  Class gate "Gate"
    Port gate.in "in"
      -> typed-by pallet
  Signal pallet "Pallet"
"""
LOAD_ALL_PASSES = registry.load_passes
HAS_RESULT = analysis.has_result


@dataclass(frozen=True)
class CheckPorts:
    """Report ports without a name (an error) or without a type (a warning)."""

    name: ClassVar[str] = "ports"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph, sink):
        for port in graph.of_kind(Kind.PORT):
            if not port.name:
                sink.report(NAMELESS, graph.subject(port), owner=graph.owner(port).name)
            elif graph.target(port, "typed-by") is None:
                sink.report(UNTYPED, graph.subject(port), port=port.name)


class Workspace:
    """A folder and the command line that runs in it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def write(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def read(self, name: str) -> str:
        return (self.folder / name).read_text()

    def list_files(self, name: str = "out") -> list[str]:
        """Return the files in the folder *name*, relative to it."""
        folder = self.folder / name
        paths = [path for path in folder.rglob("*") if path.is_file()]
        return sorted(path.relative_to(folder).as_posix() for path in paths)

    def list_inputs(self, folder: str = "out") -> list[str]:
        """Return the paths of the inputs in the manifest of an output folder."""
        manifest = json.loads(self.read(f"{folder}/manifest.json"))
        return [entry["path"] for entry in manifest["inputs"]]

    def sysmlc(self, *args: str, text: str = ""):
        """Run the command line with *text* as its input.

        Return the result of click: ``exit_code``, ``stdout`` and ``stderr``.
        """
        return CliRunner().invoke(group.sysmlc, list(args), input=text, catch_exceptions=False)


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    """A folder with ``plant.ir``, a model without errors. Commands run only the pass above."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(registry, "load_passes", lambda options, note: [CheckPorts()])
    monkeypatch.setattr(analysis, "has_result", lambda name, graph: False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    (tmp_path / ".git").mkdir()
    workspace = Workspace(tmp_path)
    workspace.write("plant.ir", PLANT)
    return workspace


@pytest.fixture
def all_passes(workspace, monkeypatch):
    """Let the commands in the workspace run all passes."""
    monkeypatch.setattr(registry, "load_passes", LOAD_ALL_PASSES)
    monkeypatch.setattr(analysis, "has_result", HAS_RESULT)
