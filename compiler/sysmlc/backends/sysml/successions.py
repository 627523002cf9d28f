"""Successions: what follows a node, with guards; object flows through control nodes order too."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.conditions import condition
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.merges import step_behind
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import named
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.values import literal
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import AttrValue, Edge, Element, Kind

WAITING = "a step that waits for several flows, one of them with a guard,"
STORES = (Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.ACTIVITY_PARAMETER)


def leaving(book: Book, entry: Entry) -> list[Line]:
    """Successions that leave a node, in the order of the model; the one for else is last."""
    element = entry.element
    assert element is not None
    flows = _leaving(book, element)
    plain = [one for one in flows if one.attrs.get("guard") != "else"]
    others = [one for one in flows if one.attrs.get("guard") == "else"]
    lines = [succession(book, entry, one) for one in (*plain, *others)]
    return [one for one in lines if one is not None]


def _leaving(book: Book, element: Element) -> list[Element]:
    """Control flows that leave a node and object flows that order it."""
    graph = book.graph
    flows = graph.sources(element, Edge.FLOW_SOURCE)
    found = [one for one in flows if one.kind is Kind.CONTROL_FLOW or _orders(book, one)]
    for pin in graph.owned(element):
        if pin.kind is Kind.PIN:
            found += [one for one in graph.sources(pin, Edge.FLOW_SOURCE) if _orders(book, one)]
    return found


def _orders(book: Book, flow: Element) -> bool:
    """Whether an object flow begins or ends at a control node."""
    if flow.kind is not Kind.OBJECT_FLOW:
        return False
    ends = [book.graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    return any(one is not None and one.kind is Kind.CONTROL for one in ends)


def succession(book: Book, entry: Entry, flow: Element) -> Line | None:
    """One succession after the node that it leaves; one with a name, or inside others, in full."""
    book.said.add(flow.id)
    target = book.graph.target(flow, Edge.FLOW_TARGET)
    end = None if target is None else vertex(book, entry.parent, target)
    if end is None:
        if target is None or target.kind not in STORES:
            book.lost(flow, "flow-target")
        return None
    own = book.plan.entry(flow)
    name = own.name if own is not None else ""
    if own is not None and own.parent is not entry.parent:
        book.approximated(flow, "a flow that another node owns", "a succession beside its source")
    inner = [] if own is None else contents(book, own)
    body = inner if flow.kind is Kind.CONTROL_FLOW else [*_objects(book, entry, flow), *inner]
    is_decision = entry.shape.keyword == "decide"
    guard = _guard(book, entry, flow)
    if guard is not None:
        _note_waiting(book, target)
    if guard == "else" and not name and is_decision:
        return Line(f"else {end}", body, depth=1)
    test = "" if guard in (None, "else") else f"if {guard} "
    if name:
        return Line(f"succession {quoted(name)} first {quoted(entry.name)} {test}then {end}", body)
    return Line(f"{test}then {end}", body, depth=1 if is_decision else 0)


def _note_waiting(book: Book, step: Element | None) -> None:
    """Note a step that waits for all of several flows: not for those whose guard does not hold."""
    if step is None or step.kind not in (Kind.ACTION, Kind.STRUCTURED):
        return
    into = [f for f in book.graph.sources(step, Edge.FLOW_TARGET) if f.kind is Kind.CONTROL_FLOW]
    told = (facts.get("said") for _, facts in book.losses.told.get(step.id, ()))
    if len(into) > 1 and WAITING not in told:
        book.approximated(step, WAITING, "one that waits for those whose guards hold")


def _objects(book: Book, entry: Entry, flow: Element) -> list[Line]:
    """Metadata of a succession along which objects flow: the pins at its ends."""
    facts: dict[str, AttrValue] = {}
    for key, edge in (("source", Edge.FLOW_SOURCE), ("target", Edge.FLOW_TARGET)):
        end = book.graph.target(flow, edge)
        pin = book.plan.entry(end) if end is not None and end.kind is Kind.PIN else None
        facts[key] = "" if pin is None else pin.name
    return [annotations.ours(book, entry, "ObjectFlow", facts)]


def _guard(book: Book, entry: Entry, flow: Element) -> str | None:
    text = flow.attrs.get("guard")
    if text is None:
        return None
    if isinstance(text, str) and text.strip() == "else":
        return "else"
    if flow.attrs.get("guard_literal") and entry.element is not None:
        compared = _input(book, entry, entry.element)
        if compared is not None:
            return f"{compared} == {_literal(book, entry, text)}"
    if not isinstance(text, str):
        return _literal(book, entry, text)
    return condition(book, entry.parent, flow, text)


def _literal(book: Book, entry: Entry, text: object) -> str:
    if isinstance(text, str) and (text in ("true", "false") or text.lstrip("-").isdigit()):
        return text
    assert entry.element is not None
    given = text if isinstance(text, str | int | float | bool) else str(text)
    return literal(book, entry.parent, entry.element, given)


def _input(book: Book, entry: Entry, decision: Element) -> str | None:
    """What a decision is made over: the one object that flows into it."""
    flows = book.graph.sources(decision, Edge.FLOW_TARGET)
    given = book.graph.get(str(decision.attrs.get("decision_input_flow", "")))
    objects = [given] if given is not None else [f for f in flows if f.kind is Kind.OBJECT_FLOW]
    if len(objects) != 1:
        return None
    source = book.graph.target(objects[0], Edge.FLOW_SOURCE)
    if source is None or source.kind is Kind.CONTROL:
        return None
    return feature(book, entry.parent, source)


def vertex(book: Book, scope: Entry | None, element: Element) -> str | None:
    """How a succession names a node; pins by their action, final nodes as ``done``."""
    if element.kind is Kind.PIN:
        owner = book.graph.owner(element)
        return None if owner is None else vertex(book, scope, owner)
    step = step_behind(book.graph, element)
    if step is not None:
        book.said.add(element.id)
        return vertex(book, scope, step)
    return None if element.kind in STORES else _vertex(book, scope, element)


def _vertex(book: Book, scope: Entry | None, element: Element) -> str | None:
    if element.subkind != "initial" and book.plan.entry(element) is not None:
        return named(book.plan, scope, element)
    word = {"initial": "start", "final": "done", "flow-final": "done"}.get(element.subkind)
    holder = None if word is None else _holder(book, element)
    if word is None or holder is None or holder is scope:
        return word
    if scope is not None and any(holder is one for one in scope.above):
        return word
    found = named(book.plan, scope, holder.element)
    return None if found is None else f"{found}.{word}"


def _holder(book: Book, element: Element) -> Entry | None:
    for above in book.graph.ancestors(element):
        found = book.plan.entry(above)
        if found is not None:
            return found
    return None


def feature(book: Book, scope: Entry | None, element: Element) -> str | None:
    """How a flow names an object node: a pin by its action, a parameter node by its parameter."""
    if element.kind is Kind.ACTIVITY_PARAMETER and book.plan.entry(element) is None:
        targets = book.graph.targets(element, Edge.REFERENCES)
        return named(book.plan, scope, targets[0]) if targets else None
    return named(book.plan, scope, element)


def first(book: Book, entry: Entry, initial: Element) -> list[Line]:
    """The successions that leave an initial node."""
    lines, scope = [], entry.parent
    for flow in book.graph.sources(initial, Edge.FLOW_SOURCE):
        book.said.add(flow.id)
        target = book.graph.target(flow, Edge.FLOW_TARGET)
        end = None if target is None else vertex(book, scope, target)
        if end is None:
            book.lost(flow, "flow-target")
            continue
        own = book.plan.entry(flow)
        name = f"succession {quoted(own.name)} " if own is not None and own.name else ""
        text = flow.attrs.get("guard")
        test = "" if text is None else f"if {condition(book, scope, flow, str(text))} "
        body = [] if own is None else contents(book, own)
        lines.append(Line(f"{name}first start {test}then {end}", body))
    return lines
