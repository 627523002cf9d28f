"""Unfolding: restore the relationships and elements of the metamodel that the tree folds.

KerML 1.0, 8.3 and 8.2.5.8. The inverse of ``folding``.
"""

from collections.abc import Iterator

from sysmlc.language.interchange.effective_names import find_accepted
from sysmlc.language.interchange.metamodel import (
    OWN_ENDS,
    REFERRING_KINDS,
    RELATION_TARGETS,
    list_features,
)
from sysmlc.language.metaclasses import (
    RELATIONSHIP_ENDS,
    USAGES,
    is_a,
    is_composite,
    is_end,
    kinds_of,
)
from sysmlc.language.tree import AttributeValue, Node, Reference, Relation


class Element:
    """An element of an interchange file: metaclass, attributes, references, owned elements.

    ``node`` is the node that it represents, for a membership the node of its member. Elements that
    the tree folds or omits have none. ``targets`` are the references: the name of a feature with an
    element of the same file, or with a link of a reference of the tree.
    """

    __slots__ = ("attributes", "id", "kind", "node", "owned", "targets")

    def __init__(self, kind: str, node: Node | None = None) -> None:
        self.kind = kind
        self.node = node
        self.attributes: dict[str, AttributeValue] = {}
        self.targets: list[tuple[str, Element | Link]] = []
        self.owned: list[Element] = []
        self.id = ""

    def add_owned(self, element: "Element") -> "Element":
        """Append ``element`` to the owned elements, and return it."""
        self.owned.append(element)
        return element


class Link:
    """One link of a reference of the tree, as the target of a feature."""

    __slots__ = ("index", "reference")

    def __init__(self, reference: Reference, index: int = -1) -> None:
        self.reference = reference
        self.index = index % len(reference.chain) if reference.chain else 0

    @property
    def node(self) -> Node | None:
        """The element that the link leads to, or None if it is unresolved."""
        targets = self.reference.targets
        return targets[self.index] if targets and self.index < len(targets) else None

    @property
    def text(self) -> str:
        """The name that the reference has for the element."""
        return "::".join(self.reference.chain[self.index]) if self.reference.chain else ""


def walk_elements(root: Element) -> Iterator[tuple[Element, Element | None]]:
    """Yield the element and all below it with their owners, owners first."""
    stack: list[tuple[Element, Element | None]] = [(root, None)]
    while stack:
        element, owner = stack.pop()
        yield element, owner
        stack.extend((owned, element) for owned in reversed(element.owned))


_END = "EndFeatureMembership"
_RESULTLESS = {"ConstructorExpression", "AssignmentActionUsage", "TransitionUsage"}


def _wrap_argument(value: Element) -> Element:
    """Return the parameter that carries an argument (KerML 1.0, 8.2.5.8.1)."""
    parameter = Element("Feature")
    parameter.attributes["direction"] = "in"
    parameter.add_owned(Element("FeatureValue")).add_owned(value)
    return parameter


def _wrap_lazy_argument(value: Element) -> Element:
    """Return the reference to an expression that is evaluated only on demand."""
    reference = Element("FeatureReferenceExpression")
    reference.add_owned(Element("FeatureMembership")).add_owned(value)
    reference.add_owned(_make_result())
    return reference


def _add_implicit(element: Element, node: Node) -> None:
    """Add the elements that follow from the kind of the node, unless the node owns them."""
    if node.kind in REFERRING_KINDS and node.kind not in _RESULTLESS:
        if not any(member.membership == "ReturnParameterMembership" for member in node.members):
            element.add_owned(_make_result())
    elif node.kind == "PortDefinition":
        element.add_owned(Element("OwningMembership")).add_owned(_make_conjugate(element))
    elif node.kind == "SuccessionAsUsage" and [member.membership for member in node.members] == [
        _END
    ]:
        element.add_owned(Element(_END)).add_owned(Element("ReferenceUsage")).attributes[
            "isEnd"
        ] = True
    elif node.attributes.get("isIndividual") and is_a(node.kind, "OccurrenceDefinition"):
        element.add_owned(Element("OwningMembership")).add_owned(Element("Multiplicity"))


def _make_result() -> Element:
    membership = Element("ReturnParameterMembership")
    membership.add_owned(Element("Feature")).attributes["direction"] = "out"
    return membership


