"""Control flow that UML implies although no flow is drawn (UML 2.5.1, 15.2.3, 16.11 and 16.12).

``construction.build`` calls ``expand_structured_node`` when it adds a node, ``chain_sequence_node``
before it adds the drawn flows, and ``add_implied_start`` after them, because a node that a drawn
flow starts has no implied start.
"""

from collections.abc import Mapping
from itertools import pairwise

from sysmlc.analyses.activities.draft import Draft
from sysmlc.analyses.activities.regions import Part
from sysmlc.ir import Element, Kind
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_nodes import Firing, Guard, NodeKind, TokenNode
from sysmlc.logic.identifiers import identifier

ACCEPTS = ("accept", "accept-call")
"""Actions that wait for an event."""
ROUND = "round"
"""Role of the fork that passes loop variables to nodes that no part of the loop lists.

Roles become ids and contract variables, so that renaming one would change outputs.
"""


def expand_structured_node(draft: Draft, node: Element) -> None:
    """Add the parts of a loop, conditional or expansion node, and the order in which they run."""
    parts = draft.drawing.parts.get(node.id, [])
    for part in parts:
        label = f"the {part.word} of {draft.drawing.labels[node.id]}"
        short = f"{identifier(part.word)}_{draft.short_names[node.id]}"
        run = draft.inputs.names.new(f"run_{short}")
        token_node = TokenNode(part.id, NodeKind.STRUCTURED, label, node.id, node.id, run=run)
        draft.put_node(token_node, short)
    parts_by_role = {part.word: part for part in parts}
    if parts and node.subkind == "loop":
        _connect_loop(draft, node, parts_by_role)
    elif parts and node.subkind == "expansion":
        _connect_expansion(draft, node, parts[0])
    elif parts:
        _connect_clauses(draft, node, parts_by_role)


def _add_control_node(draft: Draft, node: Element, role: str, kind: NodeKind) -> str:
    label = f"the {role} of {draft.drawing.labels[node.id]}"
    return draft.ensure_node(node, role, kind, label, node.id).id


def _declare_guard(draft: Draft, node: Element, role: str, text: str) -> Guard:
    """Declare a Boolean input and return the guard that it is true."""
    name = identifier(f"{role}_{draft.short_names[node.id]}")
    return Guard(
        text, draft.inputs.declare_decision_input(f"input_{name}", ["true"], node).equals("true")
    )


def _add_decision(draft: Draft, node: Element, part: Part | None, role: str) -> tuple[str, Guard]:
    """Add the decision after a test. Return its id and the guard of the branch for true."""
    text = f"{role} is true"
    decision = _add_control_node(draft, node, f"decision after {role}", NodeKind.DECISION)
    value = _find_constant(draft, node, part, role)
    if value is not None:
        return decision, Guard(text, f.TRUE if value else f.FALSE)
    return decision, _declare_guard(draft, node, role, text)


def _find_constant(draft: Draft, node: Element, part: Part | None, role: str) -> bool | None:
    """Return the value of a test that is a literal, as of ``while (true)`` or ``else``, or None."""
    decider = draft.graph.get(_find_decider(node, role))
    if decider is not None:
        return _read_literal(draft.graph.owner(decider))
    actions = [
        action
        for action in map(draft.graph.get, part.nodes if part else ())
        if action is not None and action.kind in (Kind.ACTION, Kind.STRUCTURED)
    ]
    return _read_literal(actions[0]) if len(actions) == 1 else None


def _find_decider(node: Element, role: str) -> str:
    """Return the id of the pin whose value decides a test, or "" if the model names none."""
    if node.subkind == "loop":
        return str(node.attrs.get("decider") or "")
    outputs = node.attrs.get("clause_outputs")
    index = int(role.split()[1]) - 1
    clause = outputs[index] if isinstance(outputs, tuple) and len(outputs) > index else ()
    pins = clause[0] if isinstance(clause, tuple) and clause else ()
    return str(pins[0]) if isinstance(pins, tuple) and pins else ""


def _read_literal(action: Element | None) -> bool | None:
    if action is None or action.subkind != "value":
        return None
    return {"true": True, "false": False}.get(str(action.attrs.get("value")).lower())


