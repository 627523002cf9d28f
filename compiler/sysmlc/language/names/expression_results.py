"""Results of expressions: the feature or type in which names after a dot are looked up."""

from collections.abc import Callable

from sysmlc.language.metaclasses import FEATURES
from sysmlc.language.names.queries import GeneralizationQueries
from sysmlc.language.tree import Node

_FIRST_OPERATORS = frozenset({",", "??", "[", "#"})
_CASTS = frozenset({"as", "meta"})


def find_result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """Return the feature or type whose members may follow a dot after ``expression``, if known."""
    find = _RESULTS.get(expression.kind)
    return find(expression, lookup) if find is not None else None


def find_named_element(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """Return the element that an expression names: a referent, a target, a function or type."""
    for relation in expression.relations:
        if relation.kind == "Membership":
            return lookup.target(expression, relation)
    return None


def _find_referent_result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    body = next((member for member in expression.members if member.kind == "Expression"), None)
    if body is None:
        return find_named_element(expression, lookup)
    result = next(
        (member for member in body.members if member.membership == "ResultExpressionMembership"),
        None,
    )
    return find_result(result, lookup) if result else None


def _find_operand_result(
    expression: Node, index: int, lookup: GeneralizationQueries
) -> Node | None:
    operands = [
        member for member in expression.members if member.membership == "ParameterMembership"
    ]
    return find_result(operands[index], lookup) if index < len(operands) else None


def _find_operator_result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    operator = expression.attributes.get("operator")
    if operator in _CASTS:
        return _find_cast_type(expression, lookup)
    if operator == "if":
        return _find_operand_result(expression, 1, lookup)
    return _find_operand_result(expression, 0, lookup) if operator in _FIRST_OPERATORS else None


def _find_cast_type(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    for member in reversed(expression.members):
        for relation in member.relations:
            if relation.kind == "FeatureTyping":
                return lookup.target(member, relation)
    return None


def _find_invocation_result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """Return the result parameter of a function or calculation, else the instantiated type."""
    invoked = find_named_element(expression, lookup)
    if invoked is None or expression.kind == "ConstructorExpression":
        return invoked
    return find_result_parameter(invoked, lookup, set()) or (
        invoked if invoked.kind not in FEATURES else None
    )


def find_value_result(feature: Node, lookup: GeneralizationQueries) -> Node | None:
    """Return the element that a feature without generals inherits from: the result of its value.

    KerML 8.4.4.10.2, checkFeatureValuationSpecialization. A loop variable inherits from the
    sequence, the result of a constructor from the constructed type.
    """
    membership = feature.membership
    owner = feature.owner
    if owner is None:
        return None
    if membership == "ReturnParameterMembership" and owner.kind == "ConstructorExpression":
        return find_named_element(owner, lookup)
    if owner.kind == "ForLoopActionUsage" and feature is owner.members[0]:
        feature = next(
            (member for member in owner.members if member.membership == "ParameterMembership"),
            feature,
        )
    elif "direction" in feature.attributes:
        return None
    for member in feature.members:
        if member.membership == "FeatureValue":
            return find_result(member, lookup)
    return None


def find_result_parameter(
    function: Node, lookup: GeneralizationQueries, seen: set[Node]
) -> Node | None:
    """Return the result parameter that a function or expression owns or inherits."""
    seen.add(function)
    for member in function.members:
        if member.membership == "ReturnParameterMembership":
            return member
    for general in lookup.generals(function):
        parameter = find_result_parameter(general, lookup, seen) if general not in seen else None
        if parameter is not None:
            return parameter
    return None


def _find_first_operand(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    return _find_operand_result(expression, 0, lookup)


def _find_second_operand(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    return _find_operand_result(expression, 1, lookup)


_RESULTS: dict[str, Callable[[Node, GeneralizationQueries], Node | None]] = {
    "FeatureReferenceExpression": _find_referent_result,
    "FeatureChainExpression": find_named_element,
    "SelectExpression": _find_first_operand,
    "IndexExpression": _find_first_operand,
    "CollectExpression": _find_second_operand,
    "OperatorExpression": _find_operator_result,
    "InvocationExpression": _find_invocation_result,
    "TriggerInvocationExpression": _find_invocation_result,
    "ConstructorExpression": _find_invocation_result,
}
