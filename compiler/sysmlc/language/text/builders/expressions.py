"""Primary expressions: literals, names, chains, invocations, sequences (KerML 8.2.5.8)."""

import math
from collections.abc import Sequence

from sysmlc.language.text.builders.nodes import FEATURE, add_members, make_node
from sysmlc.language.text.builders.operators import ARGUMENT, make_argument
from sysmlc.language.text.lexer import MAX_INTEGER_DIGITS, LexicalFault, Tokens, unquote
from sysmlc.language.tree import Node, Reference, Relation


def _make_literal(
    kind: str, value: str | bool | int | float, tokens: Tokens, begin: int, stop: int
) -> Node:
    node = make_node(kind, "", tokens, begin, stop)
    node.attributes["value"] = value
    return node


def _build_number(tokens: Tokens, stop: int, begin: int, token: int) -> Node:
    written = tokens[token]
    if written.isdigit() and len(written) <= MAX_INTEGER_DIGITS:
        return _make_literal("LiteralInteger", int(written), tokens, begin, stop)
    value = float(written)
    # An infinite number would break arithmetic and JSON far away from here.
    if math.isinf(value):
        tokens.faults.append(LexicalFault("number", tokens.starts[token], written))
        value = 0.0
    return _make_literal("LiteralRational", value, tokens, begin, stop)


def _build_string(tokens: Tokens, stop: int, begin: int, token: int) -> Node:
    return _make_literal("LiteralString", unquote(tokens[token]), tokens, begin, stop)


def _build_true(tokens: Tokens, stop: int, begin: int, _none: None) -> Node:
    return _make_literal("LiteralBoolean", True, tokens, begin, stop)


def _build_false(tokens: Tokens, stop: int, begin: int, _none: None) -> Node:
    return _make_literal("LiteralBoolean", False, tokens, begin, stop)


def _build_infinity(tokens: Tokens, stop: int, begin: int, _none: None) -> Node:
    return make_node("LiteralInfinity", "", tokens, begin, stop)


def _build_null(tokens: Tokens, stop: int, begin: int, _none: None) -> Node:
    return make_node("NullExpression", "", tokens, begin, stop)


def _build_feature_reference(tokens: Tokens, stop: int, begin: int, name: Reference) -> Node:
    node = make_node("FeatureReferenceExpression", "", tokens, begin, stop)
    node.relations.append(Relation("Membership", name))
    return node


def _build_parenthesised(_tokens: Tokens, _stop: int, _begin: int, inner: Node) -> Node:
    return inner


def _build_constructor(
    tokens: Tokens, stop: int, begin: int, name: Reference, arguments: list[Node]
) -> Node:
    node = make_node("ConstructorExpression", "", tokens, begin, stop)
    node.relations.append(Relation("Membership", name))
    result = node.add_member(make_node("Feature", "ReturnParameterMembership", tokens, begin, stop))
    add_members(result, _mark_arguments(arguments))
    return node


def _mark_arguments(arguments: Sequence[Node]) -> Sequence[Node]:
    for node in arguments:
        if node.membership != FEATURE:
            node.membership = ARGUMENT
    return arguments


def _build_named_argument(
    tokens: Tokens, stop: int, begin: int, name: Reference, value: Node
) -> Node:
    node = make_node("Feature", FEATURE, tokens, begin, stop)
    node.relations.append(Relation("Redefinition", name))
    value.membership, value.role = "FeatureValue", "="
    node.add_member(value)
    return node


def _build_sequence_of_one(_tokens: Tokens, _stop: int, _begin: int, only: Node) -> Node:
    return only


def _build_sequence(tokens: Tokens, _stop: int, _begin: int, first: Node, rest: list[Node]) -> Node:
    remaining = [first, *rest]
    result = remaining.pop()
    while remaining:
        element = remaining.pop()
        outer = Node("OperatorExpression", start=element.start, end=result.end)
        outer.attributes["operator"] = ","
        element.membership = result.membership = ARGUMENT
        outer.add_member(element)
        outer.add_member(result)
        result = outer
    return result


def _make_application(kind: str, tokens: Tokens, begin: int, stop: int, *operands: Node) -> Node:
    node = make_node(kind, "", tokens, begin, stop)
    for operand in operands:
        node.add_member(make_argument(operand))
    return node


def _build_bracketed(tokens: Tokens, stop: int, begin: int, primary: Node, inner: Node) -> Node:
    node = _make_application("OperatorExpression", tokens, begin, stop, primary, inner)
    node.attributes["operator"] = "["
    return node


def _build_indexed(tokens: Tokens, stop: int, begin: int, primary: Node, inner: Node) -> Node:
    return _make_application("IndexExpression", tokens, begin, stop, primary, inner)


