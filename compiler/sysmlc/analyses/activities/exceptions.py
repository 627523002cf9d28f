"""Exceptions: a raised exception ends the protected node, and its handler takes its place.

UML 2.5.1, 15.5.3; fUML 1.5, 8.10.2. When the body of a handler is done, the flows that leave the
protected node get their tokens as if the node had ended by itself. An exception that no handler in
the activity catches ends the activity.
"""

from sysmlc.analyses.activities import rules
from sysmlc.analyses.activities.draft import Draft
from sysmlc.analyses.activities.exception_analysis import CALLS, Raising, may_raise
from sysmlc.analyses.activities.regions import Handler
from sysmlc.ir import Element, Kind
from sysmlc.ir.element import derived_id
from sysmlc.logic.activities.token_nodes import ACTIVITY_REGION, Guard, NodeKind


def chain_handler_bodies(draft: Draft) -> None:
    """Mark the bodies of handlers as chained: only an exception starts them."""
    for handlers in draft.drawing.handlers.values():
        draft.chained.update(handler.body.id for handler in handlers)


def add_exceptions(draft: Draft, raising: Raising) -> None:
    """Add the edges from raising actions to handlers, and from handlers to the next nodes."""
    for id in draft.drawing.handlers:
        _add_handlers(draft, draft.graph[id])
    failing_calls = set()
    for node in draft.drawing.nodes:
        if node.kind is Kind.ACTION and node.subkind == "raise":
            _add_raise(draft, node)
        elif node.kind is Kind.ACTION and _may_raise(draft, raising, node):
            _add_failure(draft, node)
            failing_calls.add(node.id)
    for id in draft.drawing.handlers:
        node = draft.graph[id]
        outcome = derived_id(node.id, "outcome")
        ends_normally = node.subkind != "raise" and node.id not in failing_calls
        if ends_normally and outcome in draft.nodes:
            draft.add_edge(node.id, outcome, node, draft.nodes[outcome].region)


def _add_handlers(draft: Draft, node: Element) -> None:
    """Add the edges to the handlers of a protected node and from them to its outcome.

    If there are several handlers, a decision selects one by the type of the exception.
    """
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    caught = draft.ensure_node(node, "caught", NodeKind.MERGE, f"the exception of {label}", region)
    handlers = _drop_covered_handlers(draft.drawing.handlers[node.id])
    if len(handlers) == 1:
        body = handlers[0].body
        draft.add_edge(caught.id, body.id, node, draft.drawing.common_region(node, body))
    else:
        _choose_handler(draft, node, caught.id, handlers)
    if draft.drawing.outgoing(node):
        label = f"the outcome of {label}"
        outcome = draft.ensure_node(node, "outcome", NodeKind.MERGE, label, region)
        draft.exits[node.id] = outcome.id
        for handler in handlers:
            region_of_both = draft.drawing.common_region(node, handler.body)
            draft.add_edge(handler.body.id, outcome.id, node, region_of_both)


def _drop_covered_handlers(handlers: list[Handler]) -> list[Handler]:
    """Return the handlers without those that catch the same types as an earlier handler."""
    by_types: dict[tuple[str, ...], Handler] = {}
    for handler in handlers:
        by_types.setdefault(handler.types, handler)
    return list(by_types.values())


def _choose_handler(draft: Draft, node: Element, caught: str, handlers: list[Handler]) -> None:
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    label = f"the type of the exception of {label}"
    choice = draft.ensure_node(node, "type", NodeKind.DECISION, label, region)
    draft.add_edge(caught, choice.id, node, region)
    names = [_name_types(draft, handler) for handler in handlers]
    decision_input = draft.inputs.declare_decision_input(
        f"exception_{draft.short_names[node.id]}", names, node
    )
    for handler, name in zip(handlers, names, strict=True):
        region_of_both, guard = (
            draft.drawing.common_region(node, handler.body),
            decision_input.equals(name),
        )
        draft.add_edge(choice.id, handler.body.id, node, region_of_both, guard=Guard(name, guard))
    uncaught = _ensure_uncaught_final(draft)
    draft.add_edge(choice.id, uncaught, node, ACTIVITY_REGION, guard=Guard("else", None))


