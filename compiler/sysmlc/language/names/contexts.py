"""Lookup contexts: where the search for a name begins (KerML 8.2.3.5.2), and what it may find."""

from typing import NamedTuple

from sysmlc.language.metaclasses import NAMESPACES, kinds_of
from sysmlc.language.tree import Node, Reference, Relation

_CONNECTORS = kinds_of("Connector")
INSTANTIATIONS = kinds_of("InstantiationExpression")
_TRANSPARENT = INSTANTIATIONS | {"FeatureReferenceExpression", "MetadataAccessExpression"}
"""Expressions that only contain other expressions and are no scopes."""
_FLOWS = kinds_of("FlowUsage")
_EVENTS = kinds_of("EventOccurrenceUsage")
_CLASSIFIERS = kinds_of("Classifier")

_METADATA = frozenset({"MetadataUsage", "MetadataFeature"})
_IMPORTS = kinds_of("Import")
_TYPING = frozenset({"FeatureTyping", "TypeFeaturing"})
_MEMBER = frozenset({"importedMembership"})
IMPORTED = _MEMBER | {"importedNamespace"}
"""Relations of imports."""

_OF_TYPES = """
    Specialization FeatureTyping Conjugation Disjoining Unioning Intersecting Differencing
    TypeFeaturing specific general type conjugatedType originalType typeDisjoined disjoiningType
    featuringType
"""
_OF_FEATURES = """
    Subsetting Redefinition ReferenceSubsetting CrossSubsetting FeatureChaining FeatureInverting
    typedFeature subsettingFeature subsettedFeature redefiningFeature redefinedFeature
    featureInverted invertingFeature featureOfType
"""
TARGET_KINDS: dict[str, frozenset[str]] = {
    **dict.fromkeys(_OF_TYPES.split(), kinds_of("Type")),
    **dict.fromkeys(_OF_FEATURES.split(), kinds_of("Feature")),
    **dict.fromkeys(("Subclassification", "subclassifier", "superclassifier"), _CLASSIFIERS),
    "ConjugatedPortTyping": kinds_of("PortDefinition"),
    "importedNamespace": NAMESPACES,
}
"""Metaclasses that the target of a relation may have. Other relations accept any element."""


