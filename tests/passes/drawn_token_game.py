"""A game of tokens on a drawn activity, as UML 2.5.1 describes it in clauses 15 and 16.

The game reads the drawing and uses nothing that the compiler derives. In one step, every node moves
the tokens that it can move, as it finds them at the start of the step: an action starts, and ends
when the environment says that it is done, or after one step if it sends or assigns something; a
control node passes tokens on. An activity that is over starts again in the next step.
"""

from dataclasses import dataclass, replace
from itertools import product

from random_activities import BODIES, GUARDS, WORKERS

TAKES_ANY = ("merge", "flow-final", "object")
"""Kinds of nodes that move as soon as one incoming flow has a token."""
PASSES = ("fork", "join", "value")
"""Kinds of nodes that move when all incoming flows have a token, and take no time."""


class UnsafeError(Exception):
    """A token arrives where a token already is."""


@dataclass(frozen=True)
class Tokens:
    """A state: the flows with a token, the running actions, and the values of the properties."""

    flows: frozenset[str]
    running: frozenset[str]
    values: tuple[tuple[str, object], ...] = ()


def start(drawing):
    """Return the first state: tokens are on the flows that leave initial nodes."""
    first_flows = [
        id for id, (source, _, _) in drawing.flows.items() if drawing.nodes[source] == "initial"
    ]
    values = (("x", 0), ("y", False)) if drawing.bodies else ()
    return Tokens(frozenset(first_flows), frozenset(), values)


def is_over(drawing, tokens):
    """Whether a token is at an activity final, or no token can move any more."""
    for node, kind in drawing.nodes.items():
        if kind == "final" and tokens.flows & {*drawing.incoming(node)}:
            return True
    return not tokens.running and not any(
        _can_move(drawing, node, tokens) for node in drawing.nodes
    )


def _can_move(drawing, node, tokens):
    incoming = drawing.incoming(node)
    ready = [flow for flow in incoming if flow in tokens.flows]
    return bool(ready) and (drawing.nodes[node] in TAKES_ANY or len(ready) == len(incoming))


def compute_next_states(drawing, tokens, inputs):
    """Return the states that may follow.

    *inputs* are the ids of the actions that end in this step, and the guards that hold.
    """
    if is_over(drawing, tokens):
        return {start(drawing)}
    step = _Step(drawing, tokens, inputs)
    for node, kind in drawing.nodes.items():
        step.move(node, kind)
    return set(step.iter_results())


class _Step:
    """The moves of one step; every move depends on the tokens at the start of the step."""

    def __init__(self, drawing, tokens, inputs):
        self.drawing, self.tokens = drawing, tokens
        self.consumed, self.produced, self.choices, self.writers = set(), [], [], {}
        self.values = dict(tokens.values)
        true_guards = (
            guard for guard, holds in GUARDS.items() if self.values and holds(self.values)
        )
        self.inputs = {*inputs, *true_guards}
        self.running = set(tokens.running)

    def move(self, node, kind):
        incoming, outgoing = self.drawing.incoming(node), self.drawing.outgoing(node)
        ready = [flow for flow in incoming if flow in self.tokens.flows]
        has_all = bool(incoming) and len(ready) == len(incoming)
        # Flows that interrupt the same region count as one.
        reasons = {self.drawing.interrupts.get(flow, flow) for flow in ready}
        if kind in TAKES_ANY and len(reasons) > 1 and outgoing:
            raise UnsafeError
        if (kind in TAKES_ANY and ready) or (kind in PASSES and has_all):
            self.consumed.update(ready)
            self.produced += outgoing
        elif kind == "decision" and has_all:
            self._decide(ready, outgoing)
        elif kind in WORKERS:
            self._work(node, kind, ready if has_all else [], outgoing)

    def _decide(self, ready, outgoing):
        open_flows = _list_open_flows(self.drawing, outgoing, self.inputs)
        if open_flows:
            self.consumed.update(ready)
            self.choices.append(open_flows)

    def _work(self, node, kind, ready, outgoing):
        if node not in self.tokens.running:
            if ready:
                self.consumed.update(ready)
                self.running.add(node)
        elif ready:
            raise UnsafeError
        elif kind == "send" or node in self.drawing.bodies or node in self.inputs:
            self.running.remove(node)
            self.produced += outgoing
            if node in self.drawing.bodies:
                name, value = BODIES[self.drawing.bodies[node]]
                self.writers.setdefault(name, []).append(value(self.values))

    def iter_results(self):
        """Yield the state after the step for each choice of branches and of written values."""
        for chosen in product(*self.choices):
            produced = [*self.produced, *chosen]
            produced += [flow for flow in self.drawing.implied if self._starts_to_wait(flow)]
            tokens = _move_tokens(self.tokens, self.consumed, produced, self.running)
            tokens = self._interrupt_regions(tokens, produced)
            for written in product(*self.writers.values()):
                values = self.values | dict(zip(self.writers, written, strict=True))
                yield replace(tokens, values=tuple(values.items()))

    def _starts_to_wait(self, flow):
        """Whether a token enters the region of an accept action that does not wait yet."""
        node, _, _ = self.drawing.flows[flow]
        is_waiting = flow in self.tokens.flows or node in self.tokens.running
        return not is_waiting and self._is_entered(self._find_innermost_region(node))

    def _find_innermost_region(self, node):
        return min((nodes for nodes in self.drawing.regions.values() if node in nodes), key=len)

    def _is_entered(self, nodes):
        ends = (self.drawing.flows[flow] for flow in self.consumed)
        return any(source not in nodes and target in nodes for source, target, _ in ends)

    def _interrupt_regions(self, tokens, produced):
        """Remove the tokens and the running actions of each region that a new token interrupts."""
        interrupts = self.drawing.interrupts
        for region in {interrupts[flow] for flow in produced if flow in interrupts}:
            nodes = self.drawing.regions[region]
            inside = {id for id, (a, b, _) in self.drawing.flows.items() if {a, b} <= nodes}
            tokens = replace(tokens, flows=tokens.flows - inside, running=tokens.running - nodes)
        return tokens


def _list_open_flows(drawing, outgoing, inputs):
    guards = {flow: drawing.flows[flow][2] for flow in outgoing}
    true = [flow for flow, guard in guards.items() if guard in inputs]
    return true or [flow for flow, guard in guards.items() if guard == "else"]


def _move_tokens(tokens, consumed, produced, running):
    remaining = tokens.flows - consumed
    if len({*produced}) < len(produced) or remaining & {*produced}:
        raise UnsafeError
    return Tokens(remaining | {*produced}, frozenset(running))
