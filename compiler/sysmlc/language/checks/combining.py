"""How types are made of others: unions, chains, conjugates, references, multiplicities."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import DECLARED_TYPES, Found, name_of, written
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node, Relation

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
    "'{name}' references '{general}' too",
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
    "'{name}' is the conjugate of another type, and specialises '{general}' too",
    help="let a type that specialises both have what is needed",
)

_MADE = {
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


def check_operands(model: Model, node: Node) -> Iterator[Found]:
    """Report a type that is made of one other only, or of itself."""
    for kind, made in _MADE.items():
        operands = [one for one in node.relations if one.kind == kind]
        for relation in operands:
            target = relation.reference.target
            name, general = name_of(model, node), name_of(model, target)
            facts = {"name": name, "made": made, "general": general}
            if target is node:
                yield Found(ITSELF, _place(relation), facts)
            elif kind != "Conjugation" and len(operands) == 1:
                yield Found(ALONE, relation.reference.start, facts)


def _place(relation: Relation) -> int:
    """Where the name stands; links of a chain have all the place of the chain, the last its end."""
    reference = relation.reference
    if relation.kind == "FeatureChaining" and reference.start >= 0:
        return reference.end - len(reference.chain[-1][-1])
    return reference.start


def check_reference(model: Model, node: Node) -> Iterator[Found]:
    """Report the references of a feature after its first."""
    for relation, target in list(written(node, _REFERENCE))[1:]:
        facts = {"name": name_of(model, node), "general": name_of(model, target)}
        yield Found(SECOND_REFERENCE, relation.reference.start, facts)


def check_multiplicity(model: Model, node: Node) -> Iterator[Found]:
    """Report the multiplicities of a type after its first."""
    for member in [m for m in node.members if m.kind in _MULTIPLICITIES][1:]:
        yield Found(SECOND_MULTIPLICITY, member.start, {"name": name_of(model, node)})


def check_conjugate(model: Model, node: Node) -> Iterator[Found]:
    """Report what a conjugated type specialises."""
    for relation, target in written(node, _SPECIALIZATIONS):
        facts = {"name": name_of(model, node), "general": name_of(model, target)}
        yield Found(CONJUGATED, relation.reference.start, facts)


def check_apart(model: Model, node: Node) -> Iterator[Found]:
    """Report a specialisation that stands for itself and is one of a conjugated type."""
    for relation, special in written(node, _SPECIFIC):
        if any(True for _ in written(special, _CONJUGATION)):
            for _, general in written(node, _GENERAL):
                facts = {"name": name_of(model, special), "general": name_of(model, general)}
                yield Found(CONJUGATED, relation.reference.start, facts)


CHECKS = ((DECLARED_TYPES, check_multiplicity),)
BY_RELATION = (
    (frozenset(_MADE), check_operands),
    (_REFERENCE, check_reference),
    (_CONJUGATION, check_conjugate),
    (_SPECIFIC, check_apart),
)
