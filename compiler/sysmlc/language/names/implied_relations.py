"""Relations that the specification adds to those that a text states (KerML 8.4, SysML 8.4).

The generals that features have by their types are those of KerML 8.4.4.2 to 8.4.4.4:
checkFeatureDataValueSpecialization, checkFeatureOccurrenceSpecialization,
checkFeatureSuboccurrenceSpecialization, checkFeatureObjectSpecialization,
checkFeatureSubobjectSpecialization, checkFeaturePortionSpecialization.
"""

from sysmlc.language.metaclasses import EXPRESSIONS_WITHOUT_BODY, FEATURES, TYPES, kinds_of
from sysmlc.language.names.implied import find_owning_type, is_part
from sysmlc.language.names.model import Model
from sysmlc.language.tree import Node, Reference, Relation

_BASES = (
    (kinds_of("Structure"), "Objects::objects", "Objects::Object::subobjects"),
    (kinds_of("Class"), "Occurrences::occurrences", "Occurrences::Occurrence::suboccurrences"),
    (kinds_of("DataType"), "Base::dataValues", ""),
)
"""Kinds of types, the base of a feature with such a type, and that of a part of such an owner."""
_CLASSES = kinds_of("Class")
_PORTIONS = "Occurrences::Occurrence::portions"


def _find_typed_generals(model: Model, node: Node) -> tuple[Node, ...]:
    """Return the bases of a feature by its stated types that no general of it has."""
    bases = _find_type_bases(model, node)
    if not bases:
        return ()
    generals = model.lookup.all_generals(node)
    inherited_bases = model.typed_generals_above.get(generals)
    if inherited_bases is None:
        inherited_bases = {
            base
            for general in generals
            for supertype in model.supertype_set(general)
            for base in _find_type_bases(model, supertype)
        }
        model.typed_generals_above[generals] = inherited_bases
    return tuple([base for base in bases if base not in inherited_bases])


def _find_type_bases(model: Model, node: Node) -> tuple[Node, ...]:
    bases = model.typed_generals.get(node)
    if bases is None:
        names = _list_base_names(model, node) if node.kind in FEATURES else []
        elements = [model.find(name) for name in names]
        bases = tuple(
            [element for element in elements if element is not None and element is not node]
        )
        model.typed_generals[node] = bases
    return bases


def _list_base_names(model: Model, node: Node) -> list[str]:
    names = (
        [_PORTIONS]
        if node.attributes.get("isPortion") and _is_owned_by(model, node, _CLASSES)
        else []
    )
    kinds_of_types = {type_.kind for type_ in _list_stated_types(node)}
    if kinds_of_types:
        for kinds, base, part_base in _BASES:
            if not kinds.isdisjoint(kinds_of_types):
                is_inside = bool(part_base) and is_part(node) and _is_owned_by(model, node, kinds)
                names += [part_base, base] if is_inside else [base]
    return names


def _list_stated_types(node: Node) -> list[Node]:
    """Return the types that the text states for a feature."""
    targets = [
        relation.reference.target for relation in node.relations if relation.kind == "FeatureTyping"
    ]
    return [target for target in targets if target is not None]


def _is_owned_by(model: Model, node: Node, kinds: frozenset[str]) -> bool:
    """Whether a type of one of ``kinds``, or a feature of such a type, owns the feature."""
    owner = find_owning_type(node)
    if owner is None:
        return False
    if owner.kind in FEATURES:
        return any(type_.kind in kinds for type_ in model.types(owner))
    return owner.kind in kinds


_STEPS = kinds_of("IfActionUsage") | kinds_of("LoopActionUsage")
_DECLARED = TYPES - kinds_of("Multiplicity") - EXPRESSIONS_WITHOUT_BODY


def implied_relations(model: Model, node: Node) -> list[Relation]:
    """Return the relations of a type or feature that the text does not state.

    Expressions and multiplicities have none, except the conditions of steps: these are parameters,
    and take their names from the parameters that they redefine.
    """
    if not _has_implied(node):
        return []
    return [_make_relation(model, kind, target) for kind, target in _list_relations(model, node)]


def implied_redefinitions(model: Model, node: Node) -> list[Node]:
    """Return the features that a feature redefines without stating it."""
    return model.lookup.redefined_by_position(node) if _has_implied(node) else []


def _has_implied(node: Node) -> bool:
    owner = node.owner if node.membership == "ParameterMembership" else None
    return node.kind in _DECLARED or (owner is not None and owner.kind in _STEPS)


def _list_relations(model: Model, node: Node) -> list[tuple[str, Node]]:
    """Return kind and target of each relation that is needed beside the stated ones."""
    relations = [("Redefinition", target) for target in model.lookup.redefined_by_position(node)]
    if node.kind not in _DECLARED:
        return relations
    by_type = _find_typed_generals(model, node)
    needed = dict.fromkeys(model.needed_generals(node, by_type))
    # A redefined feature is no implied general too.
    for _, target in relations:
        needed.pop(target, None)
    for kind, target in [*(("Subsetting", target) for target in by_type), *model.candidates(node)]:
        if target in needed:
            del needed[target]
            relations.append((kind, target))
    return relations


def _make_relation(model: Model, kind: str, target: Node) -> Relation:
    reference = Reference((tuple(model.qualified_name(target).split("::")),))
    reference.set_targets([target])
    return Relation(kind, reference)
