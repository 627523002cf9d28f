"""Types that specialise, unite or conjugate others, and types of usages (KerML 8.3.3, 8.3.4)."""

from collections.abc import Iterator
from typing import NamedTuple

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.findings import DECLARED_TYPES, Finding, iter_stated, name_of
from sysmlc.language.checks.memberships import VARIATION_OF_VARIATION
from sysmlc.language.checks.references import refers_to_other_kind
from sysmlc.language.metaclasses import ALL_GENERALS, FEATURES, USAGES, describe_kind, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node, Relation

OTHER_KIND = rule(
    "SM259",
    "specialises-other-kind",
    Severity.ERROR,
    "'{name}', {kind}, cannot specialise '{general}', {found}",
    help="specialise {wanted}, or have a feature of that type",
)

_DATA = kinds_of("DataType")
_CLASSES = kinds_of("Class")
_LINKS = kinds_of("Association")
_STRUCTURES = kinds_of("Structure")
_BEHAVIORS = kinds_of("Behavior")
_SUBCLASSIFICATION = frozenset({"Subclassification"})


class Exclusion(NamedTuple):
    """Metaclasses that cannot specialise the excluded ones; in words, what they can specialise."""

    kinds: frozenset[str]
    excluded: frozenset[str]
    wanted: str


# Associations are classes too where they are structures, so links appear on both sides.
_EXCLUSIONS = (
    Exclusion(_DATA, _CLASSES | _LINKS, "an attribute definition or data type"),
    Exclusion(_CLASSES - _LINKS, _DATA | _LINKS, "an item, part, port, action or another class"),
    Exclusion(_CLASSES & _LINKS, _DATA, "an item, part, connection or another class"),
    Exclusion(_STRUCTURES, _BEHAVIORS, "an item, part, port or another structure"),
    Exclusion(_BEHAVIORS, _STRUCTURES, "an action or another behaviour"),
)


def check_other_kind(model: Model, node: Node) -> Iterator[Finding]:
    """Report generals that can have no common instance with ``node``."""
    for relation, target in iter_stated(node, _SUBCLASSIFICATION):
        for exclusion in _EXCLUSIONS:
            if node.kind in exclusion.kinds and target.kind in exclusion.excluded:
                facts = {
                    "name": name_of(model, node),
                    "kind": describe_kind(node),
                    "general": name_of(model, target),
                    "found": describe_kind(target),
                    "wanted": exclusion.wanted,
                }
                yield Finding(OTHER_KIND, relation.reference.start, facts)


def check_variation(model: Model, node: Node) -> Iterator[Finding]:
    """Report a variation that specialises another; ``references`` checks usages."""
    for relation, target in iter_stated(node, _SUBCLASSIFICATION):
        is_closed = target.attributes.get("isVariation") or target.kind == "EnumerationDefinition"
        if node.attributes.get("isVariation") and is_closed:
            facts = {"name": name_of(model, node), "owner": ""}
            yield Finding(VARIATION_OF_VARIATION, relation.reference.start, facts)


ALONE = rule(
    "SM254",
    "one-operand",
    Severity.ERROR,
    "'{name}' is {made} '{general}' alone",
    help="name a second one, or specialise '{general}'",
)
ITSELF = rule(
    "SM255",
    "operand-itself",
    Severity.ERROR,
    "'{name}' is {made} itself",
    help="take '{name}' out of its own definition",
)
SECOND_REFERENCE = rule(
    "SM256",
    "several-references",
    Severity.ERROR,
    "'{name}' already references another feature, so it cannot reference '{general}'",
    help="keep one 'references', and write 'subsets' for the others",
)
SECOND_MULTIPLICITY = rule(
    "SM257",
    "several-multiplicities",
    Severity.ERROR,
    "'{name}' has a second multiplicity",
    help="keep one of them",
)
CONJUGATED = rule(
    "SM258",
    "conjugate-specialises",
    Severity.ERROR,
    "'{name}' is the conjugate of another type but specialises '{general}' too",
    help="define another type that specialises both",
)

