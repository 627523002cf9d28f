"""Interactions: lifelines, messages, and the interaction fragments in their order.

UML 2.5.1 clause 17. The order of the fragments of an interaction is the order in which it owns
them (docs/ir.md); it binds the occurrences on one lifeline.
"""

from collections.abc import Iterator

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

INTERACTION_FRAGMENTS = (Kind.OCCURRENCE, Kind.EXECUTION, Kind.FRAGMENT)
INTERACTION_USES = ("ref", "part-decomposition")
"""Subkinds of a fragment that refers to another interaction (UML 2.5.1, 17.7)."""


def lifelines(graph: Graph, interaction: Element) -> list[Element]:
    """Return the lifelines, in the order of the model."""
    return [element for element in graph.owned(interaction) if element.kind is Kind.LIFELINE]


def messages(graph: Graph, interaction: Element) -> list[Element]:
    """Return all messages of the interaction, in the order of the model."""
    return [element for element in graph.owned(interaction) if element.kind is Kind.MESSAGE]


def interaction_fragments(graph: Graph, container: Element) -> list[Element]:
    """Return the occurrences, executions and fragments of an interaction or operand, in order."""
    return [element for element in graph.owned(container) if element.kind in INTERACTION_FRAGMENTS]


def operands(graph: Graph, fragment: Element) -> list[Element]:
    """Return the operands of a combined fragment, in order."""
    return [element for element in graph.owned(fragment) if element.kind is Kind.OPERAND]


def iter_containers(graph: Graph, interaction: Element) -> Iterator[Element]:
    """Iterate over the interaction and all operands in it, outer before inner."""
    yield interaction
    for element in graph.subtree(interaction):
        if element.kind is Kind.OPERAND:
            yield element


def covered_lifelines(graph: Graph, fragment: Element) -> list[Element]:
    """Return the lifelines that an interaction fragment covers."""
    return graph.targets(fragment, Edge.COVERS)


def sent_message(graph: Graph, occurrence: Element) -> Element | None:
    """Return the message that is sent at the occurrence, or None."""
    return graph.source(occurrence, Edge.SEND_EVENT)


def received_message(graph: Graph, occurrence: Element) -> Element | None:
    """Return the message that is received at the occurrence, or None."""
    return graph.source(occurrence, Edge.RECEIVE_EVENT)


def participant(graph: Graph, lifeline: Element) -> Element | None:
    """Return the part, port or parameter that the lifeline represents, or None."""
    return graph.target(lifeline, Edge.REPRESENTS)


def type_of(graph: Graph, lifeline: Element) -> Element | None:
    """Return the type of the part, port or parameter that the lifeline represents, or None."""
    represented = participant(graph, lifeline)
    return graph.target(represented, Edge.TYPED_BY) if represented is not None else None
