"""Elements and what they own: where a member depends on its owner, it is settled here."""

from collections.abc import Callable, Sequence

from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Relation

FEATURE = "FeatureMembership"
OWNING = "OwningMembership"
_ANNOTATING = {
    "Comment",
    "Documentation",
    "TextualRepresentation",
    "MetadataUsage",
    "MetadataFeature",
}
_STATES = ("StateDefinition", "StateUsage", "ExhibitStateUsage")


def made(kind: str, membership: str, tokens: Tokens, begin: int, at: int) -> Node:
    """An element of the tokens from ``begin`` to before ``at``."""
    node = Node(kind, membership=membership, start=tokens.starts[begin])
    node.end = tokens.ends[at - 1]
    return node


def own(node: Node, members: Sequence[Node]) -> Node:
    """Give the node the members of its body, as bodies of its kind have them."""
    adapt = _ADAPT.get(node.kind)
    if adapt is not None:
        adapt(node, members)
    for member in members:
        member.owner = node
    node.members += members
    return node


def _in_namespace(_owner: Node, members: Sequence[Node]) -> None:
    for member in members:
        if member.membership == FEATURE:
            member.membership = OWNING


def _in_relationship(_owner: Node, members: Sequence[Node]) -> None:
    for member in members:
        if member.kind in _ANNOTATING:
            member.membership = "Annotation"


def _in_enumeration(_owner: Node, members: Sequence[Node]) -> None:
    for member in members:
        if member.kind == "ReferenceUsage":
            member.kind = "EnumerationUsage"
        if member.kind == "EnumerationUsage":
            member.membership = "VariantMembership"


def _in_interface(_owner: Node, members: Sequence[Node]) -> None:
    """An end without keyword is a port; the word `ref` makes it a reference (8.2.2.14.1)."""
    for member in members:
        is_end = member.kind == "ReferenceUsage" and "isEnd" in member.facts
        if is_end and "isReference" not in member.facts:
            member.kind = "PortUsage"


def _in_metadata(_owner: Node, members: Sequence[Node]) -> None:
    """What looks like a declaration redefines an attribute of the metadata (8.2.2.27)."""
    from sysmlc.language.tree import Reference

    for member in members:
        if member.kind in ("ReferenceUsage", "Feature") and member.name is not None:
            start = member.name_start
            reference = Reference(((member.name,),), start, start + len(member.name))
            member.relations.insert(0, Relation("Redefinition", reference))
            member.name, member.name_start = None, start


def _in_state(_owner: Node, members: Sequence[Node]) -> None:
    """After a state, `then` and guards begin transitions that have it as source (8.2.2.18.1)."""
    after_entry = False
    for member in members:
        if member.role == "entry":
            after_entry = True
        elif member.kind == "SuccessionAsUsage" and _target(member):
            if not after_entry:
                _become_transition(member)
        elif member.kind == "TransitionUsage" and not _has_source(member):
            if not after_entry and not _is_parameter(member):
                _lead(member, [_parameter(member)])
        else:
            after_entry = False


def _target(member: Node) -> bool:
    return len(member.members) == 2 and not member.members[0].relations and member.name is None


def _has_source(member: Node) -> bool:
    return any(relation.kind == "Membership" for relation in member.relations)


def _is_parameter(member: Node) -> bool:
    return bool(member.members) and member.members[0].membership == "ParameterMembership"


def _parameter(member: Node) -> Node:
    return Node(
        "ReferenceUsage", membership="ParameterMembership", start=member.start, end=member.start
    )


def _lead(member: Node, first: list[Node]) -> None:
    for node in first:
        node.owner = member
    member.members[:0] = first


def _become_transition(member: Node) -> None:
    succession = Node("SuccessionAsUsage", membership=OWNING, start=member.start, end=member.end)
    for end in member.members:
        succession.own(end)
    member.kind = "TransitionUsage"
    member.members = []
    member.own(_parameter(member))
    member.own(succession)


_ADAPT: dict[str, Callable[[Node, Sequence[Node]], None]] = {
    "Namespace": _in_namespace,
    "Package": _in_namespace,
    "LibraryPackage": _in_namespace,
    "Dependency": _in_relationship,
    "Membership": _in_relationship,
    "MembershipImport": _in_relationship,
    "NamespaceImport": _in_relationship,
    "MembershipExpose": _in_relationship,
    "NamespaceExpose": _in_relationship,
    "EnumerationDefinition": _in_enumeration,
    "InterfaceDefinition": _in_interface,
    "InterfaceUsage": _in_interface,
    "MetadataUsage": _in_metadata,
    "MetadataFeature": _in_metadata,
    **dict.fromkeys(_STATES, _in_state),
}
