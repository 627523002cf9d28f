"""Name resolution: the element of the unit, or the external stub, that each reference means.

Pending references and attributes that hold ids are uses of elements that must be resolved.
"""

import posixpath
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from operator import attrgetter
from typing import NamedTuple
from urllib.parse import unquote

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, Reference
from sysmlc.ir.element import derived_id, is_globally_unique
from sysmlc.ir.query import ids_in
from sysmlc.passes.resolve.libraries import (
    PRIMITIVE_TYPES,
    LibraryElement,
    add_stub,
    choose_kind,
    find_library_element,
    find_primitive,
    is_href,
    read_name,
    split_href,
)

_ATTRIBUTES: dict[Kind, dict[str, Kind]] = {
    Kind.CONTROL: {"decision_input": Kind.ACTIVITY, "decision_input_flow": Kind.OBJECT_FLOW},
    Kind.CONTROL_FLOW: {"interrupts": Kind.STRUCTURED},
    Kind.OBJECT_FLOW: {"interrupts": Kind.STRUCTURED},
    Kind.ITEM_FLOW: {"item_property": Kind.PROPERTY},
    Kind.ACTION: {"on_port": Kind.PORT},
    Kind.TRIGGER: {"port": Kind.PORT},
    Kind.CONNECTOR_END: {"defining_end": Kind.PROPERTY},
    Kind.MESSAGE: {"connector": Kind.CONNECTOR},
    Kind.OPERATION: {"raised_exception": Kind.CLASS},
    Kind.STRUCTURED: dict.fromkeys(("test", "body_part", "setup_part", "clauses"), Kind.ACTION),
}
"""Attributes that hold ids (docs/ir.md), by the kind of their element: what they name."""


class Use(NamedTuple):
    """One use of an element: a pending edge, or an attribute that holds an id."""

    holder: Element
    target: str
    kind: Kind
    path: str = ""
    ordinal: int = -1
    edge: Edge | None = None
    attribute: str = ""

    @property
    def relation(self) -> str:
        """The name of the edge or of the attribute."""
        return self.edge.value if self.edge else self.attribute

    def location(self) -> tuple[str, int, str]:
        """Return file, ordinal and id of the holder, which order uses by the text."""
        ordinal = self.ordinal if self.ordinal >= 0 else self.holder.ordinal
        return self.holder.source, ordinal, self.holder.id


@dataclass(slots=True)
class Need:
    """All uses in one file that name a target with the same words."""

    graph: Graph
    file: str
    target: str
    kind: Kind
    path: str
    references: list[Reference] = field(default_factory=list)
    """The pending references among the places."""
    held: list[Use] = field(default_factory=list)
    """The attributes among the places."""

    def uses(self) -> list[Use]:
        """Return all uses."""
        return [use_of(self.graph[r.source], r) for r in self.references] + self.held

    def first_use(self) -> Use:
        """Return the first use in the unit, whatever the order in which files are read."""
        return min(self.uses(), key=Use.location)


def use_of(holder: Element, reference: Reference) -> Use:
    """Return the place of a pending reference that leaves *holder*."""
    edge, _, target, kind, path, ordinal = reference
    return Use(holder, target, kind, path, ordinal, edge)


def group_uses(graph: Graph, held_ids: list[Use]) -> list[Need]:
    """Group uses by file, target and description of the target.

    These are the pending references whose target is no id of the graph, and all attributes.
    """
    groups: dict[tuple[str, str, Kind, str], Need] = {}
    for reference in graph.pending:
        holder = graph.get(reference.source)
        if holder is not None and reference.target not in graph:
            key = (holder.source, reference.target, reference.kind, reference.name)
            if key not in groups:
                groups[key] = Need(graph, *key)
            groups[key].references.append(reference)
    for use in held_ids:
        key = (use.holder.source, use.target, use.kind, use.path)
        groups.setdefault(key, Need(graph, *key)).held.append(use)
    return list(groups.values())


def list_held_ids(graph: Graph) -> Iterator[Use]:
    """Yield the uses in attributes that hold ids."""
    for holder_kind, attributes_of_kind in _ATTRIBUTES.items():
        for element in graph.of_kind(holder_kind):
            attrs = element.attrs
            if attrs and not attrs.keys().isdisjoint(attributes_of_kind):
                for name, kind in attributes_of_kind.items():
                    for id in ids_in(attrs.get(name)):
                        yield Use(element, id, kind, attribute=name)


# -- resolution --------------------------------------------------------------------------------


