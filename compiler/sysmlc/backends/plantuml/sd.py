"""Sequence diagrams: one for each interaction with lifelines (UML 2.5.1 clause 17.8)."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.views import Diagram, Participant, SequenceView
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query import interactions
from sysmlc.support.plantuml_text import label, plain, small, stack

_WIDTH = 24


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All sequence diagrams, in the order of the model."""
    for interaction in graph.of_kind(Kind.INTERACTION):
        lifelines = interactions.lifelines(graph, interaction)
        if lifelines and not interaction.attrs.get("external"):
            yield _diagram(graph, interaction, lifelines)


def _diagram(graph: Graph, interaction: Element, lifelines: list[Element]) -> Diagram:
    from sysmlc.backends.plantuml.sd_steps import steps

    aliases = Aliases()
    participants = tuple(_participant(graph, one, aliases) for one in lifelines)
    whole = graph.qualified_name(interaction)
    features = [item.id for item in graph.owned(interaction) if item.kind in _IN_FRAME]
    return Diagram(
        kind="sd",
        name=whole,
        frame=plain(f"sd {labels.name(interaction)}{labels.signature(graph, interaction)}"),
        heading=("Sequence diagram", whole),
        view=SequenceView(participants, tuple(steps(graph, interaction, aliases))),
        about=interaction.id,
        details=tuple(features),
    )


_IN_FRAME = (Kind.PARAMETER,)


def _participant(graph: Graph, lifeline: Element, aliases: Aliases) -> Participant:
    represented = interactions.participant(graph, lifeline)
    shows = [lifeline.id]
    if represented is not None and represented.owner == lifeline.owner:
        shows.append(represented.id)
    words = small(plain(labels.guillemets(labels.applied(graph, lifeline))))
    return Participant(
        aliases.make(lifeline.id, _name(graph, lifeline), "lifeline"),
        stack([words, label(_title(graph, lifeline), _WIDTH)]),
        "actor" if _is_actor(graph, lifeline) else "participant",
        tuple(shows),
    )


def _title(graph: Graph, lifeline: Element) -> str:
    """``name[selector] : Type`` (UML 2.5.1, 17.3.4)."""
    name = _name(graph, lifeline)
    if lifeline.attrs.get("selector"):
        name += f"[{lifeline.attrs['selector']}]"
    type_ = interactions.type_of(graph, lifeline)
    if type_ is None:
        return name or labels.name(lifeline)
    return f"{name} : {labels.name(type_)}".strip()


def _name(graph: Graph, lifeline: Element) -> str:
    """The name of what it represents; tools number the lifelines themselves."""
    represented = interactions.participant(graph, lifeline)
    if represented is None:
        return lifeline.name.strip()
    is_told = represented.name.strip() or interactions.type_of(graph, lifeline) is not None
    return (represented.name if is_told else lifeline.name).strip()


def _is_actor(graph: Graph, lifeline: Element) -> bool:
    found = (interactions.participant(graph, lifeline), interactions.type_of(graph, lifeline))
    return any(item is not None and item.kind is Kind.ACTOR for item in found)
