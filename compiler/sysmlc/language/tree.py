"""Syntax trees of KerML and SysML v2: elements by metaclass, whatever notation they came in.

A tree is the abstract syntax of the specifications (KerML 1.0, 8.3; SysML 2.0, 8.3). A relationship
that only states how an owner owns one element is folded into two strings of that member,
``membership`` and ``role``. A reference to another element by name is a ``Relation``.
"""

import re
from bisect import bisect_left, bisect_right
from codecs import BOM_UTF8
from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING

from msgspec import Struct

from sysmlc.diagnostics import Place, Subject

if TYPE_CHECKING:
    from sysmlc.sources import Source

AttributeValue = str | bool | int | float
"""Values that an attribute of a metaclass may have."""
_WIDE_CHARACTER = re.compile(r"[^\x00-\x7f]")


class Reference:
    """The name of another element as it is written: ``A::B`` or a feature chain ``A::b.c.d``.

    ``chain`` has a tuple of names for each link of the chain, without quotes and escapes; a first
    name ``$`` stands for the global scope. ``targets`` has the element of each link. It is None
    until the reference is resolved, and shorter than the chain if a link was not found. ``target``
    is the element that the whole chain leads to, or None.
    """

    __slots__ = ("chain", "end", "start", "target", "targets")

    def __init__(self, chain: tuple[tuple[str, ...], ...], start: int = -1, end: int = -1) -> None:
        self.chain = chain
        self.start = start
        self.end = end
        self.target: Node | None = None
        self.targets: list[Node] | None = None

    def set_targets(self, targets: "list[Node]") -> None:
        """Resolve the links of the chain to ``targets``, which ends before the first lost link."""
        self.targets = targets
        self.target = targets[-1] if targets and len(targets) == len(self.chain) else None

    def clear_targets(self) -> None:
        """Make the reference unresolved again."""
        self.target = self.targets = None

    def __str__(self) -> str:
        return ".".join("::".join(names) for names in self.chain)

    def __repr__(self) -> str:
        return f"<Reference {self}>"


class Relation:
    """A relationship of a node to an element that it does not own.

    ``kind`` is one of these:

    - the metaclass of the relationship (``FeatureTyping``, ``Redefinition``, ``Annotation`` ...)
    - ``Membership`` for an element that is only named: the referent of an expression, the element
      of an alias, the source of a transition
    - the name of an end, where the node is the relationship itself: ``client`` and ``supplier`` of
      a dependency, ``importedNamespace``, ``importedMembership``, ``subclassifier`` ...

    A tree has the relations that the text states. ``names.implied_relations`` computes those that
    the specification adds.
    """

    __slots__ = ("kind", "reference")

    def __init__(self, kind: str, reference: Reference) -> None:
        self.kind = kind
        self.reference = reference

    def __repr__(self) -> str:
        return f"<{self.kind} {self.reference}>"


class Node:
    """An element: its metaclass (``kind``), names, attributes, relations and owned members.

    ``membership`` is the metaclass of the membership by which the owner owns the node
    (``OwningMembership``, ``FeatureMembership``, ``FeatureValue``, ``SubjectMembership`` ...).
    ``role`` is the attribute of that membership: ``=``, ``:=``, ``default``, ``default =`` or
    ``default :=`` of a feature value; ``entry``, ``do`` or ``exit`` of a subaction; ``trigger``,
    ``guard`` or ``effect`` of a transition; ``assumption`` or ``requirement`` of a constraint.
    ``visibility`` is empty unless the text states it. ``attributes`` has the attributes of the
    metaclass that the text states, by their names there (``isAbstract``, ``direction``,
    ``operator``, ``value``, ``body`` ...), and none that has its default value.
    ``start`` and ``end`` are character offsets in the text of the document, -1 without a text.
    ``name_start`` is the offset of the name, or of the first token after prefixes and visibility
    for an element without a name.
    """

    __slots__ = (
        "attributes",
        "end",
        "kind",
        "members",
        "membership",
        "name",
        "name_start",
        "owner",
        "relations",
        "role",
        "short_name",
        "start",
        "visibility",
    )

    def __init__(
        self,
        kind: str,
        name: str | None = None,
        *,
        short_name: str | None = None,
        membership: str = "",
        role: str = "",
        visibility: str = "",
        start: int = -1,
        end: int = -1,
    ) -> None:
        self.kind = kind
        self.name = name
        self.short_name = short_name
        self.owner: Node | None = None
        self.membership = membership
        self.role = role
        self.visibility = visibility
        self.attributes: dict[str, AttributeValue] = {}
        self.relations: list[Relation] = []
        self.members: list[Node] = []
        self.start = start
        self.end = end
        self.name_start = start

    def add_member(self, member: "Node") -> "Node":
        """Append ``member`` to the owned members, and return it."""
        member.owner = self
        self.members.append(member)
        return member

    def find_relation(self, kind: str) -> Relation | None:
        """Return the first relation of a kind, or None."""
        for relation in self.relations:
            if relation.kind == kind:
                return relation
        return None

    def find_member(self, membership: str) -> "Node | None":
        """Return the first member with a membership, or None."""
        for member in self.members:
            if member.membership == membership:
                return member
        return None

    def walk(self) -> Iterator["Node"]:
        """Yield the node and all below it, owners first, in the order of the text."""
        stack = [self]
        while stack:
            node = stack.pop()
            yield node
            stack.extend(reversed(node.members))

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name or self.short_name or '?'}>"


