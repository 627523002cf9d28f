"""Item flows on connectors, each with the way that it runs (SysML 1.6 clause 9.3.2.5)."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Kind, derived_id
from sysmlc.ir.query import ends, role_of
from sysmlc.overlay.model import ConnectorEntry, FlowEntry, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import CONNECTOR, FEATURE, TYPE, Finder, plain
from sysmlc.support.suggestions import did_you_mean

_Ends = tuple[list[Element], list[Element]]


def add_flows(finder: Finder, entry: ConnectorEntry) -> None:
    """Add the item flows of a connector."""
    connector = finder.entry(entry.key, CONNECTOR)
    if connector is None:
        return
    for flow in entry.flows:
        joined = _ends(finder, connector, flow)
        item = finder.term(flow.item, TYPE)
        if joined is not None and item is not None:
            _add(finder, connector, flow, item, joined)


def _add(finder: Finder, connector: Element, flow: FlowEntry, item: Element, joined: _Ends) -> None:
    graph = finder.graph
    sources, targets = _features(finder, joined)
    way = ">".join(",".join(one.id for one in side) for side in (sources, targets))
    id = derived_id(connector.id, f"item flow:{item.id}:{way}")
    owners = (one.id for one in graph.ancestors(connector) if one.kind is Kind.PACKAGE)
    made = finder.add(
        id, Kind.ITEM_FLOW, "", next(owners, None), flow.spot, origin=connector.id, role="item flow"
    )
    graph.connect(Edge.CONVEYS, made, item)
    graph.connect(Edge.REALIZING, made, connector)
    for edge, side in ((Edge.FLOW_SOURCE, sources), (Edge.FLOW_TARGET, targets)):
        for one in side:
            graph.connect(edge, made, one)


def _features(finder: Finder, joined: _Ends) -> _Ends:
    """Ports or parts at both sides. One port of two parts would not tell which way it flows."""
    sides = [[_role(finder, end) for end in side] for side in joined]
    if len(joined[0]) == 1 and sides[0] == sides[1]:
        sides = [[_part(finder, end) for end in side] for side in joined]
    return sides[0], sides[1]


def _role(finder: Finder, end: Element) -> Element:
    return role_of(finder.graph, end) or end


def _part(finder: Finder, end: Element) -> Element:
    path = finder.graph.targets(end, Edge.PATH)
    return path[-1] if path else _role(finder, end)


# -- ends --------------------------------------------------------------------------------------


def _ends(finder: Finder, connector: Element, flow: FlowEntry) -> _Ends | None:
    """Ends that the flow starts from and leads to, both for one that runs both ways."""
    attached = [end for end in ends(finder.graph, connector) if role_of(finder.graph, end)]
    if flow.is_both:
        return (attached, attached) if _are_two(finder, connector, flow, attached) else None
    given = [_end(finder, attached, word) for word in (flow.source, flow.target)]
    if None in (one for one, word in zip(given, (flow.source, flow.target), strict=True) if word):
        return None
    source, target = given
    source = source or _other(attached, target)
    target = target or _other(attached, source)
    if source is None or target is None or source is target:
        _are_two(finder, connector, flow, [one for one in (source, target) if one][:1])
        return None
    return [source], [target]


def _other(attached: list[Element], end: Element | None) -> Element | None:
    rest = [one for one in attached if one is not end]
    return rest[0] if len(rest) == 1 else None


def _are_two(finder: Finder, connector: Element, flow: FlowEntry, found: list[Element]) -> bool:
    if len(found) == 2:
        return True
    name = finder.path(connector)
    finder.report(rules.NO_TWO_ENDS, flow.item, item=flow.item.text, connector=name)
    return False


def _end(finder: Finder, attached: list[Element], word: Term | None) -> Element | None:
    """The end that a word means: its port or part, the path to it, or the id of one."""
    if word is None:
        return None
    spelt = {end.id: list(_spellings(finder, end)) for end in attached}
    found = [end for end in attached if word.text in spelt[end.id]]
    if not found:
        found = [end for end in attached if _has_id(finder, end, word.text)]
    if len(found) == 1:
        return found[0]
    longest = [max(names, key=len) for names in spelt.values()]
    advice = did_you_mean(word.text, longest)
    rule = rules.END_OF_BOTH if found else rules.ONTO_NOTHING
    finder.report(rule, word, end=word.text, listed=" and ".join(longest), advice=advice)
    return None


def _spellings(finder: Finder, end: Element) -> Iterator[str]:
    """``st/p_sIn``, ``st.p_sIn``, ``p_sIn`` and ``st`` for port p_sIn of part st."""
    steps = [*finder.graph.targets(end, Edge.PATH), _role(finder, end)]
    names = [step.name for step in steps]
    for sign in ("/", "."):
        yield from (sign.join(names[start:]) for start in range(len(names)))
        yield from (sign.join(names[:stop]) for stop in range(1, len(names)))


def _has_id(finder: Finder, end: Element, word: str) -> bool:
    steps = [end, *finder.graph.targets(end, Edge.PATH), _role(finder, end)]
    if any(plain(word) == plain(step.id) for step in steps):
        return True
    return any(found in steps for found in finder.named(word, FEATURE))
