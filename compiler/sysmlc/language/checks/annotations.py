"""Metadata: its type, the elements that it annotates, and its body (KerML 8.3.4.12)."""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.findings import Finding, name_of
from sysmlc.language.checks.memberships import ABSTRACT_METADATA
from sysmlc.language.metaclasses import ALL_GENERALS, describe_kind, is_a, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

OTHER_ELEMENT = rule(
    "SM263",
    "metadata-of-other-element",
    Severity.ERROR,
    "metadata '{name}' cannot annotate {found}",
    help="annotate {wanted}",
)
OTHER_FEATURE = rule(
    "SM264",
    "metadata-body",
    Severity.ERROR,
    "'{name}' is not a feature of the metadata '{owner}'",
    help="name a feature of the definition of '{owner}', or add one there",
)

_METADATA = kinds_of("MetadataFeature")
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")


def check_type(model: Model, node: Node) -> Iterator[Finding]:
    """Report metadata with an abstract type; ``memberships`` checks metadata usages."""
    types = model.lookup.generals(node)
    if (
        any(type_.attributes.get("isAbstract") for type_ in types)
        and node.kind == "MetadataFeature"
    ):
        facts = {"name": name_of(model, node), "owner": name_of(model, node.owner)}
        yield Finding(ABSTRACT_METADATA, node.start, facts)


def check_annotated(model: Model, node: Node) -> Iterator[Finding]:
    """Report metadata that annotates an element of a kind that its definition does not allow."""
    allowed = _list_allowed_kinds(model, node)
    for element in _list_annotated(node):
        if allowed and not any(is_a(element.kind, kind) for kind in allowed):
            name = name_of(model, next(iter(model.lookup.generals(node)), node))
            wanted = " or ".join(describe_kind(Node(kind)) for kind in allowed)
            facts = {"name": name, "found": describe_kind(element), "wanted": wanted}
            yield Finding(OTHER_ELEMENT, node.start, facts)


def _list_annotated(node: Node) -> list[Node]:
    about = [
        relation.reference.target for relation in node.relations if relation.kind == "Annotation"
    ]
    if about:
        return [element for element in about if element is not None]
    return [node.owner] if node.owner is not None else []


def _list_allowed_kinds(model: Model, node: Node) -> list[str]:
    """Return the metaclasses that ``annotatedElement`` is restricted to; empty for any."""
    cache = model.annotated_kinds
    definitions = tuple(model.lookup.all_generals(node))
    # Metadata is used thousands of times with few definitions.
    if definitions not in cache:
        cache[definitions] = _list_allowed_kinds_in(model, model.all_supertypes(node)[1:])
    return list(dict.fromkeys([*_list_allowed_kinds_in(model, [node]), *cache[definitions]]))


def _list_allowed_kinds_in(model: Model, namespaces: Iterable[Node]) -> list[str]:
    base = model.find("Metaobjects::Metaobject::annotatedElement")
    if base is None:
        return []
    kinds: dict[str, None] = {}
    for namespace in namespaces:
        for member in namespace.members:
            if member is not base and _mentions(member, base) and model.specializes(member, base):
                kinds.update(
                    dict.fromkeys(type_.name for type_ in model.types(member) if type_.name)
                )
    return [kind for kind in kinds if kind in ALL_GENERALS]


def _mentions(member: Node, feature: Node) -> bool:
    """Whether a relation ends with the name of a feature.

    The test is far cheaper than the resolution of the reference.
    """
    return any(relation.reference.chain[-1][-1] == feature.name for relation in member.relations)


def check_body(model: Model, node: Node) -> Iterator[Finding]:
    """Report features in the body of metadata that its definition does not have."""
    worklist = [node]
    for owner in worklist:
        for member in owner.members:
            if member.membership in _FEATURE_MEMBERSHIPS:
                worklist.append(member)
                if _is_foreign(model, owner, member):
                    facts = {"name": name_of(model, member), "owner": name_of(model, owner)}
                    yield Finding(OTHER_FEATURE, member.start, facts)


def _is_foreign(model: Model, owner: Node, member: Node) -> bool:
    """Whether a member of a body is not a feature that a general of the owner has."""
    redefined = [
        relation.reference.target
        for relation in member.relations
        if relation.kind == "Redefinition"
    ]
    generals = model.all_supertypes(owner)
    if redefined:
        return not any(feature is None or feature.owner in generals for feature in redefined)
    return not any(
        feature.name == member.name for general in generals[1:] for feature in general.members
    )


CHECKS = (
    (_METADATA, check_type),
    (_METADATA, check_annotated),
    (_METADATA, check_body),
)