def _build_chained(tokens: Tokens, stop: int, begin: int, primary: Node, name: Reference) -> Node:
    # `a.b.c` is one chain of two links after `a`, but `(a.b).c` are two chains.
    if primary.kind == "FeatureChainExpression" and _has_no_parentheses(tokens, primary, begin):
        reference = primary.relations[0].reference
        reference.chain += name.chain
        reference.end = primary.end = name.end
        return primary
    node = _make_application("FeatureChainExpression", tokens, begin, stop, primary)
    node.relations.append(Relation("Membership", name))
    return node


def _has_no_parentheses(tokens: Tokens, primary: Node, begin: int) -> bool:
    """Whether an operand is not in parentheses, so that a chain may continue it."""
    return primary.start == tokens.starts[begin]


def _build_collected(
    tokens: Tokens, stop: int, begin: int, primary: Node, body: list[Node]
) -> Node:
    return _make_application(
        "CollectExpression",
        tokens,
        begin,
        stop,
        primary,
        _make_body_argument(tokens, stop, primary, body),
    )


def _build_selected(tokens: Tokens, stop: int, begin: int, primary: Node, body: list[Node]) -> Node:
    return _make_application(
        "SelectExpression",
        tokens,
        begin,
        stop,
        primary,
        _make_body_argument(tokens, stop, primary, body),
    )


def _make_body_argument(
    tokens: Tokens, stop: int, operand: Node | Reference, body: list[Node]
) -> Node:
    # The brace has no token number here, because the body was reduced without it.
    start = tokens.text.find("{", operand.end)
    return _make_body_expression(body, start, tokens.ends[stop - 1])


def _make_body_expression(body: list[Node], start: int, end: int) -> Node:
    """Return an expression with a body between braces (KerML 8.2.5.8.3)."""
    node = Node("FeatureReferenceExpression", start=start, end=end)
    add_members(node.add_member(Node("Expression", membership=FEATURE, start=start, end=end)), body)
    return node


def _build_body_expression(tokens: Tokens, stop: int, begin: int, body: list[Node]) -> Node:
    return _make_body_expression(body, tokens.starts[begin], tokens.ends[stop - 1])


def _make_invocation(
    tokens: Tokens, begin: int, stop: int, name: Reference, arguments: Sequence[Node]
) -> Node:
    node = make_node("InvocationExpression", "", tokens, begin, stop)
    node.relations.append(Relation("Membership", name))
    return add_members(node, _mark_arguments(arguments))


def _build_operation(
    tokens: Tokens, stop: int, begin: int, primary: Node, name: Reference, arguments: list[Node]
) -> Node:
    return _make_invocation(tokens, begin, stop, name, [make_argument(primary), *arguments])


def _build_body_operation(
    tokens: Tokens, stop: int, begin: int, primary: Node, name: Reference, body: list[Node]
) -> Node:
    inner = _make_body_argument(tokens, stop, name, body)
    return _make_invocation(tokens, begin, stop, name, [make_argument(primary), inner])


def _build_function_operation(
    tokens: Tokens, stop: int, begin: int, primary: Node, name: Reference, function: Reference
) -> Node:
    outer = Node("FeatureReferenceExpression", start=function.start, end=function.end)
    inner = outer.add_member(
        Node("Expression", membership=FEATURE, start=function.start, end=function.end)
    )
    inner.relations.append(Relation("FeatureTyping", function))
    return _make_invocation(tokens, begin, stop, name, [make_argument(primary), outer])


def _build_metadata_access(_tokens: Tokens, stop: int, begin: int, primary: Node) -> Node:
    if primary.kind == "FeatureReferenceExpression" and primary.relations:
        primary.kind = "MetadataAccessExpression"
        primary.end = _tokens.ends[stop - 1]
        return primary
    return primary


def _build_invocation(
    tokens: Tokens, stop: int, begin: int, primary: Node, arguments: list[Node]
) -> Node:
    name = find_chain(primary)
    if name is None:
        return primary
    return _make_invocation(tokens, begin, stop, name, arguments)


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
    "true": _build_true,
    "false": _build_false,
    "infinity": _build_infinity,
    "null": _build_null,
    "feature_reference": _build_feature_reference,
    "parenthesised": _build_parenthesised,
    "constructor": _build_constructor,
    "named_argument": _build_named_argument,
    "sequence_of_one": _build_sequence_of_one,
    "sequence": _build_sequence,
    "bracketed": _build_bracketed,
    "indexed": _build_indexed,
    "chained": _build_chained,
    "collected": _build_collected,
    "selected": _build_selected,
    "body_expression": _build_body_expression,
    "operation": _build_operation,
    "body_operation": _build_body_operation,
    "function_operation": _build_function_operation,
    "metadata_access": _build_metadata_access,
    "invocation": _build_invocation,
}
