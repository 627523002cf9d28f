"""Behaviours as wholes: actions, states, occurrences and verification cases."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import definition_head
from sysmlc.backends.sysml.effects import statements
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.texts import opaque_lines
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind

_OWN_WORD = {"action": "perform", "state": "exhibit"}


def behaviour(book: Book, entry: Entry) -> list[Line]:
    """A behaviour that is a member of a package or a classifier.

    What its classifier runs is performed or exhibited by it. Those of states and transitions
    are written with these.
    """
    element = entry.element
    assert element is not None
    if _is_held(book, element):
        return []
    head = definition_head(book, entry)
    owner = book.graph.owner(element)
    if owner is not None and element in book.graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR):
        word = _OWN_WORD.get(entry.shape.keyword)
        head.prefixes += [word] if word else []
    specified = book.graph.sources(element, Edge.METHOD)
    if not specified and element.kind is Kind.STATE_MACHINE and _regions(book, element) > 1:
        head.value = " parallel"
    return [Line(head.text(), inside(book, entry, element))]


def _regions(book: Book, element: Element) -> int:
    return sum(one.kind is Kind.REGION for one in book.graph.owned(element))


_HOLDING = (Edge.ENTRY, Edge.DO, Edge.EXIT, Edge.EFFECT)


def _is_held(book: Book, element: Element) -> bool:
    """Whether a state or a transition owns the behaviour and writes it in its place."""
    owner = book.graph.owner(element)
    return owner is not None and any(
        element in book.graph.targets(owner, edge) for edge in _HOLDING
    )


def inside(book: Book, entry: Entry, element: Element) -> list[Line]:
    """What stands between the braces of a behaviour."""
    body = contents(book, entry)
    objectives = book.objectives.pop(id(entry), [])
    if objectives:
        body.insert(0, Line("objective", objectives))
    return body + body_lines(book, entry, element)


def body_lines(book: Book, entry: Entry, element: Element) -> list[Line]:
    """The text of an opaque behaviour: one action after the other, else in its own language."""
    found = statements(book, entry, element)
    if found is None:
        return opaque_lines(book, entry, element)
    return sequence(found)


def sequence(found: list[str]) -> list[Line]:
    """Actions one after the other."""
    first, *rest = found
    return [Line(first), *(Line(f"then {one}") for one in rest)]


def classified(book: Book, entry: Entry, element: Element) -> list[Line]:
    """Classifier behaviours that stand elsewhere."""
    lines = []
    for one in book.graph.targets(element, Edge.CLASSIFIER_BEHAVIOR):
        other = book.plan.entry(one)
        if other is None or other.parent is entry:
            continue
        name = book.name(entry, element, Edge.CLASSIFIER_BEHAVIOR, one)
        word = _OWN_WORD.get(other.shape.plain)
        if name is not None and word is not None:
            end = f"{other.shape.plain} : {name}" if other.shape.is_definition else name
            lines.append(Line(f"{word} {end}"))
    return lines


def held(book: Book, scope: Entry, word: str, behaviour_: Element) -> Line:
    """The entry, do or exit action of a state, or the effect of a transition."""
    entry = book.plan.entry(behaviour_)
    owner = scope.element
    if entry is None or owner is None or behaviour_.owner != owner.id:
        return _performed(book, scope, word, behaviour_)
    book.said.add(behaviour_.id)
    name = quoted(entry.name) if entry.name else ""
    found = None if entry.members else statements(book, entry, behaviour_)
    if found is not None and len(found) == 1 and not found[0].startswith("perform"):
        start = f"action {name} " if name else ""
        return Line(f"{word} {start}{found[0]}")
    if found is not None and len(found) == 1 and not name:
        return Line(f"{word} {found[0].removeprefix('perform ')}")
    body = inside(book, entry, behaviour_)
    if entry.shape.plain == "action":
        return Line(f"{word} action {name}".rstrip(), body)
    inner = Line(f"{entry.shape.plain} {name}".rstrip(), body)
    return Line(f"{word} action", [inner])


def _performed(book: Book, scope: Entry, word: str, behaviour_: Element) -> Line:
    """A behaviour that stands elsewhere."""
    name = book.name(scope, behaviour_, Edge.CALLS, behaviour_)
    entry = book.plan.entry(behaviour_)
    if name is None or entry is None:
        return Line(f"{word} action")
    return Line(f"{word} action : {name}" if entry.shape.is_definition else f"{word} {name}")
