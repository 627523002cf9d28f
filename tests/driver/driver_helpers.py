"""A small pass, a small back end and small models in IR text for the tests of the driver."""

from dataclasses import dataclass
from typing import ClassVar

from click.testing import CliRunner

from sysmlc.cli import group
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
"""The port of the gate has no name; the robot has no errors."""


@dataclass(frozen=True)
class CheckPorts:
    """Report ports without a name (an error) or without a type (a warning)."""

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
class OutlineBackend:
    """Write one file for each class, traced to the class and its ports."""

    name: str = "outline"
    summary: str = "ports of each class"
    is_default: bool = True

    def emit(self, graph, output, sink, options):
        for owner in graph.of_kind(Kind.CLASS):
            ports = graph.owned(owner)
            text = "".join(f"{port.name}\n" for port in ports)
            trace = [owner.id, *(port.id for port in ports)]
            output.add(f"outlines/{owner.name}.txt", text, trace, self.name)


def compile_files(
    *files, passes=(CheckPorts(),), backends=(OutlineBackend(),), **options
) -> Compilation:
    """Compile files with the pass and the back end of this module, or with those that are given."""
    return compile_model(Request(tuple(files), passes=passes, backends=backends, **options))


def run_sysmlc(*arguments: object) -> tuple[int, str, str]:
    """Run the command line; return exit code, standard output and diagnostics."""
    result = CliRunner().invoke(group.sysmlc, [str(argument) for argument in arguments])
    return result.exit_code, result.stdout, result.stderr


def list_inputs(compilation: Compilation) -> list[str]:
    """Return the paths of the files that a compilation has read."""
    return [file.path for file in compilation.inputs]


def list_codes(compilation: Compilation) -> list[str]:
    """Return the codes of the rules that a compilation reports, in order."""
    return [diagnostic.rule.code for diagnostic in compilation.diagnostics]


def list_published(compilation: Compilation) -> list[str]:
    """Return the paths of the outputs that are not withheld."""
    return [artefact.path for artefact in compilation.list_published()]
