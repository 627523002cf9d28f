"""What may be a member of what: variants, verifications, portions, successions, ends."""

from sysmlc.diagnostics import Rule, Sink
from sysmlc.language.checks import member_rules as rules
from sysmlc.language.metaclasses import is_end, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.positional_redefinition import find_own_features
from sysmlc.language.tree import Document, Node, make_subject

_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_SUCCESSIONS = kinds_of("Succession") | {"TransitionUsage"}
_OCCURRENCES = kinds_of("Class") | kinds_of("OccurrenceUsage")
_INTERFACES = kinds_of("InterfaceDefinition") | kinds_of("InterfaceUsage")
_WITH_ENDS = _INTERFACES | kinds_of("FlowDefinition")
_TYPED = frozenset({"AttributeUsage", "MetadataUsage"})
"""Usages whose types are looked at here."""
_VERIFICATIONS = kinds_of("VerificationCaseDefinition") | kinds_of("VerificationCaseUsage")
_ENUMERATIONS = kinds_of("EnumerationDefinition")


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report what ``node`` may not be where it is, and what it may not specialise."""
    owner = node.owner
    if owner is None:
        return
    broken = _as_member(node, owner)
    if broken is None and node.kind in _TYPED:
        broken = _by_itself(model, node)
    if broken is not None:
        place = make_subject(document, node, node.start)
        name = model.name(node) or node.kind
        sink.report(broken, place, name=name, owner=model.name(owner) or owner.kind)


def _as_member(node: Node, owner: Node) -> Rule | None:
    membership = node.membership
    if membership == "VariantMembership":
        return None if _is_variation(owner) else rules.VARIANT_ELSEWHERE
    if membership == "RequirementVerificationMembership":
        return None if _is_objective(owner) else rules.VERIFY_ELSEWHERE
    if membership in _FEATURE_MEMBERSHIPS:
        return _as_feature(node, owner)
    return rules.PORTION_ELSEWHERE if "portionKind" in node.attributes else None


def _as_feature(node: Node, owner: Node) -> Rule | None:
    if _is_variation(owner):
        return rules.NO_VARIANT
    if node.kind in _SUCCESSIONS and owner.attributes.get("isParallel"):
        return rules.PARALLEL
    if "portionKind" in node.attributes and owner.kind not in _OCCURRENCES:
        return rules.PORTION_ELSEWHERE
    if owner.kind not in _WITH_ENDS or not is_end(node):
        return None
    if owner.kind in _INTERFACES:
        is_port = node.kind in ("PortUsage", "ReferenceUsage")
        return None if is_port else rules.END_NO_PORT
    return rules.TOO_MANY_ENDS if find_own_features(owner, "end").index(node) > 1 else None


def _by_itself(model: Model, node: Node) -> Rule | None:
    if node.kind == "MetadataUsage":
        types = model.lookup.generals(node)
        return (
            rules.ABSTRACT_METADATA if any(t.attributes.get("isAbstract") for t in types) else None
        )
    if node.kind == "AttributeUsage" and len(model.lookup.generals(node)) > 1:
        types = model.types(node)
        several = len(types) > 1 and any(one.kind in _ENUMERATIONS for one in types)
        return rules.ENUMERATION_AND_MORE if several else None
    return None


def _is_variation(node: Node) -> bool:
    return bool(node.attributes.get("isVariation")) or node.kind in _ENUMERATIONS


def _is_objective(owner: Node) -> bool:
    case = owner.owner
    return (
        owner.membership == "ObjectiveMembership"
        and case is not None
        and case.kind in _VERIFICATIONS
    )
