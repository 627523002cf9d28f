"""Packages and definitions with their generals, and quantities and units of value types."""

import re

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.frontends.sysml.annotations import apply_levels, is_recipe_level
from sysmlc.frontends.sysml.kinds import CLASSIFIERS, KINDS_BY_METADATA
from sysmlc.frontends.sysml.libraries import FILES, LOWERED
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query.names import CAEX_ID
from sysmlc.language.tree import Node, Reference

_GENERALS = ("Subclassification", "Specialization", "Subsetting", "FeatureTyping", "Redefinition")
_QUANTITY = re.compile(r"(?P<name>\w+)Value")
_WORD_BOUNDARY = re.compile(r"(?<=[a-z])(?=[A-Z])")
_LIBRARY: dict[str, AttrValue] = {"external": True, "library": True}
_AML_ATTRIBUTES = {
    "id": CAEX_ID,
    "dataType": "data_type",
    "unit": "unit",
    "category": "category",
    "semantics": "semantics",
    "version": "version",
    "changeMode": "change_mode",
    "copyright": "copyright",
    "ppr": "ppr",
    "associatedFacet": "associated_facet",
    "defaultValue": "default_value",
}
"""Attributes of elements by the names that ``@SysMLC::AutomationML`` gives them."""


# -- packages and definitions ------------------------------------------------------------------


