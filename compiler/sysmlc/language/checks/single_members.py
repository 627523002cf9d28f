"""Members that may occur once: subject, objective, result, entry, do, exit, rendering."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.language.checks.findings import Finding, name_of
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.positional_redefinition import find_role
from sysmlc.language.tree import Document, Node, make_subject

ONLY_ONE = rule(
    "SM223",
    "only-one",
    Severity.ERROR,
    "'{owner}' may have one {role} only",
    help="keep the first one, or redefine it",
)
SUBJECT_FIRST = rule(
    "SM224",
    "subject-first",
    Severity.ERROR,
    "the subject of '{owner}' must be its first parameter",
    help="move the subject before the other parameters",
)

_ROLES_BY_MEMBERSHIP = {
    "SubjectMembership": "subject",
    "ObjectiveMembership": "objective",
    "ReturnParameterMembership": "result",
    "ViewRenderingMembership": "rendering",
}
MEMBERSHIPS = frozenset({*_ROLES_BY_MEMBERSHIP, "StateSubactionMembership"})
"""Memberships of members that may occur once."""


def check_own_members(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report members that occur twice, and a subject after other parameters."""
    seen_roles: set[str] = set()
    parameters = 0
    for member in node.members:
        role = _find_single_role(member)
        if role in seen_roles:
            place = make_subject(document, member, member.start)
            sink.report(ONLY_ONE, place, owner=model.name(node) or node.kind, role=role)
        elif role == "subject" and parameters:
            place = make_subject(document, member, member.start)
            sink.report(SUBJECT_FIRST, place, owner=model.name(node) or node.kind)
        if role:
            seen_roles.add(role)
        parameters += role in ("", "subject") and "direction" in member.attributes


def _find_single_role(member: Node) -> str:
    if member.membership == "StateSubactionMembership":
        return f"{member.role} action"
    return _ROLES_BY_MEMBERSHIP.get(member.membership, "")


_CASES = kinds_of("CaseDefinition") | kinds_of("CaseUsage")
_WITH_SUBJECT = _CASES | kinds_of("RequirementDefinition") | kinds_of("RequirementUsage")
_PARAMETERS = ("parameter", "subject")


def check_objective(model: Model, node: Node) -> Iterator[Finding]:
    """Report a case that inherits an objective beside another; own ones are checked above."""
    if not model.lookup.generals(node):
        return
    objectives = [
        member for member in model.members(node) if member.membership == "ObjectiveMembership"
    ]
    own_objectives = [objective for objective in objectives if objective.owner is node]
    # An inherited objective that an own one redefines is not among the members.
    if len(objectives) > max(len(own_objectives), 1):
        start = own_objectives[0].start if own_objectives else node.start
        yield Finding(ONLY_ONE, start, {"owner": name_of(model, node), "role": "objective"})


def check_subject(model: Model, node: Node) -> Iterator[Finding]:
    """Report a case or requirement whose inherited subject is not the first parameter."""
    if any(find_role(member) in _PARAMETERS for member in node.members):
        return
    if any(map(_has_late_subject, model.lookup.generals(node))):
        yield Finding(SUBJECT_FIRST, node.start, {"owner": name_of(model, node)})


def _has_late_subject(general: Node) -> bool:
    roles = [role for role in map(find_role, general.members) if role in _PARAMETERS]
    return "subject" in roles[1:] and roles[0] != "subject"


CHECKS = ((_CASES, check_objective), (_WITH_SUBJECT, check_subject))
