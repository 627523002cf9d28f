"""Copies of a graph with new ids in another order, and random changes with a known effect."""

from random import Random

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.compare.content import ENDS, IN_ORDER, WORDS, is_external
from sysmlc.ir.compare.side import Side
from sysmlc.ir.query import CLASSIFIERS


def copy_with_new_ids(graph: Graph, random: Random) -> Graph:
    """Return the model as another tool would export it: new ids, another order, other locations."""
    ids = {element.id: f"_{random.getrandbits(96):024x}" for element in graph}
    exported = Graph()
    for element in _shuffle_elements(graph, random):
        attrs = {
            name: value if name in WORDS else _replace_ids(value, ids)
            for name, value in element.attrs.items()
        }
        owner = None if element.owner is None else ids[element.owner]
        copy = Element(ids[element.id], element.kind, element.name, owner, attrs=attrs)
        copy.source, copy.ordinal = "other.uml", random.randrange(10**6)
        exported.add(copy)
    for edge in Edge:
        if edge is not Edge.OWNS:
            for _, source, target in graph.edges(edge):
                exported.connect(edge, ids[source], ids[target])
    return exported


def _shuffle_elements(graph: Graph, random: Random) -> list[Element]:
    """Return owners before their members, shuffled where order has no meaning."""
    elements = []
    waiting = [graph.roots()]
    while waiting:
        siblings = waiting.pop()
        owner = graph.owner(siblings[0]) if siblings else None
        if owner is None or owner.kind not in IN_ORDER:
            random.shuffle(siblings)
        elements += siblings
        waiting += [graph.owned(element) for element in siblings]
    return elements


def _replace_ids(value, ids):
    if isinstance(value, tuple):
        return tuple(_replace_ids(part, ids) for part in value)
    return ids.get(value, value) if isinstance(value, str) else value


def list_reported_elements(graph: Graph) -> list[Element]:
    """Return the elements that a comparison reports by themselves."""
    side = Side(graph)
    return [
        element for element in graph if element.id not in side.hidden and not is_external(element)
    ]


class Mutation:
    """One random change of a graph in place, and the difference that a comparison must report."""

    def __init__(self, graph: Graph, random: Random) -> None:
        self._graph = graph
        self._random = random
        self.change = ""
        self.name = ""
        self.aspect = ""

    def apply(self, kind: str) -> bool:
        """Apply a change of this kind; return False if the model has no element for it."""
        return getattr(self, f"_{kind}")()

    def _expect(self, change: str, name: str, aspect: str = "") -> bool:
        self.change, self.name, self.aspect = change, name, aspect
        return True

    def _choose(self, fits) -> Element | None:
        candidates = [element for element in list_reported_elements(self._graph) if fits(element)]
        return self._random.choice(candidates) if candidates else None

    def _rename(self) -> bool:
        chosen = self._choose(lambda element: element.name and element.owner)
        if chosen is None:
            return False
        self._graph.rename(chosen, f"{chosen.name}_anew")
        return self._expect("renamed", chosen.name, "name")

    def _retype(self) -> bool:
        graph = self._graph
        chosen = self._choose(
            lambda element: element.name and graph.targets(element, Edge.TYPED_BY)
        )
        if chosen is None:
            return False
        types = graph.targets(chosen, Edge.TYPED_BY)
        new_type = self._choose(
            lambda element: element.kind in CLASSIFIERS and element.name and element not in types
        )
        if new_type is None:
            return False
        graph.replace_targets(Edge.TYPED_BY, chosen, [new_type])
        return self._expect("retyped", chosen.name, "type")

    def _add(self) -> bool:
        owner = self._choose(lambda element: element.kind is Kind.CLASS)
        if owner is None:
            return False
        self._graph.add(Element("_added", Kind.PROPERTY, "addedProperty", owner.id))
        return self._expect("added", "addedProperty")

    def _remove(self) -> bool:
        graph = self._graph
        targets = {target for edge, _, target in graph.edges() if edge is not Edge.OWNS}
        attribute_ids = {
            id for element in graph for id in _iter_texts(tuple(element.attrs.values()))
        }
        chosen = self._choose(
            lambda element: (
                element.name
                and element.owner
                and not graph.owned(element)
                and element.id not in targets | attribute_ids
            )
        )
        if chosen is None:
            return False
        name = chosen.name
        graph.remove(chosen)
        return self._expect("removed", name)

    def _rewire(self) -> bool:
        """Replace the target of a flow, a transition, or the like."""
        graph = self._graph
        chosen = self._choose(
            lambda element: element.name and any(graph.targets(element, edge) for edge in ENDS)
        )
        if chosen is None:
            return self._reconnect()
        edge = next(edge for edge in reversed(ENDS) if graph.targets(chosen, edge))
        targets = graph.targets(chosen, edge)
        new_target = self._choose(
            lambda element: (
                element.name and element.kind is targets[0].kind and element not in targets
            )
        )
        if new_target is None:
            return False
        graph.replace_targets(edge, chosen, [new_target, *targets[1:]])
        return self._expect("rewired", chosen.name, "ends")

    def _reconnect(self) -> bool:
        """Replace the port at one end of a connector."""
        graph = self._graph
        chosen = self._choose(lambda element: element.kind is Kind.CONNECTOR and element.name)
        roles = (
            [] if chosen is None else [(e, graph.target(e, Edge.ROLE)) for e in graph.owned(chosen)]
        )
        ends = [(end, role) for end, role in roles if role is not None]
        new_port = self._choose(
            lambda element: element.kind is Kind.PORT and element not in [r for _, r in ends]
        )
        if not ends or new_port is None:
            return False
        graph.replace_targets(Edge.ROLE, ends[0][0], [new_port])
        return self._expect("rewired", chosen.name, "ends")

    def _change_value(self) -> bool:
        chosen = self._choose(lambda element: element.kind is Kind.PROPERTY and element.name)
        if chosen is None:
            return False
        self._graph.set(chosen, multiplicity="7..11")
        return self._expect("changed", chosen.name, "multiplicity")

    def _move(self) -> bool:
        graph = self._graph
        chosen = self._choose(
            lambda element: element.kind is Kind.CLASS and element.name and element.owner
        )
        if chosen is None:
            return False
        forbidden = {chosen.id, chosen.owner, *(element.id for element in graph.subtree(chosen))}
        target = self._choose(
            lambda element: (
                element.kind in (Kind.PACKAGE, Kind.CLASS) and element.id not in forbidden
            )
        )
        if target is None:
            return False
        graph.move(chosen, target)
        return self._expect("moved", chosen.name, "owner")


KINDS = ("rename", "retype", "add", "remove", "rewire", "change_value", "move")


def _iter_texts(value):
    if isinstance(value, tuple):
        for part in value:
            yield from _iter_texts(part)
    elif isinstance(value, str):
        yield value
