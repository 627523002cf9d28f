"""The command line in a folder of its own, with one small pass that always finds the same."""

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import pytest
from click.testing import CliRunner

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
FAULTY = PLANT.replace('gate.in "in"', "gate.in")


@dataclass(frozen=True)
class Ports:
    """Wants names and types of ports."""

    name: ClassVar[str] = "ports"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph, sink):
        for port in graph.of_kind(Kind.PORT):
            if not port.name:
                sink.report(NAMELESS, graph.subject(port), owner=graph.owner(port).name)
            elif graph.target(port, "typed-by") is None:
                sink.report(UNTYPED, graph.subject(port), port=port.name)


class Here:
    """A working folder and the command line in it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def write(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def read(self, name: str) -> str:
        return (self.folder / name).read_text()

    def files(self, name: str = "out") -> list[str]:
        folder = self.folder / name
        found = [path for path in folder.rglob("*") if path.is_file()]
        return sorted(path.relative_to(folder).as_posix() for path in found)

    def sysmlc(self, *args: str, text: str = ""):
        """Run the command line; ``exit_code``, ``stdout`` and ``stderr`` of what it did.

        ``text`` is what is typed.
        """
        return CliRunner().invoke(group.sysmlc, list(args), input=text, catch_exceptions=False)


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with a right model ``plant.ir``, in which the commands run."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(registry, "load_passes", lambda options: [Ports()])
    monkeypatch.delenv("NO_COLOR", raising=False)
    (tmp_path / ".git").mkdir()
    made = Here(tmp_path)
    made.write("plant.ir", PLANT)
    return made
