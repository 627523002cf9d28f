"""Constraints of the specification about what usages reference and redefine."""

from collections.abc import Iterator, Mapping

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.language.checks import memberships
from sysmlc.language.checks.findings import iter_stated
from sysmlc.language.metaclasses import describe_kind, is_composite, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, Relation, make_subject

OTHER_KIND = rule(
    "SM236",
    "references-other-kind",
    Severity.ERROR,
    "'{name}' is {found}, and {wanted} is needed here",
    help="reference {wanted}",
)
PART_OF_PORT = rule(
    "SM237",
    "part-of-port",
    Severity.ERROR,
    "'{name}' is a part of the port '{owner}'",
    help="write 'ref' before it, or give it a direction",
)
OTHER_DIRECTION = rule(
    "SM238",
    "other-direction",
    Severity.ERROR,
    "'{name}' has another direction where it is defined, in '{owner}'",
    help="use the same direction, or none",
)
INDIVIDUAL = rule(
    "SM239",
    "individual-types",
    Severity.ERROR,
    "the individual '{name}' has {count} individual definitions and must have one",
    help="type it by one 'individual def'",
)


_REFERENCED_KINDS = {
    "IncludeUseCaseUsage": (kinds_of("UseCaseUsage"), "a use case"),
    "ExhibitStateUsage": (kinds_of("StateUsage"), "a state"),
    "PerformActionUsage": (kinds_of("Step"), "an action"),
    "EventOccurrenceUsage": (kinds_of("OccurrenceUsage") | kinds_of("Step"), "an occurrence"),
}
_USAGES = kinds_of("Usage")
_PORT_OWNERS = kinds_of("PortDefinition") | kinds_of("PortUsage")
RELATIONS = frozenset({"ReferenceSubsetting", "Redefinition", "Subsetting", "FeatureTyping"})
"""Kinds of relations that are checked."""
_DIRECTIONS = ("in", "out")
_Broken = tuple[Rule, Mapping[str, str | None]]
"""A rule, and the facts of its phrase."""


def check_references(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report references to elements of another kind, direction or variation than required."""
    is_variation = bool(node.attributes.get("isVariation"))
    for relation, target in iter_stated(node, RELATIONS):
        broken: list[_Broken] = []
        if relation.kind == "ReferenceSubsetting":
            broken += _find_other_kind(node, relation, target)
        elif relation.kind == "Redefinition" and _has_other_direction(model, node, target):
            owner = model.name(target.owner) if target.owner else ""
            name = str(relation.reference)
            broken.append((OTHER_DIRECTION, {"name": name, "owner": owner}))
        # Usages; `specializations` checks definitions.
        if is_variation and target.attributes.get("isVariation"):
            facts_of_node = {"name": model.name(node) or node.kind, "owner": ""}
            broken.append((memberships.VARIATION_OF_VARIATION, facts_of_node))
        for broken_rule, facts in broken:
            place = make_subject(document, node, relation.reference.start)
            sink.report(broken_rule, place, notes=(), help="", **facts)


def _find_other_kind(node: Node, relation: Relation, target: Node) -> Iterator[_Broken]:
    kinds, words = _REFERENCED_KINDS.get(node.kind, (_USAGES, ""))
    if target.kind in _USAGES and target.kind not in kinds:
        name = str(relation.reference)
        yield (
            OTHER_KIND,
            {"name": name, "found": describe_kind(target), "wanted": words},
        )


def _has_other_direction(model: Model, node: Node, target: Node) -> bool:
    """Whether a redefining feature has another direction than the redefined one."""
    general_direction, own_direction = (
        target.attributes.get("direction"),
        node.attributes.get("direction"),
    )
    return (
        general_direction in _DIRECTIONS
        and own_direction not in (None, general_direction)
        and not _is_conjugated(model, node)
    )


def _is_conjugated(model: Model, node: Node) -> bool:
    """Whether the owner, or a general of it, is conjugated."""
    supers = model.all_supertypes(node.owner) if node.owner is not None else ()
    return any(
        relation.kind == "ConjugatedPortTyping"
        for general in supers
        for relation in general.relations
    )


def check_usage(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report a part of a port, and an individual with none or several individual types."""
    owner, name = node.owner, node.name or node.kind
    is_in_port = owner is not None and owner.kind in _PORT_OWNERS
    if is_in_port and node.kind != "PortUsage" and is_composite(node):
        place = make_subject(document, node, node.start)
        sink.report(PART_OF_PORT, place, name=name, owner=_name_of(model, owner))
    if node.attributes.get("isIndividual") and any(
        relation.kind == "FeatureTyping" for relation in node.relations
    ):
        types = [type_ for type_ in model.types(node) if type_.attributes.get("isIndividual")]
        if len(types) != 1:
            place = make_subject(document, node, node.start)
            sink.report(INDIVIDUAL, place, name=name, count=len(types))


def _name_of(model: Model, node: Node | None) -> str:
    return (model.name(node) or node.kind) if node is not None else ""
