"""What was not written: every element, relation and attribute that CAEX has no place for."""

from sysmlc.backends.aml.book import Book
from sysmlc.backends.aml.families import is_measured
from sysmlc.backends.aml.rules import UNSAID_ATTRIBUTE, UNSAID_EDGE, UNSAID_KIND
from sysmlc.ir import Edge, Element, Kind

_EVERYWHERE = frozenset(
    {
        "role",
        "level",
        "origin",
        "subkind",
        "version",
        "copyright",
        "change_mode",
        "unresolved_paths",
        "external",
        "library",
        "semantics",
        "interface_ids",
        "ppr",
        "domain",
        "usage",
        "property_specific",
    }
)
"""What is written of every element, or follows from what is written."""
_WRITTEN = {
    Kind.PROPERTY: (
        "data_type",
        "unit",
        "default",
        "default_value",
        "default_instance",
        "aggregation",
    ),
    Kind.PORT: ("direction", "multiplicity", "category"),
    Kind.SLOT: ("value", "direction", "multiplicity", "category"),
    Kind.DATA_TYPE: ("data_type", "unit", "default", "default_value"),
    Kind.CONSTRAINT: ("body", "language"),
    Kind.COMMENT: ("body",),
    Kind.FACET: ("mirrors",),
    Kind.GROUP: ("associated_facet", "mirrors"),
    Kind.DEPENDENCY: ("sides", "ports"),
    Kind.DOCUMENT: ("description", "superior_standard"),
    Kind.IMPORT: ("path",),
}
_SAID = frozenset(
    {"Block", "InterfaceBlock", "ValueType", "ProxyPort", "FullPort", "FlowPort", "PartProperty"}
)
"""Stereotypes of SysML that say what sort of class or feature something is."""
_IMPLIED = frozenset({Edge.OWNS, Edge.FEATURE, Edge.END, Edge.ROLE, Edge.PATH, Edge.METHOD})
"""Edges that are written with the element that has them, or that passes add."""
_MEASURES = frozenset({Kind.UNIT, Kind.QUANTITY_KIND})


def account(book: Book) -> None:
    """Note what the files do not say."""
    _documents(book)
    for element in book.graph:
        if element.id in book.said:
            _attributes(book, element)
        elif not _is_aside(book, element):
            book.losses.note(UNSAID_KIND, element, kind=_kind(element))
    for edge in Edge:
        if edge not in _IMPLIED:
            _edges(book, edge)


def _documents(book: Book) -> None:
    """Documents follow from the references that interfaces hold."""
    for one in book.graph.of_kind(Kind.DOCUMENT):
        ports = book.graph.targets(one, Edge.REFERENCES)
        if ports and all(port.id in book.said for port in ports):
            book.said.add(one.id)
            for port in ports:
                book.say(Edge.REFERENCES, one, port)


def _is_aside(book: Book, element: Element) -> bool:
    """Whether it is no content of the model: a stub, a unit, a container of what is written."""
    if element.attrs.get("external") or element.kind in _MEASURES or is_measured(element):
        return True
    if element.role in ("unit", "quantity kind") or element.kind is Kind.VIEW:
        return True
    if element.kind is Kind.APPLICATION and element.attrs.get("stereotype") in _SAID:
        return all(one.id in book.said for one in book.graph.targets(element, Edge.SUBJECT))
    if any(one.attrs.get("external") for one in book.graph.ancestors(element)):
        return True
    return element.kind is Kind.PACKAGE and any(
        one.id in book.said for one in book.graph.subtree(element)
    )


def _kind(element: Element) -> str:
    return f"{element.kind} ({element.role})" if element.role else str(element.kind)


def _attributes(book: Book, element: Element) -> None:
    written = _WRITTEN.get(element.kind, ())
    for name in element.attrs:
        if name in _EVERYWHERE or name in written or name.startswith("value."):
            continue
        if not _follows(book, element, name):
            book.losses.note(UNSAID_ATTRIBUTE, element, attribute=name, kind=_kind(element))


def _follows(book: Book, element: Element, name: str) -> bool:
    """Attributes that only some elements of a kind have for a reason that is written."""
    if element.kind in (Kind.METADATA, Kind.DOCUMENT):
        return True
    if name == "unresolved":
        return "unresolved_paths" in element.attrs or not book.ids.is_ours(element)
    if name == "abstract":
        return element.subkind == "role-class"
    if element.kind is Kind.PORT and name in ("aggregation", "conjugated"):
        return name == "aggregation" or "direction" in element.attrs
    if element.kind is Kind.PROPERTY and name in ("multiplicity", "ordered"):
        return book.ids.is_ours(element) or element.attrs.get("multiplicity") == "*"
    return element.subkind == "port-object" and name in ("direction", "multiplicity", "category")


def _edges(book: Book, edge: Edge) -> None:
    graph = book.graph
    for _, source, target in graph.edges(edge):
        if source not in book.said or (edge, source, target) in book.relations:
            continue
        if not _is_implied(book, edge, graph[source], graph[target]):
            facts = {"kind": _kind(graph[source]), "target": _kind(graph[target])}
            book.losses.note(UNSAID_EDGE, graph[source], edge=edge.value, **facts)


def _is_implied(book: Book, edge: Edge, source: Element, target: Element) -> bool:
    if edge is Edge.REFERENCES:
        is_alias = source.kind is Kind.IMPORT
        return is_alias or target.kind in _MEASURES or target.role in ("unit", "quantity kind")
    if edge is Edge.REDEFINES:
        return source.name == target.name
    if edge is Edge.SPECIALIZES:
        return source.subkind in ("attribute", "external-interface")
    return edge is Edge.SUBJECT or _is_of_dependency(book, source, target)


def _is_of_dependency(book: Book, source: Element, target: Element) -> bool:
    """Whether a dependency that is written says the same (pass ``classify``)."""
    graph = book.graph
    return any(
        one.id in book.said and target in graph.targets(one, Edge.SUPPLIER)
        for one in graph.sources(source, Edge.CLIENT)
    )
