"""Which elements may have a recipe level: what the options name, and who has that of another."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.passes.classify import vocabulary

NAMESPACE = "urn:sysmlc:profile:1"
"""Namespace of the shipped profile, metamodels/sysmlc.profile.uml."""

_OF_PARTS = ("capability", "opc ua call")
"""What else the profile marks: no levels, but what services and machine functions have."""
LEVELS = {name: level for name, level in vocabulary.LEVELS.items() if level not in _OF_PARTS}
"""Level of the recipe, by stereotype of the profile."""

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
