"""What is told of the ports of AutomationML: once a file, for the language leaves much open."""

from collections.abc import Iterable

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind

_LISTED = 8

UNDIRECTED = rule(
    "SM121",
    "undirected-plant-ports",
    Severity.INFO,
    "{count} of {all} ports of '{file}' have no direction: {ports}",
    help="give the interfaces an attribute Direction, or say in an overlay what flows",
)
UNTYPED = rule(
    "SM122",
    "untyped-plant-ports",
    Severity.WARNING,
    "{count} of {all} ports of '{file}' have no type: {ports}",
    help="let the interfaces refer to interface classes",
)


def files(graph: Graph) -> frozenset[str]:
    """The files of AutomationML in the unit."""
    documents = graph.of_kind(Kind.DOCUMENT)
    return frozenset(one.source for one in documents if one.subkind == "caex")


def undirected(graph: Graph, ports: Iterable[Element]) -> list[Element]:
    """Ports without direction in files where others have one; in most files none has.

    What leads to a document, as a drawing of the element, has none.
    """
    flowing = [port for port in ports if not _leads_to_document(graph, port)]
    telling = {port.source for port in flowing if "direction" in port.attrs}
    return [p for p in flowing if p.source in telling and "direction" not in p.attrs]


def _leads_to_document(graph: Graph, port: Element) -> bool:
    about = graph.sources(port, Edge.REFERENCES)
    return any(one.kind is Kind.DOCUMENT for one in about)


def report(
    graph: Graph, sink: Sink, about: Rule, found: Iterable[Element], ports: Iterable[Element]
) -> None:
    """Report a rule about some of all ports, once for each file, at the first of them."""
    every: dict[str, int] = {}
    for port in ports:
        every[port.source] = every.get(port.source, 0) + 1
    by_file: dict[str, list[Element]] = {}
    for port in found:
        by_file.setdefault(port.source, []).append(port)
    for file, some in by_file.items():
        names = [f"'{graph.qualified_name(port)}'" for port in some[:_LISTED]]
        more = f" and {len(some) - _LISTED} more" if len(some) > _LISTED else ""
        sink.report(
            about,
            graph.subject(some[0]),
            count=len(some),
            all=every[file],
            file=file,
            ports=", ".join(names) + more,
        )
