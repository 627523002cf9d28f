"""What all writers share: the plan, the losses, and what of the graph has been said."""

from collections.abc import Callable
from dataclasses import dataclass, field

from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.order import in_order
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import library_name, named, qualified, redefined_name, visible
from sysmlc.backends.sysml.rules import APPROXIMATED, UNREACHABLE, Losses
from sysmlc.backends.sysml.shapes import Shape
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Graph

Writer = Callable[["Book", Entry], list[Line]]
"""Writes a member of a namespace, with what belongs beside it."""


@dataclass(slots=True)
class Book:
    """The text as far as it is written."""

    graph: Graph
    plan: Plan
    losses: Losses
    writers: dict[str, Writer] = field(default_factory=dict)
    """Writer by kind of element."""
    said: set[str] = field(default_factory=set)
    """Ids of elements that the text says."""
    extra: dict[int, list[Line]] = field(default_factory=dict)
    """Members that something else in the model adds to a namespace, by the entry's identity."""
    objectives: dict[int, list[Line]] = field(default_factory=dict)
    """What verification cases verify, by the entry's identity."""
    prepared: dict[int, list[Line]] = field(default_factory=dict)
    """What is written before its turn, by the entry's identity."""
    declared: set[int] = field(default_factory=set)
    """Identities of attributes that the text needs and that are written after the members."""
    dropped: dict[str, str] = field(default_factory=dict)
    """What elements refer to without a name, so that they cannot be written; by their ids."""
    loops: set[str] = field(default_factory=set)
    """Ids of regions that are written as loops over a collection."""
    kept: set[tuple[str, str]] = field(default_factory=set)
    """Ids of elements with the names of attributes that metadata keeps."""
    kept_edges: set[tuple[Edge, str, str]] = field(default_factory=set)
    """Edges that metadata keeps, with the ids of their ends."""
    public: frozenset[str] = frozenset()
    """Ids of elements that are written as public because the text refers to them."""
    caex: frozenset[str] = frozenset()
    """Files that are AutomationML: their elements keep their ids."""
    uses_library: bool = False

    def name(self, scope: Entry | None, holder: Element, edge: Edge, target: Element) -> str | None:
        """The name of what an edge leads to; a loss when nothing names it."""
        found = named(self.plan, scope, target)
        if found is None:
            self.lost(holder, str(edge.value))
        return found

    def names(self, scope: Entry | None, holder: Element, edge: Edge) -> list[str]:
        """Qualified names of all that the edges of a kind lead to."""
        found = []
        for target in self.graph.targets(holder, edge):
            entry = self.plan.entry(target)
            name = None if entry is None else qualified(self.plan, scope, entry)
            if name is None:
                self.lost(holder, str(edge.value))
            else:
                found.append(name)
        return found

    def lost(self, holder: Element, what: str) -> None:
        """A reference to something without a name."""
        self.losses.note(UNREACHABLE, holder, edge=what, kind=str(holder.kind))

    def drop(self, entry: Entry, what: str) -> list[Line]:
        """A member that cannot be written: nothing may refer to it."""
        if entry.element is not None:
            self.dropped[entry.element.id] = what
        return []

    def approximated(self, element: Element, said: str, written: str) -> None:
        """Something that is said in other words."""
        self.losses.note(APPROXIMATED, element, said=said, written=written)

    def library(self, scope: Entry | None, name: str) -> str:
        """A name of the standard library, or of ours."""
        self.uses_library = self.uses_library or name.startswith("SysMLC::")
        return library_name(self.plan, scope, name)

    def ours(self, scope: Entry | None, name: str) -> str:
        """A name of our own library, which is then written beside the text."""
        return self.library(scope, f"SysMLC::{name}")

    def redefined(self, scope: Entry | None, target: Element) -> str | None:
        """The name of a feature that is redefined in a namespace."""
        entry = self.plan.entry(target)
        return None if entry is None else redefined_name(self.plan, scope, entry)

    def beside(self, entry: Entry, head: str) -> None:
        """Add a member to a namespace, after those of the model."""
        self.extra.setdefault(id(entry), []).append(Line(head))

    def declare(self, space: Entry, name: str, type_: str) -> str:
        """An attribute that the text needs and no element stands for; its name as it is written.

        One of the same name and type in the namespace serves again.
        """
        known = visible(self.plan, space)
        for one in space.members:
            if one.element is None and one.name == name:
                return quoted(one.name)
        free, number = name, 2
        while free in known:
            free, number = f"{name}_{number}", number + 1
        made = self.plan.new(Shape("attribute"), space, free, None)
        space.visible = None
        self.beside(space, f"attribute {quoted(free)} : {self.library(space, type_)}")
        self.declared.add(id(made))
        return quoted(free)

    def members(self, entry: Entry) -> list[Line]:
        """The members of a namespace, in the order of reading; those of the model first."""
        lines = [line for one in in_order(self.graph, entry) for line in self.member(one)]
        return lines + self.extra.pop(id(entry), [])

    def member(self, entry: Entry) -> list[Line]:
        """One member."""
        if id(entry) in self.declared:
            return []
        if entry.element is None:
            return self.writers[""](self, entry)
        write = self.writers.get(str(entry.element.kind))
        if write is None:
            return []
        self.said.add(entry.element.id)
        return write(self, entry)
