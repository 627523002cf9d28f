"""What of a graph is content of the model, and what only tells of files, tools and passes."""

from collections.abc import Iterable

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query import BEHAVIORS, CLASSIFIERS

DETAILS = frozenset(
    {
        Kind.APPLICATION,
        Kind.COMMENT,
        Kind.CONNECTOR_END,
        Kind.EXPRESSION,
        Kind.EXTEND,
        Kind.GENERAL_ORDERING,
        Kind.IMPORT,
        Kind.METADATA,
        Kind.QUANTITY_KIND,
        Kind.SLOT,
        Kind.TEMPLATE_BINDING,
        Kind.TEMPLATE_SUBSTITUTION,
        Kind.TRIGGER,
        Kind.UNIT,
    }
)
"""Kinds that say something of their owner; a difference in them is one of the owner."""

_OF_PACKAGES = frozenset({Kind.APPLICATION, Kind.COMMENT, Kind.IMPORT, Kind.METADATA})
"""Those of them that say something of a package; the others it owns for their own sake."""

_GUARDED = frozenset({Kind.TRANSITION, Kind.CONTROL_FLOW, Kind.OBJECT_FLOW})

NOT_CONTENT = frozenset(
    {
        "change_mode",
        "external",
        "interface_ids",
        "lineage",
        "namespace",
        "ns_prefix",
        "origin",
        "unresolved",
    }
)
"""Attributes that tell of files and tools, or follow from what is compared anyway."""

IMPLIED = frozenset({"role", "subkind"})
"""Attributes that mostly follow from others: told only when nothing else of the element is."""

WORDS = frozenset(
    {
        "aggregation",
        "body",
        "bodies",
        "data_type",
        "description",
        "direction",
        "domain",
        "language",
        "languages",
        "level",
        "multiplicity",
        "role",
        "stereotype",
        "subkind",
        "unit",
        "visibility",
    }
)
"""Attributes that never hold ids, whatever the ids of a model look like."""

PASSED_OVER = frozenset({Edge.OWNS, Edge.FEATURE, Edge.END})
"""Edges that follow from other edges, or that the ends of a relation stand for; the subject of
an application is what it is told of."""

ENDS = (Edge.CLIENT, Edge.SUPPLIER, Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
"""Edges of which two make one relation: they are compared together."""

TYPES = frozenset({Edge.TYPED_BY, Edge.INSTANCE_OF, Edge.SPECIALIZES, Edge.REALIZES})
"""Edges that say what an element is."""

WIRES = frozenset(
    {
        Edge.BINDS,
        Edge.COVERS,
        Edge.IN_PARTITION,
        Edge.MIRRORS,
        Edge.PATH,
        Edge.REALIZING,
        Edge.RECEIVE_EVENT,
        Edge.ROLE,
        Edge.SEND_EVENT,
    }
)
"""Edges that say what an element is connected with."""

IN_ORDER = {
    Kind.OPERATION: frozenset({Kind.PARAMETER}),
    Kind.RECEPTION: frozenset({Kind.PARAMETER}),
    Kind.ACTIVITY: frozenset({Kind.PARAMETER}),
    Kind.STATE_MACHINE: frozenset({Kind.PARAMETER}),
    Kind.ACTION: frozenset({Kind.PIN}),
    Kind.ENUMERATION: frozenset({Kind.ENUMERATION_LITERAL}),
    Kind.INTERACTION: frozenset({Kind.OCCURRENCE, Kind.EXECUTION, Kind.FRAGMENT}),
    Kind.OPERAND: frozenset({Kind.OCCURRENCE, Kind.EXECUTION, Kind.FRAGMENT}),
    Kind.FRAGMENT: frozenset({Kind.OPERAND}),
}
"""Kinds of owners to whom the order of what they own means something, and the kinds that count."""

MOVABLE = frozenset(
    {*CLASSIFIERS, *BEHAVIORS, Kind.PACKAGE, Kind.PROFILE, Kind.INSTANCE, Kind.PROPERTY}
)
"""Kinds that are recognised below another owner without the help of ids."""


def is_external(element: Element) -> bool:
    """Whether it stands for something outside the model, or is of a library."""
    return element.attrs.get("external") is True


def is_header(element: Element) -> bool:
    """Whether it tells of the file, not of the plant (docs/automationml.md)."""
    if element.owner is not None:
        return False
    return element.subkind in ("caex", "alias") or element.kind is Kind.METADATA


def is_detail(element: Element, owner: Element | None) -> bool:
    """Whether it is told as a property of its owner."""
    if owner is None or owner.kind in (Kind.PACKAGE, Kind.PROFILE):
        return element.kind in _OF_PACKAGES
    is_guard = element.kind is Kind.CONSTRAINT and (not element.name or owner.kind in _GUARDED)
    return is_guard or element.kind in DETAILS


_WORDS = frozenset({"id", "name", "value", "default", "default_value", "stereotype", "tag", "xml"})
"""``id``, and keys of facts that are no attributes in every model."""
_NEVER = frozenset({"source", "trace"})
"""Where elements are and what was made of them is never compared; ``id,source,trace`` says so."""


def words(graphs: Iterable[Graph]) -> frozenset[str]:
    """All words that may make a difference in these models, and the common ones."""
    found = {name for graph in graphs for element in graph for name in element.attrs}
    found |= {edge.value for edge in Edge} | {kind.value for kind in DETAILS}
    return frozenset(found | _WORDS | WORDS | IMPLIED | _NEVER)
