"""Where names after the dot of an expression are looked up: the feature or type of its result."""

from collections.abc import Callable

from sysmlc.language.names.queries import GeneralizationQueries
from sysmlc.language.names.symbols import FEATURES
from sysmlc.language.tree import Node

_FIRST_OPERATORS = frozenset({",", "??", "[", "#"})
_CASTS = frozenset({"as", "meta"})


def result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """The feature or type whose members follow a dot after ``expression``; None if unknown."""
    found = _RESULTS.get(expression.kind)
    return found(expression, lookup) if found is not None else None


def named(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """The element that an expression names: a referent, a target, a function or type."""
    for relation in expression.relations:
        if relation.kind == "Membership":
            return lookup.target(expression, relation)
    return None


def _referent(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    body = next((m for m in expression.members if m.kind == "Expression"), None)
    if body is None:
        return named(expression, lookup)
    last = next((m for m in body.members if m.membership == "ResultExpressionMembership"), None)
    return result(last, lookup) if last else None


def _operand(expression: Node, index: int, lookup: GeneralizationQueries) -> Node | None:
    operands = [m for m in expression.members if m.membership == "ParameterMembership"]
    return result(operands[index], lookup) if index < len(operands) else None


def _operator(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    operator = expression.attributes.get("operator")
    if operator in _CASTS:
        return _cast(expression, lookup)
    if operator == "if":
        return _operand(expression, 1, lookup)
    return _operand(expression, 0, lookup) if operator in _FIRST_OPERATORS else None


def _cast(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    for member in reversed(expression.members):
        for relation in member.relations:
            if relation.kind == "FeatureTyping":
                return lookup.target(member, relation)
    return None


def _invoked(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """The result parameter of a function or calculation, else the type that is instantiated."""
    invoked = named(expression, lookup)
    if invoked is None or expression.kind == "ConstructorExpression":
        return invoked
    return returned(invoked, lookup, set()) or (invoked if invoked.kind not in FEATURES else None)


def of_value(feature: Node, lookup: GeneralizationQueries) -> Node | None:
    """What a feature that specialises nothing has its members from: the result of its value.

    KerML 8.4.4.10.2, checkFeatureValuationSpecialization; a loop variable has those of the
    sequence, what is given to a constructor those of the type.
    """
    membership = feature.membership
    owner = feature.owner
    if owner is None:
        return None
    if membership == "ReturnParameterMembership" and owner.kind == "ConstructorExpression":
        return named(owner, lookup)
    if owner.kind == "ForLoopActionUsage" and feature is owner.members[0]:
        feature = next((m for m in owner.members if m.membership == "ParameterMembership"), feature)
    elif "direction" in feature.attributes:
        return None
    for member in feature.members:
        if member.membership == "FeatureValue":
            return result(member, lookup)
    return None


def returned(function: Node, lookup: GeneralizationQueries, seen: set[Node]) -> Node | None:
    """The result parameter that a function or expression owns or inherits."""
    seen.add(function)
    for member in function.members:
        if member.membership == "ReturnParameterMembership":
            return member
    for general in lookup.generals(function):
        found = returned(general, lookup, seen) if general not in seen else None
        if found is not None:
            return found
    return None


def _first(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    return _operand(expression, 0, lookup)


def _second(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    return _operand(expression, 1, lookup)


_RESULTS: dict[str, Callable[[Node, GeneralizationQueries], Node | None]] = {
    "FeatureReferenceExpression": _referent,
    "FeatureChainExpression": named,
    "SelectExpression": _first,
    "IndexExpression": _first,
    "CollectExpression": _second,
    "OperatorExpression": _operator,
    "InvocationExpression": _invoked,
    "TriggerInvocationExpression": _invoked,
    "ConstructorExpression": _invoked,
}
