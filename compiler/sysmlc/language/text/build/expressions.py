"""Primary expressions: literals, names, chains, invocations, sequences (KerML 8.2.5.8)."""

import math
from collections.abc import Sequence

from sysmlc.language.text.build.operators import ARGUMENT, argument
from sysmlc.language.text.build.owning import FEATURE, made, own
from sysmlc.language.text.scan import DIGITS, Fault, Tokens, unquoted
from sysmlc.language.tree import Node, Reference, Relation


def _literal(
    kind: str, value: str | bool | int | float, tokens: Tokens, begin: int, at: int
) -> Node:
    node = made(kind, "", tokens, begin, at)
    node.facts["value"] = value
    return node


def _number(tokens: Tokens, at: int, begin: int, token: int) -> Node:
    written = tokens[token]
    if written.isdigit() and len(written) <= DIGITS:
        return _literal("LiteralInteger", int(written), tokens, begin, at)
    value = float(written)
    if math.isinf(value):
        tokens.faults.append(Fault("number", tokens.starts[token], written))
        value = 0.0
    return _literal("LiteralRational", value, tokens, begin, at)


def _string(tokens: Tokens, at: int, begin: int, token: int) -> Node:
    return _literal("LiteralString", unquoted(tokens[token]), tokens, begin, at)


def _true(tokens: Tokens, at: int, begin: int, _none: None) -> Node:
    return _literal("LiteralBoolean", True, tokens, begin, at)


def _false(tokens: Tokens, at: int, begin: int, _none: None) -> Node:
    return _literal("LiteralBoolean", False, tokens, begin, at)


def _infinity(tokens: Tokens, at: int, begin: int, _none: None) -> Node:
    return made("LiteralInfinity", "", tokens, begin, at)


def _null(tokens: Tokens, at: int, begin: int, _none: None) -> Node:
    return made("NullExpression", "", tokens, begin, at)


def _feature_reference(tokens: Tokens, at: int, begin: int, name: Reference) -> Node:
    node = made("FeatureReferenceExpression", "", tokens, begin, at)
    node.relations.append(Relation("Membership", name))
    return node


def _parenthesised(_tokens: Tokens, _at: int, _begin: int, inner: Node) -> Node:
    return inner


def _constructor(
    tokens: Tokens, at: int, begin: int, name: Reference, arguments: list[Node]
) -> Node:
    node = made("ConstructorExpression", "", tokens, begin, at)
    node.relations.append(Relation("Membership", name))
    result = node.own(made("Feature", "ReturnParameterMembership", tokens, begin, at))
    own(result, _arguments(arguments))
    return node


def _arguments(given: Sequence[Node]) -> Sequence[Node]:
    for node in given:
        if node.membership != FEATURE:
            node.membership = ARGUMENT
    return given


def _named_argument(tokens: Tokens, at: int, begin: int, name: Reference, value: Node) -> Node:
    node = made("Feature", FEATURE, tokens, begin, at)
    node.relations.append(Relation("Redefinition", name))
    value.membership, value.role = "FeatureValue", "="
    node.own(value)
    return node


def _sequence_of_one(_tokens: Tokens, _at: int, _begin: int, only: Node) -> Node:
    return only


def _sequence(tokens: Tokens, _at: int, _begin: int, first: Node, rest: list[Node]) -> Node:
    nodes = [first, *rest]
    result = nodes.pop()
    while nodes:
        left = nodes.pop()
        outer = Node("OperatorExpression", start=left.start, end=result.end)
        outer.facts["operator"] = ","
        left.membership = result.membership = ARGUMENT
        outer.own(left)
        outer.own(result)
        result = outer
    return result


def _applied(kind: str, tokens: Tokens, begin: int, at: int, *operands: Node) -> Node:
    node = made(kind, "", tokens, begin, at)
    for operand in operands:
        node.own(argument(operand))
    return node


def _bracketed(tokens: Tokens, at: int, begin: int, primary: Node, inner: Node) -> Node:
    node = _applied("OperatorExpression", tokens, begin, at, primary, inner)
    node.facts["operator"] = "["
    return node


def _indexed(tokens: Tokens, at: int, begin: int, primary: Node, inner: Node) -> Node:
    return _applied("IndexExpression", tokens, begin, at, primary, inner)