def lower_package(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a package with its members.

    Shipped libraries without contracts and packages of stubs are not part of the model.
    """
    is_shipped = node.name in FILES and node.kind == "LibraryPackage"
    if owner is None and is_shipped and node.name not in LOWERED:
        lowering.verdicts.mark_external(node)
        return
    members = [member for member in node.members if not member.kind.endswith("Import")]
    if owner is None and members and all(map(_is_stereotype_stub, members)):
        lowering.verdicts.mark_external(node)
        return
    kind, subkind = read_kind(node, Kind.PACKAGE)
    if node.kind == "LibraryPackage" and kind is Kind.PACKAGE:
        subkind = subkind or "library"
    attributes = visibility_attributes(node) | foreign_attributes(node)
    if members and all(map(_external_attributes, members)):
        attributes["external"] = True
    name = nodes.name_of(node)
    package = lowering.add_element(node, kind, name, owner, subkind=subkind, **attributes)
    lowering.lower_all(node.members, package)


def _is_stereotype_stub(node: Node) -> bool:
    return annotations.is_external_stub(node) and node.kind == "MetadataDefinition"


def lower_classifier(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a definition whose members are features."""
    kind, role = CLASSIFIERS[node.kind]
    lower_definition(lowering, node, owner, kind, role)


def lower_item(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an item definition to a signal or a block."""
    is_signal = id(node) in lowering.trees.signals
    kind, role = (Kind.SIGNAL, "") if is_signal else (Kind.CLASS, "block")
    lower_definition(lowering, node, owner, kind, role)


def lower_occurrence(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an occurrence definition: an interaction if it has messages or events, else a class."""
    is_interaction = any(
        nodes.is_message(member) or member.kind == "EventOccurrenceUsage" for member in node.members
    )
    kind = Kind.INTERACTION if is_interaction else Kind.CLASS
    lower_definition(lowering, node, owner, kind, "")


def lower_definition(
    lowering: Lowering,
    node: Node,
    owner: Element | None,
    kind: Kind,
    role: str,
    **attrs: AttrValue,
) -> Element:
    """Lower a definition with its generals and its members; return its element."""
    kind, subkind = read_kind(node, kind)
    attributes: dict[str, AttrValue] = {
        "role": role,
        "subkind": subkind,
        "domain": annotations.metadata_value(node, "Kind", "domain"),
        **declaration_attributes(node),
        **attrs,
    }
    element = lowering.add_element(node, kind, nodes.name_of(node), owner, **attributes)
    if kind is Kind.DATA_TYPE:
        _set_quantity_and_unit(lowering, node, element)
    connect_generals(lowering, node, element)
    lowering.lower_all(nodes.body_of(node), element)
    return element


def connect_generals(lowering: Lowering, node: Node, element: Element) -> None:
    """Connect a definition to its generals; recipe levels become applied stereotypes instead.

    The quantities that a value type specialises become elements of their own.
    """
    if not node.relations:
        return
    apply_levels(lowering, node, element)
    for reference in nodes.list_references(node, *_GENERALS):
        if reference.target is not None and is_recipe_level(reference.target):
            continue
        if element.kind is not Kind.DATA_TYPE or not _is_quantity(reference):
            _defer_general(lowering, element, reference)


def _defer_general(lowering: Lowering, element: Element, reference: Reference) -> None:
    def connect() -> None:
        target = reference.target
        # Several nodes may be one element (a requirement and its subject): no loop results.
        if target is None or lowering.elements.find(target) is not element:
            lowering.connect_node(Edge.SPECIALIZES, element, target)

    lowering.queue.defer_until_elements(connect)


# -- attributes of declarations ----------------------------------------------------------------


def read_kind(node: Node, kind: Kind) -> tuple[Kind, str]:
    """Return kind and subkind of an element as metadata of our library states them, else *kind*."""
    if not nodes.shipped_metadata_of(node):
        return kind, ""
    name = annotations.metadata_value(node, "Kind", "name")
    name = name or annotations.metadata_value(node, "AutomationML", "kind")
    if isinstance(name, str) and name in KINDS_BY_METADATA:
        return KINDS_BY_METADATA[name], ""
    return kind, str(name or "")


def visibility_attributes(node: Node) -> dict[str, AttrValue]:
    """Return the attribute for a visibility other than public."""
    return {"visibility": node.visibility} if node.visibility in ("private", "protected") else {}


def _external_attributes(node: Node) -> dict[str, AttrValue]:
    """Return the attributes of an element that metadata marks as outside of the unit."""
    href = annotations.metadata_value(node, "External", "href")
    return {"external": True, "href": href} if href else {}


def foreign_attributes(node: Node) -> dict[str, AttrValue]:
    """Return the attributes that metadata preserves of an element of another notation."""
    if not nodes.shipped_metadata_of(node):
        return {}
    return _external_attributes(node) | _aml_attributes(node)


def _aml_attributes(node: Node) -> dict[str, AttrValue]:
    metadata = nodes.shipped_metadata_of(node).get("AutomationML")
    if metadata is None:
        return {}
    constants = dict(annotations.iter_constants(metadata))
    attributes = {
        _AML_ATTRIBUTES[key]: value for key, value in constants.items() if key in _AML_ATTRIBUTES
    }
    if isinstance(attributes.get("semantics"), str):
        attributes["semantics"] = (attributes["semantics"],)
    return attributes


def variation_attributes(node: Node) -> dict[str, AttrValue]:
    """Return whether a node is a variation or a variant, and its portion of a life."""
    if not node.attributes and node.membership != "VariantMembership":
        return {}
    return {
        "variation": bool(node.attributes.get("isVariation")),
        "variant": node.membership == "VariantMembership",
        "portion": str(node.attributes.get("portionKind") or ""),
    }


def declaration_attributes(node: Node) -> dict[str, AttrValue]:
    """Return the attributes for the prefixes of a declaration and for its metadata."""
    return {
        "abstract": bool(node.attributes.get("isAbstract")),
        **variation_attributes(node),
        "individual": bool(node.attributes.get("isIndividual")),
        **visibility_attributes(node),
        **foreign_attributes(node),
    }


# -- quantities and units of value types -------------------------------------------------------


def _is_quantity(reference: Reference) -> bool:
    """Whether a reference leads to a quantity of the standard library (``ISQ::LengthValue``)."""
    target = reference.target
    if target is None or target.owner is None or not target.owner.name:
        # Without the standard library the reference is not resolved: the written name decides.
        package, name = reference.chain[-1][0], reference.chain[-1][-1]
        return package == "ISQ" and bool(_QUANTITY.fullmatch(name))
    is_isq = target.owner.name.startswith("ISQ") and target.owner.kind == "LibraryPackage"
    return is_isq and bool(_QUANTITY.fullmatch(target.name or ""))


def _set_quantity_and_unit(lowering: Lowering, node: Node, type_: Element) -> None:
    """Connect a value type to the quantity kind and the unit that its declaration states.

    Quantities are real numbers unless the declaration states another type.
    """
    generals = nodes.list_references(node, "Subclassification", "Subsetting", "FeatureTyping")
    quantities = [reference for reference in generals if _is_quantity(reference)]
    for reference in quantities:
        _defer_quantity_kind(lowering, node, type_, _quantity_kind_name(nodes.last_name(reference)))
    if quantities and len(generals) == len(quantities):
        lowering.library.connect(Edge.SPECIALIZES, type_, "ScalarValues::Real", Kind.DATA_TYPE)
    _add_unit_of_metadata(lowering, node, type_)
    for member in node.members:
        value = nodes.value_of(member)
        if nodes.name_of(member) == "mRef" and value is not None:
            lowering.verdicts.skipped.add(id(member))
            unit = nodes.find_reference(value, "Membership")
            if unit is not None:
                _defer_unit(lowering, member, type_, unit)


def _add_unit_of_metadata(lowering: Lowering, node: Node, type_: Element) -> None:
    """Add the unit and quantity kind that metadata states because the library has no such unit."""
    metadata = nodes.shipped_metadata_of(node).get("Unit")
    if metadata is None:
        return
    texts = {key: str(value) for key, value in annotations.iter_constants(metadata)}
    name, symbol, quantity_name = (texts.get(key, "") for key in ("name", "symbol", "quantity"))
    unit = lowering.add_derived(metadata, Kind.UNIT, name, type_, symbol=symbol, **_LIBRARY)
    lowering.graph.connect(Edge.REFERENCES, type_, unit)
    if quantity_name:
        kind = Kind.QUANTITY_KIND
        quantity = lowering.add_derived(metadata, kind, quantity_name, type_, **_LIBRARY)
        lowering.graph.connect(Edge.REFERENCES, type_, quantity)
        lowering.graph.connect(Edge.REFERENCES, unit, quantity)


def _defer_unit(lowering: Lowering, node: Node, type_: Element, reference: Reference) -> None:
    """Connect a value type to a unit that the model defines, else to one of the library."""

    def connect() -> None:
        name, symbol = _unit_name_and_symbol(reference)
        unit = lowering.elements.find(reference.target)
        if unit is None:
            for instance in lowering.graph.of_kind(Kind.INSTANCE):
                is_same = instance.attrs.get("symbol") == symbol or instance.name == name
                if instance.role == "unit" and is_same:
                    unit = instance
                    break
        if unit is None:
            unit = lowering.add_derived(node, Kind.UNIT, name, type_, symbol=symbol, **_LIBRARY)
        lowering.graph.connect(Edge.REFERENCES, type_, unit)

    lowering.queue.defer_until_elements(connect)


def _defer_quantity_kind(lowering: Lowering, node: Node, type_: Element, name: str) -> None:
    """Add the quantity kind of a value type, unless a unit that the model defines states it."""

    def connect() -> None:
        units = lowering.graph.targets(type_, Edge.REFERENCES)
        if any(unit.kind is Kind.INSTANCE for unit in units):
            return
        quantity = lowering.add_derived(node, Kind.QUANTITY_KIND, name, type_, **_LIBRARY)
        lowering.graph.connect(Edge.REFERENCES, type_, quantity)
        for unit in units:
            if unit.kind is Kind.UNIT and unit.owner == type_.id:
                lowering.graph.connect(Edge.REFERENCES, unit, quantity)

    lowering.queue.defer_until_edges(connect)


def _quantity_kind_name(value_type: str) -> str:
    """Return ``thermodynamic temperature`` for ``ThermodynamicTemperatureValue``."""
    match = _QUANTITY.fullmatch(value_type)
    return _WORD_BOUNDARY.sub(" ", match["name"] if match else value_type).lower()


def _unit_name_and_symbol(reference: Reference) -> tuple[str, str]:
    """Return name and symbol of a unit; both are the written name if it is not resolved."""
    target, written = reference.target, nodes.last_name(reference)
    if target is None:
        return written, written
    return target.name or written, target.short_name or written
