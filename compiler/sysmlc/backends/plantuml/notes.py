"""Comments and constraints of a behaviour as notes beside its nodes."""

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.text import label
from sysmlc.backends.plantuml.views import Note
from sysmlc.ir import Edge, Element, Graph, Kind

_WIDTH = 48


def notes(graph: Graph, behaviour: Element, aliases: Aliases) -> tuple[Note, ...]:
    """Notes for the comments inside the behaviour and the constraints it owns directly."""
    return tuple(
        _note(graph, item, aliases)
        for item in graph.subtree(behaviour)
        if _is_note(item, behaviour) and label(_text(item))
    )


def _is_note(item: Element, behaviour: Element) -> bool:
    if item.kind is Kind.CONSTRAINT:
        return item.owner == behaviour.id
    return item.kind is Kind.COMMENT


def _text(item: Element) -> str:
    if item.kind is Kind.CONSTRAINT:
        return labels.condition(item)
    return str(item.attrs.get("body", item.name))


def _note(graph: Graph, item: Element, aliases: Aliases) -> Note:
    about = [target.id for target in graph.targets(item, Edge.REFERENCES)]
    about = about or ([item.owner] if item.owner else [])
    targets = tuple(aliases[id] for id in about if id in aliases)
    alias = aliases.make(item.id, "", "note")
    return Note(alias, label(_text(item), _WIDTH), targets, (item.id,))
