"""What a namespace owns by name: declared names, short names, aliases, effective names."""

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.tree import Node, Reference

Owned = dict[str, list[Node]]
"""Members of one namespace by name; an alias stands for the element that it names."""

_REFERRING = frozenset(
    {
        "AssertConstraintUsage",
        "EventOccurrenceUsage",
        "ExhibitStateUsage",
        "IncludeUseCaseUsage",
        "PerformActionUsage",
        "SatisfyRequirementUsage",
    }
)
"""Usages named by what they reference (SysML 8.3.6.4 and the namingFeature of each)."""
_REFERRING_MEMBERSHIPS = frozenset(
    {
        "FramedConcernMembership",
        "RequirementConstraintMembership",
        "RequirementVerificationMembership",
        "VariantMembership",
        "ViewRenderingMembership",
    }
)
FEATURES = kinds_of("Feature")
TYPES = kinds_of("Type")
NAMESPACES = kinds_of("Namespace")


def owned(node: Node) -> Owned:
    """The index of the members of ``node`` by their names.

    A feature without a name is found by the last name of its naming reference (KerML 8.3.3.3.4,
    effectiveName): what that leads to is looked up only when somebody asks.
    """
    index: Owned = {}
    for member in node.members:
        name, short = member.name, member.short_name
        if name is None and short is None:
            reference = naming(member)
            if reference is not None:
                index.setdefault(reference.chain[-1][-1], []).append(member)
            continue
        if name is not None:
            index.setdefault(name, []).append(member)
        if short is not None and short != name:
            index.setdefault(short, []).append(member)
    if node.kind == "TransitionUsage":
        _add_payload(index, node)
    return index


def _add_payload(index: Owned, transition: Node) -> None:
    """What a transition accepts is known in its guard and effect (SysML 8.3.17.9)."""
    payload, accepted = payload_of(transition)
    if payload is not None and accepted is not None:
        for name in (accepted.name, accepted.short_name):
            if name is not None:
                index.setdefault(name, []).append(payload)


def payload_of(transition: Node) -> tuple[Node | None, Node | None]:
    """The payload parameter of a transition and that of the accept action that triggers it."""
    parameters = [m for m in transition.members if m.membership == "ParameterMembership"]
    trigger = next((m for m in transition.members if m.role == "trigger"), None)
    accepted = trigger.members[0] if trigger is not None and trigger.members else None
    return (parameters[1] if len(parameters) > 1 else accepted), accepted


def naming(node: Node) -> Reference | None:
    """The reference to the feature that gives a nameless one its name, if the text has one."""
    if node.kind not in FEATURES or not node.relations:
        return None
    if node.kind in _REFERRING or node.membership in _REFERRING_MEMBERSHIPS:
        for relation in node.relations:
            if relation.kind == "ReferenceSubsetting":
                return relation.reference
    for relation in node.relations:
        if relation.kind == "Redefinition":
            return relation.reference
    return None
