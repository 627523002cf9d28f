"""What of the model the text does not say: elements, edges and attributes that nobody wrote."""

from collections.abc import Mapping

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.rules import (
    NAME_LEFT_OUT,
    UNSAID_ATTRIBUTE,
    UNSAID_EDGE,
    UNSAID_KIND,
)
from sysmlc.backends.sysml.stereotypes import is_standard
from sysmlc.ir import Edge, Element, Kind

_SAID_ELSEWHERE = frozenset(
    {
        Kind.APPLICATION,
        Kind.CONNECTOR_END,
        Kind.SLOT,
        Kind.CONTROL_FLOW,
        Kind.OBJECT_FLOW,
        Kind.TRIGGER,
        Kind.VIEW,
        Kind.UNIT,
        Kind.QUANTITY_KIND,
    }
)
"""Kinds that are said with another element, or made by passes; their losses are told there."""
_TRANSPARENT = frozenset({Kind.REGION, Kind.ACTIVITY_PARAMETER, Kind.FINAL_STATE})
_NO_NAMES = {
    Kind.REGION: "a region that is the only one",
    Kind.FINAL_STATE: "a final state",
    Kind.PSEUDOSTATE: "an initial pseudostate",
    Kind.CONTROL: "an initial or final node",
    Kind.TRIGGER: "a trigger",
    Kind.ACTIVITY_PARAMETER: "a parameter node",
    Kind.OBJECT_FLOW: "an object flow between control nodes",
    Kind.SLOT: "a slot",
    Kind.CONNECTOR_END: "an end of a connector",
}


def account(book: Book, dropped: Mapping[str, str]) -> None:
    """Note all that is not said: first elements, then edges and attributes of those that are.

    ``dropped`` says by id what elements refer to that has no name.
    """
    for element in book.graph:
        if element.attrs.get("external") or _is_below(book, element, dropped):
            continue
        if element.id in dropped:
            book.lost(element, dropped[element.id])
            continue
        if _is_unsaid(book, element):
            book.losses.note(UNSAID_KIND, element, kind=str(element.kind))
        else:
            _name(book, element)
            _attributes(book, element)
    _edges(book)


def _is_below(book: Book, element: Element, dropped: Mapping[str, str]) -> bool:
    return bool(dropped) and any(one.id in dropped for one in book.graph.ancestors(element))


def _is_unsaid(book: Book, element: Element) -> bool:
    if element.id in book.said or element.kind in (_SAID_ELSEWHERE | _TRANSPARENT):
        return False
    if element.kind is Kind.PARTITION:
        return not book.graph.sources(element, Edge.IN_PARTITION)
    if element.kind in (Kind.CONTROL, Kind.PSEUDOSTATE) and element.subkind in _WORDS:
        return False
    owners = (element, *book.graph.ancestors(element))
    return not any(one.attrs.get("external") for one in owners)


_WORDS = frozenset({"initial", "final", "flow-final"})


def _name(book: Book, element: Element) -> None:
    said = _NO_NAMES.get(element.kind)
    if said is None or not element.name:
        return
    entry = book.plan.entry(element)
    if entry is not None and entry.name:
        return
    feature = book.graph.target(element, Edge.INSTANCE_OF) or book.graph.target(
        element, Edge.REFERENCES
    )
    if feature is None or feature.name != element.name:
        book.losses.note(NAME_LEFT_OUT, element, said=said)


# -- attributes --------------------------------------------------------------------------------

_ATTRIBUTES = """
    role level subkind multiplicity direction conjugated abstract ordered derived readonly unique
    visibility aggregation default default_language default_instance default_bodies
    default_languages domain body language bodies languages external href library qualified_name
    unresolved origin value value_language value_instance value_bodies value_languages guard
    guard_language guard_literal guard_bodies guard_languages guard_instance req_id text symbol
    when when_language when_bodies when_languages condition condition_language condition_bodies
    condition_languages relative port path represents data_type unit default_value category
    semantics version change_mode copyright ppr interface_ids associated_facet tag data_type
    decision_input_flow stereotype namespace lineage on diagram arguments
    message_kind description usage property_specific payload initial value_unit variation variant
    portion individual
"""
_SAID = frozenset(_ATTRIBUTES.split())
"""Attributes that the text says, or that say nothing more than what it says."""
_OF_LOOPS = ("mode", "collection")
_WHOLE = (Kind.DOCUMENT, Kind.METADATA, Kind.ALIAS, Kind.IMPORT)
"""Kinds whose attributes are all listed in a comment."""


