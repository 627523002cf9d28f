"""Reports what CAEX allows but AutomationML (IEC 62714-1) does not.

None of it prevents reading; other tools of AutomationML do not find what they need.
"""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Rule, Severity, rule
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings, qualified_name
from sysmlc.frontends.caex.identifiers import Identifiers, LocatedNode
from sysmlc.frontends.caex.types import Type, find_meaning
from sysmlc.frontends.caex.vocabulary import (
    BASE_INTERFACE,
    BASE_REFERENCES,
    BASE_ROLE,
    DIRECTIONS,
    DOCUMENT_MEANINGS,
    INTERFACE_MEANINGS,
    ORDER_INTERFACE,
    ROLE_REFERENCES,
    STANDARD_LIBRARIES,
    Family,
)
from sysmlc.ir import Graph

ID_IN_SEVERAL_FILES = rule(
    "SM341",
    "id-in-several-files",
    Severity.WARNING,
    "the ID '{id}' of '{element}' is that of '{first}' in '{file}' too{more}",
    help="give one of them another ID; a copy of an element needs an ID of its own",
)
CLASS_WITHOUT_BASE = rule(
    "SM342",
    "class-without-base",
    Severity.INFO,
    "the {family} '{element}' does not specialise '{base}'{more}",
    help="write RefBaseClassPath='{path}', or the path of a class that specialises it",
)
WITHOUT_URI = rule(
    "SM343",
    "data-connector-without-uri",
    Severity.WARNING,
    "'{element}' is an interface to external data, but its attribute 'refURI' has no value",
    help="write the address of the file in 'refURI', or remove the interface",
)
UNKNOWN_DIRECTION = rule(
    "SM344",
    "unknown-direction",
    Severity.WARNING,
    "the direction '{value}' of '{element}' is none of In, Out and InOut, so it has no direction",
    help="write In, Out or InOut as the value of 'Direction'",
)
WITHOUT_DIRECTION = rule(
    "SM345",
    "interface-without-direction",
    Severity.INFO,
    "'{element}' is an interface of class '{base}', but its attribute 'Direction' has no "
    "value{more}",
    help="write In, Out or InOut as the value of 'Direction', here or in its class",
)
PORT_WITHOUT_INTERFACE = rule(
    "SM346",
    "port-without-interface",
    Severity.WARNING,
    "'{element}' has the role 'Port', but no interface that a link can join",
    help="add an ExternalInterface of class 'PortConnector' to it",
)

_BASES = {Family.ROLE: BASE_ROLE, Family.INTERFACE: BASE_INTERFACE}
_PORT = "port"
_DIRECTED = {ORDER_INTERFACE: "Order", _PORT: "Port"}
"""Meanings of interfaces with a direction, and the names of their standard classes."""
_PLCOPEN = (*BASE_INTERFACE, "ExternalDataConnector", "PLCopenXMLInterface")
_MEANINGS = {
    **INTERFACE_MEANINGS,
    (*BASE_INTERFACE, "Port"): _PORT,
    # It names a variable of the control program, whose file another interface refers to.
    (*_PLCOPEN, "VariableInterface"): "variable",
}


def report_repeated_across_files(findings: Findings, ids: Identifiers) -> None:
    """Report once a file that IDs of its elements are those of elements of an earlier file."""
    repeated: dict[Document, list[tuple[str, Node, LocatedNode]]] = {}
    for id, nodes in ids.iter_repeated():
        by_file: dict[Document, Node] = {}
        for document, node in nodes:
            by_file.setdefault(document, node)
        first, *others = by_file.items()
        for document, node in others:
            repeated.setdefault(document, []).append((id, node, first))
    for document, occurrences in repeated.items():
        id, node, (first_document, first_node) = occurrences[0]
        facts = {"first": qualified_name(first_node), "file": first_document.name}
        rest = [occurrence[1] for occurrence in occurrences[1:]]
        _report_group(findings, ID_IN_SEVERAL_FILES, document, [node, *rest], id=id, **facts)


def report_classes_without_base(findings: Findings, types: Iterable[Type]) -> None:
    """Report once a file and family the role and interface classes without the standard base.

    A class whose base is missing or circular is reported as such, and one whose base lacks the
    standard base is a consequence of that.
    """
    nodes: dict[tuple[Document, Family], list[Node]] = {}
    for type in types:
        base = _BASES.get(type.family)
        is_top = not type.node.attributes.get(BASE_REFERENCES[type.family], "").strip()
        if base is not None and is_top and type.path[0] not in STANDARD_LIBRARIES:
            nodes.setdefault((type.document, type.family), []).append(type.node)
    for (document, family), group in nodes.items():
        base = _BASES[family]
        facts = {"family": family.value, "base": base[-1], "path": "/".join(base)}
        _report_group(findings, CLASS_WITHOUT_BASE, document, group, **facts)