class UnitIndex:
    """Elements of the unit by id, and by file and id."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph

    @cached_property
    def _by_shared_id(self) -> dict[str, list[Element]]:
        """Elements whose id occurs in several files, by that id without the file."""
        index: dict[str, list[Element]] = {}
        for element in self._graph:
            if "#" in element.id and element.source:
                index.setdefault(element.id.rpartition("#")[2], []).append(element)
        return index

    def _with_id(self, fragment: str) -> list[Element]:
        """Return the elements of all files with this id."""
        plain = self._graph.get(fragment)
        shared = self._by_shared_id.get(fragment, [])
        return shared if plain is None or "#" in fragment or not plain.source else [*shared, plain]

    @cached_property
    def _files(self) -> dict[str, set[str]]:
        index: dict[str, set[str]] = {}
        for file in set(map(attrgetter("source"), self._graph)) - {""}:
            index.setdefault(_basename(file), set()).add(file)
        return index

    def find(self, file: str, target: str) -> Element | None:
        """Return the element that *target* means in *file*, or None if no file of the unit has it.

        A file is found by its path relative to *file*, else by its base name, which is all that a
        ``pathmap:`` leaves. An id that no tool assigns twice is found in any file.
        """
        exact = self._graph.get(target)
        if exact is not None:
            return exact
        if not is_href(target):
            return self._graph.get(f"{file}#{target.lstrip('#')}") or self._find_in_files(
                target.lstrip("#"), (file,)
            )
        library, fragment = split_href(target)
        element = self._find_in_files(fragment, self.files(file, library))
        if element is None and is_globally_unique(fragment):
            element = _smallest_id(self._with_id(fragment))
        return element

    def files(self, file: str, library: str) -> tuple[str, ...]:
        """Return the files of the unit that *library*, as *file* names it, can mean."""
        plain = unquote(library)
        named = self._files.get(_basename(plain), set())
        relative = posixpath.normpath(posixpath.join(posixpath.dirname(file), plain))
        exact = [name for name in named if name.partition("!")[0] in (relative, plain)]
        return tuple(sorted(exact or named))

    def _find_in_files(self, fragment: str, files: tuple[str, ...]) -> Element | None:
        candidates = self._with_id(fragment) if files else []
        return _smallest_id(element for element in candidates if element.source in files)


def _basename(file: str) -> str:
    return posixpath.basename(file.partition("!")[0])


def _smallest_id(elements: Iterable[Element]) -> Element | None:
    # The smallest id, not the first one read, because the order of files must have no effect.
    return min(elements, key=lambda element: element.id, default=None)


@dataclass(slots=True)
class Resolver:
    """The meaning of each target, by the file that names it."""

    graph: Graph
    index: UnitIndex
    external: dict[str, list[Need]] = field(default_factory=dict)
    """Uses of elements outside the unit, by the href of the stub."""
    library_elements: dict[str, LibraryElement] = field(default_factory=dict)
    """The elements of known libraries among them, by href."""
    _internal: dict[tuple[str, str], str | None] = field(default_factory=dict)
    _stubs: dict[str, str] = field(default_factory=dict)

    def resolve(self, needs: list[Need]) -> None:
        """Resolve every target, and add external stubs for those outside the unit."""
        external: dict[str, list[Need]] = {}
        for need in needs:
            if need.target not in self.graph and self._is_outside(need.file, need.target):
                external.setdefault(need.target, []).append(need)
        for target in sorted(external):
            href = self._find_canonical_href(target, external[target])
            self._stubs[target] = stub_id(href)
            self.external.setdefault(href, []).extend(external[target])
        for href in sorted(self.external):
            self._add_external(href, self.external[href])

    def get(self, file: str, target: str) -> Element | None:
        """Return the element that *target* means in a file."""
        if target in self.graph:
            return self.graph[target]
        id = self._internal.get((file, target)) or self._stubs.get(target)
        return self.graph.get(id)

    def _is_outside(self, file: str, target: str) -> bool:
        element = self.index.find(file, target)
        self._internal[file, target] = element.id if element else None
        if element is not None or not is_href(target):
            return False
        return not self.index.files(file, split_href(target)[0])

    def _find_canonical_href(self, target: str, needs: list[Need]) -> str:
        """Return the href of a target's stub, one for all spellings of a library element."""
        # All references to the target count, because their order must not matter.
        descriptions = {(need.path, need.kind) for need in needs}
        name = max({find_primitive(target, path, kind) for path, kind in descriptions})
        if name:
            return PRIMITIVE_TYPES + name
        element = find_library_element(
            target, {path for path, _ in descriptions}, {kind for _, kind in descriptions}
        )
        if element is None:
            return target
        if element.owner == "PrimitiveTypes":
            return PRIMITIVE_TYPES + element.name
        self.library_elements[element.href] = element
        return element.href

    def _add_external(self, href: str, needs: list[Need]) -> None:
        if href in self.library_elements:
            add_stub(self.graph, self.library_elements[href], _find_origin(needs))
        else:
            _add_unknown_stub(self.graph, href, needs)


def stub_id(href: str) -> str:
    """Return the id of the external stub for an address."""
    return derived_id(href, "stub")


def _find_origin(needs: list[Need]) -> str:
    return min((need.first_use() for need in needs), key=Use.location).holder.id


def _add_unknown_stub(graph: Graph, href: str, needs: list[Need]) -> None:
    id = stub_id(href)
    if id in graph:
        return
    path = min((need.path for need in needs if need.path), default="")
    kind = choose_kind(href, {need.kind for need in needs})
    attrs: dict[str, AttrValue] = {"external": True, "href": href}
    if href.startswith(PRIMITIVE_TYPES):
        kind, path = Kind.DATA_TYPE, ""
        attrs["subkind"] = "primitive"
    if "::" in path:
        attrs["qualified_name"] = path
    attrs["origin"] = _find_origin(needs)
    graph.add(Element(id, kind, read_name(href, path), attrs=attrs))
