"""Random well-formed activities as graphs, for tests by meaning.

A block is a tuple: ("act",), ("seq", a, b), ("par", a, b), ("if", a, b), ("loop", a),
("sub", a) for a structured node. Each has one entry and one exit.
"""

from collections.abc import Callable

from hypothesis import strategies as st

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.element import AttrValue
from sysmlc.logic.tokens import TokenGraph
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
