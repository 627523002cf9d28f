"""Where the search for a name begins (KerML 8.2.3.5.2) and what it may lead to."""

from typing import NamedTuple

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.symbols import NAMESPACES
from sysmlc.language.tree import Node, Reference, Relation

_CONNECTORS = kinds_of("Connector")
INSTANTIATIONS = kinds_of("InstantiationExpression")
_SKIPPED = INSTANTIATIONS | {"FeatureReferenceExpression", "MetadataAccessExpression"}
"""Expressions that only hold other expressions: no name is looked up in them."""
_FLOWS = kinds_of("FlowUsage")
_EVENTS = kinds_of("EventOccurrenceUsage")
_FEATURE = kinds_of("Feature")
_TYPE = kinds_of("Type")
_CLASSIFIER = kinds_of("Classifier")

_METADATA = frozenset({"MetadataUsage", "MetadataFeature"})
_IMPORTS = kinds_of("Import")
_TYPING = frozenset({"FeatureTyping", "TypeFeaturing"})
_MEMBER = frozenset({"importedMembership"})
_IMPORTED = _MEMBER | {"importedNamespace"}

WANTED: dict[str, frozenset[str]] = {
    "Specialization": _TYPE,
    "Subclassification": _CLASSIFIER,
    "FeatureTyping": _TYPE,
    "ConjugatedPortTyping": kinds_of("PortDefinition"),
    "Subsetting": _FEATURE,
    "Redefinition": _FEATURE,
    "ReferenceSubsetting": _FEATURE,
    "CrossSubsetting": _FEATURE,
    "Conjugation": _TYPE,
    "Disjoining": _TYPE,
    "Unioning": _TYPE,
    "Intersecting": _TYPE,
    "Differencing": _TYPE,
    "FeatureChaining": _FEATURE,
    "FeatureInverting": _FEATURE,
    "TypeFeaturing": _TYPE,
    "importedNamespace": NAMESPACES,
    "specific": _TYPE,
    "general": _TYPE,
    "subclassifier": _CLASSIFIER,
    "superclassifier": _CLASSIFIER,
    "typedFeature": _FEATURE,
    "type": _TYPE,
    "subsettingFeature": _FEATURE,
    "subsettedFeature": _FEATURE,
    "redefiningFeature": _FEATURE,
    "redefinedFeature": _FEATURE,
    "conjugatedType": _TYPE,
    "originalType": _TYPE,
    "typeDisjoined": _TYPE,
    "disjoiningType": _TYPE,
    "featureInverted": _FEATURE,
    "invertingFeature": _FEATURE,
    "featureOfType": _FEATURE,
    "featuringType": _TYPE,
}
"""Metaclasses that the target of a relation may have; other relations take any element."""


class Start(NamedTuple):
    """Where a search begins: ``scope`` and outwards, or in the result of ``operand`` only.

    ``inherited`` looks in the generals of the scope first and not at what it owns: a feature
    redefines what its owner inherits (KerML 8.2.3.5.2). ``without`` is not found by its
    effective name, which the search is to give. ``before`` is the link of a chain that the
    name follows. ``everything`` looks at private members too, as ``import all`` does.
    ``past_subjects`` passes subjects over: what a requirement is satisfied by is not its subject,
    which may have the same name. ``importing`` are the namespaces that the name is imported into:
    what they import is looked at last, for it may depend on where the name leads. For the same
    reason the type of metadata (``is_metadata``) is not looked for in what the annotated element
    implicitly specialises.
    """

    scope: Node | None
    operand: Node | None = None
    inherited: bool = False
    without: Node | None = None
    before: Relation | None = None
    everything: bool = False
    reference: Reference | None = None
    past_subjects: bool = False
    importing: tuple[Node, ...] = ()
    is_metadata: bool = False


def start(node: Node, relation: Relation) -> Start:
    """Where the first name of a relation of ``node`` is looked up."""
    found = _start(node, relation)
    begins_globally = relation.reference.chain[0][0] == "$"
    return found._replace(reference=relation.reference) if begins_globally else found


