"""The plan of a text: a tree of members, also found by the elements that they stand for."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.rules import Losses
from sysmlc.backends.sysml.shapes import Shape
from sysmlc.ir import Element, Graph
from sysmlc.logic.expressions.resolution import NameResolver


@dataclass(slots=True, eq=False)
class Member:
    """A member of a namespace of the text; one that the back end adds itself has no element."""

    shape: Shape
    parent: "Member | None"
    element: Element | None = None
    name: str = ""
    members: list["Member"] = field(default_factory=list)
    visible_names: "dict[str, Member] | None" = None
    """Own and inherited members by name in the text; ``references`` fills it on first use."""
    imports: list[str] = field(default_factory=list)
    """Library packages that a root imports because its members refer to them."""
    added_lines: list[Line] = field(default_factory=list)
    """Lines that other members add to the namespace and that are not written yet."""
    objective_lines: list[Line] = field(default_factory=list)
    """Lines of the objective of a verification case."""
    prewritten: list[Line] | None = None
    """Lines of the member if it was written before its turn."""
    is_declared: bool = False
    """Whether the line of another member declares this one."""
    added_type: str = ""
    """Type and multiplicity of an attribute without an element."""
    profile_namespace: str = ""
    """URI of the profile of a metadata definition without an element."""

    @property
    def namespaces(self) -> "Iterator[Member]":
        """Yield the namespaces around the member, the nearest first."""
        namespace = self.parent
        while namespace is not None:
            yield namespace
            namespace = namespace.parent

    def require_element(self) -> Element:
        """Return the element; only for members that stand for one."""
        assert self.element is not None
        return self.element

    def take_added_lines(self) -> list[Line]:
        """Return the added lines and remove them: each is written once."""
        lines, self.added_lines = self.added_lines, []
        return lines


@dataclass
class Plan:
    """All members of a text, as a tree and by the ids of their elements."""

    graph: Graph
    losses: Losses
    author_files: frozenset[str] = frozenset()
    """Files in SysML v2, whose text the output contains as its author wrote it."""
    roots: list[Member] = field(default_factory=list)
    members_by_id: dict[str, Member] = field(default_factory=dict)
    library_packages: list[Member] = field(default_factory=list)
    """Packages of the libraries of sysmlc, which the text refers to but does not contain."""
    root_names: dict[str, Member] = field(default_factory=dict)
    """Roots and packages of libraries by name: the global scope of name lookup."""
    dropped: frozenset[str] = frozenset()
    """Ids of elements that the text omits because it cannot name what they refer to."""
    exposed: set[str] = field(default_factory=set)
    """Ids of elements that references reach from outside of their owner; they must be public."""
    metadata_definitions: dict[str, Member] = field(default_factory=dict)
    """Metadata definition of each stereotype application, by the id of the application."""
    type_shapes: dict[str, Shape | None] = field(default_factory=dict)
    """Shapes of the elements that type others, by id."""

    @cached_property
    def resolver(self) -> NameResolver:
        """The resolver of names in texts that the pass ``expressions`` has not resolved."""
        return NameResolver(self.graph)

    @property
    def depth(self) -> int:
        """The number of levels of nested members."""
        level, depth = self.roots, 0
        while level:
            level, depth = [child for member in level for child in member.members], depth + 1
        return depth

    def find(self, element: Element | None) -> Member | None:
        """Return the member of the text that stands for *element*, or None."""
        return None if element is None else self.members_by_id.get(element.id)

    def is_author_member(self, member: Member) -> bool:
        """Whether the author of a file in SysML v2 wrote the member."""
        return member.element is not None and member.element.source in self.author_files

    def is_in_author_text(self, element: Element) -> bool:
        """Whether an author's text contains the element, and no overlay moves it out of there."""
        owners = (element, *self.graph.ancestors(element))
        return all(owner.source in self.author_files for owner in owners)

    def expose(self, member: Member) -> None:
        """Mark a member as referred to from outside of its namespace."""
        if member.element is not None and "visibility" in member.element.attrs:
            self.exposed.add(member.element.id)

    def add(
        self, shape: Shape, parent: Member | None, name: str, element: Element | None
    ) -> Member:
        """Add a member at the end of its namespace."""
        member = Member(shape, parent, element, name)
        (self.roots if parent is None else parent.members).append(member)
        if element is not None:
            self.members_by_id[element.id] = member
        return member
