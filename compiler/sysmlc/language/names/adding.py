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


def add_implied(model: Model) -> None:
    """Give the types and features of the documents what the text does not say of them.

    Expressions and multiplicities, which no one declares, are left as they are, but for the
    conditions of steps: those are parameters, and named by what they redefine.
    """
    names: dict[Node, tuple[str, ...]] = {}
    for document in model.documents:
        for node in document.root.walk():
            if node.kind in _DECLARED or _is_condition(node):
                try:
                    made = _relations(model, node)
                except RecursionError:
                    model.lookup.abandon()
                    continue
                node.relations += [_relation(model, kind, one, names) for kind, one in made]


def _is_condition(node: Node) -> bool:
    owner = node.owner if node.membership == "ParameterMembership" else None
    return owner is not None and owner.kind in _STEPS


def _relations(model: Model, node: Node) -> list[tuple[str, Node]]:
    """Kind and target of each relation that is needed beside the written ones."""
    positions = model.lookup.by_position(node)
    if node.kind not in _DECLARED:
        return [("Redefinition", one) for one in positions]
    by_type = typed.needed(model, node)
    needed = dict.fromkeys(model.needed_generals(node, by_type))
    made = [("Redefinition", one) for one in positions]
    for _, one in made:
        needed.pop(one, None)
    for kind, target in [*(("Subsetting", one) for one in by_type), *model.candidates(node)]:
        if target in needed:
            del needed[target]
            made.append((kind, target))
    return made


def _relation(
    model: Model, kind: str, target: Node, names: dict[Node, tuple[str, ...]]
) -> Relation:
    name = names.get(target)
    if name is None:
        name = names[target] = tuple(model.qualified_name(target).split("::"))
    reference = Reference((name,))
    reference.targets = [target]
    return Relation(kind, reference, implied=True)