class LookupContext(NamedTuple):
    """Where the lookup of the first name of a reference begins, and what it skips.

    - ``scope``: the lookup goes from this namespace outwards. With ``operand`` it looks only in the
      result of that expression, with ``before`` only in the target of the link before it.
    - ``inherited``: in ``scope`` itself only inherited members count. A feature redefines what its
      owner inherits (KerML 8.2.3.5.2).
    - ``without``: this node is not found by its effective name, because the lookup computes it.
    - ``everything``: private members are visible, as for ``import all``.
    - ``reference``: the reference, if its first name is ``$``.
    - ``past_subjects``: in ``scope`` itself subjects are skipped. The element that satisfies a
      requirement is not the satisfaction's own subject, which may have the same name.
    - ``importing``: namespaces that the name is imported into. Their imports are searched last,
      because they may depend on the result.
    - ``is_metadata``: the lookup is for the type of metadata. Implied generals of the annotated
      element are skipped, because they may depend on the result.
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


def find_context(node: Node, relation: Relation) -> LookupContext:
    """Return where the first name of a relation of ``node`` is looked up."""
    context = _make_context(node, relation)
    begins_globally = relation.reference.chain[0][0] == "$"
    return context._replace(reference=relation.reference) if begins_globally else context


def _make_context(node: Node, relation: Relation) -> LookupContext:
    kind = relation.kind
    if kind == "Membership":
        return _make_membership_context(node)
    # The ends of a connector are features of its owner, not of the connector.
    if kind == "ReferenceSubsetting" and (_is_connector_end(node) or _is_event_of_message(node)):
        return LookupContext(_find_end_scope(node.owner), without=node)
    if kind == "Redefinition":
        return LookupContext(
            _find_namespace(node), inherited=len(relation.reference.chain) == 1, without=node
        )
    if kind in _TYPING:
        scope = node if kind == "TypeFeaturing" else _find_expression_scope(node)
        return LookupContext(scope, without=node, is_metadata=node.kind in _METADATA)
    if kind in IMPORTED:
        return _make_import_context(
            node, everything=kind in _MEMBER and bool(node.attributes.get("isImportAll"))
        )
    # Each FeatureChaining after the first is looked up in the target of the one before.
    before = _find_previous_link(node, relation) if kind == "FeatureChaining" else None
    return LookupContext(_find_namespace(node), without=node, before=before)


def _make_import_context(node: Node, everything: bool) -> LookupContext:
    """Return the context of an import. Another import owns the package of a filtered one."""
    scope = _find_namespace(node)
    importing = [] if scope is None else [scope]
    while importing and importing[-1].owner is not None and importing[-1].owner.kind in _IMPORTS:
        namespace = _find_namespace(importing[-1].owner)
        if namespace is None:
            break
        importing.append(namespace)
    return LookupContext(scope, without=node, everything=everything, importing=tuple(importing))


def _find_previous_link(node: Node, relation: Relation) -> Relation | None:
    links = [link for link in node.relations if link.kind == "FeatureChaining"]
    index = links.index(relation)
    return links[index - 1] if index else None


def _make_membership_context(node: Node) -> LookupContext:
    if node.kind == "Membership":
        return LookupContext(_find_namespace(node), without=node)
    if node.kind == "FeatureChainExpression":
        return LookupContext(None, operand=node.members[0] if node.members else None)
    if node.kind == "AssignmentActionUsage":
        operand = _find_assigned_operand(node)
        return LookupContext(None, operand=operand) if operand else LookupContext(node)
    if node.kind in _TRANSPARENT:
        scope = _find_expression_scope(node)
        is_subject_binding = scope is not None and scope.kind == "SatisfyRequirementUsage"
        return LookupContext(scope, past_subjects=is_subject_binding)
    return (
        LookupContext(_find_namespace(node))
        if node.kind == "TransitionUsage"
        else LookupContext(node)
    )


def _find_assigned_operand(node: Node) -> Node | None:
    """Return the expression before the dot of ``assign x.y := z``."""
    parameter = node.find_member("ParameterMembership")
    return parameter.find_member("FeatureValue") if parameter else None


def _is_connector_end(node: Node) -> bool:
    owner = node.owner
    return (
        owner is not None
        and owner.kind in _CONNECTORS
        and (node.membership == "EndFeatureMembership" or bool(node.attributes.get("isEnd")))
    )


def _is_event_of_message(node: Node) -> bool:
    """Whether an event begins or ends a message: ``message from a to b`` (8.2.2.16.2)."""
    owner = node.owner
    is_parameter = node.membership == "ParameterMembership"
    return is_parameter and owner is not None and owner.kind in _FLOWS and node.kind in _EVENTS


def _find_end_scope(connector: Node | None) -> Node | None:
    """Return the scope in which the ends of a connector are looked up.

    The ends of the succession of a transition are looked up outside of the transition.
    """
    scope = _find_namespace(connector) if connector else None
    return (
        _find_namespace(scope) if scope is not None and scope.kind == "TransitionUsage" else scope
    )


def _find_namespace(node: Node) -> Node | None:
    """Return the nearest namespace around ``node``."""
    owner = node.owner
    while owner is not None and owner.kind not in NAMESPACES:
        owner = owner.owner
    return owner


def _find_expression_scope(node: Node) -> Node | None:
    """Return the nearest namespace around ``node`` in which an expression is looked up."""
    owner = _find_namespace(node)
    while owner is not None and (node.membership == "FeatureValue" or owner.kind in _TRANSPARENT):
        node = owner
        owner = _find_namespace(node)
    return owner


def find_outer_scope(scope: Node) -> Node | None:
    """Return the next scope outwards."""
    owner = scope.owner
    while owner is not None and (owner.kind not in NAMESPACES or owner.kind in _TRANSPARENT):
        owner = owner.owner
    return owner


def list_scopes(context: LookupContext) -> list[Node]:
    """Return the namespaces in which a name is looked up, nearest first."""
    scopes = []
    scope = context.scope
    while scope is not None:
        scopes.append(scope)
        scope = find_outer_scope(scope)
    return scopes