class Document(Struct, frozen=True, eq=False, dict=True):
    """One file: its path relative to the unit's root, its language, its text and its tree.

    ``language`` is ``sysml`` or ``kerml``. ``text`` is empty for interchange files, whose locations
    are ordinals of XML elements. ``root`` is the root namespace (KerML 8.2.3.4.1).
    """

    path: str
    language: str
    root: Node
    text: str = ""
    source: "Source | None" = None

    @cached_property
    def byte_offsets(self) -> "ByteOffsets":
        """The offsets in the file of the characters of the text."""
        return ByteOffsets(self.text, self.source)

    def ordinal_of(self, node: Node) -> int:
        """Return the byte at which the name of a node starts, or its ordinal in an XMI file."""
        return self.byte_offsets.byte_of(node.name_start if node.name_start >= 0 else node.start)


def find_root(node: Node) -> Node:
    """Return the root namespace of the document that contains ``node``."""
    while node.owner is not None:
        node = node.owner
    return node


def list_arguments(expression: Node) -> list[Node]:
    """Return the operands, or the positional arguments."""
    return [member for member in expression.members if member.membership == "ParameterMembership"]


def make_subject(document: Document, node: Node, start: int) -> Subject:
    """Return ``node`` as the subject of a diagnostic at character ``start``, if that is known."""
    return Subject(node.name or "", place=locate(document, start if start >= 0 else node.start))


def locate(document: Document, start: int) -> Place:
    """Return the location of a character of a text, or of an XML element of an interchange file."""
    if not document.text:
        return Place(document.path, ordinal=start)
    return Place(document.path, offset=document.byte_offsets.byte_of(start))


def byte_order_mark_length(source: "Source | None") -> int:
    """Return the number of bytes of the byte order mark, which a decoded text does not contain."""
    is_marked = source is not None and source.data.startswith(BOM_UTF8)
    return len(BOM_UTF8) if is_marked else 0


class ByteOffsets:
    """Offsets in a file, in bytes, of the characters of its text.

    The characters that take several bytes are indexed once, because models with many diagnostics
    ask for many offsets.
    """

    def __init__(self, text: str, source: "Source | None") -> None:
        surplus = byte_order_mark_length(source) if text else 0
        self._wide_characters: list[int] = []
        self._surplus_bytes = [surplus]
        """Bytes beyond one for each character, before the first and after each wide character."""
        for match in _WIDE_CHARACTER.finditer(text):
            # A lone surrogate, which UTF-8 cannot encode, counts as the one byte of '?'.
            surplus += len(match[0].encode("utf-8", "replace")) - 1
            self._wide_characters.append(match.start())
            self._surplus_bytes.append(surplus)

    def byte_of(self, character: int) -> int:
        """Return the byte at which a character of the text starts; -1 stays -1."""
        if character < 0:
            return character
        return character + self._surplus_bytes[bisect_left(self._wide_characters, character)]

    def character_at(self, byte: int) -> int:
        """Return the character of the text that contains a byte; -1 before the first."""
        return bisect_right(range(byte + 1), byte, key=self.byte_of) - 1
