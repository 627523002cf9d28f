"""Object flows: from one object to another, past the control nodes between them."""

from collections.abc import Iterator

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import visibility
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.rules import UNSAID_ATTRIBUTE
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.successions import STORES, feature
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind

PAST_CONTROL = "an object flow between a store and a control node"


def object_flow(book: Book, entry: Entry) -> list[Line]:
    """The flows that begin with one object flow; those that begin at control nodes are said."""
    element = entry.element
    assert element is not None
    source = book.graph.target(element, Edge.FLOW_SOURCE)
    target = book.graph.target(element, Edge.FLOW_TARGET)
    if source is None or target is None:
        return book.drop(entry, "flow ends")
    if source.kind is Kind.CONTROL:
        if target.kind in STORES:
            book.approximated(element, PAST_CONTROL, "bindings past it")
        return []
    is_direct = target.kind is not Kind.CONTROL
    if is_direct and "guard" in element.attrs:
        book.losses.note(UNSAID_ATTRIBUTE, element, attribute="guard", kind="ObjectFlow")
    reached = [target] if is_direct else list(_reached(book, target))
    is_said = not is_direct and _is_said(book, source, reached)
    if not is_direct and not is_said:
        book.approximated(element, PAST_CONTROL, "bindings past it")
    is_own = is_direct or source.kind in STORES
    start, name = feature(book, entry.parent, source), entry.name if is_own else ""
    lines: list[Line] = []
    for one in reached:
        end = feature(book, entry.parent, one)
        if start is None or end is None:
            book.drop(entry, "flow ends")
            continue
        lines.append(Line(_text(book, element, name, (source, start), (one, end))))
        name = ""
    if is_said:
        for line in lines:
            line.body.append(annotations.ours(book, entry, "Through", {}))
    elif lines and is_own:
        lines[0].body += contents(book, entry)
    return lines


def _is_said(book: Book, source: Element, reached: list[Element]) -> bool:
    """Whether successions say all of the way from pin to pin."""
    ends = (source, *reached)
    return bool(reached) and all(one.kind is Kind.PIN for one in ends)


def _text(
    book: Book, flow: Element, name: str, source: tuple[Element, str], target: tuple[Element, str]
) -> str:
    words = visibility(book, flow)
    if source[0].kind is not Kind.PIN or target[0].kind is not Kind.PIN:
        _note_shared(book, flow, source[0], target[0])
        start = ["binding", quoted(name)] if name else []
        return " ".join([*words, *start, "bind", target[1], "=", source[1]])
    start = ["flow", quoted(name)] if name else ["flow"]
    return " ".join([*words, *start, "from", source[1], "to", target[1]])


def _note_shared(book: Book, flow: Element, source: Element, target: Element) -> None:
    """Note a node of several flows, each of which takes or brings something: a binding does not.

    A flow leads from a feature of one element to a feature of another (SysML 2.0, 7.16), which
    what the activity itself holds does not have.
    """
    for one, edge in ((source, Edge.FLOW_SOURCE), (target, Edge.FLOW_TARGET)):
        if one.kind is not Kind.PIN and len(book.graph.sources(one, edge)) > 1:
            book.approximated(flow, "an object flow of a node with several", "a binding")
            return


def _reached(book: Book, control: Element) -> Iterator[Element]:
    """Object nodes that objects reach from a control node without passing another one."""
    seen, stack = {control.id}, [control]
    while stack:
        top = stack.pop()
        for flow in reversed(book.graph.sources(top, Edge.FLOW_SOURCE)):
            target = book.graph.target(flow, Edge.FLOW_TARGET)
            if flow.kind is not Kind.OBJECT_FLOW or target is None or target.id in seen:
                continue
            seen.add(target.id)
            if target.kind is Kind.CONTROL:
                stack.append(target)
            else:
                yield target
