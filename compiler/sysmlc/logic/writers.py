"""Who writes which feature: what all behaviours of a model assign, found once."""

import re
from collections.abc import Iterable, Iterator

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.expressions.named_elements import VALUE_KINDS, find_named_values
from sysmlc.logic.written import last_of, mentioned, written_names

_STEP = re.compile(r"::|\.")
_NAMED = (*VALUE_KINDS, *query.CLASSIFIERS, Kind.PACKAGE)
"""What has a value, and what others are in."""


class Writers:
    """The actions and effects of a graph by the features that they write.

    The index is built at the first question. The graph must not change while it is in use.
    """

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._writing: dict[str, list[Element]] | None = None
        self._named: dict[str, dict[str, Element]] = {}

    def beside(self, feature: Element, behaviour: Element) -> Element | None:
        """What writes the feature and does not stand inside of the behaviour; the first of all.

        An object has one value for a feature and for what redefines it.
        """
        for one in self._of(feature):
            if one is not behaviour and behaviour not in self._graph.ancestors(one):
                return one
        return None

    def target(self, writer: Element, name: str) -> Element | None:
        """The feature that a name leads to (``full``, ``arm.load``, ``Plant::total``), from where
        it is written; None when it leads nowhere.
        """
        first, *more = _STEP.split(name)
        found = self._first(writer, first)
        for step in more:
            found = None if found is None else self._next(found, step)
        return found if found is not None and found.kind in VALUE_KINDS else None

    # -- inside --------------------------------------------------------------------------------

    def _of(self, feature: Element) -> Iterator[Element]:
        slots = (
            feature,
            *query.redefined_features(self._graph, feature),
            *self._redefining(feature),
        )
        for slot in slots:
            for writer in self._candidates(slot.name):
                if slot in self._written(writer, slot.name):
                    yield writer

    def _candidates(self, name: str) -> list[Element]:
        """What may write a feature of the name: to read all texts would take ten times as long."""
        if self._writing is None:
            self._writing = _writing(self._graph)
        return self._writing.get(name, [])

    def _written(self, writer: Element, last: str) -> Iterator[Element | None]:
        """The features that something writes by names that end with this one."""
        if writer.subkind == "write":
            yield from self._graph.targets(writer, Edge.CALLS)
        for name in written_names(self._graph, writer):
            if last_of(name) == last:
                yield self.target(writer, name)

    def _redefining(self, feature: Element) -> Iterable[Element]:
        """All that redefines the feature, directly or not."""
        found = {feature.id: feature}
        waiting = [feature]
        for one in waiting:
            new = [o for o in self._graph.sources(one, Edge.REDEFINES) if o.id not in found]
            found.update((o.id, o) for o in new)
            waiting += new
        return waiting[1:]

    def _first(self, writer: Element, name: str) -> Element | None:
        """What a name means where something is written: the nearest around it that has it."""
        for above in (writer, *self._graph.ancestors(writer)):
            found = self._inside(above, name)
            if found is not None:
                return found
        return next((one for one in self._graph.roots() if one.name == name), None)

    def _next(self, of: Element, name: str) -> Element | None:
        type_ = query.type_of(self._graph, of)
        return self._inside(of, name) or (type_ and self._inside(type_, name))

    def _inside(self, scope: Element, name: str) -> Element | None:
        known = self._named.get(scope.id)
        if known is None:
            owned = (one for one in self._graph.owned(scope) if one.kind in _NAMED)
            known = {one.name: one for one in owned if one.name}
            if scope.kind in query.CLASSIFIERS:
                known |= find_named_values(self._graph, scope)
            self._named[scope.id] = known
        return known.get(name)


def _writing(graph: Graph) -> dict[str, list[Element]]:
    """What may write features, by their names."""
    found: dict[str, list[Element]] = {}
    for one in (*graph.of_kind(Kind.ACTION), *graph.of_kind(Kind.ACTIVITY)):
        for written in dict.fromkeys(mentioned(graph, one)):
            found.setdefault(written, []).append(one)
    return found


def called(graph: Graph, one: Element) -> str:
    """What is named, or what a nameless effect or action is in."""
    return next((each.name for each in (one, *graph.ancestors(one)) if each.name), one.subkind)
