"""Random small models: elements with any owner, any edge, and the attributes that passes read."""

from hypothesis import strategies as st

from sysmlc.ir import Edge, Element, Graph, Kind, Reference

KINDS_WITH_RESTRICTED_OWNERS = {
    Kind.REGION,
    Kind.STATE,
    Kind.FINAL_STATE,
    Kind.ENUMERATION_LITERAL,
    Kind.SLOT,
    Kind.CONNECTOR_END,
}
"""Kinds that only elements of certain kinds may own."""
FREQUENT_KINDS = [
    Kind.APPLICATION,
    Kind.CONTROL,
    Kind.STRUCTURED,
    Kind.CLASS,
    Kind.PORT,
    Kind.PROPERTY,
    Kind.CONNECTOR,
    Kind.ITEM_FLOW,
]
KINDS = [*sorted(set(Kind) - KINDS_WITH_RESTRICTED_OWNERS), *(5 * FREQUENT_KINDS)]
SINGLE_EDGES = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
FREQUENT_EDGES = [
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
EDGES = [*(edge for edge in Edge if edge not in (Edge.OWNS, *SINGLE_EDGES)), *(3 * FREQUENT_EDGES)]
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
TAG_VALUES = st.sampled_from(["e0", "e1", ("e2", "gone"), "kg", "", "x.uml#y", True, 3])
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
    "tag.unit": TAG_VALUES,
    "tag.bindingPath": TAG_VALUES,
    "tag.principal": TAG_VALUES,
    "tag.allocatedTo": TAG_VALUES,
    "tag.member": TAG_VALUES,
    "tag.lower": TAG_VALUES,
    "tag.text": TAG_VALUES,
    "on": st.sampled_from(["generalization", "change-event"]),
}


@st.composite
def element_lists(draw: st.DrawFn) -> list[Element]:
    """Draw elements e0, e1, ...; the owner of each is an earlier element or None."""
    elements: list[Element] = []
    for number in range(draw(st.integers(1, 10))):
        owner = draw(st.none() | st.sampled_from(elements)) if elements else None
        attrs = draw(st.fixed_dictionaries({}, optional=ATTRIBUTES))
        element = Element(
            f"e{number}", draw(st.sampled_from(KINDS)), draw(st.sampled_from(["", "a", "FullPort"]))
        )
        element.owner = owner.id if owner else None
        element.source = draw(st.sampled_from(["", "a.uml", "b.uml"]))
        element.ordinal = number if element.source else -1
        element.attrs = attrs
        elements.append(element)
    return elements


@st.composite
def structures(draw: st.DrawFn) -> Graph:
    """Draw a valid graph with references to resolve."""
    graph = Graph()
    for element in draw(element_lists()):
        graph.add(element)
    ids = [element.id for element in graph]
    for edge, source, target in draw(
        st.lists(st.tuples(*(st.sampled_from(pool) for pool in (EDGES, ids, ids))), max_size=25)
    ):
        graph.connect(edge, source, target)
    for edge in SINGLE_EDGES:
        for source in draw(st.lists(st.sampled_from(ids), unique=True, max_size=4)):
            graph.connect(edge, source, draw(st.sampled_from(ids)))
    pools = (EDGES, ids, TARGETS)
    for reference in draw(st.lists(st.tuples(*map(st.sampled_from, pools)), max_size=6)):
        graph.pending.append(Reference(*reference))
    return graph


@st.composite
def hierarchies(draw: st.DrawFn) -> Graph:
    """Draw classes that specialise earlier classes; their properties redefine inherited ones."""
    graph = Graph()
    ancestors: list[set[int]] = []
    for number in range(draw(st.integers(1, 7))):
        parents = (
            draw(st.lists(st.integers(0, number - 1), unique=True, max_size=3)) if number else []
        )
        ancestors.append(set(parents).union(*(ancestors[parent] for parent in parents)))
        graph.add(Element(f"c{number}", Kind.CLASS, f"C{number}"))
        for parent in parents:
            graph.connect(Edge.SPECIALIZES, f"c{number}", f"c{parent}")
        for feature in range(draw(st.integers(0, 2))):
            graph.add(Element(f"c{number}.{feature}", Kind.PROPERTY, "p", f"c{number}"))
            inherited = [
                element.id
                for ancestor in sorted(ancestors[number])
                for element in graph.owned(graph[f"c{ancestor}"])
            ]
            if inherited and draw(st.booleans()):
                redefined = draw(st.sampled_from(inherited))
                graph.connect(Edge.REDEFINES, f"c{number}.{feature}", redefined)
    return graph
