"""Conditions and metadata values: Boolean, and evaluable from the model alone (KerML 8.3.4.8)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.expressions import is_incompatible
from sysmlc.language.checks.findings import Finding, name_of
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.expression_results import find_named_element
from sysmlc.language.tree import Node

NOT_EVALUABLE = rule(
    "SM261",
    "not-evaluable",
    Severity.ERROR,
    "{what} needs '{called}', which says nothing without a running system",
    help="use operators and what the metadata says itself",
)

NOT_BOOLEAN = rule(
    "SM262",
    "condition-not-boolean",
    Severity.ERROR,
    "the {role} of '{name}' is neither true nor false",
    help="write a comparison, or something of the type Boolean",
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
    # Functions of the library are evaluable, except those that iterate with a body (KerML 8.4.4.9).
    is_basic = function is None or (_is_in_library(function) and function.name not in _ITERATING)
    return "" if is_basic else name_of(model, function)


def _is_in_library(node: Node) -> bool:
    return node.owner is not None and node.owner.kind == "LibraryPackage"


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


CHECKS = (
    (kinds_of("Package") | {"TransitionUsage"}, check_condition),
    (kinds_of("Package"), check_filter),
    (_METADATA, check_metadata),
)