_COMPOSITIONS = {
    "Unioning": "the union of",
    "Intersecting": "the intersection of",
    "Differencing": "the difference of",
    "FeatureChaining": "a chain of",
    "Conjugation": "the conjugate of",
}
_CONJUGATION = frozenset({"Conjugation"})
_REFERENCE = frozenset({"ReferenceSubsetting"})
_SPECIALIZATIONS = kinds_of("Specialization")
_MULTIPLICITIES = kinds_of("Multiplicity")
_SPECIFIC = frozenset({"specific", "subclassifier", "subsettingFeature", "redefiningFeature"})
_GENERAL = frozenset({"general", "superclassifier", "subsettedFeature", "redefinedFeature"})


def check_operands(model: Model, node: Node) -> Iterator[Finding]:
    """Report a type that is composed of one other type only, or of itself."""
    for kind, composition in _COMPOSITIONS.items():
        operands = [relation for relation in node.relations if relation.kind == kind]
        for relation in operands:
            target = relation.reference.target
            name, general = name_of(model, node), name_of(model, target)
            facts = {"name": name, "made": composition, "general": general}
            if target is node:
                yield Finding(ITSELF, _find_offset(relation), facts)
            elif kind != "Conjugation" and len(operands) == 1:
                yield Finding(ALONE, relation.reference.start, facts)


def _find_offset(relation: Relation) -> int:
    """Return the offset of a name. Links of a chain have the offset of the whole chain."""
    reference = relation.reference
    if relation.kind == "FeatureChaining" and reference.start >= 0:
        return reference.end - len(reference.chain[-1][-1])
    return reference.start


def check_reference(model: Model, node: Node) -> Iterator[Finding]:
    """Report the references of a feature after its first."""
    for relation, target in list(iter_stated(node, _REFERENCE))[1:]:
        facts = {"name": name_of(model, node), "general": name_of(model, target)}
        yield Finding(SECOND_REFERENCE, relation.reference.start, facts)


def check_multiplicity(model: Model, node: Node) -> Iterator[Finding]:
    """Report the multiplicities of a type after its first."""
    for member in [member for member in node.members if member.kind in _MULTIPLICITIES][1:]:
        yield Finding(SECOND_MULTIPLICITY, member.start, {"name": name_of(model, node)})


def check_conjugate(model: Model, node: Node) -> Iterator[Finding]:
    """Report generals of a conjugated type."""
    for relation, target in iter_stated(node, _SPECIALIZATIONS):
        facts = {"name": name_of(model, node), "general": name_of(model, target)}
        yield Finding(CONJUGATED, relation.reference.start, facts)


def check_separate_specialization(model: Model, node: Node) -> Iterator[Finding]:
    """Report a separately declared specialisation whose specific type is conjugated."""
    for relation, special in iter_stated(node, _SPECIFIC):
        if any(True for _ in iter_stated(special, _CONJUGATION)):
            for _, general in iter_stated(node, _GENERAL):
                facts = {"name": name_of(model, special), "general": name_of(model, general)}
                yield Finding(CONJUGATED, relation.reference.start, facts)


CHECKS = ((DECLARED_TYPES, check_multiplicity),)
BY_RELATION = (
    (frozenset(_COMPOSITIONS), check_operands),
    (_REFERENCE, check_reference),
    (_CONJUGATION, check_conjugate),
    (_SPECIFIC, check_separate_specialization),
    (_SUBCLASSIFICATION, check_other_kind),
    (_SUBCLASSIFICATION, check_variation),
)


# -- types of usages ---------------------------------------------------------------------------

TYPED_BY = rule(
    "SM221",
    "usage-type",
    Severity.ERROR,
    "{usage} must be typed by {wanted}, but '{type}' is {found}",
    help="use {wanted} as the type",
)
ONE_TYPE = rule(
    "SM222",
    "usage-one-type",
    Severity.ERROR,
    "{usage} must be typed by one definition, but has {types}",
    help="keep one of them, or let one specialise the other",
)


class Requirement(NamedTuple):
    """Kinds that the types of a usage must have, in words, and whether only one type is valid."""

    kinds: frozenset[str]
    words: str
    single: bool = False


