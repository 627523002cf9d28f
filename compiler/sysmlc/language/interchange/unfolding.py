"""What the tree leaves out because it follows: parameters, results, conjugates (KerML 8.2.5.8)."""

from collections.abc import Iterator

from sysmlc.language.interchange.effective_names import accepted_by
from sysmlc.language.interchange.elements import Element, Link
from sysmlc.language.interchange.metamodel import ENDS, NAMING, OWN_ENDS, RELATIONS, stated
from sysmlc.language.metaclasses import USAGES, is_a, is_composite, is_end, kinds_of
from sysmlc.language.tree import AttributeValue, Node, Reference, Relation

_END = "EndFeatureMembership"
_RESULTLESS = {"ConstructorExpression", "AssignmentActionUsage", "TransitionUsage"}


def argument(value: Element) -> Element:
    """The parameter that carries an argument (KerML 1.0, 8.2.5.8.1)."""
    parameter = Element("Feature")
    parameter.attributes["direction"] = "in"
    parameter.add_owned(Element("FeatureValue")).add_owned(value)
    return parameter


def late(value: Element) -> Element:
    """The reference to an expression that is only evaluated when others say so."""
    made = Element("FeatureReferenceExpression")
    made.add_owned(Element("FeatureMembership")).add_owned(value)
    made.add_owned(_result())
    return made


def add_implicit(element: Element, node: Node) -> None:
    """Own what follows for an element of its kind when its node owns nothing like it."""
    if node.kind in NAMING and node.kind not in _RESULTLESS:
        if not any(member.membership == "ReturnParameterMembership" for member in node.members):
            element.add_owned(_result())
    elif node.kind == "PortDefinition":
        element.add_owned(Element("OwningMembership")).add_owned(_conjugate(element))
    elif node.kind == "SuccessionAsUsage" and [member.membership for member in node.members] == [
        _END
    ]:
        element.add_owned(Element(_END)).add_owned(Element("ReferenceUsage")).attributes[
            "isEnd"
        ] = True
    elif node.attributes.get("isIndividual") and is_a(node.kind, "OccurrenceDefinition"):
        element.add_owned(Element("OwningMembership")).add_owned(Element("Multiplicity"))


def _result() -> Element:
    made = Element("ReturnParameterMembership")
    made.add_owned(Element("Feature")).attributes["direction"] = "out"
    return made


def _conjugate(definition: Element) -> Element:
    """The conjugated port definition that every port definition has (SysML 2.0, 8.2.2.12)."""
    made = Element("ConjugatedPortDefinition")
    conjugation = made.add_owned(Element("PortConjugation"))
    conjugation.targets += [("conjugatedType", made), ("originalPortDefinition", definition)]
    return made


_INSTANTIATIONS = kinds_of("InstantiationExpression")
_EXPRESSIONS = kinds_of("Expression")
_PARAMETERS = kinds_of("ParameterMembership")
_IMPORTS = {"MembershipImport": "importedMembership", "NamespaceImport": "importedNamespace"}
_KINDS = kinds_of("StateSubactionMembership") | kinds_of("TransitionFeatureMembership")
_REQUIREMENTS = kinds_of("RequirementConstraintMembership")


def unfold(node: Node) -> Element:
    """The element of a node with all that it owns, however deep it nests."""
    root = Element(node.kind, node)
    todo = [root]
    while todo:
        _fill(todo.pop(), todo)
    return root


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
                element.add_owned(_relationship(item, element))
            else:
                _own(element, item, todo)
    add_implicit(element, node)


def _empty(node: Node, todo: list[Element]) -> Element:
    made = Element(node.kind, node)
    todo.append(made)
    return made


def _in_order(node: Node) -> Iterator[Relation | Node]:
    """Relations and members in the order in which the text or the file has them.

    The source of a transition is before its parameters, which no text has (SysML 8.2.2.18.3).
    """
    relations = list(node.relations)
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
    accepted = accepted_by(node)
    name = node.name if accepted is None else accepted.name
    names = {"declaredName": name, "declaredShortName": node.short_name}
    element.attributes.update({name: text for name, text in names.items() if text is not None})
    known = stated(node.kind)
    element.attributes.update(
        {name: fact for name, fact in node.attributes.items() if name in known}
    )
    if node.membership in _PARAMETERS and not _is_argument(node):
        element.attributes.setdefault("direction", _direction(node))
    if is_end(node):
        element.attributes["isEnd"] = True
    if node.attributes.get("isVariation") or node.kind == "EnumerationDefinition":
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
            element.targets.append((relation.kind, element.add_owned(_chain(relation.reference))))
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
        made.targets.append((feature, made.add_owned(_chain(reference))))
    else:
        made.targets.append((feature, Link(reference)))
    return made


def _naming(reference: Reference) -> Element:
    """The membership by which an expression names what it refers to."""
    if len(reference.chain) > 1:
        made = Element("OwningMembership")
        made.add_owned(_chain(reference))
        return made
    made = Element("Membership")
    made.targets.append(("memberElement", Link(reference)))
    return made


def _chain(reference: Reference) -> Element:
    made = Element("Feature")
    for index in range(len(reference.chain)):
        chaining = made.add_owned(Element("FeatureChaining"))
        chaining.targets.append(("chainingFeature", Link(reference, index)))
    return made


# -- members ---------------------------------------------------------------------------------


def _own(owner: Element, node: Node, todo: list[Element]) -> None:
    if is_a(node.kind, "Import"):
        owner.add_owned(_import(node, todo))
    elif node.kind == "Membership":
        owner.add_owned(_alias(node, todo))
    elif not node.membership:
        owner.add_owned(_empty(node, todo))
    else:
        owner.add_owned(_membership(owner, node, todo))


def _import(node: Node, todo: list[Element]) -> Element:
    """An import; the package of a filtered one is owned by it."""
    made = Element(node.kind, node)
    made.attributes.update(node.attributes)
    if node.visibility:
        made.attributes["visibility"] = node.visibility
    if is_a(node.kind, "Expose"):
        made.attributes.update(isImportAll=True, visibility="protected")
    for relation in node.relations:
        made.targets.append((relation.kind, Link(relation.reference)))
    feature = next(end for kind, end in _IMPORTS.items() if is_a(node.kind, kind))
    for member in node.members:
        if is_a(member.kind, "Package"):
            made.targets.append((feature, made.add_owned(_empty(member, todo))))
        else:
            _own(made, member, todo)
    return made


def _alias(node: Node, todo: list[Element]) -> Element:
    made = Element("Membership", node)
    names = {"memberName": node.name, "memberShortName": node.short_name}
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
        inner = argument(late(inner) if node.role == "expression" else inner)
    made.add_owned(inner)
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


def _role(node: Node) -> dict[str, AttributeValue]:
    if node.membership == "FeatureValue":
        signs = {"isDefault": "default" in node.role, "isInitial": ":=" in node.role}
        return {name: True for name, said in signs.items() if said}
    if node.membership in _KINDS or (node.membership in _REQUIREMENTS and node.role):
        return {"kind": node.role}
    return {"kind": "requirement"} if node.membership in _REQUIREMENTS else {}