def _make_conjugate(definition: Element) -> Element:
    """Return the conjugated definition of a port definition (SysML 2.0, 8.2.2.12)."""
    conjugate = Element("ConjugatedPortDefinition")
    conjugation = conjugate.add_owned(Element("PortConjugation"))
    conjugation.targets += [("conjugatedType", conjugate), ("originalPortDefinition", definition)]
    return conjugate


_INSTANTIATIONS = kinds_of("InstantiationExpression")
_EXPRESSIONS = kinds_of("Expression")
_PARAMETERS = kinds_of("ParameterMembership")
_IMPORTS = {"MembershipImport": "importedMembership", "NamespaceImport": "importedNamespace"}
_MEMBERSHIPS_WITH_KIND = kinds_of("StateSubactionMembership") | kinds_of(
    "TransitionFeatureMembership"
)
_REQUIREMENTS = kinds_of("RequirementConstraintMembership")


def unfold(node: Node) -> Element:
    """Return the element of a node with everything that it owns, without recursion."""
    root = Element(node.kind, node)
    worklist = [root]
    while worklist:
        _fill_element(worklist.pop(), worklist)
    return root


def _fill_element(element: Element, worklist: list[Element]) -> None:
    """Set the attributes and owned elements; unfinished elements are added to ``worklist``."""
    node = element.node
    if node is None:
        return
    _set_attributes(element, node)
    if node.kind in RELATIONSHIP_ENDS and node.membership:
        _unfold_ends(element, node, worklist)
    else:
        for item in _iter_in_order(node):
            if isinstance(item, Relation):
                element.add_owned(_make_relationship(item, element))
            else:
                _add_member(element, item, worklist)
    _add_implicit(element, node)


def _make_element(node: Node, worklist: list[Element]) -> Element:
    element = Element(node.kind, node)
    worklist.append(element)
    return element


def _iter_in_order(node: Node) -> Iterator[Relation | Node]:
    """Yield relations and members in the order of the text or file.

    The source of a transition comes before its parameters, which no text has (SysML 8.2.2.18.3).
    """
    relations = list(node.relations)
    members = list(node.members)
    if node.kind == "TransitionUsage":
        yield from (relation for relation in relations if relation.kind == "Membership")
        relations = [relation for relation in relations if relation.kind != "Membership"]
    while relations and members:
        is_relation_first = relations[0].reference.start <= members[0].start
        yield relations.pop(0) if is_relation_first else members.pop(0)
    yield from relations
    yield from members


# -- what an element says --------------------------------------------------------------------


def _set_attributes(element: Element, node: Node) -> None:
    accepted = find_accepted(node)
    name = node.name if accepted is None else accepted.name
    names = {"declaredName": name, "declaredShortName": node.short_name}
    element.attributes.update({name: text for name, text in names.items() if text is not None})
    features = list_features(node.kind)
    element.attributes.update(
        {name: fact for name, fact in node.attributes.items() if name in features}
    )
    if node.membership in _PARAMETERS and not _is_argument(node):
        is_result = is_a(node.membership, "ReturnParameterMembership")
        element.attributes.setdefault("direction", "out" if is_result else "in")
    if is_end(node):
        element.attributes["isEnd"] = True
    if node.attributes.get("isVariation") or node.kind == "EnumerationDefinition":
        element.attributes["isAbstract"] = True
    if node.kind in USAGES:
        _complete_usage(element, node)


def _complete_usage(element: Element, node: Node) -> None:
    """Set the attributes that the language implies: ``isComposite``, and ``isConstant`` of ends."""
    if is_composite(node):
        element.attributes["isComposite"] = True
    owner = node.owner.kind if node.owner else ""
    owner_varies = is_a(owner, "OccurrenceDefinition") or is_a(owner, "OccurrenceUsage")
    if is_end(node) and owner_varies:
        element.attributes["isConstant"] = True


def _unfold_ends(element: Element, node: Node, worklist: list[Element]) -> None:
    """Add the ends of a relationship that is an element of its own.

    An end becomes a feature of the relationship. A feature chain becomes an owned element.
    """
    for relation in node.relations:
        if len(relation.reference.chain) > 1:
            element.targets.append(
                (relation.kind, element.add_owned(_make_chain(relation.reference)))
            )
        else:
            element.targets.append((relation.kind, Link(relation.reference)))
    for member in node.members:
        _add_member(element, member, worklist)


# -- relationships ---------------------------------------------------------------------------


