"""Expressions: constant values and types as far as known, valid referents, and conditions.

KerML 8.3.4.8. Conditions are Boolean. Filters and metadata values are evaluable from the model.
"""

import operator as op
from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.findings import Finding, iter_stated, name_of
from sysmlc.language.metaclasses import FEATURES, TYPES, describe_kind, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.expression_results import (
    find_named_element,
    find_result,
    find_result_parameter,
)
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node, list_arguments

Value = bool | int | float | str
EXPRESSIONS = kinds_of("Expression") - kinds_of("Usage")

_MAX_DEPTH = 24
"""Length of chains of features whose values name further features."""
_LITERALS = {
    "LiteralBoolean": "ScalarValues::Boolean",
    "LiteralString": "ScalarValues::String",
    "LiteralInteger": "ScalarValues::Integer",
    "LiteralRational": "ScalarValues::Rational",
    "LiteralInfinity": "ScalarValues::Positive",
}
_BOOLEAN_OPERATORS = frozenset(
    {"==", "!=", "===", "!==", "<", ">", "<=", ">=", "and", "or", "xor", "implies", "not"}
    | {"&", "|", "istype", "hastype", "@", "@@"}
)
"""Operators with a Boolean result (KerML 1.0, 9.4)."""
_REFERRING_KINDS = frozenset(
    {
        "ConstructorExpression",
        "FeatureChainExpression",
        "FeatureReferenceExpression",
        "InvocationExpression",
    }
)
_OPERATIONS: dict[str, Callable[[float, float], Value]] = {
    "+": op.add,
    "-": op.sub,
    "*": op.mul,
    "<": op.lt,
    ">": op.gt,
    "<=": op.le,
    ">=": op.ge,
    "==": op.eq,
    "!=": op.ne,
}


def evaluate_constant(model: Model, expression: Node, depth: int = 0) -> Value | None:
    """Return the constant value of an expression, also through bound features, or None."""
    if "value" in expression.attributes:
        return expression.attributes["value"]
    # Bound features may form a cycle: a = b, b = a.
    if depth > _MAX_DEPTH:
        return None
    if expression.kind == "FeatureReferenceExpression":
        feature = find_named_element(expression, model.lookup)
        bound_value = feature.find_member("FeatureValue") if feature is not None else None
        return evaluate_constant(model, bound_value, depth + 1) if bound_value is not None else None
    operands = list_arguments(expression)
    if expression.kind != "OperatorExpression" or not 1 <= len(operands) <= 2:
        return None
    values = [evaluate_constant(model, operand, depth + 1) for operand in operands]
    return _fold_constants(str(expression.attributes.get("operator")), values)


def _fold_constants(operator: str, operands: list[Value | None]) -> Value | None:
    numbers = [operand for operand in operands if isinstance(operand, int | float)]
    if len(numbers) < len(operands) or operator not in _OPERATIONS:
        return None
    if len(numbers) == 1:
        return {"-": -numbers[0], "+": numbers[0]}.get(operator)
    return _OPERATIONS[operator](numbers[0], numbers[1])


def find_types(model: Model, expression: Node, depth: int = 0) -> list[Node]:
    """Return the types of the value of an expression; empty if they are unknown."""
    name = _LITERALS.get(expression.kind)
    if (
        expression.kind == "OperatorExpression"
        and expression.attributes.get("operator") in _BOOLEAN_OPERATORS
    ):
        name = "ScalarValues::Boolean"
    if name is not None:
        type_ = model.find(name)
        return [type_] if type_ is not None else []
    if depth > _MAX_DEPTH:
        return []
    source = _find_source(model, expression)
    if source is None or source.kind not in FEATURES:
        return [source] if source is not None else []
    value = source.find_member("FeatureValue") if not model.lookup.generals(source) else None
    return model.types(source) if value is None else find_types(model, value, depth + 1)


def _find_source(model: Model, expression: Node) -> Node | None:
    """Return the feature or type that provides the values of an expression."""
    if expression.kind not in _REFERRING_KINDS:
        return None
    element = find_named_element(expression, model.lookup)
    is_called = expression.kind == "InvocationExpression"
    return (
        find_result_parameter(element, model.lookup, set())
        if element is not None and is_called
        else element
    )


def is_incompatible(model: Model, expression: Node, type_name: str) -> bool:
    """Whether the value of an expression certainly has not the library type."""
    target = model.find(type_name)
    types = find_types(model, expression)
    if target is None or not types:
        return False
    return not any(
        model.specializes(type_, target) or model.specializes(target, type_) for type_ in types
    )


NO_FEATURE = rule(
    "SM272",
    "value-no-feature",
    Severity.ERROR,
    "'{name}' is {found} and has no value",
    help="name a feature; 'all {name}' stands for all instances of a type",
)
OTHER_OWNER = rule(
    "SM273",
    "chained-elsewhere",
    Severity.ERROR,
    "'{name}' is a feature of '{owner}', not of the element before the dot",
    help="write the whole path, with a dot for each step",
)

