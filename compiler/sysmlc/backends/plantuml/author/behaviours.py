"""Authors' diagrams of behaviours: the derived drawing, without what the author left out."""

from collections.abc import Callable, Iterable, Iterator

from msgspec.structs import replace

from sysmlc.backends.plantuml import activity, state_machine
from sysmlc.backends.plantuml.author.selection import Choice
from sysmlc.backends.plantuml.views import GraphView, Line, Node, Note
from sysmlc.ir import Element, Graph, Kind

_WHOLE: dict[Kind, Callable[[Graph, Element], GraphView]] = {
    Kind.ACTIVITY: activity.whole,
    Kind.STATE_MACHINE: state_machine.whole,
}


def behaviour(choice: Choice, kind: Kind) -> Element | None:
    """The behaviour that the diagram is about: the frame's, else that of what it shows."""
    graph, about = choice.graph, choice.about
    starts = [*([about] if about else []), *choice.shown]
    every = (one for start in starts for one in (start, *graph.ancestors(start)))
    return next((one for one in every if one.kind is kind), None)


def view(choice: Choice, kind: Kind) -> GraphView:
    """The nodes that the author chose, with what they hold, and the lines between them."""
    about = behaviour(choice, kind)
    if about is None:
        return GraphView((), ())
    whole = _WHOLE[kind](choice.graph, about)
    nodes = tuple(_kept(whole.nodes, choice.ids))
    aliases = set(_aliases(nodes))
    return GraphView(
        nodes,
        tuple(line for line in whole.lines if _is_drawn(line, aliases, choice.ids)),
        tuple(_notes(whole.notes, aliases, choice.ids)),
    )


def _kept(nodes: Iterable[Node], ids: frozenset[str]) -> Iterator[Node]:
    for node in nodes:
        children = tuple(_kept(node.children, ids))
        if children or not ids.isdisjoint(node.shows):
            yield replace(node, children=children)


def _aliases(nodes: Iterable[Node]) -> Iterator[str]:
    for node in nodes:
        yield node.alias
        yield from _aliases(node.children)


def _is_drawn(line: Line, aliases: set[str], ids: frozenset[str]) -> bool:
    return {line.source, line.target} <= aliases and not ids.isdisjoint(line.shows)


def _notes(notes: Iterable[Note], aliases: set[str], ids: frozenset[str]) -> Iterator[Note]:
    for note in notes:
        if not ids.isdisjoint(note.shows):
            yield replace(note, targets=tuple(one for one in note.targets if one in aliases))
