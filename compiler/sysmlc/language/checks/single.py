"""Members of which there may be one: subject, objective, result, entry, do, exit, rendering."""

from sysmlc.diagnostics import Sink
from sysmlc.language.checks.rules import ONLY_ONE, SUBJECT_FIRST
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, make_subject

_ROLES = {
    "SubjectMembership": "subject",
    "ObjectiveMembership": "objective",
    "ReturnParameterMembership": "result",
    "ViewRenderingMembership": "rendering",
}
MEMBERSHIPS = frozenset({*_ROLES, "StateSubactionMembership"})
"""Memberships of what there may be one of."""


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report what ``node`` owns too often, and a subject that comes late."""
    seen: set[str] = set()
    parameters = 0
    for member in node.members:
        role = _role(member)
        if role in seen:
            place = make_subject(document, member, member.start)
            sink.report(ONLY_ONE, place, owner=model.name(node) or node.kind, role=role)
        elif role == "subject" and parameters:
            place = make_subject(document, member, member.start)
            sink.report(SUBJECT_FIRST, place, owner=model.name(node) or node.kind)
        if role:
            seen.add(role)
        parameters += role in ("", "subject") and "direction" in member.attributes


def _role(member: Node) -> str:
    if member.membership == "StateSubactionMembership":
        return f"{member.role} action"
    return _ROLES.get(member.membership, "")
