"""Multiplicities: valid bounds, and bounds that conform to those of general features."""

from collections.abc import Iterator
from math import inf
from typing import NamedTuple

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.expressions import evaluate_constant, is_incompatible
from sysmlc.language.checks.findings import Finding, iter_stated, name_of
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node

NOT_NATURAL = rule(
    "SM260",
    "bound-not-natural",
    Severity.ERROR,
    "the multiplicity of '{name}' has a bound that is {found}",
    help="write a whole number that is not negative, or *",
)
BOUND_EXPRESSION = rule(
    "SM253",
    "bound-is-expression",
    Severity.WARNING,
    "the multiplicity of '{name}' has an expression as a bound",
    help="give the expression a name: attribute n = ...; and write [n]",
)

_INSTANTIATIONS = kinds_of("InstantiationExpression")


def check_bound(model: Model, node: Node) -> Iterator[Finding]:
    """Report a bound whose value is known and no natural number."""
    for bound in node.members:
        value = evaluate_constant(model, bound)
        if value is not None and bound.kind != "LiteralInfinity":
            is_invalid = isinstance(value, str | bool | float) or value < 0
            description = str(value).lower() if isinstance(value, bool) else str(value)
        else:
            is_invalid, description = (
                is_incompatible(model, bound, "ScalarValues::Integer"),
                "no number",
            )
        if is_invalid:
            facts = {"name": name_of(model, node.owner), "found": description}
            yield Finding(NOT_NATURAL, bound.start, facts)


def check_notation(model: Model, node: Node) -> Iterator[Finding]:
    """Report a bound that the textual notation does not allow; interchange files may have any."""
    for bound in node.members:
        if bound.kind in _INSTANTIATIONS:
            document = model.document(node)
            # Interchange files have no notation that could be violated.
            if document is not None and document.text:
                yield Finding(BOUND_EXPRESSION, bound.start, {"name": name_of(model, node.owner)})


CHECKS = (
    (frozenset({"MultiplicityRange"}), check_bound),
    (frozenset({"MultiplicityRange"}), check_notation),
)


MORE = rule(
    "SM281",
    "more-than-general",
    Severity.WARNING,
    "'{name}' may have {own} values, but '{general}' has at most {most}",
    help="lower the bound, or raise that of '{general}'",
)
FEWER = rule(
    "SM282",
    "fewer-than-redefined",
    Severity.WARNING,
    "'{name}' may have only {own} values, but '{general}', which it redefines, requires "
    "at least {least}",
    help="raise the bound, or lower that of '{general}'",
)

_SUBSETTING = frozenset({"Subsetting", "Redefinition"})
_REDEFINITION = frozenset({"Redefinition"})
_SINGLE = frozenset({"AttributeUsage", "ItemUsage", "PartUsage", "PortUsage"})
"""Usages with the default multiplicity 1 as features of a type (SysML 2.0, 8.3.6.4)."""
_MAX_DEPTH = 20


class Bounds(NamedTuple):
    """The least and the greatest number of values."""

    least: float
    most: float


def check_bounds(model: Model, node: Node) -> Iterator[Finding]:
    """Report bounds that are wider than those of a subset or redefined feature."""
    own_bounds = _find_stated_bounds(model, node)
    if own_bounds is None:
        return
    for relation, target in iter_stated(node, _SUBSETTING):
        general_bounds = find_bounds(model, target)
        if general_bounds is not None:
            names = {"name": name_of(model, node), "general": name_of(model, target)}
            start = relation.reference.start
            if own_bounds.most > general_bounds.most:
                most = {
                    "own": _describe_number(own_bounds.most),
                    "most": _describe_number(general_bounds.most),
                }
                yield Finding(MORE, start, {**names, **most})
            if relation.kind == "Redefinition" and own_bounds.least < general_bounds.least:
                least = {
                    "own": _describe_number(own_bounds.least),
                    "least": _describe_number(general_bounds.least),
                }
                yield Finding(FEWER, start, {**names, **least})


def find_bounds(model: Model, feature: Node, depth: int = 0) -> Bounds | None:
    """Return the bounds of a feature: stated, redefined, or 1 by default; None if unknown."""
    if any(member.kind == "MultiplicityRange" for member in feature.members):
        return _find_stated_bounds(model, feature)
    for _, target in iter_stated(feature, _REDEFINITION):
        return find_bounds(model, target, depth + 1) if depth < _MAX_DEPTH else None
    is_single = feature.kind in _SINGLE and find_owning_type(feature) is not None
    return Bounds(1, 1) if is_single else None


def _find_stated_bounds(model: Model, feature: Node) -> Bounds | None:
    """Return the bounds that a feature states, if they are constant."""
    for member in feature.members:
        if member.kind == "MultiplicityRange":
            values = [_evaluate_bound(model, bound) for bound in member.members]
            numbers = [value for value in values if value is not None]
            if not numbers or len(numbers) < len(values):
                return None
            is_any = len(numbers) == 1 and numbers[0] == inf
            return Bounds(0 if is_any else numbers[0], numbers[-1])
    return None


def _evaluate_bound(model: Model, bound: Node) -> float | None:
    if bound.kind == "LiteralInfinity":
        return inf
    value = evaluate_constant(model, bound)
    return value if isinstance(value, int) and not isinstance(value, bool) else None


def _describe_number(number: float) -> str:
    return "any number of" if number == inf else f"{number:g}"


BY_RELATION = ((_SUBSETTING, check_bounds),)
