"""Random well-formed activities as graphs, their token graphs, and random runs of them.

A block is a tuple: ("act",), ("seq", a, b), ("par", a, b), ("if", a, b), ("loop", a), or ("sub", a)
for a structured node. Each has one entry and one exit. ``rich_blocks`` also draws structured nodes
of all kinds, exceptions, data stores and interruptible regions.
"""

import random
from collections.abc import Callable, Iterator

from hypothesis import strategies as st
from msgspec.structs import replace

from sysmlc.analyses.activities import Activities
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.element import AttrValue
from sysmlc.logic import evaluate
from sysmlc.logic.activities import interpreter
from sysmlc.logic.activities.derivation import list_variables
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Handshake
from sysmlc.logic.contract import Owner
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Literal

Block = tuple
Valuation = dict[str, Literal]


def blocks(max_leaves: int = 6) -> st.SearchStrategy[Block]:
    """Draw blocks of the simple kinds."""
    words = ("act", "act", "act", "send", "value", "accept", "change")
    leaf = st.sampled_from([(word,) for word in words])
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(st.just("seq"), inner, inner),
            st.tuples(st.just("par"), inner, inner),
            st.tuples(st.just("if"), inner, inner),
            st.tuples(st.just("choose"), inner, inner),
            st.tuples(st.just("loop"), inner),
            st.tuples(st.just("sub"), inner),
        ),
        max_leaves=max_leaves,
    )


def rich_blocks(max_leaves: int = 5) -> st.SearchStrategy[Block]:
    """Draw blocks of all kinds."""
    words = ("act", "act", "act", "send", "value", "accept", "change", "raise")
    leaf = st.sampled_from([(word,) for word in words])
    unary = ("loop", "sub", "each", "all", "store", "stop", "cross", "outward", "chain")
    binary = ("seq", "par", "if", "choose", "while", "case", "try", "ask")
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            *(st.tuples(st.just(word), inner) for word in unary),
            *(st.tuples(st.just(word), inner, inner) for word in binary),
        ),
        max_leaves=max_leaves,
    )


