"""Specialisations, multiplicities and values of features (KerML 8.2.4.3, 8.2.5.10, 8.2.5.11)."""

from sysmlc.language.text.build.owning import OWNING, made
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference, Relation

Part = Relation | Node | int
"""Of a specialisation: a relationship, a multiplicity, or the token `ordered` or `nonunique`."""


def specialize(node: Node, parts: list[Part] | None, tokens: Tokens) -> Node:
    """Apply what stands between the name of a feature and its value."""
    for part in parts or ():
        if isinstance(part, Relation):
            node.relations.append(part)
        elif isinstance(part, Node):
            node.own(part)
        elif tokens[part] == "ordered":
            node.facts["isOrdered"] = True
        else:
            node.facts["isUnique"] = False
    return node


def give(node: Node, value: Node | None) -> Node:
    """Give a feature its value."""
    if value is not None:
        node.own(value)
    return node


def _typing(_tokens: Tokens, _at: int, _begin: int, name: Reference) -> Relation:
    return Relation("FeatureTyping", name)


def _conjugated(_tokens: Tokens, _at: int, _begin: int, name: Reference) -> Relation:
    return Relation("ConjugatedPortTyping", name)


def _typings(_tokens: Tokens, _at: int, _begin: int, *types: list[Relation]) -> list[Relation]:
    return types[-1]


def _subsettings(_tokens: Tokens, _at: int, _begin: int, names: list[Reference]) -> list[Relation]:
    return [Relation("Subsetting", name) for name in names]


def _redefinitions(
    _tokens: Tokens, _at: int, _begin: int, names: list[Reference]
) -> list[Relation]:
    return [Relation("Redefinition", name) for name in names]


def _references(_tokens: Tokens, _at: int, _begin: int, name: Reference) -> list[Relation]:
    return [Relation("ReferenceSubsetting", name)]


def _crosses(_tokens: Tokens, _at: int, _begin: int, name: Reference) -> list[Relation]:
    return [Relation("CrossSubsetting", name)]


def multiplicity(bounds: Node, tokens: Tokens, begin: int, at: int) -> Node:
    """The multiplicity that an expression between brackets gives."""
    node = made("MultiplicityRange", OWNING, tokens, begin, at)
    is_range = bounds.facts.get("operator") == ".." and bounds.kind == "OperatorExpression"
    for bound in bounds.members if is_range else [bounds]:
        bound.membership = OWNING
        node.own(bound)
    return node


def _multiplicity(tokens: Tokens, at: int, begin: int, bounds: Node) -> list[Node]:
    return [multiplicity(bounds, tokens, begin, at)]


def _ordering(_tokens: Tokens, _at: int, _begin: int, token: int) -> list[int]:
    return [token]


def _valued(role: str, value: Node) -> Node:
    value.membership, value.role = "FeatureValue", role
    return value


def _bound(_tokens: Tokens, _at: int, _begin: int, value: Node) -> Node:
    return _valued("=", value)


def _initial(_tokens: Tokens, _at: int, _begin: int, value: Node) -> Node:
    return _valued(":=", value)


def _default(_tokens: Tokens, _at: int, _begin: int, value: Node) -> Node:
    return _valued("default", value)


def _default_bound(_tokens: Tokens, _at: int, _begin: int, value: Node) -> Node:
    return _valued("default =", value)


def _default_initial(_tokens: Tokens, _at: int, _begin: int, value: Node) -> Node:
    return _valued("default :=", value)


ACTIONS = {
    "typing": _typing,
    "conjugated_typing": _conjugated,
    "typings": _typings,
    "subsettings": _subsettings,
    "redefinitions": _redefinitions,
    "references": _references,
    "crosses": _crosses,
    "multiplicity": _multiplicity,
    "ordering_part": _ordering,
    "bound_value": _bound,
    "initial_value": _initial,
    "default_value": _default,
    "default_bound_value": _default_bound,
    "default_initial_value": _default_initial,
}
