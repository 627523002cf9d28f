"""Folding: relationships of an interchange file become members and relations of the tree.

``docs/sysml-v2-tree.md`` has the table. A relationship that only states how an owner owns one
element becomes the membership of that element. Parameters that only carry an argument are dropped
(KerML 8.2.5.8.1).
"""

from sysmlc.language.interchange.element_ids import References
from sysmlc.language.interchange.frames import Frame, complete_literal
from sysmlc.language.interchange.metamodel import (
    REFERRING_KINDS,
    RELATION_TARGETS,
)
from sysmlc.language.metaclasses import RELATIONSHIP_ENDS, USAGES, is_composite, kinds_of
from sysmlc.language.tree import Node, Relation

_LAZY_OPERATORS = {"if", "and", "or", "implies", "??"}


def _fold_constructor_arguments(result: Node) -> None:
    """Let the result of a constructor own the values of its parameters (KerML 8.2.5.8.3)."""
    for index, node in enumerate(result.members):
        if node.membership == "ParameterMembership" and node.kind == "Feature":
            value = _find_carried_value(node)
            if value is not node:
                value.membership, value.role, value.owner = node.membership, "", result
                result.members[index] = value


def _unwrap_argument(node: Node, owner: Node) -> Node:
    """Return the expression of a parameter that only carries an argument, else the parameter."""
    value = _find_carried_value(node)
    if value is node:
        return node
    inner = value.members[0] if len(value.members) == 1 and not value.relations else None
    is_reference = value.kind == "FeatureReferenceExpression" and inner is not None
    if inner is not None and is_reference and _is_evaluated_lazily(owner):
        value = inner
        value.role = "expression"
    else:
        value.role = ""
    return value


def _find_carried_value(node: Node) -> Node:
    """Return the value of a parameter that has nothing but a value, else the parameter."""
    carries = node.kind == "Feature" and not (node.name or node.relations)
    if not carries or [member.membership for member in node.members] != ["FeatureValue"]:
        return node
    return node.members[0]


def _is_evaluated_lazily(owner: Node) -> bool:
    """Whether the next argument is evaluated only on demand (KerML 1.0, 8.2.5.8.1)."""
    if owner.kind == "TriggerInvocationExpression":
        return owner.attributes.get("kind", "when") == "when"
    return owner.attributes.get("operator") in _LAZY_OPERATORS and bool(owner.members)


_WITH_RESULT = REFERRING_KINDS - {"ConstructorExpression"}
"""Expressions whose empty result no text states. That of a constructor has the arguments."""
_EXPRESSIONS = kinds_of("Expression")
_INSTANTIATIONS = kinds_of("InstantiationExpression")
_OWNING = kinds_of("OwningMembership")
_IMPORTS = dict.fromkeys(kinds_of("MembershipImport"), "importedMembership") | dict.fromkeys(
    kinds_of("NamespaceImport"), "importedNamespace"
)
_EXPOSES = kinds_of("Expose")
_PARAMETERS = kinds_of("ParameterMembership")
_BARE = {"Feature", "ReferenceUsage"}
_WITH_ROLE = (
    kinds_of("StateSubactionMembership")
    | kinds_of("TransitionFeatureMembership")
    | {"RequirementConstraintMembership"}
)

_DROPPED_RELATIONSHIPS = {"PortConjugation"}


