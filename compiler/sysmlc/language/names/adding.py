"""Relations that the specification adds to what a text says (KerML 8.4, SysML 8.4)."""

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import typed
from sysmlc.language.names.contents import TYPES
from sysmlc.language.names.model import Model
from sysmlc.language.tree import Node, Reference, Relation

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
    by_type = typed.needed(model, node)
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
    reference.lead([target])
    return Relation(kind, reference)
