"""Valid members: what may own variants, portions, ends and variable features, and how often.

Members that may occur once are the subject, objective, result, entry, do, exit and rendering.
"""

from collections.abc import Iterator

from sysmlc.diagnostics import Rule, Severity, rule
from sysmlc.language.checks.findings import DECLARED_FEATURES, DECLARED_TYPES, Finding, name_of
from sysmlc.language.metaclasses import is_end, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.implied import find_own_features, find_owning_type, find_role
from sysmlc.language.tree import Node

VARIANT_ELSEWHERE = rule(
    "SM226",
    "variant-elsewhere",
    Severity.ERROR,
    "'{name}' is a variant, but '{owner}' is not a variation",
    help="write 'variation' before '{owner}', or remove 'variant'",
)
NO_VARIANT = rule(
    "SM227",
    "variation-member",
    Severity.ERROR,
    "'{name}' is a member of the variation '{owner}' but not a variant",
    help="write 'variant' before '{name}'",
)
VARIATION_OF_VARIATION = rule(
    "SM228",
    "variation-of-variation",
    Severity.ERROR,
    "the variation '{name}' specialises another variation",
    help="specialise a type that is not a variation",
)
VERIFY_ELSEWHERE = rule(
    "SM229",
    "verify-elsewhere",
    Severity.ERROR,
    "'{owner}' is not the objective of a verification, so it cannot verify '{name}'",
    help="move 'verify' into the objective of a verification case",
)
PARALLEL = rule(
    "SM230",
    "parallel-succession",
    Severity.ERROR,
    "'{owner}' is parallel: its states have no order",
    help="remove 'parallel', or the succession or transition",
)
PORTION_ELSEWHERE = rule(
    "SM231",
    "portion-elsewhere",
    Severity.ERROR,
    "'{name}' is a portion, but its owner is not an occurrence",
    help="move it into an occurrence, item or part",
)
END_NO_PORT = rule(
    "SM232",
    "interface-end-no-port",
    Severity.ERROR,
    "'{name}' is an end of the interface '{owner}' but not a port",
    help="make it a port, or use a connection",
)
TOO_MANY_ENDS = rule(
    "SM233",
    "flow-ends",
    Severity.ERROR,
    "'{name}' is the third end of the flow '{owner}'",
    help="keep two ends",
)
ABSTRACT_METADATA = rule(
    "SM234",
    "abstract-metadata",
    Severity.ERROR,
    "metadata '{name}' has an abstract type",
    help="use a metadata definition that is not abstract",
)
ENUMERATION_AND_MORE = rule(
    "SM235",
    "enumeration-and-more",
    Severity.ERROR,
    "attribute '{name}' is typed by an enumeration and by another type",
    help="keep one type",
)
SECOND_RESULT = rule(
    "SM265",
    "several-results",
    Severity.ERROR,
    "'{name}' has {count} result expressions, {whose}",
    help="keep one of them",
)
VARIABLE_PORTION = rule(
    "SM266",
    "variable-portion",
    Severity.ERROR,
    "'{name}' is a portion, so it cannot be variable",
    help="remove 'var' or 'portion'",
)
VARIABLE_ELSEWHERE = rule(
    "SM267",
    "variable-elsewhere",
    Severity.ERROR,
    "'{name}' is variable, but '{owner}' is not an occurrence",
    help="remove 'var'",
)
ROOT_IMPORT = rule(
    "SM268",
    "public-root-import",
    Severity.ERROR,
    "the import of '{name}' is outside of all packages and not private",
    help="write 'private' before 'import'",
)
ONLY_ONE = rule(
    "SM223",
    "only-one",
    Severity.ERROR,
    "'{owner}' may have only one {role}",
    help="keep the first one, or redefine it",
)
SUBJECT_FIRST = rule(
    "SM224",
    "subject-first",
    Severity.ERROR,
    "the subject of '{owner}' must be its first parameter",
    help="move the subject before the other parameters",
)

_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_SUCCESSIONS = kinds_of("Succession") | {"TransitionUsage"}
_OCCURRENCES = kinds_of("Class") | kinds_of("OccurrenceUsage")
_INTERFACES = kinds_of("InterfaceDefinition") | kinds_of("InterfaceUsage")
_WITH_ENDS = _INTERFACES | kinds_of("FlowDefinition")
_WITH_TYPE_CHECKS = frozenset({"AttributeUsage", "MetadataUsage"})
"""Usages whose types are checked here."""
_VERIFICATIONS = kinds_of("VerificationCaseDefinition") | kinds_of("VerificationCaseUsage")
_ENUMERATIONS = kinds_of("EnumerationDefinition")
_FUNCTIONS = kinds_of("Function") | (kinds_of("Expression") & DECLARED_TYPES)
_IMPORTS = frozenset({"MembershipImport", "NamespaceImport"})
_ROLES_BY_MEMBERSHIP = {
    "SubjectMembership": "subject",
    "ObjectiveMembership": "objective",
    "ReturnParameterMembership": "result",
    "ViewRenderingMembership": "rendering",
}
SINGLE_MEMBERSHIPS = frozenset({*_ROLES_BY_MEMBERSHIP, "StateSubactionMembership"})
"""Memberships of members that may occur once."""
_CASES = kinds_of("CaseDefinition") | kinds_of("CaseUsage")
_WITH_SUBJECT = _CASES | kinds_of("RequirementDefinition") | kinds_of("RequirementUsage")
_PARAMETERS = ("parameter", "subject")


# -- members and their owners ------------------------------------------------------------------


