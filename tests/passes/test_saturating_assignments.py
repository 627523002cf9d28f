"""Assignments that can leave their range (SM428), compared with all states of a token game.

The compiler lets an assignment beyond the range saturate, and reports the actions that do so.
"""

from itertools import product

import pytest
from drawn_token_game import (
    Tokens,
    UnsafeError,
    compute_next_states,
    is_over,
    list_written_values,
    start,
)
from random_activities import BODIES, GUARDS, WORKERS, AssignmentGenerator

from long_runs import quick_first
from refinement import run_all
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.activities import saturation
from sysmlc.logic.activities.token_graph import TokenGraph

ACTIVITIES_PER_PART = 250
INCREMENT = "x := x + 1"
TOO_MANY_STATES = "may (it has too many states to tell)"


class CounterGenerator(AssignmentGenerator):
    """Draws a random activity in which most actions increment x."""

    def draw_action(self, depth):
        action = self.add_node("opaque")
        self.drawing.bodies[action] = self.dice.choice([*[INCREMENT] * 3, *BODIES])
        return action, action

    def choose_guard(self):
        if self.dice.random() < 0.2:
            return super().choose_guard()
        return self.dice.choice([*GUARDS])


def find_saturating_actions(drawing, initial_values):
    """Return the actions that increment x beyond 2 in some run; None if a second token may come."""
    first = start(drawing)
    queue = [Tokens(first.flows, first.running, values) for values in initial_values]
    visited, saturating = set(queue), set()
    for tokens in queue:
        if dict(tokens.values)["x"] == 2:
            saturating |= {id for id in tokens.running if drawing.bodies.get(id) == INCREMENT}
        try:
            successors = set(iter_next_states(drawing, tokens, len(initial_values) > 1))
        except UnsafeError:
            return None
        queue += successors - visited
        visited |= successors
    return saturating


def iter_next_states(drawing, tokens, has_free_start):
    """Yield all states after one step.

    An x without an initial value (*has_free_start*) retains its value when the activity restarts.
    """
    guards = {guard for _, _, guard in drawing.flows.values() if guard.startswith("g")}
    workers = {id for id in tokens.running if drawing.nodes[id] in WORKERS}
    free_inputs = sorted(workers | guards)
    for bits in product((False, True), repeat=len(free_inputs)):
        inputs = {name for name, bit in zip(free_inputs, bits, strict=True) if bit}
        if has_free_start and is_over(drawing, tokens, inputs):
            first = start(drawing)
            for values in list_written_values(drawing, tokens, inputs):
                retained = (("x", dict(values)["x"]), ("y", False))
                yield Tokens(first.flows, first.running, retained)
        else:
            yield from compute_next_states(drawing, tokens, inputs)


def read_reports(text):
    """Return the verdict that is reported for each action; None if x or y is an input."""
    graph, sink = parse_text(text), Sink()
    run_all(graph, sink)
    for token_graph in graph.derived(TokenGraph):
        inputs = {variable.name for variable in token_graph.inputs}
        if "x" in token_graph.written_variables and "y" not in inputs:
            reports = (diagnostic for diagnostic in sink if diagnostic.rule.code == "SM428")
            return {report.subject.id: read_verdict(report.message) for report in reports}
    return None


def read_verdict(message):
    """Return ``can`` or ``may (...)`` from ``action 'a' can take ...``."""
    return message.partition("' ")[2].partition(" take")[0]


def compare(seed, has_default):
    """Return the actions that can saturate and the reports; None if there is nothing to compare."""
    drawing = CounterGenerator(seed).draw()
    text = drawing.print_text()
    if not has_default:
        text = text.replace('"x" default=0', '"x"')
    initial_values = [(("x", n), ("y", False)) for n in ([0] if has_default else range(3))]
    reports = read_reports(text) if INCREMENT in drawing.bodies.values() else None
    expected = None if reports is None else find_saturating_actions(drawing, initial_values)
    return None if expected is None else (expected, reports)


def compare_all(part, has_default):
    seeds = range(part * ACTIVITIES_PER_PART, (part + 1) * ACTIVITIES_PER_PART)
    pairs = (compare(seed, has_default) for seed in seeds)
    return [pair for pair in pairs if pair is not None]


@pytest.mark.parametrize("part", quick_first(range(4)))
@pytest.mark.parametrize("has_default", [True, False])
def test_exactly_the_assignments_that_can_saturate_are_reported(part, has_default):
    pairs = compare_all(part, has_default)
    assert len(pairs) > ACTIVITIES_PER_PART / 7
    for expected, reports in pairs:
        assert reports == dict.fromkeys(expected, "can")
    assert any(expected for expected, _ in pairs)
    assert not all(expected for expected, _ in pairs)


@pytest.mark.parametrize("part", quick_first(range(4)))
@pytest.mark.parametrize("has_default", [True, False])
def test_without_a_search_no_assignment_that_can_saturate_is_omitted(
    part, has_default, monkeypatch
):
    monkeypatch.setattr(saturation, "_MAX_MOVES", 0)
    saturation.find_saturating_writes.cache_clear()
    pairs = compare_all(part, has_default)
    saturation.find_saturating_writes.cache_clear()
    for expected, reports in pairs:
        certain = {id for id, verdict in reports.items() if verdict == "can"}
        assert certain <= expected <= {*reports}
    assert any(TOO_MANY_STATES in reports.values() for _, reports in pairs)
    assert not all(reports for _, reports in pairs)