def _name_types(draft: Draft, handler: Handler) -> str:
    types = (draft.graph.get(id) for id in handler.types)
    names = [type_.name for type_ in types if type_ is not None and type_.name]
    return " or ".join(names) or draft.drawing.labels[handler.body.id]


# -- raising actions ---------------------------------------------------------------------------


def _find_catcher(draft: Draft, node: Element) -> Element | None:
    """Return the innermost node with handlers that is the node or contains it, or None."""
    for id in (node.id, *draft.drawing.enclosing_regions(draft.drawing.region[node.id])):
        if id in draft.drawing.handlers:
            return draft.graph[id]
    return None


def _add_raise(draft: Draft, node: Element) -> None:
    if node.id not in draft.exits and draft.drawing.outgoing(node):
        draft.exits[node.id] = _add_unreachable_end(draft, node)
    _add_throw(draft, node, node.id, None)


def _add_unreachable_end(draft: Draft, node: Element) -> str:
    """Return the source of the drawn flows after a raise action. No token ever reaches it."""
    label = f"the end of {draft.drawing.labels[node.id]}"
    region = draft.drawing.region[node.id]
    return draft.ensure_node(node, "end", NodeKind.MERGE, label, region).id


def _add_throw(draft: Draft, node: Element, source: str, guard: Guard | None) -> None:
    """Add the edge from *source* to the handlers that catch the exception.

    A structured node with these handlers loses its tokens. Without a handler, the activity ends.
    """
    catcher = _find_catcher(draft, node)
    if catcher is None:
        draft.add_edge(source, _ensure_uncaught_final(draft), node, ACTIVITY_REGION, guard=guard)
        label = draft.drawing.labels[node.id]
        draft.sink.report(rules.UNCAUGHT, draft.graph.subject(node), node=label)
        return
    caught = draft.nodes[derived_id(catcher.id, "caught")]
    # An action that catches its own exception holds no other tokens that it could lose.
    interrupts = "" if catcher is node else exception_region_id(catcher.id)
    draft.add_edge(source, caught.id, node, caught.region, guard=guard, interrupts=interrupts)


def exception_region_id(catcher: str) -> str:
    """Return the id of the nodes that lose their tokens when a protected node is ended."""
    return derived_id(catcher, "exception")


def _ensure_uncaught_final(draft: Draft) -> str:
    """Return the final node to which uncaught exceptions lead."""
    activity = draft.drawing.activity
    label = "an exception without handler"
    return draft.ensure_node(
        activity, "uncaught", NodeKind.ACTIVITY_FINAL, label, ACTIVITY_REGION
    ).id


def _may_raise(draft: Draft, raising: Raising, node: Element) -> bool:
    """Whether the action may end with an exception.

    Outside protected nodes, this is only assumed of calls that lead to a raise action.
    """
    if node.subkind not in CALLS:
        return False
    catcher = _find_catcher(draft, node)
    if catcher is None:
        return may_raise(draft.graph, node, raising.drawn, unknown=False)
    return catcher is node or may_raise(draft.graph, node, raising.possible, unknown=True)


def _add_failure(draft: Draft, node: Element) -> None:
    """Add a decision after a call: an input states whether the call ends with an exception."""
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    choice = draft.ensure_node(node, "failure", NodeKind.DECISION, f"the end of {label}", region)
    draft.add_edge(node.id, choice.id, node, region)
    decision_input = draft.inputs.declare_decision_input(
        f"raised_{draft.short_names[node.id]}", ["true"], node
    )
    guard = Guard("an exception is raised", decision_input.equals("true"))
    _add_throw(draft, node, choice.id, guard)
    normal_end = draft.exits.get(node.id) or _ensure_normal_end(draft, node)
    draft.add_edge(choice.id, normal_end, node, region, guard=Guard("else", None))


def _ensure_normal_end(draft: Draft, node: Element) -> str:
    """Return the node that a call reaches if it ends without an exception."""
    label, region = (
        f"the normal end of {draft.drawing.labels[node.id]}",
        draft.drawing.region[node.id],
    )
    if not draft.drawing.outgoing(node):
        return draft.ensure_node(node, "end", NodeKind.SINK, label, region).id
    draft.exits[node.id] = draft.ensure_node(node, "end", NodeKind.MERGE, label, region).id
    return draft.exits[node.id]