def report_interfaces(context: Context, document: Document) -> None:
    """Report interfaces without a value that their class requires, and ports without interface."""
    undirected: dict[str, list[Node]] = {}
    for node, meaning, is_instance in _iter_interfaces(context, document):
        if meaning in _DIRECTED:
            has_value = _report_unknown_direction(context.findings, document, node)
            if is_instance and not has_value and not _has_direction(context.graph, node):
                undirected.setdefault(meaning, []).append(node)
        elif is_instance and not _has_uri(context, document, node):
            context.findings.report(
                WITHOUT_URI, document, node, "no refURI", element=qualified_name(node)
            )
    for meaning, nodes in undirected.items():
        _report_group(context.findings, WITHOUT_DIRECTION, document, nodes, base=_DIRECTED[meaning])
    for node in _iter_port_elements(context, document):
        _report_unknown_direction(context.findings, document, node)
        if not _has_interface(context, document, node):
            facts = {"element": qualified_name(node)}
            context.findings.report(PORT_WITHOUT_INTERFACE, document, node, "port element", **facts)


def _report_group(
    findings: Findings, rule: Rule, document: Document, nodes: list[Node], **facts: str
) -> None:
    """Report the first of some nodes; the message counts the others."""
    rest = len(nodes) - 1
    more = f" ({rest} more in the file)" if rest else ""
    findings.report(rule, document, nodes[0], element=qualified_name(nodes[0]), more=more, **facts)


# -- interfaces ------------------------------------------------------------------------------------


def _iter_interfaces(context: Context, document: Document) -> Iterator[tuple[Node, str, bool]]:
    """Yield the interfaces for directions and documents, with meaning and if of an instance."""
    meanings: dict[str, str] = {}
    hierarchies = [
        range(node.row, document.ends[node.row])
        for node in document.root.iter_children("InstanceHierarchy")
    ]
    for row in document.iter_rows("ExternalInterface", 0, len(document.tags)):
        path = document.attributes[row].get("RefBaseClassPath", "").strip()
        if path not in meanings:
            type = context.find_resolved(path, Family.INTERFACE, document)
            meanings[path] = find_meaning(type, _MEANINGS)
        meaning = meanings[path]
        if meaning in _DIRECTED or meaning in DOCUMENT_MEANINGS:
            is_instance = any(row in hierarchy for hierarchy in hierarchies)
            is_required = document.tags[document.parents[row]] == "RoleRequirements"
            yield document.node(row), meaning, is_instance and not is_required


def _read_value(node: Node, name: str) -> str:
    """Return the value of an attribute of a node, or an empty text."""
    for child in node.iter_children("Attribute"):
        if child.name == name:
            return (child.child_text("Value") or child.child_text("DefaultValue") or "").strip()
    return ""


def _report_unknown_direction(findings: Findings, document: Document, node: Node) -> bool:
    """Report a direction that is none; return whether the node states any."""
    value = _read_value(node, "Direction")
    if value and value.lower() not in DIRECTIONS:
        facts = {"element": qualified_name(node), "value": value}
        findings.report(UNKNOWN_DIRECTION, document, node, f"direction {value}", **facts)
    return bool(value)


def _has_direction(graph: Graph, node: Node) -> bool:
    """Whether the port of an interface has a direction, from its class or what it overrides."""
    port = graph.get(node.element_id)
    return port is not None and "direction" in port.attrs


def _has_uri(context: Context, document: Document, node: Node) -> bool:
    """Whether an interface, its class or the interface that it overrides states a ``refURI``."""
    port = context.graph.get(node.element_id)
    if _read_value(node, "refURI") or (port is not None and port.attrs.get("value.refURI")):
        return True
    path = node.attributes.get("RefBaseClassPath", "").strip()
    type = context.find_resolved(path, Family.INTERFACE, document)
    chain = type.iter_chain() if type is not None else ()
    return any(_read_value(general.node, "refURI") for general in chain)


# -- elements with the role Port -------------------------------------------------------------------


def _iter_port_elements(context: Context, document: Document) -> Iterator[Node]:
    """Yield the internal elements of hierarchies that have the role Port (CAEX 2.15)."""
    elements: dict[Node, None] = {}
    for hierarchy in document.root.iter_children("InstanceHierarchy"):
        for tag, name in ROLE_REFERENCES.items():
            for row in document.iter_rows(tag, hierarchy.row, document.ends[hierarchy.row]):
                path = document.attributes[row].get(name, "").strip()
                role = context.find_resolved(path, Family.ROLE, document)
                if role is not None and role.conforms_to(*BASE_ROLE, "Port"):
                    elements[document.node(document.parents[row])] = None
    return iter(elements)


def _has_interface(context: Context, document: Document, node: Node) -> bool:
    """Whether an internal element, its class or its required role content has an interface.

    A mirror shows the interfaces of its master, and those of a missing class are unknown.
    """
    path = node.attributes.get("RefBaseSystemUnitPath", "").strip()
    type = context.find_resolved(path, Family.SYSTEM_UNIT, document)
    if path and type is None:
        return True
    chain = type.iter_chain() if type is not None else ()
    holders = [node, *node.iter_children("RoleRequirements")]
    holders += [general.node for general in chain]
    return any(holder.has_child("ExternalInterface") for holder in holders)
