"""Behaviours that an overlay gives to blocks and operations, and the calls in them.

A call operation action without an operation calls the operation of the action's name in the block
or in a part of the block. The entry ``calls`` of the overlay names it if this is ambiguous.
"""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Kind, list_items
from sysmlc.ir.query import generals, parameters, type_of
from sysmlc.overlay.model import BlockEntry, OperationEntry, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.blocks import add_parameter, find_operation
from sysmlc.passes.overlay.finder import BEHAVIOR, BLOCK, OPERATION, Finder
from sysmlc.support.suggestions import did_you_mean


def find_behaviors(finder: Finder, entry: BlockEntry) -> None:
    """Look up the behaviours of a block before ``add_behaviors`` moves them to other owners."""
    for term in (entry.behavior, *(operation.method for operation in entry.operations)):
        if term is not None:
            finder.behaviors[term.text] = finder.find_named(term.text, BEHAVIOR)


def add_behaviors(finder: Finder, entry: BlockEntry) -> None:
    """Make the stated behaviours methods of operations, or the block's classifier behaviour."""
    block = _find_block(finder, entry)
    if block is None:
        return
    if entry.behavior is not None:
        _assign_behavior(finder, block, block, Edge.CLASSIFIER_BEHAVIOR, entry.behavior)
    for operation in entry.operations:
        if operation.method is not None:
            _give_method(finder, block, operation, operation.method)


def _list_behaviors(finder: Finder, block: Element) -> list[Element]:
    """Return the behaviours that a block owns, including those that overlays gave it."""
    owned = finder.graph.owned(block)
    return [element for element in owned if element.kind in BEHAVIOR.kinds]


def _find_block(finder: Finder, entry: BlockEntry) -> Element | None:
    """Return the block of an entry, or None for an unknown or ambiguous one, already reported."""
    for word in (entry.key.text, entry.key.path):
        blocks = finder.find_named(word, BLOCK) if word else []
        if blocks:
            return blocks[0] if len(blocks) == 1 else None
    return None


def _give_method(finder: Finder, block: Element, entry: OperationEntry, method: Term) -> None:
    graph = finder.graph
    operation = find_operation(finder, block, entry.name)
    if operation is None or graph.owner(operation) is not block:
        return
    behavior = _assign_behavior(finder, block, operation, Edge.METHOD, method)
    if behavior is not None and entry.parameters is None and not parameters(graph, operation):
        for number, parameter in enumerate(parameters(graph, behavior)):
            direction = str(parameter.attrs.get("direction", "in"))
            word = Term(parameter.name, entry.name.spot)
            add_parameter(
                finder, operation, number, word, direction, graph.target(parameter, Edge.TYPED_BY)
            )


def _assign_behavior(
    finder: Finder, block: Element, holder: Element, edge: Edge, term: Term
) -> Element | None:
    """Connect *holder* with the behaviour and move it to the block (UML 2.5.1, 13.2.3)."""
    graph = finder.graph
    current = graph.target(holder, edge)
    # A second run of the pass must change nothing (`pipeline.Pass`).
    if current is not None and graph.owner(current) is block and current.name == _last_name(term):
        return current
    behavior = finder.require_one(term, finder.behaviors.get(term.text, []), BEHAVIOR, "")
    if behavior is None:
        return None
    user = _find_user(finder, behavior)
    if current is not None or user is not None:
        holder_name = graph.qualified_name(user or holder)
        behavior_name = (behavior if current is None else current).name
        finder.report(rules.BEHAVIOR_TAKEN, term, behavior=behavior_name, holder=holder_name)
        return None
    graph.move(behavior, block)
    graph.connect(edge, holder, behavior)
    finder.record_change(holder, f"the behavior '{behavior.name}'", term)
    return behavior


def _last_name(term: Term) -> str:
    return term.text.rpartition("#")[2].rpartition("::")[2].rpartition("/")[2].strip("[]")


def _find_user(finder: Finder, behavior: Element) -> Element | None:
    """Return the operation or block that has the behaviour already, or None."""
    for edge in (Edge.METHOD, Edge.CLASSIFIER_BEHAVIOR):
        user = finder.graph.source(behavior, edge)
        if user is not None:
            return user
    return None


_IN = ("in", "inout")
_OUT = ("out", "inout", "return")
_Scope = dict[str, list[Element]]
"""Operations that a behaviour of the block can call, by name."""


