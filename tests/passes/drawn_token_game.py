"""A game of tokens on a drawn activity, as UML 2.5.1 describes it in clauses 15 and 16.

The game reads the drawing and uses nothing that the compiler derives. In one step, actions end when
the environment says that they are done, or after one step if they send or assign something. Their
tokens pass control nodes and objects one after the other, until an action takes them: it runs in
the next step. A token waits for the next step before a decision, on a branch that a decision with
several open ones has chosen, and on a flow that interrupts a region. An activity that is over
starts again in the next step.
"""

from dataclasses import dataclass
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
    """Return the first state: tokens leave the initial nodes, and the first actions run."""
    first_flows = [
        id for id, (source, _, _) in drawing.flows.items() if drawing.nodes[source] == "initial"
    ]
    values = (("x", 0), ("y", False)) if drawing.bodies else ()
    step = _Step(drawing, Tokens(frozenset(first_flows), frozenset(), values))
    step.pass_tokens()
    return Tokens(frozenset(step.here | step.later), frozenset(step.running), values)


def is_over(drawing, tokens, inputs):
    """Whether a token reaches an activity final in this step, or nothing is left after it."""
    return any(step.is_over() for step in _iter_steps(drawing, tokens, inputs))


def compute_next_states(drawing, tokens, inputs):
    """Return the states that may follow.

    *inputs* are the ids of the actions that end in this step, and the guards that hold.
    """
    results = set()
    for step in _iter_steps(drawing, tokens, inputs):
        results |= {start(drawing)} if step.is_over() else set(step.iter_results())
    return results


def list_written_values(drawing, tokens, inputs):
    """Return the values that the properties may have after the writes of a step."""
    (step, *_) = _iter_steps(drawing, tokens, inputs)
    return list(step.iter_values())


def _iter_steps(drawing, tokens, inputs):
    """Yield the step for each choice of the branches that tokens at decisions take."""
    values = dict(tokens.values)
    true_guards = (guard for guard, holds in GUARDS.items() if values and holds(values))
    open_guards = {*inputs, *true_guards}
    decisions = []
    for node, kind in drawing.nodes.items():
        incoming, outgoing = drawing.incoming(node), drawing.outgoing(node)
        if kind == "decision" and incoming and {*incoming} <= tokens.flows:
            branches = _list_open_flows(drawing, outgoing, open_guards)
            decisions.append([(incoming, branch) for branch in branches] or [((), None)])
    for chosen in product(*decisions):
        step = _Step(drawing, tokens)
        step.end_actions(inputs)
        for incoming, branch in chosen:
            if branch is not None:
                step.take(incoming)
                step.give(branch)
        step.pass_tokens()
        yield step


class _Step:
    """One step: tokens that can move are ``here``, and ``later`` those that wait for the next."""

    def __init__(self, drawing, tokens):
        self.drawing, self.tokens = drawing, tokens
        self.here, self.later = set(tokens.flows), set()
        self.running = set(tokens.running)
        self.values, self.writers = dict(tokens.values), {}
        self.passed, self.heard = set(), set()
        self.waits = {id for id, (_, target, _) in drawing.flows.items() if self._waits(id, target)}

    def _waits(self, flow, target):
        source = self.drawing.flows[flow][0]
        guards = [self.drawing.flows[id][2] for id in self.drawing.outgoing(source)]
        is_choice = self.drawing.nodes[source] == "decision" and (
            guards.count("else") > 1 or len(guards) - guards.count("else") > 1
        )
        return is_choice or self.drawing.nodes[target] == "decision" or self._interrupts(flow)

    def _interrupts(self, flow):
        return flow in self.drawing.interrupts

    def end_actions(self, inputs):
        for node in self.tokens.running:
            body = self.drawing.bodies.get(node)
            if self.drawing.nodes[node] != "send" and body is None and node not in inputs:
                continue
            self.running.remove(node)
            for flow in self.drawing.outgoing(node):
                self.give(flow)
            if body is not None:
                name, value = BODIES[body]
                self.writers.setdefault(name, []).append(value(self.values))

    def give(self, flow):
        if flow in self.here | self.later:
            raise UnsafeError
        (self.later if flow in self.waits else self.here).add(flow)

    def pass_tokens(self):
        """Move tokens from node to node until none can move."""
        while any(self._move(node, kind) for node, kind in self.drawing.nodes.items()):
            pass

    def _move(self, node, kind):
        """Move the tokens at a node; return whether there was something to move."""
        incoming, outgoing = self.drawing.incoming(node), self.drawing.outgoing(node)
        ready = [flow for flow in incoming if flow in self.here]
        has_all = bool(incoming) and len(ready) == len(incoming)
        if kind in TAKES_ANY and ready:
            # Flows that interrupt the same region count as one.
            reasons = {self.drawing.interrupts.get(flow, flow) for flow in ready}
            if outgoing and (len(reasons) > 1 or node in self.passed):
                raise UnsafeError
        elif kind in WORKERS and has_all:
            if node in self.running:
                raise UnsafeError
            self.running.add(node)
            outgoing = []
        elif kind not in PASSES or not has_all:
            return False
        self.passed.add(node)
        self.take(ready)
        for flow in outgoing:
            self.give(flow)
        return True

    def take(self, flows):
        """Take tokens; accept actions begin to wait if one enters their region."""
        self.here.difference_update(flows)
        for flow in self.drawing.implied:
            if self._starts_to_wait(flow, flows):
                self.heard.add(flow)
                self.give(flow)

    def _starts_to_wait(self, flow, consumed):
        """Whether a token enters the region of an accept action that does not wait yet."""
        node, _, _ = self.drawing.flows[flow]
        if flow in self.tokens.flows | self.heard or node in self.tokens.running:
            return False
        regions = [nodes for nodes in self.drawing.regions.values() if node in nodes]
        innermost = min(regions, key=len)
        ends = (self.drawing.flows[flow] for flow in consumed)
        return any(source not in innermost and target in innermost for source, target, _ in ends)

    def is_over(self):
        nodes = self.drawing.nodes
        if any(nodes[self.drawing.flows[flow][1]] == "final" for flow in self.here):
            return True
        waiting = any(
            kind == "decision" and {*self.drawing.incoming(node)} <= self.here
            for node, kind in nodes.items()
            if self.drawing.incoming(node)
        )
        return not self.running and not self.later and not waiting

    def iter_results(self):
        """Yield the state after the step for each choice of written values."""
        flows, running = self.here | self.later, set(self.running)
        interrupts = self.drawing.interrupts
        for region in {interrupts[flow] for flow in self.later if flow in interrupts}:
            nodes = self.drawing.regions[region]
            flows -= {id for id, (a, b, _) in self.drawing.flows.items() if {a, b} <= nodes}
            running -= nodes
        for values in self.iter_values():
            yield Tokens(frozenset(flows), frozenset(running), values)

    def iter_values(self):
        """Yield the values of the properties after the step."""
        for written in product(*self.writers.values()):
            yield tuple((self.values | dict(zip(self.writers, written, strict=True))).items())


def _list_open_flows(drawing, outgoing, inputs):
    guards = {flow: drawing.flows[flow][2] for flow in outgoing}
    true = [flow for flow, guard in guards.items() if guard in inputs]
    return true or [flow for flow, guard in guards.items() if guard == "else"]
