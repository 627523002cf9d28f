"""What usages may reference, redefine and specialise."""

from collections.abc import Iterator, Mapping

from sysmlc.diagnostics import Rule, Sink
from sysmlc.language.checks import member_rules, reference_rules
from sysmlc.language.checks.found import written
from sysmlc.language.metaclasses import describe_kind, is_composite, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, Relation, make_subject

_REFERENCED = {
    "IncludeUseCaseUsage": (kinds_of("UseCaseUsage"), "a use case"),
    "ExhibitStateUsage": (kinds_of("StateUsage"), "a state"),
    "PerformActionUsage": (kinds_of("Step"), "an action"),
    "EventOccurrenceUsage": (kinds_of("OccurrenceUsage") | kinds_of("Step"), "an occurrence"),
}
_USAGES = kinds_of("Usage")
_PORT_OWNERS = kinds_of("PortDefinition") | kinds_of("PortUsage")
RELATIONS = frozenset({"ReferenceSubsetting", "Redefinition", "Subsetting", "FeatureTyping"})
"""Relations that are checked."""
_DIRECTED = ("in", "out")
_Broken = tuple[Rule, Mapping[str, str | None]]
"""A rule, and the facts of its phrase."""


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report references to what has another kind, direction or place than they need."""
    is_variation = bool(node.attributes.get("isVariation"))
    for relation, target in written(node, RELATIONS):
        broken: list[_Broken] = []
        if relation.kind == "ReferenceSubsetting":
            broken += _of_other_kind(node, relation, target)
        elif relation.kind == "Redefinition" and _turns(model, node, target):
            owner = model.name(target.owner) if target.owner else ""
            name = str(relation.reference)
            broken.append((reference_rules.OTHER_DIRECTION, {"name": name, "owner": owner}))
        if is_variation and target.attributes.get("isVariation"):
            itself = {"name": model.name(node) or node.kind, "owner": ""}
            broken.append((member_rules.VARIATION_OF_VARIATION, itself))
        for rule, facts in broken:
            place = make_subject(document, node, relation.reference.start)
            sink.report(rule, place, notes=(), help="", **facts)


def _of_other_kind(node: Node, relation: Relation, target: Node) -> Iterator[_Broken]:
    kinds, words = _REFERENCED.get(node.kind, (_USAGES, ""))
    if target.kind in _USAGES and target.kind not in kinds:
        name = str(relation.reference)
        yield (
            reference_rules.OTHER_KIND,
            {"name": name, "found": describe_kind(target), "wanted": words},
        )


def _turns(model: Model, node: Node, target: Node) -> bool:
    """Whether a redefining feature has another direction than the one that it redefines."""
    theirs, ours = target.attributes.get("direction"), node.attributes.get("direction")
    return theirs in _DIRECTED and ours not in (None, theirs) and not _is_conjugated(model, node)


def _is_conjugated(model: Model, node: Node) -> bool:
    """Whether the owner, or what it specialises, turns directions around."""
    supers = model.all_supertypes(node.owner) if node.owner is not None else ()
    return any(r.kind == "ConjugatedPortTyping" for one in supers for r in one.relations)


def check_itself(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report a part of a port, and an individual that is of none or of several."""
    owner, name = node.owner, node.name or node.kind
    is_in_port = owner is not None and owner.kind in _PORT_OWNERS
    if is_in_port and node.kind != "PortUsage" and is_composite(node):
        place = make_subject(document, node, node.start)
        sink.report(reference_rules.PART_OF_PORT, place, name=name, owner=_name(model, owner))
    if node.attributes.get("isIndividual") and any(
        r.kind == "FeatureTyping" for r in node.relations
    ):
        types = [one for one in model.types(node) if one.attributes.get("isIndividual")]
        if len(types) != 1:
            place = make_subject(document, node, node.start)
            sink.report(reference_rules.INDIVIDUAL, place, name=name, count=len(types))


def _name(model: Model, node: Node | None) -> str:
    return (model.name(node) or node.kind) if node is not None else ""
