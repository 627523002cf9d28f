"""Behaviours that a SysML model describes and the overlay gives to blocks and operations."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import generals, parameters, type_of
from sysmlc.overlay.model import BlockEntry, OperationEntry, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.blocks import add_parameter, operation_of
from sysmlc.passes.overlay.finder import BEHAVIOR, BLOCK, OPERATION, Finder
from sysmlc.support.suggestions import did_you_mean


def note_behaviors(finder: Finder, entry: BlockEntry) -> None:
    """Look for the behaviours of a block while all of them are where their model has them."""
    for term in (entry.behavior, *(operation.method for operation in entry.operations)):
        if term is not None:
            finder.behaviors[term.text] = finder.named(term.text, BEHAVIOR)


def add_behaviors(finder: Finder, entry: BlockEntry) -> None:
    """Make activities and state machines methods, or the block's classifier behaviour."""
    block = block_of(finder, entry)
    if block is None:
        return
    if entry.behavior is not None:
        _give(finder, block, block, Edge.CLASSIFIER_BEHAVIOR, entry.behavior)
    for operation in entry.operations:
        if operation.method is not None:
            _give_method(finder, block, operation, operation.method)


def behaviors_of(finder: Finder, block: Element) -> list[Element]:
    """Behaviours that a block owns: those that overlays gave it are among them."""
    owned = finder.graph.owned(block)
    return [one for one in owned if one.kind in BEHAVIOR.kinds]


def block_of(finder: Finder, entry: BlockEntry) -> Element | None:
    """The block of an entry; that it is not clear has been reported before."""
    for word in (entry.key.text, entry.key.path):
        found = finder.named(word, BLOCK) if word else []
        if found:
            return found[0] if len(found) == 1 else None
    return None


def _give_method(finder: Finder, block: Element, entry: OperationEntry, method: Term) -> None:
    graph = finder.graph
    operation = operation_of(finder, block, entry.name)
    if operation is None or graph.owner(operation) is not block:
        return
    found = _give(finder, block, operation, Edge.METHOD, method)
    if found is not None and entry.parameters is None and not parameters(graph, operation):
        for number, one in enumerate(parameters(graph, found)):
            direction = str(one.attrs.get("direction", "in"))
            word = Term(one.name, entry.name.spot)
            add_parameter(
                finder, operation, number, word, direction, graph.target(one, Edge.TYPED_BY)
            )


def _give(
    finder: Finder, block: Element, holder: Element, edge: Edge, term: Term
) -> Element | None:
    """Let the edge lead to the behaviour, which the block owns then (UML 2.5.1 clause 13.2.3)."""
    graph = finder.graph
    known = graph.target(holder, edge)
    if known is not None and graph.owner(known) is block and known.name == _last(term):
        return known
    found = finder.only(term, finder.behaviors.get(term.text, []), BEHAVIOR, "")
    if found is None:
        return None
    taken = _taken_by(finder, found)
    if known is not None or taken is not None:
        about = graph.qualified_name(taken or holder)
        behavior = (found if known is None else known).name
        finder.report(rules.BEHAVIOR_TAKEN, term, behavior=behavior, holder=about)
        return None
    graph.move(found, block)
    graph.connect(edge, holder, found)
    return found


def _last(term: Term) -> str:
    return term.text.rpartition("#")[2].rpartition("::")[2].rpartition("/")[2].strip("[]")


def _taken_by(finder: Finder, behavior: Element) -> Element | None:
    """Whose method or classifier behaviour it is already."""
    for edge in (Edge.METHOD, Edge.CLASSIFIER_BEHAVIOR):
        found = finder.graph.source(behavior, edge)
        if found is not None:
            return found
    return None


_IN = ("in", "inout")
_OUT = ("out", "inout", "return")
_Scope = dict[str, list[Element]]
"""Operations by the names under which a behaviour of the block can call them."""


