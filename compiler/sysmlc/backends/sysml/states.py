"""States, pseudostates and transitions."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.behaviours import held
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.conditions import condition
from sysmlc.backends.sysml.declarations import visibility
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.events import trigger
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import named
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind

_KEYWORDS = {
    "choice": "choice",
    "junction": "junction",
    "fork": "forking",
    "join": "joining",
    "shallow-history": "shallowHistory",
    "deep-history": "deepHistory",
    "entry-point": "entryPoint",
    "exit-point": "exitPoint",
    "connection-point": "connectionPoint",
    "terminate": "termination",
}
_POINTS = ("entry-point", "exit-point", "connection-point")
"""Pseudostates that states and state machines own themselves (UML 2.5.1, 14.2.4)."""
_WIDTH = 80


def state(book: Book, entry: Entry) -> list[Line]:
    """A state with its actions; one with several regions is parallel."""
    element = entry.element
    assert element is not None
    head = " ".join([*visibility(book, element), "state", quoted(entry.name)])
    for machine in book.graph.targets(element, Edge.CALLS):
        other = book.plan.entry(machine)
        name = book.name(entry.parent, element, Edge.CALLS, machine)
        if name is not None and other is not None:
            head += f" {':' if other.shape.is_definition else ':>'} {name}"
    regions = [one for one in book.graph.owned(element) if one.kind is Kind.REGION]
    body = annotations.of(book, entry)
    for word, edge in (("entry", Edge.ENTRY), ("do", Edge.DO), ("exit", Edge.EXIT)):
        body += [held(book, entry, word, one) for one in book.graph.targets(element, edge)]
    body += book.members(entry)
    return [Line(f"{head} parallel" if len(regions) > 1 else head, body)]


def region(book: Book, entry: Entry) -> list[Line]:
    """One of several regions: a state of its own that runs beside the others."""
    return [Line(f"state {quoted(entry.name)}", contents(book, entry))]


def pseudostate(book: Book, entry: Entry) -> list[Line]:
    """A pseudostate: a state with a keyword of ours."""
    element = entry.element
    assert element is not None
    keyword = _KEYWORDS.get(element.subkind, "choice")
    mark = f"#{book.ours(entry.parent, keyword)}"
    owner = book.graph.owner(element)
    if owner is not None and owner.kind is Kind.STATE and element.subkind not in _POINTS:
        book.approximated(element, "a pseudostate that no region owns", "one of the only region")
    body = contents(book, entry)
    for one in book.graph.targets(element, Edge.REFERENCES):
        name = book.name(entry, element, Edge.REFERENCES, one)
        body += [] if name is None else [Line(f"ref :> {name}")]
    return [Line(f"{mark} state {quoted(entry.name)}", body)]


def transition(book: Book, entry: Entry) -> list[Line]:
    """A transition for each of its triggers; the first has the name."""
    element = entry.element
    assert element is not None
    triggers = book.graph.targets(element, Edge.TRIGGER)
    book.said.update(one.id for one in triggers)
    ends = [_end(book, entry, element, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    if None in ends:
        return book.drop(entry, "flow ends")
    body = annotations.of(book, entry)
    if element.subkind not in ("", "external"):
        body.append(annotations.ours(book, entry, "Kind", {"name": element.subkind}))
    body += _owned(book, entry)
    lines = []
    accepted = [trigger(book, entry, one) for one in triggers] or [""]
    name = entry.name
    for one in accepted:
        lines.append(_line(book, entry, name, (str(ends[0]), str(ends[1])), one, body))
        name, body = "", []
    return lines


def _owned(book: Book, entry: Entry) -> list[Line]:
    """What a transition owns besides its effect, its guard and its triggers."""
    return [line for one in entry.members for line in book.member(one)]


def _line(
    book: Book, entry: Entry, name: str, ends: tuple[str, str], accepted: str, body: list[Line]
) -> Line:
    element = entry.element
    assert element is not None
    words = [*visibility(book, element), "transition", quoted(name) if name else ""]
    parts = [" ".join(word for word in words if word), f"first {ends[0]}"]
    if not accepted and len(parts[0]) == len("transition") and "guard" not in element.attrs:
        effects = book.graph.targets(element, Edge.EFFECT)
        if ends[0] == "start" and not effects and not body:
            return Line(f"first start then {ends[1]}")
    parts += [accepted] if accepted else []
    guard = element.attrs.get("guard")
    if guard is not None and str(guard).strip() != "else":
        parts.append(f"if {condition(book, entry, element, str(guard))}")
    elif guard is not None:
        parts.append(f"if {_otherwise(book, entry, element)}")
    return _with_effect(book, entry, parts, f"then {ends[1]}", body)


def _with_effect(book: Book, entry: Entry, parts: list[str], end: str, body: list[Line]) -> Line:
    element = entry.element
    assert element is not None
    effects = book.graph.targets(element, Edge.EFFECT)
    done = held(book, entry, "do", effects[0]) if effects else None
    if done is not None and done.body:
        return Line(_joined([*parts, done.head], ""), done.body, tail=end)
    parts += [] if done is None else [done.head]
    return Line(_joined(parts, end), body)


def _joined(parts: list[str], end: str) -> str:
    whole = [*parts, end] if end else parts
    text = " ".join(whole)
    if len(text) <= _WIDTH:
        return text
    return "\n".join(whole)


def _otherwise(book: Book, entry: Entry, element: Element) -> str:
    """The condition that no other transition from the same vertex may be taken."""
    source = book.graph.target(element, Edge.FLOW_SOURCE)
    others = [] if source is None else book.graph.sources(source, Edge.FLOW_SOURCE)
    texts = [
        f"({condition(book, entry, one, str(one.attrs['guard']))})"
        for one in others
        if one is not element and one.attrs.get("guard") not in (None, "else")
    ]
    return f"not ({' or '.join(texts)})" if texts else "true"


def _end(book: Book, entry: Entry, element: Element, edge: Edge) -> str | None:
    vertex = book.graph.target(element, edge)
    if vertex is None:
        return None
    if book.plan.entry(vertex) is not None:
        return named(book.plan, entry.parent, vertex)
    book.said.add(vertex.id)
    word = "start" if vertex.kind is Kind.PSEUDOSTATE else "done"
    for above in book.graph.ancestors(vertex):
        holder = book.plan.entry(above)
        if holder is None:
            continue
        if holder is entry.parent:
            return word
        name = named(book.plan, entry.parent, holder.element)
        return None if name is None else f"{name}.{word}"
    return word
