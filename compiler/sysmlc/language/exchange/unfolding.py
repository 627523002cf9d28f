"""Unfolding: every relationship that the tree folds, as the metamodel has it (KerML 1.0, 8.3)."""

from collections.abc import Iterator

from sysmlc.language.composition import USAGES, is_composite, is_end
from sysmlc.language.exchange.features import stated
from sysmlc.language.exchange.folding import ENDS, NAMING, RELATIONS
from sysmlc.language.metaclasses import is_a, kinds_of
from sysmlc.language.tree import Fact, Node, Reference, Relation

OWN_ENDS = {
    "Specialization": "specific",
    "Subclassification": "subclassifier",
    "FeatureTyping": "typedFeature",
    "ConjugatedPortTyping": "typedFeature",
    "Subsetting": "subsettingFeature",
    "Redefinition": "redefiningFeature",
    "Conjugation": "conjugatedType",
    "Disjoining": "typeDisjoined",
    "FeatureInverting": "featureInverted",
    "TypeFeaturing": "featureOfType",
}
"""The feature by which an owned relationship names its owner, where the owner does not say it."""

_INSTANTIATIONS = kinds_of("InstantiationExpression")
_EXPRESSIONS = kinds_of("Expression")
_PARAMETERS = kinds_of("ParameterMembership")
_IMPORTS = {"MembershipImport": "importedMembership", "NamespaceImport": "importedNamespace"}
_END = "EndFeatureMembership"
_RESULTLESS = {"ConstructorExpression", "AssignmentActionUsage", "TransitionUsage"}
_KINDS = kinds_of("StateSubactionMembership") | kinds_of("TransitionFeatureMembership")
_REQUIREMENTS = kinds_of("RequirementConstraintMembership")


class Element:
    """An element of an interchange file: its metaclass, what it says, what it owns.

    ``node`` is what it comes from, for a membership its member; what the tree leaves out has
    none. ``targets`` are the references by feature: the name of one, an element of the same
    file, or a link of a reference of the tree.
    """

    __slots__ = ("attributes", "id", "kind", "node", "owned", "targets")

    def __init__(self, kind: str, node: Node | None = None) -> None:
        self.kind = kind
        self.node = node
        self.attributes: dict[str, Fact] = {}
        self.targets: list[tuple[str, Element | Link]] = []
        self.owned: list[Element] = []
        self.id = ""

    def own(self, element: "Element") -> "Element":
        """Take the element as the last of what is owned; it is returned."""
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
        """The element that the link leads to, if it was found."""
        targets = self.reference.targets
        return targets[self.index] if targets and self.index < len(targets) else None

    @property
    def text(self) -> str:
        """How the reference names it."""
        return "::".join(self.reference.chain[self.index]) if self.reference.chain else ""


def unfold(node: Node) -> Element:
    """The element of a node with all that it owns, however deep it nests."""
    root = Element(node.kind, node)
    todo = [root]
    while todo:
        _fill(todo.pop(), todo)
    return root


def walk(root: Element) -> Iterator[tuple[Element, Element | None]]:
    """The element and all below it, owners first, each with what owns it."""
    stack: list[tuple[Element, Element | None]] = [(root, None)]
    while stack:
        element, owner = stack.pop()
        yield element, owner
        stack.extend((owned, element) for owned in reversed(element.owned))


def _fill(element: Element, todo: list[Element]) -> None:
    """State what the element says and own what its node owns; ``todo`` gets what is empty yet."""
    node = element.node
    if node is None:
        return
    _state(element, node)
    if node.kind in ENDS and node.membership:
        _stand(element, node, todo)
    else:
        for item in _in_order(node):
            if isinstance(item, Relation):
                element.own(_relationship(item, element))
            else:
                _own(element, item, todo)
    _add_implicit(element, node)


def _empty(node: Node, todo: list[Element]) -> Element:
    made = Element(node.kind, node)
    todo.append(made)
    return made