def resolve_calls(finder: Finder, entry: BlockEntry) -> None:
    """Resolve the open calls in the behaviours that the block owns."""
    block = block_of(finder, entry)
    if block is None:
        return
    behaviors = behaviors_of(finder, block)
    calls = [one for top in behaviors for one in finder.graph.subtree(top) if _is_call(one)]
    scope: _Scope = {}
    for word, operation in _visible(finder, block):
        scope.setdefault(word, []).append(operation)
    for name, called in entry.calls:
        _resolve_as_told(finder, scope, calls, name, called)
    told = {name.text for name, _ in entry.calls}
    for action in calls:
        if action.name not in told and finder.graph.target(action, Edge.CALLS) is None:
            _resolve_by_name(finder, scope, block, action)


def _is_call(element: Element) -> bool:
    return element.kind is Kind.ACTION and element.subkind == "call-operation"


def _visible(finder: Finder, block: Element) -> Iterator[tuple[str, Element]]:
    graph = finder.graph
    for operation in _operations(finder, block):
        yield operation.name, operation
    for part in _features(finder, block, Kind.PROPERTY):
        type_ = type_of(graph, part)
        for operation in _operations(finder, type_) if type_ is not None else ():
            yield operation.name, operation
            for sign in ("/", ".", "::"):
                yield f"{part.name}{sign}{operation.name}", operation


def _operations(finder: Finder, block: Element) -> Iterator[Element]:
    return _features(finder, block, Kind.OPERATION)


def _features(finder: Finder, block: Element, kind: Kind) -> Iterator[Element]:
    """Own and inherited features of a kind; the nearest of a name counts."""
    seen: set[str] = set()
    for one in (block, *generals(finder.graph, block)):
        for inner in finder.graph.owned(one):
            if inner.kind is kind and inner.name and inner.name not in seen:
                seen.add(inner.name)
                yield inner


def _resolve_as_told(
    finder: Finder, scope: _Scope, calls: list[Element], name: Term, called: Term
) -> None:
    actions = [one for one in calls if one.name == name.text]
    if not actions:
        known = [one.name for one in calls if one.name]
        finder.report(
            rules.NO_ACTION, name, action=name.text, advice=did_you_mean(name.text, known)
        )
    found = list(dict.fromkeys(scope.get(called.text, ())))
    operation = found[0] if len(found) == 1 else finder.term(called, OPERATION)
    if operation is not None:
        for action in actions:
            finder.graph.replace_targets(Edge.CALLS, action, [operation])
            _type_pins(finder, action, operation)


def _resolve_by_name(finder: Finder, scope: _Scope, block: Element, action: Element) -> None:
    graph = finder.graph
    found = list(dict.fromkeys(scope.get(action.name, ())))
    if len(found) == 1:
        graph.connect(Edge.CALLS, action, found[0])
        _type_pins(finder, action, found[0])
        return
    listed = ", ".join(f"'{graph.qualified_name(one)}'" for one in found)
    rule = rules.CALL_OF_SEVERAL if found else rules.CALL_OF_NONE
    advice = did_you_mean(action.name, [name for name in scope if "::" not in name])
    name = graph.qualified_name(block)
    subject = graph.subject(action)
    finder.sink.report(rule, subject, action=action.name, block=name, listed=listed, advice=advice)
    _mark_unresolved(finder, action)


def _type_pins(finder: Finder, action: Element, operation: Element) -> None:
    """Pins without a type have that of their parameter (UML 2.5.1 clause 16.3.3)."""
    graph = finder.graph
    pins = [one for one in graph.owned(action) if one.kind is Kind.PIN]
    for subkind, directions in (("argument", _IN), ("result", _OUT)):
        own = [one for one in pins if one.subkind == subkind]
        for pin, parameter in zip(own, parameters(graph, operation, *directions), strict=False):
            type_ = graph.target(parameter, Edge.TYPED_BY)
            if type_ is not None and graph.target(pin, Edge.TYPED_BY) is None:
                graph.connect(Edge.TYPED_BY, pin, type_)


def _mark_unresolved(finder: Finder, action: Element) -> None:
    """What comes of a call that is not resolved is not reported again."""
    known = action.attrs.get("unresolved")
    told = known if isinstance(known, tuple) else ()
    if Edge.CALLS.value not in told:
        finder.graph.set(action, unresolved=(*told, Edge.CALLS.value))
