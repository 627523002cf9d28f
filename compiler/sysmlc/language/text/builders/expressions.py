"""Primary expressions: literals, names, chains, invocations, sequences (KerML 8.2.5.8)."""

import math
from collections.abc import Sequence
from functools import partial

from sysmlc.language.text.builders.nodes import FEATURE, PARAMETER, add_members, make_node
from sysmlc.language.text.builders.operators import make_argument
from sysmlc.language.text.lexer import MAX_INTEGER_DIGITS, LexicalFault, Tokens, unquote
from sysmlc.language.tree import AttributeValue, Node, Reference, Relation


def _build_literal(kind: str, value: AttributeValue | None, tokens: Tokens) -> Node:
    node = make_node(kind, "", tokens)
    if value is not None:
        node.attributes["value"] = value
    return node


def _build_number(tokens: Tokens, token: int) -> Node:
    written = tokens[token]
    if written.isdigit() and len(written) <= MAX_INTEGER_DIGITS:
        return _build_literal("LiteralInteger", int(written), tokens)
    value = float(written)
    # An infinite number would break arithmetic and JSON far away from here.
    if math.isinf(value):
        tokens.faults.append(LexicalFault("number", tokens.starts[token], written))
        value = 0.0
    return _build_literal("LiteralRational", value, tokens)


def _build_string(tokens: Tokens, token: int) -> Node:
    return _build_literal("LiteralString", unquote(tokens[token]), tokens)


def _build_naming(kind: str, tokens: Tokens, name: Reference, *operands: Node) -> Node:
    """Build an expression that names an element, with its operands."""
    node = make_node(kind, "", tokens)
    for operand in operands:
        node.add_member(make_argument(operand))
    node.relations.append(Relation("Membership", name))
    return node


def _build_constructor(tokens: Tokens, name: Reference, arguments: list[Node]) -> Node:
    node = _build_naming("ConstructorExpression", tokens, name)
    result = node.add_member(make_node("Feature", "ReturnParameterMembership", tokens))
    add_members(result, _mark_arguments(arguments))
    return node


def _mark_arguments(arguments: Sequence[Node]) -> Sequence[Node]:
    for node in arguments:
        if node.membership != FEATURE:
            node.membership = PARAMETER
    return arguments


def _build_named_argument(tokens: Tokens, name: Reference, value: Node) -> Node:
    node = make_node("Feature", FEATURE, tokens)
    node.relations.append(Relation("Redefinition", name))
    value.membership, value.role = "FeatureValue", "="
    node.add_member(value)
    return node


def _build_sequence(_tokens: Tokens, first: Node, rest: list[Node]) -> Node:
    remaining = [first, *rest]
    result = remaining.pop()
    while remaining:
        element = remaining.pop()
        outer = Node("OperatorExpression", start=element.start, end=result.end)
        outer.attributes["operator"] = ","
        outer.add_member(make_argument(element))
        outer.add_member(make_argument(result))
        result = outer
    return result


def _build_application(kind: str, tokens: Tokens, primary: Node, inner: Node) -> Node:
    node = make_node(kind, "", tokens)
    node.add_member(make_argument(primary))
    node.add_member(make_argument(inner))
    return node


def _build_bracketed(tokens: Tokens, primary: Node, inner: Node) -> Node:
    node = _build_application("OperatorExpression", tokens, primary, inner)
    node.attributes["operator"] = "["
    return node


def _build_chained(tokens: Tokens, primary: Node, name: Reference) -> Node:
    # `a.b.c` is one chain of two links after `a`, but `(a.b).c` are two chains.
    has_no_parentheses = primary.start == tokens.starts[tokens.begin]
    if primary.kind == "FeatureChainExpression" and has_no_parentheses:
        reference = primary.relations[0].reference
        reference.chain += name.chain
        reference.end = primary.end = name.end
        return primary
    return _build_naming("FeatureChainExpression", tokens, name, primary)


