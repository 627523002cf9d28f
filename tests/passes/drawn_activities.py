"""Random activities as they are drawn, and a game of tokens on the drawing.

The game reads elements of the graph and none of the compiler's derivations (UML 2.5.1, clauses
15 and 16). In one step every node moves the tokens that it can move, as it finds them at the start
of the step: actions start, and end when the environment says so; control nodes pass tokens on. What
is over starts anew in the next step.
"""

import random
from dataclasses import dataclass, field, replace
from itertools import product

TAKES_ANY = ("merge", "flow-final", "object")
PASSES = ("fork", "join", "value")
WORKS = ("opaque", "send", "accept")

PROPERTIES = [
    '    Property x "x" default=0',
    "      -> typed-by int",
    '    Property y "y" default=false',
    "      -> typed-by bool",
    '    Constraint r body="0 <= x <= 2"',
]
TYPES = ['  DataType int "Integer"', '  DataType bool "Boolean"']
BODIES = {
    "x := x + 1": ("x", lambda now: min(now["x"] + 1, 2)),
    "x := 0": ("x", lambda now: 0),
    "x := if y ? 2 else x": ("x", lambda now: 2 if now["y"] else now["x"]),
    "y := not y": ("y", lambda now: not now["y"]),
    "y := x > 0": ("y", lambda now: now["x"] > 0),
}
"""What may be assigned, with what it means in the words of this game."""
GUARDS = {"x < 2": lambda now: now["x"] < 2, "y": lambda now: now["y"]}


@dataclass
class Drawing:
    """Nodes by id with what they are, flows by id with source, target and guard."""

    nodes: dict[str, str] = field(default_factory=dict)
    flows: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    objects: set[str] = field(default_factory=set)
    """Flows that carry objects, from pin to pin."""
    bodies: dict[str, str] = field(default_factory=dict)
    """What actions assign when they are done."""
    regions: dict[str, set[str]] = field(default_factory=dict)
    """Interruptible regions with their nodes."""
    interrupts: dict[str, str] = field(default_factory=dict)
    """Flows that interrupt a region."""
    unseen: set[str] = field(default_factory=set)
    """Flows from accept actions to themselves: nobody draws them, they listen again."""

    def incoming(self, node):
        return [id for id, (_, target, _) in self.flows.items() if target == node]

    def outgoing(self, node):
        return [id for id, (source, _, _) in self.flows.items() if source == node]

    def text(self):
        """The activity in IR text."""
        lines = ['Package p "P"', '  Activity a "a"', *(PROPERTIES if self.bodies else [])]
        lines += [f'    Structured {id} "{id}" subkind="interruptible"' for id in self.regions]
        for id, kind in self.nodes.items():
            lines += self._node(id, kind)
        for id in [id for id in self.flows if id not in self.unseen]:
            source, target, guard = self.flows[id]
            word = "ObjectFlow" if id in self.objects else "ControlFlow"
            ends = (self._pin(source, id, "o"), self._pin(target, id, "i"))
            shown = f' guard="{guard}"' if guard else ""
            shown += f' interrupts="{self.interrupts[id]}"' if id in self.interrupts else ""
            lines += [f"    {word} {id}{shown}", f"      -> flow-source {ends[0]}"]
            lines += [f"      -> flow-target {ends[1]}"]
        return "\n".join([*lines, *(TYPES if self.bodies else [])]) + "\n"

    def _node(self, id, kind):
        if kind in (*WORKS, "value"):
            body = f' body="{self.bodies[id]}"' if id in self.bodies else ""
            yield f'    Action {id} "{id}"{body} subkind="{kind}"'
            yield from self._around(id)
            for flow in sorted(self.objects):
                source, target, _ = self.flows[flow]
                for end, word in ((source, "o"), (target, "i")):
                    if end == id:
                        way = {"o": "out", "i": "in"}[word]
                        yield f'      Pin {id}{word}{flow} "{word}{flow}" direction="{way}"'
        elif kind == "object":
            yield f'    ObjectNode {id} "{id}" subkind="central-buffer"'
        else:
            yield f'    Control {id} "" subkind="{kind}"'
            yield from self._around(id)

    def _around(self, id):
        around = [region for region, nodes in self.regions.items() if id in nodes]
        if around:
            yield f"      -> in-partition {' '.join(around)}"

    def _pin(self, node, flow, word):
        is_pinned = flow in self.objects and self.nodes[node] != "object"
        return f"{node}{word}{flow}" if is_pinned else node


