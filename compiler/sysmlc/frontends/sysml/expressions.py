"""Expressions of KerML in the one grammar of the compiler (grammars/expression.lark)."""

from functools import reduce

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.nodes import arguments
from sysmlc.language.tree import Node, Reference
from sysmlc.logic.expressions.expression import (
    Binary,
    Call,
    Conditional,
    Expression,
    Index,
    Literal,
    Member,
    Name,
    Unary,
    print_expression,
)

_BINARY = {
    "implies": "implies",
    "or": "or",
    "|": "or",
    "xor": "xor",
    "and": "and",
    "&": "and",
    "==": "==",
    "===": "==",
    "!=": "!=",
    "!==": "!=",
    **{op: op for op in ("<", "<=", ">", ">=", "+", "-", "*", "/", "%")},
}
_UNARY = {"not": "not", "-": "-", "+": "+"}


class UnsaidError(ValueError):
    """An expression that our grammar has no words for."""


def text(node: Node, source: str = "") -> str:
    """The expression in our grammar, else as ``source``, the text of the document, has it.

    A document of interchange has no text: its expression is put into the notation of KerML.
    """
    found = read(node)
    written = None if found is None else _printed(found)
    if written is not None:
        return written
    if not source:
        from sysmlc.language.notation import write_expression

        return write_expression(node)
    return nodes.quoted(node, source)


def _printed(expression: Expression) -> str | None:
    """The expression as text; None when it is nested deeper than one can be printed."""
    try:
        return print_expression(expression)
    except RecursionError:
        return None


def read(node: Node) -> Expression | None:
    """The expression as a value of ``logic.expression``; None when it is none of our grammar."""
    try:
        return _read(node)
    except (UnsaidError, RecursionError):
        return None


def _read(node: Node) -> Expression:
    reader = _READERS.get(node.kind)
    if reader is None:
        raise UnsaidError(node.kind)
    return reader(node)


def _literal(node: Node) -> Expression:
    value = node.attributes.get("value")
    if value is None:
        raise UnsaidError(node.kind)
    return Literal(value)


def _operator(node: Node) -> Expression:
    operator = str(node.attributes.get("operator", ""))
    args = arguments(node)
    if len(args) == 1 and operator in _UNARY:
        return Unary(_UNARY[operator], _read(args[0]))
    if len(args) == 2 and operator in _BINARY:
        return Binary(_BINARY[operator], _read(args[0]), _read(args[1]))
    if len(args) == 3 and operator == "if":
        return Conditional(_read(args[0]), _read(args[1]), _read(args[2]))
    if len(args) == 2 and operator in ("#", "index"):
        return Index(_read(args[0]), _read(args[1]))
    raise UnsaidError(operator)


def _index(node: Node) -> Expression:
    base, index = arguments(node)
    return Index(_read(base), _read(index))


def _feature(node: Node) -> Expression:
    found = nodes.reference(node, "Membership")
    if found is None:
        raise UnsaidError(node.kind)
    return named(found)


def named(found: Reference) -> Expression:
    """A reference to a feature, or to a chain of features, as an expression."""
    return _chain(_first(found), found.chain[1:])


def _chain(first: Expression, links: tuple[tuple[str, ...], ...]) -> Expression:
    return reduce(Member, (link[-1] for link in links), first) if links else first


def _first(found: Reference) -> Expression:
    """A feature of the context by its own name; literals and the rest by their qualified names.

    Inside an action its features are often qualified by its name (``Task::pallet``), which
    our grammar does not need.
    """
    names = found.chain[0]
    target = found.targets[0] if found.targets else None
    if target is not None and target.kind == "EnumerationUsage" and len(names) > 1:
        return Name(names[-2:])
    if target is not None and _is_feature(target) and len(names) > 1:
        return Name(names[-1:])
    return Name(tuple(one for one in names if one != "$") if "$" in names else names)


def _is_feature(node: Node) -> bool:
    """Whether a definition or a behaviour owns the feature, so that its name alone says it."""
    owner = node.owner
    return owner is not None and not owner.kind.endswith(("Package", "Namespace"))


def _member(node: Node) -> Expression:
    found = nodes.reference(node, "Membership")
    base = arguments(node)
    if found is None or not base:
        raise UnsaidError(node.kind)
    return _chain(_read(base[0]), found.chain)


def _call(node: Node) -> Expression:
    found = nodes.reference(node, "Membership", "FeatureTyping")
    if found is None:
        raise UnsaidError(node.kind)
    given = [_read(nodes.value_of(one) or one) for one in _ordered(node)]
    return Call(_chain(Name(found.chain[0]), found.chain[1:]), tuple(given))


def in_order(node: Node) -> list[Node]:
    """Arguments in the order of what they are given to, where that is known; else as written."""
    try:
        return _ordered(node)
    except UnsaidError:
        return arguments(node)


def _ordered(node: Node) -> list[Node]:
    """Arguments in the order of what they are given to; named ones may stand in any order.

    Raises UnsaidError where only some are named, or one before them is left out.
    """
    given = arguments(node)
    formal = [nodes.target(one, "Redefinition") for one in given if one.kind == "Feature"]
    if not any(nodes.reference(one, "Redefinition") for one in given):
        return given
    owner = formal[0].owner if formal and formal[0] is not None else None
    declared = [] if owner is None else _declared(owner, node.kind == "ConstructorExpression")
    numbers = [next((n for n, one in enumerate(declared) if one is to), -1) for to in formal]
    if len(numbers) != len(given) or sorted(numbers) != list(range(len(given))):
        raise UnsaidError(node.kind)
    return [given[numbers.index(number)] for number in range(len(given))]


def _declared(owner: Node, is_new: bool) -> list[Node]:
    """What the arguments of a call, or of a new instance of a type, are given to, in order."""
    found = [one for one in owner.members if one.membership.endswith("FeatureMembership")]
    found += [one for one in owner.members if one.membership == "ParameterMembership"]
    return [one for one in found if is_new or one.attributes.get("direction") in ("in", "inout")]


_READERS = {
    "LiteralBoolean": _literal,
    "LiteralString": _literal,
    "LiteralInteger": _literal,
    "LiteralRational": _literal,
    "OperatorExpression": _operator,
    "IndexExpression": _index,
    "FeatureReferenceExpression": _feature,
    "FeatureChainExpression": _member,
    "InvocationExpression": _call,
    "ConstructorExpression": _call,
}
