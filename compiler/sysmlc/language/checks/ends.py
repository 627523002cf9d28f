"""Ends of associations and connectors: one type, two of them, something at each."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of
from sysmlc.language.checks.member_rules import TOO_MANY_ENDS
from sysmlc.language.metaclasses import is_a, is_end, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.positional_redefinition import find_own_features
from sysmlc.language.tree import Node, Relation

END_TYPE = rule(
    "SM269",
    "end-types",
    Severity.ERROR,
    "the end '{name}' of '{owner}' has {count} types and needs one",
    help="keep one type, or let it specialise the inherited one",
)
TOO_FEW = rule(
    "SM270",
    "connects-too-few",
    Severity.ERROR,
    "'{name}' connects {count} element{s}",
    help="name what it connects at two ends at least",
)
NO_FLOW_END = rule(
    "SM271",
    "flow-end-without-dot",
    Severity.ERROR,
    "'{name}' does not say what of the flow's end it belongs to",
    help="name the element, a dot, and its feature",
)

_ASSOCIATIONS = kinds_of("Association")
_CONNECTORS = kinds_of("Connector") - kinds_of("Flow")
_SUCCESSIONS = kinds_of("Succession")
_PORTS = frozenset({"PortUsage", "ReferenceUsage"})
"""Ends of interfaces that are ports; others are told as that."""
_FLOWS = kinds_of("FlowDefinition")


def check_types(model: Model, node: Node) -> Iterator[Found]:
    """Report ends of an association with several types."""
    for end in filter(is_end, node.members):
        if node.kind == "InterfaceDefinition" and end.kind not in _PORTS:
            continue
        typings = [one for one in end.relations if one.kind == "FeatureTyping"]
        crosses = any(one.kind == "CrossSubsetting" for one in end.relations)
        count = len(typings if crosses else model.types(end))
        if count > 1:
            facts = {"name": name_of(model, end), "owner": name_of(model, node)}
            yield Found(END_TYPE, end.start, {**facts, "count": str(count)})


def check_related(model: Model, node: Node) -> Iterator[Found]:
    """Report a connector with ends of its own that names less than two related elements."""
    ends = find_own_features(node, "end")
    if not ends or node.attributes.get("isAbstract") or node.kind in _SUCCESSIONS:
        return
    ends += model.lookup.features_of_role(node, "end")
    count = len({end for end in ends if _is_related(end)})
    if count < 2:
        facts = {"name": name_of(model, node), "count": str(count)}
        yield Found(TOO_FEW, node.start, {**facts, "s": "" if count == 1 else "s"})


def _is_related(end: Node) -> bool:
    return any(relation.kind == "ReferenceSubsetting" for relation in end.relations)


def check_flow_end(model: Model, node: Node) -> Iterator[Found]:
    """Report an end of a flow without a dot that names a feature of no other feature.

    Of a usage it is that usage which the flow ends at.
    """
    if _is_related(node):
        return
    for member in node.members:
        for relation in member.relations:
            if relation.kind == "Redefinition" and _is_held_by_a_type(relation):
                text = "::".join(relation.reference.chain[0])
                yield Found(NO_FLOW_END, node.start, {"name": text})


def _is_held_by_a_type(relation: Relation) -> bool:
    target = relation.reference.target
    owner = target.owner if target is not None else None
    return owner is not None and not is_a(owner.kind, "Feature")


def check_flow(model: Model, node: Node) -> Iterator[Found]:
    """Report a definition of flows that inherits more than two ends."""
    ends = model.lookup.features_of_role(node, "end")
    if len(ends) > 2 and len(find_own_features(node, "end")) <= 2:
        facts = {"name": name_of(model, ends[2]), "owner": name_of(model, node)}
        yield Found(TOO_MANY_ENDS, node.start, facts)


CHECKS = (
    (_ASSOCIATIONS, check_types),
    (_CONNECTORS, check_related),
    (frozenset({"FlowEnd"}), check_flow_end),
    (_FLOWS, check_flow),
)
