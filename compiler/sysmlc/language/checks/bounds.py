"""Bounds of multiplicities are natural numbers; conditions are true or false."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, error, name_of
from sysmlc.language.checks.values import cannot_be, value
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

NOT_NATURAL = error(
    "SM260",
    "bound-not-natural",
    "the multiplicity of '{name}' has a bound that is {found}",
    "How many there are is 0, 1, 2 and so on (KerML 1.0, "
    "validateMultiplicityRangeBoundResultTypes).",
    "write a whole number that is not negative, or *",
    'part wheels["four"];\n',
    "part wheels[4];\n",
)
NOT_BOOLEAN = error(
    "SM262",
    "condition-not-boolean",
    "the {role} of '{name}' is neither true nor false",
    "It decides whether something is so (KerML 1.0, "
    "validateElementFilterMembershipConditionIsBoolean; SysML 2.0, "
    "validateTransitionFeatureMembershipGuardExpression).",
    "write a comparison, or something of the type Boolean",
    'state def Running {\n    state a;\n    state b;\n    transition first a if "x" then b;\n}\n',
    "state def Running {\n    state a;\n    state b;\n    transition first a if 2 > 1 then b;\n}\n",
)
BOUND_EXPRESSION = rule(
    "SM253",
    "bound-is-expression",
    Severity.WARNING,
    "the multiplicity of '{name}' has an expression as a bound",
    why="The notation has numbers, '*' and names between the brackets (KerML 1.0, 8.2.5.11, "
    "MultiplicityExpressionMember): other tools may refuse the file. sysmlc reads it all the same.",
    help="give the expression a name: attribute n = ...; and write [n]",
    wrong="attribute axles = 2;\npart wheels[2 * axles];\n",
    right="attribute axles = 2;\nattribute count = 2 * axles;\npart wheels[count];\n",
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