def _build_iteration(kind: str, tokens: Tokens, primary: Node, body: list[Node]) -> Node:
    return _build_application(kind, tokens, primary, _make_body_argument(tokens, primary, body))


def _make_body_argument(tokens: Tokens, operand: Node | Reference, body: list[Node]) -> Node:
    # The brace has no token number here, because the body was reduced without it.
    return _make_body_expression(tokens, tokens.text.find("{", operand.end), body)


def _make_body_expression(tokens: Tokens, start: int, body: list[Node]) -> Node:
    """Return an expression with a body between braces (KerML 8.2.5.8.3)."""
    end = tokens.ends[tokens.stop - 1]
    node = Node("FeatureReferenceExpression", start=start, end=end)
    add_members(node.add_member(Node("Expression", membership=FEATURE, start=start, end=end)), body)
    return node


def _build_body_expression(tokens: Tokens, body: list[Node]) -> Node:
    return _make_body_expression(tokens, tokens.starts[tokens.begin], body)


def _make_invocation(tokens: Tokens, name: Reference, arguments: Sequence[Node]) -> Node:
    node = _build_naming("InvocationExpression", tokens, name)
    return add_members(node, _mark_arguments(arguments))


def _build_operation(tokens: Tokens, primary: Node, name: Reference, arguments: list[Node]) -> Node:
    return _make_invocation(tokens, name, [make_argument(primary), *arguments])


def _build_body_operation(tokens: Tokens, primary: Node, name: Reference, body: list[Node]) -> Node:
    return _build_operation(tokens, primary, name, [_make_body_argument(tokens, name, body)])


def _build_function_operation(
    tokens: Tokens, primary: Node, name: Reference, function: Reference
) -> Node:
    outer = Node("FeatureReferenceExpression", start=function.start, end=function.end)
    inner = Node("Expression", membership=FEATURE, start=function.start, end=function.end)
    outer.add_member(inner).relations.append(Relation("FeatureTyping", function))
    return _build_operation(tokens, primary, name, [outer])


def _build_metadata_access(tokens: Tokens, primary: Node) -> Node:
    if primary.kind == "FeatureReferenceExpression" and primary.relations:
        primary.kind = "MetadataAccessExpression"
        primary.end = tokens.ends[tokens.stop - 1]
    return primary


def _build_invocation(tokens: Tokens, primary: Node, arguments: list[Node]) -> Node:
    name = find_chain(primary)
    return primary if name is None else _make_invocation(tokens, name, arguments)


def find_chain(node: Node) -> Reference | None:
    """Return the name or feature chain that an expression consists of, or None."""
    if node.kind == "FeatureReferenceExpression" and node.relations:
        return node.relations[0].reference
    if node.kind != "FeatureChainExpression":
        return None
    operand_chain = find_chain(node.members[0])
    if operand_chain is None:
        return None
    last = node.relations[0].reference
    return Reference(operand_chain.chain + last.chain, operand_chain.start, last.end)


ACTIONS = {
    "number": _build_number,
    "string": _build_string,
    "true": partial(_build_literal, "LiteralBoolean", True),
    "false": partial(_build_literal, "LiteralBoolean", False),
    "infinity": partial(_build_literal, "LiteralInfinity", None),
    "null": partial(_build_literal, "NullExpression", None),
    "feature_reference": partial(_build_naming, "FeatureReferenceExpression"),
    "constructor": _build_constructor,
    "named_argument": _build_named_argument,
    "sequence": _build_sequence,
    "bracketed": _build_bracketed,
    "indexed": partial(_build_application, "IndexExpression"),
    "chained": _build_chained,
    "collected": partial(_build_iteration, "CollectExpression"),
    "selected": partial(_build_iteration, "SelectExpression"),
    "body_expression": _build_body_expression,
    "operation": _build_operation,
    "body_operation": _build_body_operation,
    "function_operation": _build_function_operation,
    "metadata_access": _build_metadata_access,
    "invocation": _build_invocation,
}
