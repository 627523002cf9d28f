"""Connectors, interfaces, bindings and flows: ends as feature chains."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import typing, visibility
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import chain, is_around
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import (
    conforms,
    flow_directions,
    role_of,
    runs_both_ways,
    type_of,
)
from sysmlc.ir.query.relations import flow_path


def connector(book: Book, entry: Entry) -> list[Line]:
    """A connector: an interface between ports, a binding, else a connection."""
    element = entry.element
    assert element is not None
    ends = book.graph.targets(element, Edge.END)
    texts = [end_text(book, entry, end) for end in ends]
    book.said.update(end.id for end in ends)
    if len(texts) < 2 or None in texts:
        return book.drop(entry, "end")
    known = [str(text) for text in texts]
    body = _body(book, entry, ends)
    if element.role == "binding connector" and len(known) == 2:
        name = f"binding {quoted(entry.name)} " if entry.name else ""
        return [Line(f"{name}bind {known[0]} = {known[1]}", body)]
    return [Line(_connection(book, entry, ends, known), body)]


def _body(book: Book, entry: Entry, ends: list[Element]) -> list[Line]:
    body = contents(book, entry)
    for end in ends:
        if any(one.kind is not Kind.APPLICATION for one in book.graph.owned(end)):
            book.approximated(end, "what an end of a connector owns", "its own")
    return body


def _connection(book: Book, entry: Entry, ends: list[Element], texts: list[str]) -> str:
    element = entry.element
    assert element is not None
    keyword = "interface" if _joins_ports(book, ends) else "connection"
    types, _ = typing(book, entry.parent, element)
    type_ = book.plan.entry(type_of(book.graph, element))
    if type_ is not None and type_.shape.is_definition:
        keyword = type_.shape.plain
    joined = f"({', '.join(texts)})" if len(texts) > 2 else " to ".join(texts)
    words = [*visibility(book, element)]
    if not entry.name and not types:
        words += ["interface", joined] if keyword == "interface" else ["connect", joined]
        return " ".join(words)
    words += [keyword, quoted(entry.name) if entry.name else ""]
    head = " ".join(word for word in words if word)
    return head + (f" : {', '.join(types)}" if types else "") + f" connect {joined}"


def _joins_ports(book: Book, ends: list[Element]) -> bool:
    roles = [book.plan.entry(role_of(book.graph, end)) for end in ends]
    return all(role is not None and role.shape.keyword == "port" for role in roles)


def end_text(book: Book, entry: Entry, end: Element) -> str | None:
    """One end: its multiplicity, and the chain of features that leads to its role."""
    found = end_chain(book, entry, end)
    given = end.attrs.get("multiplicity")
    if found is None or given is None:
        return found
    return f"[{given}] {found}"


def end_chain(book: Book, entry: Entry, end: Element) -> str | None:
    """The chain from the owner of the connector to the role of one of its ends."""
    role = role_of(book.graph, end)
    if role is None:
        return None
    path = book.graph.targets(end, Edge.PATH)
    steps = [*(one for one in path if one is not role), role]
    first = book.plan.entry(steps[0])
    if first is None or not is_around(book.plan, entry.parent, first):
        return None
    return chain(book.plan, entry.parent, steps)


# -- flows -------------------------------------------------------------------------------------


def item_flow(book: Book, entry: Entry) -> list[Line]:
    """Flows of the items that are conveyed, along the connectors that realise them."""
    element = entry.element
    assert element is not None
    pairs = [one for one in _pairs(book, entry, element) if None not in one]
    if not pairs:
        return _flow_definition(book, entry, element)
    items: list[Element | None] = [*book.graph.targets(element, Edge.CONVEYS)] or [None]
    lines = []
    name = entry.name
    for source, target in pairs:
        for item in items:
            lines.append(_flow(book, entry, name, item, (str(source), str(target))))
            name = ""
    lines[0].body += contents(book, entry)
    return lines


def _flow(book: Book, entry: Entry, name: str, item: Element | None, ends: tuple[str, str]) -> Line:
    element = entry.element
    assert element is not None
    # A flow leads from a feature of one element to a feature of another; else it is a message.
    word = "flow" if all("." in one for one in ends) else "message"
    head = " ".join([*visibility(book, element), word, *([quoted(name)] if name else [])])
    type_ = None if item is None else book.name(entry.parent, element, Edge.CONVEYS, item)
    of = "" if type_ is None else f" of {type_}"
    return Line(f"{head}{of} from {ends[0]} to {ends[1]}")


def _pairs(book: Book, entry: Entry, flow: Element) -> list[tuple[str | None, str | None]]:
    """Chains to the source and the target, for each connector that realises the flow."""
    graph = book.graph
    source, target = graph.target(flow, Edge.FLOW_SOURCE), graph.target(flow, Edge.FLOW_TARGET)
    item = graph.target(flow, Edge.CONVEYS)
    found = []
    for realizing in graph.targets(flow, Edge.REALIZING):
        ends = graph.targets(realizing, Edge.END) if realizing.kind is Kind.CONNECTOR else []
        if len(ends) == 2:
            first, last = _directed(book, ends, source, target)
            at = book.plan.entry(realizing)
            if at is not None and _is_around(entry, at):
                pair = (_at(book, entry, first, item), _at(book, entry, last, item))
                found += [pair, pair[::-1]] if runs_both_ways(graph, flow) else [pair]
    if found or source is None or target is None:
        return found
    steps = [book.plan.entry(one) for one in (source, target)]
    if all(one is not None and one.shape.is_usage for one in steps):
        ways = [
            [*flow_path(graph, flow, Edge.FLOW_SOURCE), source],
            [*flow_path(graph, flow, Edge.FLOW_TARGET), target],
        ]
        chains = [chain(book.plan, entry.parent, way) for way in ways]
        return [(chains[0], chains[1])]
    return []


def _is_around(entry: Entry, connector: Entry) -> bool:
    """Whether names of the connector's owner are found from the flow."""
    return any(connector.parent is one for one in entry.above)


