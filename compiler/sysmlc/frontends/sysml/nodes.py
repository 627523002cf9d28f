"""Queries on nodes of the syntax tree that several handlers need."""

import re
from collections.abc import Iterator

from sysmlc.frontends.sysml.libraries import OUR_LIBRARY
from sysmlc.language.text.lexer import join_tokens
from sysmlc.language.tree import Node, Reference

_EXPRESSIONS = """
    OperatorExpression IndexExpression SelectExpression CollectExpression FeatureChainExpression
    FeatureReferenceExpression MetadataAccessExpression InvocationExpression ConstructorExpression
    NullExpression LiteralBoolean LiteralString LiteralInteger LiteralRational LiteralInfinity
    LiteralExpression TriggerInvocationExpression
"""
EXPRESSIONS = frozenset(_EXPRESSIONS.split())
ANNOTATIONS = frozenset({"Documentation", "Comment", "TextualRepresentation", "MetadataUsage"})
"""Metaclasses of members that annotate their owner and are no features of it."""
SUBSETTINGS = ("Subsetting", "ReferenceSubsetting", "CrossSubsetting")
"""Relations of a feature to features that it subsets, redefinition aside."""
_ARGUMENT_MEMBERSHIPS = frozenset(
    {"ParameterMembership", "FeatureMembership", "OwningMembership", ""}
)
_HEAD_MEMBERSHIPS = frozenset({"FeatureValue", "EndFeatureMembership"})
_MULTIPLICITIES = frozenset({"MultiplicityRange", "Multiplicity"})
_QUOTED_OR_PARENTHESIS = re.compile(r"\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|[()]")


# -- relations ---------------------------------------------------------------------------------


def list_references(node: Node, *kinds: str) -> list[Reference]:
    """Return the references of the node's relations of these metaclasses, in order."""
    return [relation.reference for relation in node.relations if relation.kind in kinds]


def find_reference(node: Node, *kinds: str) -> Reference | None:
    """Return the reference of the node's first relation of these metaclasses."""
    for relation in node.relations:
        if relation.kind in kinds:
            return relation.reference
    return None


def find_target(node: Node, *kinds: str) -> Node | None:
    """Return the target of the node's first relation of these metaclasses."""
    reference = find_reference(node, *kinds)
    return None if reference is None else reference.target


def list_subsettings(node: Node) -> list[Reference]:
    """Return the references to features that the node subsets, excluding redefined features."""
    return list_references(node, *SUBSETTINGS)


def last_name(reference: Reference) -> str:
    """Return the last segment of the name in a reference."""
    return reference.chain[-1][-1] if reference.chain and reference.chain[-1] else ""


# -- members -----------------------------------------------------------------------------------


def iter_by_metaclass(node: Node, *kinds: str) -> Iterator[Node]:
    """Yield the members of these metaclasses, in order."""
    return (member for member in node.members if member.kind in kinds)


def iter_by_membership(node: Node, *memberships: str) -> Iterator[Node]:
    """Yield the members that the node owns through one of these memberships, in order."""
    return (member for member in node.members if member.membership in memberships)


def body_of(node: Node) -> list[Node]:
    """Return the members between the braces: no multiplicity, no value and no ends."""
    if not node.members:
        return []
    cross = cross_feature_of(node)
    return [
        member
        for member in node.members
        if member.membership not in _HEAD_MEMBERSHIPS
        and member.kind not in _MULTIPLICITIES
        and member is not cross
    ]


def value_of(node: Node) -> Node | None:
    """Return the expression of the node's feature value, whether bound, initial or default."""
    for member in node.members:
        if member.membership == "FeatureValue":
            return member
    return None


def result_of(node: Node) -> Node | None:
    """Return the result expression of a constraint or a calculation."""
    return next(iter_by_membership(node, "ResultExpressionMembership"), None)


def ends_of(node: Node) -> list[Node]:
    """Return the ends of a connector, in order."""
    return [member for member in node.members if member.membership == "EndFeatureMembership"]


def events_of(node: Node) -> list[Node]:
    """Return the events at which a message is sent and received."""
    parameters = iter_by_membership(node, "ParameterMembership")
    return [parameter for parameter in parameters if parameter.kind.startswith("Event")]


def list_arguments(node: Node) -> list[Node]:
    """Return the arguments of an operator, an invocation or ``new``; named ones are features."""
    if node.kind == "ConstructorExpression":
        node = next(iter_by_membership(node, "ReturnParameterMembership"), node)
    return [member for member in node.members if member.membership in _ARGUMENT_MEMBERSHIPS]


def cross_feature_of(node: Node) -> Node | None:
    """Return the cross feature of an end: ``[*]`` in ``end [*] part b : B``.

    Its multiplicity is that of an end of a UML association (KerML 1.0, 8.3.4.5.3).
    """
    if not is_end(node):
        return None
    for member in iter_by_membership(node, "OwningMembership"):
        if member.kind in ("Feature", "ReferenceUsage"):
            return member
    return None


def is_end(node: Node) -> bool:
    """Whether a feature is an end of a connector, or of a definition of connections."""
    return node.membership == "EndFeatureMembership" or bool(node.attributes.get("isEnd"))


