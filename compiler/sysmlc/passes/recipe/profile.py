"""Which elements may have a recipe level: what the options name, and who has that of another."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.passes.classify import vocabulary
from sysmlc.recipe.model import Range

NAMESPACE = "urn:sysmlc:profile:1"
"""Namespace of the shipped profile, metamodels/sysmlc.profile.uml."""

_OF_PARTS = ("capability", "opc ua call")
"""What else the profile marks: no levels, but what services and machine functions have."""
LEVELS = {name: level for name, level in vocabulary.LEVELS.items() if level not in _OF_PARTS}
"""Level of the recipe, by stereotype of the profile."""

CALL_KINDS = ("call", "read", "write", "subscribe")
MATERIAL_USES = ("consumed", "produced", "carried")

_FOLLOWED = (Edge.SPECIALIZES, Edge.TYPED_BY, Edge.REDEFINES, Edge.CALLS, Edge.METHOD)
"""Edges along which an element has the level of another one."""


def said(
    graph: Graph, levels: Mapping[str, str], segment: Callable[[Element], str]
) -> dict[str, str]:
    """Levels by id that elements have themselves: by the options, ``classify`` or a stereotype.

    ``levels`` are those of the options, by ids or qualified names, which win. ``segment`` is the
    part of an element in such a name.
    """
    found = _applied(graph)
    known = frozenset(LEVELS.values())
    for one in graph:
        if "level" in one.attrs and (level := str(one.attrs["level"])) in known:
            found[one.id] = level
    roots = graph.roots() if levels else []
    for name, level in levels.items():
        found.update((one.id, level) for one in _named(graph, name, roots, segment) if level)
    found.update((id, level) for id, level in levels.items() if level and id in graph)
    return found


def _applied(graph: Graph) -> dict[str, str]:
    """Levels by id that follow from the stereotypes that are applied."""
    names: dict[str, set[str]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        for one in graph.targets(application, Edge.SUBJECT):
            names.setdefault(one.id, set()).update(stereotypes(application))
    levels = LEVELS.items()
    found = (
        (id, next((level for name, level in levels if name in own), ""))
        for id, own in names.items()
    )
    return {id: level for id, level in found if level}


def subjects(graph: Graph) -> Iterator[str]:
    """Ids of what stereotypes are applied to."""
    for application in graph.of_kind(Kind.APPLICATION):
        yield from (one.id for one in graph.targets(application, Edge.SUBJECT))


def stereotypes(application: Element) -> tuple[str, ...]:
    """Stereotypes that are applied; what another profile calls like ours only by its general."""
    names = query.lineage(application)
    is_ours = application.attrs.get("namespace") in (NAMESPACE, None)
    return names if is_ours or len(names) > 1 else ()


def _named(
    graph: Graph, name: str, siblings: list[Element], segment: Callable[[Element], str]
) -> Iterator[Element]:
    """From the top down: only what the name begins with is looked into."""
    for one in siblings:
        part = segment(one)
        if name == part:
            yield one
        elif name.startswith(f"{part}::"):
            yield from _named(graph, name[len(part) + 2 :], graph.owned(one), segment)


def followers(graph: Graph, first: Iterable[str]) -> set[str]:
    """Ids of these elements, and of all that may have a level because one of them has it."""
    waiting = [graph[id] for id in first]
    found = {one.id for one in waiting}
    while waiting:
        one = waiting.pop()
        users = (user for edge in _FOLLOWED for user in graph.sources(one, edge))
        new = [user for user in users if user.id not in found]
        found.update(user.id for user in new)
        waiting += new
    return found


class Tags(Struct, frozen=True):
    """Tagged values as the types that the profile gives them; None or empty when absent."""

    attrs: Mapping[str, object]

    def text(self, name: str) -> str:
        """Text, or the empty string."""
        return next(iter(self.texts(name)), "")

    def texts(self, name: str) -> list[str]:
        """All texts; a list of ids in one attribute is split."""
        value = self.attrs.get(f"tag.{name}")
        if value is None:
            return []
        return [str(one) for one in value] if isinstance(value, tuple) else [str(value)]

    def ids(self, name: str) -> list[str]:
        """References: ids of elements, or names."""
        return [one for text in self.texts(name) for one in text.split()]

    def flag(self, name: str) -> bool | None:
        """Truth value."""
        text = self.text(name).lower()
        return None if not text else text == "true"

    def amount(self, name: str) -> int | float | None:
        """A number that is not negative; None when there is none or it cannot be read."""
        value = number(self.text(name))
        return value if value is not None and value >= 0 else None

    def integer(self, name: str) -> int | None:
        """A whole number that is not negative."""
        value = self.amount(name)
        return int(value) if value is not None and value == int(value) else None

    def endpoint(self, name: str) -> str | None:
        """An OPC UA address."""
        text = self.text(name)
        return text if text.startswith("opc.tcp://") else None

    def call_kind(self, name: str) -> str | None:
        """What is done with an OPC UA node; a call when nothing is said."""
        text = self.text(name) or "call"
        return text if text in CALL_KINDS else None

    def material_use(self, name: str) -> str | None:
        """How a material is used."""
        text = self.text(name)
        return text if text in MATERIAL_USES else None

    def range(self, low: str, high: str) -> Range | None:
        """Two numbers; one of them stands for both."""

        values = [v for v in (self.amount(low), self.amount(high)) if v is not None]
        return Range(values[0], values[-1]) if values else None


def number(text: str) -> int | float | None:
    """The number that a text is; whole numbers are integers."""
    try:
        value = float(text)
    except ValueError:
        return None
    if value != value or value in (float("inf"), float("-inf")):
        return None
    return int(value) if value == int(value) else value