def check_member(model: Model, node: Node) -> Iterator[Finding]:
    """Report a node that may not be a member of its owner, or has a type that it may not have."""
    owner = node.owner
    if owner is None:
        return
    broken = _find_broken_membership(node, owner)
    # One finding for each usage: its type may be right once it has its place.
    if broken is None and node.kind in _WITH_TYPE_CHECKS:
        broken = _find_broken_type(model, node)
    if broken is not None:
        facts = {"name": name_of(model, node), "owner": name_of(model, owner)}
        # The parser reports a member that no owner of this kind may have.
        yield Finding(broken, node.start, facts, unless=("SM195",))


def _find_broken_membership(node: Node, owner: Node) -> Rule | None:
    membership = node.membership
    if membership == "VariantMembership":
        return None if _is_variation(owner) else VARIANT_ELSEWHERE
    if membership == "RequirementVerificationMembership":
        return None if _is_objective(owner) else VERIFY_ELSEWHERE
    if membership in _FEATURE_MEMBERSHIPS:
        return _find_broken_feature_membership(node, owner)
    return PORTION_ELSEWHERE if "portionKind" in node.attributes else None


def _find_broken_feature_membership(node: Node, owner: Node) -> Rule | None:
    if _is_variation(owner):
        return NO_VARIANT
    if node.kind in _SUCCESSIONS and owner.attributes.get("isParallel"):
        return PARALLEL
    if "portionKind" in node.attributes and owner.kind not in _OCCURRENCES:
        return PORTION_ELSEWHERE
    if owner.kind not in _WITH_ENDS or not is_end(node):
        return None
    if owner.kind in _INTERFACES:
        is_port = node.kind in ("PortUsage", "ReferenceUsage")
        return None if is_port else END_NO_PORT
    return TOO_MANY_ENDS if find_own_features(owner, "end").index(node) > 1 else None


def _find_broken_type(model: Model, node: Node) -> Rule | None:
    if node.kind == "MetadataUsage":
        types = model.lookup.generals(node)
        is_abstract = any(type_.attributes.get("isAbstract") for type_ in types)
        return ABSTRACT_METADATA if is_abstract else None
    if node.kind == "AttributeUsage" and len(model.lookup.generals(node)) > 1:
        types = model.types(node)
        has_enumeration = any(type_.kind in _ENUMERATIONS for type_ in types)
        return ENUMERATION_AND_MORE if len(types) > 1 and has_enumeration else None
    return None


def _is_variation(node: Node) -> bool:
    return bool(node.attributes.get("isVariation")) or node.kind in _ENUMERATIONS


def _is_objective(owner: Node) -> bool:
    case = owner.owner
    return (
        owner.membership == "ObjectiveMembership"
        and case is not None
        and case.kind in _VERIFICATIONS
    )


def check_result(model: Model, node: Node) -> Iterator[Finding]:
    """Report a second result expression; the first one may be owned or inherited."""
    own_results = _list_results(node)
    if not own_results and not model.lookup.generals(node):
        return
    inherited = [
        result for general in model.all_supertypes(node)[1:] for result in _list_results(general)
    ]
    count = len(own_results) + len(inherited)
    if count > 1:
        start = own_results[-1].start if own_results else node.start
        whose = "its own and inherited ones" if own_results else "inherited ones"
        if not inherited:
            whose = "its own"
        facts = {"name": name_of(model, node), "count": str(count), "whose": whose}
        yield Finding(SECOND_RESULT, start, facts)


def _list_results(node: Node) -> list[Node]:
    return [member for member in node.members if member.membership == "ResultExpressionMembership"]


def check_variable(model: Model, node: Node) -> Iterator[Finding]:
    """Report a feature that is declared variable although it cannot be."""
    if node.attributes.get("isVariable") is not True:
        return
    owner = find_owning_type(node)
    facts = {"name": name_of(model, node), "owner": name_of(model, node.owner)}
    if node.attributes.get("isPortion"):
        yield Finding(VARIABLE_PORTION, node.start, facts)
    elif owner is None or not model.specializes(owner, "Occurrences::Occurrence"):
        yield Finding(VARIABLE_ELSEWHERE, node.start, facts)


def check_import(model: Model, node: Node) -> Iterator[Finding]:
    """Report a visible import of the root namespace."""
    is_at_top = node.owner is not None and node.owner.owner is None
    if is_at_top and node.visibility != "private" and node.relations:
        yield Finding(ROOT_IMPORT, node.start, {"name": str(node.relations[0].reference)})


CHECKS = ((_FUNCTIONS, check_result), (DECLARED_FEATURES, check_variable), (_IMPORTS, check_import))


# -- members that may occur once ---------------------------------------------------------------


def check_own_members(model: Model, node: Node) -> Iterator[Finding]:
    """Report members that occur twice, and a subject after other parameters."""
    seen_roles: set[str] = set()
    parameters = 0
    for member in node.members:
        role = _find_single_role(member)
        owner = {"owner": name_of(model, node)}
        if role in seen_roles:
            yield Finding(ONLY_ONE, member.start, {**owner, "role": role}, member)
        elif role == "subject" and parameters:
            yield Finding(SUBJECT_FIRST, member.start, owner, member)
        if role:
            seen_roles.add(role)
        parameters += role in ("", "subject") and "direction" in member.attributes


def _find_single_role(member: Node) -> str:
    if member.membership == "StateSubactionMembership":
        return f"{member.role} action"
    return _ROLES_BY_MEMBERSHIP.get(member.membership, "")


def check_objective(model: Model, node: Node) -> Iterator[Finding]:
    """Report a case with an inherited objective and another one.

    ``check_own_members`` reports several owned objectives.
    """
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


SINGLE_MEMBER_CHECKS = ((_CASES, check_objective), (_WITH_SUBJECT, check_subject))
