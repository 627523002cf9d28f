"""References before they are edges: columns that behave like a list of references."""

from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.ir.reference import References

GATE = Reference(Edge.TYPED_BY, "gate", "pallet")
LIFT = Reference(Edge.CALLS, "lift", "lib.uml#up", Kind.OPERATION, "lib::up", 7)


def test_references_come_back_as_they_were_added():
    references = References()
    for one in (GATE, LIFT, GATE):
        references.append(one)
    assert list(references) == [GATE, LIFT, GATE]
    references[0] = LIFT
    assert list(references) == [LIFT, LIFT, GATE]


def test_others_are_added_without_those_that_are_left_out():
    references, others = References(), References()
    references.append(GATE)
    for one in (GATE, LIFT, GATE, LIFT):
        others.append(one)
    references.extend(others, {0, 1})
    assert list(references) == [GATE, GATE, LIFT]
    references.extend(others)
    assert list(references) == [GATE, GATE, LIFT, GATE, LIFT, GATE, LIFT]


def test_ends_can_be_elements_and_are_told_by_their_ids():
    graph = Graph()
    gate, pallet = (graph.add(Element(id, Kind.CLASS)) for id in ("gate", "pallet"))
    graph.pending.extend(References([Edge.TYPED_BY], [gate], [pallet], [-1]))
    assert list(graph.pending) == [GATE]


def test_an_element_that_is_removed_is_no_longer_the_end_of_a_reference():
    graph = Graph()
    gate, pallet = (graph.add(Element(id, Kind.CLASS)) for id in ("gate", "pallet"))
    graph.pending.extend(References([Edge.TYPED_BY], [gate], [pallet], [-1]))
    graph.remove(pallet)
    assert graph.find_all(graph.pending.targets) == [None]
