"""Match of differences between a model and its text with the losses that the back end reports."""

from sysmlc.ir import Edge, Kind

_DETAILS = (Kind.COMMENT, Kind.CONSTRAINT, Kind.IMPORT, Kind.TRIGGER, Kind.SLOT, Kind.CONNECTOR_END)


def find_unreported(graph, losses, changes):
    """Return the changes that are near no element with a loss; *losses* maps element ids."""
    by_name = {}
    for element in graph:
        by_name.setdefault(graph.qualified_name(element), []).append(element)
    return [change for change in changes if not _is_reported(graph, losses, by_name, change)]


def _is_reported(graph, losses, by_name, change):
    if change.aspect == "trigger" and change.after == f"{change.before} s":
        return True  # nothing is lost: a number without a unit is in seconds
    if change.old is not None:
        return any(element.id in losses for element in _iter_near(graph, graph[change.old.id]))
    return any(
        element.id in losses
        for owner in by_name.get(change.owner, [])
        for element in (*_iter_near(graph, owner), *_iter_inside(graph, owner))
    )


def _iter_inside(graph, owner):
    """Yield owned elements, and flows that leave them: their text stands beside their source."""
    for child in graph.owned(owner):
        yield child
        for node in (child, *graph.owned(child)):
            yield from graph.sources(node, Edge.FLOW_SOURCE)


def _iter_near(graph, element):
    """Yield the element, its details and owners, and the ends without which it is omitted."""
    yield element
    yield from graph.sources(element, Edge.SUBJECT)
    yield from (child for child in graph.owned(element) if child.kind in _DETAILS)
    for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
        yield from graph.targets(element, edge)
    yield from graph.ancestors(element)