def _chained(tokens: Tokens, at: int, begin: int, primary: Node, name: Reference) -> Node:
    if primary.kind == "FeatureChainExpression" and _is_open(tokens, primary, begin):
        reference = primary.relations[0].reference
        reference.chain += name.chain
        reference.end = primary.end = name.end
        return primary
    node = _applied("FeatureChainExpression", tokens, begin, at, primary)
    node.relations.append(Relation("Membership", name))
    return node


def _is_open(tokens: Tokens, primary: Node, begin: int) -> bool:
    """Whether no parentheses stand around it."""
    return primary.start == tokens.starts[begin]


def _collected(tokens: Tokens, at: int, begin: int, primary: Node, body: list[Node]) -> Node:
    return _applied(
        "CollectExpression", tokens, begin, at, primary, _body(tokens, at, primary, body)
    )


def _selected(tokens: Tokens, at: int, begin: int, primary: Node, body: list[Node]) -> Node:
    return _applied(
        "SelectExpression", tokens, begin, at, primary, _body(tokens, at, primary, body)
    )


def _body(tokens: Tokens, at: int, before: Node | Reference, body: list[Node]) -> Node:
    start = tokens.text.find("{", before.end)
    return body_expression(body, start, tokens.ends[at - 1])


def body_expression(body: list[Node], start: int, end: int) -> Node:
    """An expression of a body between braces (KerML 8.2.5.8.3)."""
    node = Node("FeatureReferenceExpression", start=start, end=end)
    own(node.own(Node("Expression", membership=FEATURE, start=start, end=end)), body)
    return node


def _body_expression(tokens: Tokens, at: int, begin: int, body: list[Node]) -> Node:
    return body_expression(body, tokens.starts[begin], tokens.ends[at - 1])


def _invoked(tokens: Tokens, begin: int, at: int, name: Reference, given: Sequence[Node]) -> Node:
    node = made("InvocationExpression", "", tokens, begin, at)
    node.relations.append(Relation("Membership", name))
    return own(node, _arguments(given))


def _operation(
    tokens: Tokens, at: int, begin: int, primary: Node, name: Reference, arguments: list[Node]
) -> Node:
    return _invoked(tokens, begin, at, name, [argument(primary), *arguments])


def _body_operation(
    tokens: Tokens, at: int, begin: int, primary: Node, name: Reference, body: list[Node]
) -> Node:
    inner = _body(tokens, at, name, body)
    return _invoked(tokens, begin, at, name, [argument(primary), inner])


def _function_operation(
    tokens: Tokens, at: int, begin: int, primary: Node, name: Reference, function: Reference
) -> Node:
    outer = Node("FeatureReferenceExpression", start=function.start, end=function.end)
    inner = outer.own(
        Node("Expression", membership=FEATURE, start=function.start, end=function.end)
    )
    inner.relations.append(Relation("FeatureTyping", function))
    return _invoked(tokens, begin, at, name, [argument(primary), outer])


def _metadata_access(_tokens: Tokens, at: int, begin: int, primary: Node) -> Node:
    if primary.kind == "FeatureReferenceExpression" and primary.relations:
        primary.kind = "MetadataAccessExpression"
        primary.end = _tokens.ends[at - 1]
        return primary
    return primary


def _invocation(tokens: Tokens, at: int, begin: int, primary: Node, arguments: list[Node]) -> Node:
    name = chain_of(primary)
    if name is None:
        return primary
    return _invoked(tokens, begin, at, name, arguments)


def chain_of(node: Node) -> Reference | None:
    """The name or feature chain that an expression is, if it is nothing more."""
    if node.kind == "FeatureReferenceExpression" and node.relations:
        return node.relations[0].reference
    if node.kind != "FeatureChainExpression":
        return None
    before = chain_of(node.members[0])
    if before is None:
        return None
    last = node.relations[0].reference
    return Reference(before.chain + last.chain, before.start, last.end)


ACTIONS = {
    "number": _number,
    "string": _string,
    "true": _true,
    "false": _false,
    "infinity": _infinity,
    "null": _null,
    "feature_reference": _feature_reference,
    "parenthesised": _parenthesised,
    "constructor": _constructor,
    "named_argument": _named_argument,
    "sequence_of_one": _sequence_of_one,
    "sequence": _sequence,
    "bracketed": _bracketed,
    "indexed": _indexed,
    "chained": _chained,
    "collected": _collected,
    "selected": _selected,
    "body_expression": _body_expression,
    "operation": _operation,
    "body_operation": _body_operation,
    "function_operation": _function_operation,
    "metadata_access": _metadata_access,
    "invocation": _invocation,
}