def _directed(
    book: Book, ends: list[Element], source: Element | None, target: Element | None
) -> tuple[Element, Element]:
    roles = [role_of(book.graph, end) for end in ends]
    is_turned = source is not None and source is not target and roles[1] in (source,)
    is_turned = is_turned or (target is not None and source is not target and roles[0] is target)
    return (ends[1], ends[0]) if is_turned else (ends[0], ends[1])


def _at(book: Book, entry: Entry, end: Element, item: Element | None) -> str | None:
    """Chain to an end, and to the one flow property of its port that fits what is conveyed."""
    found = end_chain(book, entry, end)
    role = role_of(book.graph, end)
    if found is None or role is None or role.kind is not Kind.PORT or item is None:
        return found
    fitting = [
        one
        for one, _ in flow_directions(book.graph, role)
        if (type_ := type_of(book.graph, one)) is not None
        and (conforms(book.graph, item, type_) or conforms(book.graph, type_, item))
    ]
    known = book.plan.entry(fitting[0]) if len(fitting) == 1 else None
    return found if known is None else f"{found}.{quoted(known.name)}"


def _flow_definition(book: Book, entry: Entry, flow: Element) -> list[Line]:
    """A flow between classifiers is a definition of flows."""
    graph = book.graph
    ends = [graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    names = [None if e is None else book.name(entry, flow, Edge.FLOW_SOURCE, e) for e in ends]
    shapes = [book.plan.entry(one) for one in ends]
    if None in names or any(one is None or not one.shape.is_definition for one in shapes):
        return book.drop(entry, "flow ends")
    body = [Line(f"ref :>> payload : {name}") for name in book.names(entry, flow, Edge.CONVEYS)[:1]]
    if len(graph.targets(flow, Edge.CONVEYS)) > 1:
        book.lost(flow, "conveys")
    pairs = zip(("source", "target"), names, strict=True)
    body += [Line(f"end ref {word} : {name}") for word, name in pairs]
    head = f"flow def {quoted(entry.name)}" if entry.name else "flow def"
    return [Line(head, body + annotations.of(book, entry) + book.members(entry))]
