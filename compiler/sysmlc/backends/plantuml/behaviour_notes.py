"""Comments and constraints of a behaviour as notes beside its nodes."""

from collections.abc import Iterable

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.views import Aliases, Note
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import format_label, join_rows, wrap_lines

_WIDTH = 48
_NOTED = (Kind.COMMENT, Kind.CONSTRAINT)
_FEATURES = (Kind.PROPERTY, Kind.PORT, Kind.OPERATION, Kind.RECEPTION)


def make_notes(
    graph: Graph,
    behaviour: Element,
    aliases: Aliases,
    with_parameters: bool = False,
    inside: Iterable[Element] | None = None,
) -> tuple[Note, ...]:
    """Return notes for the comments *inside* the behaviour, and for its own constraints and
    features.
    """
    texts = tuple(
        _make_note(graph, item, aliases)
        for item in (graph.subtree(behaviour) if inside is None else inside)
        if item.kind in _NOTED
        and _is_note(item, behaviour)
        and format_label(labels.note_text(item))
    )
    kinds = (Kind.PARAMETER, *_FEATURES) if with_parameters else _FEATURES
    return (*_make_feature_note(graph, behaviour, aliases, kinds), *texts)


def _make_feature_note(
    graph: Graph, behaviour: Element, aliases: Aliases, kinds: tuple[Kind, ...]
) -> tuple[Note, ...]:
    """Return one note with the attributes and operations of the behaviour, which is a class as
    well.
    """
    members = [item for item in graph.owned(behaviour) if item.kind in kinds]
    if not members:
        return ()
    rows = [row for item in members for row in wrap_lines(_format_feature(graph, item), _WIDTH)]
    alias = aliases.make(f"features of {behaviour.id}", "", "note")
    return (Note(alias, join_rows(rows), (), tuple(item.id for item in members)),)


def _format_feature(graph: Graph, item: Element) -> str:
    if item.kind is Kind.OPERATION:
        return labels.operation(graph, item)
    return labels.feature(graph, item)


def _is_note(item: Element, behaviour: Element) -> bool:
    return item.kind is Kind.COMMENT or item.owner == behaviour.id


def _make_note(graph: Graph, item: Element, aliases: Aliases) -> Note:
    about = [target.id for target in graph.targets(item, Edge.REFERENCES)]
    about = about or ([item.owner] if item.owner else [])
    targets = tuple(aliases[id] for id in about if id in aliases)
    alias = aliases.make(item.id, "", "note")
    return Note(alias, format_label(labels.note_text(item), _WIDTH), targets, (item.id,))
