"""Exceptions: what is raised ends the protected node, and its handler takes its place.

UML 2.5.1, 15.5.3; fUML 1.5, 8.10.2. When the body of a handler is done, the flows that leave the
protected node get their tokens as if the node had ended by itself. What no handler in the activity
catches ends the activity.
"""

from sysmlc.ir import Element, Kind
from sysmlc.ir.identity import derived_id
from sysmlc.logic.activities.token_graph import ACTIVITY_REGION, Guard, NodeKind
from sysmlc.passes.activities import rules
from sysmlc.passes.activities.draft import Draft
from sysmlc.passes.activities.exception_analysis import CALLS, may_raise
from sysmlc.passes.activities.regions import Handler


def keep_handlers(draft: Draft) -> None:
    """Let the bodies of handlers not start by themselves."""
    for handlers in draft.drawing.handlers.values():
        draft.chained.update(handler.body.id for handler in handlers)


def add_exceptions(draft: Draft) -> None:
    """Add what is raised and what catches it."""
    for id in draft.drawing.handlers:
        _add_handlers(draft, draft.graph[id])
    for node in draft.drawing.nodes:
        if node.kind is Kind.ACTION and node.subkind == "raise":
            _add_raise(draft, node)
        elif node.kind is Kind.ACTION and _may_raise(draft, node):
            _add_failure(draft, node)
    for id in draft.drawing.handlers:
        node = draft.graph[id]
        outcome = derived_id(node.id, "outcome")
        if node.subkind != "raise" and outcome in draft.nodes and node.id not in draft.failing:
            draft.link(node.id, outcome, node, draft.nodes[outcome].region)


def _add_handlers(draft: Draft, node: Element) -> None:
    """The handlers of a protected node, chosen by the type of the exception."""
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    caught = draft.extra(node, "caught", NodeKind.MERGE, f"the exception of {label}", region)
    handlers = _distinct(draft.drawing.handlers[node.id])
    if len(handlers) == 1:
        body = handlers[0].body
        draft.link(caught.id, body.id, node, draft.drawing.around_both(node, body))
    else:
        _choose_handler(draft, node, caught.id, handlers)
    if draft.outgoing[node.id]:
        label = f"the outcome of {label}"
        outcome = draft.extra(node, "outcome", NodeKind.MERGE, label, region)
        draft.exits[node.id] = outcome.id
        for handler in handlers:
            around = draft.drawing.around_both(node, handler.body)
            draft.link(handler.body.id, outcome.id, node, around)


def _distinct(handlers: list[Handler]) -> list[Handler]:
    """Without those whose types an earlier one catches."""
    found: dict[tuple[str, ...], Handler] = {}
    for handler in handlers:
        found.setdefault(handler.types, handler)
    return list(found.values())


def _choose_handler(draft: Draft, node: Element, caught: str, handlers: list[Handler]) -> None:
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    label = f"the type of the exception of {label}"
    choice = draft.extra(node, "type", NodeKind.DECISION, label, region)
    draft.link(caught, choice.id, node, region)
    names = [_type_names(draft, handler) for handler in handlers]
    answer = draft.inputs.answer(f"exception_{draft.short[node.id]}", names, node)
    for handler, name in zip(handlers, names, strict=True):
        around, guard = draft.drawing.around_both(node, handler.body), answer.equals(name)
        draft.link(choice.id, handler.body.id, node, around, guard=Guard(name, guard))
    leaves = _leaving(draft)
    draft.link(choice.id, leaves, node, ACTIVITY_REGION, guard=Guard("else", None))


def _type_names(draft: Draft, handler: Handler) -> str:
    found = (draft.graph.get(id) for id in handler.types)
    names = [type_.name for type_ in found if type_ is not None and type_.name]
    return " or ".join(names) or draft.drawing.labels[handler.body.id]


# -- what raises -------------------------------------------------------------------------------


def _catcher(draft: Draft, node: Element) -> Element | None:
    """The innermost protected node that the node is or is in."""
    for id in (node.id, *draft.drawing.around(draft.drawing.region[node.id])):
        if id in draft.drawing.handlers:
            return draft.graph[id]
    return None


def _add_raise(draft: Draft, node: Element) -> None:
    if node.id not in draft.exits and draft.outgoing[node.id]:
        draft.exits[node.id] = _never(draft, node)
    _throw(draft, node, node.id, None)


def _never(draft: Draft, node: Element) -> str:
    """What the flows after a raise action leave: no token ever does."""
    label = f"the end of {draft.drawing.labels[node.id]}"
    region = draft.drawing.region[node.id]
    return draft.extra(node, "end", NodeKind.MERGE, label, region).id


def _throw(draft: Draft, node: Element, source: str, guard: Guard | None) -> None:
    """Lead the exception to the handlers; a structured node that catches it is ended."""
    catcher = _catcher(draft, node)
    if catcher is None:
        draft.link(source, _leaving(draft), node, ACTIVITY_REGION, guard=guard)
        label = draft.drawing.labels[node.id]
        draft.sink.report(rules.UNCAUGHT, draft.graph.subject(node), node=label)
        return
    caught = draft.nodes[derived_id(catcher.id, "caught")]
    interrupts = ""
    if catcher is not node:
        interrupts = derived_id(catcher.id, "exception")
        draft.ended[interrupts] = catcher
    draft.link(source, caught.id, node, caught.region, guard=guard, interrupts=interrupts)


def _leaving(draft: Draft) -> str:
    """Where exceptions that no handler catches end the activity."""
    activity = draft.drawing.activity
    label = "an exception that nobody catches"
    return draft.extra(activity, "uncaught", NodeKind.ACTIVITY_FINAL, label, ACTIVITY_REGION).id


def _may_raise(draft: Draft, node: Element) -> bool:
    """Whether the end of the action may be an exception.

    Where no handler is near only calls of what raises something by its drawing do so.
    """
    if node.subkind not in CALLS:
        return False
    catcher = _catcher(draft, node)
    if catcher is None:
        return may_raise(draft.graph, node, draft.raising.drawn, unknown=False)
    return catcher is node or may_raise(draft.graph, node, draft.raising.possible, unknown=True)


def _add_failure(draft: Draft, node: Element) -> None:
    """Let the environment decide whether a call ends by itself or with an exception."""
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    choice = draft.extra(node, "failure", NodeKind.DECISION, f"the end of {label}", region)
    draft.link(node.id, choice.id, node, region)
    answer = draft.inputs.answer(f"raised_{draft.short[node.id]}", ["true"], node)
    guard = Guard("an exception is raised", answer.equals("true"))
    _throw(draft, node, choice.id, guard)
    draft.failing.add(node.id)
    after = draft.exits.get(node.id) or _after(draft, node)
    draft.link(choice.id, after, node, region, guard=Guard("else", None))


def _after(draft: Draft, node: Element) -> str:
    """What the flows of a call leave when it has ended by itself."""
    label, region = (
        f"the normal end of {draft.drawing.labels[node.id]}",
        draft.drawing.region[node.id],
    )
    if not draft.outgoing[node.id]:
        return draft.extra(node, "end", NodeKind.SINK, label, region).id
    draft.exits[node.id] = draft.extra(node, "end", NodeKind.MERGE, label, region).id
    return draft.exits[node.id]
