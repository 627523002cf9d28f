"""How an action names what it calls, and which pin stands for which parameter."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.references import chain, lookup
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import direction_of, features, generals, type_of


def call_target(book: Book, entry: Entry, action: Element, target: Element) -> str | None:
    """The name of what is called: a definition, or an action that a chain of features reaches."""
    other = book.plan.entry(target)
    if other is None:
        book.lost(action, "calls")
        return None
    if not other.shape.is_definition and lookup(book.plan, entry.parent, other.name) is not other:
        through = _through(book, entry, target)
        if through is not None:
            return through
    return book.name(entry.parent, action, Edge.CALLS, target)


def _through(book: Book, entry: Entry, target: Element) -> str | None:
    """A chain through the one feature of the context that has the operation."""
    owner = book.graph.owner(target)
    for above in entry.above:
        if above.element is None or above.element.kind not in (Kind.CLASS, Kind.COMPONENT):
            continue
        fitting = [
            one
            for one in features(book.graph, above.element)
            if one.kind is Kind.PROPERTY and _has(book, one, owner)
        ]
        if len(fitting) == 1:
            return chain(book.plan, entry.parent, [fitting[0], target])
    return None


def _has(book: Book, feature: Element, owner: Element | None) -> bool:
    type_ = type_of(book.graph, feature)
    return type_ is not None and (type_ is owner or owner in generals(book.graph, type_))


def parameter_of(book: Book, pin: Element) -> Element | None:
    """The parameter that a pin of a call stands for (UML 2.5.1 clause 16.3.3).

    Arguments follow the in and inout parameters in order, results the inout, out and return
    ones.
    """
    action = book.graph.owner(pin)
    called = None if action is None else book.graph.target(action, Edge.CALLS)
    if action is None or action.subkind not in ("call-behavior", "call-operation"):
        return None
    if called is None or pin.subkind in ("target", "object"):
        return None
    if called.kind not in (Kind.OPERATION, Kind.ACTIVITY):
        return None
    is_out = pin.attrs.get("direction") == "out"
    wanted = ("inout", "out", "return") if is_out else ("in", "inout")
    pins = [
        one
        for one in book.graph.owned(action)
        if one.kind is Kind.PIN
        and (one.attrs.get("direction") == "out") is is_out
        and one.subkind not in ("target", "object")
    ]
    formal = [
        one
        for one in book.graph.owned(called)
        if one.kind is Kind.PARAMETER and direction_of(one) in wanted
    ]
    number = pins.index(pin) if pin in pins else len(formal)
    return formal[number] if number < len(formal) else None
