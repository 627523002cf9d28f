"""What starts and follows by itself: parts of loops and conditionals, sequences, first actions."""

from itertools import pairwise

from sysmlc.ir import Element, Kind
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import Firing, Guard, NodeKind, TokenNode
from sysmlc.logic.names import identifier
from sysmlc.passes.activities.draft import Draft
from sysmlc.passes.activities.regions import Part

ACCEPTS = ("accept", "accept-call")
"""Actions that wait for an event."""
ROUND = "round"
"""Role of the node that gives the values of loop variables to what no part of the loop lists."""


def add_parts(draft: Draft, node: Element) -> None:
    """Add the parts of a loop or conditional node and the order in which they run."""
    parts = draft.drawing.parts.get(node.id, [])
    for part in parts:
        label = f"the {part.word} of {draft.drawing.labels[node.id]}"
        short = f"{identifier(part.word)}_{draft.short[node.id]}"
        run = draft.inputs.names.new(f"run_{short}")
        made = TokenNode(part.id, NodeKind.STRUCTURED, label, node.id, node.id, run=run)
        draft.put(made, short)
    words = {part.word: part for part in parts}
    if parts and node.subkind == "loop":
        _add_loop(draft, node, words)
    elif parts and node.subkind == "expansion":
        _add_expansion(draft, node, parts[0])
    elif parts:
        _add_clauses(draft, node, words)


def _inner(draft: Draft, node: Element, role: str, kind: NodeKind) -> str:
    label = f"the {role} of {draft.drawing.labels[node.id]}"
    return draft.extra(node, role, kind, label, node.id).id


def _answer(draft: Draft, node: Element, role: str, text: str) -> Guard:
    """The guard that an input of the environment is true."""
    name = identifier(f"{role}_{draft.short[node.id]}")
    return Guard(text, draft.inputs.answer(f"input_{name}", ["true"], node).equals("true"))


def _test(draft: Draft, node: Element, part: Part | None, role: str) -> tuple[str, Guard]:
    """A decision after a test, and the guard that the test is true."""
    text = f"{role} is true"
    decision = _inner(draft, node, f"decision after {role}", NodeKind.DECISION)
    value = _constant(draft, node, part, role)
    if value is not None:
        return decision, Guard(text, f.TRUE if value else f.FALSE)
    return decision, _answer(draft, node, role, text)


def _constant(draft: Draft, node: Element, part: Part | None, role: str) -> bool | None:
    """The value of a test that is a literal: ``else``, ``while (true)``."""
    decider = draft.graph.get(_decider(node, role))
    if decider is not None:
        return _literal(draft.graph.owner(decider))
    works = [
        one
        for one in map(draft.graph.get, part.nodes if part else ())
        if one is not None and one.kind in (Kind.ACTION, Kind.STRUCTURED)
    ]
    return _literal(works[0]) if len(works) == 1 else None


def _decider(node: Element, role: str) -> str:
    """The id of the pin whose value a test is about, as far as the model names one."""
    if node.subkind == "loop":
        return str(node.attrs.get("decider") or "")
    found = node.attrs.get("clause_outputs")
    place = int(role.split()[1]) - 1
    clause = found[place] if isinstance(found, tuple) and len(found) > place else ()
    pins = clause[0] if isinstance(clause, tuple) and clause else ()
    return str(pins[0]) if isinstance(pins, tuple) and pins else ""


def _literal(action: Element | None) -> bool | None:
    if action is None or action.subkind != "value":
        return None
    return {"true": True, "false": False}.get(str(action.attrs.get("value")).lower())


def _add_loop(draft: Draft, node: Element, parts: dict[str, Part]) -> None:
    start = _inner(draft, node, "begin", NodeKind.INITIAL)
    end = _inner(draft, node, "end", NodeKind.SINK)
    again = _inner(draft, node, "repetition", NodeKind.MERGE)
    decision, guard = _test(draft, node, parts.get("test"), "test")
    setup, test, body = (
        [parts[word].id] if word in parts else [] for word in ("setup", "test", "body")
    )
    loose = [g for g in draft.drawing.flows if g.enters and g.region == g.source.id == node.id]
    given = [_inner(draft, node, ROUND, NodeKind.FORK)] if loose else []
    is_first = node.attrs.get("tested_first") is not False
    draft.path(node, start, *setup, again, marked=True)
    draft.path(node, again, *given, *(test if is_first else [*body, *test]), decision)
    back = draft.path(node, decision, *(body if is_first else []), again, guard=guard)
    draft.rounds[node.id] = [back[-1].id]
    if guard.condition != f.TRUE:
        draft.path(node, decision, end, guard=Guard("else", None))


def _add_expansion(draft: Draft, node: Element, part: Part) -> None:
    """One round for each element, or one for all of them at once."""
    start = _inner(draft, node, "begin", NodeKind.INITIAL)
    end = _inner(draft, node, "end", NodeKind.SINK)
    if node.attrs.get("mode") != "iterative":
        draft.path(node, start, part.id, end, marked=True)
        return
    again = _inner(draft, node, "repetition", NodeKind.MERGE)
    decision = _inner(draft, node, "more", NodeKind.DECISION)
    guard = _answer(draft, node, "more", "there is another element")
    draft.path(node, start, again, decision, marked=True)
    draft.path(node, decision, part.id, again, guard=guard)
    draft.path(node, decision, end, guard=Guard("else", None))


def _add_clauses(draft: Draft, node: Element, parts: dict[str, Part]) -> None:
    before = _inner(draft, node, "begin", NodeKind.INITIAL)
    end = _inner(draft, node, "end", NodeKind.SINK)
    marked, otherwise = True, None
    for number in dict.fromkeys(word.split()[1] for word in parts):
        test, body = parts.get(f"test {number}"), parts.get(f"body {number}")
        decision, guard = _test(draft, node, test, f"test {number}")
        steps = [test.id] if test else []
        draft.path(node, before, *steps, decision, marked=marked, guard=otherwise)
        draft.path(node, decision, *([body.id] if body else []), end, guard=guard)
        before, marked, otherwise = decision, False, Guard("else", None)
        if guard.condition == f.TRUE:
            return
    draft.path(node, before, end, guard=otherwise)


def add_order(draft: Draft, node: Element) -> None:
    """Let the nodes of a sequence node follow each other."""
    if node.subkind != "sequence":
        return
    inside = [
        n
        for n in draft.drawing.nodes
        if draft.drawing.region[n.id] == node.id
        and n.kind in (Kind.ACTION, Kind.STRUCTURED)
        and n.id not in draft.chained
    ]
    for before, after in pairwise(inside):
        draft.link(draft.exit(before), after.id, after, node.id)
        draft.chained.add(after.id)


def add_start(draft: Draft, node: Element) -> None:
    """Let a node start with its region when no flow from inside the region starts it.

    It still waits for what flows from outside and from data stores bring (fUML 1.5, 8.10.2).
    """
    made, reaching = draft.nodes[node.id], draft.reaching(node.id)
    works = made.kind in (NodeKind.ACTION, NodeKind.STRUCTURED)
    waits = made.firing in (Firing.ALL, Firing.CHOICE, Firing.WORK)
    is_started = any(edge.region == made.region and not edge.keeps for edge in reaching)
    if is_started or node.id in draft.chained or not (works or (waits and reaching)):
        return
    if node.subkind in ACCEPTS and not reaching:
        region = draft.listening.get(node.id, "")
        draft.link(node.id, node.id, node, made.region, marked=not region, listens=region)
        return
    start = draft.extra(node, "start", NodeKind.INITIAL, "the start", made.region)
    draft.link(start.id, node.id, node, made.region, marked=True)
