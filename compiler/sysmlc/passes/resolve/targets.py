"""Finding the element of the unit that a reference means, also across files."""

import posixpath
from collections.abc import Iterable
from functools import cached_property
from operator import attrgetter
from urllib.parse import unquote

from sysmlc.ir import Element, Graph
from sysmlc.ir.identity import is_unmistakable
from sysmlc.passes.resolve.hrefs import is_href, split


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
        if found is None and is_unmistakable(fragment):
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
