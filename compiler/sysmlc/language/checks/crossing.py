"""Cross features: what an end of an association is, seen from the other end (KerML 8.3.3.3.5)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of, written
from sysmlc.language.metaclasses import is_end
from sysmlc.language.names import Model
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node, Reference

NOT_OPPOSITE = rule(
    "SM285",
    "crosses-own-end",
    Severity.ERROR,
    "'{name}' does not lead through the opposite end of '{owner}'",
    help="name the other end, a dot, and its feature",
)
OTHER_TYPE = rule(
    "SM286",
    "crosses-other-type",
    Severity.ERROR,
    "'{name}' has another type than the end that crosses it",
    help="let the end and the feature have one type",
)
NOT_SPECIAL = rule(
    "SM287",
    "crosses-unrelated",
    Severity.ERROR,
    "'{name}' does not specialise '{general}', which the redefined end crosses",
    help="cross a feature that subsets '{general}'",
)
OTHER_OWN = rule(
    "SM288",
    "crosses-past-own",
    Severity.ERROR,
    "'{owner}' has the cross feature '{name}' and crosses another one",
    help="cross '{name}', or leave it out",
)

_CROSSES = frozenset({"CrossSubsetting"})
_TYPING = frozenset({"FeatureTyping"})


def check(model: Model, node: Node) -> Iterator[Found]:
    """Report an end that crosses what is not its cross feature."""
    for relation, crossed in written(node, _CROSSES) if _is_binary(node.owner) else ():
        facts = {"name": name_of(model, crossed), "owner": name_of(model, node.owner)}
        start = relation.reference.start
        if not _is_opposite(node, relation.reference):
            yield Found(NOT_OPPOSITE, start, {**facts, "name": str(relation.reference)})
        typed = {target for _, target in written(node, _TYPING)}
        is_typed = bool(typed and model.lookup.generals(crossed))
        if is_typed and typed != set(model.types(crossed)):
            yield Found(OTHER_TYPE, start, facts)
        for general in _generally(model, node):
            if not model.specializes(crossed, general):
                yield Found(NOT_SPECIAL, start, {**facts, "general": name_of(model, general)})
        for own in _own(node):
            if own is not crossed:
                names = {"name": name_of(model, own), "owner": name_of(model, node)}
                yield Found(OTHER_OWN, own.start, names)


def _is_binary(owner: Node | None) -> bool:
    """Whether a feature is one of two ends: of more, what is opposite is a link of the others."""
    return owner is not None and sum(map(is_end, owner.members)) == 2


def _is_opposite(node: Node, reference: Reference) -> bool:
    """Whether a chain leads from the other end to a feature of it."""
    targets = reference.targets or []
    is_other = bool(targets) and targets[0] is not node and is_end(targets[0])
    return len(targets) == 2 and is_other and find_owning_type(targets[0]) is not None


def _generally(model: Model, node: Node) -> list[Node]:
    """What the ends cross that an end redefines."""
    ends = sorted(model.lookup.redefined_features(node), key=model.qualified_name)
    return [target for end in ends for _, target in written(end, _CROSSES)]


def _own(node: Node) -> list[Node]:
    members = (one for one in node.members if one.membership == "OwningMembership")
    return [one for one in members if one.kind == "Feature"]


BY_RELATION = ((_CROSSES, check),)
