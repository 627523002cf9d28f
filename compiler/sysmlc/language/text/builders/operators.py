"""Operator precedence: flat lists of operands and operators become trees (KerML 8.2.5.8.1)."""

from sysmlc.language.text.builders.nodes import PARAMETER, make_node
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
Operand = Node | Reference
ExpressionPart = Operand | int
"""An operand, a type, or the token of an operator."""

_POWER = PRECEDENCE["^"]
_LAZY_OPERATORS = {"??", "or", "and", "implies"}
_CASTS = {"as", "meta"}
_METACLASS_OPERATORS = {"@@", "meta"}


def _build_grouped(tokens: Tokens, parts: list[ExpressionPart]) -> Node:
    """Build the tree of alternating operands and operators, given as numbers of tokens.

    This is operator-precedence parsing with two stacks. A type completes its operation at once: the
    next operator takes the whole as its left operand.
    """
    operands = [part for part in parts[1:] if not isinstance(part, int)]
    operators = [tokens[part] for part in parts if isinstance(part, int)]
    output: list[Node] = [part for part in parts[:1] if isinstance(part, Node)]
    operator_stack: list[str] = []
    for operator, operand in zip(operators, operands, strict=True):
        level = PRECEDENCE[operator]
        # A looser operator completes the operations before it; `^` alone groups to the right.
        least_level = level + 1 if level == _POWER else level
        while operator_stack and PRECEDENCE[operator_stack[-1]] >= least_level:
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
    node.membership = PARAMETER
    return node


def _make_type_argument(operator: str, name: Reference) -> Node:
    """Return a feature with the type ``name``: the result of a cast, else an argument."""
    membership = "ReturnParameterMembership" if operator in _CASTS else PARAMETER
    feature = Node("Feature", membership=membership, start=name.start, end=name.end)
    feature.relations.append(Relation("FeatureTyping", name))
    return feature


def _start_operands(_tokens: Tokens, *parts: ExpressionPart) -> list[ExpressionPart]:
    return list(parts)


def _append_operand(
    _tokens: Tokens, parts: list[ExpressionPart], operator: int, operand: Operand
) -> list[ExpressionPart]:
    parts += (operator, operand)
    return parts


def _make_operator(tokens: Tokens, operator: str, *operands: Node) -> Node:
    node = make_node("OperatorExpression", "", tokens)
    node.attributes["operator"] = operator
    for operand in operands:
        node.add_member(operand)
    return node


def _build_conditional(tokens: Tokens, condition: Node, then: Node, otherwise: Node) -> Node:
    then.role = otherwise.role = "expression"
    return _make_operator(tokens, "if", *map(make_argument, (condition, then, otherwise)))


def _build_unary(tokens: Tokens, operator: int, operand: Operand) -> Node:
    word = tokens[operator]
    if isinstance(operand, Reference):
        return _make_operator(tokens, word, _make_type_argument(word, operand))
    return _make_operator(tokens, word, make_argument(operand))


def _build_extent(tokens: Tokens, name: Reference) -> Node:
    return _make_operator(tokens, "all", _make_type_argument("all", name))


ACTIONS = {
    "grouped": _build_grouped,
    "first_infix": _start_operands,
    "more_infix": _append_operand,
    "conditional": _build_conditional,
    "unary": _build_unary,
    "extent": _build_extent,
}
