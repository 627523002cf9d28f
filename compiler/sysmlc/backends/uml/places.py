"""The feature of its owner in which an element stands (UML 2.5.1, as UML2 5.0 serialises it)."""

from collections.abc import Callable

from sysmlc.backends.uml.names import camel
from sysmlc.ir import Edge, Element, Graph, Kind

_CLASSIFIERS = frozenset(
    {
        Kind.CLASS,
        Kind.COMPONENT,
        Kind.INTERFACE,
        Kind.DATA_TYPE,
        Kind.ENUMERATION,
        Kind.SIGNAL,
        Kind.ASSOCIATION,
        Kind.STEREOTYPE,
        Kind.USE_CASE,
        Kind.ACTOR,
        Kind.ITEM,
        Kind.REQUIREMENT,
    }
)
_BEHAVIOURS = frozenset({Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION, Kind.TEST_CASE})
_PACKAGES = frozenset({Kind.PACKAGE, Kind.PROFILE})
_PACKAGED = frozenset(
    {
        Kind.PACKAGE,
        Kind.PROFILE,
        Kind.INSTANCE,
        Kind.UNIT,
        Kind.QUANTITY_KIND,
        Kind.ITEM_FLOW,
        Kind.EXPRESSION,
        Kind.OBSERVATION,
        Kind.GENERALIZATION_SET,
        Kind.DEPENDENCY,
    }
)
"""Kinds that only packages and components own."""
_NODES = frozenset(
    {
        Kind.ACTION,
        Kind.CONTROL,
        Kind.OBJECT_NODE,
        Kind.DATA_STORE,
        Kind.ACTIVITY_PARAMETER,
        Kind.STRUCTURED,
    }
)
_FEATURES: dict[Kind, str] = {
    Kind.COMMENT: "ownedComment",
    Kind.OPERATION: "ownedOperation",
    Kind.RECEPTION: "ownedReception",
    Kind.PARAMETER: "ownedParameter",
    Kind.PARAMETER_SET: "ownedParameterSet",
    Kind.ENUMERATION_LITERAL: "ownedLiteral",
    Kind.CONNECTOR: "ownedConnector",
    Kind.CONNECTOR_END: "end",
    Kind.SLOT: "slot",
    Kind.CONTROL_FLOW: "edge",
    Kind.OBJECT_FLOW: "edge",
    Kind.REGION: "region",
    Kind.STATE: "subvertex",
    Kind.FINAL_STATE: "subvertex",
    Kind.TRANSITION: "transition",
    Kind.LIFELINE: "lifeline",
    Kind.MESSAGE: "message",
    Kind.OCCURRENCE: "fragment",
    Kind.EXECUTION: "fragment",
    Kind.FRAGMENT: "fragment",
    Kind.OPERAND: "operand",
    Kind.GENERAL_ORDERING: "generalOrdering",
    Kind.EXTEND: "extend",
    Kind.EXTENSION_POINT: "extensionPoint",
    Kind.COLLABORATION_USE: "collaborationUse",
    Kind.TEMPLATE_PARAMETER: "ownedParameter",
    Kind.TEMPLATE_BINDING: "templateBinding",
    Kind.TEMPLATE_SUBSTITUTION: "parameterSubstitution",
}
"""Features of kinds that stand in one feature only, whatever owns them."""
_IMPORTS = {"element": "elementImport", "merge": "packageMerge"}
_CONTAINED = {
    Kind.EXTEND: "condition",
    Kind.PARAMETER_SET: "condition",
    Kind.OPERAND: "guard",
    Kind.FRAGMENT: "invariant",
}
"""Where a constraint stands that is not an owned rule of a namespace."""
_STATE = {
    Edge.ENTRY: "entry",
    Edge.DO: "doActivity",
    Edge.EXIT: "exit",
    Edge.EFFECT: "effect",
}
_CLASS_LIKE = frozenset({Kind.CLASS, Kind.COMPONENT, Kind.STEREOTYPE, Kind.REQUIREMENT})


def place(graph: Graph, owner: Element, element: Element) -> str:
    """Feature of ``owner`` that holds the element; empty when UML knows none."""
    if owner.kind is Kind.TEMPLATE_PARAMETER and element.kind is not Kind.COMMENT:
        is_default = owner.attrs.get("default") == element.id
        return "ownedDefault" if is_default else "ownedParameteredElement"
    if owner.kind is Kind.TEMPLATE_SUBSTITUTION and element.kind is not Kind.COMMENT:
        return "ownedActual"
    known = _FEATURES.get(element.kind)
    return known or _special(graph, owner, element)


def _special(graph: Graph, owner: Element, element: Element) -> str:
    kind = element.kind
    if kind in (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY):
        return _property(graph, owner, element)
    if kind in _BEHAVIOURS:
        return _behaviour(graph, owner, element)
    if kind in _PACKAGED:
        return _packaged(owner, element)
    if kind in _CLASSIFIERS:
        return _classifier(owner, element)
    return _PARTS.get(kind, _nowhere)(owner, element)


