"""Authors' diagrams of behaviours: the derived drawing without the elements that the author
omitted.
"""

from collections.abc import Callable, Iterable, Iterator

from msgspec.structs import replace

from sysmlc.backends.plantuml import activity, state_machine
from sysmlc.backends.plantuml.author.selection import Selection
from sysmlc.backends.plantuml.views import GraphView, Line, Node, Note
from sysmlc.ir import Element, Graph, Kind

_WHOLE: dict[Kind, Callable[[Graph, Element], GraphView]] = {
    Kind.ACTIVITY: activity.draw_whole,
    Kind.STATE_MACHINE: state_machine.draw_whole,
}


def find_behaviour(choice: Selection, kind: Kind) -> Element | None:
    """Return the behaviour of the frame, else the behaviour that owns the shown elements."""
    graph, about = choice.graph, choice.about
    starts = [*([about] if about else []), *choice.shown]
    candidates = (element for start in starts for element in (start, *graph.ancestors(start)))
    return next((element for element in candidates if element.kind is kind), None)


def build_view(choice: Selection, kind: Kind) -> GraphView:
    """Return the nodes that the author selected, with their content, and the lines between them."""
    about = find_behaviour(choice, kind)
    if about is None:
        return GraphView((), ())
    whole = _WHOLE[kind](choice.graph, about)
    nodes = tuple(_select_nodes(whole.nodes, choice.ids))
    aliases = set(_iter_aliases(nodes))
    return GraphView(
        nodes,
        tuple(line for line in whole.lines if _is_drawn(line, aliases, choice.ids)),
        tuple(_select_notes(whole.notes, aliases, choice.ids)),
    )


def _select_nodes(nodes: Iterable[Node], ids: frozenset[str]) -> Iterator[Node]:
    for node in nodes:
        children = tuple(_select_nodes(node.children, ids))
        if children or not ids.isdisjoint(node.shows):
            yield replace(node, children=children)


def _iter_aliases(nodes: Iterable[Node]) -> Iterator[str]:
    for node in nodes:
        yield node.alias
        yield from _iter_aliases(node.children)


def _is_drawn(line: Line, aliases: set[str], ids: frozenset[str]) -> bool:
    return {line.source, line.target} <= aliases and not ids.isdisjoint(line.shows)


def _select_notes(notes: Iterable[Note], aliases: set[str], ids: frozenset[str]) -> Iterator[Note]:
    for note in notes:
        if not ids.isdisjoint(note.shows):
            yield replace(
                note, targets=tuple(target for target in note.targets if target in aliases)
            )
