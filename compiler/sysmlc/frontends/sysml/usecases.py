"""Use cases: subject, actors, inclusions, extension points."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.definitions import define
from sysmlc.frontends.sysml.requirements import objective
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering


def use_case(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A use case, of a definition or a usage."""
    special = [one for one in nodes.body_of(node) if one.membership in _READERS]
    low.skipped.update(id(one) for one in special)
    made = define(low, node, owner, Kind.USE_CASE, "")
    for one in special:
        _READERS[one.membership](low, one, made)


def include(low: "Lowering", node: Node, owner: Element | None) -> None:
    """The inclusion of another use case."""
    if owner is None:
        low.unsupported(node)
        return
    kinds = ("ReferenceSubsetting", "FeatureTyping", "Subsetting")
    for found in nodes.references(node, *kinds)[:1]:
        low.refer(Edge.INCLUDES, owner, found)


def _subject(low: "Lowering", node: Node, made: Element) -> None:
    for type_ in types_of(low, node):
        low.later(lambda type_=type_: low.lead(Edge.SUBJECT, made, type_))  # type: ignore[misc]
    if nodes.value_of(node) is not None:
        low.approximated(node, "the value of a subject", "its type")


def _actor(low: "Lowering", node: Node, made: Element) -> None:
    """An association between the use case and the actor (UML 2.5.1 clause 18.1.3).

    One that the model has already is not made again.
    """
    # The ends of associations are there only behind what is done last.
    low.last(lambda: low.last(lambda: _join(low, node, made)))


def _join(low: "Lowering", node: Node, made: Element) -> None:
    actors = [low.element(one) for one in types_of(low, node)]
    for end in low.graph.sources(made, Edge.TYPED_BY):
        for known in low.graph.sources(end, Edge.END):
            ends = low.graph.targets(known, Edge.END)
            if any(low.graph.target(one, Edge.TYPED_BY) in actors for one in ends):
                low.elements[id(node)] = known
                return
    name = nodes.name_of(node)
    joined = low.add(node, Kind.ASSOCIATION, "", low.graph.owner(made))
    for end_name, type_ in (("", made), (name, None)):
        end = low.make(node, Kind.PROPERTY, end_name, joined)
        low.graph.connect(Edge.END, joined, end)
        if type_ is not None:
            low.graph.connect(Edge.TYPED_BY, end, type_)
        else:
            low.later(lambda end=end: _typed(low, node, end))  # type: ignore[misc]


def _typed(low: "Lowering", node: Node, end: Element) -> None:
    for type_ in types_of(low, node):
        low.lead(Edge.TYPED_BY, end, type_)


def _objective(low: "Lowering", node: Node, made: Element) -> None:
    objective(low, node, made)


_READERS = {
    "SubjectMembership": _subject,
    "ActorMembership": _actor,
    "StakeholderMembership": _actor,
    "ObjectiveMembership": _objective,
}


def extension_point(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An event of a use case: an extension point."""
    low.add(node, Kind.EXTENSION_POINT, nodes.name_of(node), owner)
