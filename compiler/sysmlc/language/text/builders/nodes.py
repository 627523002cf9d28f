"""Nodes, lists and bodies, and how members adapt to the owner of their body.

Some members depend on an owner that is built after them. ``add_members`` corrects them then.
"""

from collections.abc import Callable, Sequence
from typing import TypeVar

from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation

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


def make_node(kind: str, membership: str, tokens: Tokens, begin: int, stop: int) -> Node:
    """Return a node for the tokens from ``begin`` to before ``stop``."""
    node = Node(kind, membership=membership, start=tokens.starts[begin])
    node.end = tokens.ends[stop - 1]
    return node


def add_members(node: Node, members: Sequence[Node]) -> Node:
    """Append the members of a body, adapted to the kind of ``node``, and return ``node``."""
    adapt = _ADAPTERS.get(node.kind)
    if adapt is not None:
        adapt(node, members)
    for member in members:
        member.owner = node
    node.members += members
    return node


def _adapt_to_namespace(_owner: Node, members: Sequence[Node]) -> None:
    for member in members:
        if member.membership == FEATURE:
            member.membership = OWNING


def _adapt_to_relationship(_owner: Node, members: Sequence[Node]) -> None:
    for member in members:
        if member.kind in _ANNOTATING:
            member.membership = "Annotation"


def _adapt_to_enumeration(_owner: Node, members: Sequence[Node]) -> None:
    for member in members:
        if member.kind == "ReferenceUsage":
            member.kind = "EnumerationUsage"
        if member.kind == "EnumerationUsage":
            member.membership = "VariantMembership"


def _adapt_to_interface(_owner: Node, members: Sequence[Node]) -> None:
    """Make ends without keyword ports; the word `ref` makes them references (8.2.2.14.1)."""
    for member in members:
        is_end = member.kind == "ReferenceUsage" and "isEnd" in member.attributes
        if is_end and "isReference" not in member.attributes:
            member.kind = "PortUsage"


def _adapt_to_metadata(_owner: Node, members: Sequence[Node]) -> None:
    """Let declarations in metadata redefine the attributes of its definition (8.2.2.27)."""
    for member in members:
        if member.kind in ("ReferenceUsage", "Feature") and member.name is not None:
            start = member.name_start
            reference = Reference(((member.name,),), start, start + len(member.name))
            # The redefinition goes first: the name precedes the other specialisations in the text.
            member.relations.insert(0, Relation("Redefinition", reference))
            member.name, member.name_start = None, start


def _adapt_to_state(_owner: Node, members: Sequence[Node]) -> None:
    """Make `then` and guards after a state transitions from that state (8.2.2.18.1)."""
    is_after_entry = False
    for member in members:
        # `entry; then off;` names the initial state: a succession from the entry action.
        if member.role == "entry":
            is_after_entry = True
        elif member.kind == "SuccessionAsUsage" and _has_only_target(member):
            if not is_after_entry:
                _turn_into_transition(member)
        elif member.kind == "TransitionUsage" and not _has_source(member):
            if not is_after_entry and not _begins_with_parameter(member):
                prepend_members(member, [_make_empty_parameter(member)])
        else:
            is_after_entry = False


def _has_only_target(member: Node) -> bool:
    return len(member.members) == 2 and not member.members[0].relations and member.name is None


def _has_source(member: Node) -> bool:
    return any(relation.kind == "Membership" for relation in member.relations)


def _begins_with_parameter(member: Node) -> bool:
    return bool(member.members) and member.members[0].membership == "ParameterMembership"


def _make_empty_parameter(member: Node) -> Node:
    return Node(
        "ReferenceUsage", membership="ParameterMembership", start=member.start, end=member.start
    )


def prepend_members(node: Node, members: list[Node]) -> Node:
    """Insert ``members`` before the other members of ``node``, and return ``node``."""
    for member in members:
        member.owner = node
    node.members[:0] = members
    return node


def _turn_into_transition(member: Node) -> None:
    succession = Node("SuccessionAsUsage", membership=OWNING, start=member.start, end=member.end)
    for end in member.members:
        succession.add_member(end)
    member.kind = "TransitionUsage"
    member.members = []
    member.add_member(_make_empty_parameter(member))
    member.add_member(succession)


_ADAPTERS: dict[str, Callable[[Node, Sequence[Node]], None]] = {
    "Namespace": _adapt_to_namespace,
    "Package": _adapt_to_namespace,
    "LibraryPackage": _adapt_to_namespace,
    "Dependency": _adapt_to_relationship,
    "Membership": _adapt_to_relationship,
    "MembershipImport": _adapt_to_relationship,
    "NamespaceImport": _adapt_to_relationship,
    "MembershipExpose": _adapt_to_relationship,
    "NamespaceExpose": _adapt_to_relationship,
    "EnumerationDefinition": _adapt_to_enumeration,
    "InterfaceDefinition": _adapt_to_interface,
    "InterfaceUsage": _adapt_to_interface,
    "MetadataUsage": _adapt_to_metadata,
    "MetadataFeature": _adapt_to_metadata,
    **dict.fromkeys(_STATES, _adapt_to_state),
}


T = TypeVar("T")


def _start_list(_tokens: Tokens, _stop: int, _begin: int, item: T) -> list[T]:
    return [item]


def _append_item(_tokens: Tokens, _stop: int, _begin: int, items: list[T], item: T) -> list[T]:
    items.append(item)
    return items


def _start_members(_tokens: Tokens, _stop: int, _begin: int, item: Node | list[Node]) -> list[Node]:
    return item if isinstance(item, list) else [item]


def _append_members(
    _tokens: Tokens, _stop: int, _begin: int, items: list[Node], item: Node | list[Node]
) -> list[Node]:
    if isinstance(item, list):
        items += item
    else:
        items.append(item)
    return items


def _extend_list(
    _tokens: Tokens, _stop: int, _begin: int, items: list[T], further_items: list[T]
) -> list[T]:
    items += further_items
    return items


def _pass_on(_tokens: Tokens, _stop: int, _begin: int, value: T) -> T:
    return value


def _build_empty_list(_tokens: Tokens, _stop: int, _begin: int, *_ignored: object) -> list[Node]:
    return []


def _mark_result(tokens: Tokens, node: Node) -> Node:
    node.membership = "ResultExpressionMembership"
    tokens.restricted_nodes.append(node)
    return node


def _build_result_body(tokens: Tokens, _stop: int, _begin: int, result: Node) -> list[Node]:
    return [_mark_result(tokens, result)]


def _append_result(
    tokens: Tokens, _stop: int, _begin: int, items: list[Node], result: Node
) -> list[Node]:
    items.append(_mark_result(tokens, result))
    return items


ACTIONS = {
    "first": _start_list,
    "more": _append_item,
    "items_first": _start_members,
    "items_more": _append_members,
    "join": _extend_list,
    "nothing": _build_empty_list,
    "block": _pass_on,
    "only_result": _build_result_body,
    "with_result": _append_result,
    "bracket": _pass_on,
    "arguments": _pass_on,
    "general": _pass_on,
    "from": _build_empty_list,
    "typed_by": _build_empty_list,
}