def is_annotation(node: Node) -> bool:
    """Whether the node only annotates its owner."""
    return node.kind in ANNOTATIONS


def shipped_metadata_name(node: Node) -> str:
    """Return the name of the definition in our library that types metadata, else ''."""
    reference = find_reference(node, "FeatureTyping")
    definition = None if reference is None else reference.target
    owner = None if definition is None else definition.owner
    if definition is None or owner is None or owner.name != OUR_LIBRARY:
        return ""
    return definition.name or definition.short_name or ""


def shipped_metadata_of(node: Node) -> dict[str, Node]:
    """Return the metadata of a node that our library defines, by the names of the definitions."""
    return {
        name: member
        for member in node.members
        if member.kind == "MetadataUsage" and (name := shipped_metadata_name(member))
    }


def is_message(node: Node) -> bool:
    """Whether a flow is a message, which has events instead of ends."""
    is_flow_without_ends = node.kind == "FlowUsage" and not ends_of(node)
    return is_flow_without_ends and bool(node.attributes.get("isAbstract"))


# -- feature paths -----------------------------------------------------------------------------


def path_of_end(end: Node) -> list[Node | None]:
    """Return the features from the outermost to the end of a connector or a flow.

    None stands for a feature that is not resolved.
    """
    path: list[Node | None] = []
    subsettings = list_references(end, "ReferenceSubsetting")
    for reference in subsettings or list_references(end, "Subsetting", "Redefinition"):
        path += _path_of_reference(reference)
    for member in end.members:
        inner = find_reference(member, "Redefinition", "ReferenceSubsetting")
        value = value_of(member)
        if inner is not None:
            path += _path_of_reference(inner)
        elif value is not None:
            path += path_of_expression(value)
    return path


def path_of_expression(expression: Node) -> list[Node | None]:
    """Return the features that an expression names: one feature, or a chain of features.

    None stands for a feature that is not resolved, and for any other expression.
    """
    reference = find_reference(expression, "Membership")
    if expression.kind == "FeatureChainExpression":
        path: list[Node | None] = []
        for member in expression.members:
            path += path_of_expression(member)
        return path + ([] if reference is None else _path_of_reference(reference))
    if expression.kind != "FeatureReferenceExpression" or reference is None:
        return [None]
    return _path_of_reference(reference)


def _path_of_reference(reference: Reference) -> list[Node | None]:
    """Return the targets of the chain; a single None stands for all unresolved targets."""
    targets: list[Node | None] = list(reference.targets or ())
    return targets if len(targets) == len(reference.chain) else [*targets, None]


# -- names and text ----------------------------------------------------------------------------


def name_of(node: Node) -> str:
    """Return the effective name (KerML 1.0, 8.3.3.3.4): its own, or that of a redefined feature.

    A usage that only refers to another usage has the name of that usage.
    """
    own_name = node.name or node.short_name
    if own_name:
        return own_name
    reference = find_reference(node, "Redefinition") or find_reference(node, "ReferenceSubsetting")
    return "" if reference is None else last_name(reference)


def qualified_name_of(node: Node) -> str:
    """Return the names from the root down, joined by ``::``; ``<metaclass>`` if there is none."""
    names = []
    element: Node | None = node
    while element is not None and element.owner is not None:
        names.append(name_of(element) or f"<{element.kind}>")
        element = element.owner
    return "::".join(reversed(names))


def root_member_of(node: Node) -> Node:
    """Return the member of the root namespace that contains the node."""
    while node.owner is not None and node.owner.owner is not None:
        node = node.owner
    return node


_METACLASS_WORDS = {
    "SuccessionAsUsage": "succession",
    "BindingConnectorAsUsage": "binding",
    "FlowUsage": "flow or message",
}
"""Names of metaclasses in the words of the notation, where they differ."""


def spell_metaclass(metaclass: str) -> str:
    """Return a metaclass in words: ``FlowDefinition`` is ``flow definition``."""
    if metaclass in _METACLASS_WORDS:
        return _METACLASS_WORDS[metaclass]
    return "".join(f" {c.lower()}" if c.isupper() else c for c in metaclass).strip()


def add_article(noun: str) -> str:
    """Return a noun, such as a metaclass in words, with its indefinite article."""
    return f"an {noun}" if noun[0] in "aeiou" and not noun.startswith("us") else f"a {noun}"


def quote_source(node: Node, text: str) -> str:
    """Return the source text of a node in one line, without notes.

    The position of an operator expression starts and ends with its operands, inside their
    parentheses; the text contains the parentheses.
    """
    if not 0 <= node.start < node.end:
        return ""
    quoted = join_tokens(text, node.start, node.end)
    opening, closing = _count_open_parentheses(quoted)
    return "(" * opening + quoted + ")" * closing


def _count_open_parentheses(text: str) -> tuple[int, int]:
    """Return how many parentheses are missing before the text and after it."""
    before = after = 0
    for token in _QUOTED_OR_PARENTHESIS.findall(text):
        if token == "(":
            after += 1
        elif token == ")" and after:
            after -= 1
        elif token == ")":
            before += 1
    return before, after
