"""Types of usages: definitions of the kind of the usage."""

from typing import NamedTuple

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.language.metaclasses import ALL_GENERALS, FEATURES, describe_kind, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, make_subject

TYPED_BY = rule(
    "SM221",
    "usage-type",
    Severity.ERROR,
    "{usage} must be typed by {wanted}, and '{type}' is {found}",
    help="use {wanted} as the type",
)
ONE_TYPE = rule(
    "SM222",
    "usage-one-type",
    Severity.ERROR,
    "{usage} must be typed by one definition, and has {types}",
    help="keep one of them, or let one specialise the other",
)


class Requirement(NamedTuple):
    """Kinds that the types of a usage must have, in words, and whether only one type is valid."""

    kinds: frozenset[str]
    words: str
    single: bool = False


_REQUIREMENTS: tuple[tuple[str, Requirement], ...] = (
    (
        "EnumerationUsage",
        Requirement(kinds_of("EnumerationDefinition"), "an enumeration definition", True),
    ),
    ("AttributeUsage", Requirement(kinds_of("DataType"), "attribute definitions")),
    ("AllocationUsage", Requirement(kinds_of("AllocationDefinition"), "allocation definitions")),
    ("InterfaceUsage", Requirement(kinds_of("InterfaceDefinition"), "interface definitions")),
    ("FlowUsage", Requirement(kinds_of("Interaction"), "flow definitions")),
    ("ConnectionUsage", Requirement(kinds_of("Association"), "connection definitions")),
    ("MetadataUsage", Requirement(kinds_of("Metaclass"), "a metadata definition", True)),
    ("ViewUsage", Requirement(kinds_of("ViewDefinition"), "a view definition", True)),
    (
        "RenderingUsage",
        Requirement(kinds_of("RenderingDefinition"), "a rendering definition", True),
    ),
    ("PortUsage", Requirement(kinds_of("PortDefinition"), "port definitions")),
    (
        "ViewpointUsage",
        Requirement(kinds_of("ViewpointDefinition"), "a viewpoint definition", True),
    ),
    ("ConcernUsage", Requirement(kinds_of("ConcernDefinition"), "a concern definition", True)),
    (
        "RequirementUsage",
        Requirement(kinds_of("RequirementDefinition"), "a requirement definition", True),
    ),
    ("ConstraintUsage", Requirement(kinds_of("Predicate"), "a constraint definition", True)),
    (
        "AnalysisCaseUsage",
        Requirement(kinds_of("AnalysisCaseDefinition"), "an analysis definition", True),
    ),
    (
        "VerificationCaseUsage",
        Requirement(kinds_of("VerificationCaseDefinition"), "a verification definition", True),
    ),
    ("UseCaseUsage", Requirement(kinds_of("UseCaseDefinition"), "a use case definition", True)),
    ("CaseUsage", Requirement(kinds_of("CaseDefinition"), "a case definition", True)),
    ("CalculationUsage", Requirement(kinds_of("Function"), "a calculation definition", True)),
    ("StateUsage", Requirement(kinds_of("Behavior"), "state definitions")),
    ("ActionUsage", Requirement(kinds_of("Behavior"), "action definitions")),
    ("OccurrenceUsage", Requirement(kinds_of("Class"), "occurrence, item or part definitions")),
    ("ReferenceUsage", Requirement(kinds_of("Classifier"), "definitions")),
)


def _find_requirements() -> dict[str, Requirement]:
    """Return the requirement of each metaclass of usages: the first row with a general of it."""
    requirements: dict[str, Requirement] = {}
    for kind in kinds_of("Usage") - kinds_of("Connector"):
        for general, requirement in _REQUIREMENTS:
            if general in ALL_GENERALS[kind]:
                requirements[kind] = requirement
                break
    # Bindings and successions are connectors too, and their types are not restricted.
    connectors = kinds_of("ConnectionUsage") | kinds_of("FlowUsage")
    for kind in connectors:
        requirements[kind] = next(w for g, w in _REQUIREMENTS if g in ALL_GENERALS[kind])
    return requirements


_REQUIREMENT_BY_KIND = _find_requirements()
RELATIONS = frozenset({"FeatureTyping", "Subsetting", "ReferenceSubsetting", "Redefinition"})
"""Relations that determine types."""


KINDS = frozenset(_REQUIREMENT_BY_KIND)
"""Metaclasses of usages that are checked."""


def check_types(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report a usage whose types do not meet the requirement of its kind."""
    requirement = _REQUIREMENT_BY_KIND.get(node.kind)
    if requirement is None or not _is_resolved(node):
        return
    types = _list_types(model, node)
    if all(type_.kind in requirement.kinds for type_ in types) and not (
        requirement.single and len(types) > 1
    ):
        return
    place = make_subject(document, node, node.start)
    name = model.name(node)
    usage = f"{describe_kind(node).partition(' ')[2]} '{name}'" if name else describe_kind(node)
    for type_ in types:
        if type_.kind not in requirement.kinds:
            sink.report(
                TYPED_BY,
                place,
                usage=usage,
                wanted=requirement.words,
                type=model.name(type_),
                found=describe_kind(type_),
            )
            return
    if requirement.single and len(types) > 1:
        names = " and ".join(f"'{model.name(type_)}'" for type_ in types)
        sink.report(ONE_TYPE, place, usage=usage, types=names)


def _is_resolved(node: Node) -> bool:
    """Whether all relations that determine types are resolved."""
    for relation in node.relations:
        if relation.kind in RELATIONS and relation.reference.target is None:
            return False
    return True


def _list_types(model: Model, node: Node) -> list[Node]:
    """Return the types of a usage; a feature that is used as a type is among them."""
    usages = [
        relation.reference.target
        for relation in node.relations
        if relation.kind == "FeatureTyping" and relation.reference.target is not None
    ]
    features = [usage for usage in usages if usage.kind in FEATURES]
    return features or model.types(node)
