"""What starts and follows by itself: parts of loops and conditionals, sequences, first actions."""

from itertools import pairwise

from sysmlc.ir import Element, Kind
from sysmlc.logic.names import identifier
from sysmlc.logic.tokens import Guard, NodeKind, TokenNode
from sysmlc.passes.activity_draft import Draft
from sysmlc.passes.activity_regions import Part

ACCEPTS = ("accept", "accept-call")
"""Actions that wait for an event."""


def add_parts(draft: Draft, node: Element) -> None:
    """Add the parts of a loop or conditional node and the order in which they run."""
    parts = draft.drawing.parts.get(node.id, [])
    for part in parts:
        label = f"the {part.word} of {draft.drawing.labels[node.id]}"
        short = f"{identifier(part.word)}_{draft.short[node.id]}"
        run = draft.inputs.names.new(f"run_{short}")
        made = TokenNode(part.id, NodeKind.STRUCTURED, label, node.id, node.id, run=run)
        draft.put(made, short)
    if parts and node.subkind == "loop":
        _add_loop(draft, node, {part.word: part for part in parts})
    elif parts:
        _add_clauses(draft, node, parts)


def _inner(draft: Draft, node: Element, role: str, kind: NodeKind) -> str:
    label = f"the {role} of {draft.drawing.labels[node.id]}"
    return draft.extra(node, role, kind, label, node.id).id


def _test(draft: Draft, node: Element, role: str) -> tuple[str, Guard]:
    """A decision after a test, and the guard that the test is true."""
    decision = _inner(draft, node, role, NodeKind.DECISION)
    name = identifier(f"{role}_{draft.short[node.id]}")
    answer = draft.inputs.answer(f"input_{name}", ["true"], node)
    return decision, Guard(f"{role} is true", answer.equals("true"))


def _add_loop(draft: Draft, node: Element, parts: dict[str, Part]) -> None:
    start = _inner(draft, node, "begin", NodeKind.INITIAL)
    end = _inner(draft, node, "end", NodeKind.SINK)
    again = _inner(draft, node, "repetition", NodeKind.MERGE)
    decision, guard = _test(draft, node, "test")
    setup, test, body = (
        [parts[word].id] if word in parts else [] for word in ("setup", "test", "body")
    )
    is_first = node.attrs.get("tested_first") is not False
    draft.path(node, start, *setup, again, marked=True)
    draft.path(node, again, *(test if is_first else [*body, *test]), decision)
    draft.path(node, decision, *(body if is_first else []), again, guard=guard)
    draft.path(node, decision, end, guard=Guard("else", None))


def _add_clauses(draft: Draft, node: Element, parts: list[Part]) -> None:
    before = _inner(draft, node, "begin", NodeKind.INITIAL)
    end = _inner(draft, node, "end", NodeKind.SINK)
    marked, otherwise = True, None
    words = {part.word: part for part in parts}
    for number in dict.fromkeys(part.word.split()[1] for part in parts):
        test, body = words.get(f"test {number}"), words.get(f"body {number}")
        decision, guard = _test(draft, node, f"test {number}")
        steps = [test.id] if test else []
        draft.path(node, before, *steps, decision, marked=marked, guard=otherwise)
        draft.path(node, decision, *([body.id] if body else []), end, guard=guard)
        before, marked, otherwise = decision, False, Guard("else", None)
    draft.path(node, before, end, guard=otherwise)


def add_order(draft: Draft, node: Element) -> None:
    """Let the nodes of a sequence node follow each other."""
    if node.subkind != "sequence":
        return
    inside = [
        n
        for n in draft.drawing.nodes
        if draft.drawing.region[n.id] == node.id and n.kind in (Kind.ACTION, Kind.STRUCTURED)
    ]
    for before, after in pairwise(inside):
        draft.link(before.id, after.id, after, node.id)
        draft.chained.add(after.id)


def add_start(draft: Draft, node: Element) -> None:
    """Let an action without incoming flows start with its region."""
    made = draft.nodes[node.id]
    works = made.kind in (NodeKind.ACTION, NodeKind.STRUCTURED)
    if not works or draft.incoming[node.id] or node.id in draft.chained:
        return
    if node.subkind in ACCEPTS:
        draft.link(node.id, node.id, node, made.region, marked=True)
        return
    start = draft.extra(node, "start", NodeKind.INITIAL, "the start", made.region)
    draft.link(start.id, node.id, node, made.region, marked=True)