class Pencil:
    """Draws a random activity."""

    def __init__(self, seed):
        self.dice = random.Random(seed)
        self.drawing = Drawing()
        self.left = self.dice.randint(2, 7)
        self.guards = 0

    def drawn(self):
        first, last = self.part(0)
        self.flow(self.node("initial"), first)
        if self.dice.random() < 0.7:
            self.flow(last, self.node("final"))
        return self.drawing

    def node(self, kind):
        id = f"n{len(self.drawing.nodes)}"
        self.drawing.nodes[id] = kind
        return id

    def flow(self, source, target, guard="", is_object=False):
        id = f"f{len(self.drawing.flows)}"
        self.drawing.flows[id] = (source, target, guard)
        if is_object:
            self.drawing.objects.add(id)
        return id

    def guard(self):
        self.guards += 1
        return f"g{self.guards}"

    def part(self, depth):
        self.left -= 1
        words = ["action"] * 3
        if self.left > 0 and depth < 4:
            words += ["row", "row", "parallel", "wide", "branch", "choice", "loop", "objects"]
            words += ["dropped", "stopped"]
        return getattr(self, f"_{self.dice.choice(words)}")(depth + 1)

    def _action(self, depth):
        made = self.node(self.dice.choice(["opaque", "opaque", "send", "accept", "value"]))
        return made, made

    def _row(self, depth):
        (a, b), (c, d) = self.part(depth), self.part(depth)
        self.flow(b, c)
        return a, d

    def _parallel(self, depth):
        return self._split(depth, self.node("fork"), self.node("join"))

    def _wide(self, depth):
        """Actions with several flows fork and join by themselves."""
        return self._split(depth, self.node("opaque"), self.node("opaque"))

    def _split(self, depth, fork, join):
        for _ in range(2):
            a, b = self.part(depth)
            self.flow(fork, a)
            self.flow(b, join)
        return fork, join

    def _branch(self, depth):
        return self._branches(depth, (self.guard(), "else"))

    def _choice(self, depth):
        """Several guards may hold, or none."""
        return self._branches(depth, (self.guard(), self.guard()))

    def _branches(self, depth, guards):
        decision, merge = self.node("decision"), self.node("merge")
        for guard in guards:
            a, b = self.part(depth)
            self.flow(decision, a, guard)
            self.flow(b, merge)
        return decision, merge

    def _loop(self, depth):
        merge, decision = self.node("merge"), self.node("decision")
        a, b = self.part(depth)
        self.flow(merge, a)
        self.flow(b, decision)
        self.flow(decision, merge, "else")
        after = self.node("opaque")
        self.flow(decision, after, self.guard())
        return merge, after

    def _objects(self, depth):
        """An action gives an object to the next one, perhaps by way of a buffer."""
        one, other = self.node("opaque"), self.node("opaque")
        if self.dice.random() < 0.5:
            between = self.node("object")
            self.flow(one, between, is_object=True)
            self.flow(between, other, is_object=True)
        else:
            self.flow(one, other, is_object=True)
        if self.dice.random() < 0.5:
            self.flow(one, other)
        return one, other

    def _dropped(self, depth):
        """One of two branches ends at a flow final."""
        return self._side(depth, "flow-final")

    def _stopped(self, depth):
        """One of two branches ends the whole activity."""
        return self._side(depth, "final")

    def _side(self, depth, kind):
        fork, (a, b), (c, d) = self.node("fork"), self.part(depth), self.part(depth)
        self.flow(fork, a)
        self.flow(fork, c)
        self.flow(d, self.node(kind))
        return fork, b


class Writer(Pencil):
    """Draws a random activity in which actions assign what guards read."""

    def _action(self, depth):
        made, _ = super()._action(depth)
        if self.drawing.nodes[made] == "opaque":
            self.drawing.bodies[made] = self.dice.choice([*BODIES])
        return made, made

    def guard(self):
        return self.dice.choice([super().guard(), *GUARDS])

    def drawn(self):
        """An activity in which at least one action assigns something."""
        made = super().drawn()
        while not made.bodies:
            self.left = self.dice.randint(2, 7)
            self.drawing, self.guards = Drawing(), 0
            made = super().drawn()
        return made


class Listener(Pencil):
    """Draws a random activity with interruptible regions in which something listens."""

    def part(self, depth):
        if self.left > 1 and depth < 3 and self.dice.random() < 0.35:
            self.left -= 1
            return self._guarded(depth + 1)
        return super().part(depth)

    def _guarded(self, depth):
        """An accept action without incoming flows interrupts a part that is entered later."""
        region = f"r{len(self.drawing.regions)}"
        self.drawing.regions[region] = set()
        before, merge = self.node("opaque"), self.node("merge")
        known = set(self.drawing.nodes)
        first, last = self.part(depth)
        listens = self.node("accept")
        inside = {one for one, kind in self.drawing.nodes.items() if one not in known}
        self.drawing.regions[region] |= {
            one for one in inside if self.drawing.nodes[one] != "object"
        }
        self.flow(before, first)
        self.drawing.unseen.add(self.flow(listens, listens))
        for source in (last, listens):
            self.drawing.interrupts[self.flow(source, merge)] = region
        return before, merge


class UnsafeError(Exception):
    """A second token comes to where one is."""


@dataclass(frozen=True)
class Tokens:
    """Flows with a token, actions that run, and what has been assigned."""

    at: frozenset[str]
    running: frozenset[str]
    values: tuple[tuple[str, object], ...] = ()


