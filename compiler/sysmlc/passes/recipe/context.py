"""What the recipe pass asks of the graph: recipe levels, tagged values, ids for the JSON."""

from collections.abc import Iterator, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.passes.recipe.profile import Tags, followers, said, stereotypes, subjects
from sysmlc.passes.recipe.regions import contents
from sysmlc.recipe.model import FlowGraph, Parameter, ValueType

SERVICES = ("machine service", "infrastructure service")
NODES = frozenset(
    [
        Kind.ACTION,
        Kind.CONTROL,
        Kind.STRUCTURED,
        Kind.OBJECT_NODE,
        Kind.DATA_STORE,
        Kind.ACTIVITY_PARAMETER,
    ]
)


class Called(Struct, frozen=True):
    """A service, machine function or helper that a node calls, both by their ids."""

    kind: str
    node: str
    definition: str


class Refined(Struct, frozen=True):
    """An activity that refines a task or a service.

    ``remarks`` are ids of nodes whose content is left out, with an empty text, and of what is
    called by position, with the level that it is taken for.
    """

    graph: FlowGraph
    calls: tuple[Called, ...]
    remarks: tuple[tuple[str, str], ...]


class Context(Struct, frozen=True):
    """The graph with what the user said about levels; it remembers what it has computed."""

    graph: Graph
    levels: Mapping[str, str] = field(default_factory=dict)
    said: Mapping[str, str] = field(default_factory=dict)
    """Levels by id that elements have themselves: said of them, or derived."""
    able: frozenset[str] = frozenset()
    """Ids of elements that may have a level; most elements of a model have none."""
    derived: Mapping[str, str] = field(default_factory=dict)
    """Levels by id that follow from others; what is said wins over them."""
    subjects: frozenset[str] = frozenset()
    """Ids of elements that stereotypes are applied to."""
    _segments: dict[str, str] = field(default_factory=dict)
    _names: dict[str, str] = field(default_factory=dict)
    _levels: dict[str, str] = field(default_factory=dict)
    _of_level: dict[str, list[Element]] = field(default_factory=dict)
    _literals: list[dict[str, str]] = field(default_factory=list)
    _contents: dict[str, list[Element]] = field(default_factory=dict)
    _nodes: dict[str, list[Element]] = field(default_factory=dict)
    types: dict[str, ValueType] = field(default_factory=dict)
    """Types of values by the id of what types them, as far as somebody asked."""
    parameters: dict[str, Parameter] = field(default_factory=dict)
    """Parameters of recipes by the id of what they are made of, as far as somebody asked."""
    kinds: dict[tuple[str, str], str] = field(default_factory=dict)
    """Kinds of recipe nodes by id and level of the activity, as far as somebody asked."""
    refined: dict[str, Element | None] = field(default_factory=dict)
    """What refines a definition, by its id, as far as somebody asked."""
    refinements: dict[tuple[str, str], Refined] = field(default_factory=dict)
    """What activities say, by the level of what they refine and by id, as far as somebody asked."""
    members: dict[str, dict[str, Element]] = field(default_factory=dict)
    """Features by name, by the id of what has them, as far as somebody asked."""

    @classmethod
    def of(cls, graph: Graph, levels: Mapping[str, str]) -> "Context":
        """The context of a graph; ``levels`` by ids or qualified names win over what it says."""
        bare = cls(graph, levels)
        own = said(graph, levels, bare._segment)
        able = frozenset(followers(graph, own))
        return replace(bare, said=own, able=able, subjects=frozenset(subjects(graph)))

    # -- levels --------------------------------------------------------------------------------

    def own_level(self, element: Element) -> str:
        """Level that the options, ``classify`` or a stereotype give the element itself."""
        return self.said.get(element.id, "")

    def level(self, element: Element | None) -> str:
        """Level of an element: its own, or that of its type, of what it calls or specialises."""
        if element is None or element.id not in self.able:
            return ""
        found = self._levels.get(element.id)
        if found is None:
            self._levels[element.id] = ""
            found = self._levels[element.id] = self._level(element)
        return found

    def with_derived(self, derived: Mapping[str, str]) -> "Context":
        """The same with levels (by id) that follow from others: who has theirs is asked again."""
        changed = followers(self.graph, derived)
        known = {id: level for id, level in self._levels.items() if id not in changed}
        return replace(
            self,
            said={**derived, **self.said},
            able=self.able | changed,
            derived=derived,
            _levels=known,
            _of_level={},
            types={},
            parameters={},
            kinds={},
            refinements={},
        )

    def of_level(self, level: str) -> list[Element]:
        """All elements of a level, in the order of the graph."""
        if self.able and not self._of_level:
            for element in (one for one in self.graph if one.id in self.able):
                self._of_level.setdefault(self.level(element), []).append(element)
        return self._of_level.get(level, [])

    def literal(self, name: str) -> Element | None:
        """The enumeration literal ``Enumeration::literal``; None where two are called so."""
        if not self._literals:
            self._literals.append(_index_literals(self.graph))
        id = self._literals[0].get(_last_two(name))
        return self.graph.get(id) if id else None

    def _level(self, element: Element) -> str:
        own = self.own_level(element)
        if own:
            return own
        for general in query.generals(self.graph, element):
            own = self.own_level(general)
            if own:
                return own
        definition = self.definition(element)
        if element.kind is Kind.OPERATION:
            definition = self.graph.target(element, Edge.METHOD)
        return "" if definition is None or definition is element else self.level(definition)

    def definition(self, element: Element) -> Element | None:
        """What defines a use: the behaviour or operation that it calls, or its type."""
        if element.kind is Kind.ACTION:
            return self.graph.target(element, Edge.CALLS)
        return query.type_of(self.graph, element)

    # -- contents ------------------------------------------------------------------------------

    def contents(self, activity: Element) -> list[Element]:
        """What an activity owns, and behind each inlined node what that owns."""
        found = self._contents.get(activity.id)
        if found is None:
            found = self._contents[activity.id] = list(contents(self.graph, activity))
        return found

    def nodes(self, activity: Element) -> list[Element]:
        """Nodes of the activity, those in for-each regions and plain blocks too."""
        found = self._nodes.get(activity.id)
        if found is None:
            inside = self.contents(activity)
            found = self._nodes[activity.id] = [one for one in inside if one.kind in NODES]
        return found

    # -- stereotypes and tagged values ---------------------------------------------------------

    def applied(self, element: Element, stereotype: str) -> Element | None:
        """Application of a stereotype of the shipped profile, or of one that specialises it."""
        if not self.may_have_stereotype(element):
            return None
        found = query.applications(self.graph, element)
        return next((one for one in found if stereotype in stereotypes(one)), None)

    def may_have_stereotype(self, element: Element) -> bool:
        """Whether a stereotype may be applied to the element: most have none."""
        return element.id in self.subjects

    def tags(self, element: Element, stereotype: str) -> Tags:
        """Tagged values of one stereotype of the profile; empty when it is not applied."""
        application = self.applied(element, stereotype)
        return Tags({} if application is None else application.attrs)

    # -- ids -----------------------------------------------------------------------------------

    def name(self, element: Element) -> str:
        """Qualified name; an unnamed part shows its kind, siblings of one name get ``#2``."""
        found = self._names.get(element.id)
        if found is None:
            owner, segment = self.graph.owner(element), self._segment(element)
            found = segment if owner is None else f"{self.name(owner)}::{segment}"
            self._names[element.id] = found
        return found

    def label(self, element: Element) -> str:
        """Own name; an unnamed element shows its kind and number among its siblings."""
        return element.name or self._segment(element)

    def reference(self, value: str) -> str:
        """Id for the JSON of what a tagged value names: an element of the graph, or its text."""
        element = self.graph.get(value)
        return value if element is None else self.name(element)

    def _segment(self, element: Element) -> str:
        if element.id not in self._segments:
            owner = self.graph.owner(element)
            siblings = self.graph.roots() if owner is None else self.graph.owned(owner)
            self._segments.update(_numbered(siblings))
        return self._segments[element.id]


def _index_literals(graph: Graph) -> dict[str, str]:
    """Return ids of enumeration literals by the last two parts of their names.

    The id is empty if two literals share these parts.
    """
    found: dict[str, str] = {}
    for one in graph.of_kind(Kind.ENUMERATION_LITERAL):
        name = _last_two(graph.qualified_name(one))
        found[name] = "" if name in found else one.id
    return found


def _last_two(name: str) -> str:
    return "::".join(name.split("::")[-2:])


def _numbered(siblings: list[Element]) -> Iterator[tuple[str, str]]:
    seen: dict[str, int] = {}
    for element in siblings:
        called = word(element)
        number = seen[called] = seen.get(called, 0) + 1
        yield element.id, called if number == 1 else f"{called}#{number}"


def word(element: Element) -> str:
    """By what an element is called in qualified names: its name or what it is."""
    return element.name or element.subkind or element.kind.lower()
