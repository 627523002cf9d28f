"""Random well-formed activities as graphs, for tests by meaning.

A block is a tuple: ("act",), ("seq", a, b), ("par", a, b), ("if", a, b), ("loop", a),
("sub", a) for a structured node. Each has one entry and one exit. ``rich`` has more: what UML
makes of structured nodes, exceptions, data stores and interruptible regions.
"""

from collections.abc import Callable

from hypothesis import strategies as st

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.element import AttrValue
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.passes.activities import Activities

Block = tuple


def blocks(max_leaves: int = 6) -> st.SearchStrategy[Block]:
    """Random blocks."""
    leaf = st.sampled_from([("act",), ("act",), ("act",), ("send",), ("value",), ("accept",)])
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


def rich(max_leaves: int = 5) -> st.SearchStrategy[Block]:
    """Random blocks with everything that an activity may have."""
    words = ("act", "act", "act", "send", "value", "accept", "raise")
    leaf = st.sampled_from([(word,) for word in words])
    one = ("loop", "sub", "each", "all", "store", "stop", "cross", "outward", "chain")
    two = ("seq", "par", "if", "choose", "while", "case", "try", "ask")
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            *(st.tuples(st.just(word), inner) for word in one),
            *(st.tuples(st.just(word), inner, inner) for word in two),
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
        made = Element(f"n{self.count}", kind, name, self.owner.id)
        made.attrs.update({"subkind": subkind, **attrs})
        return self.graph.add(made)

    def control(self, subkind: str) -> Element:
        return self.node(Kind.CONTROL, subkind)

    def flow(self, source: Element, target: Element, guard: str = "") -> Element:
        self.count += 1
        made = Element(f"f{self.count}", Kind.CONTROL_FLOW, "", self.owner.id)
        if guard:
            made.attrs["guard"] = guard
        self.graph.add(made)
        self.graph.connect(Edge.FLOW_SOURCE, made, source)
        self.graph.connect(Edge.FLOW_TARGET, made, target)
        return made

    def draw(self, block: Block) -> tuple[Element, Element]:
        return getattr(self, f"_{block[0]}")(*block[1:])

    def _act(self) -> tuple[Element, Element]:
        made = self.node(Kind.ACTION, "opaque", f"w{self.count}")
        return made, made

    def _send(self) -> tuple[Element, Element]:
        made = self.node(Kind.ACTION, "send", f"s{self.count}")
        return made, made

    def _value(self) -> tuple[Element, Element]:
        made = self.node(Kind.ACTION, "value", f"v{self.count}")
        return made, made

    def _accept(self) -> tuple[Element, Element]:
        made = self.node(Kind.ACTION, "accept", f"e{self.count}")
        return made, made

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
        """Guards that may hold together, or not at all."""
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
        made = self.node(Kind.STRUCTURED, "structured", f"sub{self.count}")
        outer, self.owner = self.owner, made
        start = self.control("initial")
        a, _ = self.draw(body)
        self.flow(start, a)
        self.owner = outer
        return made, made

    # -- rich blocks -----------------------------------------------------------------------

    def _raise(self) -> tuple[Element, Element]:
        made = self.node(Kind.ACTION, "raise", f"r{self.count}")
        return made, made

    def inside(self, owner: Element, *parts: Block) -> list[tuple[list[str], Element, Element]]:
        """Blocks in a structured node: ids of executable nodes, entry and exit of each."""
        outer, self.owner, found = self.owner, owner, []
        for part in parts:
            before = {n.id for n in self.graph.owned(owner)}
            first, last = self.draw(part)
            made = [n for n in self.graph.owned(owner) if n.id not in before]
            works = [n.id for n in made if n.kind in (Kind.ACTION, Kind.STRUCTURED)]
            found.append((works, first, last))
        self.owner = outer
        return found

    def box(self, subkind: str, name: str) -> Element:
        return self.node(Kind.STRUCTURED, subkind, f"{name}{self.count}")

    def _started(self, owner: Element, first: Element) -> None:
        """A block that starts with a merge or a fork needs something to start it."""
        if first.kind is Kind.CONTROL:
            outer, self.owner = self.owner, owner
            self.flow(self.node(Kind.ACTION, "value", f"v{self.count}"), first)
            self.owner = outer

    def _while(self, test: Block, body: Block) -> tuple[Element, Element]:
        made = self.box("loop", "while")
        (tests, _, _), (bodies, b, _) = self.inside(made, ("seq", ("value",), test), body)
        self._started(made, b)
        made.attrs.update(test=tuple(tests), body_part=tuple(bodies), tested_first=True)
        return made, made

    def _case(self, first: Block, second: Block) -> tuple[Element, Element]:
        made = self.box("conditional", "case")
        found = self.inside(made, ("act",), ("seq", ("value",), first), ("value",), second)
        for _, entry, _ in found[1:]:
            self._started(made, entry)
        tests = [ids for ids, _, _ in found]
        made.attrs["clauses"] = (
            (tuple(tests[0]), tuple(tests[1])),
            (tuple(tests[2]), tuple(tests[3])),
        )
        return made, made

    def _each(self, body: Block) -> tuple[Element, Element]:
        made = self.box("expansion", "each")
        made.attrs["mode"] = "iterative"
        ((_, first, _),) = self.inside(made, body)
        self._started(made, first)
        return made, made

    def _all(self, body: Block) -> tuple[Element, Element]:
        made, _ = self._each(body)
        made.attrs["mode"] = "parallel"
        return made, made

    def _cross(self, body: Block) -> tuple[Element, Element]:
        """Flows lead past the border of a structured node, in and out."""
        fork, join, made = self.control("fork"), self.control("join"), self.box("", "cross")
        ((_, first, last),) = self.inside(made, body)
        self.flow(fork, made)
        self.flow(fork, first)
        self.flow(last, join)
        self.flow(made, join)
        return fork, join

    def _outward(self, body: Block) -> tuple[Element, Element]:
        """An action inside gives a token to one outside while the structured node goes on."""
        made, watch, join = self.box("", "outer"), self.node(Kind.ACTION, "opaque", "watch"), None
        ((_, first, _), (_, beside, _)) = self.inside(made, ("seq", ("act",), body), ("act",))
        self.flow(first, watch)
        join = self.control("join")
        self.flow(watch, join)
        self.flow(made, join)
        del beside
        return made, join

    def _chain(self, body: Block) -> tuple[Element, Element]:
        made = self.box("sequence", "chain")
        self.inside(made, ("act",), ("sub", body), ("value",))
        return made, made

    def _try(self, body: Block, repair: Block) -> tuple[Element, Element]:
        made, handler = self.box("structured", "try"), self.box("structured", "catch")
        for owner, block in ((made, body), (handler, repair)):
            ((_, first, _),) = self.inside(owner, block)
            self._started(owner, first)
        made.attrs["handlers"] = (((handler.id,), (), ()),)
        return made, made

    def _ask(self, first: Block, second: Block) -> tuple[Element, Element]:
        """A decision about a value; other values than two end there."""
        decision, merge = self._branches((first, second), ("1", "2"))
        decision.attrs["decision_input"] = "b"
        for flow in self.graph.sources(decision, Edge.FLOW_SOURCE):
            flow.attrs["guard_literal"] = True
        return decision, merge

    def _store(self, body: Block) -> tuple[Element, Element]:
        """What is read twice from a data store."""
        store = self.node(Kind.DATA_STORE, "", f"store{self.count}")
        write, read = (self.node(Kind.ACTION, "opaque", f"{w}{self.count}") for w in "wr")
        first, last = self.draw(body)
        again = self.node(Kind.ACTION, "value", f"again{self.count}")
        for source, target in ((write, read), (read, first), (last, again)):
            self.flow(source, target)
        for source, target in ((write, store), (store, read), (store, again)):
            self.flow(source, target)
        return write, again

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


def activity(block: Block, has_final: bool = True) -> Graph:
    """An activity that does the block between an initial and (perhaps) a final node."""
    canvas = Canvas()
    start = canvas.control("initial")
    first, last = canvas.draw(block)
    canvas.flow(start, first)
    if has_final:
        canvas.flow(last, canvas.control("final"))
    return canvas.graph


def tokens_of(graph: Graph, make: Callable[[], Activities] = Activities) -> TokenGraph:
    """The token graph of the only activity."""
    make().run(graph, Sink())
    (tokens,) = graph.derived(TokenGraph)
    return tokens
