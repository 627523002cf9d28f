"""Expressions as the textual notation says them, from trees that have no text (KerML 8.2.5.8)."""

from collections.abc import Callable

from sysmlc.language.text.builders.operators import PRECEDENCE, PRECEDENCE_LEVELS
from sysmlc.language.tree import Node, Reference

_CONDITIONAL = -1
"""How tightly ``if`` binds: less than all binary operators."""
_UNARY = len(PRECEDENCE_LEVELS)
_PRIMARY = _UNARY + 1
_TYPED = {"istype", "hastype", "@", "@@", "as", "meta"}
_ESCAPES = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"})


def expression(node: Node) -> str:
    """The notation of an expression; empty for what has none without its declarations."""
    try:
        return _written(node)[0]
    except (_UnsaidError, RecursionError):
        return ""


class _UnsaidError(ValueError):
    """An expression that contains declarations, or that lacks a part."""


def _written(node: Node) -> tuple[str, int]:
    """The notation, and how firmly its parts are bound."""
    writer = _WRITERS.get(node.kind)
    if writer is None:
        raise _UnsaidError(node.kind)
    return writer(node)


def _within(node: Node, level: int) -> str:
    """The notation of an operand, in parentheses when it is bound less firmly than ``level``."""
    text, own = _written(node)
    return text if own >= level else f"({text})"


def _arguments(node: Node) -> list[Node]:
    return [one for one in node.members if one.membership == "ParameterMembership"]


def _name(node: Node) -> str:
    """What an expression refers to."""
    found = next((one for one in node.relations if one.kind == "Membership"), None)
    if found is None:
        raise _UnsaidError(node.kind)
    return _reference(found.reference)


def _reference(reference: Reference) -> str:
    from sysmlc.language.interchange.element_ids import escaped

    links = ("::".join(n if n == "$" else escaped(n) for n in names) for names in reference.chain)
    return ".".join(links)


def _type(node: Node) -> str:
    """The type that an operator like ``as`` names."""
    typed = (one for member in node.members for one in member.relations)
    found = next((one for one in typed if one.kind == "FeatureTyping"), None)
    if found is None:
        raise _UnsaidError(node.kind)
    return _reference(found.reference)


def _operator(node: Node) -> tuple[str, int]:
    operator, args = str(node.attributes.get("operator", "")), _arguments(node)
    if operator in _TYPED:
        left = [one for one in args if one.kind != "Feature"]
        before = f"{_within(left[0], PRECEDENCE[operator])} " if left else ""
        return f"{before}{operator} {_type(node)}", PRECEDENCE[operator]
    if operator == "all":
        return f"all {_type(node)}", _UNARY
    if operator == "if" and len(args) == 3:
        test, then, other = (_within(one, _CONDITIONAL + 1) for one in args)
        return f"if {test} ? {then} else {other}", _CONDITIONAL
    if len(args) == 1:
        space = " " if operator.isalpha() else ""
        return f"{operator}{space}{_within(args[0], _UNARY)}", _UNARY
    if len(args) != 2:
        raise _UnsaidError(operator)
    return _binary(operator, args[0], args[1])


def _binary(operator: str, left: Node, right: Node) -> tuple[str, int]:
    if operator == ",":
        rest = _written(right)[0]
        is_list = right.attributes.get("operator") == ","
        return f"({_within(left, _CONDITIONAL)}, {rest[1:-1] if is_list else rest})", _PRIMARY
    if operator == "[":
        return f"{_within(left, _PRIMARY)} [{_bare(right)}]", _PRIMARY
    level = PRECEDENCE.get(operator)
    if level is None:
        raise _UnsaidError(operator)
    first, second = (level + 1, level) if operator in ("^", "**") else (level, level + 1)
    sign = operator if operator in ("^", "**", "..") else f" {operator} "
    return f"{_within(left, first)}{sign}{_within(right, second)}", level


def _bare(node: Node) -> str:
    """A sequence without its parentheses, where others stand around it."""
    text, _ = _written(node)
    return text[1:-1] if node.attributes.get("operator") == "," else text


def _index(node: Node) -> tuple[str, int]:
    base, index = _arguments(node)
    return f"{_within(base, _PRIMARY)}#({_bare(index)})", _PRIMARY


def _chain(node: Node) -> tuple[str, int]:
    base = _arguments(node)
    if not base:
        raise _UnsaidError(node.kind)
    return f"{_within(base[0], _PRIMARY)}.{_name(node)}", _PRIMARY


def _call(node: Node) -> tuple[str, int]:
    given = [_given(one) for one in node.members if one.membership != "ReturnParameterMembership"]
    return f"{_name(node)}({', '.join(given)})", _PRIMARY


def _given(argument: Node) -> str:
    """An argument, by its position or by the name of its parameter."""
    if argument.kind != "Feature":
        return _within(argument, _CONDITIONAL)
    named = next((one for one in argument.relations if one.kind == "Redefinition"), None)
    if named is None or len(argument.members) != 1:
        raise _UnsaidError(argument.kind)
    return f"{_reference(named.reference)} = {_within(argument.members[0], _CONDITIONAL)}"


def _construct(node: Node) -> tuple[str, int]:
    results = [one for one in node.members if one.membership == "ReturnParameterMembership"]
    given = [_given(one) for result in results for one in result.members]
    return f"new {_name(node)}({', '.join(given)})", _PRIMARY


def _literal(node: Node) -> tuple[str, int]:
    value = node.attributes.get("value")
    if isinstance(value, bool):
        return ("true" if value else "false"), _PRIMARY
    if isinstance(value, str):
        return f'"{value.translate(_ESCAPES)}"', _PRIMARY
    if value is None:
        raise _UnsaidError(node.kind)
    return str(value), _PRIMARY


_WRITERS: dict[str, Callable[[Node], tuple[str, int]]] = {
    "OperatorExpression": _operator,
    "IndexExpression": _index,
    "FeatureChainExpression": _chain,
    "FeatureReferenceExpression": lambda node: (_name(node), _PRIMARY),
    "MetadataAccessExpression": lambda node: (f"{_name(node)}.metadata", _PRIMARY),
    "InvocationExpression": _call,
    "ConstructorExpression": _construct,
    "LiteralBoolean": _literal,
    "LiteralInteger": _literal,
    "LiteralRational": _literal,
    "LiteralString": _literal,
    "LiteralInfinity": lambda _: ("*", _PRIMARY),
    "NullExpression": lambda _: ("null", _PRIMARY),
}