def _start(node: Node, relation: Relation) -> Start:
    kind = relation.kind
    if kind == "Membership":
        return _membership(node)
    if kind == "ReferenceSubsetting" and (_is_connector_end(node) or _is_event_of_message(node)):
        return Start(_beyond_transition(node.owner), without=node)
    if kind == "Redefinition":
        return Start(namespace(node), inherited=len(relation.reference.chain) == 1, without=node)
    if kind in _TYPING:
        scope = node if kind == "TypeFeaturing" else beyond_expressions(node)
        return Start(scope, without=node, is_metadata=node.kind in _METADATA)
    if kind in _IMPORTED:
        return _import(
            node, everything=kind in _MEMBER and bool(node.attributes.get("isImportAll"))
        )
    before = _before(node, relation) if kind == "FeatureChaining" else None
    return Start(namespace(node), without=node, before=before)


def _import(node: Node, everything: bool) -> Start:
    """A filtered import is within a package of its own, which another import owns."""
    scope = namespace(node)
    importing = [] if scope is None else [scope]
    while importing and importing[-1].owner is not None and importing[-1].owner.kind in _IMPORTS:
        above = namespace(importing[-1].owner)
        if above is None:
            break
        importing.append(above)
    return Start(scope, without=node, everything=everything, importing=tuple(importing))


def _before(node: Node, relation: Relation) -> Relation | None:
    chain = [r for r in node.relations if r.kind == "FeatureChaining"]
    index = chain.index(relation)
    return chain[index - 1] if index else None


def _membership(node: Node) -> Start:
    if node.kind == "Membership":
        return Start(namespace(node), without=node)
    if node.kind == "FeatureChainExpression":
        return Start(None, operand=node.members[0] if node.members else None)
    if node.kind == "AssignmentActionUsage":
        operand = _assigned(node)
        return Start(None, operand=operand) if operand else Start(node)
    if node.kind in _SKIPPED:
        scope = beyond_expressions(node)
        is_by = scope is not None and scope.kind == "SatisfyRequirementUsage"
        return Start(scope, past_subjects=is_by)
    return Start(namespace(node)) if node.kind == "TransitionUsage" else Start(node)


def _assigned(node: Node) -> Node | None:
    """The expression before the dot of ``assign x.y := z``, where it is written apart."""
    for member in node.members:
        if member.membership == "ParameterMembership":
            return next((m for m in member.members if m.membership == "FeatureValue"), None)
    return None


def _is_connector_end(node: Node) -> bool:
    owner = node.owner
    return (
        owner is not None
        and owner.kind in _CONNECTORS
        and (node.membership == "EndFeatureMembership" or bool(node.attributes.get("isEnd")))
    )


def _is_event_of_message(node: Node) -> bool:
    """Whether a message begins or ends with it: ``message from a to b`` (SysML 8.2.2.16.2)."""
    owner = node.owner
    is_parameter = node.membership == "ParameterMembership"
    return is_parameter and owner is not None and owner.kind in _FLOWS and node.kind in _EVENTS


def _beyond_transition(connector: Node | None) -> Node | None:
    """Where the ends of a connector are looked up; those of a transition's, around that."""
    scope = namespace(connector) if connector else None
    return namespace(scope) if scope is not None and scope.kind == "TransitionUsage" else scope


def namespace(node: Node) -> Node | None:
    """The nearest namespace around ``node``."""
    owner = node.owner
    while owner is not None and owner.kind not in NAMESPACES:
        owner = owner.owner
    return owner


def beyond_expressions(node: Node) -> Node | None:
    """The nearest namespace around ``node`` in which names of an expression are looked up."""
    owner = namespace(node)
    while owner is not None and (node.membership == "FeatureValue" or owner.kind in _SKIPPED):
        node = owner
        owner = namespace(node)
    return owner


def outer(scope: Node) -> Node | None:
    """The next scope outwards."""
    owner = scope.owner
    while owner is not None and (owner.kind not in NAMESPACES or owner.kind in _SKIPPED):
        owner = owner.owner
    return owner
