"""Reports every element, edge and attribute that the files do not express."""

from sysmlc.backends.aml.class_kinds import is_hierarchy, is_measured_type
from sysmlc.backends.aml.context import Context
from sysmlc.backends.aml.rules import UNSUPPORTED_ATTRIBUTE, UNSUPPORTED_EDGE, UNSUPPORTED_KIND
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query.classifiers import name_value_unit

_COVERED_ATTRIBUTES = frozenset(
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
        "caex_id",
        "ppr",
        "domain",
        "usage",
        "property_specific",
    }
)
"""Attributes that are written for every element, or that passes derive from what is written."""
_WRITTEN_ATTRIBUTES = {
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
_EXPRESSED_STEREOTYPES = frozenset(
    {"Block", "InterfaceBlock", "ValueType", "ProxyPort", "FullPort", "FlowPort", "PartProperty"}
)
"""Stereotypes of SysML that the kind of the CAEX object expresses."""
_COVERED_EDGES = frozenset({Edge.OWNS, Edge.FEATURE, Edge.END, Edge.ROLE, Edge.PATH, Edge.METHOD})
"""Edges that are written with their source, or that passes add."""
_CONTAINERS = frozenset({Kind.PACKAGE, Kind.DOCUMENT, Kind.IMPORT, Kind.METADATA, Kind.COMMENT})
"""Kinds that are no content of a plant: a file with nothing else is empty."""
_MEASURES = frozenset({Kind.UNIT, Kind.QUANTITY_KIND})
_MEASURE_ROLES = ("unit", "quantity kind")


def note_omissions(context: Context) -> None:
    """Count what the files do not express."""
    _mark_documents(context)
    for element in context.graph:
        if element.id in context.written:
            _note_attributes(context, element)
        elif not _needs_no_object(context, element):
            context.losses.record(UNSUPPORTED_KIND, element, kind=_describe_kind(element))
    for edge in Edge:
        if edge not in _COVERED_EDGES:
            _note_edges(context, edge)


def find_lost_plant(context: Context) -> tuple[Element, str] | None:
    """Return an omitted element, and what the files lack, if they would be without content.

    Return None for files with content, and for a model that has none itself.
    """
    graph, written = context.graph, context.written
    hierarchies = [package for package in graph.of_kind(Kind.PACKAGE) if is_hierarchy(package)]
    objects = [
        member for member in context.list_owned(*hierarchies) if member.kind is Kind.INSTANCE
    ]
    if objects and not any(member.id in written for member in objects):
        return objects[0], "AutomationML would lose all internal elements of the plant"
    if any(element.id in written and element.kind not in _CONTAINERS for element in graph):
        return None
    for element in graph:
        if element.id not in written and not _needs_no_object(context, element):
            return element, "the model has no blocks, types or instances for AutomationML"
    return None


def _mark_documents(context: Context) -> None:
    """Mark the documents that interfaces reference by their attribute ``refURI``."""
    for document in context.graph.of_kind(Kind.DOCUMENT):
        ports = context.graph.targets(document, Edge.REFERENCES)
        if ports and all(port.id in context.written for port in ports):
            context.written.add(document.id)
            for port in ports:
                context.mark_edge(Edge.REFERENCES, document, port)


def _needs_no_object(context: Context, element: Element) -> bool:
    """Whether an element needs no CAEX object: a stub, a unit, a mere container."""
    graph = context.graph
    if element.attrs.get("external") or element.kind in _MEASURES or is_measured_type(element):
        return True
    if element.role in _MEASURE_ROLES or element.kind is Kind.VIEW:
        return True
    stereotype = element.attrs.get("stereotype") if element.kind is Kind.APPLICATION else None
    if stereotype in _EXPRESSED_STEREOTYPES:
        subjects = graph.targets(element, Edge.SUBJECT)
        return all(subject.id in context.written for subject in subjects)
    if any(ancestor.attrs.get("external") for ancestor in graph.ancestors(element)):
        return True
    return element.kind is Kind.PACKAGE and any(
        member.id in context.written for member in graph.subtree(element)
    )


def _describe_kind(element: Element) -> str:
    return f"{element.kind} ({element.role})" if element.role else str(element.kind)


def _note_attributes(context: Context, element: Element) -> None:
    written = _WRITTEN_ATTRIBUTES.get(element.kind, ())
    for name in element.attrs:
        if name in _COVERED_ATTRIBUTES or name in written or name.startswith("value."):
            continue
        if not (
            _is_unit_written(context, element, name)
            or _is_attribute_expressed(context, element, name)
        ):
            kind = _describe_kind(element)
            context.losses.record(UNSUPPORTED_ATTRIBUTE, element, attribute=name, kind=kind)


def _is_unit_written(context: Context, element: Element, name: str) -> bool:
    """Whether an attribute is the unit of a value, and the CAEX attribute of the value has it."""
    node = context.nodes.get(element.id)
    if name not in ("default_unit", "value_unit") or node is None:
        return False
    unit = name_value_unit(context.graph, element, name.removesuffix("_unit"))
    return node.attributes.get("Unit") == unit


def _is_attribute_expressed(context: Context, element: Element, name: str) -> bool:
    """Whether an attribute follows from what the files state about the element."""
    if element.kind in (Kind.METADATA, Kind.DOCUMENT):
        return True
    if name == "unresolved":
        return "unresolved_paths" in element.attrs or not context.ids.is_from_caex(element)
    if name == "abstract":
        return element.subkind == "role-class"
    if element.kind is Kind.PORT and name in ("aggregation", "conjugated"):
        return name == "aggregation" or "direction" in element.attrs
    if element.kind is Kind.PROPERTY and name in ("multiplicity", "ordered"):
        return context.ids.is_from_caex(element) or element.attrs.get("multiplicity") == "*"
    return element.subkind == "port-object" and name in ("direction", "multiplicity", "category")


def _note_edges(context: Context, edge: Edge) -> None:
    graph = context.graph
    for _, source, target in graph.edges(edge):
        if source not in context.written or (edge, source, target) in context.written_edges:
            continue
        if not _is_edge_implied(context, edge, graph[source], graph[target]):
            kind, target_kind = _describe_kind(graph[source]), _describe_kind(graph[target])
            context.losses.record(
                UNSUPPORTED_EDGE, graph[source], edge=edge.value, kind=kind, target=target_kind
            )


def _is_edge_implied(context: Context, edge: Edge, source: Element, target: Element) -> bool:
    """Whether something that is written implies an edge."""
    if edge is Edge.REFERENCES:
        is_measure = target.kind in _MEASURES or target.role in _MEASURE_ROLES
        return is_measure or source.kind is Kind.IMPORT
    if edge is Edge.REDEFINES:
        # In CAEX a feature of the same name overrides the inherited one.
        return source.name == target.name
    if edge is Edge.SPECIALIZES:
        return source.subkind in ("attribute", "external-interface")
    return edge is Edge.SUBJECT or _has_written_dependency(context, source, target)


def _has_written_dependency(context: Context, source: Element, target: Element) -> bool:
    """Whether a dependency is written from which ``classify`` derives the edge."""
    graph = context.graph
    return any(
        dependency.id in context.written and target in graph.targets(dependency, Edge.SUPPLIER)
        for dependency in graph.sources(source, Edge.CLIENT)
    )
