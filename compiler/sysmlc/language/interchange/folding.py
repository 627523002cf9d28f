"""Arguments of expressions, folded out of the parameters that carry them (KerML 8.2.5.8.1)."""

from sysmlc.language.interchange.frames import Frame, complete
from sysmlc.language.interchange.metamodel import ENDS, NAMING, RELATIONS
from sysmlc.language.interchange.references import References
from sysmlc.language.metaclasses import USAGES, is_composite, kinds_of
from sysmlc.language.tree import Node, Relation

_CONDITIONAL = {"if", "and", "or", "implies", "??"}


def fold_arguments(result: Node) -> None:
    """Let the result of a constructor own what its parameters carry (KerML 8.2.5.8.3)."""
    for index, node in enumerate(result.members):
        if node.membership == "ParameterMembership" and node.kind == "Feature":
            value = _carried(node)
            if value is not node:
                value.membership, value.role, value.owner = node.membership, "", result
                result.members[index] = value


def argument(node: Node, owner: Node) -> Node:
    """The expression that a parameter of an expression only carries, else the parameter."""
    value = _carried(node)
    if value is node:
        return node
    inner = value.members[0] if len(value.members) == 1 and not value.relations else None
    is_reference = value.kind == "FeatureReferenceExpression" and inner is not None
    if inner is not None and is_reference and _is_late(owner):
        value = inner
        value.role = "expression"
    else:
        value.role = ""
    return value


def _carried(node: Node) -> Node:
    """The value of a parameter that has nothing but a value, else the parameter."""
    carries = node.kind == "Feature" and not (node.name or node.relations)
    if not carries or [member.membership for member in node.members] != ["FeatureValue"]:
        return node
    return node.members[0]


def _is_late(owner: Node) -> bool:
    """Whether the next argument is only evaluated when others say so (KerML 1.0, 8.2.5.8.1)."""
    if owner.kind == "TriggerInvocationExpression":
        return owner.attributes.get("kind", "when") == "when"
    return owner.attributes.get("operator") in _CONDITIONAL and bool(owner.members)


_WITH_RESULT = NAMING - {"ConstructorExpression"}
"""Expressions whose empty result is in no text; that of a constructor has the arguments."""
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

_DROPPED_RELATIONS = {"PortConjugation"}


class Folding:
    """Puts closed frames into the nodes of the frames around them."""

    def __init__(self, references: References) -> None:
        self._references = references

    def relationship(self, frame: Frame, owner: Frame) -> None:
        """Take a closed ``ownedRelationship`` of ``owner``."""
        kind = frame.kind
        if kind in _OWNING and frame.owned:
            for inner in frame.owned:
                self._own(inner, frame, owner)
        elif kind in RELATIONS and not (kind == "Annotation" and frame.owned):
            self._relate(frame, owner)
        elif kind in _IMPORTS:
            self._import(frame, owner)
        elif kind == "Annotation":
            for inner in frame.owned:
                self._member(inner, frame, owner, "Annotation")
        elif kind == "Membership" or kind in _OWNING:
            self._name(frame, owner)
        elif kind not in _DROPPED_RELATIONS:
            self._free(frame)
            owner.node.add_member(frame.node)

    def related(self, frame: Frame, owner: Frame) -> None:
        """Take a closed ``ownedRelatedElement`` of the relationship ``owner``."""
        complete(frame.node)
        if frame.kind in ENDS:
            self._free(frame)
        frame.is_chain = _is_chain(frame.node)
        owner.owned.append(frame)

    def _own(self, inner: Frame, frame: Frame, owner: Frame) -> None:
        node = inner.node
        if inner.kind == "ConjugatedPortDefinition":
            self._references.stand_for(inner.id, owner.node)
        elif inner.is_chain and owner.kind in NAMING and frame.kind == "OwningMembership":
            reference = self._references.joined(node)
            owner.node.relations.append(Relation("Membership", reference))
        elif not _is_implicit(node, frame, owner):
            self._member(inner, frame, owner, frame.kind)

    def _member(self, inner: Frame, frame: Frame, owner: Frame, membership: str) -> None:
        node = inner.node
        if membership in _PARAMETERS:
            node.attributes.pop("direction", None)
        if owner.kind == "ConstructorExpression":
            fold_arguments(node)
        elif owner.kind in _INSTANTIATIONS:
            node = argument(node, owner.node)
        node.membership = membership if node is inner.node else "ParameterMembership"
        if not node.role:
            node.role = _role(frame)
        node.visibility = _visibility(frame, owner)
        owner.node.add_member(node)
        _settle(node)
        self._references.stand_for(frame.id, node)

    def _relate(self, frame: Frame, owner: Frame) -> None:
        feature = RELATIONS[frame.kind]
        for inner in frame.owned:
            if inner.is_chain:
                reference = self._references.joined(inner.node)
                owner.node.relations.append(Relation(frame.kind, reference))
                return
            self._member(inner, frame, owner, "")
        for target in frame.targets.get(feature, ()):
            reference = self._references.add([target], feature, frame.node)
            owner.node.relations.append(Relation(frame.kind, reference))

    def _import(self, frame: Frame, owner: Frame) -> None:
        feature = _IMPORTS[frame.kind]
        for inner in frame.owned:
            frame.node.add_member(inner.node)
            frame.targets.pop(feature, None)
        self._ends(frame, (feature,))
        visibility = str(frame.node.attributes.pop("visibility", "private"))
        if frame.kind in _EXPOSES:
            frame.node.attributes.pop("isImportAll", None)
        else:
            frame.node.visibility = visibility
        owner.node.add_member(frame.node)

    def _name(self, frame: Frame, owner: Frame) -> None:
        """A membership that does not own its member: an alias, an initial node, a referent."""
        if owner.kind in NAMING:
            for target in frame.targets.get("memberElement", ()):
                reference = self._references.add([target], "memberElement", frame.node)
                owner.node.relations.append(Relation("Membership", reference))
            return
        node = frame.node
        node.kind = "Membership"
        node.name = _text(node, "memberName")
        node.short_name = _text(node, "memberShortName")
        node.visibility = _text(node, "visibility") or ""
        for target in frame.targets.get("memberElement", ()):
            reference = self._references.add([target], "memberElement", node)
            node.relations.append(Relation("Membership", reference))
        owner.node.add_member(node)
        self._references.stand_for(frame.id, node)

    def _free(self, frame: Frame) -> None:
        self._ends(frame, ENDS.get(frame.kind, ()))

    def _ends(self, frame: Frame, features: tuple[str, ...]) -> None:
        chains = {inner.id: inner.node for inner in frame.owned if inner.is_chain}
        for feature in features:
            for target in frame.targets.get(feature, ()):
                chain = chains.get(target.lstrip("#"))
                if chain is not None:
                    reference = self._references.joined(chain)
                else:
                    reference = self._references.add([target], feature, frame.node)
                frame.node.relations.append(Relation(feature, reference))