def _property(graph: Graph, owner: Element, element: Element) -> str:
    if element.subkind == "variable":
        return "variable"
    if owner.kind is Kind.ASSOCIATION:
        is_end = element in graph.targets(owner, Edge.END)
        plain = owner.subkind != "association-class"
        return "ownedEnd" if is_end or plain else "ownedAttribute"
    if owner.kind in (Kind.PROPERTY, Kind.PORT):
        return "qualifier"
    return "" if owner.kind in _PACKAGES else "ownedAttribute"


def _constraint(owner: Element, element: Element) -> str:
    if owner.kind in (Kind.ACTION, Kind.STRUCTURED):
        return {"precondition": "localPrecondition", "postcondition": "localPostcondition"}.get(
            element.subkind, "ownedRule"
        )
    if owner.kind is Kind.FRAGMENT and owner.subkind != "state-invariant":
        return "ownedRule"
    return _CONTAINED.get(owner.kind, "ownedRule")


def _packaged(owner: Element, element: Element) -> str:
    subkind = element.subkind
    if subkind == "role-binding":
        return "roleBinding"
    if subkind == "component-realization" and owner.kind is Kind.COMPONENT:
        return "realization"
    if subkind == "substitution" and owner.kind in _CLASSIFIERS:
        return "substitution"
    if subkind in ("manifestation", "deployment") and owner.kind not in _PACKAGES:
        return subkind
    return "packagedElement" if owner.kind in (*_PACKAGES, Kind.COMPONENT) else ""


def _behaviour(graph: Graph, owner: Element, element: Element) -> str:
    if owner.kind in (Kind.STATE, Kind.FINAL_STATE, Kind.TRANSITION):
        held = (f for edge, f in _STATE.items() if element in graph.targets(owner, edge))
        return next(held, "")
    if owner.kind in _PACKAGES:
        return "packagedElement"
    if owner.kind is Kind.INTERFACE and element.subkind == "protocol":
        return "protocol"
    holds = owner.kind in (*_CLASS_LIKE, *_BEHAVIOURS, Kind.USE_CASE, Kind.ACTOR)
    return "ownedBehavior" if holds or owner.subkind == "association-class" else ""


def _classifier(owner: Element, element: Element) -> str:
    if owner.kind in (*_PACKAGES, Kind.COMPONENT):
        return "packagedElement"
    if owner.subkind == "artifact" and element.subkind == "artifact":
        return "nestedArtifact"
    if element.kind is Kind.USE_CASE and owner.kind not in _CLASS_LIKE:
        return "ownedUseCase"
    is_node = element.subkind in ("node", "device", "execution-environment")
    if is_node and owner.subkind in ("node", "device", "execution-environment"):
        return "nestedNode"
    holds = (*_CLASS_LIKE, *_BEHAVIOURS, Kind.INTERFACE)
    return "nestedClassifier" if owner.kind in holds else ""


def _import(_owner: Element, element: Element) -> str:
    return _IMPORTS.get(element.subkind, "packageImport")


def _partition(owner: Element, _element: Element) -> str:
    return "subpartition" if owner.kind is Kind.PARTITION else "group"


def _pseudostate(owner: Element, element: Element) -> str:
    if element.subkind == "connection-point":
        return "connection"
    return "subvertex" if owner.kind is Kind.REGION else "connectionPoint"


def _trigger(_owner: Element, element: Element) -> str:
    return "deferrableTrigger" if element.attrs.get("deferred") else "trigger"


def _gate(owner: Element, _element: Element) -> str:
    if owner.kind is not Kind.FRAGMENT:
        return "formalGate"
    return "actualGate" if owner.subkind in ("ref", "part-decomposition") else "cfragmentGate"


def _nowhere(_owner: Element, _element: Element) -> str:
    return ""


def _pin(owner: Element, element: Element) -> str:
    """Its own name of the feature, else one by its direction."""
    if element.subkind:
        return camel(element.subkind)
    is_out = element.attrs.get("direction") == "out"
    if owner.kind is Kind.STRUCTURED:
        return "structuredNodeOutput" if is_out else "structuredNodeInput"
    if owner.subkind in ("", "opaque"):
        return "outputValue" if is_out else "inputValue"
    return "result" if is_out else "argument"


def _node(owner: Element, element: Element) -> str:
    if owner.kind is Kind.PIN:
        return "fromAction"
    if owner.kind is Kind.INTERACTION:
        return "action"
    if element.kind is Kind.STRUCTURED and owner.kind is Kind.ACTIVITY:
        return "group" if element.subkind == "interruptible" else "structuredNode"
    return "executableNode" if owner.subkind == "sequence" else "node"


_PARTS: dict[Kind, Callable[[Element, Element], str]] = {
    Kind.CONSTRAINT: _constraint,
    Kind.IMPORT: _import,
    Kind.PIN: _pin,
    Kind.PARTITION: _partition,
    Kind.PSEUDOSTATE: _pseudostate,
    Kind.TRIGGER: _trigger,
    Kind.GATE: _gate,
    **dict.fromkeys(_NODES, _node),
}