def start(drawing):
    """Tokens are on what leaves initial nodes."""
    begins = [
        id for id, (source, _, _) in drawing.flows.items() if drawing.nodes[source] == "initial"
    ]
    values = (("x", 0), ("y", False)) if drawing.bodies else ()
    return Tokens(frozenset(begins), frozenset(), values)


def is_over(drawing, tokens):
    """A token is at an activity final, or nothing can move any more."""
    for node, kind in drawing.nodes.items():
        if kind == "final" and tokens.at & {*drawing.incoming(node)}:
            return True
    return not tokens.running and not any(
        _can_move(drawing, node, tokens) for node in drawing.nodes
    )


def _can_move(drawing, node, tokens):
    given = drawing.incoming(node)
    ready = [flow for flow in given if flow in tokens.at]
    return bool(ready) and (drawing.nodes[node] in TAKES_ANY or len(ready) == len(given))


def following(drawing, tokens, inputs):
    """All ways in which a step may end; ``inputs`` are what is done, received and open (ids of
    actions, guards).
    """
    if is_over(drawing, tokens):
        return {start(drawing)}
    step = _Step(drawing, tokens, inputs)
    for node, kind in drawing.nodes.items():
        step.move(node, kind)
    return set(step.ends())


class _Step:
    """What moves in a step: everything looks at the tokens as they were."""

    def __init__(self, drawing, tokens, inputs):
        self.drawing, self.tokens = drawing, tokens
        self.taken, self.given, self.choices, self.writers = set(), [], [], {}
        self.now = dict(tokens.values)
        held = (guard for guard, holds in GUARDS.items() if self.now and holds(self.now))
        self.inputs = {*inputs, *held}
        self.running = set(tokens.running)

    def move(self, node, kind):
        incoming, outgoing = self.drawing.incoming(node), self.drawing.outgoing(node)
        ready = [flow for flow in incoming if flow in self.tokens.at]
        has_all = bool(incoming) and len(ready) == len(incoming)
        reasons = {self.drawing.interrupts.get(flow, flow) for flow in ready}
        if kind in TAKES_ANY and len(reasons) > 1 and outgoing:
            raise UnsafeError
        if (kind in TAKES_ANY and ready) or (kind in PASSES and has_all):
            self.taken.update(ready)
            self.given += outgoing
        elif kind == "decision" and has_all:
            self._decide(ready, outgoing)
        elif kind in WORKS:
            self._work(node, kind, ready if has_all else [], outgoing)

    def _decide(self, ready, outgoing):
        open_ = _open(self.drawing, outgoing, self.inputs)
        if open_:
            self.taken.update(ready)
            self.choices.append(open_)

    def _work(self, node, kind, ready, outgoing):
        if node not in self.tokens.running:
            if ready:
                self.taken.update(ready)
                self.running.add(node)
        elif ready:
            raise UnsafeError
        elif kind == "send" or node in self.inputs:
            self.running.remove(node)
            self.given += outgoing
            if node in self.drawing.bodies:
                name, value = BODIES[self.drawing.bodies[node]]
                self.writers.setdefault(name, []).append(value(self.now))

    def ends(self):
        for chosen in product(*self.choices):
            given = [*self.given, *chosen]
            given += [flow for flow in self.drawing.unseen if self._hears(flow)]
            made = _placed(self.tokens, self.taken, given, self.running)
            made = self._interrupted(made, given)
            for written in product(*self.writers.values()):
                values = self.now | dict(zip(self.writers, written, strict=True))
                yield replace(made, values=tuple(values.items()))

    def _hears(self, flow):
        """A token comes into a region around an accept action that does not listen."""
        node, _, _ = self.drawing.flows[flow]
        waits = flow in self.tokens.at or node in self.tokens.running
        return not waits and any(self._is_entered(nodes) for nodes in self._innermost(node))

    def _innermost(self, node):
        around = [nodes for nodes in self.drawing.regions.values() if node in nodes]
        return [min(around, key=len)]

    def _is_entered(self, nodes):
        ends = (self.drawing.flows[flow] for flow in self.taken)
        return any(source not in nodes and target in nodes for source, target, _ in ends)

    def _interrupted(self, made, given):
        for region in {
            self.drawing.interrupts[flow] for flow in given if flow in self.drawing.interrupts
        }:
            nodes = self.drawing.regions[region]
            inside = {id for id, (a, b, _) in self.drawing.flows.items() if {a, b} <= nodes}
            made = replace(made, at=made.at - inside, running=made.running - nodes)
        return made


def _open(drawing, outgoing, inputs):
    guards = {flow: drawing.flows[flow][2] for flow in outgoing}
    true = [flow for flow, guard in guards.items() if guard in inputs]
    return true or [flow for flow, guard in guards.items() if guard == "else"]


def _placed(tokens, taken, given, running):
    rest = tokens.at - taken
    if len({*given}) < len(given) or rest & {*given}:
        raise UnsafeError
    return Tokens(rest | {*given}, frozenset(running))