def _is_chain(node: Node) -> bool:
    """Whether it is a feature that is nothing but a chain of others."""
    return (
        node.kind == "Feature"
        and len(node.relations) > 1
        and not (node.name or node.members)
        and all(relation.kind == "FeatureChaining" for relation in node.relations)
    )


def _is_bare(node: Node) -> bool:
    stated = node.name or node.short_name or node.members or node.relations or node.attributes
    return node.kind in _BARE and not stated


def _is_implicit(node: Node, frame: Frame, owner: Frame) -> bool:
    """Whether the element follows from others, so that the text does not say it.

    These are empty results of expressions, empty multiplicities, and the empty features by
    which chains, assignments and transitions reach their targets.
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
    return frame.kind == "FeatureMembership" and _is_bare(node) and _reaches(owner.node)


def _reaches(owner: Node) -> bool:
    """Whether an empty feature of ``owner`` only leads to the target of a chain or a step."""
    nameless = not (owner.name or owner.relations)
    return owner.kind == "TransitionUsage" or (owner.kind in _BARE and nameless)


def _role(frame: Frame) -> str:
    if frame.kind == "FeatureValue":
        facts = frame.node.attributes
        sign = ":=" if facts.get("isInitial") else "="
        return ("default" if sign == "=" else "default :=") if facts.get("isDefault") else sign
    return str(frame.node.attributes.get("kind", "")) if frame.kind in _WITH_ROLE else ""


def _visibility(frame: Frame, owner: Frame) -> str:
    """As it is stated; parameters of expressions are private because nobody can name them."""
    if frame.kind in _PARAMETERS and owner.kind in _EXPRESSIONS:
        return ""
    return str(frame.node.attributes.get("visibility", ""))


def _settle(node: Node) -> None:
    """Keep only what a text would say."""
    facts = node.attributes
    if node.kind == "SuccessionAsUsage" and _leads_on(node):
        del node.members[1]
    if node.membership == "EndFeatureMembership":
        facts.pop("isEnd", None)
        facts.pop("isConstant", None)
    if facts.get("isVariation") or node.kind == "EnumerationDefinition":
        facts.pop("isAbstract", None)
    if node.kind == "EnumerationDefinition":
        facts.pop("isVariation", None)
    if node.kind in USAGES:
        was_composite = facts.pop("isComposite", False)
        if facts.get("isEnd"):
            facts.pop("isConstant", None)
        if not was_composite and is_composite(node):
            facts["isReference"] = True
    if node.owner is not None and node.owner.kind == "FlowEnd":
        facts.pop("direction", None)


def _leads_on(node: Node) -> bool:
    """Whether it is a ``then`` before an element: its end there is empty (SysML 8.2.2.9.3)."""
    ends = [member for member in node.members if member.membership == "EndFeatureMembership"]
    return node.members == ends and len(ends) == 2 and _is_bare(ends[1])


def _text(node: Node, feature: str) -> str | None:
    value = node.attributes.pop(feature, None)
    return None if value is None else str(value)
