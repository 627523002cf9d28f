"""Operator precedence: flat lists of operands and operators become trees (KerML 8.2.5.8.1)."""

from sysmlc.language.text.builders.nodes import make_node
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation

PRECEDENCE_LEVELS = (
    ("??",),
    ("implies",),
    ("or", "|"),
    ("xor",),
    ("and", "&"),
    ("==", "!=", "===", "!=="),
    ("istype", "hastype", "@", "@@", "as", "meta"),
    ("<", ">", "<=", ">="),
    ("..",),
    ("+", "-"),
    ("*", "/", "%"),
    ("^", "**"),
)
"""Loosest first. Only ``if`` binds more loosely than all of them."""
PRECEDENCE = {
    operator: level for level, group in enumerate(PRECEDENCE_LEVELS) for operator in group
}
"""The precedence of each operator: the index of its row."""


ARGUMENT = "ParameterMembership"
Operand = Node | Reference
ExpressionPart = Operand | int
"""An operand, a type, or the token of an operator."""

_POWER = PRECEDENCE["^"]
_LAZY_OPERATORS = {"??", "or", "and", "implies"}
_CASTS = {"as", "meta"}
_METACLASS_OPERATORS = {"@@", "meta"}


def _group_operands(tokens: Tokens, parts: list[ExpressionPart]) -> Node:
    """Return the tree of alternating operands and operators, given as numbers of tokens.

    This is operator-precedence parsing with two stacks. A type completes its operation at once: the
    next operator takes the whole as its left operand.
    """
    operands = [part for part in parts[1:] if not isinstance(part, int)]
    operators = [tokens[part] for part in parts if isinstance(part, int)]
    output: list[Node] = [part for part in parts[:1] if isinstance(part, Node)]
    operator_stack: list[str] = []
    for operator, operand in zip(operators, operands, strict=True):
        # A looser operator completes the operations before it; `^` alone groups to the right.
        while operator_stack and _binds_first(PRECEDENCE[operator_stack[-1]], PRECEDENCE[operator]):
            _reduce_operation(output, operator_stack.pop())
        if isinstance(operand, Reference):
            output.append(_make_operation(operator, output.pop(), operand))
        else:
            operator_stack.append(operator)
            output.append(operand)
    while operator_stack:
        _reduce_operation(output, operator_stack.pop())
    return output[0]


def find_precedence(operator: str) -> int:
    """Return the precedence of a binary operator, higher for tighter binding; -1 for others."""
    return PRECEDENCE.get(operator, -1)


def _binds_first(left: int, right: int) -> bool:
    return left > right or (left == right and left != _POWER)


def _reduce_operation(operands: list[Node], operator: str) -> None:
    right, left = operands.pop(), operands.pop()
    operands.append(_make_operation(operator, left, right))


def _make_operation(operator: str, left: Node, right: Node | Reference) -> Node:
    """Return a binary operation; the right operand of a classification is the name of a type."""
    node = Node("OperatorExpression", start=left.start, end=right.end)
    node.attributes["operator"] = operator
    node.add_member(make_argument(left))
    if isinstance(right, Node):
        node.add_member(make_argument(right))
        if operator in _LAZY_OPERATORS:
            right.role = "expression"
    else:
        node.add_member(_make_type_argument(operator, right))
        if operator in _METACLASS_OPERATORS and left.kind == "FeatureReferenceExpression":
            left.kind = "MetadataAccessExpression"
    return node


def make_argument(node: Node) -> Node:
    """Make an expression an argument, and return it."""
    node.membership = ARGUMENT
    return node


def _make_type_argument(operator: str, name: Reference) -> Node:
    """Return a feature with the type ``name``: the result of a cast, else an argument."""
    membership = "ReturnParameterMembership" if operator in _CASTS else ARGUMENT
    feature = Node("Feature", membership=membership, start=name.start, end=name.end)
    feature.relations.append(Relation("FeatureTyping", name))
    return feature


def _build_grouped(tokens: Tokens, _stop: int, _begin: int, parts: list[ExpressionPart]) -> Node:
    return _group_operands(tokens, parts)


def _start_operands(
    _tokens: Tokens, _stop: int, _begin: int, *parts: ExpressionPart
) -> list[ExpressionPart]:
    return list(parts)


def _append_operand(
    _tokens: Tokens,
    _stop: int,
    _begin: int,
    parts: list[ExpressionPart],
    operator: int,
    operand: Operand,
) -> list[ExpressionPart]:
    parts += (operator, operand)
    return parts


def _build_conditional(
    tokens: Tokens, stop: int, begin: int, condition: Node, then: Node, otherwise: Node
) -> Node:
    node = make_node("OperatorExpression", "", tokens, begin, stop)
    node.attributes["operator"] = "if"
    for member in (condition, then, otherwise):
        node.add_member(make_argument(member))
    then.role = otherwise.role = "expression"
    return node


def _build_unary(tokens: Tokens, stop: int, begin: int, operator: int, operand: Node) -> Node:
    node = make_node("OperatorExpression", "", tokens, begin, stop)
    node.attributes["operator"] = tokens[operator]
    node.add_member(make_argument(operand))
    return node


def _build_unary_type(
    tokens: Tokens, stop: int, begin: int, operator: int, name: Reference
) -> Node:
    node = make_node("OperatorExpression", "", tokens, begin, stop)
    node.attributes["operator"] = tokens[operator]
    node.add_member(_make_type_argument(tokens[operator], name))
    return node


def _build_extent(tokens: Tokens, stop: int, begin: int, name: Reference) -> Node:
    node = make_node("OperatorExpression", "", tokens, begin, stop)
    node.attributes["operator"] = "all"
    node.add_member(_make_type_argument("all", name))
    return node


ACTIONS = {
    "grouped": _build_grouped,
    "first_infix": _start_operands,
    "more_infix": _append_operand,
    "conditional": _build_conditional,
    "unary": _build_unary,
    "unary_type": _build_unary_type,
    "extent": _build_extent,
}
