"""Rows that become no element: edges of their owner, ends of extensions, metaclass properties.

UML 2.5.1: a generalization (9.9.7), a profile application (12.4.7) and the like only relate their
owner to another element, so that they are edges in the graph.
"""

from collections.abc import Collection

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses, uml_features
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context, RowHandler
from sysmlc.frontends.xmi.dangling import check_references_inside
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
    """Approximate a row that has attributes which are not *lowered* and not at their default.

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