def _attributes(book: Book, element: Element) -> None:
    if element.kind in _WHOLE or (element.kind is Kind.APPLICATION and not is_standard(element)):
        return
    for key, value in element.attrs.items():
        is_tag = key.startswith(("tag.", "value."))
        if key in _SAID or value in (None, "", ()) or (is_tag and _is_told(element, key)):
            continue
        if element.id in book.loops and key.startswith(_OF_LOOPS):
            continue
        book.losses.note(UNSAID_ATTRIBUTE, element, attribute=key, kind=str(element.kind))


_TOLD_TAGS = """
    id text direction unit quantityKind base isConjugated kind propertyPath sourceContext
    targetContext sourcePropertyPath targetPropertyPath refines derived derivedFrom satisfiedBy
    verifiedBy tracedTo master allocatedTo allocatedFrom itemProperty onNestedPort
"""
_TOLD = frozenset(name.lower() for name in _TOLD_TAGS.split())


def _is_told(element: Element, key: str) -> bool:
    """Whether a tag of a stereotype of SysML is said, or has its default."""
    if key.startswith("value."):
        return True
    tag = key.removeprefix("tag.").lower()
    return tag in _TOLD or element.attrs[key] in ("false", False)


# -- edges -------------------------------------------------------------------------------------

_EDGES = frozenset(
    {
        Edge.OWNS,
        Edge.FEATURE,
        Edge.TYPED_BY,
        Edge.SPECIALIZES,
        Edge.SUBSETS,
        Edge.REDEFINES,
        Edge.REALIZES,
        Edge.CONVEYS,
        Edge.FLOW_SOURCE,
        Edge.FLOW_TARGET,
        Edge.REALIZING,
        Edge.END,
        Edge.ROLE,
        Edge.PATH,
        Edge.TRIGGER,
        Edge.GUARD,
        Edge.EFFECT,
        Edge.ENTRY,
        Edge.DO,
        Edge.EXIT,
        Edge.METHOD,
        Edge.CALLS,
        Edge.IN_PARTITION,
        Edge.INSTANCE_OF,
        Edge.CLIENT,
        Edge.SUPPLIER,
        Edge.CLASSIFIER_BEHAVIOR,
        Edge.INCLUDES,
        Edge.APPLIES,
        Edge.SUBJECT,
        Edge.SATISFIES,
        Edge.DERIVES,
        Edge.VERIFIES,
        Edge.REFINES,
        Edge.TRACES,
        Edge.DEPENDS,
        Edge.SEND_EVENT,
        Edge.RECEIVE_EVENT,
    }
)
"""Edges that are written where they are, or follow from what is written."""
_OF_KINDS = {
    Edge.REFERENCES: frozenset(
        {
            Kind.PROPERTY,
            Kind.PORT,
            Kind.COMMENT,
            Kind.CONSTRAINT,
            Kind.IMPORT,
            Kind.SLOT,
            Kind.FACET,
            Kind.GROUP,
            Kind.DOCUMENT,
            Kind.METADATA,
            Kind.DATA_TYPE,
            Kind.ENUMERATION,
            Kind.PSEUDOSTATE,
            Kind.ACTIVITY_PARAMETER,
            Kind.EXTEND,
            Kind.UNIT,
            Kind.QUANTITY_KIND,
            Kind.APPLICATION,
            Kind.VIEW,
        }
    ),
    Edge.REPRESENTS: frozenset({Kind.INSTANCE, Kind.LIFELINE, Kind.PARTITION, Kind.VIEW}),
    Edge.EXTENDS: frozenset({Kind.USE_CASE, Kind.EXTEND}),
    Edge.ALLOCATED_TO: frozenset(Kind),
    Edge.BINDS: frozenset({Kind.PROPERTY, Kind.PORT}),
    Edge.COVERS: frozenset({Kind.OCCURRENCE, Kind.EXECUTION}),
}


def _edges(book: Book) -> None:
    for edge in Edge:
        if edge in _EDGES:
            continue
        kinds = _OF_KINDS.get(edge, frozenset())
        for _, source, target in book.graph.edges(edge):
            one, other = book.graph[source], book.graph[target]
            if one.kind in kinds or one.attrs.get("external") or _is_measure(one, other):
                continue
            if one.id not in book.said:
                continue
            facts = {"edge": str(edge.value), "kind": str(one.kind), "target": str(other.kind)}
            book.losses.note(UNSAID_EDGE, one, **facts)


def _is_measure(one: Element, other: Element) -> bool:
    return one.role in ("unit", "quantity kind") or other.kind in (Kind.UNIT, Kind.QUANTITY_KIND)