def _in_order(node: Node) -> Iterator[Relation | Node]:
    """Relations and members in the order in which the text or the file has them.

    The source of a transition is before its parameters, which no text has (SysML 8.2.2.18.3).
    """
    relations = [relation for relation in node.relations if not relation.implied]
    members = list(node.members)
    if node.kind == "TransitionUsage":
        yield from (relation for relation in relations if relation.kind == "Membership")
        relations = [relation for relation in relations if relation.kind != "Membership"]
    while relations and members:
        before = relations[0].reference.start <= members[0].start
        yield relations.pop(0) if before else members.pop(0)
    yield from relations
    yield from members


# -- what an element says --------------------------------------------------------------------


def _state(element: Element, node: Node) -> None:
    names = {"declaredName": node.name, "declaredShortName": node.short}
    element.attributes.update({name: text for name, text in names.items() if text is not None})
    known = stated(node.kind)
    element.attributes.update({name: fact for name, fact in node.facts.items() if name in known})
    if node.membership in _PARAMETERS and not _is_argument(node):
        element.attributes.setdefault("direction", _direction(node))
    if is_end(node):
        element.attributes["isEnd"] = True
    if node.facts.get("isVariation") or node.kind == "EnumerationDefinition":
        element.attributes["isAbstract"] = True
    if node.kind in USAGES:
        _complete_usage(element, node)


def _direction(node: Node) -> str:
    return "out" if is_a(node.membership, "ReturnParameterMembership") else "in"


def _complete_usage(element: Element, node: Node) -> None:
    """What follows from the language: composition, and that ends are constant."""
    if is_composite(node):
        element.attributes["isComposite"] = True
    owner = node.owner.kind if node.owner else ""
    varies = is_a(owner, "OccurrenceDefinition") or is_a(owner, "OccurrenceUsage")
    if is_end(node) and varies:
        element.attributes["isConstant"] = True


def _stand(element: Element, node: Node, todo: list[Element]) -> None:
    """A relationship for itself: its ends are features, chains are owned by it."""
    for relation in node.relations:
        if len(relation.reference.chain) > 1:
            element.targets.append((relation.kind, element.own(_chain(relation.reference))))
        else:
            element.targets.append((relation.kind, Link(relation.reference)))
    for member in node.members:
        _own(element, member, todo)


# -- relationships ---------------------------------------------------------------------------


def _relationship(relation: Relation, owner: Element) -> Element:
    reference = relation.reference
    if relation.kind == "Membership":
        return _naming(reference)
    made = Element(relation.kind)
    own_end = OWN_ENDS.get(relation.kind)
    if own_end:
        made.targets.append((own_end, owner))
    feature = RELATIONS.get(relation.kind, relation.kind)
    if len(reference.chain) > 1:
        made.targets.append((feature, made.own(_chain(reference))))
    else:
        made.targets.append((feature, Link(reference)))
    return made


def _naming(reference: Reference) -> Element:
    """The membership by which an expression names what it refers to."""
    if len(reference.chain) > 1:
        made = Element("OwningMembership")
        made.own(_chain(reference))
        return made
    made = Element("Membership")
    made.targets.append(("memberElement", Link(reference)))
    return made


def _chain(reference: Reference) -> Element:
    made = Element("Feature")
    for index in range(len(reference.chain)):
        chaining = made.own(Element("FeatureChaining"))
        chaining.targets.append(("chainingFeature", Link(reference, index)))
    return made


# -- members ---------------------------------------------------------------------------------


def _own(owner: Element, node: Node, todo: list[Element]) -> None:
    if is_a(node.kind, "Import"):
        owner.own(_import(node, todo))
    elif node.kind == "Membership":
        owner.own(_alias(node, todo))
    elif not node.membership:
        owner.own(_empty(node, todo))
    else:
        owner.own(_membership(owner, node, todo))


def _import(node: Node, todo: list[Element]) -> Element:
    """An import; the package of a filtered one is owned by it."""
    made = Element(node.kind, node)
    made.attributes.update(node.facts)
    if node.visibility:
        made.attributes["visibility"] = node.visibility
    if is_a(node.kind, "Expose"):
        made.attributes.update(isImportAll=True, visibility="protected")
    for relation in node.relations:
        made.targets.append((relation.kind, Link(relation.reference)))
    feature = next(end for kind, end in _IMPORTS.items() if is_a(node.kind, kind))
    for member in node.members:
        if is_a(member.kind, "Package"):
            made.targets.append((feature, made.own(_empty(member, todo))))
        else:
            _own(made, member, todo)
    return made


