"""What the grammars let through because it can be said better once the tree is there."""

from functools import cache

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.text import rules
from sysmlc.language.text.errors import Errors
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node

_REQUIREMENT = ("RequirementDefinition", "RequirementUsage")
_CASE = ("CaseDefinition", "CaseUsage")
_CALCULATION = ("Function", "Expression")
_ACTION = ("ActionDefinition", "ActionUsage", "ConstraintDefinition", "ConstraintUsage", "Behavior")
_STATE = ("StateDefinition", "StateUsage", "ExhibitStateUsage")
_VIEW = ("ViewDefinition", "ViewUsage")
_PLACES: dict[str, tuple[str, tuple[str, ...], str]] = {
    "SubjectMembership": ("a subject", _REQUIREMENT + _CASE, "requirements and cases"),
    "ActorMembership": ("an actor", _REQUIREMENT + _CASE, "requirements and cases"),
    "StakeholderMembership": ("a stakeholder", _REQUIREMENT, "requirements"),
    "ObjectiveMembership": ("an objective", _CASE, "cases"),
    "RequirementConstraintMembership": (
        "an 'assume' or 'require' constraint",
        _REQUIREMENT,
        "requirements",
    ),
    "FramedConcernMembership": ("'frame'", _REQUIREMENT, "requirements"),
    "RequirementVerificationMembership": ("'verify'", _REQUIREMENT, "requirements"),
    "ViewRenderingMembership": ("'render'", _VIEW, "views"),
    "StateSubactionMembership": ("an 'entry', 'do' or 'exit' action", _STATE, "states"),
    "ElementFilterMembership": (
        "a filter",
        ("Package", "LibraryPackage", "Namespace", *_VIEW),
        "packages and views",
    ),
    "ResultExpressionMembership": ("an expression", _CALCULATION, "calculations and constraints"),
    "ReturnParameterMembership": ("'return'", _CALCULATION, "calculations and cases"),
    "MembershipExpose": ("'expose'", ("ViewUsage",), "usages of views"),
    "NamespaceExpose": ("'expose'", ("ViewUsage",), "usages of views"),
    "action": ("a step of an action", _ACTION, "actions"),
    "TransitionUsage": ("a transition", (*_ACTION, *_STATE), "states and actions"),
}
_STEPS = {
    "AcceptActionUsage",
    "SendActionUsage",
    "AssignmentActionUsage",
    "TerminateActionUsage",
    "IfActionUsage",
    "WhileLoopActionUsage",
    "ForLoopActionUsage",
    "MergeNode",
    "DecisionNode",
    "JoinNode",
    "ForkNode",
    "Membership",
}
_IMPORTS = ("MembershipImport", "NamespaceImport")


def check(tokens: Tokens, errors: Errors) -> None:
    """Report members that stand where they must not, and what the builder remarked."""
    for remark in tokens.remarks:
        rule = rules.PREFIX if remark.what == "prefix" else rules.COMBINATION
        errors.report(rule, remark.start, problem=remark.text, advice=remark.advice)
    for node in tokens.special:
        if node.kind in _IMPORTS:
            _import(node, errors)
        elif node.kind == "EnumerationDefinition":
            _enumeration(node, errors)
        elif node.owner is not None:
            _place(node, node.owner, errors)


def _import(node: Node, errors: Errors) -> None:
    if not node.visibility:
        errors.report(rules.VISIBILITY, node.start)


def _enumeration(node: Node, errors: Errors) -> None:
    for member in node.members:
        if member.kind != "EnumerationUsage" and member.membership != "OwningMembership":
            _report(member, "what is no enumerated value", "other definitions", errors)
        elif member.kind.endswith("Definition"):
            _report(member, "a definition", "packages and other definitions", errors)


def _place(node: Node, owner: Node, errors: Errors) -> None:
    key = node.kind if node.kind in _PLACES else node.membership
    if node.kind in _STEPS and key not in _PLACES:
        key = "action"
    what, kinds, where = _PLACES.get(key, ("", (), ""))
    if kinds and owner.kind not in _all(kinds):
        _report(node, what, where, errors)


def _report(node: Node, what: str, where: str, errors: Errors) -> None:
    owner = node.owner
    here = "outside of any body" if owner is None or owner.owner is None else _called(owner)
    errors.report(rules.PLACE, node.start, what=what, here=here, where=where)


def _called(owner: Node) -> str:
    return f"in '{owner.name or owner.short}'" if owner.name or owner.short else "in this body"


@cache
def _all(kinds: tuple[str, ...]) -> frozenset[str]:
    return frozenset(kind for general in kinds for kind in kinds_of(general))
