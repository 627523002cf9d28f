"""Requirements with subject, text and constraints; what satisfies and verifies them."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.frontends.sysml.connections import steps_of_value
from sysmlc.frontends.sysml.constraints import constraint
from sysmlc.frontends.sysml.definitions import flags, generalize
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node, Reference

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)


def requirement(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A requirement, of a definition or a usage: its short name is its id, its doc its text."""
    if node.membership == "RequirementVerificationMembership":
        verify(low, node, owner)
        return
    if node.membership == "ObjectiveMembership":
        objective(low, node, owner)
        return
    texts = list(nodes.members(node, "Documentation"))
    text = str(texts[0].attributes.get("body", "")).strip() if texts else ""
    given = annotations.said(node, "Requirement", "id")
    attrs: dict[str, AttrValue] = {"req_id": str(given or node.short_name or ""), "text": text}
    name = node.name or nodes.name_of(node)
    made = low.add(node, Kind.CLASS, name, owner, role="requirement", **(attrs | flags(node)))
    generalize(low, node, made)
    low.skipped.update(id(one) for one in texts[:1])
    for one in nodes.body_of(node):
        _member(low, one, made)


def _member(low: "Lowering", node: Node, made: Element) -> None:
    if node.membership == "SubjectMembership":
        for type_ in types_of(low, node):
            low.later(lambda type_=type_: low.lead(Edge.SUBJECT, made, type_))  # type: ignore[misc]
        low.elements[id(node)] = made
        if nodes.value_of(node) is not None:
            low.approximated(node, "the value of a subject", "its type")
    elif node.membership == "RequirementConstraintMembership":
        constraint(low, node, made)
        edge = Edge.ASSUMES if node.role == "assumption" else Edge.REQUIRES
        one = low.element(node)
        if one is not None and node.role == "assumption":
            low.graph.connect(edge, made, one)
    else:
        low.lower(node, made)


# -- satisfy and verify ------------------------------------------------------------------------


def satisfy(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A satisfaction: by what it names, else by what it stands in."""
    attrs: dict[str, AttrValue] = {"role": "satisfy", "subkind": "abstraction"}
    made = low.add(node, Kind.DEPENDENCY, node.name or "", _package(low, owner), **attrs)
    annotations.texts(low, node, made, "a satisfaction")
    kinds = ("ReferenceSubsetting", "Subsetting", "FeatureTyping")
    found = next((one for kind in kinds if (one := nodes.reference(node, kind))), None)
    low.later(lambda: low.lead(Edge.SUPPLIER, made, _satisfied(found)))
    by = next(nodes.held(node, "SubjectMembership"), None)
    value = None if by is None else nodes.value_of(by)
    low.later(lambda: _client(low, made, owner, value))
    if node.attributes.get("isNegated"):
        low.approximated(node, "'not satisfy'", "'satisfy'")


def _satisfied(found: Reference | None) -> Node | None:
    """The requirement that a satisfaction names; a satisfaction beside it has the same name."""
    target, seen = None if found is None else found.target, set[int]()
    while target is not None and target.kind == _SATISFY and id(target) not in seen:
        seen.add(id(target))
        following = nodes.target(target, "ReferenceSubsetting")
        target = target if following is None else following
    return target


_SATISFY = "SatisfyRequirementUsage"


def _client(low: "Lowering", made: Element, owner: Element | None, value: Node | None) -> None:
    if value is not None:
        steps = steps_of_value(value)
        low.lead(Edge.CLIENT, made, steps[-1] if steps else None)
    elif owner is not None:
        low.graph.connect(Edge.CLIENT, made, owner)


def _package(low: "Lowering", owner: Element | None) -> Element | None:
    """The nearest package: a relation belongs to none of its ends."""
    while owner is not None and owner.kind not in _PACKAGES:
        owner = low.graph.owner(owner)
    return owner


def objective(low: "Lowering", node: Node, owner: Element | None) -> None:
    """What a case is for: requirements that it verifies, and texts."""
    low.skipped.add(id(node))
    if nodes.reference(node, "FeatureTyping", "ReferenceSubsetting", "Subsetting"):
        low.approximated(node, "the type of an objective", "nothing")
    for one in nodes.body_of(node):
        if one.membership == "RequirementVerificationMembership":
            verify(low, one, owner)
        elif nodes.is_text(one):
            low.lower(one, owner)
        elif one.membership != "SubjectMembership":
            low.approximated(one, "a part of an objective", "nothing")


def verify(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A verification of a requirement by the case that it stands in."""
    attrs: dict[str, AttrValue] = {"role": "verify", "subkind": "abstraction"}
    made = low.add(node, Kind.DEPENDENCY, node.name or "", _package(low, owner), **attrs)
    if owner is not None:
        low.graph.connect(Edge.CLIENT, made, owner)
    found = nodes.reference(node, "ReferenceSubsetting", "FeatureTyping", "Subsetting")
    low.refer(Edge.SUPPLIER, made, found)
    annotations.texts(low, node, made, "a verification")
