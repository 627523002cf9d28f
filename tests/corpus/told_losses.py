"""Which differences between a model and what is read of its text the back end has told."""

from sysmlc.ir import Edge, Kind

_DETAILS = (Kind.COMMENT, Kind.CONSTRAINT, Kind.IMPORT, Kind.TRIGGER, Kind.SLOT, Kind.CONNECTOR_END)


def untold(graph, told, changes):
    """Changes of elements of which no loss was told; ``told`` has the losses by id."""
    names = {}
    for one in graph:
        names.setdefault(graph.qualified_name(one), []).append(one)
    return [one for one in changes if not _is_told(graph, told, names, one)]


def _is_told(graph, told, names, change):
    if change.old is not None:
        near = _near(graph, graph[change.old.id])
    else:
        owners = names.get(change.owner, [])
        near = [near for one in owners for near in (*_near(graph, one), *_inside(graph, one))]
    return any(one.id in told for one in near)


def _inside(graph, owner):
    """What an element owns, and flows that leave it: their text stands beside their source."""
    for one in graph.owned(owner):
        yield one
        for node in (one, *graph.owned(one)):
            yield from graph.sources(node, Edge.FLOW_SOURCE)


def _near(graph, element):
    """The element, what says something of it, and what it is left out with."""
    yield element
    yield from graph.sources(element, Edge.SUBJECT)
    yield from (one for one in graph.owned(element) if one.kind in _DETAILS)
    for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
        yield from graph.targets(element, edge)
    yield from graph.ancestors(element)
