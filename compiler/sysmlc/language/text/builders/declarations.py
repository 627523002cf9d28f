"""Declarations: names, feature chains, specialisations, multiplicities and values.

KerML 8.2.2.3, 8.2.3.4.1, 8.2.4.3, 8.2.5.10, 8.2.5.11.
"""

from typing import NamedTuple

from sysmlc.language.text.builders.nodes import OWNING, make_node
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation


class Names(NamedTuple):
    """The names of an element, and the token that has the name."""

    short_name: str | None
    name: str | None
    token: int


def apply_names(node: Node, names: Names | None, tokens: Tokens) -> Node:
    """Set the names of ``node``, and return it."""
    if names is not None:
        node.short_name, node.name = names.short_name, names.name
        node.name_start = tokens.starts[names.token]
    return node


def _build_name(tokens: Tokens, _stop: int, begin: int, name: int, *_follow: object) -> Names:
    return Names(None, tokens.read_name(name), begin)


def _build_short_name(
    tokens: Tokens, _stop: int, _begin: int, short: int, *_follow: object
) -> Names:
    return Names(tokens.read_name(short), None, short)


def _build_both_names(
    tokens: Tokens, _stop: int, _begin: int, short: int, name: int, *_follow: object
) -> Names:
    return Names(tokens.read_name(short), tokens.read_name(name), name)


def _build_simple_name(tokens: Tokens, _stop: int, _begin: int, name: int) -> Reference:
    return Reference(((tokens.read_name(name),),), tokens.starts[name], tokens.ends[name])


def _build_global_name(tokens: Tokens, _stop: int, begin: int, name: int) -> Reference:
    return Reference((("$", tokens.read_name(name)),), tokens.starts[begin], tokens.ends[name])


def _extend_name(
    tokens: Tokens, _stop: int, _begin: int, reference: Reference, name: int
) -> Reference:
    reference.chain = ((*reference.chain[0], tokens.read_name(name)),)
    reference.end = tokens.ends[name]
    return reference


def _extend_chain(
    _tokens: Tokens, _stop: int, _begin: int, reference: Reference, link: Reference
) -> Reference:
    reference.chain += link.chain
    reference.end = link.end
    return reference


SpecializationPart = Relation | Node | int
"""A relationship, a multiplicity, or the token `ordered` or `nonunique`."""


def apply_specializations(
    node: Node, parts: list[SpecializationPart] | None, tokens: Tokens
) -> Node:
    """Apply everything between the name of a feature and its value, and return the feature."""
    for part in parts or ():
        if isinstance(part, Relation):
            node.relations.append(part)
        elif isinstance(part, Node):
            node.add_member(part)
        elif tokens[part] == "ordered":
            node.attributes["isOrdered"] = True
        else:
            node.attributes["isUnique"] = False
    return node


def apply_value(node: Node, value: Node | None) -> Node:
    """Let a feature own its value, if it has one, and return the feature."""
    if value is not None:
        node.add_member(value)
    return node


def _build_typing(_tokens: Tokens, _stop: int, _begin: int, name: Reference) -> Relation:
    return Relation("FeatureTyping", name)


def _build_conjugated_typing(_tokens: Tokens, _stop: int, _begin: int, name: Reference) -> Relation:
    return Relation("ConjugatedPortTyping", name)


def _build_typings(
    _tokens: Tokens, _stop: int, _begin: int, _typed_by: list[Node], types: list[Relation]
) -> list[Relation]:
    return types


def _build_subsettings(
    _tokens: Tokens, _stop: int, _begin: int, names: list[Reference]
) -> list[Relation]:
    return [Relation("Subsetting", name) for name in names]


def _build_redefinitions(
    _tokens: Tokens, _stop: int, _begin: int, names: list[Reference]
) -> list[Relation]:
    return [Relation("Redefinition", name) for name in names]


def _build_references(_tokens: Tokens, _stop: int, _begin: int, name: Reference) -> list[Relation]:
    return [Relation("ReferenceSubsetting", name)]


def _build_crosses(_tokens: Tokens, _stop: int, _begin: int, name: Reference) -> list[Relation]:
    return [Relation("CrossSubsetting", name)]


def make_multiplicity(bounds: Node, tokens: Tokens, begin: int, stop: int) -> Node:
    """Return the multiplicity of an expression between brackets."""
    node = make_node("MultiplicityRange", OWNING, tokens, begin, stop)
    is_range = bounds.attributes.get("operator") == ".." and bounds.kind == "OperatorExpression"
    for bound in bounds.members if is_range else [bounds]:
        bound.membership = OWNING
        node.add_member(bound)
    return node


def _build_multiplicity(tokens: Tokens, stop: int, begin: int, bounds: Node) -> list[Node]:
    return [make_multiplicity(bounds, tokens, begin, stop)]


def _build_ordering(_tokens: Tokens, _stop: int, _begin: int, token: int) -> list[int]:
    return [token]


def _mark_value(role: str, value: Node) -> Node:
    value.membership, value.role = "FeatureValue", role
    return value


def _build_bound_value(_tokens: Tokens, _stop: int, _begin: int, value: Node) -> Node:
    return _mark_value("=", value)


def _build_initial_value(_tokens: Tokens, _stop: int, _begin: int, value: Node) -> Node:
    return _mark_value(":=", value)


def _build_default_value(_tokens: Tokens, _stop: int, _begin: int, value: Node) -> Node:
    return _mark_value("default", value)


def _build_default_bound_value(_tokens: Tokens, _stop: int, _begin: int, value: Node) -> Node:
    return _mark_value("default =", value)


def _build_default_initial_value(_tokens: Tokens, _stop: int, _begin: int, value: Node) -> Node:
    return _mark_value("default :=", value)


ACTIONS = {
    "named": _build_name,
    "short_named": _build_short_name,
    "both_named": _build_both_names,
    "simple_name": _build_simple_name,
    "global_name": _build_global_name,
    "longer_name": _extend_name,
    "longer_chain": _extend_chain,
    "typing": _build_typing,
    "conjugated_typing": _build_conjugated_typing,
    "typings": _build_typings,
    "subsettings": _build_subsettings,
    "redefinitions": _build_redefinitions,
    "references": _build_references,
    "crosses": _build_crosses,
    "multiplicity": _build_multiplicity,
    "ordering_part": _build_ordering,
    "bound_value": _build_bound_value,
    "initial_value": _build_initial_value,
    "default_value": _build_default_value,
    "default_bound_value": _build_default_bound_value,
    "default_initial_value": _build_default_initial_value,
}