def resolve_calls(finder: Finder, entry: BlockEntry) -> None:
    """Resolve the calls without an operation in the behaviours of the block."""
    block = _find_block(finder, entry)
    if block is None:
        return
    behaviors = _list_behaviors(finder, block)
    calls = [
        action for top in behaviors for action in finder.graph.subtree(top) if _is_call(action)
    ]
    scope: _Scope = {}
    for visible_name, operation in _list_visible_operations(finder, block):
        scope.setdefault(visible_name, []).append(operation)
    for name, called in entry.calls:
        _resolve_stated(finder, scope, calls, name, called)
    stated = {name.text for name, _ in entry.calls}
    for action in calls:
        if action.name not in stated and finder.graph.target(action, Edge.CALLS) is None:
            _resolve_by_name(finder, scope, block, action, entry)


def _is_call(element: Element) -> bool:
    return element.kind is Kind.ACTION and element.subkind == "call-operation"


def _list_visible_operations(finder: Finder, block: Element) -> Iterator[tuple[str, Element]]:
    graph = finder.graph
    for operation in _operations(finder, block):
        yield operation.name, operation
    for part in _list_features(finder, block, Kind.PROPERTY):
        type_ = type_of(graph, part)
        if type_ is not None:
            for operation in _operations(finder, type_):
                yield operation.name, operation
                for sign in ("/", ".", "::"):
                    yield f"{part.name}{sign}{operation.name}", operation


def _operations(finder: Finder, block: Element) -> Iterator[Element]:
    return _list_features(finder, block, Kind.OPERATION)


def _list_features(finder: Finder, block: Element, kind: Kind) -> Iterator[Element]:
    """Yield own and inherited features of a kind; the nearest feature hides others of its name."""
    names: set[str] = set()
    for classifier in (block, *generals(finder.graph, block)):
        for feature in finder.graph.owned(classifier):
            if feature.kind is kind and feature.name and feature.name not in names:
                names.add(feature.name)
                yield feature


def _resolve_stated(
    finder: Finder, scope: _Scope, calls: list[Element], name: Term, called: Term
) -> None:
    actions = [action for action in calls if action.name == name.text]
    if not actions:
        names = [action.name for action in calls if action.name]
        finder.report(
            rules.NO_ACTION, name, action=name.text, advice=did_you_mean(name.text, names)
        )
    operations = list(dict.fromkeys(scope.get(called.text, ())))
    operation = operations[0] if len(operations) == 1 else finder.find_term(called, OPERATION)
    if operation is not None:
        for action in actions:
            finder.graph.replace_targets(Edge.CALLS, action, [operation])
            finder.record_change(action, f"the called operation '{operation.name}'", called)
            _type_pins(finder, action, operation)


def _resolve_by_name(
    finder: Finder, scope: _Scope, block: Element, action: Element, entry: BlockEntry
) -> None:
    graph = finder.graph
    operations = list(dict.fromkeys(scope.get(action.name, ())))
    if len(operations) == 1:
        graph.connect(Edge.CALLS, action, operations[0])
        finder.record_change(action, f"the called operation '{operations[0].name}'", entry.key)
        _type_pins(finder, action, operations[0])
        return
    listed = ", ".join(f"'{graph.qualified_name(operation)}'" for operation in operations)
    rule = rules.SEVERAL_OPERATIONS if operations else rules.NO_OPERATION
    advice = did_you_mean(action.name, [name for name in scope if "::" not in name])
    name = graph.qualified_name(block)
    subject = graph.subject(action)
    finder.sink.report(rule, subject, action=action.name, block=name, listed=listed, advice=advice)
    _mark_unresolved(finder, action)


def _type_pins(finder: Finder, action: Element, operation: Element) -> None:
    """Set the type of untyped pins to the type of their parameter (UML 2.5.1 clause 16.3.3)."""
    graph = finder.graph
    pins = [pin for pin in graph.owned(action) if pin.kind is Kind.PIN]
    for subkind, directions in (("argument", _IN), ("result", _OUT)):
        pins_of_kind = [pin for pin in pins if pin.subkind == subkind]
        for pin, parameter in zip(
            pins_of_kind, parameters(graph, operation, *directions), strict=False
        ):
            type_ = graph.target(parameter, Edge.TYPED_BY)
            if type_ is not None and graph.target(pin, Edge.TYPED_BY) is None:
                graph.connect(Edge.TYPED_BY, pin, type_)


def _mark_unresolved(finder: Finder, action: Element) -> None:
    """Mark the call as unresolved, so that later passes do not report it again."""
    unresolved = list_items(action.attrs.get("unresolved"))
    if Edge.CALLS.value not in unresolved:
        finder.graph.set(action, unresolved=(*unresolved, Edge.CALLS.value))
