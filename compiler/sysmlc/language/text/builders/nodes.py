"""Nodes, lists and bodies, and how members adapt to the owner of their body.

Some members depend on an owner that is built after them. ``add_members`` corrects them then.
"""

from collections.abc import Callable, Sequence
from typing import TypeVar

from sysmlc.language.text.lexer import Action, Span, Tokens
from sysmlc.language.tree import Node, Reference, Relation

FEATURE = "FeatureMembership"
OWNING = "OwningMembership"
PARAMETER = "ParameterMembership"
_ANNOTATING = {
    "Comment",
    "Documentation",
    "TextualRepresentation",
    "MetadataUsage",
    "MetadataFeature",
}


def make_node(kind: str, membership: str, tokens: Tokens, span: Span | None = None) -> Node:
    """Return a node for the tokens of *span*, by default those of the rule that is reduced."""
    begin, stop = span or (tokens.begin, tokens.stop)
    node = Node(kind, membership=membership, start=tokens.starts[begin])
    node.end = tokens.ends[stop - 1]
    return node


def add_members(node: Node, members: Sequence[Node]) -> Node:
    """Append the members of a body, adapted to the kind of ``node``, and return ``node``."""
    adapt = _ADAPTERS.get(node.kind)
    if adapt is not None:
        adapt(members)
    for member in members:
        member.owner = node
    node.members += members
    return node


def _adapt_to_namespace(members: Sequence[Node]) -> None:
    for member in members:
        if member.membership == FEATURE:
            member.membership = OWNING


def _adapt_to_relationship(members: Sequence[Node]) -> None:
    for member in members:
        if member.kind in _ANNOTATING:
            member.membership = "Annotation"


def _adapt_to_enumeration(members: Sequence[Node]) -> None:
    for member in members:
        if member.kind == "ReferenceUsage":
            member.kind = "EnumerationUsage"
        if member.kind == "EnumerationUsage":
            member.membership = "VariantMembership"


def _adapt_to_interface(members: Sequence[Node]) -> None:
    """Make ends without keyword ports; the word `ref` makes them references (8.2.2.14.1)."""
    for member in members:
        is_end = member.kind == "ReferenceUsage" and "isEnd" in member.attributes
        if is_end and "isReference" not in member.attributes:
            member.kind = "PortUsage"


def _adapt_to_metadata(members: Sequence[Node]) -> None:
    """Let declarations in metadata redefine the attributes of its definition (8.2.2.27)."""
    for member in members:
        if member.kind in ("ReferenceUsage", "Feature") and member.name is not None:
            start = member.name_start
            reference = Reference(((member.name,),), start, start + len(member.name))
            # The redefinition goes first: the name precedes the other specialisations in the text.
            member.relations.insert(0, Relation("Redefinition", reference))
            member.name, member.name_start = None, start


def _adapt_to_state(members: Sequence[Node]) -> None:
    """Make `then` and guards after a state transitions from that state (8.2.2.18.1)."""
    is_after_entry = False
    for member in members:
        # `entry; then off;` names the initial state: a succession from the entry action.
        if member.role == "entry":
            is_after_entry = True
        elif member.kind == "SuccessionAsUsage" and _has_only_target(member):
            if not is_after_entry:
                _turn_into_transition(member)
        elif member.kind == "TransitionUsage" and not member.find_relation("Membership"):
            has_parameter = member.members and member.members[0].membership == PARAMETER
            if not is_after_entry and not has_parameter:
                prepend_members(member, [_make_empty_parameter(member)])
        else:
            is_after_entry = False


def _has_only_target(member: Node) -> bool:
    return len(member.members) == 2 and not member.members[0].relations and member.name is None


def _make_empty_parameter(member: Node) -> Node:
    start = member.start
    return Node("ReferenceUsage", membership=PARAMETER, start=start, end=start)


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


_ADAPTERS: dict[str, Callable[[Sequence[Node]], None]] = {
    **dict.fromkeys(("Namespace", "Package", "LibraryPackage"), _adapt_to_namespace),
    **dict.fromkeys(("Dependency", "Membership"), _adapt_to_relationship),
    **dict.fromkeys(("MembershipImport", "NamespaceImport"), _adapt_to_relationship),
    **dict.fromkeys(("MembershipExpose", "NamespaceExpose"), _adapt_to_relationship),
    "EnumerationDefinition": _adapt_to_enumeration,
    **dict.fromkeys(("InterfaceDefinition", "InterfaceUsage"), _adapt_to_interface),
    **dict.fromkeys(("MetadataUsage", "MetadataFeature"), _adapt_to_metadata),
    **dict.fromkeys(("StateDefinition", "StateUsage", "ExhibitStateUsage"), _adapt_to_state),
}


T = TypeVar("T")


def omit_first(build: Action, count: int = 1) -> Action:
    """Return a builder for a notation without the first values of *build*, which are None."""
    absent = [None] * count
    return lambda tokens, *values: build(tokens, *absent, *values)


def _start_list(_tokens: Tokens, item: T | list[T]) -> list[T]:
    return item if isinstance(item, list) else [item]


def _append_item(_tokens: Tokens, items: list[T], item: T | list[T]) -> list[T]:
    if isinstance(item, list):
        items += item
    else:
        items.append(item)
    return items


def _pass_on(_tokens: Tokens, value: T) -> T:
    return value


def _build_empty_list(_tokens: Tokens) -> list[Node]:
    return []


def _append_result(tokens: Tokens, items: list[Node] | None, result: Node) -> list[Node]:
    result.membership = "ResultExpressionMembership"
    tokens.restricted_nodes.append(result)
    return [*(items or ()), result]


ACTIONS = {
    "first": _start_list,
    "more": _append_item,
    **dict.fromkeys(("nothing", "from", "of", "typed_by"), _build_empty_list),
    "only_result": omit_first(_append_result),
    "with_result": _append_result,
    **dict.fromkeys(("block", "bracket", "arguments", "general", "same"), _pass_on),
}
