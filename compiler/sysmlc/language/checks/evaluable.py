"""Filters and values of metadata can be evaluated from the model itself (KerML 8.3.4.8)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of
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

_METADATA = kinds_of("MetadataFeature")
_OPERATORS = frozenset({"~", "all"})
"""Operators that are no model-level evaluable functions (KerML 1.0, 8.4.4.9)."""
MEMBERSHIPS = frozenset({"ElementFilterMembership"})
"""Memberships of filters."""
_ITERATING = frozenset({"collect", "select", "selectOne", "reject", "forAll", "exists"})


def check_filter(model: Model, node: Node) -> Iterator[Found]:
    """Report filters of a package that cannot be evaluated."""
    for member in node.members:
        if member.membership in MEMBERSHIPS:
            yield from _check(model, member, f"the filter of {_quoted(model, node)}")


def check_metadata(model: Model, node: Node) -> Iterator[Found]:
    """Report values in metadata that cannot be evaluated."""
    for inner in node.walk():
        if inner.membership == "FeatureValue" and inner is not node:
            yield from _check(model, inner, f"the value of {_quoted(model, inner.owner)}")


def _check(model: Model, expression: Node, what: str) -> Iterator[Found]:
    for node in expression.walk():
        called = _called(model, node)
        if called:
            yield Found(NOT_EVALUABLE, expression.start, {"what": what, "called": called})
            return


def _called(model: Model, node: Node) -> str:
    """The operator or function of an expression that cannot be evaluated; else empty."""
    if node.kind == "OperatorExpression":
        operator = str(node.attributes.get("operator", ""))
        return operator if operator in _OPERATORS else ""
    if node.kind != "InvocationExpression":
        return ""
    function = find_named_element(node, model.lookup)
    is_basic = function is None or (_is_of_library(function) and function.name not in _ITERATING)
    return "" if is_basic else name_of(model, function)


def _is_of_library(node: Node) -> bool:
    return node.owner is not None and node.owner.kind == "LibraryPackage"


def _quoted(model: Model, node: Node | None) -> str:
    return f"'{name_of(model, node)}'"


CHECKS = ((kinds_of("Package"), check_filter), (_METADATA, check_metadata))
