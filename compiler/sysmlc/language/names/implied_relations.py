"""Relations that the specification adds to those that a text states (KerML 8.4, SysML 8.4)."""

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.implied import is_part, owning_type
from sysmlc.language.names.model import Model
from sysmlc.language.names.symbols import FEATURES, TYPES
from sysmlc.language.tree import Node, Reference, Relation

_BASES = (
    (kinds_of("Structure"), "Objects::objects", "Objects::Object::subobjects"),
    (kinds_of("Class"), "Occurrences::occurrences", "Occurrences::Occurrence::suboccurrences"),
    (kinds_of("DataType"), "Base::dataValues", ""),
)
"""Metaclasses of types; what a feature of such a type specialises, and what as a part of one."""
_CLASSES = kinds_of("Class")
_PORTIONS = "Occurrences::Occurrence::portions"


def generals_by_type(model: Model, node: Node) -> tuple[Node, ...]:
    """What ``node`` specialises because of the types that its text says.

    Not what a feature that it specialises does for the same reason.
    """
    found = _candidates(model, node)
    if not found:
        return ()
    generals = model.lookup.all_generals(node)
    above = model.by_types_above.get(generals)
    if above is None:
        above = {one for general in _above(model, generals) for one in _candidates(model, general)}
        model.by_types_above[generals] = above
    return tuple([one for one in found if one not in above])


def _above(model: Model, generals: tuple[Node, ...]) -> set[Node]:
    return {one for general in generals for one in model.supers_of(general)}


def _candidates(model: Model, node: Node) -> tuple[Node, ...]:
    known = model.by_type.get(node)
    if known is None:
        named = _names(model, node) if node.kind in FEATURES else []
        found = [model.find(name) for name in named]
        known = tuple([one for one in found if one is not None and one is not node])
        model.by_type[node] = known
    return known


def _names(model: Model, node: Node) -> list[str]:
    names = (
        [_PORTIONS] if node.attributes.get("isPortion") and _is_in(model, node, _CLASSES) else []
    )
    stated = {one.kind for one in _stated(node)}
    for kinds, base, part in _BASES if stated else ():
        if not kinds.isdisjoint(stated):
            is_inside = bool(part) and is_part(node) and _is_in(model, node, kinds)
            names += [part, base] if is_inside else [base]
    return names


def _stated(node: Node) -> list[Node]:
    """The types that the text says for a feature."""
    said = [r.reference.target for r in node.relations if r.kind == "FeatureTyping"]
    return [one for one in said if one is not None]


def _is_in(model: Model, node: Node, kinds: frozenset[str]) -> bool:
    """Whether a type of such a metaclass owns the feature, or a feature of such a type."""
    owner = owning_type(node)
    if owner is None:
        return False
    if owner.kind in FEATURES:
        return any(one.kind in kinds for one in model.types(owner))
    return owner.kind in kinds


_EXPRESSIONS = (
    kinds_of("InstantiationExpression")
    | kinds_of("LiteralExpression")
    | {"FeatureReferenceExpression", "MetadataAccessExpression", "NullExpression"}
)
_STEPS = kinds_of("IfActionUsage") | kinds_of("LoopActionUsage")
_DECLARED = TYPES - kinds_of("Multiplicity") - _EXPRESSIONS


def implied_relations(model: Model, node: Node) -> list[Relation]:
    """What the text does not say of a type or feature.

    Expressions and multiplicities, which no one declares, have none, but for the conditions of
    steps: those are parameters, and named by what they redefine.
    """
    if not _has_implied(node):
        return []
    return [_relation(model, kind, one) for kind, one in _relations(model, node)]


def implied_redefinitions(model: Model, node: Node) -> list[Node]:
    """What a feature redefines though the text does not say so."""
    return model.lookup.by_position(node) if _has_implied(node) else []


def _has_implied(node: Node) -> bool:
    return node.kind in _DECLARED or _is_condition(node)


def _is_condition(node: Node) -> bool:
    owner = node.owner if node.membership == "ParameterMembership" else None
    return owner is not None and owner.kind in _STEPS


def _relations(model: Model, node: Node) -> list[tuple[str, Node]]:
    """Kind and target of each relation that is needed beside the written ones."""
    made = [("Redefinition", one) for one in model.lookup.by_position(node)]
    if node.kind not in _DECLARED:
        return made
    by_type = generals_by_type(model, node)
    needed = dict.fromkeys(model.needed_generals(node, by_type))
    for _, one in made:
        needed.pop(one, None)
    for kind, target in [*(("Subsetting", one) for one in by_type), *model.candidates(node)]:
        if target in needed:
            del needed[target]
            made.append((kind, target))
    return made


def _relation(model: Model, kind: str, target: Node) -> Relation:
    reference = Reference((tuple(model.qualified_name(target).split("::")),))
    reference.set_targets([target])
    return Relation(kind, reference)