def _alias(node: Node, todo: list[Element]) -> Element:
    made = Element("Membership", node)
    names = {"memberName": node.name, "memberShortName": node.short}
    names["visibility"] = node.visibility or None
    made.attributes.update({name: text for name, text in names.items() if text is not None})
    for relation in node.relations:
        made.targets.append(("memberElement", Link(relation.reference)))
    for member in node.members:
        _own(made, member, todo)
    return made


def _membership(owner: Element, node: Node, todo: list[Element]) -> Element:
    made = Element(node.membership, node)
    if node.visibility:
        made.attributes["visibility"] = node.visibility
    made.attributes.update(_role(node))
    if node.membership == "Annotation":
        made.targets.append(("annotatedElement", owner))
    inner = _empty(node, todo)
    if _is_argument(node):
        inner = _argument(_late(inner) if node.role == "expression" else inner)
    made.own(inner)
    return made


def _is_argument(node: Node) -> bool:
    """Whether it is an expression that a parameter carries to the one that owns it."""
    owner = node.owner
    if node.membership != "ParameterMembership" or node.kind not in _EXPRESSIONS or owner is None:
        return False
    return owner.kind in _INSTANTIATIONS or _is_constructed(owner)


def _is_constructed(node: Node) -> bool:
    """Whether it is the result of a constructor, which has its arguments (KerML 8.2.5.8.3)."""
    owner = node.owner
    return owner is not None and owner.kind == "ConstructorExpression" and node.kind == "Feature"


def _role(node: Node) -> dict[str, Fact]:
    if node.membership == "FeatureValue":
        signs = {"isDefault": "default" in node.role, "isInitial": ":=" in node.role}
        return {name: True for name, said in signs.items() if said}
    if node.membership in _KINDS or (node.membership in _REQUIREMENTS and node.role):
        return {"kind": node.role}
    return {"kind": "requirement"} if node.membership in _REQUIREMENTS else {}


def _argument(value: Element) -> Element:
    """The parameter that carries an argument (KerML 1.0, 8.2.5.8.1)."""
    parameter = Element("Feature")
    parameter.attributes["direction"] = "in"
    parameter.own(Element("FeatureValue")).own(value)
    return parameter


def _late(value: Element) -> Element:
    """The reference to an expression that is only evaluated when others say so."""
    made = Element("FeatureReferenceExpression")
    made.own(Element("FeatureMembership")).own(value)
    made.own(_result())
    return made


# -- what the tree leaves out ----------------------------------------------------------------


def _add_implicit(element: Element, node: Node) -> None:
    if node.kind in NAMING and node.kind not in _RESULTLESS:
        if not any(one.membership == "ReturnParameterMembership" for one in node.members):
            element.own(_result())
    elif node.kind == "PortDefinition":
        element.own(Element("OwningMembership")).own(_conjugate(element))
    elif node.kind == "SuccessionAsUsage" and [one.membership for one in node.members] == [_END]:
        element.own(Element(_END)).own(Element("ReferenceUsage")).attributes["isEnd"] = True
    elif node.facts.get("isIndividual") and is_a(node.kind, "OccurrenceDefinition"):
        element.own(Element("OwningMembership")).own(Element("Multiplicity"))


def _result() -> Element:
    made = Element("ReturnParameterMembership")
    made.own(Element("Feature")).attributes["direction"] = "out"
    return made


def _conjugate(definition: Element) -> Element:
    """The conjugated port definition that every port definition has (SysML 2.0, 8.2.2.12)."""
    made = Element("ConjugatedPortDefinition")
    conjugation = made.own(Element("PortConjugation"))
    conjugation.targets += [("conjugatedType", made), ("originalPortDefinition", definition)]
    return made
