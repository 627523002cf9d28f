"""The textual notation of expressions, from trees that may have no text (KerML 8.2.5.8)."""

from collections.abc import Callable

from sysmlc.language.text.builders.operators import PRECEDENCE, PRECEDENCE_LEVELS
from sysmlc.language.text.lexer import quote_name
from sysmlc.language.tree import Node, Reference, list_arguments

_CONDITIONAL = -1
"""The level of ``if``, which binds less than all binary operators."""
_UNARY = len(PRECEDENCE_LEVELS)
_PRIMARY = _UNARY + 1
_TYPE_OPERATORS = {"istype", "hastype", "@", "@@", "as", "meta"}
_ESCAPES = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"})


def write_expression(node: Node) -> str:
    """Return the notation of an expression; empty if it needs declarations in a body."""
    try:
        return _write(node)[0]
    except (_NoNotationError, RecursionError):
        return ""


class _NoNotationError(ValueError):
    """The expression contains declarations, or lacks a part."""


def _write(node: Node) -> tuple[str, int]:
    """Return the notation of an expression and its binding level."""
    writer = _WRITERS.get(node.kind)
    if writer is None:
        raise _NoNotationError(node.kind)
    return writer(node)


def _write_operand(node: Node, level: int) -> str:
    """Return the notation of an operand, in parentheses if it binds less than ``level``."""
    text, own_level = _write(node)
    return text if own_level >= level else f"({text})"


def _write_name(node: Node) -> str:
    """Return the name of the referent of an expression."""
    relation = node.find_relation("Membership")
    if relation is None:
        raise _NoNotationError(node.kind)
    return _write_reference(relation.reference)


def _write_reference(reference: Reference) -> str:
    links = (
        "::".join(name if name == "$" else quote_name(name) for name in names)
        for names in reference.chain
    )
    return ".".join(links)


def _write_type(node: Node) -> str:
    """Return the type that an operator such as ``as`` names."""
    for member in node.members:
        if typing := member.find_relation("FeatureTyping"):
            return _write_reference(typing.reference)
    raise _NoNotationError(node.kind)


def _write_operator(node: Node) -> tuple[str, int]:
    operator, operands = str(node.attributes.get("operator", "")), list_arguments(node)
    if operator in _TYPE_OPERATORS:
        left_operands = [operand for operand in operands if operand.kind != "Feature"]
        left = f"{_write_operand(left_operands[0], PRECEDENCE[operator])} " if left_operands else ""
        return f"{left}{operator} {_write_type(node)}", PRECEDENCE[operator]
    if operator == "all":
        return f"all {_write_type(node)}", _UNARY
    if operator == "if" and len(operands) == 3:
        test, then, otherwise = (_write_operand(operand, _CONDITIONAL + 1) for operand in operands)
        return f"if {test} ? {then} else {otherwise}", _CONDITIONAL
    if len(operands) == 1:
        space = " " if operator.isalpha() else ""
        return f"{operator}{space}{_write_operand(operands[0], _UNARY)}", _UNARY
    if len(operands) != 2:
        raise _NoNotationError(operator)
    return _write_binary(operator, operands[0], operands[1])


def _write_binary(operator: str, left: Node, right: Node) -> tuple[str, int]:
    if operator == ",":
        rest = _write(right)[0]
        # A sequence a, b, c is nested to the right; only the outer one has parentheses.
        is_list = right.attributes.get("operator") == ","
        return (
            f"({_write_operand(left, _CONDITIONAL)}, {rest[1:-1] if is_list else rest})",
            _PRIMARY,
        )
    if operator == "[":
        return f"{_write_operand(left, _PRIMARY)} [{_write_without_parentheses(right)}]", _PRIMARY
    level = PRECEDENCE.get(operator)
    if level is None:
        raise _NoNotationError(operator)
    # Powers group to the right: a^b^c is a^(b^c).
    first, second = (level + 1, level) if operator in ("^", "**") else (level, level + 1)
    sign = operator if operator in ("^", "**", "..") else f" {operator} "
    return f"{_write_operand(left, first)}{sign}{_write_operand(right, second)}", level


def _write_without_parentheses(node: Node) -> str:
    """Return a sequence without its parentheses, for use in other brackets."""
    text, _ = _write(node)
    return text[1:-1] if node.attributes.get("operator") == "," else text


def _write_index(node: Node) -> tuple[str, int]:
    base, index = list_arguments(node)
    return f"{_write_operand(base, _PRIMARY)}#({_write_without_parentheses(index)})", _PRIMARY


def _write_chain(node: Node) -> tuple[str, int]:
    base = list_arguments(node)
    if not base:
        raise _NoNotationError(node.kind)
    return f"{_write_operand(base[0], _PRIMARY)}.{_write_name(node)}", _PRIMARY


def _write_call(node: Node) -> tuple[str, int]:
    arguments = [
        _write_argument(argument)
        for argument in node.members
        if argument.membership != "ReturnParameterMembership"
    ]
    return f"{_write_name(node)}({', '.join(arguments)})", _PRIMARY


def _write_argument(argument: Node) -> str:
    """Return an argument, by position or with the name of its parameter."""
    if argument.kind != "Feature":
        return _write_operand(argument, _CONDITIONAL)
    redefinition = argument.find_relation("Redefinition")
    if redefinition is None or len(argument.members) != 1:
        raise _NoNotationError(argument.kind)
    value = _write_operand(argument.members[0], _CONDITIONAL)
    return f"{_write_reference(redefinition.reference)} = {value}"


def _write_constructor(node: Node) -> tuple[str, int]:
    result = node.find_member("ReturnParameterMembership")
    arguments = map(_write_argument, result.members if result else ())
    return f"new {_write_name(node)}({', '.join(arguments)})", _PRIMARY


def _write_literal(node: Node) -> tuple[str, int]:
    value = node.attributes.get("value")
    if isinstance(value, bool):
        return ("true" if value else "false"), _PRIMARY
    if isinstance(value, str):
        return f'"{value.translate(_ESCAPES)}"', _PRIMARY
    if value is None:
        raise _NoNotationError(node.kind)
    return str(value), _PRIMARY


_WRITERS: dict[str, Callable[[Node], tuple[str, int]]] = {
    "OperatorExpression": _write_operator,
    "IndexExpression": _write_index,
    "FeatureChainExpression": _write_chain,
    "FeatureReferenceExpression": lambda node: (_write_name(node), _PRIMARY),
    "MetadataAccessExpression": lambda node: (f"{_write_name(node)}.metadata", _PRIMARY),
    "InvocationExpression": _write_call,
    "ConstructorExpression": _write_constructor,
    "LiteralBoolean": _write_literal,
    "LiteralInteger": _write_literal,
    "LiteralRational": _write_literal,
    "LiteralString": _write_literal,
    "LiteralInfinity": lambda _: ("*", _PRIMARY),
    "NullExpression": lambda _: ("null", _PRIMARY),
}
