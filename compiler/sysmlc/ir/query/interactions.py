"""Questions about interactions: what happens, in which order, on which lifeline.

UML 2.5.1 clause 17. The order of the fragments of an interaction is the order in which it owns
them (docs/ir.md); it binds the occurrences on one lifeline.
"""

from collections.abc import Iterator

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

HAPPENINGS = (Kind.OCCURRENCE, Kind.EXECUTION, Kind.FRAGMENT)
USES = ("ref", "part-decomposition")


def lifelines(graph: Graph, interaction: Element) -> list[Element]:
    """The participants, in the order of the model."""
    return [item for item in graph.owned(interaction) if item.kind is Kind.LIFELINE]


def messages(graph: Graph, interaction: Element) -> list[Element]:
    """All messages of the interaction, in the order of the model."""
    return [item for item in graph.owned(interaction) if item.kind is Kind.MESSAGE]


def happenings(graph: Graph, container: Element) -> list[Element]:
    """Occurrences, executions and fragments of an interaction or operand, in their order."""
    return [item for item in graph.owned(container) if item.kind in HAPPENINGS]


def operands(graph: Graph, fragment: Element) -> list[Element]:
    """The operands of a combined fragment, in order."""
    return [item for item in graph.owned(fragment) if item.kind is Kind.OPERAND]


def containers(graph: Graph, interaction: Element) -> Iterator[Element]:
    """The interaction and all operands in it, outer before inner."""
    yield interaction
    for item in graph.subtree(interaction):
        if item.kind is Kind.OPERAND:
            yield item


def covered(graph: Graph, happening: Element) -> list[Element]:
    """The lifelines that it covers."""
    return graph.targets(happening, Edge.COVERS)


def sent(graph: Graph, occurrence: Element) -> Element | None:
    """The message that is sent at the occurrence."""
    return graph.source(occurrence, Edge.SEND_EVENT)


def received(graph: Graph, occurrence: Element) -> Element | None:
    """The message that is received at the occurrence."""
    return graph.source(occurrence, Edge.RECEIVE_EVENT)


def participant(graph: Graph, lifeline: Element) -> Element | None:
    """The part, port or parameter that the lifeline stands for."""
    return graph.target(lifeline, Edge.REPRESENTS)


def type_of(graph: Graph, lifeline: Element) -> Element | None:
    """Type of what the lifeline stands for."""
    represented = participant(graph, lifeline)
    return graph.target(represented, Edge.TYPED_BY) if represented is not None else None
