"""Copies of a graph with other ids and another order, or with one change that is known."""

from random import Random

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.compare.content import ENDS, IN_ORDER, WORDS, is_external
from sysmlc.ir.compare.side import Side
from sysmlc.ir.query import CLASSIFIERS


def reissued(graph: Graph, random: Random) -> Graph:
    """The same model as another tool would export it: new ids, other order, other places."""
    ids = {element.id: f"_{random.getrandbits(96):024x}" for element in graph}
    made = Graph()
    for element in _shuffled(graph, random):
        attrs = {
            name: value if name in WORDS else _translated(value, ids)
            for name, value in element.attrs.items()
        }
        owner = None if element.owner is None else ids[element.owner]
        copy = Element(ids[element.id], element.kind, element.name, owner, attrs=attrs)
        copy.source, copy.ordinal = "other.uml", random.randrange(10**6)
        made.add(copy)
    for edge in Edge:
        if edge is not Edge.OWNS:
            for _, source, target in graph.edges(edge):
                made.connect(edge, ids[source], ids[target])
    return made


def _shuffled(graph: Graph, random: Random) -> list[Element]:
    """Owners before owned, else in any order where order means nothing."""
    found = []
    waiting = [graph.roots()]
    while waiting:
        siblings = waiting.pop()
        owner = graph.owner(siblings[0]) if siblings else None
        if owner is None or owner.kind not in IN_ORDER:
            random.shuffle(siblings)
        found += siblings
        waiting += [graph.owned(one) for one in siblings]
    return found


def _translated(value, ids):
    if isinstance(value, tuple):
        return tuple(_translated(part, ids) for part in value)
    return ids.get(value, value) if isinstance(value, str) else value


def things(graph: Graph) -> list[Element]:
    """What a comparison tells of by itself."""
    side = Side(graph)
    return [one for one in graph if one.id not in side.hidden and not is_external(one)]


class Mutation:
    """One random change of a graph, made in place; ``what`` and ``name`` is what must be told."""

    def __init__(self, graph: Graph, random: Random) -> None:
        self._graph = graph
        self._random = random
        self.what = ""
        self.name = ""
        self.aspect = ""

    def make(self, kind: str) -> bool:
        """Make a change of this kind; False when the model has no place for one."""
        return getattr(self, f"_{kind}")()

    def _tell(self, what: str, name: str, aspect: str = "") -> bool:
        self.what, self.name, self.aspect = what, name, aspect
        return True

    def _choose(self, fits) -> Element | None:
        found = [one for one in things(self._graph) if fits(one)]
        return self._random.choice(found) if found else None

    def _rename(self) -> bool:
        chosen = self._choose(lambda one: one.name and one.owner)
        if chosen is None:
            return False
        self._graph.rename(chosen, f"{chosen.name}_anew")
        return self._tell("renamed", chosen.name, "name")

    def _retype(self) -> bool:
        graph = self._graph
        chosen = self._choose(lambda one: one.name and graph.targets(one, Edge.TYPED_BY))
        if chosen is None:
            return False
        now = graph.targets(chosen, Edge.TYPED_BY)
        other = self._choose(lambda one: one.kind in CLASSIFIERS and one.name and one not in now)
        if other is None:
            return False
        graph.replace_targets(Edge.TYPED_BY, chosen, [other])
        return self._tell("retyped", chosen.name, "type")

    def _add(self) -> bool:
        owner = self._choose(lambda one: one.kind is Kind.CLASS)
        if owner is None:
            return False
        self._graph.add(Element("_added", Kind.PROPERTY, "addedProperty", owner.id))
        return self._tell("added", "addedProperty")

    def _remove(self) -> bool:
        graph = self._graph
        used = {target for edge, _, target in graph.edges() if edge is not Edge.OWNS}
        held = {id for one in graph for id in _texts(tuple(one.attrs.values()))}
        chosen = self._choose(
            lambda one: (
                one.name and one.owner and not graph.owned(one) and one.id not in used | held
            )
        )
        if chosen is None:
            return False
        name = chosen.name
        graph.remove(chosen)
        return self._tell("removed", name)

    def _rewire(self) -> bool:
        """Another target of a flow, a transition, or the like."""
        graph = self._graph
        chosen = self._choose(
            lambda one: one.name and any(graph.targets(one, edge) for edge in ENDS)
        )
        if chosen is None:
            return self._reconnect()
        edge = next(edge for edge in reversed(ENDS) if graph.targets(chosen, edge))
        now = graph.targets(chosen, edge)
        other = self._choose(lambda one: one.name and one.kind is now[0].kind and one not in now)
        if other is None:
            return False
        graph.replace_targets(edge, chosen, [other, *now[1:]])
        return self._tell("rewired", chosen.name, "ends")

    def _reconnect(self) -> bool:
        """Another port at the end of a connector."""
        graph = self._graph
        chosen = self._choose(lambda one: one.kind is Kind.CONNECTOR and one.name)
        roles = (
            [] if chosen is None else [(e, graph.target(e, Edge.ROLE)) for e in graph.owned(chosen)]
        )
        found = [(end, role) for end, role in roles if role is not None]
        other = self._choose(lambda one: one.kind is Kind.PORT and one not in [r for _, r in found])
        if not found or other is None:
            return False
        graph.replace_targets(Edge.ROLE, found[0][0], [other])
        return self._tell("rewired", chosen.name, "ends")

    def _value(self) -> bool:
        chosen = self._choose(lambda one: one.kind is Kind.PROPERTY and one.name)
        if chosen is None:
            return False
        self._graph.set(chosen, multiplicity="7..11")
        return self._tell("changed", chosen.name, "multiplicity")

    def _move(self) -> bool:
        graph = self._graph
        chosen = self._choose(lambda one: one.kind is Kind.CLASS and one.name and one.owner)
        if chosen is None:
            return False
        above = {chosen.id, chosen.owner, *(one.id for one in graph.subtree(chosen))}
        target = self._choose(
            lambda one: one.kind in (Kind.PACKAGE, Kind.CLASS) and one.id not in above
        )
        if target is None:
            return False
        graph.move(chosen, target)
        return self._tell("moved", chosen.name, "owner")


KINDS = ("rename", "retype", "add", "remove", "rewire", "value", "move")


def _texts(value):
    if isinstance(value, tuple):
        return [text for part in value for text in _texts(part)]
    return [value] if isinstance(value, str) else []
