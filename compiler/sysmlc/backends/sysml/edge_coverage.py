"""Edges of the graph that no relation of SysML v2 text expresses."""

from collections.abc import Iterator

from sysmlc.backends.sysml.compatibility import (
    is_incompatible,
    is_invalid_subset,
    is_lifeline_subset,
    is_without_parameters,
)
from sysmlc.backends.sysml.library import find_quantity
from sysmlc.backends.sysml.references import is_accessible
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind

_EXPRESSED_EDGES = frozenset(
    {
        Edge.OWNS,
        Edge.FEATURE,
        Edge.TYPED_BY,
        Edge.SPECIALIZES,
        Edge.SUBSETS,
        Edge.REDEFINES,
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
        Edge.CALLS,
        Edge.IN_PARTITION,
        Edge.INSTANCE_OF,
        Edge.CLIENT,
        Edge.SUPPLIER,
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
"""Edges that the text expresses for all elements, or that follow from other edges."""
_KINDS_THAT_EXPRESS = {
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
    Edge.EXTENDS: frozenset({Kind.USE_CASE, Kind.EXTEND}),
    Edge.ALLOCATED_TO: frozenset(Kind),
    Edge.BINDS: frozenset({Kind.PROPERTY, Kind.PORT}),
    Edge.COVERS: frozenset({Kind.OCCURRENCE, Kind.EXECUTION}),
}
"""Kinds of elements for which the text expresses an edge."""


def iter_unexpressed_edges(writer: Writer, element: Element) -> Iterator[tuple[Edge, Element]]:
    """Yield the edges of an element of the model that nothing else in the text expresses."""
    if element.attrs.get("external"):
        return
    for edge in _EDGES_TO_CHECK:
        is_unexpressed = _CHECKS.get(edge)
        if is_unexpressed is None and element.kind in _KINDS_THAT_EXPRESS.get(edge, ()):
            continue
        for target in writer.graph.targets(element, edge):
            if is_unexpressed is not None and not is_unexpressed(writer, element, target):
                continue
            if not _is_about_measure(element, target):
                yield edge, target


def _is_about_measure(source: Element, target: Element) -> bool:
    is_unit = source.role in ("unit", "quantity kind")
    return is_unit or target.kind in (Kind.UNIT, Kind.QUANTITY_KIND)


# -- edges that the text expresses in some cases only --------------------------------------------


def _is_unexpressed_method(writer: Writer, operation: Element, method: Element) -> bool:
    is_same_action = writer.plan.find(operation) is writer.plan.find(method)
    return not is_same_action and is_without_parameters(writer.graph, operation, method)


def _is_unexpressed_behavior(writer: Writer, _owner: Element, behaviour: Element) -> bool:
    """Whether a classifier behaviour is neither performed (actions) nor exhibited (states)."""
    member = writer.plan.find(behaviour)
    return member is not None and member.shape.usage_keyword not in ("action", "state")


def has_own_measure(writer: Writer, type_: Element, measure: Element) -> bool:
    """Whether the unit or quantity kind of a value type is an instance in the text.

    Metadata refers to it, unless the type is a quantity of ISQ: this states the unit by name.
    """
    is_instance = measure.kind is Kind.INSTANCE and writer.plan.find(measure) is not None
    return is_instance and find_quantity(writer.graph, type_) is None


def _is_unexpressed_reference(writer: Writer, source: Element, target: Element) -> bool:
    """Whether the text lacks a reference; a named constraint states all but its owner."""
    if source.kind is Kind.DATA_TYPE:
        return has_own_measure(writer, source, target)
    if source.kind is Kind.CONSTRAINT:
        return target.id == source.owner or not source.name
    return source.kind not in _KINDS_THAT_EXPRESS[Edge.REFERENCES]


def _is_unexpressed_subset(writer: Writer, feature: Element, subsetted: Element) -> bool:
    return is_invalid_subset(writer.plan, feature, subsetted)


def _is_unexpressed_redefinition(writer: Writer, feature: Element, redefined: Element) -> bool:
    return is_incompatible(writer.plan, feature, redefined)


def _is_unexpressed_realization(_writer: Writer, source: Element, _target: Element) -> bool:
    """Whether the text lacks a realization: classes and features have a dependency for it."""
    return source.kind is Kind.INSTANCE


def _is_unexpressed_call(writer: Writer, action: Element, target: Element) -> bool:
    """Whether an action uses a feature that is not accessible where the action stands."""
    member, feature = writer.plan.find(action), writer.plan.find(target)
    if action.kind is not Kind.ACTION or member is None or feature is None:
        return False
    return not _is_call(action) and not is_accessible(writer.plan, member, feature)


def _is_unexpressed_represented(writer: Writer, source: Element, target: Element) -> bool:
    """Whether a lifeline cannot subset the feature that it represents."""
    member = writer.plan.find(source)
    if source.kind is not Kind.LIFELINE or member is None:
        return source.kind not in (Kind.INSTANCE, Kind.LIFELINE, Kind.PARTITION, Kind.VIEW)
    return not is_lifeline_subset(writer.plan, member, target)


def _is_call(action: Element) -> bool:
    """Whether an action calls, sends, accepts or starts its target."""
    return action.subkind.partition("-")[0] in ("call", "send", "broadcast", "accept", "start")


def _is_never_expressed(_writer: Writer, _source: Element, _target: Element) -> bool:
    return True


_CHECKS = {
    Edge.METHOD: _is_unexpressed_method,
    Edge.CLASSIFIER_BEHAVIOR: _is_unexpressed_behavior,
    Edge.REFERENCES: _is_unexpressed_reference,
    Edge.SUBSETS: _is_unexpressed_subset,
    Edge.REDEFINES: _is_unexpressed_redefinition,
    Edge.REALIZES: _is_unexpressed_realization,
    Edge.APPLIES: _is_never_expressed,
    Edge.CALLS: _is_unexpressed_call,
    Edge.REPRESENTS: _is_unexpressed_represented,
}
_EDGES_TO_CHECK = tuple(
    dict.fromkeys((*(edge for edge in Edge if edge not in _EXPRESSED_EDGES), *_CHECKS))
)
