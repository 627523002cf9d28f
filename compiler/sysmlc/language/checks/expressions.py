"""Expressions name features: the names of types have no values (KerML 8.3.4.8)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of, written
from sysmlc.language.checks.values import arguments
from sysmlc.language.metaclasses import FEATURES, TYPES, describe_kind, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.expression_results import find_result
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node

NO_FEATURE = rule(
    "SM272",
    "value-no-feature",
    Severity.ERROR,
    "'{name}' is {found} and has no value",
    help="name a feature; 'all {name}' gives everything of a type",
)
OTHER_OWNER = rule(
    "SM273",
    "chained-elsewhere",
    Severity.ERROR,
    "'{name}' is a feature of '{owner}', not of what stands before the dot",
    help="write a dot for every step",
)

_MEMBERSHIP = frozenset({"Membership"})
_REFERRING = frozenset({"FeatureReferenceExpression", "FeatureChainExpression"})


def check(model: Model, node: Node) -> Iterator[Found]:
    """Report an expression that names something else than a feature of what is before it."""
    for relation, target in written(node, _MEMBERSHIP):
        facts = {"name": name_of(model, target)}
        if target.kind in TYPES - FEATURES:
            facts["found"] = describe_kind(target)
            yield Found(NO_FEATURE, relation.reference.start, facts)
        elif len(relation.reference.chain[0]) > 1 and _is_elsewhere(model, node, target):
            facts["owner"] = name_of(model, target.owner)
            yield Found(OTHER_OWNER, relation.reference.start, facts)


def _is_elsewhere(model: Model, node: Node, target: Node) -> bool:
    """Whether what is before the dot is known, and has not the feature."""
    if node.kind != "FeatureChainExpression":
        return False
    operand = next(iter(arguments(node)), None)
    source = find_result(operand, model.lookup) if operand is not None else None
    owner = find_owning_type(target)
    if source is None or owner is None or owner.kind not in FEATURES:
        return False
    return owner not in model.supertype_set(source)


CHECKS = ((_REFERRING & kinds_of("Expression"), check),)
