"""Comments, documentation and metadata, including the levels of a recipe.

"Our library" is ``SysMLC``, which is shipped with the compiler. Its metadata states facts for which
SysML v2 has no construct; the back end ``sysml`` writes it.
"""

from collections.abc import Callable, Collection, Iterator
from fractions import Fraction

from sysmlc.frontends.sysml import nodes, preserved_facts, quantities, values
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.libraries import PROFILE, RECIPES
from sysmlc.frontends.sysml.lowering import Lowering, QualifiedNames
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.language.tree import Node

_STUB_PACKAGE = "Stereotypes"
"""Package in which the back end writes stubs for stereotypes of profiles that are not there."""
_OWNING = frozenset({"OwningMembership", "FeatureMembership"})
_READ_WITH_OWNER = nodes.EXPRESSIONS | {"EventOccurrenceUsage"}
_LEVEL_GENERALS = ("Subclassification", "FeatureTyping", "Specialization")
_LEVEL_NAMES = {"MaterialUse": "Material"}
"""A metadata definition cannot have the name of the level, which is a part definition."""
_KINDS_BY_NAME = {str(kind): kind for kind in Kind}


# -- comments and texts ------------------------------------------------------------------------


def lower_only_annotations(
    lowering: Lowering,
    node: Node,
    element: Element,
    description: str,
    read: Collection[Node] = (),
) -> None:
    """Lower the annotations of an element without members; report its other members as lost.

    ``description`` names the element in the report; ``read`` has members that are read elsewhere.
    """
    for member in nodes.body_of(node):
        if nodes.is_annotation(member):
            lowering.lower(member, element)
        elif (
            member.membership in _OWNING
            and member not in read
            and member.kind not in _READ_WITH_OWNER
        ):
            lowering.verdicts.mark_approximated(member, f"a member of {description}", "nothing")