class Folding:
    """Folds each frame, when its XML element closes, into the node of the enclosing frame."""

    def __init__(self, references: References) -> None:
        self._references = references

    def fold_relationship(self, frame: Frame, owner: Frame) -> None:
        """Fold a closed ``ownedRelationship`` into its owner."""
        kind = frame.kind
        if kind in _OWNING and frame.owned:
            for inner in frame.owned:
                self._fold_owned(inner, frame, owner)
        elif kind in RELATION_TARGETS and not (kind == "Annotation" and frame.owned):
            self._add_relations(frame, owner)
        elif kind in _IMPORTS:
            self._add_import(frame, owner)
        elif kind == "Annotation":
            for inner in frame.owned:
                self._add_member(inner, frame, owner, "Annotation")
        elif kind == "Membership" or kind in _OWNING:
            self._add_membership(frame, owner)
        elif kind not in _DROPPED_RELATIONSHIPS:
            self._add_end_relations(frame)
            owner.node.add_member(frame.node)

    def fold_related_element(self, frame: Frame, owner: Frame) -> None:
        """Add a closed ``ownedRelatedElement`` to the relationship ``owner``."""
        complete_literal(frame.node)
        if frame.kind in RELATIONSHIP_ENDS:
            self._add_end_relations(frame)
        frame.is_chain = _is_chain(frame.node)
        owner.owned.append(frame)

    def _fold_owned(self, inner: Frame, frame: Frame, owner: Frame) -> None:
        node = inner.node
        if inner.kind == "ConjugatedPortDefinition":
            self._references.bind_id(inner.id, owner.node)
        elif inner.is_chain and owner.kind in REFERRING_KINDS and frame.kind == "OwningMembership":
            reference = self._references.join_chain(node)
            owner.node.relations.append(Relation("Membership", reference))
        elif not _is_implicit(node, frame, owner):
            self._add_member(inner, frame, owner, frame.kind)

    def _add_member(self, inner: Frame, frame: Frame, owner: Frame, membership: str) -> None:
        node = inner.node
        if membership in _PARAMETERS:
            node.attributes.pop("direction", None)
        if owner.kind == "ConstructorExpression":
            _fold_constructor_arguments(node)
        elif owner.kind in _INSTANTIATIONS:
            node = _unwrap_argument(node, owner.node)
        node.membership = membership if node is inner.node else "ParameterMembership"
        if not node.role:
            node.role = _find_role(frame)
        node.visibility = _find_visibility(frame, owner)
        owner.node.add_member(node)
        _drop_derived_attributes(node)
        self._references.bind_id(frame.id, node)

    def _add_relations(self, frame: Frame, owner: Frame) -> None:
        feature = RELATION_TARGETS[frame.kind]
        for inner in frame.owned:
            if inner.is_chain:
                reference = self._references.join_chain(inner.node)
                owner.node.relations.append(Relation(frame.kind, reference))
                return
            self._add_member(inner, frame, owner, "")
        for target in frame.targets.get(feature, ()):
            reference = self._references.add([target], feature, frame.node)
            owner.node.relations.append(Relation(frame.kind, reference))

    def _add_import(self, frame: Frame, owner: Frame) -> None:
        feature = _IMPORTS[frame.kind]
        for inner in frame.owned:
            frame.node.add_member(inner.node)
            frame.targets.pop(feature, None)
        self._add_relations_to(frame, (feature,))
        visibility = str(frame.node.attributes.pop("visibility", "private"))
        if frame.kind in _EXPOSES:
            frame.node.attributes.pop("isImportAll", None)
        else:
            frame.node.visibility = visibility
        owner.node.add_member(frame.node)

    def _add_membership(self, frame: Frame, owner: Frame) -> None:
        """Add a membership that does not own its member: an alias, an initial node, a referent."""
        if owner.kind in REFERRING_KINDS:
            for target in frame.targets.get("memberElement", ()):
                reference = self._references.add([target], "memberElement", frame.node)
                owner.node.relations.append(Relation("Membership", reference))
            return
        node = frame.node
        node.kind = "Membership"
        node.name = _pop_text(node, "memberName")
        node.short_name = _pop_text(node, "memberShortName")
        node.visibility = _pop_text(node, "visibility") or ""
        for target in frame.targets.get("memberElement", ()):
            reference = self._references.add([target], "memberElement", node)
            node.relations.append(Relation("Membership", reference))
        owner.node.add_member(node)
        self._references.bind_id(frame.id, node)

    def _add_end_relations(self, frame: Frame) -> None:
        self._add_relations_to(frame, RELATIONSHIP_ENDS.get(frame.kind, ()))

    def _add_relations_to(self, frame: Frame, features: tuple[str, ...]) -> None:
        chains = {inner.id: inner.node for inner in frame.owned if inner.is_chain}
        for feature in features:
            for target in frame.targets.get(feature, ()):
                chain = chains.get(target.lstrip("#"))
                if chain is not None:
                    reference = self._references.join_chain(chain)
                else:
                    reference = self._references.add([target], feature, frame.node)
                frame.node.relations.append(Relation(feature, reference))


