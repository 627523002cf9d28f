"""Questions about nodes of the tree that every part of the lowering asks."""

from collections.abc import Iterator

from sysmlc.language.tree import Node, Reference

_EXPRESSIONS = """
    OperatorExpression IndexExpression SelectExpression CollectExpression FeatureChainExpression
    FeatureReferenceExpression MetadataAccessExpression InvocationExpression ConstructorExpression
    NullExpression LiteralBoolean LiteralString LiteralInteger LiteralRational LiteralInfinity
    LiteralExpression TriggerInvocationExpression
"""
EXPRESSIONS = frozenset(_EXPRESSIONS.split())
TEXTS = frozenset({"Documentation", "Comment", "TextualRepresentation", "MetadataUsage"})
"""Metaclasses of what annotates its owner and gives it no feature."""
_ARGUMENTS = frozenset({"ParameterMembership", "FeatureMembership", "OwningMembership", ""})
SUBSETTINGS = ("Subsetting", "ReferenceSubsetting", "CrossSubsetting")
"""Relations to features that a feature subsets, in whatever way but redefinition."""


def references(node: Node, *kinds: str) -> list[Reference]:
    """References of the relations of these metaclasses that the text states, in order."""
    return [one.reference for one in node.relations if one.kind in kinds]


def reference(node: Node, *kinds: str) -> Reference | None:
    """The first of them."""
    for one in node.relations:
        if one.kind in kinds:
            return one.reference
    return None


def target(node: Node, *kinds: str) -> Node | None:
    """The element that the first of them leads to."""
    found = reference(node, *kinds)
    return None if found is None else found.target


def subsetted(node: Node) -> list[Reference]:
    """Features that the node subsets, in whatever way but redefinition."""
    return references(node, *SUBSETTINGS)


def members(node: Node, *kinds: str) -> Iterator[Node]:
    """Members of these metaclasses, in order."""
    return (one for one in node.members if one.kind in kinds)


def held(node: Node, *memberships: str) -> Iterator[Node]:
    """Members that these memberships own, in order."""
    return (one for one in node.members if one.membership in memberships)


def quoted(node: Node, text: str) -> str:
    """Return the source text of a node in one line, without notes."""
    from sysmlc.language.text.lexer import join_tokens

    return join_tokens(text, node.start, node.end) if 0 <= node.start < node.end else ""


def arguments(node: Node) -> list[Node]:
    """The arguments of an operator, an invocation or `new`, in order; named ones as features."""
    if node.kind == "ConstructorExpression":
        node = next(held(node, "ReturnParameterMembership"), node)
    return [one for one in node.members if one.membership in _ARGUMENTS]


def value_of(node: Node) -> Node | None:
    """The expression of the node's feature value, bound, initial or default."""
    for one in node.members:
        if one.membership == "FeatureValue":
            return one
    return None


def result_of(node: Node) -> Node | None:
    """The result expression of a constraint, a calculation or a body."""
    return next(held(node, "ResultExpressionMembership"), None)


def ends_of(node: Node) -> list[Node]:
    """The ends of a connector, in order."""
    return [one for one in node.members if one.membership == "EndFeatureMembership"]


def is_message(node: Node) -> bool:
    """Whether a flow is a message: it has events instead of ends."""
    return (
        node.kind == "FlowUsage" and not ends_of(node) and bool(node.attributes.get("isAbstract"))
    )


def events_of(node: Node) -> list[Node]:
    """The events at which a message is sent and received."""
    return [one for one in held(node, "ParameterMembership") if one.kind.startswith("Event")]


def last_name(found: Reference) -> str:
    """The last name of a reference."""
    return found.chain[-1][-1] if found.chain and found.chain[-1] else ""


def name_of(node: Node) -> str:
    """The effective name (KerML 1.0, 8.3.3.3.4): its own, else that of what it redefines.

    A usage that only refers to another one has the name of that.
    """
    own = node.name or node.short_name
    if own:
        return own
    redefined = reference(node, "Redefinition") or reference(node, "ReferenceSubsetting")
    return "" if redefined is None else last_name(redefined)


def body_of(node: Node) -> list[Node]:
    """What stands between the braces: neither multiplicity, value nor ends."""
    if not node.members:
        return []
    cross = crossed(node)
    return [
        one
        for one in node.members
        if one.membership not in _HEAD and one.kind not in _RANGE and one is not cross
    ]


def crossed(node: Node) -> Node | None:
    """The feature of an end that crosses to the other end: ``[*]`` in ``end [*] part b : B``.

    Its multiplicity is that of an end of a UML association (KerML 1.0, 8.3.4.5.3).
    """
    if not node.attributes.get("isEnd") and node.membership != "EndFeatureMembership":
        return None
    found = held(node, "OwningMembership")
    return next((one for one in found if one.kind in ("Feature", "ReferenceUsage")), None)


_HEAD = frozenset({"FeatureValue", "EndFeatureMembership"})
_RANGE = frozenset({"MultiplicityRange", "Multiplicity"})


def is_text(node: Node) -> bool:
    """Whether the node only annotates its owner."""
    return node.kind in TEXTS


def top_of(node: Node) -> Node:
    """The member of the root namespace that the node stands in."""
    while node.owner is not None and node.owner.owner is not None:
        node = node.owner
    return node


def path_of(node: Node) -> str:
    """Names from the root down, joined by ``::``; what has no name shows its metaclass."""
    names = []
    above: Node | None = node
    while above is not None and above.owner is not None:
        names.append(name_of(above) or f"<{above.kind}>")
        above = above.owner
    return "::".join(reversed(names))


def words(metaclass: str) -> str:
    """A metaclass in words: ``FlowDefinition`` is ``flow definition``."""
    return "".join(f" {c.lower()}" if c.isupper() else c for c in metaclass).strip()
