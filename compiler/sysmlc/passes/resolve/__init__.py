"""Pass ``resolve``: turns references into edges to elements or external stubs."""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.passes.resolve.reports import SEVERAL_TARGETS, report_libraries, report_unresolved
from sysmlc.passes.resolve.resolver import (
    Resolver,
    UnitIndex,
    Use,
    group_uses,
    list_held_ids,
    use_of,
)


class Resolve(Struct, frozen=True):
    """Turn every reference into an edge.

    Assumes the output of a front end: elements, edges between them, and references in
    ``graph.pending``. Guarantees: nothing is pending; the ids in attributes exist; the target of
    every edge is an element, or an external stub (``external``, ``href``) if its file is not part
    of the unit. A reference to a missing element is reported, and the attribute ``unresolved`` of
    its holder names the relation, so that later passes do not report its consequences. The result
    does not depend on the order of the files.
    """

    name: ClassVar[str] = "resolve"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        """Resolve in place; see the class."""
        held_ids = [*list_held_ids(graph)]
        resolver = Resolver(graph, UnitIndex(graph))
        resolver.resolve(group_uses(graph, held_ids))
        unresolved = _connect_pending(graph, resolver)
        unresolved += [
            use for use in held_ids if resolver.get(use.holder.source, use.target) is None
        ]
        report_unresolved(graph, sink, unresolved)
        _keep_first_ends(graph, sink)
        _rewrite_attributes(graph, resolver, held_ids)
        missing = {
            href: uses
            for href, uses in resolver.external.items()
            if href not in resolver.library_elements
        }
        report_libraries(graph, sink, missing)
        graph.pending.clear()


def _connect_pending(graph: Graph, resolver: Resolver) -> list[Use]:
    """Turn the pending references into edges. Return the references without a target, in order."""
    unresolved: list[Use] = []
    for reference in graph.pending:
        source = graph.get(reference.source)
        if source is None:
            continue
        target = graph.get(reference.target) or resolver.get(source.source, reference.target)
        if target is None:
            unresolved.append(use_of(source, reference))
        else:
            graph.connect(reference.edge, source, target)
    return unresolved


def _rewrite_attributes(graph: Graph, resolver: Resolver, held_ids: list[Use]) -> None:
    """Replace the ids in attributes by the ids of the resolved elements."""
    for holder, name in dict.fromkeys((use.holder, use.attribute) for use in held_ids):
        graph.set(holder, **{name: _resolve_value(resolver, holder, holder.attrs[name])})


def _resolve_value(resolver: Resolver, holder: Element, value: AttrValue) -> AttrValue:
    if isinstance(value, str):
        element = resolver.get(holder.source, value)
        return element.id if element else None
    if isinstance(value, tuple):
        items = (_resolve_value(resolver, holder, item) for item in value)
        return tuple(item for item in items if item is not None)
    return value


def _keep_first_ends(graph: Graph, sink: Sink) -> None:
    """Reduce each control flow, object flow and transition to one source and one target.

    Reports the flows for which a file gives several.
    """
    for flow in graph.of_kind(Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION):
        for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
            ends = graph.targets(flow, edge)
            if len(ends) > 1:
                graph.replace_targets(edge, flow, ends[:1])
                sink.report(
                    SEVERAL_TARGETS,
                    graph.subject(flow),
                    relation=edge.value,
                    element=graph.qualified_name(flow),
                    count=len(ends),
                )
