"""Operands and operators are grouped by precedence (KerML 8.2.5.8.1, Table 6)."""

from sysmlc.language.operators import LEVEL
from sysmlc.language.text.build.owning import made
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference, Relation

ARGUMENT = "ParameterMembership"
Operand = Node | Reference
Part = Operand | int
"""Of an expression with operators: an operand, a type, or the token of an operator."""

_RIGHT = LEVEL["^"]
_CONDITIONAL = {"??", "or", "and", "implies"}
_CASTS = {"as", "meta"}
_METADATA = {"@@", "meta"}


def grouped(tokens: Tokens, parts: list[Part]) -> Node:
    """The expression of operands and operators in turn, operators as numbers of tokens.

    A type ends what its operator makes: what follows takes the whole as its left side.
    """
    operands = [part for part in parts[1:] if not isinstance(part, int)]
    operators = [tokens[part] for part in parts if isinstance(part, int)]
    done: list[Node] = [part for part in parts[:1] if isinstance(part, Node)]
    pending: list[str] = []
    for operator, operand in zip(operators, operands, strict=True):
        while pending and _before(LEVEL[pending[-1]], LEVEL[operator]):
            _reduce(done, pending.pop())
        if isinstance(operand, Reference):
            done.append(operation(operator, done.pop(), operand))
        else:
            pending.append(operator)
            done.append(operand)
    while pending:
        _reduce(done, pending.pop())
    return done[0]


def level(operator: str) -> int:
    """How tightly a binary operator binds, those that bind least first; -1 for others."""
    return LEVEL.get(operator, -1)


def _before(left: int, right: int) -> bool:
    return left > right or (left == right and left != _RIGHT)


def _reduce(operands: list[Node], operator: str) -> None:
    right, left = operands.pop(), operands.pop()
    operands.append(operation(operator, left, right))


def operation(operator: str, left: Node, right: Node | Reference) -> Node:
    """A binary operation; the right side of a classification is the name of a type."""
    node = Node("OperatorExpression", start=left.start, end=right.end)
    node.facts["operator"] = operator
    node.own(argument(left))
    if isinstance(right, Node):
        node.own(argument(right))
        if operator in _CONDITIONAL:
            right.role = "expression"
    else:
        node.own(type_reference(operator, right))
        if operator in _METADATA and left.kind == "FeatureReferenceExpression":
            left.kind = "MetadataAccessExpression"
    return node


def argument(node: Node) -> Node:
    """Make an expression an argument."""
    node.membership = ARGUMENT
    return node


def type_reference(operator: str, name: Reference) -> Node:
    """The type that an operator takes as argument, or gives as result."""
    membership = "ReturnParameterMembership" if operator in _CASTS else ARGUMENT
    feature = Node("Feature", membership=membership, start=name.start, end=name.end)
    feature.relations.append(Relation("FeatureTyping", name))
    return feature


def _grouped(tokens: Tokens, _at: int, _begin: int, parts: list[Part]) -> Node:
    return grouped(tokens, parts)


def _first_infix(_tokens: Tokens, _at: int, _begin: int, *parts: Part) -> list[Part]:
    return list(parts)


def _more_infix(
    _tokens: Tokens, _at: int, _begin: int, parts: list[Part], operator: int, operand: Operand
) -> list[Part]:
    parts += (operator, operand)
    return parts


def _conditional(
    tokens: Tokens, at: int, begin: int, condition: Node, then: Node, other: Node
) -> Node:
    node = made("OperatorExpression", "", tokens, begin, at)
    node.facts["operator"] = "if"
    for member in (condition, then, other):
        node.own(argument(member))
    then.role = other.role = "expression"
    return node


def _unary(tokens: Tokens, at: int, begin: int, operator: int, operand: Node) -> Node:
    node = made("OperatorExpression", "", tokens, begin, at)
    node.facts["operator"] = tokens[operator]
    node.own(argument(operand))
    return node


def _unary_type(tokens: Tokens, at: int, begin: int, operator: int, name: Reference) -> Node:
    node = made("OperatorExpression", "", tokens, begin, at)
    node.facts["operator"] = tokens[operator]
    node.own(type_reference(tokens[operator], name))
    return node


def _extent(tokens: Tokens, at: int, begin: int, name: Reference) -> Node:
    node = made("OperatorExpression", "", tokens, begin, at)
    node.facts["operator"] = "all"
    node.own(type_reference("all", name))
    return node


ACTIONS = {
    "grouped": _grouped,
    "first_infix": _first_infix,
    "more_infix": _more_infix,
    "conditional": _conditional,
    "unary": _unary,
    "unary_type": _unary_type,
    "extent": _extent,
}
