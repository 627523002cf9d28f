"""Entries about connectors: item flows with their direction (SysML 1.6 clause 9.3.2.5)."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Kind, derived_id
from sysmlc.ir.query import ends, role_of
from sysmlc.overlay.model import ConnectorEntry, FlowEntry, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import CONNECTOR, FEATURE, TYPE, Finder, normalise_guid
from sysmlc.support.suggestions import did_you_mean

_Ends = tuple[list[Element], list[Element]]


def add_flows(finder: Finder, entry: ConnectorEntry) -> None:
    """Add the item flows of a connector."""
    connector = finder.find_entry(entry.key, CONNECTOR)
    if connector is None:
        return
    for flow in entry.flows:
        sides = _find_ends(finder, connector, flow)
        item = finder.find_term(flow.item, TYPE)
        if sides is not None and item is not None:
            _add_flow(finder, connector, flow, item, sides)


def _add_flow(
    finder: Finder, connector: Element, flow: FlowEntry, item: Element, end_sides: _Ends
) -> None:
    graph = finder.graph
    sources, targets = _find_features(finder, end_sides)
    direction = ">".join(",".join(element.id for element in side) for side in (sources, targets))
    id = derived_id(connector.id, f"item flow:{item.id}:{direction}")
    owners = (element.id for element in graph.ancestors(connector) if element.kind is Kind.PACKAGE)
    item_flow = finder.ensure_element(
        id, Kind.ITEM_FLOW, "", next(owners, None), flow.spot, origin=connector.id, role="item flow"
    )
    graph.connect(Edge.CONVEYS, item_flow, item)
    graph.connect(Edge.REALIZING, item_flow, connector)
    for edge, side in ((Edge.FLOW_SOURCE, sources), (Edge.FLOW_TARGET, targets)):
        for element in side:
            graph.connect(edge, item_flow, element)


def _find_features(finder: Finder, end_sides: _Ends) -> _Ends:
    """Return the ports or parts at both sides.

    If two parts of the same type are connected at the same port, the result has the parts, because
    the port would not show the direction.
    """
    sides = [[_role_or_end(finder, end) for end in side] for side in end_sides]
    if len(end_sides[0]) == 1 and sides[0] == sides[1]:
        sides = [[_part_or_role(finder, end) for end in side] for side in end_sides]
    return sides[0], sides[1]


def _role_or_end(finder: Finder, end: Element) -> Element:
    return role_of(finder.graph, end) or end


def _part_or_role(finder: Finder, end: Element) -> Element:
    path = finder.graph.targets(end, Edge.PATH)
    return path[-1] if path else _role_or_end(finder, end)


# -- ends --------------------------------------------------------------------------------------


def _find_ends(finder: Finder, connector: Element, flow: FlowEntry) -> _Ends | None:
    """Return the source and target ends of a flow; a two-way flow has both ends on each side."""
    connector_ends = [end for end in ends(finder.graph, connector) if role_of(finder.graph, end)]
    if flow.is_both:
        return (
            (connector_ends, connector_ends)
            if _require_two(finder, connector, flow, connector_ends)
            else None
        )
    stated = [_find_end(finder, connector_ends, word) for word in (flow.source, flow.target)]
    if None in (end for end, word in zip(stated, (flow.source, flow.target), strict=True) if word):
        return None
    source, target = stated
    source = source or _find_other(connector_ends, target)
    target = target or _find_other(connector_ends, source)
    if source is None or target is None or source is target:
        _require_two(finder, connector, flow, [end for end in (source, target) if end][:1])
        return None
    return [source], [target]


def _find_other(connector_ends: list[Element], end: Element | None) -> Element | None:
    remaining = [candidate for candidate in connector_ends if candidate is not end]
    return remaining[0] if len(remaining) == 1 else None


def _require_two(
    finder: Finder, connector: Element, flow: FlowEntry, named_ends: list[Element]
) -> bool:
    if len(named_ends) == 2:
        return True
    name = finder.path_of(connector)
    finder.report(rules.MISSING_FLOW_END, flow.item, item=flow.item.text, connector=name)
    return False


def _find_end(finder: Finder, connector_ends: list[Element], word: Term | None) -> Element | None:
    """Return the end with this port, part, path or id; report an unknown or ambiguous word."""
    if word is None:
        return None
    spellings = {end.id: list(_list_spellings(finder, end)) for end in connector_ends}
    matches = [end for end in connector_ends if word.text in spellings[end.id]]
    if not matches:
        matches = [end for end in connector_ends if _has_id(finder, end, word.text)]
    if len(matches) == 1:
        return matches[0]
    longest = [max(names, key=len) for names in spellings.values()]
    advice = did_you_mean(word.text, longest)
    rule = rules.AMBIGUOUS_END if matches else rules.UNKNOWN_END
    finder.report(rule, word, end=word.text, listed=" and ".join(longest), advice=advice)
    return None


def _list_spellings(finder: Finder, end: Element) -> Iterator[str]:
    """Yield ``st/p_sIn``, ``st.p_sIn``, ``p_sIn`` and ``st`` for port p_sIn of part st."""
    steps = [*finder.graph.targets(end, Edge.PATH), _role_or_end(finder, end)]
    names = [step.name for step in steps]
    for separator in ("/", "."):
        yield from (separator.join(names[start:]) for start in range(len(names)))
        yield from (separator.join(names[:stop]) for stop in range(1, len(names)))


def _has_id(finder: Finder, end: Element, word: str) -> bool:
    steps = [end, *finder.graph.targets(end, Edge.PATH), _role_or_end(finder, end)]
    if any(normalise_guid(word) == normalise_guid(step.id) for step in steps):
        return True
    return any(element in steps for element in finder.find_named(word, FEATURE))
