"""What each reference means: an element of the unit, or a stand-in for one outside it."""

import posixpath
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from operator import attrgetter
from urllib.parse import unquote

from sysmlc.ir import AttrValue, Element, Graph, Kind
from sysmlc.ir.identity import derived_id, is_globally_unique
from sysmlc.passes.resolve.hrefs import (
    PRIMITIVE_TYPES,
    is_href,
    kind_of,
    name_of,
    primitive,
    split,
)
from sysmlc.passes.resolve.libraries import StandIn, add_stub, find_library_element
from sysmlc.passes.resolve.references import Need, Use


class Targets:
    """Elements of the unit by id, and by file and id."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph

    @cached_property
    def _prefixed(self) -> dict[str, list[Element]]:
        """Elements whose ids several files have, by that id: in the graph the file is before it."""
        index: dict[str, list[Element]] = {}
        for element in self._graph:
            if "#" in element.id and element.source:
                index.setdefault(element.id.rpartition("#")[2], []).append(element)
        return index

    def _named(self, fragment: str) -> list[Element]:
        """Elements of all files with this id."""
        plain = self._graph.get(fragment)
        found = self._prefixed.get(fragment, [])
        return found if plain is None or "#" in fragment or not plain.source else [*found, plain]

    @cached_property
    def _files(self) -> dict[str, set[str]]:
        index: dict[str, set[str]] = {}
        for file in set(map(attrgetter("source"), self._graph)) - {""}:
            index.setdefault(_basename(file), set()).add(file)
        return index

    def find(self, file: str, target: str) -> Element | None:
        """The element that ``target`` means in ``file``, or None when no file of the unit has it.

        A file is known by its path relative to ``file``, else by its name alone: that is all
        that a ``pathmap:`` leaves. An id that no tool gives twice is found whatever the file.
        """
        exact = self._graph.get(target)
        if exact is not None:
            return exact
        if not is_href(target):
            return self._graph.get(f"{file}#{target.lstrip('#')}") or self._in(
                target.lstrip("#"), (file,)
            )
        library, fragment = split(target)
        found = self._in(fragment, self.files(file, library))
        if found is None and is_globally_unique(fragment):
            found = _first(self._named(fragment))
        return found

    def files(self, file: str, library: str) -> tuple[str, ...]:
        """Files of the unit that ``library``, as ``file`` names it, can mean."""
        plain = unquote(library)
        named = self._files.get(_basename(plain), set())
        beside = posixpath.normpath(posixpath.join(posixpath.dirname(file), plain))
        exact = [name for name in named if name.partition("!")[0] in (beside, plain)]
        return tuple(sorted(exact or named))

    def _in(self, fragment: str, files: tuple[str, ...]) -> Element | None:
        found = self._named(fragment) if files else []
        return _first(element for element in found if element.source in files)


def _basename(file: str) -> str:
    return posixpath.basename(file.partition("!")[0])


def _first(elements: Iterable[Element]) -> Element | None:
    # The smallest id, not the first that was read: the order of the files must not matter.
    return min(elements, key=lambda element: element.id, default=None)


@dataclass(slots=True)
class Answers:
    """What each target means, by the file that names it."""

    graph: Graph
    targets: Targets
    outside: dict[str, list[Need]] = field(default_factory=dict)
    """Needs of elements outside the unit, by the href of the stand-in."""
    known: "dict[str, StandIn]" = field(default_factory=dict)
    """Those of ``outside`` that are elements of a known library."""
    _found: dict[tuple[str, str], str | None] = field(default_factory=dict)
    _stubs: dict[str, str] = field(default_factory=dict)

    def find(self, needs: list[Need]) -> None:
        """Look for every target, and make the stand-ins for those outside the unit."""
        distant: dict[str, list[Need]] = {}
        for need in needs:
            if need.target not in self.graph and self._is_outside(need.file, need.target):
                distant.setdefault(need.target, []).append(need)
        for target in sorted(distant):
            href = self._canonical(target, distant[target])
            self._stubs[target] = stand_in_id(href)
            self.outside.setdefault(href, []).extend(distant[target])
        for href in sorted(self.outside):
            self._add(href, self.outside[href])

    def get(self, file: str, target: str) -> Element | None:
        """The element that ``target`` means in a file."""
        if target in self.graph:
            return self.graph[target]
        found = self._found.get((file, target))
        return self.graph.get(found or self._stubs.get(target))

    def _is_outside(self, file: str, target: str) -> bool:
        element = self.targets.find(file, target)
        self._found[file, target] = element.id if element else None
        if element is not None or not is_href(target):
            return False
        return not self.targets.files(file, split(target)[0])

    def _canonical(self, target: str, needs: list[Need]) -> str:
        # All are asked, for the order in which they come must not matter.
        said = {(need.path, need.kind) for need in needs}
        name = max({primitive(target, path, kind) for path, kind in said})
        if name:
            return PRIMITIVE_TYPES + name
        found = find_library_element(target, {path for path, _ in said}, {kind for _, kind in said})
        if found is None:
            return target
        if found.owner == "PrimitiveTypes":
            return PRIMITIVE_TYPES + found.name
        self.known[found.href] = found
        return found.href

    def _add(self, href: str, needs: list[Need]) -> None:
        if href in self.known:
            add_stub(self.graph, self.known[href], _origin(needs))
        else:
            _stand_in(self.graph, href, needs)


def stand_in_id(href: str) -> str:
    """Id of the stand-in for an element outside the unit, by its address."""
    return derived_id(href, "stub")


def _origin(needs: list[Need]) -> str:
    return min((need.first() for need in needs), key=Use.place).holder.id


def _stand_in(graph: Graph, href: str, needs: list[Need]) -> None:
    id = stand_in_id(href)
    if id in graph:
        return
    path = min((need.path for need in needs if need.path), default="")
    kind = kind_of(href, {need.kind for need in needs})
    attrs: dict[str, AttrValue] = {"external": True, "href": href}
    if href.startswith(PRIMITIVE_TYPES):
        kind, path = Kind.DATA_TYPE, ""
        attrs["subkind"] = "primitive"
    if "::" in path:
        attrs["qualified_name"] = path
    attrs["origin"] = _origin(needs)
    graph.add(Element(id, kind, name_of(href, path), attrs=attrs))
