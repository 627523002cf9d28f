"""Pass ``kept``: restores facts that UML cannot express from a comment of the back end ``uml``."""

from collections.abc import Iterable, Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.round_trip import PREFIX, Record, StoredElement, decode_record

UNREADABLE = rule(
    "SM189",
    "kept-comment",
    Severity.WARNING,
    "the comment that preserves facts which UML cannot express was changed: it is ignored",
    help="restore the comment, or remove it and save the plant again",
)


class Kept(Struct, frozen=True):
    """Restore the facts in the comment. Facts about elements that were deleted are ignored."""

    name: ClassVar[str] = "kept"
    after: ClassVar[tuple[str, ...]] = ("resolve",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Restore elements, attributes, names, owners and edges, and remove the comment."""
        for comment in graph.of_kind(Kind.COMMENT):
            body = comment.attrs.get("body")
            if isinstance(body, str) and body.startswith(PREFIX):
                try:
                    record = decode_record(body)
                except ValueError:
                    sink.report(UNREADABLE, graph.subject(comment))
                else:
                    graph.remove(comment)
                    _restore(graph, record)


def _restore(graph: Graph, record: Record) -> None:
    for element in _list_present(graph, record.made):
        graph.remove(element)
    _remove_profiles(graph, record.applied)
    _add_elements(graph, record.elements)
    for element in _list_present(graph, record.attributes):
        graph.set(element, **record.attributes[element.id])
    for element in _list_present(graph, record.names):
        graph.rename(element, record.names[element.id])
    _move_elements(graph, record.owners)
    _redirect_references(graph, record.elements)
    _connect_edges(graph, record.edges)


def _list_present(graph: Graph, ids: Iterable[str]) -> Iterator[Element]:
    """Yield the elements with these ids that are still in the graph."""
    return (element for id in ids if (element := graph.get(id)) is not None)


def _add_elements(graph: Graph, elements: list[StoredElement]) -> None:
    for stored in elements:
        if stored.id and stored.id not in graph and (stored.owner is None or stored.owner in graph):
            graph.add(Element(stored.id, stored.kind, stored.name, stored.owner))


def _move_elements(graph: Graph, owners: dict[str, str | None]) -> None:
    for id, owner in owners.items():
        element, new_owner = graph.get(id), graph.get(owner)
        if element is None or (owner is not None and new_owner is None):
            continue
        # An author may have moved the new owner into the element: no element may own itself.
        if new_owner is None or element not in (new_owner, *graph.ancestors(new_owner)):
            graph.move(element, new_owner)


def _redirect_references(graph: Graph, elements: list[StoredElement]) -> None:
    """Redirect references to external stubs to the restored elements that these stand for."""
    restored = {stored.id for stored in elements}
    external = [
        element for element in graph if "href" in element.attrs and element.id not in restored
    ]
    stubs = {str(element.attrs["href"]): element for element in external}
    for stored in elements:
        stub, replacement = stubs.get(stored.href or ""), graph.get(stored.id)
        if stub is None or replacement is None or stub.id not in graph:
            continue
        for edge in Edge:
            if edge is not Edge.OWNS:
                for source in graph.sources(stub, edge):
                    targets = [
                        replacement if element is stub else element
                        for element in graph.targets(source, edge)
                    ]
                    graph.replace_targets(edge, source, targets)
        if not graph.owned(stub):
            graph.remove(stub)


def _connect_edges(graph: Graph, edges: list[tuple[Edge, str, str]]) -> None:
    """Add the edges. The stored targets of an edge follow the other targets, in their order."""
    wanted: dict[tuple[Edge, str], list[Element]] = {}
    for edge, source, target in edges:
        if source in graph and target in graph and edge is not Edge.OWNS:
            wanted.setdefault((edge, source), []).append(graph[target])
    for (edge, source), targets in wanted.items():
        existing = graph.targets(graph[source], edge)
        unrelated = [element for element in existing if element not in targets]
        graph.replace_targets(edge, graph[source], [*unrelated, *targets])


def _remove_profiles(graph: Graph, packages: list[str]) -> None:
    """Remove the applications of profiles from packages, and external profiles without content."""
    profiles: dict[str, Element] = {}
    for package in _list_present(graph, packages):
        for profile in graph.targets(package, Edge.APPLIES):
            profiles[profile.id] = profile
            graph.disconnect(Edge.APPLIES, package, profile)
    for profile in profiles.values():
        for element in (profile, *graph.ancestors(profile)):
            if element.id in graph and not graph.owned(element) and element.attrs.get("external"):
                graph.remove(element)
