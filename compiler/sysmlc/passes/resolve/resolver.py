"""Resolution of references to elements of the unit or to external stubs.

A use is a pending reference, or an id in an attribute.
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

_ID_ATTRIBUTES: dict[Kind, dict[str, Kind]] = {
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
"""Attributes that hold ids (docs/ir.md) with the kind of their targets, by kind of the holder."""


class Use(NamedTuple):
    """One use of an element: a pending reference (``edge``) or an id in an attribute."""

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
        """Return file, ordinal and id of the holder: the sort key for the order of the text."""
        ordinal = self.ordinal if self.ordinal >= 0 else self.holder.ordinal
        return self.holder.source, ordinal, self.holder.id


@dataclass(slots=True)
class UseGroup:
    """The uses in one file with the same target, expected kind and stated path."""

    graph: Graph
    file: str
    target: str
    kind: Kind
    path: str
    references: list[Reference] = field(default_factory=list)
    """The pending references of the group."""
    attribute_uses: list[Use] = field(default_factory=list)
    """The uses in attributes."""

    def uses(self) -> list[Use]:
        """Return all uses."""
        return [use_of(self.graph[r.source], r) for r in self.references] + self.attribute_uses

    def first_use(self) -> Use:
        """Return the first use by file and position, independent of the order of reading."""
        return min(self.uses(), key=Use.location)


def use_of(holder: Element, reference: Reference) -> Use:
    """Return the use for a pending reference from *holder*."""
    edge, _, target, kind, path, ordinal = reference
    return Use(holder, target, kind, path, ordinal, edge)


def group_uses(graph: Graph, held_ids: list[Use]) -> list[UseGroup]:
    """Group uses by file, target, expected kind and stated path.

    The groups contain all uses in attributes, and the pending references whose target is not an id
    of the graph.
    """
    groups: dict[tuple[str, str, Kind, str], UseGroup] = {}
    for reference in graph.pending:
        holder = graph.get(reference.source)
        if holder is not None and reference.target not in graph:
            key = (holder.source, reference.target, reference.kind, reference.name)
            if key not in groups:
                groups[key] = UseGroup(graph, *key)
            groups[key].references.append(reference)
    for use in held_ids:
        key = (use.holder.source, use.target, use.kind, use.path)
        groups.setdefault(key, UseGroup(graph, *key)).attribute_uses.append(use)
    return list(groups.values())


def list_held_ids(graph: Graph) -> Iterator[Use]:
    """Yield the uses in attributes that hold ids."""
    for holder_kind, attributes_of_kind in _ID_ATTRIBUTES.items():
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
        """Elements with an id that several files contain, by that id without the file."""
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
        """Return the element to which *target* leads from *file*, or None if it is not in the unit.

        A file is found by its path relative to *file*, or else by its base name, because a
        ``pathmap:`` address has no usable path. A globally unique id is found in any file.
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
        """Return the files of the unit to which the path *library* in *file* may lead."""
        plain = unquote(library)
        named = self._files.get(_basename(plain), set())
        relative = posixpath.normpath(posixpath.join(posixpath.dirname(file), plain))
        # The name of a file in an archive is `archive!member`; references name the archive.
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
    """Map from targets, in the files that refer to them, to elements and external stubs."""

    graph: Graph
    index: UnitIndex
    external: dict[str, list[UseGroup]] = field(default_factory=dict)
    """Uses of elements outside the unit, by the href of the stub."""
    library_elements: dict[str, LibraryElement] = field(default_factory=dict)
    """The elements of known libraries among them, by href."""
    _internal: dict[tuple[str, str], str | None] = field(default_factory=dict)
    _stubs: dict[str, str] = field(default_factory=dict)

    def resolve(self, groups: list[UseGroup]) -> None:
        """Resolve every target, and add external stubs for targets outside the unit."""
        # Sorted, so that ids and origins of stubs do not depend on the order of the files.
        external: dict[str, list[UseGroup]] = {}
        for group in groups:
            if group.target not in self.graph and self._is_outside(group.file, group.target):
                external.setdefault(group.target, []).append(group)
        for target in sorted(external):
            href = self._find_canonical_href(target, external[target])
            self._stubs[target] = stub_id(href)
            self.external.setdefault(href, []).extend(external[target])
        for href, href_groups in sorted(self.external.items()):
            if href in self.library_elements:
                origin = _find_origin(href_groups)
                add_stub(self.graph, self.library_elements[href], origin)
            else:
                _add_unknown_stub(self.graph, href, href_groups)

    def get(self, file: str, target: str) -> Element | None:
        """Return the element or stub to which *target* leads from a file, or None."""
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

    def _find_canonical_href(self, target: str, groups: list[UseGroup]) -> str:
        """Return the href of a target's stub; all spellings of a library element have the same."""
        # All references to the target are read, so that their order has no effect.
        descriptions = {(group.path, group.kind) for group in groups}
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


def stub_id(href: str) -> str:
    """Return the id of the external stub for an href."""
    return derived_id(href, "stub")


def _find_origin(groups: list[UseGroup]) -> str:
    return min((group.first_use() for group in groups), key=Use.location).holder.id


def _add_unknown_stub(graph: Graph, href: str, groups: list[UseGroup]) -> None:
    id = stub_id(href)
    if id in graph:
        return
    path = min((group.path for group in groups if group.path), default="")
    kind = choose_kind(href, {group.kind for group in groups})
    attrs: dict[str, AttrValue] = {"external": True, "href": href}
    if href.startswith(PRIMITIVE_TYPES):
        kind, path = Kind.DATA_TYPE, ""
        attrs["subkind"] = "primitive"
    if "::" in path:
        attrs["qualified_name"] = path
    attrs["origin"] = _find_origin(groups)
    graph.add(Element(id, kind, read_name(href, path), attrs=attrs))
