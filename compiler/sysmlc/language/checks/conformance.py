"""What subsets or redefines a feature keeps what the feature promises (KerML 8.3.3.3)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import DECLARED_FEATURES, Found, name_of, written
from sysmlc.language.checks.reference_rules import OTHER_DIRECTION
from sysmlc.language.metaclasses import USAGES, is_end, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.generals import GENERALIZATION_KINDS
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node

NONUNIQUE = rule(
    "SM250",
    "nonunique-subset",
    Severity.ERROR,
    "'{name}' may have a value twice, and '{general}' may not",
    help="leave 'nonunique' out, or write it for '{general}' too",
)
NOT_CONSTANT = rule(
    "SM251",
    "variable-subset",
    Severity.ERROR,
    "'{name}' may change, and '{general}' is constant",
    help="write 'const' for 'var'",
)
NO_END = rule(
    "SM252",
    "redefined-end",
    Severity.ERROR,
    "'{name}' is no end, and '{general}', which it redefines, is one",
    help="write 'end' before it",
)
OF_PACKAGE = rule(
    "SM278",
    "redefines-package-feature",
    Severity.ERROR,
    "'{general}' is a member of no type, so '{name}' cannot redefine it",
    help="subset it: ':>' for ':>>'",
)
OF_SAME_OWNER = rule(
    "SM279",
    "redefines-own-feature",
    Severity.ERROR,
    "'{name}' redefines '{general}' of the same owner",
    help="subset it: ':>' for ':>>'",
)

_REDEFINITION = frozenset({"Redefinition"})
_SUBSETTINGS = kinds_of("Subsetting")
_TURNING = frozenset({"Conjugation", "ConjugatedPortTyping"})
_TURNED = {"in": "out", "out": "in"}
_PLAIN = DECLARED_FEATURES - USAGES


def check(model: Model, node: Node) -> Iterator[Found]:
    """Report a feature that breaks what a feature promises that it subsets or redefines."""
    for relation, target in written(node, _SUBSETTINGS):
        rules = (
            (NONUNIQUE, node.attributes.get("isUnique") is False and _is_unique(target)),
            (NOT_CONSTANT, _may_change(node) and target.attributes.get("isConstant") is True),
            (OF_PACKAGE, relation.kind == "Redefinition" and _are_free(model, node, target)),
            (OF_SAME_OWNER, relation.kind == "Redefinition" and _are_of_one(node, target)),
            (NO_END, relation.kind == "Redefinition" and is_end(target) and not is_end(node)),
        )
        for broken_rule, is_broken in rules:
            if is_broken:
                facts = {"name": name_of(model, node), "general": name_of(model, target)}
                yield Found(broken_rule, relation.reference.start, facts)


def _is_unique(feature: Node) -> bool:
    return feature.attributes.get("isUnique") is not False


def _are_free(model: Model, feature: Node, general: Node) -> bool:
    if find_owning_type(feature) is not None or find_owning_type(general) is not None:
        return False
    return not (_is_featured(model, feature) or _is_featured(model, general))


def _is_featured(model: Model, feature: Node) -> bool:
    """Whether a type is said to have a feature that it does not own."""
    if any(relation.kind == "TypeFeaturing" for relation in feature.relations):
        return True
    return any(
        relation.reference.target is feature
        for document in model.documents
        for node in model.nodes(document)
        if node.kind == "TypeFeaturing"
        for relation in node.relations
    )


def _are_of_one(feature: Node, general: Node) -> bool:
    owner = find_owning_type(feature)
    return owner is not None and owner is find_owning_type(general)


def _may_change(feature: Node) -> bool:
    return feature.attributes.get("isVariable") is True and not feature.attributes.get("isConstant")


def check_direction(model: Model, node: Node) -> Iterator[Found]:
    """Report a feature with another direction than what it redefines has where it is."""
    scope = find_owning_type(node)
    if scope is None or scope.kind == "FlowEnd":
        return
    own = _said(node)
    for start, target in _redefined(model, node):
        wanted = direction(model, scope, target)
        if (wanted in _TURNED and own != wanted) or (wanted == "inout" and own is None):
            facts = {"name": name_of(model, target), "owner": name_of(model, target.owner)}
            yield Found(OTHER_DIRECTION, start, facts)


def _redefined(model: Model, node: Node) -> Iterator[tuple[int, Node]]:
    """What a feature redefines, as its text says or by its position, and where it says so."""
    for relation, target in written(node, _REDEFINITION):
        yield relation.reference.start, target
    for target in model.lookup.redefined_by_position(node):
        yield node.start, target


def direction(model: Model, scope: Node, feature: Node) -> str:
    """The direction of a feature as ``scope`` sees it: conjugation turns it around.

    Empty where it has none and where ``scope`` does not inherit it (KerML 8.3.3.1.10,
    directionOf).
    """
    said = _said(feature)
    if said is None:
        return ""
    waiting = [(scope, False)]
    seen = set(waiting)
    for at, is_turned in waiting:
        if at is feature.owner:
            return _TURNED.get(said, said) if is_turned else said
        for general, turns in _generals(model, at):
            step = (general, is_turned ^ turns)
            if step not in seen:
                seen.add(step)
                waiting.append(step)
    return ""


def _generals(model: Model, node: Node) -> Iterator[tuple[Node, bool]]:
    """What an element directly specialises, and whether that turns directions around."""
    for relation in node.relations:
        general = model.target(node, relation) if relation.kind in GENERALIZATION_KINDS else None
        if general is not None:
            yield general, relation.kind in _TURNING
    for general in model.needed_generals(node):
        yield general, False


def _said(feature: Node) -> str | None:
    """The direction that the text says; a result goes out."""
    said = feature.attributes.get("direction")
    is_result = feature.membership == "ReturnParameterMembership"
    return str(said) if said is not None else "out" if is_result else None


CHECKS = ((_PLAIN, check_direction),)
BY_RELATION = ((_SUBSETTINGS, check),)
