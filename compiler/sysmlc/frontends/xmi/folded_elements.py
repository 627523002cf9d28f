"""Rows that become no element: references, edges of their owner, ends of extensions, properties.

UML 2.5.1: a generalization (9.9.7), a profile application (12.4.7) and the like only relate their
owner to another element, so that they are edges in the graph. A child with ``xmi:idref`` or
``href`` refers to an element instead of defining one: it becomes an edge, an attribute with ids, or
a contained element.
"""

from collections.abc import Collection
from functools import partial

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses, papyrus, rules, uml_features
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.attributes import defer_conditions, defer_ids
from sysmlc.frontends.xmi.dangling import check_references_inside
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.elements import add_element, make_handler
from sysmlc.frontends.xmi.unit import File, RowHandler, Stage
from sysmlc.ir import Edge, Element, Kind

_REFERENCES_TO_OWNER = uml_features.NAMING - v.FOLDED_REFERENCES.keys()
"""Other references of a folded element: they lead to its owner, or to an owner of both ends."""

_WITH_MEANING = uml_features.FEATURES - {"name", "visibility"}


def _lower_edge(file: File, row: int) -> None:
    file.mark_mapped(row)
    owner = file.find_owner(row)
    if owner is None:
        return
    values = file.document.attributes[row]
    for feature, edge in v.FOLDED_REFERENCES.items():
        for target in file.document.split_ids(values.get(feature, "")):
            file.add_reference(edge, owner.id, WrittenReference(target, row), feature)
    for feature, value in values.items():
        if feature in _REFERENCES_TO_OWNER:
            file.defer_check(row, feature, value)
    # A name where UML has none, as on a generalization, is reported as a misplaced attribute.
    has_name = not uml_features.is_misplaced(file.document.types[row], "name")
    report_losses(file, row, _REFERENCES_TO_OWNER | v.FOLDED_REFERENCES.keys(), is_named=has_name)


def report_losses(
    file: File, row: int, lowered: Collection[str], *, is_named: bool = False
) -> None:
    """Mark a row as approximated if an attribute is neither *lowered* nor at its default.

    Visibilities do not count, because tools generate them; a name counts only if the row
    *is_named* by the author of the model.
    """
    values = file.document.attributes[row]
    lost = [
        name
        for name, value in values.items()
        if name in _WITH_MEANING and name not in lowered and value != v.default_value(name)
    ]
    if is_named and values.get("name"):
        lost.append("name")
    if lost:
        file.approximate(row, rules.APPROXIMATED, ", ".join(f"'{name}'" for name in lost))


def _lower_extension(file: File, row: int) -> None:
    # The property ``base_...`` of the stereotype states the metaclass, too.
    file.mark_subtree(row, Verdict.MAPPED)
    check_references_inside(file, row)


def _lower_property(file: File, row: int) -> None:
    owner = file.find_owner(row)
    name = file.document.attributes[row].get("name", "")
    if owner is not None and owner.kind is Kind.STEREOTYPE and name.startswith("base_"):
        _lower_metaclass_property(file, row, owner)
    elif not add_element(file, row, Kind.PROPERTY, "", "Property"):
        file.mark_subtree(row, Verdict.UNSUPPORTED)


def _lower_metaclass_property(file: File, row: int, stereotype: Element) -> None:
    """Add an edge from a stereotype to the metaclass that it extends."""
    file.mark_subtree(row, Verdict.MAPPED)
    check_references_inside(file, row)
    for target in file.document.targets(row, "type"):
        reference = WrittenReference(target, row)
        file.add_reference(Edge.EXTENDS, stereotype.id, reference, "type")
    for child in file.document.children(row, "type"):
        href = file.document.href(child)
        if href:
            reference = WrittenReference(href, child, is_href=True)
            file.add_reference(Edge.EXTENDS, stereotype.id, reference, "type")


def _ignore_image(file: File, row: int) -> None:
    file.mark_subtree(row, Verdict.IGNORED_NOTATION)


def _complete_extend(file: File, element: Element, row: int) -> None:
    """Add an edge between the use cases, so that queries need not know ``Extend`` (18.1)."""
    if element.owner is not None:
        file.add_references(Edge.EXTENDS, element.owner, row, "extendedCase")


TYPES: dict[str, RowHandler] = {
    **dict.fromkeys(metaclasses.EDGE_TYPES, _lower_edge),
    "Extension": _lower_extension,
    "ExtensionEnd": _lower_extension,
    "Property": _lower_property,
    "Image": _ignore_image,
    "Extend": make_handler("Extend", _complete_extend),
}


# -- references --------------------------------------------------------------------------------


def is_reference(file: File, row: int) -> bool:
    """Whether the row refers to an element instead of defining one."""
    attributes = file.document.attributes[row]
    return "href" in attributes or file.document.idref_key in attributes


def lower_reference(file: File, row: int) -> int:
    """Lower a row that refers to an element; return the row after its content."""
    document = file.document
    end = file.mark_subtree(row, Verdict.MAPPED)
    for child in document.children(row):
        file.mark_subtree(child, Verdict.IGNORED_NOTATION)
    feature, parent = document.features[row], document.parents[row]
    owner = file.find_owner(row)
    href = document.href(row)
    reference = WrittenReference(href or document.idref(row), row, bool(href))
    if owner is not None and papyrus.is_contained_href(document, row):
        file.verdicts[row] = Verdict.EXTERNAL
        file.defer(Stage.WALKS, partial(papyrus.join_contained_element, file, row))
    elif owner is None or feature in ("packagedElement", "nestedPackage"):
        file.verdicts[row] = Verdict.EXTERNAL if href else Verdict.MAPPED
    elif file.elements[parent]:
        _refer(file, owner, reference, feature)
    elif feature in v.FOLDED_REFERENCES:
        file.add_reference(v.FOLDED_REFERENCES[feature], owner.id, reference, feature)
    elif not href:
        file.defer_check(parent, feature, reference.target)
    return end


def _refer(file: File, owner: Element, reference: WrittenReference, feature: str) -> None:
    target, row, is_href = reference
    edge = v.REFERENCES_BY_KIND.get((owner.kind, feature)) or v.REFERENCES.get(feature)
    reversed_edge = v.REVERSED.get((owner.kind, feature))
    if edge is not None:
        file.add_reference(edge, owner.id, reference, feature)
    elif reversed_edge is not None:
        file.add_reference(reversed_edge, owner.id, reference, feature, is_reversed=True)
    elif feature in v.CONDITIONS:
        defer_conditions(file, [target], feature)
    elif feature in v.REDUNDANT:
        if not is_href:
            file.defer_check(file.document.parents[row], feature, target)
    elif feature == "guard" and owner.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
        # The value is in another file or belongs to another element, so that it has no text here.
        owner.attrs["guard"] = ""
    elif feature not in ("partWithPort", "guard", "event"):
        _store_ids(file, owner, reference, feature)


def _store_ids(file: File, owner: Element, reference: WrittenReference, feature: str) -> None:
    key = v.to_snake_case(feature)
    if reference.is_href:
        defer_ids(file, owner, key, [reference.target], is_href=True)
    elif feature not in ("sendEvent", "receiveEvent"):
        parent = file.document.parents[reference.row]
        defer_ids(file, owner, key, file.document.targets(parent, feature))
