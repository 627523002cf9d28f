"""Findings of the checks of recipe models, and functions that several checks use."""

from collections.abc import Callable, Iterator, Mapping

from msgspec import Struct, field

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.recipe.derive import Tables
from sysmlc.recipe.model import FlowGraph, Model, Parameter

Locate = Callable[[str], Subject]


class Finding(Struct, frozen=True):
    """A violation of a rule: the id of an element, and the facts for the message."""

    rule: Rule
    element: str
    facts: Mapping[str, object] = field(default_factory=dict)


Check = Callable[[Model, Tables], Iterator[Finding]]


def report_findings(findings: Iterator[Finding], sink: Sink, locate: Locate) -> None:
    """Report findings; *locate* turns ids of elements into subjects."""
    for finding in findings:
        sink.report(finding.rule, locate(finding.element), **finding.facts)  # type: ignore[arg-type]


def iter_graphs(model: Model) -> Iterator[FlowGraph]:
    """Iterate over the graphs of services and functions."""
    yield from model.service_graphs
    yield from model.function_graphs


def declared_parameters(graph: FlowGraph) -> dict[str, Parameter]:
    """Return the inputs, outputs and variables that expressions of a graph may name, by name."""
    parameters = (*graph.inputs, *graph.outputs, *graph.variables)
    return {parameter.name: parameter for parameter in parameters}
