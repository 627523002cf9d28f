"""Which elements, edges and attributes of a graph are content of the model.

The others describe files, tools and the work of passes; the comparison ignores them.
"""

from collections.abc import Iterable, Sequence

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query import BEHAVIORS, CLASSIFIERS
from sysmlc.support.suggestions import did_you_mean

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
"""Kinds that describe their owner; a difference in them is a difference of the owner."""

_OF_PACKAGES = frozenset({Kind.APPLICATION, Kind.COMMENT, Kind.IMPORT, Kind.METADATA})
"""Details of packages; a package owns all other elements for their own sake."""

_GUARDED = frozenset({Kind.TRANSITION, Kind.CONTROL_FLOW, Kind.OBJECT_FLOW})

NOT_CONTENT = frozenset(
    {
        "caex_id",
        "change_mode",
        "external",
        "immediate",
        "interface_ids",
        "lineage",
        "namespace",
        "ns_prefix",
        "origin",
        "token_rules",
        "unresolved",
    }
)
"""Attributes that describe files and tools, or follow from what is compared anyway."""

IMPLIED = frozenset({"role", "subkind"})
"""Attributes that mostly follow from others: reported only if no other attribute differs."""

DECLARATION = "declaration"
"""Key of facts about declarations in SysML v2, which ``--ignore`` accepts as well."""

_RELATIONS = frozenset(
    {"from", "to", "between", *(edge.value for edge in Edge if edge is not Edge.OWNS)}
)
_TEXTS = frozenset({"body", "comment", "description", "locale", "text"})
DECLARED_BY: dict[str, frozenset[str]] = {
    "keyword": frozenset({"role", "subkind"}),
    "specialization": _RELATIONS | {"conjugated"},
    "body": _TEXTS,
    "condition": frozenset({"body", "constraint", "guard"}),
    "documentation": _TEXTS,
    "end": _RELATIONS | {"ends"},
    "filter": frozenset({"filters"}),
    "import": frozenset({"exposed", "filters", "import"}),
    "locale": _TEXTS,
    "name": frozenset({"req_id"}),
    "reference": frozenset({"aggregation", "referential"}),
    "short name": frozenset({"req_id", "symbol"}),
    "metadata": frozenset({"stereotype", "tag", "metadata"}),
}
"""Names of facts that express an aspect of declarations; other aspects are named like the facts."""

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
        "tag.nsPrefix",
        "tag.prefix",
        "subkind",
        "unit",
        "visibility",
    }
)
"""Attributes that never hold ids, whatever the ids of a model look like."""

_FIRST_AND_LAST_NAMES = {
    (Kind.CONTROL, "initial"): "start",
    (Kind.PSEUDOSTATE, "initial"): "start",
    (Kind.CONTROL, "final"): "done",
    (Kind.CONTROL, "flow-final"): "done",
    (Kind.FINAL_STATE, ""): "done",
}
"""Names in SysML v2 of the first and last nodes of a behaviour, which have mostly none in UML."""

PASSED_OVER = frozenset({Edge.OWNS, Edge.FEATURE, Edge.END})
"""Edges that follow from ownership, from inheritance, or from the ends of a relation."""

ENDS = (Edge.CLIENT, Edge.SUPPLIER, Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
"""Edges from a relation to its two ends, which are compared together."""

TYPES = frozenset({Edge.TYPED_BY, Edge.INSTANCE_OF, Edge.SPECIALIZES, Edge.REALIZES})
"""Edges to the types of an element."""

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
"""Edges to what an element is connected with."""

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
"""Kinds of owners for which order has a meaning, with the kinds of owned elements it concerns."""

MOVABLE = frozenset(
    {*CLASSIFIERS, *BEHAVIORS, Kind.PACKAGE, Kind.PROFILE, Kind.INSTANCE, Kind.PROPERTY}
)
"""Kinds that are recognised below another owner by kind and name, without ids."""


def name_in_comparison(element: Element) -> str:
    """Return the name of *element*; a first or last node without one is called as in SysML v2."""
    return element.name or _FIRST_AND_LAST_NAMES.get((element.kind, element.subkind), "")


def is_external(element: Element) -> bool:
    """Whether *element* is an external stub or an element of a library."""
    return element.attrs.get("external") is True


def is_header(element: Element) -> bool:
    """Whether *element* describes the file, not the plant (docs/automationml.md)."""
    if element.owner is not None:
        return False
    return element.subkind in ("caex", "alias") or element.kind is Kind.METADATA


def is_detail(element: Element, owner: Element | None) -> bool:
    """Whether *element* is compared as a property of its owner."""
    if owner is None or owner.kind in (Kind.PACKAGE, Kind.PROFILE):
        return element.kind in _OF_PACKAGES
    is_guard = element.kind is Kind.CONSTRAINT and (not element.name or owner.kind in _GUARDED)
    return is_guard or element.kind in DETAILS


_FACT_KEYS = frozenset(
    {"id", "name", "value", "default", "default_value", "stereotype", "tag", "xml"}
)
"""``id``, and keys of facts that not every model has as attributes."""
_NEVER_COMPARED = frozenset({"source", "trace"})
"""Accepted because ``--ignore id,source,trace`` is a usual combination."""


def check_ignored(ignore: Iterable[str], graphs: Sequence[Graph]) -> None:
    """Raise ValueError for a word that names nothing in the models: it is probably misspelt."""
    words = ignorable_words(graphs) if ignore else ()
    for word in ignore:
        if word not in words:
            hint = did_you_mean(word, words)
            advice = hint if hint.startswith("did") else "these models have no such attribute"
            raise ValueError(f"'{word}': {advice}")


def ignorable_words(graphs: Iterable[Graph]) -> frozenset[str]:
    """Return the words that ``--ignore`` accepts: attributes, edges and kinds of details."""
    attributes = {name for graph in graphs for element in graph for name in element.attrs}
    kinds = {edge.value for edge in Edge} | {kind.value for kind in DETAILS}
    return frozenset(
        attributes | kinds | {DECLARATION} | _FACT_KEYS | WORDS | IMPLIED | _NEVER_COMPARED
    )
