"""Objectives and subjects that cases and requirements inherit beside their own (SysML 8.3.22)."""

from collections.abc import Iterator

from sysmlc.language.checks.found import Found, name_of
from sysmlc.language.checks.rules import ONLY_ONE, SUBJECT_FIRST
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.positional_redefinition import find_role
from sysmlc.language.tree import Node

_CASES = kinds_of("CaseDefinition") | kinds_of("CaseUsage")
_WITH_SUBJECT = _CASES | kinds_of("RequirementDefinition") | kinds_of("RequirementUsage")
_PARAMETERS = ("parameter", "subject")


def check_objective(model: Model, node: Node) -> Iterator[Found]:
    """Report a case that inherits an objective beside another; ``single`` reports own ones."""
    if not model.lookup.generals(node):
        return
    found = [one for one in model.members(node) if one.membership == "ObjectiveMembership"]
    own = [one for one in found if one.owner is node]
    if len(found) > max(len(own), 1):
        start = own[0].start if own else node.start
        yield Found(ONLY_ONE, start, {"owner": name_of(model, node), "role": "objective"})


def check_subject(model: Model, node: Node) -> Iterator[Found]:
    """Report a case or requirement of which the inherited subject is not the first parameter."""
    if any(find_role(one) in _PARAMETERS for one in node.members):
        return
    if any(map(_is_late, model.lookup.generals(node))):
        yield Found(SUBJECT_FIRST, node.start, {"owner": name_of(model, node)})


def _is_late(general: Node) -> bool:
    roles = [one for one in map(find_role, general.members) if one in _PARAMETERS]
    return "subject" in roles[1:] and roles[0] != "subject"


CHECKS = ((_CASES, check_objective), (_WITH_SUBJECT, check_subject))
