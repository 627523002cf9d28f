"""The order of members: as in the model, but documentation first, and behaviours as they run."""

from sysmlc.backends.sysml.entry import Entry
from sysmlc.ir import Edge, Element, Graph, Kind

_GROUPS = {
    Kind.IMPORT: 0,
    Kind.COMMENT: 1,
    Kind.PARAMETER: 2,
    Kind.ACTIVITY_PARAMETER: 2,
    Kind.PIN: 2,
    Kind.PROPERTY: 3,
    Kind.OBJECT_NODE: 4,
    Kind.DATA_STORE: 4,
    Kind.OBJECT_FLOW: 7,
}
_LATER = 6
_INITIAL = 5


def in_order(graph: Graph, entry: Entry) -> list[Entry]:
    """The members of a namespace as they are written."""
    plain = entry.shape.plain
    if plain == "state":
        return _of_states(graph, sorted(entry.members, key=_is_text))
    if plain in ("action", "verification"):
        return sorted(entry.members, key=_group)
    return sorted(entry.members, key=_is_text)


def _is_text(entry: Entry) -> int:
    kind = None if entry.element is None else entry.element.kind
    return {Kind.IMPORT: 0, Kind.COMMENT: 1}.get(kind, 2) if kind is not None else 2


def _group(entry: Entry) -> int:
    if entry.shape.keyword == "start":
        return _INITIAL
    return _LATER if entry.element is None else _GROUPS.get(entry.element.kind, _LATER)


def _of_states(graph: Graph, members: list[Entry]) -> list[Entry]:
    """Transitions stand behind the state that they leave, that from the start before all."""
    known = {one.element.id for one in members if one.element is not None}
    leaving: dict[str, list[Entry]] = {}
    first: list[Entry] = []
    rest: list[Entry] = []
    for one in members:
        if one.element is None or one.element.kind is not Kind.TRANSITION:
            rest.append(one)
            continue
        source = graph.target(one.element, Edge.FLOW_SOURCE)
        if source is not None and source.id in known:
            leaving.setdefault(source.id, []).append(one)
        else:
            (first if _is_initial(source) else rest).append(one)
    number = next((n for n, one in enumerate(rest) if _is_vertex(one)), len(rest))
    ordered = [*rest[:number], *first, *rest[number:]]
    return [each for one in ordered for each in (one, *leaving.get(_id(one), ()))]


def _is_initial(source: Element | None) -> bool:
    return source is not None and source.kind is Kind.PSEUDOSTATE and source.subkind == "initial"


def _is_vertex(entry: Entry) -> bool:
    return entry.shape.keyword == "state"


def _id(entry: Entry) -> str:
    return "" if entry.element is None else entry.element.id
