"""Packages, imports and definitions."""

from sysmlc.backends.sysml.annotations import make_annotation, write_annotations
from sysmlc.backends.sysml.comments import record_text_changes
from sysmlc.backends.sysml.declarations import list_visibility, make_definition_head
from sysmlc.backends.sysml.edge_coverage import has_own_measure
from sysmlc.backends.sysml.library import (
    find_quantity,
    find_scalar_type,
    find_unit_name,
    find_value_type,
)
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, format_comment, quote_name
from sysmlc.backends.sysml.references import format_library_name, format_qualified_name, look_up
from sysmlc.backends.sysml.rules import UNSAID_ATTRIBUTE
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import STRUCTURAL_FEATURES
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of

_PRIMITIVE_PACKAGES = ("PrimitiveTypes", "UMLPrimitiveTypes", "PrimitiveValueTypes")


# -- packages and imports ------------------------------------------------------------------------


def write_package(writer: Writer, member: Member) -> list[Line]:
    """Write a package, of the model or added for elements outside of it.

    It imports the libraries to which its members refer by short names.
    """
    body = [] if member.element is None else write_annotations(writer, member)
    prefixes = [] if member.element is None else list_visibility(writer, member.element)
    head = " ".join([*prefixes, member.shape.keyword, quote_name(member.name)])
    body += writer.write_members(member)
    own_imports = {line.head.partition(" ")[2] for line in body}
    libraries = (
        format_library_name(writer.plan, member, library) for library in sorted(member.imports)
    )
    imports = [f"import {library}::*" for library in libraries]
    lines = [Line(f"private {import_}") for import_ in imports if import_ not in own_imports]
    return [Line(head, [*lines, *body])]


def write_import(writer: Writer, member: Member) -> list[Line]:
    """Write an import; without a visibility of its own it is public, as in UML."""
    element = member.require_element()
    if element.subkind == "alias":
        return writer.writers[str(Kind.DOCUMENT)](writer, member)
    visibility = "private" if element.attrs.get("visibility") == "private" else "public"
    lines = []
    alias = element.attrs.get("alias")
    if alias and any(target.name != alias for target in _list_imported(writer, element)):
        facts = {"attribute": "alias", "kind": str(element.kind)}
        writer.losses.record(UNSAID_ATTRIBUTE, element, **facts)
    for target in _list_imported(writer, element):
        name = _refer_to_imported(writer, member, target)
        if name is None and target.attrs.get("library"):
            construct = f"the import of the library {target.name}"
            writer.record_approximation(element, construct, "nothing")
            continue
        if name is None:
            writer.record_unreachable(element, "references")
            continue
        if target.attrs.get("external") and writer.plan.find(target) is None:
            construct = "an import of primitive types"
            writer.record_approximation(element, construct, "one of those of SysML v2")
        is_package = target.kind in (Kind.PACKAGE, Kind.PROFILE) and element.subkind != "element"
        lines.append(Line(f"{visibility} import {name}{'::*' if is_package else ''}"))
    return lines


def _list_imported(writer: Writer, import_: Element) -> list[Element]:
    return writer.graph.targets(import_, Edge.REFERENCES)


def _refer_to_imported(writer: Writer, member: Member, target: Element) -> str | None:
    scalar = find_scalar_type(target)
    if scalar is not None:
        return writer.refer_to_library(member.parent, scalar)
    if target.name in _PRIMITIVE_PACKAGES and target.attrs.get("external"):
        return writer.refer_to_library(member.parent, "ScalarValues")
    if writer.plan.find(target) is None:
        return None
    return writer.refer_to(member.parent, target, Edge.REFERENCES, target)


# -- definitions ---------------------------------------------------------------------------------


def write_class(writer: Writer, member: Member) -> list[Line]:
    """Write a class: a requirement by its stereotype, else a definition."""
    write = write_requirement if member.shape.keyword == "requirement" else write_definition
    return write(writer, member)


def write_definition(writer: Writer, member: Member) -> list[Line]:
    """Write a definition with all its members."""
    head = make_definition_head(writer, member).format()
    return [Line(head, write_contents(writer, member))]


def write_contents(writer: Writer, member: Member) -> list[Line]:
    """Return the annotations and members of a namespace, and lines added by other elements."""
    body = write_annotations(writer, member) + writer.write_members(member)
    element = member.element
    if element is None:
        return body
    if element.kind in STRUCTURAL_FEATURES:
        types = writer.graph.targets(element, Edge.TYPED_BY)
        writer.expressed.update(type_.id for type_ in types if writer.plan.find(type_) is member)
    body += _write_realizations(writer, member, element)
    body += member.take_added_lines()
    if member.shape.keyword == "constraint def":
        # A result expression, which has no head, ends the body (SysML 2.0, 8.2.2.19.1).
        body.sort(key=lambda line: not line.head)
    return body


def _write_realizations(writer: Writer, member: Member, element: Element) -> list[Line]:
    """Write dependencies on realised classifiers, unless the model has its own dependency."""
    supplier_ids = {
        supplier.id
        for dependency in writer.graph.sources(element, Edge.CLIENT)
        for supplier in writer.graph.targets(dependency, Edge.SUPPLIER)
    }
    lines = []
    for target in writer.graph.targets(element, Edge.REALIZES):
        realized = None if target.id in supplier_ids else writer.plan.find(target)
        if realized is None:
            continue
        name = format_qualified_name(writer.plan, member, realized)
        if name is not None:
            keyword = writer.refer_to_sysmlc(member, "realization")
            # A member of the same name inside hides the bare name.
            source = format_qualified_name(writer.plan, member, member)
            lines.append(Line(f"#{keyword} dependency from {source} to {name}"))
    return lines


