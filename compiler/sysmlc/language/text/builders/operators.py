"""Binary operators by how tightly they bind (KerML 8.2.5.8.1, Table 6)."""

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
"""Those that bind less first; only ``if`` binds less than all of them."""
PRECEDENCE = {
    operator: level for level, group in enumerate(PRECEDENCE_LEVELS) for operator in group
}
"""The number of each operator's row."""


ARGUMENT = "ParameterMembership"
Operand = Node | Reference
ExpressionPart = Operand | int
"""Of an expression with operators: an operand, a type, or the token of an operator."""

_POWER = PRECEDENCE["^"]
_LAZY_OPERATORS = {"??", "or", "and", "implies"}
_CASTS = {"as", "meta"}
_METACLASS_OPERATORS = {"@@", "meta"}


def group_operands(tokens: Tokens, parts: list[ExpressionPart]) -> Node:
    """The expression of operands and operators in turn, operators as numbers of tokens.

    A type ends what its operator makes: what follows takes the whole as its left side.
    """
    operands = [part for part in parts[1:] if not isinstance(part, int)]
    operators = [tokens[part] for part in parts if isinstance(part, int)]
    done: list[Node] = [part for part in parts[:1] if isinstance(part, Node)]
    pending: list[str] = []
    for operator, operand in zip(operators, operands, strict=True):
        while pending and _binds_first(PRECEDENCE[pending[-1]], PRECEDENCE[operator]):
            _reduce_operation(done, pending.pop())
        if isinstance(operand, Reference):
            done.append(make_operation(operator, done.pop(), operand))
        else:
            pending.append(operator)
            done.append(operand)
    while pending:
        _reduce_operation(done, pending.pop())
    return done[0]


def find_precedence(operator: str) -> int:
    """How tightly a binary operator binds, those that bind least first; -1 for others."""
    return PRECEDENCE.get(operator, -1)


def _binds_first(left: int, right: int) -> bool:
    return left > right or (left == right and left != _POWER)


def _reduce_operation(operands: list[Node], operator: str) -> None:
    right, left = operands.pop(), operands.pop()
    operands.append(make_operation(operator, left, right))


def make_operation(operator: str, left: Node, right: Node | Reference) -> Node:
    """A binary operation; the right side of a classification is the name of a type."""
    node = Node("OperatorExpression", start=left.start, end=right.end)
    node.attributes["operator"] = operator
    node.add_member(make_argument(left))
    if isinstance(right, Node):
        node.add_member(make_argument(right))
        if operator in _LAZY_OPERATORS:
            right.role = "expression"
    else:
        node.add_member(make_type_argument(operator, right))
        if operator in _METACLASS_OPERATORS and left.kind == "FeatureReferenceExpression":
            left.kind = "MetadataAccessExpression"
    return node


def make_argument(node: Node) -> Node:
    """Make an expression an argument."""
    node.membership = ARGUMENT
    return node


def make_type_argument(operator: str, name: Reference) -> Node:
    """The type that an operator takes as argument, or gives as result."""
    membership = "ReturnParameterMembership" if operator in _CASTS else ARGUMENT
    feature = Node("Feature", membership=membership, start=name.start, end=name.end)
    feature.relations.append(Relation("FeatureTyping", name))
    return feature


def _build_grouped(tokens: Tokens, _stop: int, _begin: int, parts: list[ExpressionPart]) -> Node:
    return group_operands(tokens, parts)


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
    tokens: Tokens, stop: int, begin: int, condition: Node, then: Node, other: Node
) -> Node:
    node = make_node("OperatorExpression", "", tokens, begin, stop)
    node.attributes["operator"] = "if"
    for member in (condition, then, other):
        node.add_member(make_argument(member))
    then.role = other.role = "expression"
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
    node.add_member(make_type_argument(tokens[operator], name))
    return node


def _build_extent(tokens: Tokens, stop: int, begin: int, name: Reference) -> Node:
    node = make_node("OperatorExpression", "", tokens, begin, stop)
    node.attributes["operator"] = "all"
    node.add_member(make_type_argument("all", name))
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
