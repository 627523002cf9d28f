"""Declarations: names, feature chains, specialisations, multiplicities and values.

KerML 8.2.2.3, 8.2.3.4.1, 8.2.4.3, 8.2.5.10, 8.2.5.11.
"""

from functools import partial
from typing import NamedTuple

from sysmlc.language.text.builders.nodes import OWNING, make_node, omit_first
from sysmlc.language.text.lexer import Span, Tokens
from sysmlc.language.tree import Node, Reference, Relation


class Names(NamedTuple):
    """The names of an element, and the token that has the name."""

    short_name: str | None
    name: str | None
    token: int


SpecializationPart = Relation | Node | int
"""A relationship, a multiplicity, or the token `ordered` or `nonunique`."""
Parts = list[SpecializationPart] | None
"""Everything between the name of a feature and its value."""


def make_element(
    kind: str,
    membership: str,
    tokens: Tokens,
    names: Names | None = None,
    parts: Parts = None,
    value: Node | None = None,
) -> Node:
    """Return a node for the rule that is reduced, with its names, specialisations and value."""
    node = apply_names(make_node(kind, membership, tokens), names, tokens)
    return complete_element(node, tokens, parts, value)


def apply_names(node: Node, names: Names | None, tokens: Tokens) -> Node:
    """Set the names of ``node``, and return it."""
    if names is not None:
        node.short_name, node.name = names.short_name, names.name
        node.name_start = tokens.starts[names.token]
    return node


def complete_element(node: Node, tokens: Tokens, parts: Parts, value: Node | None) -> Node:
    """Add the specialisations and the value to a node that has its names, and return it."""
    for part in parts or ():
        if isinstance(part, Relation):
            node.relations.append(part)
        elif isinstance(part, Node):
            node.add_member(part)
        elif tokens[part] == "ordered":
            node.attributes["isOrdered"] = True
        else:
            node.attributes["isUnique"] = False
    if value is not None:
        node.add_member(value)
    return node


def _build_name(tokens: Tokens, name: int, *_follow: object) -> Names:
    return Names(None, tokens.read_name(name), name)


def _build_short_name(tokens: Tokens, short: int, *_follow: object) -> Names:
    return Names(tokens.read_name(short), None, short)


def _build_both_names(tokens: Tokens, short: int, name: int, *_follow: object) -> Names:
    return Names(tokens.read_name(short), tokens.read_name(name), name)


def _build_heading(
    tokens: Tokens, name: Names | int | None, parts: Parts = None
) -> tuple[Names | None, Parts]:
    """Build what precedes the source of a transition or the ends of a binding."""
    names = Names(None, tokens.read_name(name), name) if isinstance(name, int) else name
    return names, parts


def _build_simple_name(tokens: Tokens, name: int) -> Reference:
    return Reference(((tokens.read_name(name),),), tokens.starts[name], tokens.ends[name])


def _build_global_name(tokens: Tokens, name: int) -> Reference:
    chain = (("$", tokens.read_name(name)),)
    return Reference(chain, tokens.starts[tokens.begin], tokens.ends[name])


def _extend_name(tokens: Tokens, reference: Reference, name: int) -> Reference:
    reference.chain = ((*reference.chain[0], tokens.read_name(name)),)
    reference.end = tokens.ends[name]
    return reference


def _extend_chain(_tokens: Tokens, reference: Reference, link: Reference) -> Reference:
    reference.chain += link.chain
    reference.end = link.end
    return reference


def _build_relation(kind: str, _tokens: Tokens, name: Reference) -> Relation:
    return Relation(kind, name)


def build_relations(
    kind: str, _tokens: Tokens, names: Reference | list[Reference]
) -> list[Relation]:
    """Build one relation to each of the names after a keyword."""
    return [Relation(kind, name) for name in (names if isinstance(names, list) else [names])]


def _build_typings(_tokens: Tokens, _typed_by: list[Node], types: list[Relation]) -> list[Relation]:
    return types


def make_multiplicity(bounds: Node, tokens: Tokens, span: Span | None = None) -> Node:
    """Return the multiplicity of an expression between brackets."""
    node = make_node("MultiplicityRange", OWNING, tokens, span)
    is_range = bounds.attributes.get("operator") == ".." and bounds.kind == "OperatorExpression"
    for bound in bounds.members if is_range else [bounds]:
        bound.membership = OWNING
        node.add_member(bound)
    return node


def _build_multiplicity(tokens: Tokens, bounds: Node) -> list[Node]:
    return [make_multiplicity(bounds, tokens)]


def _build_ordering(_tokens: Tokens, token: int) -> list[int]:
    return [token]


def mark_value(role: str, _tokens: Tokens, value: Node) -> Node:
    """Make an expression the value of a feature; ``role`` says how the value is given."""
    value.membership, value.role = "FeatureValue", role
    return value


ACTIONS = {
    "named": _build_name,
    "short_named": _build_short_name,
    "both_named": _build_both_names,
    "heading": _build_heading,
    "nameless_heading": omit_first(_build_heading),
    "simple_name": _build_simple_name,
    "global_name": _build_global_name,
    "longer_name": _extend_name,
    "longer_chain": _extend_chain,
    "typing": partial(_build_relation, "FeatureTyping"),
    "conjugated_typing": partial(_build_relation, "ConjugatedPortTyping"),
    "typings": _build_typings,
    "subsettings": partial(build_relations, "Subsetting"),
    "redefinitions": partial(build_relations, "Redefinition"),
    "references": partial(build_relations, "ReferenceSubsetting"),
    "crosses": partial(build_relations, "CrossSubsetting"),
    "multiplicity": _build_multiplicity,
    "ordering_part": _build_ordering,
    "bound_value": partial(mark_value, "="),
    "initial_value": partial(mark_value, ":="),
    "default_value": partial(mark_value, "default"),
    "default_bound_value": partial(mark_value, "default ="),
    "default_initial_value": partial(mark_value, "default :="),
}
