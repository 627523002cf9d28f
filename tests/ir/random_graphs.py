"""Random valid graphs for property tests."""

from hypothesis import strategies as st

from sysmlc.ir import Edge, Element, Graph, Kind

KINDS = [Kind.PACKAGE, Kind.CLASS, Kind.PROPERTY, Kind.PORT, Kind.ACTIVITY, Kind.ACTION]
EDGES = [edge for edge in Edge if edge is not Edge.OWNS]

words = st.text(max_size=8)
scalars = st.none() | st.booleans() | st.integers() | words | st.floats(allow_nan=False)
values = st.recursive(scalars, lambda inner: st.lists(inner, max_size=3).map(tuple), max_leaves=4)


@st.composite
def graphs(draw: st.DrawFn, max_size: int = 12) -> Graph:
    """Draw a forest of elements with random names, attributes, locations and edges."""
    graph = Graph()
    ids = draw(st.lists(st.text(min_size=1, max_size=6), unique=True, max_size=max_size))
    for number, id in enumerate(ids):
        owner = draw(st.none() | st.sampled_from(ids[:number])) if number else None
        attrs = draw(st.dictionaries(words.filter(lambda k: k != "origin"), values, max_size=3))
        element = Element(id, draw(st.sampled_from(KINDS)), draw(words), owner, attrs=attrs)
        element.source = draw(st.sampled_from(["", "a.uml", "odd name.uml", "z.mdzip!m:1"]))
        element.ordinal = draw(st.integers(0, 99)) if element.source else -1
        graph.add(element)
    for _ in range(draw(st.integers(0, 2 * len(ids)))):
        graph.connect(*(draw(st.sampled_from(pool)) for pool in (EDGES, ids, ids)))
    return graph
