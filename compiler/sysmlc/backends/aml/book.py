"""What all writers of parts share: the graph, the files, ids, class paths and losses."""

from dataclasses import dataclass, field

from sysmlc.backends.aml.families import Families, Family
from sysmlc.backends.aml.identity import Identity
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.rules import Losses
from sysmlc.ir import Edge, Element, Graph

_BRACKETED = frozenset("/@[]")


@dataclass(slots=True, eq=False)
class File:
    """One CAEX file; ``name`` is the source whose elements it holds, ``document`` its Document."""

    name: str
    path: str
    root: Node
    document: Element | None = None
    aliases: dict[str, str] = field(default_factory=dict)
    """Alias by name of the other file."""


@dataclass(slots=True, eq=False)
class Place:
    """A class in its library: the node, names from the library down, and the file (or None)."""

    node: Node | None
    names: tuple[str, ...]
    file: File | None
    family: Family


@dataclass(slots=True)
class Book:
    """The files as far as they are written."""

    graph: Graph
    losses: Losses
    files: list[File]
    families: Families
    ids: Identity
    places: dict[str, Place] = field(default_factory=dict)
    """Classes by the id of their element."""
    nodes: dict[str, Node] = field(default_factory=dict)
    """What stands for an element, by its id."""
    holders: dict[str, str] = field(default_factory=dict)
    """Id of the feature (or instance) that each inlined type belongs to, by the type's id."""
    said: set[str] = field(default_factory=set)
    relations: set[tuple[Edge, str, str]] = field(default_factory=set)
    copies: list[tuple[Node, Element]] = field(default_factory=list)
    """Internal elements with the class that they are copies of."""
    late: list[tuple[Node, str, Element]] = field(default_factory=list)
    """References to ids: the node, its attribute, the element that is meant."""
    mapped: dict[str, list[tuple[Element, Element]]] = field(default_factory=dict)
    """Features that redefine those of roles, by the id of the class that has them."""
    paths: dict[tuple[str, Family, str], str] = field(default_factory=dict)
    """Classes by the paths that were written: name of the file, family, path."""
    first: dict[tuple[File | None, Family, tuple[str, ...]], str] = field(default_factory=dict)
    """The element that a path means: of two classes of one path the first."""

    def file_of(self, element: Element) -> File:
        """The file that an element is written to."""
        return next((file for file in self.files if file.name == element.source), self.files[0])

    def say(self, edge: Edge, source: Element, target: Element) -> None:
        """Note that a relation is written."""
        self.relations.add((edge, source.id, target.id))

    def put(self, element: Element, node: Node) -> Node:
        """Note that a node stands for an element."""
        self.said.add(element.id)
        self.nodes.setdefault(element.id, node)
        return node

    def path(self, target: Element, file: File) -> str:
        """The class path that means the class in a file, or the empty string."""
        place = self.places.get(target.id)
        if place is None or self.first.get((place.file, place.family, place.names)) != target.id:
            return ""
        names = place.names
        if any(_BRACKETED.intersection(name) for name in names):
            names = tuple(f"[{name}]" for name in names)
        path = "/".join(names)
        if place.file is not None and place.file is not file:
            alias = file.aliases.get(place.file.name)
            path = f"{alias}@{path}" if alias else ""
        self.paths[file.name, place.family, path] = target.id
        return path

    def class_at(self, path: str, family: Family, file: File) -> Element | None:
        """The class that a path means that was written in a file."""
        return self.graph.get(self.paths.get((file.name, family, path)))

    def enter(self, element: Element, place: Place) -> None:
        """Know a class under its path."""
        self.places[element.id] = place
        self.first.setdefault((place.file, place.family, place.names), element.id)

    def owned(self, *owners: Element | None) -> list[Element]:
        """What some elements own, in order."""
        return [one for owner in owners if owner is not None for one in self.graph.owned(owner)]
