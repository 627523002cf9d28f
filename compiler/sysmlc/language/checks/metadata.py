"""Metadata says what its definition has, about what its definition is for (KerML 8.3.4.12)."""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of
from sysmlc.language.checks.member_rules import ABSTRACT_METADATA
from sysmlc.language.metaclasses import ALL_GENERALS, describe_kind, is_a, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

OTHER_ELEMENT = rule(
    "SM263",
    "metadata-of-other-element",
    Severity.ERROR,
    "metadata '{name}' is not for {found}",
    help="annotate {wanted}",
)
OTHER_FEATURE = rule(
    "SM264",
    "metadata-body",
    Severity.ERROR,
    "'{name}' is no feature of the metadata '{owner}'",
    help="name a feature of the definition of '{owner}', or add one there",
)

_METADATA = kinds_of("MetadataFeature")
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")


def check_type(model: Model, node: Node) -> Iterator[Found]:
    """Report metadata of a type that is abstract; usages have a check of their own."""
    types = model.lookup.generals(node)
    if any(one.attributes.get("isAbstract") for one in types) and node.kind == "MetadataFeature":
        facts = {"name": name_of(model, node), "owner": name_of(model, node.owner)}
        yield Found(ABSTRACT_METADATA, node.start, facts)


def check_annotated(model: Model, node: Node) -> Iterator[Found]:
    """Report metadata about elements that its definition is not for."""
    allowed = _allowed(model, node)
    for element in _annotated(node):
        if allowed and not any(is_a(element.kind, one) for one in allowed):
            name = name_of(model, next(iter(model.lookup.generals(node)), node))
            facts = {"name": name, "found": describe_kind(element), "wanted": _words(allowed)}
            yield Found(OTHER_ELEMENT, node.start, facts)


def _words(kinds: list[str]) -> str:
    return " or ".join(describe_kind(Node(kind)) for kind in kinds)


def _annotated(node: Node) -> list[Node]:
    about = [r.reference.target for r in node.relations if r.kind == "Annotation"]
    if about:
        return [one for one in about if one is not None]
    return [node.owner] if node.owner is not None else []


def _allowed(model: Model, node: Node) -> list[str]:
    """Metaclasses that ``annotatedElement`` is redefined or subset to be; empty for any."""
    kept = model.annotated_kinds
    definitions = tuple(model.lookup.all_generals(node))
    if definitions not in kept:
        kept[definitions] = _allowed_in(model, model.all_supertypes(node)[1:])
    return list(dict.fromkeys([*_allowed_in(model, [node]), *kept[definitions]]))


def _allowed_in(model: Model, namespaces: Iterable[Node]) -> list[str]:
    base = model.find("Metaobjects::Metaobject::annotatedElement")
    if base is None:
        return []
    found: dict[str, None] = {}
    for namespace in namespaces:
        for member in namespace.members:
            if member is not base and _names(member, base) and model.specializes(member, base):
                found.update(dict.fromkeys(one.name for one in model.types(member) if one.name))
    return [one for one in found if one in ALL_GENERALS]


def _names(member: Node, feature: Node) -> bool:
    """Whether a relation ends with the name of a feature: far cheaper than to follow it."""
    return any(r.reference.chain[-1][-1] == feature.name for r in member.relations)


def check_body(model: Model, node: Node) -> Iterator[Found]:
    """Report what in the body of metadata is no feature of its definition."""
    waiting = [node]
    for owner in waiting:
        for member in owner.members:
            if member.membership in _FEATURE_MEMBERSHIPS:
                waiting.append(member)
                if _is_strange(model, owner, member):
                    facts = {"name": name_of(model, member), "owner": name_of(model, owner)}
                    yield Found(OTHER_FEATURE, member.start, facts)


def _is_strange(model: Model, owner: Node, member: Node) -> bool:
    """Whether a feature in a body is none of what its owner specialises, by name or link."""
    redefined = [r.reference.target for r in member.relations if r.kind == "Redefinition"]
    generals = model.all_supertypes(owner)
    if redefined:
        return not any(one is None or one.owner in generals for one in redefined)
    return not any(one.name == member.name for g in generals[1:] for one in g.members)


CHECKS = (
    (_METADATA, check_type),
    (_METADATA, check_annotated),
    (_METADATA, check_body),
)
