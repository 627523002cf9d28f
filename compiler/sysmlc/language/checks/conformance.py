"""Conformance of features to what they subset or redefine, and their multiplicities.

KerML 8.3.3.3. The bounds of a multiplicity are valid, and conform to those of general features.
"""

from collections.abc import Iterator
from math import inf
from typing import NamedTuple

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.expressions import evaluate_constant, is_incompatible
from sysmlc.language.checks.findings import DECLARED_FEATURES, Finding, iter_stated, name_of
from sysmlc.language.checks.references import OTHER_DIRECTION
from sysmlc.language.metaclasses import USAGES, is_end, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.generals import GENERALIZATION_KINDS
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node
from sysmlc.support.counts import count

NONUNIQUE = rule(
    "SM250",
    "nonunique-subset",
    Severity.ERROR,
    "'{name}' is nonunique, but '{general}' is unique",
    help="remove 'nonunique', or add it to '{general}' too",
)
NOT_CONSTANT = rule(
    "SM251",
    "variable-subset",
    Severity.ERROR,
    "'{name}' is variable, but '{general}' is constant",
    help="write 'const' instead of 'var'",
)
NO_END = rule(
    "SM252",
    "redefined-end",
    Severity.ERROR,
    "'{name}' is not an end, but '{general}', which it redefines, is an end",
    help="write 'end' before it",
)
OF_PACKAGE = rule(
    "SM278",
    "redefines-package-feature",
    Severity.ERROR,
    "'{general}' is not a feature of a type, so '{name}' cannot redefine it",
    help="subset it: write ':>' instead of ':>>'",
)
OF_SAME_OWNER = rule(
    "SM279",
    "redefines-own-feature",
    Severity.ERROR,
    "'{name}' redefines '{general}' of the same owner",
    help="subset it: write ':>' instead of ':>>'",
)

_REDEFINITION = frozenset({"Redefinition"})
_SUBSETTINGS = kinds_of("Subsetting")
_CONJUGATIONS = frozenset({"Conjugation", "ConjugatedPortTyping"})
_CONJUGATED_DIRECTIONS = {"in": "out", "out": "in"}
_KERML_FEATURES = DECLARED_FEATURES - USAGES


def check_conformance(model: Model, node: Node) -> Iterator[Finding]:
    """Report a feature that violates a property of the feature that it subsets or redefines."""
    own, owner = node.attributes, find_owning_type(node)
    is_variable = own.get("isVariable") is True and not own.get("isConstant")
    for relation, target in iter_stated(node, _SUBSETTINGS):
        general, general_owner = target.attributes, find_owning_type(target)
        redefines, is_in_no_type = relation.kind == "Redefinition", owner is general_owner is None
        rules = (
            (NONUNIQUE, own.get("isUnique") is False and general.get("isUnique") is not False),
            (NOT_CONSTANT, is_variable and general.get("isConstant") is True),
            (
                OF_PACKAGE,
                redefines
                and is_in_no_type
                and not (_is_featured(model, node) or _is_featured(model, target)),
            ),
            (OF_SAME_OWNER, redefines and owner is general_owner is not None),
            (NO_END, redefines and is_end(target) and not is_end(node)),
        )
        for broken_rule, is_broken in rules:
            if is_broken:
                facts = {"name": name_of(model, node), "general": name_of(model, target)}
                yield Finding(broken_rule, relation.reference.start, facts)


def _is_featured(model: Model, feature: Node) -> bool:
    """Whether a feature that no type owns is a feature of a type by a TypeFeaturing."""
    if feature.find_relation("TypeFeaturing"):
        return True
    return any(
        relation.reference.target is feature
        for document in model.documents
        for node in model.nodes(document)
        if node.kind == "TypeFeaturing"
        for relation in node.relations
    )


