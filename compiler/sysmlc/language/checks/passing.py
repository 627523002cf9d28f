"""What is called or performed is given no more than it takes (KerML 8.4.4.1, SysML 8.4.12)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of
from sysmlc.language.checks.values import arguments
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.expression_results import find_named_element
from sysmlc.language.names.positional_redefinition import find_own_features
from sysmlc.language.tree import Node

TOO_MANY = rule(
    "SM248",
    "extra-argument",
    Severity.WARNING,
    "'{called}' takes {takes}, and {given} values are given",
    help="leave the argument out, or give the definition another parameter",
)
NO_PARAMETER = rule(
    "SM249",
    "extra-parameter",
    Severity.WARNING,
    "'{name}' of '{step}' is no parameter of '{called}'",
    help="give it the name of the parameter that is meant, or declare it in the definition",
)

_TYPES = frozenset({"FeatureTyping", "ReferenceSubsetting", "Subsetting", "Redefinition"})
_STEPS = kinds_of("ActionUsage") - kinds_of("CaseUsage") - kinds_of("TransitionUsage")
_CALLED = kinds_of("Behavior") | kinds_of("Step")
MEMBERSHIPS = frozenset({"FeatureMembership", "ParameterMembership"})
"""Memberships of parameters."""
_IN = frozenset({"in", "inout"})
_ROLES = ("subject", "parameter")
"""How a feature is an input: the subject of a requirement or case is one too."""


def check_arguments(model: Model, node: Node) -> Iterator[Found]:
    """Report an invocation with more arguments by position than what it calls has inputs."""
    given = arguments(node)
    called = find_named_element(node, model.lookup)
    if called is None or called.kind not in _CALLED:
        return
    takes = [one for role in _ROLES for one in model.lookup.features_of_role(called, role)]
    inputs = [one for one in takes if _direction(one) in _IN]
    if len(given) > len(inputs):
        said = {0: "no value", 1: "one value"}.get(len(inputs), f"{len(inputs)} values")
        facts = {"called": name_of(model, called), "takes": said, "given": str(len(given))}
        yield Found(TOO_MANY, given[len(inputs)].start, facts)


def check_parameters(model: Model, node: Node) -> Iterator[Found]:
    """Report parameters of a step that are none of what it performs, where that has some."""
    given = find_own_features(node, "parameter")
    called = _called(node) if given else None
    if called is None:
        return
    wanted = model.lookup.features_of_role(called, "parameter")
    for place, one in enumerate(given):
        is_said = any(r.kind == "Redefinition" for r in one.relations)
        namesakes = [other for other in wanted if model.name(other) == model.name(one)]
        meant = [*wanted[place : place + 1], *namesakes]
        if wanted and not (is_said or any(_may_be(one, other) for other in meant)):
            step, name = name_of(model, node), name_of(model, one)
            facts = {"name": name, "step": step, "called": name_of(model, called)}
            yield Found(NO_PARAMETER, one.name_start, facts)


def _called(step: Node) -> Node | None:
    """The only behaviour that the text says the step is one of."""
    found = [r.reference.target for r in step.relations if r.kind in _TYPES]
    behaviours = [one for one in found if one is not None and one.kind in _CALLED]
    return behaviours[0] if len(behaviours) == 1 else None


def _may_be(parameter: Node, other: Node) -> bool:
    return _direction(other) in (_direction(parameter), "inout")


def _direction(parameter: Node) -> str:
    return str(parameter.attributes.get("direction", "in"))


CHECKS = (
    (frozenset({"InvocationExpression"}), check_arguments),
    (_STEPS, check_parameters),
)
