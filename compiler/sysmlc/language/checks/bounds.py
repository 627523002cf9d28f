"""Bounds of multiplicities are natural numbers; conditions are true or false."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of
from sysmlc.language.checks.values import cannot_be, value
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

NOT_NATURAL = rule(
    "SM260",
    "bound-not-natural",
    Severity.ERROR,
    "the multiplicity of '{name}' has a bound that is {found}",
    help="write a whole number that is not negative, or *",
)
NOT_BOOLEAN = rule(
    "SM262",
    "condition-not-boolean",
    Severity.ERROR,
    "the {role} of '{name}' is neither true nor false",
    help="write a comparison, or something of the type Boolean",
)
BOUND_EXPRESSION = rule(
    "SM253",
    "bound-is-expression",
    Severity.WARNING,
    "the multiplicity of '{name}' has an expression as a bound",
    help="give the expression a name: attribute n = ...; and write [n]",
)

_OPERATED = kinds_of("InstantiationExpression")
_ROLES = {"ElementFilterMembership": "filter", "TransitionFeatureMembership": "guard"}
MEMBERSHIPS = frozenset(_ROLES)
"""Memberships of conditions."""


def check_bound(model: Model, node: Node) -> Iterator[Found]:
    """Report a bound that is no natural number, if it is known what it is."""
    for bound in node.members:
        known = value(model, bound)
        if known is not None and bound.kind != "LiteralInfinity":
            is_wrong = isinstance(known, str | bool | float) or known < 0
            found = str(known).lower() if isinstance(known, bool) else str(known)
        else:
            is_wrong, found = cannot_be(model, bound, "ScalarValues::Integer"), "no number"
        if is_wrong:
            facts = {"name": name_of(model, node.owner), "found": found}
            yield Found(NOT_NATURAL, bound.start, facts)


def check_notation(model: Model, node: Node) -> Iterator[Found]:
    """Report a bound that the notation has no place for; interchange files may have any."""
    for bound in node.members:
        if bound.kind in _OPERATED:
            document = model.document(node)
            if document is not None and document.text:
                yield Found(BOUND_EXPRESSION, bound.start, {"name": name_of(model, node.owner)})


def check_condition(model: Model, node: Node) -> Iterator[Found]:
    """Report a filter or guard that gives something else than true or false."""
    for condition in node.members:
        role = _ROLES.get(condition.membership)
        if role is None or (role == "guard" and condition.role != "guard"):
            continue
        if cannot_be(model, condition, "ScalarValues::Boolean"):
            yield Found(NOT_BOOLEAN, condition.start, {"role": role, "name": name_of(model, node)})


CHECKS = (
    (frozenset({"MultiplicityRange"}), check_bound),
    (frozenset({"MultiplicityRange"}), check_notation),
    (kinds_of("Package") | {"TransitionUsage"}, check_condition),
)