def _is_chain(node: Node) -> bool:
    """Whether a node is a feature that consists of a feature chain alone."""
    return (
        node.kind == "Feature"
        and len(node.relations) > 1
        and not (node.name or node.members)
        and all(relation.kind == "FeatureChaining" for relation in node.relations)
    )


def _is_bare(node: Node) -> bool:
    has_content = node.name or node.short_name or node.members or node.relations or node.attributes
    return node.kind in _BARE and not has_content


def _is_implicit(node: Node, frame: Frame, owner: Frame) -> bool:
    """Whether an element follows from others, so that a text does not state it.

    These are empty results of expressions, empty multiplicities, and the empty features by which
    chains, assignments and transitions reach their targets.
    """
    if node.kind == "Multiplicity":
        return not (node.name or node.short_name or node.members or node.relations)
    if frame.kind == "ReturnParameterMembership" and owner.kind in _EXPRESSIONS:
        if node.attributes.get("direction") == "out" and len(node.attributes) == 1:
            del node.attributes["direction"]
        return _is_bare(node) and owner.kind in _WITH_RESULT
    if owner.kind == "TransitionUsage" and frame.kind == "ParameterMembership":
        node.name = None
        return False
    return frame.kind == "FeatureMembership" and _is_bare(node) and _has_target_features(owner.node)


def _has_target_features(owner: Node) -> bool:
    """Whether the owner implies its empty features.

    Transitions, chains and assignments reach their targets through empty features.
    """
    nameless = not (owner.name or owner.relations)
    return owner.kind == "TransitionUsage" or (owner.kind in _BARE and nameless)


def _find_role(frame: Frame) -> str:
    if frame.kind == "FeatureValue":
        attributes = frame.node.attributes
        sign = ":=" if attributes.get("isInitial") else "="
        return ("default" if sign == "=" else "default :=") if attributes.get("isDefault") else sign
    return str(frame.node.attributes.get("kind", "")) if frame.kind in _WITH_ROLE else ""


def _find_visibility(frame: Frame, owner: Frame) -> str:
    """Return the stated visibility, without that of parameters of expressions.

    Interchange files state that these are private; a text does not.
    """
    if frame.kind in _PARAMETERS and owner.kind in _EXPRESSIONS:
        return ""
    return str(frame.node.attributes.get("visibility", ""))


def _drop_derived_attributes(node: Node) -> None:
    """Drop attributes and members that a text would not state."""
    attributes = node.attributes
    if node.kind == "SuccessionAsUsage" and _has_empty_target(node):
        del node.members[1]
    if node.membership == "EndFeatureMembership":
        attributes.pop("isEnd", None)
        attributes.pop("isConstant", None)
    if attributes.get("isVariation") or node.kind == "EnumerationDefinition":
        attributes.pop("isAbstract", None)
    if node.kind == "EnumerationDefinition":
        attributes.pop("isVariation", None)
    if node.kind in USAGES:
        # Files state isComposite, texts state `ref` where a usage would be composite otherwise.
        was_composite = attributes.pop("isComposite", False)
        if attributes.get("isEnd"):
            attributes.pop("isConstant", None)
        if not was_composite and is_composite(node):
            attributes["isReference"] = True
    if node.owner is not None and node.owner.kind == "FlowEnd":
        attributes.pop("direction", None)


def _has_empty_target(node: Node) -> bool:
    """Whether a succession is a ``then`` before an element, with an empty end (SysML 8.2.2.9.3)."""
    ends = [member for member in node.members if member.membership == "EndFeatureMembership"]
    return node.members == ends and len(ends) == 2 and _is_bare(ends[1])


def _pop_text(node: Node, feature: str) -> str | None:
    value = node.attributes.pop(feature, None)
    return None if value is None else str(value)
