"""Constraints, and expressions that are conditions or texts of another language."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import visibility
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.expressions import expression
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import qualified
from sysmlc.backends.sysml.texts import opaque_lines
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind

_KEYWORDS = {
    "precondition": "precondition",
    "postcondition": "postcondition",
    "body": "bodyCondition",
    "invariant": "invariant",
}


def constraint(book: Book, entry: Entry) -> list[Line]:
    """A constraint that holds; its body as an expression, else in its own language."""
    element = entry.element
    assert element is not None
    if _is_guard(book, element):
        return []
    above = entry.parent
    result = _result(book, entry, element)
    is_definition = above is not None and above.shape.keyword == "constraint def"
    if is_definition and result and not entry.name and _is_only(book, element):
        return [Line("", text=[result])]
    word = "require" if above is not None and above.shape.keyword == "requirement" else "assert"
    if above is None or above.shape.keyword in ("package", "metadata def", "enum def"):
        word = ""
    mark = _KEYWORDS.get(element.subkind)
    marks = [f"#{book.ours(entry.parent, mark)}"] if mark else []
    name = quoted(entry.name) if entry.name else ""
    marked = [word, *marks] if word == "require" else [*marks, word]
    if above is not None and above.shape.plain.split()[:1] == ["port"]:
        # What a port has inside is no part of it (SysML v2, 8.3.12).
        marked.insert(0, "ref")
    words = [*visibility(book, element), *marked, "constraint", name]
    body = annotations.of(book, entry) + book.members(entry)
    body += [Line("", text=[result])] if result else opaque_lines(book, entry, element)
    head = " ".join(one for one in words if one)
    lines = [Line(head, body, is_short=len(body) == 1)]
    return lines + _about(book, entry, element)


def _result(book: Book, entry: Entry, element: Element) -> str | None:
    text = element.attrs.get("body")
    if any(one.kind is Kind.DATA_TYPE for one in book.graph.targets(element, Edge.REFERENCES)):
        # AutomationML calls the values of an attribute type by its name: here it is no feature.
        return None
    return expression(book, entry, str(text)) if text else None


def _is_guard(book: Book, element: Element) -> bool:
    """Whether a transition, a flow or a fragment says it as its own condition."""
    return bool(book.graph.sources(element, Edge.GUARD))


def _is_only(book: Book, element: Element) -> bool:
    owner = book.graph.owner(element)
    beside = [] if owner is None else book.graph.owned(owner)
    return sum(one.kind is element.kind for one in beside) == 1


def _about(book: Book, entry: Entry, element: Element) -> list[Line]:
    """What it constrains besides its owner, when it has a name to refer by."""
    owner = book.graph.owner(element)
    others = [one for one in book.graph.targets(element, Edge.REFERENCES) if one is not owner]
    if not others or not entry.name:
        return []
    targets = [book.plan.entry(one) for one in others]
    names = [None if one is None else qualified(book.plan, entry.parent, one) for one in targets]
    known = [one for one in names if one is not None]
    mark = book.ours(entry.parent, "constrains")
    head = f"#{mark} dependency from {quoted(entry.name)} to {', '.join(known)}"
    return [Line(head)] if known else []