def check_direction(model: Model, node: Node) -> Iterator[Finding]:
    """Report a feature whose direction differs from that of a redefined feature in its owner."""
    scope = find_owning_type(node)
    if scope is None or scope.kind == "FlowEnd":
        return
    own_direction = _find_stated_direction(node)
    for start, target in _iter_redefined(model, node):
        expected = find_direction(model, scope, target)
        if (expected in _CONJUGATED_DIRECTIONS and own_direction != expected) or (
            expected == "inout" and own_direction is None
        ):
            facts = {"name": name_of(model, target), "owner": name_of(model, target.owner)}
            yield Finding(OTHER_DIRECTION, start, facts)


def _iter_redefined(model: Model, node: Node) -> Iterator[tuple[int, Node]]:
    """Yield the redefined features, stated and by position, with the offset of the statement."""
    for relation, target in iter_stated(node, _REDEFINITION):
        yield relation.reference.start, target
    for target in model.lookup.redefined_by_position(node):
        yield node.start, target


def find_direction(model: Model, scope: Node, feature: Node) -> str:
    """Return the direction of a feature as ``scope`` sees it: conjugation reverses it.

    Empty if the feature has none or ``scope`` does not inherit it (KerML 8.3.3.1.10, directionOf).
    """
    stated = _find_stated_direction(feature)
    if stated is None:
        return ""
    worklist = [(scope, False)]
    seen = set(worklist)
    for type_, is_conjugated in worklist:
        if type_ is feature.owner:
            return _CONJUGATED_DIRECTIONS.get(stated, stated) if is_conjugated else stated
        for general, conjugates in _iter_generals(model, type_):
            step = (general, is_conjugated ^ conjugates)
            if step not in seen:
                seen.add(step)
                worklist.append(step)
    return ""


def _iter_generals(model: Model, node: Node) -> Iterator[tuple[Node, bool]]:
    """Yield the direct generals of an element, and whether they are conjugated."""
    for relation in node.relations:
        general = model.target(node, relation) if relation.kind in GENERALIZATION_KINDS else None
        if general is not None:
            yield general, relation.kind in _CONJUGATIONS
    for general in model.needed_generals(node):
        yield general, False


def _find_stated_direction(feature: Node) -> str | None:
    """Return the direction that the text states; that of a result is ``out``."""
    stated = feature.attributes.get("direction")
    is_result = feature.membership == "ReturnParameterMembership"
    return str(stated) if stated is not None else "out" if is_result else None


CHECKS = ((_KERML_FEATURES, check_direction),)
BY_RELATION = ((_SUBSETTINGS, check_conformance),)


# -- multiplicities ----------------------------------------------------------------------------

NOT_NATURAL = rule(
    "SM260",
    "bound-not-natural",
    Severity.ERROR,
    "the multiplicity of '{name}' has a bound that is {found}",
    help="write a whole number that is not negative, or *",
)
BOUND_EXPRESSION = rule(
    "SM253",
    "bound-is-expression",
    Severity.WARNING,
    "the multiplicity of '{name}' has an expression as a bound",
    help="give the expression a name: attribute n = ...; and write [n]",
)

_INSTANTIATIONS = kinds_of("InstantiationExpression")


def check_bound(model: Model, node: Node) -> Iterator[Finding]:
    """Report a bound whose value is known but not a natural number."""
    for bound in node.members:
        value = evaluate_constant(model, bound)
        if value is not None and bound.kind != "LiteralInfinity":
            is_invalid = isinstance(value, str | bool | float) or value < 0
            description = str(value).lower() if isinstance(value, bool) else str(value)
        else:
            is_invalid = is_incompatible(model, bound, "ScalarValues::Integer")
            description = "no number"
        if is_invalid:
            facts = {"name": name_of(model, node.owner), "found": description}
            yield Finding(NOT_NATURAL, bound.start, facts)


