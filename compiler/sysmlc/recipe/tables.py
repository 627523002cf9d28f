"""What the checks of recipe models get and return: the parts of a model by id, and findings."""

from collections.abc import Callable, Iterator, Mapping

from msgspec import Struct, field

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.recipe.model import FlowGraph, Function, Model, Node, Range, Service


class Tables(Struct, frozen=True):
    """The services, functions and graphs of a model by id, and memoised durations."""

    services: Mapping[str, Service]
    functions: Mapping[str, Function]
    service_graphs: Mapping[str, FlowGraph]
    function_graphs: Mapping[str, FlowGraph]
    open_graphs: frozenset[str] = frozenset()
    """Function graphs whose calls are being followed."""
    _times: dict[tuple[str, ...], Range | None] = field(default_factory=dict)

    @classmethod
    def from_model(cls, model: Model) -> "Tables":
        """Build the tables of *model*."""
        return cls(
            {service.id: service for service in model.services},
            {function.id: function for function in model.functions},
            {graph.id: graph for graph in model.service_graphs},
            {graph.id: graph for graph in model.function_graphs},
        )

    def find_service(self, node: Node) -> Service | None:
        """Return the service that a node calls, or None."""
        return self.services.get(node.ref) if node.kind == "service" else None

    def memoise_duration(
        self, key: tuple[str, ...], compute: Callable[[], Range | None]
    ) -> Range | None:
        """Return the duration stored under *key*, which the first call computes and stores."""
        if key not in self._times:
            self._times[key] = compute()
        return self._times[key]

    def without_graph(self, id: str) -> "Tables":
        """Return the tables without one function graph, so that calls of it are not followed."""
        rest = {key: graph for key, graph in self.function_graphs.items() if key != id}
        opened = self.open_graphs | {id}
        return Tables(self.services, self.functions, self.service_graphs, rest, opened)


# -- findings --------------------------------------------------------------------------------------

Locate = Callable[[str], Subject]
"""Returns the element with an id as the subject of a diagnostic."""


class Finding(Struct, frozen=True):
    """A violation of a rule: the id of an element, and the facts for the message."""

    rule: Rule
    element: str
    facts: Mapping[str, object] = field(default_factory=dict)


Check = Callable[[Model, Tables], Iterator[Finding]]
"""Yields the violations of one or more rules by a model, whose tables are given, too."""


def report_findings(findings: Iterator[Finding], sink: Sink, locate: Locate) -> None:
    """Report each finding at its element, which *locate* finds."""
    for finding in findings:
        sink.report(finding.rule, locate(finding.element), **finding.facts)  # type: ignore[arg-type]