class Canvas:
    """Draws an activity into a graph."""

    def __init__(self) -> None:
        self.graph = Graph()
        self.owner = self.graph.add(Element("a", Kind.ACTIVITY, "a"))
        self.count = 0

    def node(self, kind: Kind, subkind: str, name: str = "", **attrs: AttrValue) -> Element:
        self.count += 1
        node = Element(f"n{self.count}", kind, name, self.owner.id)
        node.attrs.update({"subkind": subkind, **attrs})
        return self.graph.add(node)

    def control(self, subkind: str) -> Element:
        return self.node(Kind.CONTROL, subkind)

    def flow(self, source: Element, target: Element, guard: str = "") -> Element:
        self.count += 1
        flow = Element(f"f{self.count}", Kind.CONTROL_FLOW, "", self.owner.id)
        if guard:
            flow.attrs["guard"] = guard
        self.graph.add(flow)
        self.graph.connect(Edge.FLOW_SOURCE, flow, source)
        self.graph.connect(Edge.FLOW_TARGET, flow, target)
        return flow

    def draw(self, block: Block) -> tuple[Element, Element]:
        return getattr(self, f"_{block[0]}")(*block[1:])

    def _act(self) -> tuple[Element, Element]:
        node = self.node(Kind.ACTION, "opaque", f"w{self.count}")
        return node, node

    def _send(self) -> tuple[Element, Element]:
        node = self.node(Kind.ACTION, "send", f"s{self.count}")
        return node, node

    def _value(self) -> tuple[Element, Element]:
        node = self.node(Kind.ACTION, "value", f"v{self.count}")
        return node, node

    def _accept(self) -> tuple[Element, Element]:
        node = self.node(Kind.ACTION, "accept", f"e{self.count}")
        return node, node

    def _change(self) -> tuple[Element, Element]:
        """Draw an action that waits, as in UML, until a condition becomes true."""
        node = self.node(Kind.ACTION, "accept", f"e{self.count}")
        attrs: dict[str, AttrValue] = {"subkind": "change", "condition": "hot"}
        trigger = self.graph.add(Element(f"t{self.count}", Kind.TRIGGER, "", node.id, attrs=attrs))
        self.graph.connect(Edge.TRIGGER, node, trigger)
        return node, node

    def _seq(self, first: Block, second: Block) -> tuple[Element, Element]:
        (a, b), (c, d) = self.draw(first), self.draw(second)
        self.flow(b, c)
        return a, d

    def _par(self, first: Block, second: Block) -> tuple[Element, Element]:
        fork, join = self.control("fork"), self.control("join")
        for part in (first, second):
            a, b = self.draw(part)
            self.flow(fork, a)
            self.flow(b, join)
        return fork, join

    def _branches(
        self, parts: tuple[Block, Block], guards: tuple[str, str]
    ) -> tuple[Element, Element]:
        decision, merge = self.control("decision"), self.control("merge")
        for part, guard in zip(parts, guards, strict=True):
            a, b = self.draw(part)
            self.flow(decision, a, guard)
            self.flow(b, merge)
        return decision, merge

    def _if(self, first: Block, second: Block) -> tuple[Element, Element]:
        return self._branches((first, second), (f"g{self.count}", "else"))

    def _choose(self, first: Block, second: Block) -> tuple[Element, Element]:
        """Guards of which both or none may hold."""
        return self._branches((first, second), (f"g{self.count}", f"h{self.count}"))

    def _loop(self, body: Block) -> tuple[Element, Element]:
        merge, decision = self.control("merge"), self.control("decision")
        a, b = self.draw(body)
        done = self.control("merge")
        self.flow(merge, a)
        self.flow(b, decision)
        self.flow(decision, merge, f"again{self.count}")
        self.flow(decision, done, "else")
        return merge, done

    def _sub(self, body: Block) -> tuple[Element, Element]:
        node = self.node(Kind.STRUCTURED, "structured", f"sub{self.count}")
        outer_owner, self.owner = self.owner, node
        start = self.control("initial")
        a, _ = self.draw(body)
        self.flow(start, a)
        self.owner = outer_owner
        return node, node

    # -- rich blocks -----------------------------------------------------------------------

    def _raise(self) -> tuple[Element, Element]:
        node = self.node(Kind.ACTION, "raise", f"r{self.count}")
        return node, node

    def draw_inside(
        self, owner: Element, *parts: Block
    ) -> list[tuple[list[str], Element, Element]]:
        """Draw blocks in a structured node.

        Return the ids of the executable nodes, the entry and the exit of each block.
        """
        outer_owner, self.owner, drawn = self.owner, owner, []
        for part in parts:
            ids_before = {node.id for node in self.graph.owned(owner)}
            first, last = self.draw(part)
            nodes = [node for node in self.graph.owned(owner) if node.id not in ids_before]
            executable = [node.id for node in nodes if node.kind in (Kind.ACTION, Kind.STRUCTURED)]
            drawn.append((executable, first, last))
        self.owner = outer_owner
        return drawn

    def box(self, subkind: str, name: str) -> Element:
        return self.node(Kind.STRUCTURED, subkind, f"{name}{self.count}")

    def start(self, owner: Element, first: Element) -> None:
        """Add an action that starts a block whose entry is a merge or a fork."""
        if first.kind is Kind.CONTROL:
            outer_owner, self.owner = self.owner, owner
            self.flow(self.node(Kind.ACTION, "value", f"v{self.count}"), first)
            self.owner = outer_owner

    def _while(self, test: Block, body: Block) -> tuple[Element, Element]:
        loop = self.box("loop", "while")
        (test_ids, _, _), (body_ids, body_entry, _) = self.draw_inside(
            loop, ("seq", ("value",), test), body
        )
        self.start(loop, body_entry)
        loop.attrs.update(test=tuple(test_ids), body_part=tuple(body_ids), tested_first=True)
        return loop, loop

    def _case(self, first: Block, second: Block) -> tuple[Element, Element]:
        conditional = self.box("conditional", "case")
        drawn = self.draw_inside(
            conditional, ("act",), ("seq", ("value",), first), ("value",), second
        )
        for _, entry, _ in drawn[1:]:
            self.start(conditional, entry)
        ids_of_parts = [ids for ids, _, _ in drawn]
        conditional.attrs["clauses"] = (
            (tuple(ids_of_parts[0]), tuple(ids_of_parts[1])),
            (tuple(ids_of_parts[2]), tuple(ids_of_parts[3])),
        )
        return conditional, conditional

    def _each(self, body: Block) -> tuple[Element, Element]:
        region = self.box("expansion", "each")
        region.attrs["mode"] = "iterative"
        ((_, first, _),) = self.draw_inside(region, body)
        self.start(region, first)
        return region, region

    def _all(self, body: Block) -> tuple[Element, Element]:
        region, _ = self._each(body)
        region.attrs["mode"] = "parallel"
        return region, region

    def _cross(self, body: Block) -> tuple[Element, Element]:
        """Flows cross the border of a structured node in both directions."""
        fork, join, node = self.control("fork"), self.control("join"), self.box("", "cross")
        ((_, first, last),) = self.draw_inside(node, body)
        self.flow(fork, node)
        self.flow(fork, first)
        self.flow(last, join)
        self.flow(node, join)
        return fork, join

    def _outward(self, body: Block) -> tuple[Element, Element]:
        """An action in a structured node passes a token outside while the node still runs."""
        node, watch = self.box("", "outer"), self.node(Kind.ACTION, "opaque", "watch")
        (_, first, _), _ = self.draw_inside(node, ("seq", ("act",), body), ("act",))
        self.flow(first, watch)
        join = self.control("join")
        self.flow(watch, join)
        self.flow(node, join)
        return node, join

    def _chain(self, body: Block) -> tuple[Element, Element]:
        sequence = self.box("sequence", "chain")
        self.draw_inside(sequence, ("act",), ("sub", body), ("value",))
        return sequence, sequence

    def _try(self, body: Block, repair: Block) -> tuple[Element, Element]:
        protected, handler = self.box("structured", "try"), self.box("structured", "catch")
        for owner, block in ((protected, body), (handler, repair)):
            ((_, first, _),) = self.draw_inside(owner, block)
            self.start(owner, first)
        protected.attrs["handlers"] = (((handler.id,), (), ()),)
        return protected, protected

    def _ask(self, first: Block, second: Block) -> tuple[Element, Element]:
        """A decision on a value with guards for two values; for other values the activity stops."""
        decision, merge = self._branches((first, second), ("1", "2"))
        decision.attrs["decision_input"] = "b"
        for flow in self.graph.sources(decision, Edge.FLOW_SOURCE):
            flow.attrs["guard_literal"] = True
        return decision, merge

    def _store(self, body: Block) -> tuple[Element, Element]:
        """A data store that two actions read."""
        store = self.node(Kind.DATA_STORE, "", f"store{self.count}")
        write, read = (self.node(Kind.ACTION, "opaque", f"{w}{self.count}") for w in "wr")
        first, last = self.draw(body)
        second_read = self.node(Kind.ACTION, "value", f"again{self.count}")
        for source, target in ((write, read), (read, first), (last, second_read)):
            self.flow(source, target)
        for source, target in ((write, store), (store, read), (store, second_read)):
            self.flow(source, target)
        return write, second_read

    def _stop(self, body: Block) -> tuple[Element, Element]:
        """A block in an interruptible region beside an event that interrupts it."""
        region = self.node(Kind.STRUCTURED, "interruptible", f"busy{self.count}")
        fork, merge = self.control("fork"), self.control("merge")
        before = {n.id for n in self.graph.owned(self.owner)}
        first, last = self.draw(body)
        stop = self.node(Kind.ACTION, "accept", f"stop{self.count}")
        for node in self.graph.owned(self.owner):
            if node.id not in before and node.kind not in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
                self.graph.connect(Edge.IN_PARTITION, node, region)
        self.flow(fork, first)
        self.flow(fork, stop)
        for source in (last, stop):
            self.flow(source, merge).attrs["interrupts"] = region.id
        return fork, merge


