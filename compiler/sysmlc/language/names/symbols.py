"""Symbol tables: the members of one namespace by declared, short and effective name."""

from sysmlc.language.metaclasses import FEATURES
from sysmlc.language.tree import Node, Reference, list_arguments

SymbolTable = dict[str, list[Node]]
"""Members of one namespace by name. The entry of an alias is its Membership node."""

_NAMED_BY_REFERENCE = frozenset(
    {
        "AssertConstraintUsage",
        "EventOccurrenceUsage",
        "ExhibitStateUsage",
        "IncludeUseCaseUsage",
        "PerformActionUsage",
        "SatisfyRequirementUsage",
    }
)
"""Usages with the name of the feature that they reference (SysML 8.3.6.4, namingFeature)."""
_MEMBERSHIPS_NAMED_BY_REFERENCE = frozenset(
    {
        "FramedConcernMembership",
        "RequirementConstraintMembership",
        "RequirementVerificationMembership",
        "VariantMembership",
        "ViewRenderingMembership",
    }
)


def build_symbol_table(node: Node) -> SymbolTable:
    """Return the members of ``node`` by name.

    A feature without a name is entered under the last name of its naming reference (KerML
    8.3.3.3.4, effectiveName). The reference itself is resolved only when the feature is looked up.
    """
    index: SymbolTable = {}
    for member in node.members:
        name, short = member.name, member.short_name
        if name is None and short is None:
            reference = find_naming_reference(member)
            if reference is not None:
                index.setdefault(reference.chain[-1][-1], []).append(member)
            continue
        if name is not None:
            index.setdefault(name, []).append(member)
        if short is not None and short != name:
            index.setdefault(short, []).append(member)
    if node.kind == "TransitionUsage":
        _add_accepted_payload(index, node)
    return index


def _add_accepted_payload(index: SymbolTable, transition: Node) -> None:
    """Enter the payload of a transition, which guard and effect may name (SysML 8.3.17.9)."""
    payload, accepted = find_payload(transition)
    if payload is not None and accepted is not None:
        for name in (accepted.name, accepted.short_name):
            if name is not None:
                index.setdefault(name, []).append(payload)


def find_payload(transition: Node) -> tuple[Node | None, Node | None]:
    """Return the payload parameters of a transition and of the accept action that triggers it."""
    parameters = list_arguments(transition)
    trigger = next((member for member in transition.members if member.role == "trigger"), None)
    accepted = trigger.members[0] if trigger is not None and trigger.members else None
    return (parameters[1] if len(parameters) > 1 else accepted), accepted


def find_naming_reference(node: Node) -> Reference | None:
    """Return the reference to the feature that names a nameless feature, if any."""
    if node.kind not in FEATURES or not node.relations:
        return None
    relation = None
    if node.kind in _NAMED_BY_REFERENCE or node.membership in _MEMBERSHIPS_NAMED_BY_REFERENCE:
        relation = node.find_relation("ReferenceSubsetting")
    relation = relation or node.find_relation("Redefinition")
    return relation.reference if relation else None