_REQUIREMENTS = {
    general: Requirement(kinds_of(kind), words, words.startswith(("a ", "an ")))
    for general, kind, words in (
        ("EnumerationUsage", "EnumerationDefinition", "an enumeration definition"),
        ("AttributeUsage", "DataType", "attribute definitions"),
        ("AllocationUsage", "AllocationDefinition", "allocation definitions"),
        ("InterfaceUsage", "InterfaceDefinition", "interface definitions"),
        ("FlowUsage", "Interaction", "flow definitions"),
        ("ConnectionUsage", "Association", "connection definitions"),
        ("MetadataUsage", "Metaclass", "a metadata definition"),
        ("ViewUsage", "ViewDefinition", "a view definition"),
        ("RenderingUsage", "RenderingDefinition", "a rendering definition"),
        ("PortUsage", "PortDefinition", "port definitions"),
        ("ViewpointUsage", "ViewpointDefinition", "a viewpoint definition"),
        ("ConcernUsage", "ConcernDefinition", "a concern definition"),
        ("RequirementUsage", "RequirementDefinition", "a requirement definition"),
        ("ConstraintUsage", "Predicate", "a constraint definition"),
        ("AnalysisCaseUsage", "AnalysisCaseDefinition", "an analysis definition"),
        ("VerificationCaseUsage", "VerificationCaseDefinition", "a verification definition"),
        ("UseCaseUsage", "UseCaseDefinition", "a use case definition"),
        ("CaseUsage", "CaseDefinition", "a case definition"),
        ("CalculationUsage", "Function", "a calculation definition"),
        ("StateUsage", "Behavior", "state definitions"),
        ("ActionUsage", "Behavior", "action definitions"),
        ("OccurrenceUsage", "Class", "occurrence, item or part definitions"),
        ("ReferenceUsage", "Classifier", "definitions"),
    )
}
"""The requirement of usages of a kind; the first kind that a usage specialises counts."""
# Bindings and successions are connectors too, and their types are not restricted.
_TYPED = (USAGES - kinds_of("Connector")) | kinds_of("ConnectionUsage") | kinds_of("FlowUsage")
_REQUIREMENT_BY_KIND = {
    kind: next(
        requirement
        for general, requirement in _REQUIREMENTS.items()
        if general in ALL_GENERALS[kind]
    )
    for kind in _TYPED - {"Usage"}
}
TYPING_RELATIONS = frozenset({"FeatureTyping", "Subsetting", "ReferenceSubsetting", "Redefinition"})
"""Relations that determine types."""
TYPED_KINDS = frozenset(_REQUIREMENT_BY_KIND)
"""Metaclasses of usages that are checked."""


def check_types(model: Model, node: Node) -> Iterator[Finding]:
    """Report a usage whose types do not meet the requirement of its kind."""
    requirement = _REQUIREMENT_BY_KIND.get(node.kind)
    if requirement is None or not _is_resolved(node) or refers_to_other_kind(node):
        return
    types = _list_types(model, node)
    unsuitable = next((type_ for type_ in types if type_.kind not in requirement.kinds), None)
    name = model.name(node)
    usage = f"{describe_kind(node).partition(' ')[2]} '{name}'" if name else describe_kind(node)
    if unsuitable is not None:
        found, type_name = describe_kind(unsuitable), model.name(unsuitable)
        keyword = found.partition(" ")[2]
        advice = (
            f"write '{keyword} def {type_name}' to declare a type, or ':> {type_name}' for a usage "
            "that is one of these"
        )
        facts = {"usage": usage, "wanted": requirement.words, "type": type_name, "found": found}
        help_ = advice if unsuitable.kind.endswith("Usage") else ""
        yield Finding(TYPED_BY, node.start, facts, help=help_)
    elif requirement.single and len(types) > 1:
        names = " and ".join(f"'{model.name(type_)}'" for type_ in types)
        yield Finding(ONE_TYPE, node.start, {"usage": usage, "types": names})


def _is_resolved(node: Node) -> bool:
    """Whether all relations that determine types are resolved."""
    for relation in node.relations:
        if relation.kind in TYPING_RELATIONS and relation.reference.target is None:
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
