"""The plan of a text: entries for all members, as a tree and by their elements."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.backends.sysml.rules import Losses
from sysmlc.backends.sysml.shapes import Shape
from sysmlc.ir import Element, Graph


@dataclass(slots=True, eq=False)
class Entry:
    """One member of a namespace of the text; what the text adds itself has no element."""

    shape: Shape
    parent: "Entry | None"
    element: Element | None = None
    name: str = ""
    members: list["Entry"] = field(default_factory=list)
    visible: "dict[str, Entry] | None" = None
    """Names of own and inherited members, once someone has asked."""
    meant: "dict[str, Entry] | None" = None
    """The same by the names that the model gives them."""

    @property
    def above(self) -> "Iterator[Entry]":
        """The namespaces around it, nearest first."""
        found = self.parent
        while found is not None:
            yield found
            found = found.parent


@dataclass(slots=True)
class Plan:
    """All entries: the tree, and by the ids of their elements."""

    graph: Graph
    losses: Losses
    tops: list[Entry] = field(default_factory=list)
    entries: dict[str, Entry] = field(default_factory=dict)
    shipped: list[Entry] = field(default_factory=list)
    """Packages of our own libraries, which the text refers to."""
    globals: dict[str, Entry] = field(default_factory=dict)
    added: dict[int, str] = field(default_factory=dict)
    """Type and multiplicity of attributes that no element stands for, by identity."""
    profiles: dict[int, str] = field(default_factory=dict)
    """Namespace of the profile that a stand-in is of, by the identity of its entry."""
    imports: dict[int, set[str]] = field(default_factory=dict)
    """Packages of libraries that a package of the text imports, by its identity."""
    dropped: frozenset[str] = frozenset()
    """Ids of elements that cannot be written."""
    shown: set[str] = field(default_factory=set)
    """Ids of elements that are not public in the model and that the text refers to."""
    applied: dict[str, Entry] = field(default_factory=dict)
    """Metadata definition of each application of a stereotype, by its id."""
    typing: dict[str, Shape | None] = field(default_factory=dict)
    """How elements are written that others are typed by, by id."""

    @property
    def depth(self) -> int:
        """How deep members are nested in one another."""
        level, found = self.tops, 0
        while level:
            level, found = [one for above in level for one in above.members], found + 1
        return found

    def entry(self, element: Element | None) -> Entry | None:
        """The entry that an element has, or that stands for it."""
        return None if element is None else self.entries.get(element.id)

    def show(self, entry: Entry) -> None:
        """Something refers to the member from outside of its namespace, so that it is public."""
        if entry.element is not None and "visibility" in entry.element.attrs:
            self.shown.add(entry.element.id)

    def new(self, shape: Shape, parent: Entry | None, name: str, element: Element | None) -> Entry:
        """A new entry at the end of its namespace."""
        made = Entry(shape, parent, element, name)
        (self.tops if parent is None else parent.members).append(made)
        if element is not None:
            self.entries[element.id] = made
        return made
