"""The state that all writers share: the files, the ids and the class paths in them."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from msgspec import Struct

from sysmlc.backends.aml.class_kinds import ClassKind, is_caex_package, is_inline
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.rules import Losses
from sysmlc.ir import Edge, Element, Graph, list_items
from sysmlc.ir.element import derived_id
from sysmlc.ir.query.names import find_caex_id, find_extended_id

_BRACKETED = frozenset("/@[]")
"""A path whose names contain one of these has its names in brackets (IEC 62424, A.2)."""


@dataclass(slots=True, eq=False)
class File:
    """One CAEX file; *name* is the source file of its elements, *document* its Document."""

    name: str
    path: str
    root: Node
    document: Element | None = None
    aliases: dict[str, str] = field(default_factory=dict)
    """Alias by name of the other file."""


@dataclass(slots=True, eq=False)
class ClassEntry:
    """A class and its path; without a node if it is in a standard library that no file holds."""

    node: Node | None
    names: tuple[str, ...]
    """Names from the library down to the class."""
    file: File | None
    kind: ClassKind


class ObjectIds(Struct, frozen=True):
    """Finds the ``ID`` of an object: that of an AutomationML file unchanged, else a derived one."""

    graph: Graph
    files: frozenset[str]
    """Names of the sources that are AutomationML."""

    def is_from_caex(self, element: Element) -> bool:
        """Whether the element comes from an AutomationML file, if only by way of another language.

        UML and SysML v2 preserve which packages were libraries and hierarchies of AutomationML.
        """
        if element.source in self.files:
            return True
        path = [element, *self.graph.ancestors(element)]
        return is_caex_package(path[-1]) and not path[-1].attrs.get("external")

    def find_original(self, element: Element) -> str:
        """Return the ID that the object has in its AutomationML file, or the empty string."""
        return find_caex_id(element, self.files)

    def choose(self, *elements: Element | None) -> str:
        """Return the ID of an object that several elements represent.

        It is the first original ID among the elements, else an ID derived from the first element.
        """
        present = [element for element in elements if element is not None]
        for element in present:
            id = self.find_original(element)
            if not id and is_inline(element) and element.source in self.files:
                id = find_extended_id(element)
            if id:
                return id
        return derived_id(present[0].id, "caex")


@dataclass(slots=True)
class Context:
    """The files written so far, and the records by which ``omissions.py`` finds what they lack."""

    graph: Graph
    losses: Losses
    files: list[File]
    ids: ObjectIds
    classes: dict[str, ClassEntry] = field(default_factory=dict)
    """By the id of the class."""
    nodes: dict[str, Node] = field(default_factory=dict)
    """The node that represents an element, by the id of the element."""
    written: set[str] = field(default_factory=set)
    """Ids of the elements that the files express."""
    written_edges: set[tuple[Edge, str, str]] = field(default_factory=set)
    """Edges that the files express: kind, source, target."""
    copies: list[tuple[Node, Element]] = field(default_factory=list)
    """Internal elements, each with the class that it is a copy of."""
    pending_references: list[tuple[Node, str, Element]] = field(default_factory=list)
    """References by id, written last: the node, its XML attribute, the referenced element."""
    role_features: dict[str, list[tuple[Element, Element]]] = field(default_factory=dict)
    """Features with the role's feature that they redefine, by the id of the owning class."""
    class_ids: dict[tuple[str, ClassKind, str], str] = field(default_factory=dict)
    """Ids of classes by the paths that were written: name of the file, kind, path."""
    _first_ids: dict[tuple[File | None, ClassKind, tuple[str, ...]], str] = field(
        default_factory=dict
    )
    """The id of the class that a path denotes: of several classes with one path the first."""

    def find_file(self, element: Element) -> File:
        """Return the file that an element is written to."""
        return next((file for file in self.files if file.name == element.source), self.files[0])

    def mark_edge(self, edge: Edge, source: Element, target: Element) -> None:
        """Record that the files express an edge."""
        self.written_edges.add((edge, source.id, target.id))

    def register(self, element: Element, node: Node) -> Node:
        """Record that a node represents an element, and return the node."""
        self.written.add(element.id)
        self.nodes.setdefault(element.id, node)
        return node

    def copy_id(self, element: Element, node: Node) -> None:
        """Write the ID that the element has in its AutomationML file, if it has one."""
        id = self.ids.find_original(element)
        if id:
            node.attributes["ID"] = id

    def add_class(self, element: Element, entry: ClassEntry) -> None:
        """Register a class under its path."""
        self.classes[element.id] = entry
        self._first_ids.setdefault((entry.file, entry.kind, entry.names), element.id)

    def make_class_path(self, target: Element, file: File) -> str:
        """Return the path that denotes a class in *file*, or the empty string if none does."""
        entry = self.classes.get(target.id)
        if entry is None:
            return ""
        if self._first_ids.get((entry.file, entry.kind, entry.names)) != target.id:
            return ""
        names = entry.names
        if any(_BRACKETED.intersection(name) for name in names):
            names = tuple(f"[{name}]" for name in names)
        path = "/".join(names)
        if entry.file is not None and entry.file is not file:
            alias = file.aliases.get(entry.file.name)
            path = f"{alias}@{path}" if alias else ""
        self.class_ids[file.name, entry.kind, path] = target.id
        return path

    def find_class(self, path: str, kind: ClassKind, file: File) -> Element | None:
        """Return the class that a path written in *file* denotes."""
        return self.graph.get(self.class_ids.get((file.name, kind, path)))

    def list_owned(self, *owners: Element | None) -> list[Element]:
        """Return the elements that the given owners own, in order."""
        return [
            element for owner in owners if owner is not None for element in self.graph.owned(owner)
        ]

    def iter_bases(self, type_: Element | None) -> Iterator[Element]:
        """Yield a class and its base classes, the nearest first; CAEX has single inheritance."""
        visited: set[str] = set()
        while type_ is not None and type_.id not in visited:
            visited.add(type_.id)
            yield type_
            type_ = self.graph.target(type_, Edge.SPECIALIZES)


def find_unresolved(element: Element, *tags: str) -> str:
    """Return the first reference of *element* that could not be resolved, as it was written.

    Only references in XML elements with one of *tags* count.
    """
    return next((path for _, path in iter_unresolved(element, *tags)), "")


def iter_unresolved(element: Element, *tags: str) -> Iterator[tuple[str, str]]:
    """Yield tag and path of the references that could not be resolved, as they were written."""
    for pair in list_items(element.attrs.get("unresolved_paths")):
        if isinstance(pair, tuple) and pair[0] in tags:
            yield str(pair[0]), str(pair[1])