def draw_activity(block: Block, has_final: bool = True) -> Graph:
    """Return an activity with a block between an initial node and, perhaps, a final node."""
    canvas = Canvas()
    start = canvas.control("initial")
    first, last = canvas.draw(block)
    canvas.flow(start, first)
    if has_final:
        canvas.flow(last, canvas.control("final"))
    return canvas.graph


def build_tokens(graph: Graph, make: Callable[[], Activities] = Activities) -> TokenGraph:
    """Return the token graph of the only activity, which is repeated."""
    make().run(graph, Sink())
    (tokens,) = graph.derived(TokenGraph)
    return perform(tokens, "repeated")


_STOP_PROBABILITY = 0.05


def perform(tokens: TokenGraph, way: str) -> TokenGraph:
    """Return the activity as it is performed: repeated, once, or started and stopped by others."""
    handshakes = {
        "repeated": None,
        "once": Handshake("running_a", "finished_a", is_started=True),
        "called": Handshake("running_a", "finished_a", "start_a"),
        "do": Handshake("running_a", "finished_a", "start_a", "stop_a"),
        "main and called": Handshake("running_a", "finished_a", "start_a", is_started=True),
    }
    return replace(tokens, handshake=handshakes[way])


WAYS = ("repeated", "once", "called", "do", "main and called")
"""The ways in which activities are performed."""


