"""What features specialise because of their types (KerML 8.4.4.2 to 8.4.4.4).

checkFeatureDataValueSpecialization, checkFeatureOccurrenceSpecialization,
checkFeatureSuboccurrenceSpecialization, checkFeatureObjectSpecialization,
checkFeatureSubobjectSpecialization, checkFeaturePortionSpecialization.
"""

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.contents import FEATURES
from sysmlc.language.names.implied import is_part, owning_type
from sysmlc.language.names.model import Model
from sysmlc.language.tree import Node

_BASES = (
    (kinds_of("Structure"), "Objects::objects", "Objects::Object::subobjects"),
    (kinds_of("Class"), "Occurrences::occurrences", "Occurrences::Occurrence::suboccurrences"),
    (kinds_of("DataType"), "Base::dataValues", ""),
)
"""Metaclasses of types; what a feature of such a type specialises, and what as a part of one."""
_CLASSES = kinds_of("Class")
_PORTIONS = "Occurrences::Occurrence::portions"


def needed(model: Model, node: Node) -> tuple[Node, ...]:
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
    names = [_PORTIONS] if node.facts.get("isPortion") and _is_in(model, node, _CLASSES) else []
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