def _connect_loop(draft: Draft, node: Element, parts: dict[str, Part]) -> None:
    """Connect ``begin -> setup -> merge -> test -> decision -> body -> merge``.

    In a loop that is tested last, the cycle is ``merge -> body -> test -> decision -> merge``.
    """
    begin = _add_control_node(draft, node, "begin", NodeKind.INITIAL)
    end = _add_control_node(draft, node, "end", NodeKind.SINK)
    merge = _add_control_node(draft, node, "repetition", NodeKind.MERGE)
    decision, guard = _add_decision(draft, node, parts.get("test"), "test")
    setup, test, body = (
        [parts[word].id] if word in parts else [] for word in ("setup", "test", "body")
    )
    loop_variable_flows = [
        g for g in draft.drawing.flows if g.enters and g.region == g.source.id == node.id
    ]
    loop_variables = (
        [_add_control_node(draft, node, ROUND, NodeKind.FORK)] if loop_variable_flows else []
    )
    is_tested_first = node.attrs.get("tested_first") is not False
    draft.add_path(node, begin, *setup, merge, marked=True)
    before_decision = test if is_tested_first else [*body, *test]
    after_decision = body if is_tested_first else []
    draft.add_path(node, merge, *loop_variables, *before_decision, decision)
    back_edges = draft.add_path(node, decision, *after_decision, merge, guard=guard)
    draft.back_edges[node.id] = back_edges[-1].id
    # Without this condition a loop `while (true)` would have an exit that is never taken.
    if guard.condition != f.TRUE:
        draft.add_path(node, decision, end, guard=Guard("else", None))


def _connect_expansion(draft: Draft, node: Element, part: Part) -> None:
    """Connect an expansion region: a loop over the elements, or one step if it is not iterative."""
    begin = _add_control_node(draft, node, "begin", NodeKind.INITIAL)
    end = _add_control_node(draft, node, "end", NodeKind.SINK)
    if node.attrs.get("mode") != "iterative":
        draft.add_path(node, begin, part.id, end, marked=True)
        return
    merge = _add_control_node(draft, node, "repetition", NodeKind.MERGE)
    decision = _add_control_node(draft, node, "more", NodeKind.DECISION)
    guard = _declare_guard(draft, node, "more", "there is another element")
    draft.add_path(node, begin, merge, decision, marked=True)
    draft.add_path(node, decision, part.id, merge, guard=guard)
    draft.add_path(node, decision, end, guard=Guard("else", None))


def _connect_clauses(draft: Draft, node: Element, parts: dict[str, Part]) -> None:
    """Connect ``begin -> test 1 -> decision -> body 1 -> end``, with ``else`` to the next test."""
    source = _add_control_node(draft, node, "begin", NodeKind.INITIAL)
    end = _add_control_node(draft, node, "end", NodeKind.SINK)
    marked, guard_of_next = True, None
    for number in dict.fromkeys(word.split()[1] for word in parts):
        test, body = parts.get(f"test {number}"), parts.get(f"body {number}")
        decision, guard = _add_decision(draft, node, test, f"test {number}")
        steps = [test.id] if test else []
        draft.add_path(node, source, *steps, decision, marked=marked, guard=guard_of_next)
        draft.add_path(node, decision, *([body.id] if body else []), end, guard=guard)
        source, marked, guard_of_next = decision, False, Guard("else", None)
        # A clause whose test is the literal true is the else clause: no other can follow it.
        if guard.condition == f.TRUE:
            return
    draft.add_path(node, source, end, guard=guard_of_next)


def chain_sequence_node(draft: Draft, node: Element) -> None:
    """Connect the nodes of a sequence node in the order in which they are listed."""
    if node.subkind != "sequence":
        return
    steps = [
        n
        for n in draft.drawing.nodes
        if draft.drawing.region[n.id] == node.id
        and n.kind in (Kind.ACTION, Kind.STRUCTURED)
        and n.id not in draft.chained
    ]
    for step, next_step in pairwise(steps):
        draft.add_edge(draft.exit_of(step), next_step.id, next_step, node.id)
        draft.chained.add(next_step.id)


def add_implied_start(draft: Draft, node: Element, listening_regions: Mapping[str, str]) -> None:
    """Start a node with its region, unless a flow from inside the region starts it.

    The node still waits for tokens from outside the region and from data stores (fUML 1.5, 8.10.2).
    """
    token_node, incoming = draft.nodes[node.id], draft.edges_into(node.id)
    is_executable = token_node.kind in (NodeKind.ACTION, NodeKind.STRUCTURED)
    needs_token = token_node.firing in (Firing.ALL, Firing.CHOICE, Firing.WORK)
    is_started = any(edge.region == token_node.region and not edge.keeps for edge in incoming)
    if is_started or node.id in draft.chained or not (is_executable or (needs_token and incoming)):
        return
    # An accept action without incoming flows listens again after each event (UML 2.5.1, 16.10.3).
    if node.subkind in ACCEPTS and not incoming and not draft.follows_v2:
        region = listening_regions.get(node.id, "")
        draft.add_edge(node.id, node.id, node, token_node.region, marked=not region, listens=region)
        return
    start = draft.ensure_node(node, "start", NodeKind.INITIAL, "the start", token_node.region)
    draft.add_edge(start.id, node.id, node, token_node.region, marked=True)
