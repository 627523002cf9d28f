"""Libraries and their classes: packages, blocks, interface blocks and value types.

The standard libraries of AutomationML are built in, for files that refer to them without holding
them.
"""

from collections.abc import Iterator
from functools import cache

from sysmlc.frontends.caex import data_types, rules, value_types
from sysmlc.frontends.caex.attributes import lower_attribute, lower_constraints
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node, read_document
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.interfaces import lower_interface
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import (
    CLASS_TAGS,
    LIBRARIES,
    STANDARD_LIBRARIES,
    SYSML_ROLES,
    Family,
)
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.sources import Source
from sysmlc.support import resources


def lower_libraries(context: Context, document: Document) -> list[Type]:
    """Add the libraries of a file; return their classes in document order."""
    return [
        type
        for node in document.root.iter_children(*LIBRARIES)
        for type in _lower_library(context, document, node)
    ]


def _lower_library(context: Context, document: Document, node: Node) -> Iterator[Type]:
    """Add one library; yield its classes, each before the classes nested in it."""
    family, class_tag, subkind = LIBRARIES[node.tag]
    context.add_element(
        Kind.PACKAGE,
        node,
        document,
        None,
        subkind=subkind,
        version=node.child_text("Version"),
    )
    worklist = [(child, node) for child in reversed(node.children) if child.tag == class_tag]
    while worklist:
        child, parent = worklist.pop()
        yield _add_class(context, document, child, parent, family)
        nested = [inner for inner in child.children if CLASS_TAGS.get(inner.tag) is family]
        worklist += [(inner, child) for inner in reversed(nested)]


def _add_class(
    context: Context, document: Document, node: Node, parent: Node, family: Family
) -> Type:
    is_role = family is Family.ROLE
    element = context.add_element(
        Kind.DATA_TYPE if family is Family.ATTRIBUTE else Kind.CLASS,
        node,
        document,
        parent.element_id,
        role=SYSML_ROLES[family],
        subkind="role-class" if is_role else None,
        abstract=True if is_role else None,
    )
    nodes = (node, *node.iter_ancestors())
    names = [part.name for part in nodes if part.tag != "CAEXFile"]
    type = Type(element.id, document, node.row, family, tuple(reversed(names)))
    context.types.add(type)
    return type


def mark_standard_libraries(graph: Graph, documents: list[Document]) -> None:
    """Mark the standard libraries in files as external, as the built-in ones are."""
    for document in documents:
        for node in document.root.iter_children(*LIBRARIES):
            if node.name in STANDARD_LIBRARIES:
                for element in graph.subtree(graph[node.element_id]):
                    graph.set(element, external=True, library=True)


# -- base classes ----------------------------------------------------------------------------------


def connect_base_classes(context: Context, types: list[Type]) -> None:
    """Connect every class to the class that it specialises; a cycle is reported and cut."""
    for type in types:
        base = context.types.find_base(type)
        if isinstance(base, str):
            base = context.resolve_type(base, type.family, type.document, type.node)
        type.base = base
    acyclic: set[Type] = set()
    for type in types:
        _cut_cycle(context.findings, type, acyclic)
        if type.base is not None:
            context.graph.connect(Edge.SPECIALIZES, type.id, type.base.id)


def _cut_cycle(findings: Findings, start: Type, acyclic: set[Type]) -> None:
    """Remove the base of *start* if the class specialises itself.

    *acyclic* collects the classes whose chains of base classes end.
    """
    chain: dict[Type, None] = {}
    type: Type | None = start
    while type is not None and type not in chain and type not in acyclic:
        chain[type] = None
        type = type.base
    if type is start and start in chain:
        names = " -> ".join(general.node.name for general in (*chain, start))
        facts = {"element": start.node.name, "cycle": names}
        findings.report(rules.CLASS_CYCLE, start.document, start.node, **facts)
        start.base = None
    if type is None or type not in chain or type is start:
        acyclic.update(chain)


# -- orders ----------------------------------------------------------------------------------------


