"""The feature of the owner that contains an element (UML 2.5.1, as UML2 5.0 serialises it)."""

from collections.abc import Callable

from sysmlc.backends.uml.features import to_camel_case
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
"""Features of kinds that are in the same feature of every owner."""
_IMPORT_FEATURES = {"element": "elementImport", "merge": "packageMerge"}
_CONSTRAINT_FEATURES = {
    Kind.EXTEND: "condition",
    Kind.PARAMETER_SET: "condition",
    Kind.OPERAND: "guard",
    Kind.FRAGMENT: "invariant",
}
"""The feature for a constraint by the owner's kind; other owners have owned rules."""
_STATE_BEHAVIOURS = {
    Edge.ENTRY: "entry",
    Edge.DO: "doActivity",
    Edge.EXIT: "exit",
    Edge.EFFECT: "effect",
}
_NODE_SUBKINDS = ("node", "device", "execution-environment")
_CLASS_LIKE = frozenset({Kind.CLASS, Kind.COMPONENT, Kind.STEREOTYPE, Kind.REQUIREMENT})


def find_containing_feature(graph: Graph, owner: Element, element: Element) -> str:
    """Return the feature of *owner* that contains *element*; empty if UML has none."""
    if owner.kind is Kind.TEMPLATE_PARAMETER and element.kind is not Kind.COMMENT:
        is_default = owner.attrs.get("default") == element.id
        return "ownedDefault" if is_default else "ownedParameteredElement"
    if owner.kind is Kind.TEMPLATE_SUBSTITUTION and element.kind is not Kind.COMMENT:
        return "ownedActual"
    return _FEATURES.get(element.kind) or _find_by_owner(graph, owner, element)


def _find_by_owner(graph: Graph, owner: Element, element: Element) -> str:
    """Return the feature for an element whose feature depends on its owner."""
    kind = element.kind
    if kind in (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY):
        return _find_for_property(graph, owner, element)
    if kind in _BEHAVIOURS:
        return _find_for_behaviour(graph, owner, element)
    if kind in _PACKAGED:
        return _find_for_packaged_element(owner, element)
    if kind in _CLASSIFIERS:
        return _find_for_classifier(owner, element)
    return _FINDERS[kind](owner, element) if kind in _FINDERS else ""


def _find_for_property(graph: Graph, owner: Element, element: Element) -> str:
    if element.subkind == "variable":
        return "variable"
    if owner.kind is Kind.ASSOCIATION:
        is_end = element in graph.targets(owner, Edge.END)
        is_plain = owner.subkind != "association-class"
        return "ownedEnd" if is_end or is_plain else "ownedAttribute"
    if owner.kind in (Kind.PROPERTY, Kind.PORT):
        return "qualifier"
    return "" if owner.kind in _PACKAGES else "ownedAttribute"


def _find_for_constraint(owner: Element, element: Element) -> str:
    if owner.kind in (Kind.ACTION, Kind.STRUCTURED):
        features = {"precondition": "localPrecondition", "postcondition": "localPostcondition"}
        return features.get(element.subkind, "ownedRule")
    if owner.kind is Kind.FRAGMENT and owner.subkind != "state-invariant":
        return "ownedRule"
    return _CONSTRAINT_FEATURES.get(owner.kind, "ownedRule")


def _find_for_packaged_element(owner: Element, element: Element) -> str:
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


def _find_for_behaviour(graph: Graph, owner: Element, element: Element) -> str:
    if owner.kind in (Kind.STATE, Kind.FINAL_STATE, Kind.TRANSITION):
        for edge, feature in _STATE_BEHAVIOURS.items():
            if element in graph.targets(owner, edge):
                return feature
        return ""
    if owner.kind in _PACKAGES:
        return "packagedElement"
    if owner.kind is Kind.INTERFACE and element.subkind == "protocol":
        return "protocol"
    is_behaviored = owner.kind in (*_CLASS_LIKE, *_BEHAVIOURS, Kind.USE_CASE, Kind.ACTOR)
    return "ownedBehavior" if is_behaviored or owner.subkind == "association-class" else ""


def _find_for_classifier(owner: Element, element: Element) -> str:
    if owner.kind in (*_PACKAGES, Kind.COMPONENT):
        return "packagedElement"
    if owner.subkind == "artifact" and element.subkind == "artifact":
        return "nestedArtifact"
    if element.kind is Kind.USE_CASE and owner.kind not in _CLASS_LIKE:
        return "ownedUseCase"
    if element.subkind in _NODE_SUBKINDS and owner.subkind in _NODE_SUBKINDS:
        return "nestedNode"
    is_namespace = owner.kind in (*_CLASS_LIKE, *_BEHAVIOURS, Kind.INTERFACE)
    return "nestedClassifier" if is_namespace else ""


def _find_for_pseudostate(owner: Element, element: Element) -> str:
    if element.subkind == "connection-point":
        return "connection"
    return "subvertex" if owner.kind is Kind.REGION else "connectionPoint"


def _find_for_gate(owner: Element, _element: Element) -> str:
    if owner.kind is not Kind.FRAGMENT:
        return "formalGate"
    return "actualGate" if owner.subkind in ("ref", "part-decomposition") else "cfragmentGate"


def _find_for_pin(owner: Element, element: Element) -> str:
    """Return the feature that the subkind names, else one for the direction of the pin."""
    if element.subkind:
        return to_camel_case(element.subkind)
    is_output = element.attrs.get("direction") == "out"
    if owner.kind is Kind.STRUCTURED:
        return "structuredNodeOutput" if is_output else "structuredNodeInput"
    if owner.subkind in ("", "opaque"):
        return "outputValue" if is_output else "inputValue"
    return "result" if is_output else "argument"


def _find_for_node(owner: Element, element: Element) -> str:
    if owner.kind is Kind.PIN:
        return "fromAction"
    if owner.kind is Kind.INTERACTION:
        return "action"
    if element.kind is Kind.STRUCTURED and owner.kind is Kind.ACTIVITY:
        return "group" if element.subkind == "interruptible" else "structuredNode"
    return "executableNode" if owner.subkind == "sequence" else "node"


_FINDERS: dict[Kind, Callable[[Element, Element], str]] = {
    Kind.CONSTRAINT: _find_for_constraint,
    Kind.IMPORT: lambda _, element: _IMPORT_FEATURES.get(element.subkind, "packageImport"),
    Kind.PIN: _find_for_pin,
    Kind.PARTITION: lambda owner, _: "subpartition" if owner.kind is Kind.PARTITION else "group",
    Kind.PSEUDOSTATE: _find_for_pseudostate,
    Kind.TRIGGER: lambda _, element: (
        "deferrableTrigger" if element.attrs.get("deferred") else "trigger"
    ),
    Kind.GATE: _find_for_gate,
    **dict.fromkeys(_NODES, _find_for_node),
}
