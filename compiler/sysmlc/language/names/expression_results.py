"""Results of expressions: the feature or type in which names after a dot are looked up."""

from collections.abc import Callable
from functools import partial

from sysmlc.language.metaclasses import FEATURES
from sysmlc.language.names.queries import GeneralizationQueries
from sysmlc.language.tree import Node, list_arguments

_FIRST_OPERATORS = frozenset({",", "??", "[", "#"})
_CASTS = frozenset({"as", "meta"})


def find_result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """Return the feature or type whose members may follow a dot after ``expression``, if known."""
    find = _RESULTS.get(expression.kind)
    return find(expression, lookup) if find is not None else None


def find_named_element(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    """Return the element that an expression names: a referent, a target, a function or type."""
    relation = expression.find_relation("Membership")
    return lookup.target(expression, relation) if relation else None


def _find_referent_result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    body = next((member for member in expression.members if member.kind == "Expression"), None)
    if body is None:
        return find_named_element(expression, lookup)
    result = body.find_member("ResultExpressionMembership")
    return find_result(result, lookup) if result else None


def _find_operand_result(
    index: int, expression: Node, lookup: GeneralizationQueries
) -> Node | None:
    operands = list_arguments(expression)
    return find_result(operands[index], lookup) if index < len(operands) else None


def _find_operator_result(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    operator = expression.attributes.get("operator")
    if operator in _CASTS:
        return _find_cast_type(expression, lookup)
    if operator == "if":
        return _find_operand_result(1, expression, lookup)
    return _find_operand_result(0, expression, lookup) if operator in _FIRST_OPERATORS else None


def _find_cast_type(expression: Node, lookup: GeneralizationQueries) -> Node | None:
    for member in reversed(expression.members):
        if relation := member.find_relation("FeatureTyping"):
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
        feature = owner.find_member("ParameterMembership") or feature
    elif "direction" in feature.attributes:
        return None
    value = feature.find_member("FeatureValue")
    return find_result(value, lookup) if value else None


def find_result_parameter(
    function: Node, lookup: GeneralizationQueries, seen: set[Node]
) -> Node | None:
    """Return the result parameter that a function or expression owns or inherits."""
    seen.add(function)
    own_result = function.find_member("ReturnParameterMembership")
    if own_result is not None:
        return own_result
    for general in lookup.generals(function):
        parameter = find_result_parameter(general, lookup, seen) if general not in seen else None
        if parameter is not None:
            return parameter
    return None


_RESULTS: dict[str, Callable[[Node, GeneralizationQueries], Node | None]] = {
    "FeatureReferenceExpression": _find_referent_result,
    "FeatureChainExpression": find_named_element,
    "SelectExpression": partial(_find_operand_result, 0),
    "IndexExpression": partial(_find_operand_result, 0),
    "CollectExpression": partial(_find_operand_result, 1),
    "OperatorExpression": _find_operator_result,
    "InvocationExpression": _find_invocation_result,
    "TriggerInvocationExpression": _find_invocation_result,
    "ConstructorExpression": _find_invocation_result,
}