def check_notation(model: Model, node: Node) -> Iterator[Finding]:
    """Report a bound that the textual notation does not allow; interchange files may have any."""
    reported = {finding.start for finding in check_bound(model, node)}
    for bound in node.members:
        if bound.kind in _INSTANTIATIONS and bound.start not in reported:
            document = model.document(node)
            # Interchange files have no notation that could be violated.
            if document is not None and document.text:
                yield Finding(BOUND_EXPRESSION, bound.start, {"name": name_of(model, node.owner)})


MULTIPLICITY_CHECKS = (
    (frozenset({"MultiplicityRange"}), check_bound),
    (frozenset({"MultiplicityRange"}), check_notation),
)


MORE = rule(
    "SM281",
    "more-than-general",
    Severity.WARNING,
    "'{name}' may have {own}, but '{general}' has at most {most}",
    help="lower the bound, or raise that of '{general}'",
)
FEWER = rule(
    "SM282",
    "fewer-than-redefined",
    Severity.WARNING,
    "'{name}' may have only {own}, but '{general}', which it redefines, requires at least {least}",
    help="raise the bound, or lower that of '{general}'",
)

_BOUNDED_RELATIONS = frozenset({"Subsetting", "Redefinition"})
_SINGLE = frozenset({"AttributeUsage", "ItemUsage", "PartUsage", "PortUsage"})
"""Usages with the default multiplicity 1 as features of a type (SysML 2.0, 8.3.6.4)."""
_MAX_DEPTH = 20


class Bounds(NamedTuple):
    """The least and the greatest number of values."""

    least: float
    most: float


def check_bounds(model: Model, node: Node) -> Iterator[Finding]:
    """Report bounds that are wider than those of a subsetted or redefined feature."""
    own_bounds = _find_stated_bounds(model, node)
    if own_bounds is None:
        return
    for relation, target in iter_stated(node, _BOUNDED_RELATIONS):
        general_bounds = _find_bounds(model, target)
        if general_bounds is not None:
            names = {"name": name_of(model, node), "general": name_of(model, target)}
            start = relation.reference.start
            if own_bounds.most > general_bounds.most:
                names["own"] = _describe_values(own_bounds.most)
                yield Finding(MORE, start, {**names, "most": _describe(general_bounds.most)})
            if relation.kind == "Redefinition" and own_bounds.least < general_bounds.least:
                names["own"] = _describe_values(own_bounds.least)
                yield Finding(FEWER, start, {**names, "least": _describe(general_bounds.least)})


def _find_bounds(model: Model, feature: Node, depth: int = 0) -> Bounds | None:
    """Return the bounds of a feature: stated, redefined, or 1 by default; None if unknown."""
    if any(member.kind == "MultiplicityRange" for member in feature.members):
        return _find_stated_bounds(model, feature)
    for _, target in iter_stated(feature, _REDEFINITION):
        return _find_bounds(model, target, depth + 1) if depth < _MAX_DEPTH else None
    is_single = feature.kind in _SINGLE and find_owning_type(feature) is not None
    return Bounds(1, 1) if is_single else None


def _find_stated_bounds(model: Model, feature: Node) -> Bounds | None:
    """Return the bounds that a feature states, if they are constant."""
    for member in feature.members:
        if member.kind == "MultiplicityRange":
            values = [_evaluate_bound(model, bound) for bound in member.members]
            numbers = [value for value in values if value is not None]
            if not numbers or len(numbers) < len(values):
                return None
            is_any = len(numbers) == 1 and numbers[0] == inf
            return Bounds(0 if is_any else numbers[0], numbers[-1])
    return None


def _evaluate_bound(model: Model, bound: Node) -> float | None:
    if bound.kind == "LiteralInfinity":
        return inf
    value = evaluate_constant(model, bound)
    return value if isinstance(value, int) and not isinstance(value, bool) else None


def _describe_values(number: float) -> str:
    return "any number of values" if number == inf else count(int(number), "value")


def _describe(number: float) -> str:
    return "any number of" if number == inf else f"{number:g}"


MULTIPLICITY_BY_RELATION = ((_BOUNDED_RELATIONS, check_bounds),)
