"""The context of the recipe analysis: graph, recipe levels, ids, and memoised results."""

from collections.abc import Iterator, Mapping
from functools import cached_property

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.analyses.activities.regions import NODES
from sysmlc.analyses.recipe.activity_graph import ActivityGraph
from sysmlc.analyses.recipe.profile import (
    Tags,
    find_followers,
    find_profile_stereotypes,
    find_stated_levels,
    read_tags,
)
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.recipe.model import FlowGraph

SERVICES = ("machine service", "infrastructure service")


class Call(Struct, frozen=True):
    """The call of a service, machine function or helper: the ids of the node and of the callee."""

    kind: str
    node: str
    definition: str


class Refinement(Struct, frozen=True):
    """The content of an activity that refines a task or a service.

    ``decisions`` are pairs of an element id and a text for ``reports.report_decisions``: a node
    whose content the recipe omits, with an empty text, or a called definition without a stated
    level, with the level that the position of the call gives it.
    """

    graph: FlowGraph
    calls: tuple[Call, ...]
    decisions: tuple[tuple[str, str], ...]


class Context(Struct, frozen=True, dict=True):
    """The graph with the levels given by options, model and stereotypes.

    The fields with a leading underscore, and those from ``types`` on, memoise results.
    """

    graph: Graph
    levels: Mapping[str, str] = field(default_factory=dict)
    stated: Mapping[str, str] = field(default_factory=dict)
    """Levels by id that elements do not take over from others, derived levels included."""
    candidates: frozenset[str] = frozenset()
    """Ids of elements that may have a level; most elements of a model have none."""
    stereotypes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Stereotypes of the shipped profile, and those with such generals, by application."""
    _segments: dict[str, str] = field(default_factory=dict)
    _names: dict[str, str] = field(default_factory=dict)
    _levels: dict[str, str] = field(default_factory=dict)
    _activities: dict[str, ActivityGraph] = field(default_factory=dict)
    refined: dict[str, Element | None] = field(default_factory=dict)
    """The refining activity by the id of the definition."""
    refinements: dict[tuple[str, str], Refinement] = field(default_factory=dict)
    """Refinements by the level of the refined element and the id of the activity."""
    members: dict[str, dict[str, Element]] = field(default_factory=dict)
    """Features by the id of the owner and by name."""

    @classmethod
    def build(cls, graph: Graph, levels: Mapping[str, str]) -> "Context":
        """Return the context of a graph. *levels* by ids or qualified names override the model."""
        bare = cls(graph, levels)
        stereotypes = find_profile_stereotypes(graph)
        stated = find_stated_levels(graph, stereotypes, levels, bare._segment)
        return replace(
            bare,
            stated=stated,
            candidates=frozenset(find_followers(graph, stated)),
            stereotypes=stereotypes,
        )

    # -- levels --------------------------------------------------------------------------------

    def own_level(self, element: Element) -> str:
        """Return the level that options, ``classify`` or a stereotype give the element."""
        return self.stated.get(element.id, "")

    def level(self, element: Element | None) -> str:
        """Return the level of an element: its own, or that of its general, callee or type."""
        if element is None or element.id not in self.candidates:
            return ""
        level = self._levels.get(element.id)
        if level is None:
            # The entry ends the recursion if types or generals form a cycle.
            self._levels[element.id] = ""
            level = self._levels[element.id] = self._find_level(element)
        return level

    def with_derived(self, derived: Mapping[str, str]) -> "Context":
        """Return a context with derived levels by id, without memoised results that they change."""
        changed = find_followers(self.graph, derived)
        unaffected = {id: level for id, level in self._levels.items() if id not in changed}
        return replace(
            self,
            stated={**derived, **self.stated},
            candidates=self.candidates | changed,
            _levels=unaffected,
            refinements={},
        )

    def elements_of_level(self, level: str) -> list[Element]:
        """Return all elements of a level, in the order of the graph."""
        return self._elements_by_level.get(level, [])

    @cached_property
    def _elements_by_level(self) -> dict[str, list[Element]]:
        elements: dict[str, list[Element]] = {}
        for element in self.graph if self.candidates else ():
            if element.id in self.candidates:
                elements.setdefault(self.level(element), []).append(element)
        return elements

    def _find_level(self, element: Element) -> str:
        level = self.own_level(element)
        if level:
            return level
        for general in query.generals(self.graph, element):
            level = self.own_level(general)
            if level:
                return level
        definition = self.definition(element)
        if element.kind is Kind.OPERATION:
            definition = self.graph.target(element, Edge.METHOD)
        return "" if definition is None or definition is element else self.level(definition)

    def definition(self, element: Element) -> Element | None:
        """Return the definition of a use: the behaviour or operation that it calls, or its type."""
        if element.kind is Kind.ACTION:
            return self.graph.target(element, Edge.CALLS)
        return query.type_of(self.graph, element)

    # -- contents ------------------------------------------------------------------------------

    def read_activity(self, activity: Element) -> ActivityGraph:
        """Return the nodes and flows of an activity."""
        if activity.id not in self._activities:
            self._activities[activity.id] = ActivityGraph(self.graph, activity)
        return self._activities[activity.id]

    def contents(self, activity: Element) -> Iterator[Element]:
        """Yield the elements that an activity owns; an inlined node precedes its content."""
        worklist = [activity]
        while worklist:
            element = worklist.pop()
            if element is not activity:
                yield element
            if element.id in self.read_activity(activity).inlined:
                worklist += reversed(self.graph.owned(element))

    def has_nodes(self, activity: Element) -> bool:
        """Whether nodes describe the activity."""
        return any(
            element.kind in NODES and query.is_performed(self.graph, element)
            for element in self.graph.owned(activity)
        )

    def is_inlined(self, node: Element) -> bool:
        """Whether the content of a structured node belongs to the activity around it."""
        activity = next((a for a in self.graph.ancestors(node) if a.kind is Kind.ACTIVITY), None)
        return activity is not None and node.id in self.read_activity(activity).inlined

    # -- stereotypes and tagged values ---------------------------------------------------------

    def find_application(self, element: Element, stereotype: str) -> Element | None:
        """Return the application of *stereotype*, or of a stereotype that specialises it."""
        applications = query.applications(self.graph, element)
        return next(
            (
                application
                for application in applications
                if stereotype in self.stereotypes.get(application.id, ())
            ),
            None,
        )

    def tags(self, element: Element, stereotype: str) -> Tags:
        """Return the tagged values of a stereotype of the profile; empty if it is not applied."""
        return read_tags(self.graph, self.find_application(element, stereotype))

    # -- ids -----------------------------------------------------------------------------------

    def name(self, element: Element) -> str:
        """Return the qualified name, the id of recipe elements.

        An unnamed element is called by its kind, and the second element of a name gets ``#2``.
        """
        name = self._names.get(element.id)
        if name is None:
            owner, segment = self.graph.owner(element), self._segment(element)
            name = segment if owner is None else f"{self.name(owner)}::{segment}"
            self._names[element.id] = name
        return name

    def label(self, element: Element) -> str:
        """Return the name of the element without its owners, or its kind and number if unnamed."""
        return element.name or self._segment(element)

    def reference(self, value: str) -> str:
        """Return the recipe id of the element that a tagged value refers to, or else the value."""
        element = self.graph.get(value)
        return value if element is None else self.name(element)

    def _segment(self, element: Element) -> str:
        if element.id not in self._segments:
            owner = self.graph.owner(element)
            siblings = self.graph.roots() if owner is None else self.graph.owned(owner)
            self._segments.update(_number_siblings(siblings))
        return self._segments[element.id]


def _number_siblings(siblings: list[Element]) -> Iterator[tuple[str, str]]:
    seen: dict[str, int] = {}
    for element in siblings:
        word = segment_word(element)
        number = seen[word] = seen.get(word, 0) + 1
        yield element.id, word if number == 1 else f"{word}#{number}"


def segment_word(element: Element) -> str:
    """Return the part of a qualified name for an element: its name, or else its subkind or kind."""
    return element.name or element.subkind or element.kind.lower()
