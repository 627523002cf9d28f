"""The tree of a model in KerML or SysML v2: elements by metaclass, whatever notation they came in.

It is the abstract syntax of the specifications (KerML 1.0, 8.3; SysML 2.0, 8.3), folded where a
relationship only says how its owner owns one element: such a membership is two texts of the
member, ``membership`` and ``role``. What refers to other elements by name is a ``Relation``.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from msgspec import Struct

if TYPE_CHECKING:
    from sysmlc.sources import Source

Fact = str | bool | int | float
"""What an attribute of a metaclass may hold."""


class Reference:
    """The name of another element: ``A::B`` or a feature chain ``A::b.c.d``, as the text says it.

    ``chain`` has a tuple of names for each link of the chain, quotes and escapes undone; a first
    name ``$`` is the global scope. ``targets`` has the element of each link once names are
    resolved, and is None before; what leads nowhere ends the list early. ``target`` is the element
    that the whole chain leads to, if it was found.
    """

    __slots__ = ("chain", "end", "start", "target", "targets")

    def __init__(self, chain: tuple[tuple[str, ...], ...], start: int = -1, end: int = -1) -> None:
        self.chain = chain
        self.start = start
        self.end = end
        self.target: Node | None = None
        self.targets: list[Node] | None = None

    def lead(self, targets: "list[Node]") -> None:
        """Say the elements that the links of the chain lead to, as far as they were found."""
        self.targets = targets
        self.target = targets[-1] if targets and len(targets) == len(self.chain) else None

    def forget_targets(self) -> None:
        """Make the reference unresolved again."""
        self.target = self.targets = None

    def __str__(self) -> str:
        return ".".join("::".join(names) for names in self.chain)

    def __repr__(self) -> str:
        return f"<Reference {self}>"


class Relation:
    """A relationship of a node to an element that it does not own.

    ``kind`` is the metaclass (``FeatureTyping``, ``Redefinition``, ``ConjugatedPortTyping``,
    ``Annotation`` ...), ``Membership`` for a member that is only named (the referent of an
    expression, the element of an alias, the source of a transition), or, where the node is the
    relationship itself, the name of the end: ``client`` and ``supplier`` of a dependency,
    ``importedNamespace``, ``importedMembership``, ``subclassifier`` ... Those that the
    specification adds to what a text says, ``names.adding`` gives.
    """

    __slots__ = ("kind", "reference")

    def __init__(self, kind: str, reference: Reference) -> None:
        self.kind = kind
        self.reference = reference

    def __repr__(self) -> str:
        return f"<{self.kind} {self.reference}>"


class Node:
    """An element: its metaclass, its names, what it is related to, what it owns.

    ``membership`` is the metaclass of the membership by which its owner owns it
    (``OwningMembership``, ``FeatureMembership``, ``FeatureValue``, ``SubjectMembership`` ...),
    ``role`` what that membership says beside: ``=``, ``:=``, ``default``, ``default =`` or
    ``default :=`` of a feature value, ``entry``, ``do``, ``exit`` of a subaction, ``trigger``,
    ``guard``, ``effect`` of a transition, ``assumption``, ``requirement`` of a constraint.
    ``visibility`` is empty when the text does not say it. ``facts`` are the attributes of the
    metaclass that the text states, by their names there (``isAbstract``, ``direction``,
    ``operator``, ``value``, ``body`` ...); what it leaves at the default is not in it.
    ``start`` and ``end`` are offsets of characters in the text of the document, -1 without one;
    ``name_start`` is that of the name, else of the first token that belongs to nothing else.
    """

    __slots__ = (
        "end",
        "facts",
        "kind",
        "members",
        "membership",
        "name",
        "name_start",
        "owner",
        "relations",
        "role",
        "short",
        "start",
        "visibility",
    )

    def __init__(
        self,
        kind: str,
        name: str | None = None,
        *,
        short: str | None = None,
        membership: str = "",
        role: str = "",
        visibility: str = "",
        start: int = -1,
        end: int = -1,
    ) -> None:
        self.kind = kind
        self.name = name
        self.short = short
        self.owner: Node | None = None
        self.membership = membership
        self.role = role
        self.visibility = visibility
        self.facts: dict[str, Fact] = {}
        self.relations: list[Relation] = []
        self.members: list[Node] = []
        self.start = start
        self.end = end
        self.name_start = start

    def own(self, member: "Node") -> "Node":
        """Take ``member`` as the last of the members; it is returned."""
        member.owner = self
        self.members.append(member)
        return member

    def walk(self) -> Iterator["Node"]:
        """The node and all below it, owners first, in the order of the text."""
        stack = [self]
        while stack:
            node = stack.pop()
            yield node
            stack.extend(reversed(node.members))

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name or self.short or '?'}>"


class Document(Struct, frozen=True, eq=False):
    """One file: its path relative to the unit's root, its language, its text, its tree.

    ``language`` is ``sysml`` or ``kerml``; ``text`` is empty for interchange files, whose places
    are ordinals of XML elements. ``root`` is the root namespace (KerML 8.2.3.4.1).
    """

    path: str
    language: str
    root: Node
    text: str = ""
    source: "Source | None" = None
