"""Small passes and back ends for the tests of the driver, and models in IR text."""

from dataclasses import dataclass
from typing import ClassVar

from sysmlc.diagnostics import Severity, rule
from sysmlc.driver import Compilation, Request, compile_model
from sysmlc.ir import Kind

UNNAMED_PORT = rule(
    "SM940",
    "test-unnamed-port",
    Severity.ERROR,
    "a port of '{owner}' has no name",
)
PLAIN_PORT = rule(
    "SM941",
    "test-plain-port",
    Severity.WARNING,
    "port '{port}' has no type",
)
PLANT = """\
Package pkg "Plant"
  Class gate "Gate"
    Port gate.in "in"
  Class robot "Robot"
    Port robot.out "out"
"""
FAULTY = PLANT.replace('gate.in "in"', "gate.in")
"""The gate's port has no name; the robot is right."""


@dataclass(frozen=True)
class Ports:
    """Reports ports without a name or without a type."""

    name: ClassVar[str] = "ports"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph, sink):
        for port in graph.of_kind(Kind.PORT):
            if not port.name:
                owner = graph.owner(port).name
                sink.report(UNNAMED_PORT, graph.subject(port), owner=owner)
            elif not port.attrs.get("typed"):
                sink.report(PLAIN_PORT, graph.subject(port), port=port.name)


@dataclass(frozen=True)
class Outlines:
    """One file a class, traced to the class and its ports."""

    name: str = "outline"
    summary: str = "ports of each class"
    is_default: bool = True

    def emit(self, graph, output, sink, options):
        for owner in graph.of_kind(Kind.CLASS):
            ports = graph.owned(owner)
            text = "".join(f"{port.name}\n" for port in ports)
            trace = [owner.id, *(port.id for port in ports)]
            output.add(f"outlines/{owner.name}.txt", text, trace, self.name)


def compiled(*files, passes=(Ports(),), backends=(Outlines(),), **given) -> Compilation:
    """Compile files with the fakes instead of the real passes and back ends."""
    return compile_model(Request(tuple(files), passes=passes, backends=backends, **given))
