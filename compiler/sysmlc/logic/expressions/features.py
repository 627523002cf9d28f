"""The properties that expressions may name, as variables; found out when they are asked for."""

from collections.abc import Iterator, Mapping
from functools import cached_property

from msgspec.structs import replace

from sysmlc.ir import Element, Graph
from sysmlc.logic.contract import EnumerationDomain
from sysmlc.logic.expressions import declared
from sysmlc.logic.expressions.context_objects import direction_at
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.enumerations import Enumerations
from sysmlc.logic.expressions.mentioned import BEHAVIOURS, Mentioned, mentioned
from sysmlc.logic.names import unique

_OTHER = "other"


class Features(Mapping[str, Feature]):
    """The properties that a classifier and a behaviour of it know, by the names that they have.

    Each is found out when somebody asks for it: a behaviour knows hundreds by what its parameters
    hold, and speaks of a few.
    """

    def __init__(
        self,
        graph: Graph,
        classifier: Element,
        within: Element | None,
        named: Mapping[str, Element],
        assumed: tuple[int, int],
        enumerations: Enumerations,
    ) -> None:
        self.variables = variables(graph, named)
        self._enumerations = enumerations
        self._graph = graph
        self._classifier = classifier
        self._behaviour = within or classifier
        self._named = named
        self._assumed = assumed
        self._plain: dict[str, Feature] = {}
        self._found: dict[str, Feature] = {}

    def __getitem__(self, name: str) -> Feature:
        found = self._found.get(name)
        if found is None:
            found = self._found[name] = self._as_mentioned(name, self._as_declared(name))
        return found

    def __contains__(self, name: object) -> bool:
        return name in self.variables

    def __iter__(self) -> Iterator[str]:
        return iter(self.variables)

    def __len__(self) -> int:
        return len(self.variables)

    def _as_declared(self, name: str) -> Feature:
        found = self._plain.get(name)
        if found is None:
            found = self._plain[name] = self._made(name, self._named[name])
        return found

    def _made(self, name: str, element: Element) -> Feature:
        graph, variable = self._graph, self.variables[name]
        seen = (self._classifier, name) if "." in name else None
        made = declared.feature(graph, element, variable, self._assumed, self._fixed, seen)
        if "direction" not in element.attrs:
            return made
        return replace(made, direction=direction_at(graph, self._classifier, name, element))

    def _as_mentioned(self, name: str, one: Feature) -> Feature:
        """What the behaviour mentions tells the values of what is not declared."""
        if self._behaviour.kind not in BEHAVIOURS:
            return one
        if one.is_assumed:
            return self._widened(name, one)
        if declared.is_text(self._graph, one) and self._said.texts:
            return declared.as_text(one, self._texts)
        return one

    def _widened(self, name: str, one: Feature) -> Feature:
        """The range of an Integer that has none, with the numbers that it is compared with."""
        numbers = self._said.numbers.get(name, ())
        if not numbers:
            return one
        low, high = self._assumed
        wide = min((low, *numbers)), max((high, *numbers))
        made = declared.feature(self._graph, one.element, one.variable, wide, self._fixed)
        return replace(made, direction=one.direction)

    @cached_property
    def _fixed(self) -> dict[str, int]:
        """Integers that never change."""
        values = ((one.name, declared.fixed(one)) for one in self._named.values())
        return {name: value for name, value in values if value is not None}

    @cached_property
    def _said(self) -> Mentioned:
        return mentioned(self._graph, self._behaviour, self._enumerations)

    @cached_property
    def _texts(self) -> EnumerationDomain:
        """The texts that the behaviour mentions, those that features start with, and any other."""
        found = [one for one in map(self._as_declared, self) if declared.is_text(self._graph, one)]
        defaults = [text for one in found if (text := declared.first_text(one.element)) is not None]
        texts = tuple(dict.fromkeys([*self._said.texts, *defaults]))
        names = [text.strip() or "empty" for text in texts]
        return EnumerationDomain(unique([*names, _OTHER], "text"), texts)


def variables(graph: Graph, named: Mapping[str, Element]) -> dict[str, str]:
    """The variables that names stand for, in the order of the document."""
    names = sorted(named, key=lambda name: (named[name].ordinal, name))
    return dict(zip(names, unique(names, "value", "event", "none"), strict=True))