def write_enumeration(writer: Writer, member: Member) -> list[Line]:
    """Write an enumeration; its generals become a comment, because it may not specialise."""
    head = make_definition_head(writer, member)
    if head.subsets and member.element is not None:
        writer.record_approximation(member.element, "generalization of Enumeration", "comment")
        comment = Line("", text=format_comment(":> " + ", ".join(head.subsets)))
        head.subsets = []
        return [Line(head.format(), [comment, *write_contents(writer, member)])]
    return [Line(head.format(), write_contents(writer, member))]


def write_enumeration_literal(writer: Writer, member: Member) -> list[Line]:
    """Write a literal of an enumeration."""
    return [Line(f"enum {quote_name(member.name)}", write_contents(writer, member))]


# -- value types ---------------------------------------------------------------------------------


def write_value_type(writer: Writer, member: Member) -> list[Line]:
    """Write an attribute definition; one with a known quantity specialises that of ISQ."""
    element = member.require_element()
    quantity = find_quantity(writer.graph, element)
    unit = unit_of(writer.graph, element)
    head = make_definition_head(writer, member, is_quantity=quantity is not None)
    body = write_contents(writer, member)
    if quantity is not None:
        _record_other_quantity(writer, element, quantity)
        generals = writer.graph.targets(element, Edge.SPECIALIZES)
        subsets = _list_non_scalar_generals(writer, member, element)
        if not any(find_quantity(writer.graph, general) is not None for general in generals):
            subsets.append(writer.refer_to_library(member.parent, f"ISQ::{quantity}"))
        head.subsets = subsets
        is_inherited = unit not in writer.graph.targets(element, Edge.REFERENCES) and any(
            unit_of(writer.graph, general) is unit and writer.plan.find(general) is not None
            for general in generals
        )
        unit_name = None if is_inherited else find_unit_name(unit)
        if unit_name is not None:
            reference = writer.refer_to_library(member, unit_name)
            body.insert(0, Line(f"attribute :>> mRef = {reference}"))
    elif unit is not None and _needs_unit_annotation(writer, element, unit):
        body.insert(0, _annotate_unit(writer, member, unit))
    return [Line(head.format(), body)]


def _needs_unit_annotation(writer: Writer, type_: Element, unit: Element) -> bool:
    """Whether neither a general nor a reference to a member of the text states the unit."""
    is_own = unit in writer.graph.targets(type_, Edge.REFERENCES)
    return is_own and not has_own_measure(writer, type_, unit)


def _record_other_quantity(writer: Writer, element: Element, quantity: str) -> None:
    """Record a quantity kind that differs from that of the unit: in ISQ, a unit determines it."""
    quantity_kind = quantity_kind_of(writer.graph, element)
    if quantity_kind is None:
        return
    if find_value_type(quantity_kind.name) not in (None, quantity):
        construct = "a quantity kind that has other units"
        writer.record_approximation(element, construct, "that of the unit")


def _list_non_scalar_generals(writer: Writer, member: Member, element: Element) -> list[str]:
    """Return the generals except numbers: a quantity value contains its number."""
    generals = writer.graph.targets(element, Edge.SPECIALIZES)
    names = (
        writer.refer_to(member.parent, element, Edge.SPECIALIZES, general)
        for general in generals
        if find_scalar_type(general) is None
    )
    return [name for name in names if name is not None]


def _annotate_unit(writer: Writer, member: Member, unit: Element) -> Line:
    """Return metadata with a unit that neither SI nor ``SysMLC`` defines."""
    facts = {"name": unit.name, "symbol": unit.attrs.get("symbol")}
    quantity_kind = quantity_kind_of(writer.graph, member.element) if member.element else None
    facts["quantity"] = None if quantity_kind is None else quantity_kind.name
    return make_annotation(writer, member, "Unit", facts)


# -- requirements --------------------------------------------------------------------------------


def write_requirement(writer: Writer, member: Member) -> list[Line]:
    """Write a requirement: a usage with its id as short name and its text as documentation.

    An id that is not free as a name in the namespace becomes metadata.
    """
    element = member.require_element()
    head = make_definition_head(writer, member)
    id = str(element.attrs.get("req_id", ""))
    is_free = bool(id) and _is_free_id(writer, member, id)
    if is_free:
        head.name = f"<{quote_name(id)}> {head.name}"
    body = []
    if id and not is_free:
        body.append(make_annotation(writer, member, "Requirement", {"id": id}))
    text = element.attrs.get("text")
    if text:
        record_text_changes(writer, element, str(text))
        body.append(Line("doc", text=format_comment(str(text))))
    return [Line(head.format(), body + write_contents(writer, member))]


def _is_free_id(writer: Writer, requirement: Member, id: str) -> bool:
    """Whether the id hides no other name, and no earlier requirement beside it has the same id."""
    parent = requirement.parent
    siblings = writer.plan.roots if parent is None else parent.members
    if look_up(writer.plan, parent, id) is not None:
        return False
    earlier = siblings[: siblings.index(requirement)]
    return not any(
        sibling.element is not None and sibling.element.attrs.get("req_id") == id
        for sibling in earlier
    )