def lower_documentation(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a documentation to a comment about its owner."""
    comment = _add_comment(lowering, node, owner)
    if owner is not None:
        lowering.graph.connect(Edge.REFERENCES, comment, owner)


def lower_comment(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a comment about the elements it names, else about its owner (KerML 1.0, 8.3.2.3.2)."""
    comment = _add_comment(lowering, node, owner)
    about = nodes.list_references(node, "Annotation")
    for reference in about:
        lowering.connect_reference(Edge.REFERENCES, comment, reference)
    if not about and owner is not None:
        lowering.graph.connect(Edge.REFERENCES, comment, owner)


def _add_comment(lowering: Lowering, node: Node, owner: Element | None) -> Element:
    body = str(node.attributes.get("body", "")).strip()
    locale = node.attributes.get("locale", "")
    name = node.name or ""
    return lowering.add_element(node, Kind.COMMENT, name, owner, body=body, locale=locale)


def lower_textual_representation(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a text in another language to a body of its owner, which becomes opaque."""
    if owner is None:
        lowering.verdicts.mark_unsupported(node)
        return
    body = str(node.attributes.get("body", "")).strip()
    language = str(node.attributes.get("language", ""))
    bodies = owner.attrs.get("bodies", owner.attrs.get("body"))
    if not isinstance(bodies, tuple):
        bodies = () if bodies is None else (bodies,)
    languages = owner.attrs.get("languages", owner.attrs.get("language", ""))
    if not isinstance(languages, tuple):
        languages = (languages,) * len(bodies)
    if bodies:
        lowering.set_attributes(owner, bodies=(*bodies, body), languages=(*languages, language))
    else:
        lowering.set_attributes(owner, body=body, language=language)
    if owner.kind in (Kind.ACTIVITY, Kind.ACTION) and not owner.subkind:
        lowering.set_attributes(owner, subkind="opaque")


# -- metadata ----------------------------------------------------------------------------------


def lower_metadata(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower metadata to an applied stereotype; metadata of our library describes its owner."""
    shipped_name = nodes.shipped_metadata_name(node)
    if shipped_name:
        if owner is not None and shipped_name in _SHIPPED_HANDLERS:
            _SHIPPED_HANDLERS[shipped_name](lowering, node, owner)
        return
    definition = nodes.find_target(node, "FeatureTyping")
    name = _stereotype_name(node, definition)
    application = lowering.add_element(node, Kind.APPLICATION, name, owner, stereotype=name)
    lowering.set_attributes(application, namespace=_namespace_of(definition))
    about = nodes.list_references(node, "Annotation")
    if owner is not None and not about:
        lowering.graph.connect(Edge.SUBJECT, application, owner)
    for reference in about:
        lowering.connect_reference(Edge.SUBJECT, application, reference)
    if definition is not None and lowering.trees.document_of(definition) is not None:
        lowering.queue.defer_until_elements(
            lambda: _connect_stereotype(lowering.graph, lowering.elements, application, definition)
        )
    for key, value in _iter_values(node):
        _defer_tag(lowering, application, key, value)


def _rename_owner(lowering: Lowering, node: Node, owner: Element) -> None:
    """Restore the name in the source; it is empty if only the text needs a name."""
    lowering.graph.rename(owner, str(dict(iter_constants(node)).get("name", "")))


def _restore_facts(lowering: Lowering, node: Node, owner: Element) -> None:
    """Restore facts that no construct of SysML v2 expresses."""
    preserved_facts.restore_facts(lowering, dict(iter_constants(node)), owner)


def _restore_element(lowering: Lowering, node: Node, owner: Element) -> None:
    """Restore an element that no construct of SysML v2 expresses."""
    facts = dict(iter_constants(node))
    kind = _KINDS_BY_NAME.get(str(facts.get("kind")))
    if kind is not None:
        element = lowering.add_element(node, kind, str(facts.get("name", "")), owner)
        preserved_facts.restore_facts(lowering, facts, element)


_SHIPPED_HANDLERS: dict[str, Callable[[Lowering, Node, Element], None]] = {
    "Named": _rename_owner,
    "Kept": _restore_facts,
    "Element": _restore_element,
}
"""Metadata of our library that is lowered by itself; other metadata is read with its owner."""


def is_owned_by_type(node: Node) -> bool:
    """Whether metadata is an element that the class of its feature owns, not the feature."""
    is_element = nodes.shipped_metadata_name(node) == "Element"
    return is_element and bool(dict(iter_constants(node)).get("isOfType"))


def _stereotype_name(node: Node, definition: Node | None) -> str:
    if definition is not None:
        name = definition.name or ""
        return _LEVEL_NAMES.get(name, name or definition.short_name or "")
    reference = nodes.find_reference(node, "FeatureTyping")
    return "" if reference is None else nodes.last_name(reference)


def _namespace_of(definition: Node | None) -> str:
    """Return the profile of a stub as its metadata states it, or that of the recipe levels."""
    if definition is None:
        return ""
    root_member = nodes.root_member_of(definition)
    if root_member is not definition and nodes.name_of(root_member) == RECIPES:
        return PROFILE
    for member in nodes.iter_by_metaclass(definition, "MetadataUsage"):
        if nodes.shipped_metadata_name(member) == "External":
            return str(dict(iter_constants(member)).get("href", ""))
    return ""


def is_external_stub(node: Node) -> bool:
    """Whether a definition is a stub for a stereotype of a profile outside the unit."""
    owner = node.owner
    return owner is not None and owner.name == _STUB_PACKAGE and owner.kind == "Package"


def _connect_stereotype(
    graph: Graph, elements: NodeElements, application: Element, definition: Node
) -> None:
    stereotype = elements.find(definition)
    if stereotype is not None:
        graph.connect(Edge.INSTANCE_OF, application, stereotype)


# -- values of metadata ------------------------------------------------------------------------


def _defer_tag(lowering: Lowering, application: Element, key: str, value: Node) -> None:
    """Set a tagged value of an applied stereotype, once all elements exist."""
    lowering.queue.defer_until_elements(
        lambda: _set_tag(lowering, application, f"tag.{key}", value)
    )


def _set_tag(lowering: Lowering, application: Element, attribute: str, value: Node) -> None:
    constant = values.constant_of(value)
    element = lowering.elements.find(nodes.find_target(value, "Membership"))
    tagged: AttrValue
    if constant is not None:
        unit, factor = quantities.read_unit(lowering.trees, value)
        tagged = _write_tag(lowering.names, constant, f" {unit}" if unit else "", factor)
    elif element is not None:
        tagged = element.id
    else:
        tagged = values.expression_text(value, lowering)
    lowering.graph.set(application, **{attribute: tagged})


def _write_tag(
    names: QualifiedNames, value: AttrValue, unit: str = "", factor: Fraction = Fraction(1)
) -> AttrValue:
    """Return a tagged value as text; the qualified name of an element becomes its id.

    The unit of a quantity follows its number (``9 s``), as models in SysML v1 write it. *factor*
    converts the number to the unit.
    """
    if isinstance(value, tuple):
        return tuple(_write_tag(names, item, unit, factor) for item in value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float) and factor != 1:
        number = Fraction(str(value)) * factor
        value = number.numerator if number.denominator == 1 else float(number)
    text = f"{value}{unit}"
    return names.id_of(text) or text if "::" in text else text


def _iter_values(node: Node) -> Iterator[tuple[str, Node]]:
    """Yield the names and expressions of the values in metadata."""
    for member in node.members:
        value = nodes.value_of(member)
        name = nodes.name_of(member)
        if value is not None and name:
            yield name, value


def iter_constants(node: Node) -> Iterator[tuple[str, AttrValue]]:
    """Yield the names and values of the constants in metadata."""
    for name, expression in _iter_values(node):
        value = values.constant_of(expression)
        if value is not None:
            yield name, value


def metadata_value(node: Node, name: str, key: str) -> AttrValue:
    """Return the value *key* in the metadata *name* of our library, or None."""
    metadata = nodes.shipped_metadata_of(node).get(name)
    return None if metadata is None else dict(iter_constants(metadata)).get(key)


# -- recipe levels -----------------------------------------------------------------------------


def apply_levels(lowering: Lowering, node: Node, element: Element) -> None:
    """Apply the stereotype of each recipe level that a definition specialises.

    It does so directly, or redefines an attribute of the level. The members that redefine
    attributes of the level give its tagged values.
    """
    generals = (reference.target for reference in nodes.list_references(node, *_LEVEL_GENERALS))
    levels = [general.name or "" for general in generals if general and is_recipe_level(general)]
    values = list(_iter_level_values(node))
    for level in dict.fromkeys([*levels, *(level for level, _, _ in values)]):
        _apply_level(lowering, node, element, level, values)


def apply_task_values(lowering: Lowering, node: Node, action: Element) -> None:
    """Apply the stereotype of a task to a usage that redefines attributes of a task."""
    values = [value for value in _iter_level_values(node) if value[0] == "Task"]
    if values:
        _apply_level(lowering, node, action, "Task", values)


_LevelValue = tuple[str, str, Node]
"""A level, an attribute of the level, and the member that redefines the attribute."""


def _apply_level(
    lowering: Lowering, node: Node, element: Element, level: str, values: list[_LevelValue]
) -> None:
    application = lowering.add_derived(
        node, Kind.APPLICATION, level, element, stereotype=level, namespace=PROFILE
    )
    lowering.graph.connect(Edge.SUBJECT, application, element)
    for owner, key, member in values:
        value = nodes.value_of(member)
        if owner == level:
            lowering.verdicts.skipped.add(id(member))
        if owner == level and value is not None:
            _defer_tag(lowering, application, key, value)


def _iter_level_values(node: Node) -> Iterator[_LevelValue]:
    """Yield the members that redefine an attribute of a level, directly or not."""
    for member in node.members:
        attributes = [member]
        for attribute in attributes:
            redefined = nodes.find_target(attribute, "Redefinition")
            if redefined is not None and redefined not in attributes:
                attributes.append(redefined)
        level = attributes[-1].owner
        if len(attributes) > 1 and level is not None and is_recipe_level(level):
            yield level.name or "", attributes[-1].name or "", member


def is_recipe_level(node: Node) -> bool:
    """Whether the node is a definition of our library of recipe levels."""
    owner = node.owner
    return owner is not None and owner.name == RECIPES and owner.kind == "LibraryPackage"