def _make_relationship(relation: Relation, owner: Element) -> Element:
    reference = relation.reference
    if relation.kind == "Membership":
        return _make_reference_membership(reference)
    relationship = Element(relation.kind)
    own_end = OWN_ENDS.get(relation.kind)
    if own_end:
        relationship.targets.append((own_end, owner))
    feature = RELATION_TARGETS.get(relation.kind, relation.kind)
    if len(reference.chain) > 1:
        relationship.targets.append((feature, relationship.add_owned(_make_chain(reference))))
    else:
        relationship.targets.append((feature, Link(reference)))
    return relationship


def _make_reference_membership(reference: Reference) -> Element:
    """Return the membership by which an expression refers to an element."""
    if len(reference.chain) > 1:
        membership = Element("OwningMembership")
        membership.add_owned(_make_chain(reference))
        return membership
    membership = Element("Membership")
    membership.targets.append(("memberElement", Link(reference)))
    return membership


def _make_chain(reference: Reference) -> Element:
    feature = Element("Feature")
    for index in range(len(reference.chain)):
        chaining = feature.add_owned(Element("FeatureChaining"))
        chaining.targets.append(("chainingFeature", Link(reference, index)))
    return feature


# -- members ---------------------------------------------------------------------------------


def _add_member(owner: Element, node: Node, worklist: list[Element]) -> None:
    if is_a(node.kind, "Import"):
        owner.add_owned(_make_import(node, worklist))
    elif node.kind == "Membership":
        owner.add_owned(_make_alias(node, worklist))
    elif not node.membership:
        owner.add_owned(_make_element(node, worklist))
    else:
        owner.add_owned(_make_membership(owner, node, worklist))


def _make_import(node: Node, worklist: list[Element]) -> Element:
    """Return the element of an import; it owns the package of a filtered one."""
    element = Element(node.kind, node)
    element.attributes.update(node.attributes)
    if node.visibility:
        element.attributes["visibility"] = node.visibility
    if is_a(node.kind, "Expose"):
        element.attributes.update(isImportAll=True, visibility="protected")
    for relation in node.relations:
        element.targets.append((relation.kind, Link(relation.reference)))
    feature = next(end for kind, end in _IMPORTS.items() if is_a(node.kind, kind))
    for member in node.members:
        if is_a(member.kind, "Package"):
            element.targets.append((feature, element.add_owned(_make_element(member, worklist))))
        else:
            _add_member(element, member, worklist)
    return element


def _make_alias(node: Node, worklist: list[Element]) -> Element:
    alias = Element("Membership", node)
    names = {"memberName": node.name, "memberShortName": node.short_name}
    names["visibility"] = node.visibility or None
    alias.attributes.update({name: text for name, text in names.items() if text is not None})
    for relation in node.relations:
        alias.targets.append(("memberElement", Link(relation.reference)))
    for member in node.members:
        _add_member(alias, member, worklist)
    return alias


def _make_membership(owner: Element, node: Node, worklist: list[Element]) -> Element:
    membership = Element(node.membership, node)
    if node.visibility:
        membership.attributes["visibility"] = node.visibility
    membership.attributes.update(_make_role_attributes(node))
    if node.membership == "Annotation":
        membership.targets.append(("annotatedElement", owner))
    member = _make_element(node, worklist)
    if _is_argument(node):
        member = _wrap_argument(
            _wrap_lazy_argument(member) if node.role == "expression" else member
        )
    membership.add_owned(member)
    return membership


def _is_argument(node: Node) -> bool:
    """Whether a node is an expression that a parameter carries to its owner."""
    owner = node.owner
    if node.membership != "ParameterMembership" or node.kind not in _EXPRESSIONS or owner is None:
        return False
    return owner.kind in _INSTANTIATIONS or _is_constructor_result(owner)


def _is_constructor_result(node: Node) -> bool:
    """Whether a node is the result of a constructor, which has its arguments (KerML 8.2.5.8.3)."""
    owner = node.owner
    return owner is not None and owner.kind == "ConstructorExpression" and node.kind == "Feature"


def _make_role_attributes(node: Node) -> dict[str, AttributeValue]:
    if node.membership == "FeatureValue":
        signs = {"isDefault": "default" in node.role, "isInitial": ":=" in node.role}
        return {name: True for name, is_set in signs.items() if is_set}
    if node.membership in _MEMBERSHIPS_WITH_KIND or (
        node.membership in _REQUIREMENTS and node.role
    ):
        return {"kind": node.role}
    return {"kind": "requirement"} if node.membership in _REQUIREMENTS else {}