_MEMBERSHIP = frozenset({"Membership"})
_REFERRING = frozenset({"FeatureReferenceExpression", "FeatureChainExpression"})


def check_named_feature(model: Model, node: Node) -> Iterator[Finding]:
    """Report an expression that names a type, or a feature that its operand does not have."""
    for relation, target in iter_stated(node, _MEMBERSHIP):
        facts = {"name": name_of(model, target)}
        if target.kind in TYPES - FEATURES:
            facts["found"] = describe_kind(target)
            yield Finding(NO_FEATURE, relation.reference.start, facts)
        elif len(relation.reference.chain[0]) > 1 and _is_not_in_operand(model, node, target):
            facts["owner"] = name_of(model, target.owner)
            yield Finding(OTHER_OWNER, relation.reference.start, facts)


def _is_not_in_operand(model: Model, node: Node, target: Node) -> bool:
    """Whether the expression before the dot is known and does not have the feature."""
    if node.kind != "FeatureChainExpression":
        return False
    operand = next(iter(list_arguments(node)), None)
    source = find_result(operand, model.lookup) if operand is not None else None
    owner = find_owning_type(target)
    if source is None or owner is None or owner.kind not in FEATURES:
        return False
    return owner not in model.supertype_set(source)


CHECKS = ((_REFERRING & kinds_of("Expression"), check_named_feature),)


# -- conditions and metadata values ------------------------------------------------------------

NOT_EVALUABLE = rule(
    "SM261",
    "not-evaluable",
    Severity.ERROR,
    "{what} uses '{called}', which cannot be evaluated without a running system",
    help="use only operators and the features of the metadata",
)

NOT_BOOLEAN = rule(
    "SM262",
    "condition-not-boolean",
    Severity.ERROR,
    "the {role} of '{name}' is not Boolean",
    help="write a comparison, or an expression of the type Boolean",
)

_METADATA = kinds_of("MetadataFeature")
_OPERATORS = frozenset({"~", "all"})
"""Operators that are no model-level evaluable functions (KerML 1.0, 8.4.4.9)."""
FILTER_MEMBERSHIPS = frozenset({"ElementFilterMembership"})
"""Memberships of filters."""
_CONDITION_ROLES = {"ElementFilterMembership": "filter", "TransitionFeatureMembership": "guard"}
CONDITION_MEMBERSHIPS = frozenset(_CONDITION_ROLES)
"""Memberships of conditions."""
_ITERATING = frozenset({"collect", "select", "selectOne", "reject", "forAll", "exists"})


def check_filter(model: Model, node: Node) -> Iterator[Finding]:
    """Report filters of a package that cannot be evaluated from the model."""
    for member in node.members:
        if member.membership in FILTER_MEMBERSHIPS:
            yield from _check_evaluable(model, member, f"the filter of {_quote_name(model, node)}")


def check_metadata(model: Model, node: Node) -> Iterator[Finding]:
    """Report values in metadata that cannot be evaluated from the model."""
    for inner in node.walk():
        if inner.membership == "FeatureValue" and inner is not node:
            yield from _check_evaluable(
                model, inner, f"the value of {_quote_name(model, inner.owner)}"
            )


def _check_evaluable(model: Model, expression: Node, what: str) -> Iterator[Finding]:
    for node in expression.walk():
        unevaluable = _find_unevaluable(model, node)
        if unevaluable:
            yield Finding(NOT_EVALUABLE, expression.start, {"what": what, "called": unevaluable})
            return


def _find_unevaluable(model: Model, node: Node) -> str:
    """Return the operator or function of an expression that cannot be evaluated; else empty."""
    if node.kind == "OperatorExpression":
        operator = str(node.attributes.get("operator", ""))
        return operator if operator in _OPERATORS else ""
    if node.kind != "InvocationExpression":
        return ""
    function = find_named_element(node, model.lookup)
    if function is None:
        return ""
    # Functions of the library are evaluable, except those that iterate with a body (KerML 8.4.4.9).
    is_of_library = function.owner is not None and function.owner.kind == "LibraryPackage"
    is_evaluable = is_of_library and function.name not in _ITERATING
    return "" if is_evaluable else name_of(model, function)


def _quote_name(model: Model, node: Node | None) -> str:
    return f"'{name_of(model, node)}'"


def check_condition(model: Model, node: Node) -> Iterator[Finding]:
    """Report a filter or guard whose value is not a Boolean."""
    for condition in node.members:
        role = _CONDITION_ROLES.get(condition.membership)
        if role is None or (role == "guard" and condition.role != "guard"):
            continue
        if is_incompatible(model, condition, "ScalarValues::Boolean"):
            yield Finding(
                NOT_BOOLEAN, condition.start, {"role": role, "name": name_of(model, node)}
            )


CONDITION_CHECKS = (
    (kinds_of("Package") | {"TransitionUsage"}, check_condition),
    (kinds_of("Package"), check_filter),
    (_METADATA, check_metadata),
)