def order_by_base(types: list[Type]) -> Iterator[Type]:
    """Yield the classes, each after the class that it specialises."""
    visited: set[Type] = set()
    for type in types:
        for general in reversed(list(type.iter_chain())):
            if general not in visited:
                visited.add(general)
                yield general


def order_by_parts(context: Context, types: list[Type]) -> list[Type]:
    """Return the classes, each after its base class and the classes of its internal elements.

    Built-in classes are omitted. A cycle is cut at the class that is visited first.
    """
    ordered: dict[Type, None] = {}
    visited: set[Type] = set()
    for type in types:
        # Depth-first search; a class is pushed again to be added after the classes it needs.
        stack = [(type, False)]
        while stack:
            current, is_complete = stack.pop()
            if is_complete:
                ordered[current] = None
            elif current not in visited:
                visited.add(current)
                stack.append((current, True))
                stack += [(required, False) for required in _iter_required(context, current)]
    return [type for type in ordered if not type.document.is_built_in]


def _iter_required(context: Context, type: Type) -> Iterator[Type]:
    """Yield the base class of a class, and the classes of its internal elements."""
    if type.base is not None:
        yield type.base
    worklist = list(type.node.iter_children("InternalElement"))
    for node in worklist:
        worklist += node.iter_children("InternalElement")
        path = node.attributes.get("RefBaseSystemUnitPath", "").strip()
        required = context.types.find(path, Family.SYSTEM_UNIT, type.document) if path else None
        if isinstance(required, Type):
            yield required


# -- features --------------------------------------------------------------------------------------


def lower_features(context: Context, type: Type) -> None:
    """Add the attributes and interfaces that are directly below a class."""
    if type.family is Family.ATTRIBUTE:
        lower_constraints(context, context.graph[type.id], type.node, type.document)
        value_types.complete_attribute_type(context.graph, context.findings, type)
        _set_defaults(context.graph, context.findings, type)
    for child in type.node.children:
        if child.tag == "Attribute":
            lower_attribute(context, type, child, type.document)
        elif child.tag == "ExternalInterface":
            lower_interface(context, type, child, type.document)


def _set_defaults(graph: Graph, findings: Findings, type: Type) -> None:
    """Set the initial value that an attribute type gives to attributes of this type."""
    node, attrs = type.node, graph[type.id].attrs
    value, default = node.child_text("Value"), node.child_text("DefaultValue")
    data_type = data_types.find_data_type("", type)
    data_types.check_data_type(findings, type.document, node.row, data_type)
    initial = default if value is None else value
    if initial:
        attrs["default"] = data_types.convert_value(findings, node, initial, data_type, None)
    if default and default != value:
        attrs["default_value"] = default
        if default != initial:
            # The text is stored as it is written; the conversion only checks it.
            data_types.convert_value(findings, node, default, data_type, None)


# -- standard libraries ----------------------------------------------------------------------------

_STANDARD_FILE = "automationml-libraries.aml"


class StandardLibraries:
    """The standard libraries for one unit; each is added to its graph when it is needed."""

    def __init__(self) -> None:
        # Each unit needs its own document, because rows store ids of elements of the graph.
        source = Source(_STANDARD_FILE, _read_standard_file())
        self._document = read_document(source, is_built_in=True)
        roots = self._document.root.iter_children(*LIBRARIES)
        self._unused = {(LIBRARIES[node.tag].family, node.name): node for node in roots}

    def provide(self, context: Context, family: Family, name: str) -> bool:
        """Add the library to the graph; return False if there is none, or it was added before."""
        library = self._unused.pop((family, name), None)
        if library is None:
            return False
        context.types.add_standard_library(self._document, family, name)
        types = list(_lower_library(context, self._document, library))
        connect_base_classes(context, types)
        for type in types:
            lower_features(context, type)
        return True

    def release_nodes(self) -> None:
        """Break the reference cycle between the document and its nodes."""
        self._document.release_nodes()


@cache
def _read_standard_file() -> bytes:
    return resources.path("metamodels", _STANDARD_FILE).read_bytes()
