"""Random small models: any element below any other, any edge, the attributes that passes read."""

from hypothesis import strategies as st

from sysmlc.ir import Edge, Element, Graph, Kind, Reference

BOUND = {
    Kind.REGION,
    Kind.STATE,
    Kind.FINAL_STATE,
    Kind.ENUMERATION_LITERAL,
    Kind.SLOT,
    Kind.CONNECTOR_END,
}
"""Kinds that only some others may own."""
USUAL = [
    Kind.APPLICATION,
    Kind.CONTROL,
    Kind.STRUCTURED,
    Kind.CLASS,
    Kind.PORT,
    Kind.PROPERTY,
    Kind.CONNECTOR,
    Kind.ITEM_FLOW,
]
KINDS = [*sorted(set(Kind) - BOUND), *(5 * USUAL)]
SINGLE = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
OFTEN = [
    Edge.SUBJECT,
    Edge.SPECIALIZES,
    Edge.REDEFINES,
    Edge.TYPED_BY,
    Edge.ROLE,
    Edge.END,
    Edge.REALIZING,
    Edge.CONVEYS,
    Edge.CLIENT,
    Edge.SUPPLIER,
]
EDGES = [*(edge for edge in Edge if edge not in (Edge.OWNS, *SINGLE)), *(3 * OFTEN)]
NAMESPACES = [
    "",
    "urn:sysmlc:profile:1",
    "http://www.omg.org/spec/SysML/20150709/SysML",
    "http://example.org/plant",
    "http://www.eclipse.org/papyrus/GCM/1",
]
STEREOTYPES = [
    *("Block", "FullPort", "FlowProperty", "Satisfy", "Task", "Requirement", "Odd", "Copy"),
    *("ValueType", "Unit", "BoundReference", "AdjunctProperty", "AllocateActivityPartition"),
    *("ConstraintBlock", "Allocated", "Conform", "View", "ElementGroup", "DistributedProperty"),
]
_ANY = st.sampled_from(["e0", "e1", ("e2", "gone"), "kg", "", "x.uml#y", True, 3])
TARGETS = [
    "nowhere",
    "a.uml#e1",
    "b.uml#e2",
    "other.uml#x",
    "pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Integer",
    "http://www.omg.org/spec/UML/20131001/PrimitiveTypes.xmi#Integer",
]
ATTRIBUTES = {
    "aggregation": st.sampled_from(["composite", "shared"]),
    "conjugated": st.just(True),
    "direction": st.sampled_from(["in", "out", "inout", "return"]),
    "domain": st.sampled_from(["physical", "information"]),
    "multiplicity": st.sampled_from(["0..1", "*", "2..1", "0", "a..b", "", "1..*"]),
    "role": st.sampled_from(["flow property", "flow port", "block", "requirement", "satisfy"]),
    "subkind": st.sampled_from(["call-behavior", "send", "signal", "realization"]),
    "decision_input": st.sampled_from(["e0", "gone", "a.uml#e1", "lib.uml#f"]),
    "clauses": st.just((("e0", "gone"), ("e1",))),
    "stereotype": st.sampled_from(STEREOTYPES),
    "namespace": st.sampled_from(NAMESPACES),
    "tag.direction": st.sampled_from(["in", "out"]),
    "tag.unit": _ANY,
    "tag.bindingPath": _ANY,
    "tag.principal": _ANY,
    "tag.allocatedTo": _ANY,
    "tag.member": _ANY,
    "tag.lower": _ANY,
    "tag.text": _ANY,
    "on": st.sampled_from(["generalization", "change-event"]),
}


@st.composite
def elements(draw: st.DrawFn) -> list[Element]:
    """Elements e0, e1, ... each below an earlier one or none."""
    made: list[Element] = []
    for number in range(draw(st.integers(1, 10))):
        owner = draw(st.none() | st.sampled_from(made)) if made else None
        attrs = draw(st.fixed_dictionaries({}, optional=ATTRIBUTES))
        element = Element(
            f"e{number}", draw(st.sampled_from(KINDS)), draw(st.sampled_from(["", "a", "FullPort"]))
        )
        element.owner = owner.id if owner else None
        element.source = draw(st.sampled_from(["", "a.uml", "b.uml"]))
        element.ordinal = number if element.source else -1
        element.attrs = attrs
        made.append(element)
    return made


@st.composite
def structures(draw: st.DrawFn) -> Graph:
    """A valid graph with references still to resolve."""
    graph = Graph()
    for element in draw(elements()):
        graph.add(element)
    ids = [element.id for element in graph]
    for edge, source, target in draw(
        st.lists(st.tuples(*(st.sampled_from(pool) for pool in (EDGES, ids, ids))), max_size=25)
    ):
        graph.connect(edge, source, target)
    for edge in SINGLE:
        for source in draw(st.lists(st.sampled_from(ids), unique=True, max_size=4)):
            graph.connect(edge, source, draw(st.sampled_from(ids)))
    pools = (EDGES, ids, TARGETS)
    for found in draw(st.lists(st.tuples(*map(st.sampled_from, pools)), max_size=6)):
        graph.pending.append(Reference(*found))
    return graph


@st.composite
def hierarchies(draw: st.DrawFn) -> Graph:
    """Classes that specialise earlier ones, with properties that redefine inherited ones."""
    graph = Graph()
    above: list[set[int]] = []
    for number in range(draw(st.integers(1, 7))):
        ups = draw(st.lists(st.integers(0, number - 1), unique=True, max_size=3)) if number else []
        above.append(set(ups).union(*(above[up] for up in ups)))
        graph.add(Element(f"c{number}", Kind.CLASS, f"C{number}"))
        for up in ups:
            graph.connect(Edge.SPECIALIZES, f"c{number}", f"c{up}")
        for own in range(draw(st.integers(0, 2))):
            graph.add(Element(f"c{number}.{own}", Kind.PROPERTY, "p", f"c{number}"))
            old = [one.id for up in sorted(above[number]) for one in graph.owned(graph[f"c{up}"])]
            if old and draw(st.booleans()):
                graph.connect(Edge.REDEFINES, f"c{number}.{own}", draw(st.sampled_from(old)))
    return graph
