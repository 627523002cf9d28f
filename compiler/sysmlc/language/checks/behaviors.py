"""Calls, steps, transitions and assignments (KerML 8.4.4.1, SysML 8.3.16, 8.3.17, 8.4.12)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.findings import Finding, iter_stated, name_of
from sysmlc.language.metaclasses import is_composite, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.expression_results import find_named_element
from sysmlc.language.names.implied import find_own_features
from sysmlc.language.tree import Node, list_arguments
from sysmlc.support.counts import count

TOO_MANY = rule(
    "SM248",
    "extra-argument",
    Severity.WARNING,
    "'{called}' takes {takes}, not {given}",
    help="remove the argument, or give the definition another parameter",
)
NO_PARAMETER = rule(
    "SM249",
    "extra-parameter",
    Severity.WARNING,
    "'{name}' of '{step}' is not a parameter of '{called}'",
    help="use the name of a parameter, or declare the parameter in the definition",
)

_TYPES = frozenset({"FeatureTyping", "ReferenceSubsetting", "Subsetting", "Redefinition"})
_STEPS = kinds_of("ActionUsage") - kinds_of("CaseUsage") - kinds_of("TransitionUsage")
_CALLABLE = kinds_of("Behavior") | kinds_of("Step")
MEMBERSHIPS = frozenset({"FeatureMembership", "ParameterMembership"})
"""Memberships of parameters."""
_INPUT_DIRECTIONS = frozenset({"in", "inout"})
_ROLES = ("subject", "parameter")
"""Positional roles of inputs: the subject of a requirement or case is one too."""


def check_arguments(model: Model, node: Node) -> Iterator[Finding]:
    """Report an invocation with more positional arguments than the called behaviour has inputs."""
    arguments = list_arguments(node)
    called = find_named_element(node, model.lookup)
    if called is None or called.kind not in _CALLABLE:
        return
    parameters = [
        parameter for role in _ROLES for parameter in model.lookup.features_of_role(called, role)
    ]
    inputs = [
        parameter for parameter in parameters if _direction_of(parameter) in _INPUT_DIRECTIONS
    ]
    if len(arguments) > len(inputs):
        expected = {0: "no value", 1: "one value"}.get(len(inputs), count(len(inputs), "value"))
        facts = {
            "called": name_of(model, called),
            "takes": expected,
            "given": count(len(arguments), "value"),
        }
        yield Finding(TOO_MANY, arguments[len(inputs)].start, facts)


def check_parameters(model: Model, node: Node) -> Iterator[Finding]:
    """Report parameters of a step that the performed behaviour does not have, if it has any."""
    parameters = find_own_features(node, "parameter")
    called = _find_called(node) if parameters else None
    if called is None:
        return
    expected = model.lookup.features_of_role(called, "parameter")
    for position, parameter in enumerate(parameters):
        is_redefinition_stated = parameter.find_relation("Redefinition") is not None
        namesakes = [
            candidate for candidate in expected if model.name(candidate) == model.name(parameter)
        ]
        candidates = [*expected[position : position + 1], *namesakes]
        if expected and not (
            is_redefinition_stated
            or any(
                _direction_of(candidate) in (_direction_of(parameter), "inout")
                for candidate in candidates
            )
        ):
            step, name = name_of(model, node), name_of(model, parameter)
            facts = {"name": name, "step": step, "called": name_of(model, called)}
            yield Finding(NO_PARAMETER, parameter.name_start, facts)


def _find_called(step: Node) -> Node | None:
    """Return the only behaviour that the text states as a type of the step."""
    targets = [relation.reference.target for relation in step.relations if relation.kind in _TYPES]
    behaviours = [target for target in targets if target is not None and target.kind in _CALLABLE]
    return behaviours[0] if len(behaviours) == 1 else None


def _direction_of(parameter: Node) -> str:
    return str(parameter.attributes.get("direction", "in"))


CALL_CHECKS = (
    (frozenset({"InvocationExpression"}), check_arguments),
    (_STEPS, check_parameters),
)


NO_STATE = rule(
    "SM276",
    "accepts-outside-state",
    Severity.ERROR,
    "'{name}' is not a state, so a transition from it cannot accept an event",
    help="let the transition start in a state",
)
UNCHANGING = rule(
    "SM277",
    "assigns-unchanging",
    Severity.ERROR,
    "'{name}' cannot change over time, so nothing can be assigned to it",
    help="assign to an attribute, item or reference",
)

_MEMBERSHIP = frozenset({"Membership"})
_ACTIONS = kinds_of("ActionUsage")
_STATES = kinds_of("StateUsage")


def check_source(model: Model, node: Node) -> Iterator[Finding]:
    """Report a transition with an accept action whose source is an action, not a state."""
    triggers = [member for member in node.members if member.role == "trigger"]
    for _, source in iter_stated(node, _MEMBERSHIP):
        if triggers and source.kind in _ACTIONS - _STATES:
            yield Finding(NO_STATE, triggers[0].start, {"name": name_of(model, source)})


def check_assigned(model: Model, node: Node) -> Iterator[Finding]:
    """Report an assignment to a composite action."""
    for relation, target in iter_stated(node, _MEMBERSHIP):
        if target.kind in _ACTIONS and is_composite(target):
            yield Finding(UNCHANGING, relation.reference.start, {"name": name_of(model, target)})


STEP_CHECKS = (
    (frozenset({"TransitionUsage"}), check_source),
    (frozenset({"AssignmentActionUsage"}), check_assigned),
)