def draw_inputs(tokens: TokenGraph, dice: random.Random) -> Valuation:
    inputs = [v for v in list_variables(tokens) if v.owner is Owner.ENVIRONMENT]
    drawn = {variable.name: dice.choice(values(variable.domain)) for variable in inputs}
    # A performance that is stopped in every second step would never get far.
    if tokens.handshake is not None and tokens.handshake.stop:
        drawn[tokens.handshake.stop] = dice.random() < _STOP_PROBABILITY
    return drawn


def play(
    tokens: TokenGraph, dice: random.Random, length: int
) -> Iterator[tuple[interpreter.State, Valuation]]:
    """Yield each state of a random run, and the valuation of inputs and state there."""
    state = interpreter.initial_state(tokens)
    for _ in range(length):
        inputs = draw_inputs(tokens, dice)
        yield state, {**inputs, **interpreter.values_of(tokens, state, inputs)}
        state = interpreter.next_state(
            tokens, state, inputs, evaluate.is_true, lambda _, options: dice.choice(options)
        )


def play_trace(tokens: TokenGraph, seed: int, length: int) -> list[Valuation]:
    """Return the valuations of a random run."""
    return [valuation for _, valuation in play(tokens, random.Random(seed), length)]


def list_successors(tokens: TokenGraph, valuation: Valuation, inputs: Valuation) -> list[Valuation]:
    """Return all states that may follow a valuation: one for each combination of choices.

    *inputs* are those of the next step, on which the ends of regions there depend.
    """
    state, successors, plans = interpreter.state_of(tokens, valuation), [], [[]]
    while plans:
        plan = plans.pop()
        counts: list[int] = []

        def choose(_, options, plan=plan, counts=counts):
            """Take the options of the plan, then the first ones; count the options."""
            counts.append(len(options))
            return options[plan[len(counts) - 1] if len(counts) <= len(plan) else 0]

        successor = interpreter.next_state(tokens, state, valuation, evaluate.is_true, choose)
        successors.append(interpreter.values_of(tokens, successor, inputs))
        for index in range(len(plan), len(counts)):
            prefix = plan + [0] * (index - len(plan))
            plans += [[*prefix, option] for option in range(1, counts[index])]
    return successors
