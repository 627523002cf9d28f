"""Rows that become no element: references, edges of their owner, ends of extensions, properties.

UML 2.5.1: a generalization (9.9.7), a profile application (12.4.7) and the like only relate their
owner to another element, so that they are edges in the graph. A child with ``xmi:idref`` or
``href`` refers to an element instead of defining one: it becomes an edge, an attribute with ids, or
a contained element.
"""

from collections.abc import Collection

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses, papyrus, uml_features
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context, RowHandler, check_references_inside
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.elements import add_element, make_handler
from sysmlc.ir import Edge, Element, Kind

_REFERENCES_TO_OWNER = uml_features.NAMING - v.FOLDED_REFERENCES.keys()
"""Other references of a folded element: they lead to its owner, or to an owner of both ends."""

_WITH_MEANING = uml_features.FEATURES - {"name", "visibility"}


def _lower_edge(context: Context, row: int) -> None:
    context.mark_mapped(row)
    owner = context.find_owner(row)
    if owner is None:
        return
    values = context.document.attributes[row]
    for feature, edge in v.FOLDED_REFERENCES.items():
        for target in context.document.split_ids(values.get(feature, "")):
            context.add_reference(edge, owner.id, WrittenReference(target, row), feature)
    for feature, value in values.items():
        if feature in _REFERENCES_TO_OWNER:
            context.defer_check(row, feature, value)
    # A name where UML has none, as on a generalization, is reported as a misplaced attribute.
    has_name = not uml_features.is_misplaced(context.document.types[row], "name")
    report_losses(
        context, row, _REFERENCES_TO_OWNER | v.FOLDED_REFERENCES.keys(), is_named=has_name
    )


def report_losses(
    context: Context, row: int, lowered: Collection[str], *, is_named: bool = False
) -> None:
    """Mark a row as approximated if an attribute is neither *lowered* nor at its default.

    Visibilities do not count, because tools generate them; a name counts only if the row
    *is_named* by the author of the model.
    """
    values = context.document.attributes[row]
    lost = [
        name
        for name, value in values.items()
        if name in _WITH_MEANING and name not in lowered and value != v.default_value(name)
    ]
    if is_named and values.get("name"):
        lost.append("name")
    if lost:
        context.approximate(row, ", ".join(f"'{name}'" for name in lost))


def _lower_extension(context: Context, row: int) -> None:
    # The property ``base_...`` of the stereotype states the metaclass, too.
    context.mark_subtree(row, Verdict.MAPPED)
    check_references_inside(context, row)


def _lower_property(context: Context, row: int) -> None:
    owner = context.find_owner(row)
    name = context.document.attributes[row].get("name", "")
    if owner is not None and owner.kind is Kind.STEREOTYPE and name.startswith("base_"):
        _lower_metaclass_property(context, row, owner)
    elif not add_element(context, row, Kind.PROPERTY, "", "Property"):
        context.mark_subtree(row, Verdict.UNSUPPORTED)


def _lower_metaclass_property(context: Context, row: int, stereotype: Element) -> None:
    """Add an edge from a stereotype to the metaclass that it extends."""
    context.mark_subtree(row, Verdict.MAPPED)
    check_references_inside(context, row)
    for target in context.document.targets(row, "type"):
        reference = WrittenReference(target, row)
        context.add_reference(Edge.EXTENDS, stereotype.id, reference, "type")
    for child in context.document.children(row, "type"):
        href = context.document.href(child)
        if href:
            reference = WrittenReference(href, child, is_href=True)
            context.add_reference(Edge.EXTENDS, stereotype.id, reference, "type")


def _ignore_image(context: Context, row: int) -> None:
    context.mark_subtree(row, Verdict.IGNORED_NOTATION)


def _complete_extend(context: Context, element: Element, row: int) -> None:
    """Add an edge between the use cases, so that queries need not know ``Extend`` (18.1)."""
    if element.owner is not None:
        context.add_references(Edge.EXTENDS, element.owner, row, "extendedCase")


TYPES: dict[str, RowHandler] = {
    **dict.fromkeys(metaclasses.EDGE_TYPES, _lower_edge),
    "Extension": _lower_extension,
    "ExtensionEnd": _lower_extension,
    "Property": _lower_property,
    "Image": _ignore_image,
    "Extend": make_handler("Extend", _complete_extend),
}


# -- references --------------------------------------------------------------------------------


def is_reference(context: Context, row: int) -> bool:
    """Whether the row refers to an element instead of defining one."""
    attributes = context.document.attributes[row]
    return "href" in attributes or context.document.idref_key in attributes


def lower_reference(context: Context, row: int) -> int:
    """Lower a row that refers to an element; return the row after its content."""
    document = context.document
    end = context.mark_subtree(row, Verdict.MAPPED)
    for child in document.children(row):
        context.mark_subtree(child, Verdict.IGNORED_NOTATION)
    feature, parent = document.features[row], document.parents[row]
    owner = context.find_owner(row)
    href = document.href(row)
    reference = WrittenReference(href or document.idref(row), row, bool(href))
    if owner is not None and papyrus.is_contained_href(document, row):
        context.verdicts[row] = Verdict.EXTERNAL
        context.contained_hrefs.append(row)
    elif owner is None or feature in ("packagedElement", "nestedPackage"):
        context.verdicts[row] = Verdict.EXTERNAL if href else Verdict.MAPPED
    elif context.elements[parent]:
        _refer(context, owner, reference, feature)
    elif feature in v.FOLDED_REFERENCES:
        context.add_reference(v.FOLDED_REFERENCES[feature], owner.id, reference, feature)
    elif not href:
        context.defer_check(parent, feature, reference.target)
    return end


def _refer(context: Context, owner: Element, reference: WrittenReference, feature: str) -> None:
    target, row, is_href = reference
    edge = v.REFERENCES_BY_KIND.get((owner.kind, feature)) or v.REFERENCES.get(feature)
    reversed_edge = v.REVERSED.get((owner.kind, feature))
    if edge is not None:
        context.add_reference(edge, owner.id, reference, feature)
    elif reversed_edge is not None:
        context.add_reference(reversed_edge, owner.id, reference, feature, is_reversed=True)
    elif feature in v.CONDITIONS:
        context.defer_conditions([target], feature)
    elif feature in v.REDUNDANT:
        if not is_href:
            context.defer_check(context.document.parents[row], feature, target)
    elif feature == "guard" and owner.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
        # The value is in another file or belongs to another element, so that it has no text here.
        owner.attrs["guard"] = ""
    elif feature not in ("partWithPort", "guard", "event"):
        _store_ids(context, owner, reference, feature)


def _store_ids(context: Context, owner: Element, reference: WrittenReference, feature: str) -> None:
    key = v.to_snake_case(feature)
    if reference.is_href:
        context.defer_ids(owner, key, [reference.target], is_href=True)
    elif feature not in ("sendEvent", "receiveEvent"):
        parent = context.document.parents[reference.row]
        context.defer_ids(owner, key, context.document.targets(parent, feature))
