"""Which assignments can leave their range, by a game on drawings that knows all its states."""

from itertools import product

import pytest
from drawn_activities import BODIES, GUARDS, WORKS, Tokens, UnsafeError, Writer, following, is_over
from drawn_activities import start as begin

from long_runs import quick_first
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.activities import saturation
from sysmlc.logic.activities import saturation as bound_search
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.passes import pipeline

EACH = 250
COUNTS = "x := x + 1"
MANY = "may (it has too many states to tell)"


class Counter(Writer):
    """Draws a random activity in which most actions count."""

    def _action(self, depth):
        made = self.node("opaque")
        self.drawing.bodies[made] = self.dice.choice([*[COUNTS] * 3, *BODIES])
        return made, made

    def guard(self):
        return super().guard() if self.dice.random() < 0.2 else self.dice.choice([*GUARDS])


def stops(drawing, values):
    """The actions that count beyond 2 in some run; None where a second token may come."""
    first = begin(drawing)
    seen = [Tokens(first.at, first.running, one) for one in values]
    known, found = set(seen), set()
    for tokens in seen:
        if not is_over(drawing, tokens) and dict(tokens.values)["x"] == 2:
            found |= {one for one in tokens.running if drawing.bodies.get(one) == COUNTS}
        try:
            ways = set(after(drawing, tokens, len(values) > 1))
        except UnsafeError:
            return None
        seen += ways - known
        known |= ways
    return found


def after(drawing, tokens, is_kept):
    """All states after one step; an x without a value at the start keeps the one that it has."""
    if is_kept and is_over(drawing, tokens):
        first = begin(drawing)
        yield Tokens(first.at, first.running, (("x", dict(tokens.values)["x"]), ("y", False)))
        return
    guards = {guard for _, _, guard in drawing.flows.values() if guard.startswith("g")}
    works = {one for one in tokens.running if drawing.nodes[one] in WORKS}
    asked = sorted(works | guards)
    for bits in product((False, True), repeat=len(asked)):
        said = {one for one, bit in zip(asked, bits, strict=True) if bit}
        yield from following(drawing, tokens, said)


def told(text):
    """What is told of each action; None where x or y is not followed."""
    graph, sink = parse_text(text), Sink()
    pipeline.run(graph, sink)
    for tokens in graph.derived(TokenGraph):
        if "x" in tokens.written_variables and "y" not in {one.name for one in tokens.inputs}:
            found = (diagnostic for diagnostic in sink if diagnostic.rule.code == "SM428")
            return {one.subject.id: said(one.message) for one in found}
    return None


def said(message):
    return message.partition("' ")[2].partition(" take")[0]


def compared(seed, is_known):
    """What stops in an activity and what is told; None where that cannot be compared."""
    drawing = Counter(seed).drawn()
    text = drawing.text()
    if not is_known:
        text = text.replace('"x" default=0', '"x"')
    ways = [(("x", 0), ("y", False))] if is_known else [(("x", n), ("y", False)) for n in range(3)]
    found = told(text) if COUNTS in drawing.bodies.values() else None
    wanted = None if found is None else stops(drawing, ways)
    return None if wanted is None else (wanted, found)


def all_compared(part, is_known):
    pairs = (compared(seed, is_known) for seed in range(part * EACH, (part + 1) * EACH))
    return [pair for pair in pairs if pair is not None]


@pytest.mark.parametrize("part", quick_first(range(4)))
@pytest.mark.parametrize("is_known", [True, False])
def test_told_is_what_can_stop_and_nothing_else(part, is_known):
    pairs = all_compared(part, is_known)
    assert len(pairs) > EACH / 7
    for wanted, found in pairs:
        assert found == dict.fromkeys(wanted, "can")
    assert any(wanted for wanted, _ in pairs)
    assert not all(wanted for wanted, _ in pairs)


@pytest.mark.parametrize("part", quick_first(range(4)))
@pytest.mark.parametrize("is_known", [True, False])
def test_without_a_search_nothing_that_can_stop_is_left_out(part, is_known, monkeypatch):
    monkeypatch.setattr(bound_search, "_MAX_MOVES", 0)
    saturation.find_saturating_writes.cache_clear()
    pairs = all_compared(part, is_known)
    saturation.find_saturating_writes.cache_clear()
    for wanted, found in pairs:
        assert {one for one, can in found.items() if can == "can"} <= wanted <= {*found}
    assert any(MANY in found.values() for _, found in pairs)
    assert not all(found for _, found in pairs)
