"""What the checks of recipe models share: findings, and how they are told."""

from collections.abc import Callable, Iterator, Mapping

from msgspec import Struct, field

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.recipe.derive import Tables
from sysmlc.recipe.model import FlowGraph, Model, Parameter

Locate = Callable[[str], Subject]


class Finding(Struct, frozen=True):
    """A rule that is broken: element of the graph, facts for the phrase."""

    rule: Rule
    element: str
    facts: Mapping[str, object] = field(default_factory=dict)


Check = Callable[[Model, Tables], Iterator[Finding]]


def tell(found: Iterator[Finding], sink: Sink, locate: Locate) -> None:
    """Report findings."""
    for one in found:
        sink.report(one.rule, locate(one.element), **one.facts)  # type: ignore[arg-type]


def graphs(model: Model) -> Iterator[FlowGraph]:
    """All graphs of a model."""
    yield from model.service_graphs
    yield from model.function_graphs


def declared(graph: FlowGraph) -> dict[str, Parameter]:
    """Everything that expressions of a graph may name."""
    return {one.name: one for one in (*graph.inputs, *graph.outputs, *graph.variables)}
