"""Diagnostics on ports of AutomationML, one per file: the language leaves much open."""

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


def find_plant_files(graph: Graph) -> frozenset[str]:
    """Return the AutomationML files of the unit."""
    documents = graph.of_kind(Kind.DOCUMENT)
    return frozenset(document.source for document in documents if document.subkind == "caex")


def find_undirected(graph: Graph, ports: Iterable[Element]) -> list[Element]:
    """Return the ports without direction in files where other ports have one; in most files none
    has.

    A port that leads to a document, such as a drawing of the element, has no direction.
    """
    flow_ports = [port for port in ports if not _leads_to_document(graph, port)]
    files_with_directions = {port.source for port in flow_ports if "direction" in port.attrs}
    return [
        p for p in flow_ports if p.source in files_with_directions and "direction" not in p.attrs
    ]


def _leads_to_document(graph: Graph, port: Element) -> bool:
    referring = graph.sources(port, Edge.REFERENCES)
    return any(element.kind is Kind.DOCUMENT for element in referring)


def report_by_file(
    graph: Graph, sink: Sink, rule: Rule, faulty: Iterable[Element], ports: Iterable[Element]
) -> None:
    """Report the *faulty* among all *ports* once for each file, at the first of them."""
    totals: dict[str, int] = {}
    for port in ports:
        totals[port.source] = totals.get(port.source, 0) + 1
    by_file: dict[str, list[Element]] = {}
    for port in faulty:
        by_file.setdefault(port.source, []).append(port)
    for file, reported in by_file.items():
        names = [f"'{graph.qualified_name(port)}'" for port in reported[:_LISTED]]
        more = f" and {len(reported) - _LISTED} more" if len(reported) > _LISTED else ""
        sink.report(
            rule,
            graph.subject(reported[0]),
            count=len(reported),
            all=totals[file],
            file=file,
            ports=", ".join(names) + more,
        )
