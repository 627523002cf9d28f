"""Checks of syntax that the grammars leave out because the tree allows better messages."""

from functools import cache

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.text import rules
from sysmlc.language.text.errors import Errors
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node

_REQUIREMENT = ("RequirementDefinition", "RequirementUsage")
_CASE = ("CaseDefinition", "CaseUsage")
_CALCULATION = ("Function", "Expression")
_ACTION = ("ActionDefinition", "ActionUsage", "ConstraintDefinition", "ConstraintUsage", "Behavior")
_STATE = ("StateDefinition", "StateUsage", "ExhibitStateUsage")
_VIEW = ("ViewDefinition", "ViewUsage")
# The grammars have one rule for members of all bodies: a rule for each kind of body would multiply
# their states, and the message would only name a token.
_ALLOWED_OWNERS: dict[str, tuple[str, tuple[str, ...], str]] = {
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
"""For a kind or a membership: its name, the kinds of owners, and these in words."""
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


def check_syntax(tokens: Tokens, errors: Errors) -> None:
    """Report members in bodies that cannot have them, and the faults that builders found."""
    for fault in tokens.build_faults:
        rule = rules.PREFIX if fault.what == "prefix" else rules.COMBINATION
        errors.report(rule, fault.start, problem=fault.text, advice=fault.advice)
    for node in tokens.restricted_nodes:
        if node.kind in _IMPORTS:
            _check_import(node, errors)
        elif node.kind == "EnumerationDefinition":
            _check_enumeration(node, errors)
        elif node.owner is not None:
            _check_owner(node, node.owner, errors)


def _check_import(node: Node, errors: Errors) -> None:
    if not node.visibility:
        errors.report(rules.VISIBILITY, node.start)


def _check_enumeration(node: Node, errors: Errors) -> None:
    for member in node.members:
        if member.kind != "EnumerationUsage" and member.membership != "OwningMembership":
            _report(member, "what is no enumerated value", "other definitions", errors)
        elif member.kind.endswith("Definition"):
            _report(member, "a definition", "packages and other definitions", errors)


def _check_owner(node: Node, owner: Node, errors: Errors) -> None:
    key = node.kind if node.kind in _ALLOWED_OWNERS else node.membership
    if node.kind in _STEPS and key not in _ALLOWED_OWNERS:
        key = "action"
    what, kinds, where = _ALLOWED_OWNERS.get(key, ("", (), ""))
    if kinds and owner.kind not in _with_special_kinds(kinds):
        _report(node, what, where, errors)


def _report(node: Node, what: str, where: str, errors: Errors) -> None:
    owner = node.owner
    is_at_top = owner is None or owner.owner is None
    body = "outside of any body" if owner is None or is_at_top else _describe_body(owner)
    errors.report(rules.PLACE, node.start, what=what, here=body, where=where)


def _describe_body(owner: Node) -> str:
    name = owner.name or owner.short_name
    return f"in '{name}'" if name else "in this body"


@cache
def _with_special_kinds(kinds: tuple[str, ...]) -> frozenset[str]:
    return frozenset(kind for general in kinds for kind in kinds_of(general))
